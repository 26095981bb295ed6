"""Whether a part is a centrifugal impeller: faces of blades repeated evenly about the axis of a hub that carries them to their outlet."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from trunnion.geometry.arrays import Bools, Floats
from trunnion.geometry.facegraph import CONCAVE, FaceGraph
from trunnion.recognize.contract import Suitability
from trunnion.recognize.grow import samples
from trunnion.recognize.revolution import RevolutionAxis, main_axis, of_revolution
from trunnion.recognize.symmetry import CircularPattern, patterns
from trunnion.tolerance import COINCIDENT
from trunnion.units import percent, radians

ENOUGH = 0.2
"""Share of the area in faces of blades on a part that is surely a wheel; bolt circles and the pads of a casing have a twentieth at most."""
CARRIED = 0.75
"""Radius of the hub over that of the blades from which on it carries them to their outlet: blades of fans, propellers and rotors stand
out from a hub of half their radius."""
UPRIGHT = radians(2.0)
"""A face within this of parallel to the axis all over, or of square to it, stands upright or lies level, in radians."""
END = 0.2
"""Share of a blade's height at either end in which its edges with hub and shroud lie."""
BLADES = ("plane", "extrusion", "revolution", "spline", "other")
"""Surfaces of blades; repeated cylinders, cones and tori are holes, rims and fillets."""


def suitability(graph: FaceGraph) -> Suitability:
    """Return the share of the part's area in its blades, the faces of revolution and all that is repeated about the axis."""
    axis = main_axis(graph)
    turned = of_revolution(graph, axis) if axis else np.zeros(len(graph), dtype=bool)
    repeated = patterns(graph, axis) if axis else ()
    blades = [
        p
        for p in repeated
        if axis and not turned[p.rows].any() and _may_be_blade(graph, axis, int(p.rows[0]))
    ]
    if axis is None or not blades:
        return Suitability(
            score=0.0, explained=0.0, reason="nothing like a blade is repeated about an axis"
        )
    whole, blade = float(graph.area.sum()), _within(graph, blades)
    explained = min(1.0, float(graph.area[turned | _within(graph, repeated)].sum()) / whole)
    share = float(graph.area[blade].sum()) / whole
    carried = _hub_reach(graph, axis, turned, repeated) / float(
        _away(graph, axis)[blade[graph.sample_face]].max()
    )
    score = explained * min(1.0, share / ENOUGH) if carried >= CARRIED else 0.0
    return Suitability(
        score=score,
        explained=explained,
        reason=(
            f"{blades[0].count} blades stand evenly about an axis, {percent(share)} of the area, on a hub of "
            f"{percent(min(carried, 1.0))} of their radius"
        ),
    )


def _within(graph: FaceGraph, patterns: Sequence[CircularPattern]) -> Bools:
    found = np.zeros(len(graph), dtype=bool)
    for pattern in patterns:
        found[pattern.rows] = True
    return found


def _away(graph: FaceGraph, axis: RevolutionAxis) -> Floats:
    return np.asarray(np.linalg.norm(axis.away(graph.sample_point), axis=1))


def _may_be_blade(graph: FaceGraph, axis: RevolutionAxis, row: int) -> bool:
    """Return whether a repeated face is a side of a blade: twisted or leaning, or upright with both ends in hub and shroud.

    Other upright faces are teeth, spokes and the walls of pockets, which a flat part has too.
    """
    if graph.surface[row] not in BLADES:
        return False
    along = np.abs(samples(graph, row)[1] @ axis.direction)
    if along.min() > np.cos(UPRIGHT):
        return False
    return bool(along.max() > np.sin(UPRIGHT)) or _enclosed(graph, axis, row)


def _enclosed(graph: FaceGraph, axis: RevolutionAxis, row: int) -> bool:
    """Return whether most of the edges at either end of a face along the axis are inner corners."""
    edges = list(graph.edges_of[row])
    if not edges:
        return False
    ends = np.stack([axis.height(p[edges]) for p in (graph.start, graph.middle, graph.end)])
    low, high = float(ends.min()), float(ends.max())
    at = ((ends - low) / max(high - low, COINCIDENT)).mean(axis=0)
    length = graph.length[edges]
    inner = length * (graph.convexity[edges] == CONCAVE)
    return all(
        float(inner[mine].sum()) > 0.5 * float(length[mine].sum())
        for mine in (at < END, at > 1.0 - END)
    )


def _hub_reach(
    graph: FaceGraph, axis: RevolutionAxis, turned: Bools, repeated: Sequence[CircularPattern]
) -> float:
    """Return the radius in mm out to which faces of revolution run round the axis; the tips of blades, apart from one another, don't."""
    tips = np.zeros(len(graph), dtype=bool)
    for pattern in repeated:
        mine = set(pattern.rows.tolist())
        tips[[r for r in pattern.rows if not mine & set(graph.neighbours(int(r)))]] = True
    hub = (turned & ~tips)[graph.sample_face]
    return float(_away(graph, axis)[hub].max(initial=0.0))
