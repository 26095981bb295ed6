"""The blank: the material that the first setup starts from."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trunnion.geometry.arrays import Floats, floats
from trunnion.geometry.frame import Frame


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Blank:
    """A box blank in a frame of its own: `low` and `high` (3,) mm are its corners in `frame`; `material` a catalogue name."""

    frame: Frame
    low: Floats
    high: Floats
    material: str
    density: float
    kind: str = "box"

    def __post_init__(self) -> None:
        object.__setattr__(self, "low", floats(self.low, (3,), "blank low"))
        object.__setattr__(self, "high", floats(self.high, (3,), "blank high"))
        if not (self.high > self.low).all():
            raise ValueError("blank: its high corner must lie above its low one")

    @property
    def size(self) -> Floats:
        """Length, width and height (3,) mm."""
        return self.high - self.low

    @property
    def volume(self) -> float:
        """Volume in mm3."""
        return float(np.prod(self.size))

    @property
    def mass(self) -> float:
        """Mass in kg (`density` in kg/dm3)."""
        return self.volume * self.density * 1e-6
