"""How far a part reaches, read from its face graph: exact on lines and arcs, without CAD."""

from __future__ import annotations

import numpy as np

from trunnion.geometry.arrays import Floats, Ints
from trunnion.geometry.facegraph import FaceGraph
from trunnion.tolerance import ANGLE, COINCIDENT

ARC_PIECES = 16
"""Chords an arc is opened into where points on it are needed; the box is exact on arcs."""


def box(graph: FaceGraph) -> tuple[Floats, Floats]:
    """Return the lowest and highest corner (3,) of the faces of a graph along its own axes, exact on lines and arcs."""
    present = graph.area > 0.0
    low, high = graph.box_low[present].min(axis=0), graph.box_high[present].max(axis=0)
    arcs = _arcs(graph)
    for axis in range(3):
        along = np.eye(3)[axis] - graph.curve_axis[arcs, axis, None] * graph.curve_axis[arcs]
        length = np.linalg.norm(along, axis=1)
        turns = length > ANGLE
        rows, reach = (
            arcs[turns],
            (graph.curve_radius[arcs, None] * along)[turns] / length[turns, None],
        )
        for side in (-reach, reach):
            tips = graph.curve_centre[rows] + side
            tips = tips[_on_arc(graph, rows, tips), axis]
            low[axis], high[axis] = min(low[axis], *tips, np.inf), max(high[axis], *tips, -np.inf)
    return low, high


def outline_points(graph: FaceGraph) -> Floats:
    """Return points (k, 2) whose convex hull is that of the part seen along z: ends of edges, points of arcs, samples."""
    arcs = _arcs(graph)
    centre, axis = graph.curve_centre[arcs, None], graph.curve_axis[arcs, None]
    u = graph.start[arcs, None] - centre
    turn = (_sweep(graph, arcs)[:, None] * np.linspace(0.0, 1.0, ARC_PIECES + 1))[..., None]
    points = centre + np.cos(turn) * u + np.sin(turn) * np.cross(axis, u)
    return np.concatenate(
        [graph.start, graph.end, graph.middle, graph.sample_point, points.reshape(-1, 3)]
    )[:, :2]


def _arcs(graph: FaceGraph) -> Ints:
    return np.flatnonzero(np.isfinite(graph.curve_radius))


def _sweep(graph: FaceGraph, arcs: Ints) -> Floats:
    """Return the turn (k,) of arcs (radians, signed about `curve_axis`) from their start to their end over their middle."""
    to_end, to_middle = (
        _angle(graph, arcs, graph.end[arcs]),
        _angle(graph, arcs, graph.middle[arcs]),
    )
    closed = np.linalg.norm(graph.end[arcs] - graph.start[arcs], axis=1) < COINCIDENT
    return np.where(
        closed, 2.0 * np.pi, np.where(to_middle <= to_end, to_end, to_end - 2.0 * np.pi)
    )


def _angle(graph: FaceGraph, arcs: Ints, points: Floats) -> Floats:
    """Return the angle (k,) from 0 to a whole turn, about `curve_axis`, from the start of each arc to a point."""
    u, p = graph.start[arcs] - graph.curve_centre[arcs], points - graph.curve_centre[arcs]
    across = np.einsum("ij,ij->i", graph.curve_axis[arcs], np.cross(u, p))
    return np.arctan2(across, np.einsum("ij,ij->i", u, p)) % (2.0 * np.pi)


def _on_arc(graph: FaceGraph, arcs: Ints, points: Floats) -> np.ndarray:
    sweep, there = _sweep(graph, arcs), _angle(graph, arcs, points)
    return np.where(sweep > 0.0, there <= sweep, there >= sweep + 2.0 * np.pi)
