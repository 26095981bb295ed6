"""Contour-parallel passes: nested offsets of the axis region, as a tree from the rim inwards.

No post stays between or inside the passes as long as the step is at most the radius of the cutter's flat end: a position between two
neighbouring offsets is nearer than one step to the outer one, and the innermost offset is nowhere deeper than one step. With a rounded
end a longer step leaves ridges as high as the end has risen there.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from trunnion.geometry.arrays import Floats
from trunnion.geometry.plane.curve import Curve
from trunnion.geometry.plane.curve_parts import points_along
from trunnion.geometry.plane.region import Region
from trunnion.model.tool import Tool

SAFE_SHARE = 0.95
"""Of the flat end's radius: the widest step; the rest is for the machine."""

CLIP_SPACING = 2.0
"""mm between the positions of a clip's rim that decide whether a ring can touch it."""


@dataclass(frozen=True, slots=True, eq=False)
class OffsetRing:
    """One piece of an offset of the axis region: its rim is a pass, `inner` are the pieces one step further inside."""

    region: Region
    inner: tuple[OffsetRing, ...]

    def curves(self) -> tuple[Curve, ...]:
        """Return the loops of the rim, the axis region on the left of each."""
        return self.region.curves()


def safe_step(tool: Tool, width: float, ridge: float = 0.0) -> float:
    """Return the step between passes in mm that leaves nothing higher than `ridge` mm between them: `width` when the cutter allows it."""
    corner = tool.corner_radius
    at_ridge = math.sqrt(corner**2 - max(corner - ridge, 0.0) ** 2)
    return min(width, SAFE_SHARE * max(tool.radius - corner + at_ridge, 0.5 * tool.radius))


def ring_tree(region: Region, step: float, clip: Region | None = None) -> tuple[OffsetRing, ...]:
    """Return the rings of an axis region, a step apart; with a clip, only those that can touch it."""
    rim = (
        None
        if clip is None
        else _Clip(clip, tuple(points_along(c, CLIP_SPACING)[1] for c in clip.curves()))
    )
    return tuple(_ring(piece, step, rim) for piece in region.split() if _overlaps(piece, rim))


def depth_first(rings: tuple[OffsetRing, ...]) -> Iterator[OffsetRing]:
    """Yield all rings of a tree, inner ones before the ring around them."""
    for ring in rings:
        yield from depth_first(ring.inner)
        yield ring


@dataclass(frozen=True, slots=True, eq=False)
class _Clip:
    """A clip and places (k, 2) along each of its loops."""

    region: Region
    rim: tuple[Floats, ...]


def _ring(piece: Region, step: float, clip: _Clip | None) -> OffsetRing:
    inside = piece.offset(-step).split()
    return OffsetRing(piece, tuple(_ring(p, step, clip) for p in inside if _overlaps(p, clip)))


def _overlaps(piece: Region, clip: _Clip | None) -> bool:
    """Return whether a piece has some of a clip's rim in it or lies inside the clip, as a closed space beside open ones does."""
    return (
        clip is None
        or any(bool(piece.contains(p).any()) for p in clip.rim)
        or _lies_in(piece, clip.region)
    )


def _lies_in(piece: Region, clip: Region) -> bool:
    return any(bool(clip.contains(c.points[:1]).all()) for c in piece.curves())
