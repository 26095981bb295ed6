"""The body of a wheel: the faces of revolution that blades stand on and all others that run round it; what is left are blades.

A face of revolution belongs to a blade when blades' walls fall away from it at sharp edges (their tips, and edges turned with the wheel);
to the body when it runs round the axis, alone or with the faces it runs into smoothly, or when walls rise from it: at inner corners, or
over root fillets.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trunnion.geometry.arrays import Bools, Floats
from trunnion.geometry.facegraph import CONCAVE, CONVEX, SMOOTH, FaceGraph
from trunnion.recognize.grow import grown
from trunnion.recognize.holes.sweep import TURN, arcs, axis_frame, swept
from trunnion.recognize.impeller.coordinates import CylindricalSamples
from trunnion.recognize.revolution import RevolutionAxis
from trunnion.tolerance import COINCIDENT

WHOLE = 0.9 * TURN
"""Turn that edges of faces which run round the axis sweep together, radians: no blade wraps so far round a wheel."""
MOSTLY = 0.5
"""Share of its outline that walls fall away from around a face of a blade; a rim that carries outlet edges has less."""
NEAREST = 5
"""Samples beside a smooth edge that tell whether the face beyond rises from the one before it or falls away."""
LOOKS_OUT = 0.15
"""Part of a face's mean normal away from the axis from which on the face looks out; below, it lies across the axis."""
COVERED = 0.3
"""Share of the hub's roots from which on a second surface that blades stand on is a cover."""


@dataclass(frozen=True, eq=False, kw_only=True)
class WheelBody:
    """Which faces (n,) are what: `turned` of revolution, `body` of them all but blades' own, `free` neither turned nor of holes.

    `roots` (n,) is the length in mm of the edges at which walls or root fillets rise from each body face, less that of those at which
    they fall away. `hub` are the rows of the faces that blades stand on, `cover` those of others opposite to them; `inlet` is 1 where the
    inlet lies in the axis's direction, -1 where against it.
    """

    turned: Bools
    body: Bools
    free: Bools
    roots: Floats
    hub: tuple[int, ...]
    cover: tuple[int, ...]
    inlet: float

    @property
    def is_covered(self) -> bool:
        """Whether blades stand between two surfaces, so that no cutter gets into the passages from outside of the wheel."""
        hub, cover = (float(self.roots[list(rows)].sum()) for rows in (self.hub, self.cover))
        return cover > COVERED * hub


def wheel_body(
    graph: FaceGraph,
    samples: CylindricalSamples,
    turned: Bools,
    apart: frozenset[int],
) -> WheelBody:
    """Return the body of a wheel; `apart` are rows of faces that belong to holes."""
    present = graph.area > 0.0
    out = np.zeros(len(graph), dtype=bool)
    out[sorted(apart)] = True
    turned = turned & present & ~out
    free = present & ~turned & ~out
    roots, share = _roots(graph, samples, turned, free)
    groups = _smooth_groups(graph, turned)
    body = np.zeros(len(graph), dtype=bool)
    for group in groups:
        whole = _runs_round(graph, samples.axis, group)
        for row in group:
            falls = roots[row] < 0.0 and share[row] > MOSTLY
            body[row] = (
                roots[row] > 0.0
                or (whole and not falls)
                or (whole and _runs_round(graph, samples.axis, (row,)))
            )
    hub, cover, inlet = _carriers(samples, body, roots)
    return WheelBody(
        turned=turned, body=body, free=free, roots=roots, hub=hub, cover=cover, inlet=inlet
    )


def _roots(
    graph: FaceGraph, samples: CylindricalSamples, turned: Bools, free: Bools
) -> tuple[Floats, Floats]:
    """Return for every turned face by how much more walls rise from it than fall away (mm of edges), and the share of its outline that
    free faces have."""
    rising, beside, outline = (np.zeros(len(graph)) for _ in range(3))
    for row in np.flatnonzero(turned):
        for edge in graph.edges_of[row]:
            other, length = graph.across(edge, int(row)), float(graph.length[edge])
            outline[row] += length
            if free[other]:
                beside[row] += length
                rising[row] += length * _rises(graph, samples, edge, other)
    return rising, beside / np.maximum(outline, 1e-12)


def _rises(graph: FaceGraph, samples: CylindricalSamples, edge: int, other: int) -> int:
    """Return 1 where the face beyond an edge rises from the one before it, -1 where it falls away."""
    if graph.convexity[edge] == CONCAVE:
        return 1
    if graph.convexity[edge] == CONVEX:
        return -1
    mine = samples.of(other)
    away = np.linalg.norm(graph.sample_point[mine] - graph.middle[edge], axis=1)
    near = mine[np.argsort(away, kind="stable")[:NEAREST]]
    step = graph.sample_point[near] - graph.sample_point[near[0]]
    turn = graph.sample_normal[near] - graph.sample_normal[near[0]]
    # The normal of a hollow face turns back over where it came from, that of a bulging one goes ahead.
    return 1 if float((step * turn).sum()) < 0.0 else -1


def _smooth_groups(graph: FaceGraph, turned: Bools) -> list[tuple[int, ...]]:
    """Return the turned faces in groups that run into each other smoothly."""
    found: list[tuple[int, ...]] = []
    seen: set[int] = set()
    for row in np.flatnonzero(turned).tolist():
        if row not in seen:
            group = grown(
                graph,
                [row],
                lambda edge, face, other: bool(turned[other]) and graph.convexity[edge] == SMOOTH,
            )
            seen.update(group)
            found.append(tuple(sorted(group)))
    return found


def _runs_round(graph: FaceGraph, axis: RevolutionAxis, rows: tuple[int, ...]) -> bool:
    edges = {e for r in rows for e in graph.edges_of[r]}
    frame = axis_frame(axis.point, axis.direction)
    return bool(edges) and swept(arcs(graph, edges, frame)) > WHOLE


def _carriers(
    samples: CylindricalSamples, body: Bools, roots: Floats
) -> tuple[tuple[int, ...], tuple[int, ...], float]:
    """Return the rows of the hub and of its cover, and 1 or -1: which way along the axis the inlet is.

    A hub's normals look away from the axis and, farther out, to the inlet; those of a cover look the other way. Of two flat discs the
    one that reaches nearer to the axis is the hub.
    """
    rows = [r for r in np.flatnonzero(body).tolist() if roots[r] > 0.0]
    normal = {r: samples.normal[samples.of(r)].mean(axis=0) for r in rows}
    out = sum(float(roots[r] * normal[r][2]) for r in rows if normal[r][0] > LOOKS_OUT)
    out -= sum(float(roots[r] * normal[r][2]) for r in rows if normal[r][0] < -LOOKS_OUT)
    across = [r for r in rows if abs(normal[r][2]) > LOOKS_OUT]
    if abs(out) <= COINCIDENT and across:
        inner = min(across, key=lambda r: (float(samples.meridian[samples.of(r), 0].min()), r))
        out = float(normal[inner][2])
    inlet = 1.0 if out >= 0.0 else -1.0
    hub = tuple(
        r
        for r in rows
        if normal[r][0] > LOOKS_OUT or (normal[r][0] >= -LOOKS_OUT and normal[r][2] * inlet >= 0.0)
    )
    return hub, tuple(r for r in rows if r not in hub), inlet
