"""How far a part reaches, read from its face graph: exact on lines and arcs, without CAD."""

from __future__ import annotations

import numpy as np

from trunnion.geometry.arrays import Floats
from trunnion.geometry.facegraph import FaceGraph
from trunnion.tolerance import ANGLE, COINCIDENT

ARC_PIECES = 16
"""Chords an arc is opened into where points on it are asked for; the box is exact on arcs."""


def box(graph: FaceGraph) -> tuple[Floats, Floats]:
    """Return the lowest and highest corner (3,) of the faces of a graph along its own axes, exact on lines and arcs."""
    present = graph.area > 0.0
    low, high = graph.box_low[present].min(axis=0), graph.box_high[present].max(axis=0)
    arcs = np.isfinite(graph.curve_radius)
    for e in np.flatnonzero(arcs).tolist():
        for axis in range(3):
            along = np.eye(3)[axis] - graph.curve_axis[e][axis] * graph.curve_axis[e]
            length = np.linalg.norm(along)
            if length < ANGLE:
                continue
            for sign in (-1.0, 1.0):
                tip = graph.curve_centre[e] + sign * graph.curve_radius[e] * along / length
                if _on_arc(graph, e, tip):
                    low[axis], high[axis] = min(low[axis], tip[axis]), max(high[axis], tip[axis])
    return low, high


def outline_points(graph: FaceGraph) -> Floats:
    """Return points (k, 2) whose convex hull is that of the part seen along z: ends of edges, points of arcs, samples."""
    near = [graph.start, graph.end, graph.middle, graph.sample_point]
    for e in np.flatnonzero(np.isfinite(graph.curve_radius)):
        near.append(_arc_points(graph, int(e), ARC_PIECES))
    return np.concatenate(near)[:, :2]


def _arc_points(graph: FaceGraph, edge: int, pieces: int) -> Floats:
    """Return points (pieces + 1, 3) along a circular edge, its ends with them."""
    centre, axis = graph.curve_centre[edge], graph.curve_axis[edge]
    u = graph.start[edge] - centre
    sweep = _sweep(graph, edge)
    t = np.linspace(0.0, sweep, pieces + 1)[:, None]
    return centre + np.cos(t) * u + np.sin(t) * np.cross(axis, u)


def _sweep(graph: FaceGraph, edge: int) -> float:
    """Return the turn (radians, signed about `curve_axis`) from an arc's start to its end over its middle."""
    to_end, to_middle = _angle(graph, edge, graph.end[edge]), _angle(graph, edge, graph.middle[edge])
    if np.linalg.norm(graph.end[edge] - graph.start[edge]) < COINCIDENT:
        return 2.0 * np.pi
    return to_end if to_middle <= to_end else to_end - 2.0 * np.pi


def _angle(graph: FaceGraph, edge: int, point: Floats) -> float:
    centre, axis = graph.curve_centre[edge], graph.curve_axis[edge]
    u, p = graph.start[edge] - centre, point - centre
    return float(np.arctan2(axis @ np.cross(u, p), u @ p) % (2.0 * np.pi))


def _on_arc(graph: FaceGraph, edge: int, point: Floats) -> bool:
    sweep, there = _sweep(graph, edge), _angle(graph, edge, point)
    return there <= sweep if sweep > 0.0 else there >= sweep + 2.0 * np.pi
