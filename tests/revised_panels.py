"""The small panel of `samples`, as a designer revises it: pockets deeper, longer, moved, an island gone, a pocket or a hole more."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any

import cadquery as cq

LENGTH, WIDTH, HEIGHT = 160.0, 100.0, 20.0
CORNER, FILLET = 8.0, 3.0


@dataclass(frozen=True)
class PanelDesign:
    """Sizes of a panel with a pocket on the left, one on the right, an island in the left one and holes, mm."""

    left_floor: float = 4.0
    left_length: float = 58.0
    right_floor: float = 4.0
    right_x: float = 98.5
    right_length: float = 53.0
    island: bool = True
    third: bool = False
    holes: tuple[tuple[float, float], ...] = ((145.0, 20.0), (145.0, 80.0))

    def place(self, x: float) -> str:
        """Return which pocket is at an x, empty for none."""
        right = 0.5 * self.right_length
        if 10.0 <= x <= 10.0 + self.left_length:
            return "left"
        if self.right_x - right <= x <= self.right_x + right:
            return "right"
        return "third" if self.third and 131.0 <= x <= 155.0 else ""

    def floor(self, place: str) -> float:
        """Return the height of a pocket's floor."""
        return {"left": self.left_floor, "right": self.right_floor, "third": 8.0}.get(place, 0.0)

    @cache  # noqa: B019 - designs are few and small
    def shape(self) -> Any:
        """Return the solid."""
        plate = (
            cq.Workplane("XY").box(LENGTH, WIDTH, HEIGHT, centered=False).edges("|Z").fillet(10.0)
        )
        left = _pocket(10.0 + 0.5 * self.left_length, self.left_length, 80.0, self.left_floor)
        if self.island:
            left = left.cut(
                cq.Workplane("XY").circle(8.0).extrude(14.0).translate((36.0, 50.0, 0.0))
            )
        made = plate.cut(left).cut(_pocket(self.right_x, self.right_length, 80.0, self.right_floor))
        if self.third:
            made = made.cut(_pocket(143.0, 24.0, 30.0, 8.0))
        for x, y in self.holes:
            made = made.cut(cq.Workplane("XY").circle(3.0).extrude(HEIGHT).translate((x, y, 0.0)))
        return made.val().wrapped


def _pocket(x: float, length: float, width: float, floor: float) -> Any:
    body = (
        cq.Workplane("XY")
        .box(length, width, HEIGHT - floor, centered=(True, True, False))
        .edges("|Z")
        .fillet(CORNER)
    )
    return body.faces("<Z").edges().fillet(FILLET).translate((x, 50.0, floor))
