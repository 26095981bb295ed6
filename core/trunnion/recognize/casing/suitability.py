"""Whether a part is a casing: a thin wall of revolution about one axis, seen from inside and outside, with or without bosses."""

from __future__ import annotations

import numpy as np

from trunnion.geometry.arrays import Bools, Floats
from trunnion.geometry.facegraph import FaceGraph
from trunnion.recognize.contract import Suitability
from trunnion.recognize.revolution import RevolutionAxis, main_axis, of_revolution
from trunnion.tolerance import COINCIDENT
from trunnion.units import percent

ENOUGH = 0.5
"""Share of the area in the two sides of a wall of revolution on a part that is surely a shell; engine casings have 0.7, bushings 0.35."""
FACING = 0.3
"""Cosine between a normal and the direction away from the axis from which on a face is a side of the wall, not a flange or a rim."""
THIN = 0.2
"""Thickness of the wall over the radius inside it up to which it is thin: casings have a twentieth, bushings and rings a third."""
ON_WALL = 0.1
"""Share of the area up to which faces that hang together and are not of revolution are a boss, a hole or a pocket on the wall."""


def suitability(graph: FaceGraph) -> Suitability:
    """Return the share of the part's area in faces of revolution about its main axis and in what stands on them."""
    axis = main_axis(graph)
    turned = of_revolution(graph, axis) if axis else np.zeros(len(graph), dtype=bool)
    if axis is None or not turned.any():
        return Suitability(
            score=0.0, explained=0.0, reason="no face is of revolution about an axis"
        )
    whole = float(graph.area.sum())
    explained = min(1.0, float(graph.area[turned | _on_wall(graph, turned)].sum()) / whole)
    sides, bore = _wall(graph, axis, turned)
    if not sides:
        return Suitability(score=0.0, explained=explained, reason="no wall runs round an axis")
    thickness = _thickness(graph)
    score = explained * min(1.0, sides / whole / ENOUGH) * min(1.0, THIN * bore / thickness)
    return Suitability(
        score=score,
        explained=explained,
        reason=(
            f"{percent(float(graph.area[turned].sum()) / whole)} of the area is of revolution about one axis, {percent(sides / whole)} "
            f"the two sides of a wall about {thickness:.3g} mm thick round a bore of {2.0 * bore:.3g} mm"
        ),
    )


def _wall(graph: FaceGraph, axis: RevolutionAxis, turned: Bools) -> tuple[float, float]:
    """Return twice the area of that side of a wall round an axis that has less of it, mm2, and the mean radius inside it, mm."""
    weight = np.where(turned[graph.sample_face], _weights(graph), 0.0)
    away = axis.away(graph.sample_point)
    radius = np.linalg.norm(away, axis=1)
    facing = np.einsum("ij,ij->i", away, graph.sample_normal) / np.maximum(radius, COINCIDENT)
    inside, outside = weight * (facing < -FACING), weight * (facing > FACING)
    area = float(inside.sum())
    return 2.0 * min(area, float(outside.sum())), float(inside @ radius) / area if area else 0.0


def _weights(graph: FaceGraph) -> Floats:
    """Return the area (s,) that each sample represents, mm2."""
    number = np.bincount(graph.sample_face, minlength=len(graph))
    return np.asarray((graph.area / np.maximum(number, 1))[graph.sample_face])


def _thickness(graph: FaceGraph) -> float:
    """Return about how thick the material is, mm: twice the volume (by the divergence theorem over the samples) over the area."""
    point = graph.sample_point - graph.sample_point.mean(axis=0)
    volume = float(_weights(graph) @ np.einsum("ij,ij->i", point, graph.sample_normal)) / 3.0
    return max(2.0 * abs(volume) / float(graph.area.sum()), COINCIDENT)


def _on_wall(graph: FaceGraph, turned: Bools) -> Bools:
    """Return which faces (n,) are parts of bosses, holes and pockets: not of revolution, and little of them hangs together."""
    found = np.zeros(len(graph), dtype=bool)
    remaining, whole = (
        {int(r) for r in np.flatnonzero(~turned & (graph.area > 0.0))},
        float(graph.area.sum()),
    )
    while remaining:
        border, mine = [remaining.pop()], []
        while border:
            mine.append(border.pop())
            adjacent = remaining.intersection(graph.neighbours(mine[-1]))
            remaining -= adjacent
            border += adjacent
        found[mine] = float(graph.area[mine].sum()) <= ON_WALL * whole
    return found
