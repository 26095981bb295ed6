"""All uncut pieces of a casing for one cutter: before anything is cut after it, so that rest operations can be placed."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

import numpy as np
from scipy.spatial import cKDTree

from trunnion.geometry.facegraph import FaceGraph
from trunnion.model.feature import Feature, Recognition
from trunnion.plan.casing.bottoms import CasingBottom, casing_bottoms
from trunnion.plan.casing.uncut.boss_pieces import pieces_inside
from trunnion.plan.casing.uncut.piece import BESIDE, UncutPiece
from trunnion.plan.casing.uncut.pocket_side import milled_wall
from trunnion.plan.casing.uncut.throat import Milled, milled_boss, pieces_between
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.recognize.casing.kinds import SIDE
from trunnion.tolerance import ANGLE, FITTED


def uncut_pieces(
    found: Recognition,
    graph: FaceGraph,
    diameter: float,
    allowance: float = 0.0,
    progress: Progress = NO_PROGRESS,
) -> tuple[UncutPiece, ...]:
    """Return what a cutter of a diameter (mm) with an allowance on all sides leaves on a casing, by class and owner.

    Root fillets count as part of neither boss nor piece. Raises `BadInput` for a part without pockets, `Cancelled` when asked to stop.
    """
    progress.at(0.0, "unrolling bottoms")
    bottoms = progress.aside(lambda _: casing_bottoms(found, graph))
    made: list[UncutPiece] = []
    for bottom in progress.over(bottoms, "uncut pieces"):
        own = [b for b in bottom.bosses if b.feature.attributes.get("on") == bottom.pocket.id]
        for boss in progress.each(own):
            made += pieces_inside(boss, bottom.meridian, diameter, allowance)
        sides = [
            milled_boss(b, bottom.meridian, 0.5 * diameter, allowance) for b in progress.each(own)
        ]
        for a, b in progress.each(list(combinations(sides, 2))):
            if _near(a, b, diameter + 2.0 * allowance):
                made += _aside(progress, a, b, bottom, diameter, allowance)
        for side in progress.each(sides):
            for wall in _walls(side, bottom, graph, found, diameter, allowance):
                made += _aside(progress, side, wall, bottom, diameter, allowance, BESIDE)
    return tuple(sorted(made, key=lambda p: (p.number, p.owners)))


def _aside(
    progress: Progress,
    a: Milled,
    b: Milled,
    bottom: CasingBottom,
    diameter: float,
    allowance: float,
    number: int = 2,
) -> tuple[UncutPiece, ...]:
    return progress.aside(
        lambda _: pieces_between(a, b, bottom.meridian, diameter, allowance, number)
    )


def _near(a: Milled, b: Milled, reach: float) -> bool:
    """Return whether two feet come nearer to each other than a cutter is wide."""
    return bool(np.min(cKDTree(a.foot).query(b.foot)[0]) < reach)


def _walls(
    side: Milled,
    bottom: CasingBottom,
    graph: FaceGraph,
    found: Recognition,
    diameter: float,
    allowance: float,
) -> Iterator[Milled]:
    """Yield the ends of a bottom that rise beside a boss nearer than a cutter is wide, but don't cut it."""
    low, high = float(side.foot[:, 2].min()), float(side.foot[:, 2].max())
    local = graph.in_frame(found.frame)
    first, last = bottom.meridian.ends
    for z, up, gap in ((first, False, low - first), (last, True, last - high)):
        if not FITTED < gap < diameter + 2.0 * allowance:
            continue
        rise = _rise(bottom.pocket, local, z, bottom.meridian.outward)
        if rise > 0.0:
            yield milled_wall(
                side,
                z,
                min(rise, side.height),
                up,
                bottom.meridian,
                0.5 * diameter,
                allowance,
                bottom.pocket.id,
            )


def _rise(pocket: Feature, local: FaceGraph, z: float, outward: float) -> float:
    """Return how far (mm) the pocket's side at a height rises over the bottom's end there; 0 where there is none square to the axis."""
    for tag in pocket.with_role(SIDE):
        row = tag - 1
        level = abs(float(local.normal[row, 2])) > np.cos(ANGLE)
        if level and abs(float(local.centre[row, 2]) - z) < FITTED * 10.0:
            edges = list(local.edges_of[row])
            away = np.linalg.norm(local.middle[edges, :2], axis=1)
            return float(away.max() - away.min()) if outward else 0.0
    return 0.0
