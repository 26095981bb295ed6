"""A cut that divides one face of a part in two, as a person made it: plain data, done again when the part is opened."""

from __future__ import annotations

import math
from dataclasses import dataclass

from trunnion.findings import BadInput

Position = tuple[float, float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class Cut:
    """Where a face, named by tag, is cut: by the plane through the one position of `places` that has a `normal`, or, without a normal, by
    the path through two or more positions that are brought onto the face. mm, the part's coordinates as read.

    What lies behind the plane (left of the path, seen from outside) keeps the tag, what lies before it (right) takes the next free one.
    """

    face: int
    places: tuple[Position, ...]
    normal: tuple[float, ...] = ()

    @property
    def is_plane(self) -> bool:
        """Whether a plane cuts, not a way."""
        return bool(self.normal)


def plane_cut(face: int, position: Position, normal: Position) -> Cut:
    """Return the cut of a face by the plane through a position; raise `BadInput` when the normal has no length or a number is none."""
    if not all(map(math.isfinite, (*position, *normal))):
        raise BadInput(
            f"the plane of a cut needs numbers; got {' '.join(f'{v:g}' for v in (*position, *normal))}"
        )
    if not sum(v * v for v in normal) > 0.0:
        raise BadInput("the plane of a cut needs a normal with a length")
    return Cut(face=face, places=(position,), normal=normal)


def curve_cut(face: int, places: tuple[Position, ...]) -> Cut:
    """Return the cut of a face by the path through some positions near it; raise `BadInput` for fewer than two."""
    if len(places) < 2:
        raise BadInput("a drawn cut needs two places at least")
    return Cut(face=face, places=places)
