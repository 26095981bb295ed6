"""Tunnels along a part: planes that lean, seen from above, but stand upright along a level direction, between others that do."""

from __future__ import annotations

import numpy as np

from trunnion.geometry.arrays import Bools, Floats
from trunnion.geometry.facegraph import CONCAVE, FaceGraph
from trunnion.tolerance import ANGLE


def tunnel_walls(graph: FaceGraph, z: Floats) -> Bools:
    """Return which faces (n,) are planes between two sharp inner edges along one level direction, seen along z: walls of tunnels and slots
    with three sides or more, which an end mill cuts from where they open."""
    level = np.abs((graph.end - graph.start) @ z) < np.sin(ANGLE) * graph.length
    line = np.array([c == "line" for c in graph.curve])
    edges = np.flatnonzero(level & line & (graph.convexity == CONCAVE))
    along = (graph.end - graph.start)[edges] / graph.length[edges, None]
    found = np.zeros(len(graph), dtype=bool)
    for row, surface in enumerate(graph.surface):
        if surface == "plane":
            own = along[(graph.edge_face[edges] == row).any(axis=1)]
            parallel = np.abs(own @ own.T) > np.cos(ANGLE)
            found[row] = bool((parallel.sum(axis=1) > 1).any())
    return found
