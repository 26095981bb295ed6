"""What a random part is: its solid somewhere in space, what it was made of, and the file that a shop would get."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from random import Random
from typing import Any

UNITS = ("mm", "mm", "mm", "inch")
"""Units of the files: most shops send millimetres."""


@dataclass(frozen=True, slots=True)
class Seeded:
    """A random part with its truth by construction."""

    name: str
    shape: Any
    """OCP solid, mm, as it lies in its file."""
    unit: str
    """Unit that its file is written in."""
    counts: Mapping[str, int]
    """How many features of each kind it was made with."""
    smallest_radius: float
    """Radius (mm) of its tightest upright corner or foot."""

    def written(self, folder: Path) -> Path:
        """Return its STEP file in a folder."""
        from trunnion.part.write import write_step

        path = folder / f"{self.name}.step"
        write_step(self.shape, path, unit=self.unit)
        return path


def placed(draw: Random, shape: Any) -> Any:
    """Return a shape (cadquery) where a designer left it: as drawn, moved, turned about the vertical, or laid on another side."""
    how = draw.choice(("drawn", "moved", "turned", "laid"))
    if how == "drawn":
        return shape
    shift = tuple(draw.uniform(-300.0, 300.0) for _ in range(3))
    if how == "turned":
        shape = shape.rotate((0, 0, 0), (0, 0, 1), draw.uniform(0.0, 360.0))
    if how == "laid":
        shape = shape.rotate((0, 0, 0), draw.choice(((1, 0, 0), (0, 1, 0))), 90.0)
    return shape.translate(shift)
