"""What faces are to keep on purpose, as the proof holds programs against it."""

from __future__ import annotations

from dataclasses import dataclass

from trunnion.geometry.frame import WORLD, Frame
from trunnion.geometry.plane.region import Region


@dataclass(frozen=True, slots=True, kw_only=True)
class FaceAllowance:
    """A face, by its tag, that keeps material when all programs have run: `least` to `most` mm over it, for the feature it is demanded on.

    Both are equal on walls and floors; at a fillet between a wall and a floor that keep different amounts, one runs into the other.
    A face that other features have too keeps it over the plan area `own` alone, in a frame; over `others`, those features', it keeps
    nothing, and in between nobody minds how one runs into the other. None: all of the face keeps it.
    """

    feature: str
    face: int
    least: float
    most: float
    frame: Frame = WORLD
    own: Region | None = None
    others: Region | None = None
