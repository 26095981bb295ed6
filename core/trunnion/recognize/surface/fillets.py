"""Fillets of a part of curved surfaces by how they bend and run on, also where their radius varies and the file cut them up."""

from __future__ import annotations

import numpy as np

from trunnion.geometry.arrays import Bools, Floats
from trunnion.geometry.facegraph import CONVEX, FaceGraph
from trunnion.recognize.grow import grown
from trunnion.units import radians

TURN = radians(30.0)
"""A fillet turns by this at least between the faces that it joins, in radians; the hollow side of a blade bends less across its width."""
MOST = 0.5
"""Share of a boundary from which on it is most of it."""
SAME = 1.1
"""Ratio of hollow curvatures up to which faces that meet are of one fillet: those that a file cut into pieces are too small to turn."""


def fillets(graph: FaceGraph, width: Floats, hollow: Floats) -> Bools:
    """Return which faces (n,) are fillets, from their mean width (n,), mm, and middle hollow curvature (n,), 1/mm.

    A fillet is hollow, turns by `TURN` across its width and ends in no outer corner along most of its boundary; so do the pieces around it
    that are hollow by the same radius.
    """
    inner = graph.convexity != CONVEX
    seeds = np.flatnonzero((hollow * width > TURN) & mostly(graph, inner))

    def runs_on(edge: int, face: int, other: int) -> bool:
        return bool(inner[edge] and 1.0 / SAME <= hollow[other] / hollow[face] <= SAME)

    return np.isin(np.arange(len(graph)), grown(graph, seeds.tolist(), runs_on))


def mostly(graph: FaceGraph, edges: Bools) -> Bools:
    """Return of which faces (n,) some edges (m,) are most of the boundary."""
    every, some = (
        np.bincount(graph.edge_face.ravel(), np.repeat(length, 2), len(graph))
        for length in (graph.length, np.where(edges, graph.length, 0.0))
    )
    return np.asarray(some > MOST * every)
