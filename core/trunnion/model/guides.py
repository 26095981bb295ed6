"""Guide lines: the curves that passes of an operation are led by, or that bound what they clear, and how one element of them follows the
other.

Source: the drive geometry paper (guide lines and guide faces, move direction and link relations), in the words of APT (ISO 4342): the tool
comes TO a face that it can't pass, goes PAST one that ends before the next begins, or meets the next TANTO; from there it goes left
(GOLFT), right (GORGT) or straight on (GOFWD).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from trunnion.geometry.arrays import Floats, floats


class GuideKind(StrEnum):
    """What a guide line is to an operation: the wall that a pass goes along, the foot of one beside that it stays off, the rim of an area
    that is cleared or finished, the axis of a hole, the contour of turning."""

    WALL = "wall"
    FOOT = "foot"
    AREA = "area"
    AXIS = "axis"
    CONTOUR = "contour"


class LinkRelation(StrEnum):
    """How a pass along one element of a guide line ends where the next begins."""

    TO = "TO"
    PAST = "PAST"
    TANGENT = "TANTO"


MOVES = {LinkRelation.TO: "GOLFT", LinkRelation.PAST: "GORGT", LinkRelation.TANGENT: "GOFWD"}
"""APT's word for where the tool goes on: the part is on the right of a wall's guide line."""


@dataclass(frozen=True, slots=True, kw_only=True)
class GuideChain:
    """A guide line by faces alone. `on` has the tag of the face that each of its elements lies on, 0 where none is known; `relations` say
    how each ends where the next begins, that of the last one of a `closed` line where the first does. `faces` are the tags that are
    finished along it, where they are known."""

    kind: GuideKind
    closed: bool = False
    faces: tuple[int, ...] = ()
    on: tuple[int, ...] = ()
    relations: tuple[LinkRelation, ...] = ()

    def __post_init__(self) -> None:
        links = len(self.on) if self.closed else max(len(self.on) - 1, 0)
        if len(self.relations) != links:
            raise ValueError(
                f"guide chain: {len(self.on)} elements have {links} links, not {len(self.relations)}"
            )

    def elements(self) -> Iterator[tuple[str, int, LinkRelation | None, int]]:
        """Yield for each element APT's word for how the tool goes on to it, its face, and how it ends at which face (None and 0 at an open
        end)."""
        n = len(self.on)
        for k, face in enumerate(self.on):
            came = self.relations[k - 1] if k or self.closed else LinkRelation.TANGENT
            link = self.relations[k] if k < len(self.relations) else None
            yield MOVES[came], face, link, self.on[(k + 1) % n] if link is not None else 0


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class GuideCurve:
    """A guide line in the part's coordinates: `points` (n, 3) mm, the first again at the end where its `chain` is closed; elements of the
    chain meet at places `corners` (k, 3)."""

    chain: GuideChain
    points: Floats
    corners: Floats

    def __post_init__(self) -> None:
        object.__setattr__(self, "points", floats(self.points, (None, 3), "guide line"))
        places = (len(self.chain.relations), 3)
        object.__setattr__(self, "corners", floats(self.corners, places, "corners"))

    @property
    def kind(self) -> GuideKind:
        """What it is to the operation."""
        return self.chain.kind

    @property
    def relations(self) -> tuple[LinkRelation, ...]:
        """How its elements follow each other, at its corners."""
        return self.chain.relations

    @property
    def length(self) -> float:
        """Length in mm."""
        return float(np.linalg.norm(np.diff(self.points, axis=0), axis=1).sum())


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class OperationGuides:
    """The guide lines of an operation, and the tags of its guide faces; `refused` says why there are none, where that is so."""

    operation: str
    lines: tuple[GuideCurve, ...] = ()
    faces: tuple[int, ...] = ()
    refused: str = ""
