"""Passes of interrupted turning over ground laid flat: on each circle about the axis the gaps that a tool may be down in.

A circle about the axis is looked at point by point; a gap ends a point before the first one that the tool may not be at.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from itertools import pairwise

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats
from trunnion.geometry.plane.region import EMPTY_REGION, Region, union_all
from trunnion.plan.development.drives import (
    OFF_STOCK,
    GroundCutter,
    cleared_by,
    free_for,
    ring_of,
)
from trunnion.plan.development.ground import DevelopedGround, sector_between
from trunnion.plan.turning.gap_drive import GapPass

SPACING = 1.0
"""mm between the points of a circle at which it is looked at."""
LIFT_STEP = 2.0
"""mm: heights that a tool is lifted to are whole steps of it."""

Needed = Callable[[float], float]
"""The length (mm) that a gap must have at least, by how high (mm) the tool is lifted between gaps."""


def gap_passes(
    ground: DevelopedGround,
    cutter: GroundCutter,
    roughed: Sequence[GroundCutter],
    step: float,
    needed: Needed,
) -> tuple[GapPass, ...]:
    """Return passes a `step` (mm) apart over ground, from its lower to its upper end.

    The tool stays within what earlier cutters have `roughed`, and goes from gap to gap over all that may stand on the circle; where
    the part is in its way there, or no gap is long enough, there is no pass. A circle without anything on it is no gap.
    """
    allowed = _axis_region(ground, cutter, roughed)
    if not allowed:
        return ()
    count = max(1, math.ceil((ground.ends[1] - ground.ends[0]) / step - tolerance.COINCIDENT))
    along = np.linspace(*ground.ends, count + 1)
    widest = float(ground.development.radius_at(along).max())
    turns = np.linspace(-math.pi, math.pi, max(16, math.ceil(2.0 * math.pi * widest / SPACING)) + 1)
    down = _on_circles(allowed, ground, along, turns[:-1])
    rows = np.flatnonzero(down.any(axis=1) & ~down.all(axis=1))
    lifted = _lifts(ground, cutter, along[rows], turns[:-1])
    found = []
    for row, lift in zip(rows.tolist(), lifted.tolist(), strict=True):
        radius = float(ground.development.radius_at(along[row : row + 1])[0])
        gaps = tuple(
            gap
            for gap in _gaps(down[row], turns)
            if math.isfinite(lift) and radius * (gap[1] - gap[0]) >= needed(lift)
        )
        if gaps:
            found.append(GapPass(along=float(along[row]), lift=lift, gaps=gaps))
    return tuple(found)


def turned_region(
    ground: DevelopedGround, passes: Sequence[GapPass], step: float, ramp: Callable[[float], float]
) -> Region:
    """Return the area of ground that passes a `step` (mm) apart finish: between two neighbours, where both are down.

    `ramp` gives the length (mm) at either end of a gap in which the tool is not yet down, by how high it is lifted.
    """
    pieces = []
    for low, high in pairwise(passes):
        if high.along - low.along > step + tolerance.COINCIDENT:
            continue
        first, second = (_down(p, ground, ramp) for p in (low, high))
        for a in first:
            for b in second:
                for turn in (-2.0 * math.pi, 0.0, 2.0 * math.pi):
                    start, end = max(a[0], b[0] + turn), min(a[1], b[1] + turn)
                    if end > start:
                        pieces.append((low.along, high.along, start, end))
    return union_all([r for piece in pieces for r in _within_plane(ground, *piece)])


def _within_plane(
    ground: DevelopedGround, low: float, high: float, start: float, end: float
) -> list[Region]:
    """Return a piece of a band as areas of the plane: what goes past half a turn comes in at its other end."""
    whole = 2.0 * math.pi
    shift = whole * math.floor((start + math.pi) / whole)
    start, end = start - shift, end - shift
    areas = [sector_between(ground.development, low, high, start, min(end, math.pi))]
    if end > math.pi:
        areas.append(sector_between(ground.development, low, high, -math.pi, end - whole))
    return [a for a in areas if a]


def _down(
    each: GapPass, ground: DevelopedGround, ramp: Callable[[float], float]
) -> list[tuple[float, float]]:
    """Return the angles between which the tool is on the ground in each gap of a pass."""
    radius = float(ground.development.radius_at(np.array([each.along]))[0])
    margin = ramp(each.lift) / radius
    return [(a + margin, b - margin) for a, b in each.gaps]


def _axis_region(
    ground: DevelopedGround, cutter: GroundCutter, roughed: Sequence[GroundCutter]
) -> Region:
    """Return the area of the plane that the tool's axis may be in, on the ground: free of the part, over what has been roughed."""
    kept = cutter.tool.radius + cutter.allowance
    allowed = free_for(ground, 0.0, cutter).offset(-kept).intersect(ring_of(ground))
    cleared = union_all([cleared_by(each, ground, 0.0) for each in roughed])
    if not (allowed and cleared):
        return EMPTY_REGION
    kept = max(r for z, r in cutter.tool.rings() if z <= ground.ring_top) + OFF_STOCK
    return allowed.intersect(cleared.offset(-kept))


def _on_circles(area: Region, ground: DevelopedGround, along: Floats, turns: Floats) -> Bools:
    """Return for places along the straight lines and angles whether their points (k, n) lie in an area of the plane."""
    places, angles = np.meshgrid(along, turns, indexing="ij")
    points = ground.development.at(places.ravel(), angles.ravel())
    return area.contains(points).reshape(places.shape)


def _lifts(ground: DevelopedGround, cutter: GroundCutter, along: Floats, turns: Floats) -> Floats:
    """Return for each circle how high (k,) mm a tool is lifted between gaps: over the blank, which may still stand there; infinite where
    the part is in its way even so."""
    places, high = ground.profile.T
    near = cutter.tool.radius + float(places[1] - places[0])
    over = np.array([high[np.abs(places - v) <= near].max() for v in along]) + cutter.above
    lifts = LIFT_STEP * np.ceil(over / LIFT_STEP)
    for lift in np.unique(lifts).tolist():
        rows = np.flatnonzero(lifts == lift)
        area = free_for(ground, lift, cutter).offset(-cutter.tool.radius)
        clear = _on_circles(area, ground, along[rows], turns).all(axis=1)
        lifts[rows[~clear]] = np.inf
    return lifts


def _gaps(down: Bools, turns: Floats) -> list[tuple[float, float]]:
    """Return the stretches of a circle (n,) on which the tool may be down, as angles; one over the end of the turns is one."""
    n = len(down)
    first = int(np.argmin(down))
    rolled = np.roll(down, -first)
    edges = np.flatnonzero(np.diff(np.concatenate([[False], rolled, [False]]).astype(int)))
    step = float(turns[1] - turns[0])
    return [
        (float(turns[0]) + (first + a) * step, float(turns[0]) + (first + b - 1) * step)
        for a, b in edges.reshape(-1, 2).tolist()
        if b - a > 1 and b - a < n
    ]
