"""Class 1: what a cutter that goes round a boss leaves inside its outline, in the plane of the top.

With the radius r and the allowance a on the sides it is closing(outline + a, r) minus (outline + a), exactly: the outline is grown by r,
holes of the grown area are filled (no cutter gets in), and the rest is shrunk by r.
"""

from __future__ import annotations

import numpy as np

from trunnion.geometry.arrays import Floats
from trunnion.geometry.plane.curve import Curve
from trunnion.geometry.plane.region import Region
from trunnion.plan.casing.bottoms import CasingBoss
from trunnion.plan.casing.uncut.piece import INSIDE, UncutPiece
from trunnion.recognize.casing.meridian import Meridian
from trunnion.recognize.casing.outline import BossOutline
from trunnion.tolerance import COINCIDENT

LEAST = 1e-3
"""mm2: what is smaller is the rounding of offsets."""
CELL = 0.5
"""mm: grid that the height of a piece over the ground is averaged on."""
STEPS = 20
"""Halvings of the cutter's radius until the largest that leaves nothing is known to a thousandth of a millimetre."""


def outline_region(outline: BossOutline) -> Region:
    """Return the area inside an outline in its plane; what a rib cuts off is closed by straight lines."""
    pieces = outline.pieces
    if len(pieces) == 1 and pieces[0].is_whole and pieces[0].centre is not None:
        return Region.circle(pieces[0].centre, pieces[0].radius)
    points: list[Floats] = []
    bulges: list[float] = []
    for piece, after in zip(pieces, (*pieces[1:], pieces[0]), strict=True):
        points.append(piece.start)
        bulges.append(float(np.tan(0.25 * piece.turn)))
        if np.linalg.norm(piece.end - after.start) > COINCIDENT:
            points.append(piece.end)
            bulges.append(0.0)
    return Region.of([Curve(np.array(points), np.array(bulges), True)])


def uncut_of(region: Region, radius: float) -> Region:
    """Return what a cutter of a radius leaves of the surroundings of a region that it goes round."""
    closed = region.offset(radius).holes_filled().offset(-radius)
    return closed.minus(region)


def pieces_inside(
    boss: CasingBoss, meridian: Meridian, diameter: float, allowance: float = 0.0
) -> tuple[UncutPiece, ...]:
    """Return the pieces of class 1 of a boss for a cutter of a diameter with an allowance on the sides, mm."""
    region = outline_region(boss.outline)
    if allowance:
        region = region.offset(allowance)
    left = uncut_of(region, 0.5 * diameter)
    return tuple(
        UncutPiece(
            number=INSIDE,
            owners=(boss.id,),
            cutter=diameter,
            area=part.area,
            volume=part.area * _mean_depth(boss.outline, part, meridian),
            boundary=boss.outline.space(part.curves()[0].sampled(LEAST)),
            clears=2.0 * _largest(region, part, 0.5 * diameter),
        )
        for part in left.split()
        if part.area > LEAST
    )


def _mean_depth(outline: BossOutline, part: Region, meridian: Meridian) -> float:
    """Return the mean distance (mm) from the plane of the top to the ground over a piece."""
    low, high = part.box()
    x, y = (np.arange(a, b + CELL, CELL) + 0.01 * CELL for a, b in zip(low, high, strict=True))
    grid = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)
    inside = grid[part.contains(grid)]
    if not len(inside):
        inside = part.curves()[0].points
    return float(np.nanmean(meridian.foot(outline.space(inside), outline.frame.z)))


def _largest(region: Region, part: Region, radius: float) -> float:
    """Return the largest radius below a cutter's that leaves nothing in a piece, by halving: what is left grows with the radius."""
    low, high = 0.0, radius
    for _ in range(STEPS):
        middle = 0.5 * (low + high)
        if uncut_of(region, middle).intersect(part).area > LEAST:
            high = middle
        else:
            low = middle
        if high - low < LEAST:
            break
    return low
