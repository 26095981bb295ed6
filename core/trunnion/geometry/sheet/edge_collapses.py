"""Points of a sheet that stand closer than a field needs them, taken away: what is left of long slivers that were split.

Short edges are collapsed, one end onto the other (as in isotropic remeshing: Botsch and Kobbelt, A remeshing approach to multiresolution
modeling, 2004), so that every point that stays is one of the faces'. Points on rims and on edges between faces stay where they are.
"""

from __future__ import annotations

import math

import numpy as np

from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.kernels.collapses import apart_loop, shortest_edges_loop
from trunnion.geometry.sheet.sheet import SMOOTH, Measure, edges_of, unit
from trunnion.progress import NO_PROGRESS, Progress

SHORT = 0.45
"""Of the limit: shorter edges are collapsed. Halving leaves edges of a half, or of a third askew."""
TURN = math.cos(math.radians(6.0))
"""Cosine of the turn of the normals along an edge at most: the cubic through its ends leaves an arc of 6 degrees by 2e-7 of its
radius, and what is split again and again by a few times that."""
ROUNDS = 10
"""Rounds of collapses at most; each one takes as many short edges as have no neighbours in common, the shortest first."""
SCATTER, SCATTER_OVER = 2_654_435_761, 1 << 32
"""Knuth's multiplier: products with rows, over a power of two, lie in no order."""
ENOUGH = 0.002
"""Share of the points: a round that takes fewer away is the last one."""


def collapsed(
    points: Floats,
    normals: Floats,
    triangles: Ints,
    face: Ints,
    measure: Measure,
    limit: float,
    longest: float,
    progress: Progress = NO_PROGRESS,
) -> tuple[Ints, Ints]:
    """Return triangles (t, 3) and their faces (t,) with edges collapsed that measure less than `SHORT` of a limit, as long as none that is
    made measures more than `longest`, turns by more than `TURN` or comes to lie in a folded triangle."""
    n = len(points)
    stuck = np.zeros(n, dtype=bool)
    for _ in range(ROUNDS):
        progress.check()
        ends, side = edges_of(triangles, n)
        a, b = ends.T
        size = measure(points[a], normals[a], points[b], normals[b])
        fixed = _on_borders(ends, side, face, n) | stuck
        goes, onto = _shortest(ends, size, SHORT * limit, fixed)
        together = apart_loop(triangles, goes, n)
        goes, onto = goes[together], onto[together]
        if not len(goes):
            break
        new = np.arange(n)
        new[goes] = onto
        fit = _fit(points, normals, triangles, ends, measure, longest, goes, onto)
        stuck[goes[~fit]] = True
        new[goes[~fit]] = goes[~fit]
        triangles = new[triangles]
        real = _has_area(triangles)
        triangles, face = triangles[real], face[real]
        if len(goes) < ENOUGH * n:
            break
    return triangles, face


def _on_borders(ends: Ints, side: Ints, face: Ints, n: int) -> Bools:
    """Return which of n points lie on rims, between faces, or on edges of more than two triangles."""
    uses = np.bincount(side.ravel(), minlength=len(ends))
    low, high = np.full(len(ends), np.iinfo(np.int64).max), np.full(len(ends), -1)
    tags = np.repeat(face, 3)
    np.minimum.at(low, side.ravel(), tags)
    np.maximum.at(high, side.ravel(), tags)
    found = np.zeros(n, dtype=bool)
    found[ends[(uses != 2) | (low != high)]] = True
    return found


def _shortest(ends: Ints, size: Floats, limit: float, fixed: Bools) -> tuple[Ints, Ints]:
    """Return the points (k,) that go and those they go onto, each along its shortest edge, those of the shortest ones first."""
    edge = shortest_edges_loop(ends, size, limit, len(fixed))
    goes = np.flatnonzero((edge >= 0) & ~fixed)
    edge = edge[goes]
    # Of about the same length in no order that follows the rows: along a strip only one would win a round.
    order = np.lexsort(
        (
            goes * SCATTER % SCATTER_OVER,
            np.ceil(np.log2(np.maximum(size[edge], np.finfo(float).tiny))),
        )
    )
    goes, edge = goes[order], edge[order]
    return goes, ends[edge].sum(axis=1) - goes


def _fit(
    points: Floats,
    normals: Floats,
    triangles: Ints,
    ends: Ints,
    measure: Measure,
    longest: float,
    goes: Ints,
    onto: Ints,
) -> Bools:
    """Return which points (k,) may go onto others (k,): what their triangles become is no worse than is allowed."""
    n = len(points)
    rank, target = np.full(n, -1), np.arange(n)
    rank[goes] = np.arange(len(goes))
    target[goes] = onto
    # No triangle has two points that go in one round.
    mine = np.maximum(
        np.maximum(rank[triangles[:, 0]], rank[triangles[:, 1]]), rank[triangles[:, 2]]
    )
    rows = np.flatnonzero(mine >= 0)
    made, mine = target[triangles[rows]], mine[rows]
    kept = _has_area(made)
    made, mine = made[kept], mine[kept]
    good = _upright(points, normals, made)
    for k in range(3):
        p, q = made[:, k], made[:, (k + 1) % 3]
        good &= measure(points[p], normals[p], points[q], normals[q]) <= longest
        good &= (normals[p] * normals[q]).sum(axis=1) >= TURN
    fit = np.ones(len(goes), dtype=bool)
    fit[mine[~good]] = False
    return fit & (_shared(ends, rank, onto, n) == 2)


def _has_area(triangles: Ints) -> Bools:
    """Return which triangles (t, 3) have three different corners; by columns, many times as quick as along the rows."""
    a, b, c = triangles.T
    return np.asarray((a != b) & (b != c) & (c != a))


def _shared(ends: Ints, rank: Ints, onto: Ints, n: int) -> Ints:
    """Return how many neighbours (k,) a point that goes has in common with the one it goes onto: two, or triangles would coincide."""
    keys = ends[:, 0] * n + ends[:, 1]
    out = np.vstack([ends, ends[:, ::-1]])
    out = out[rank[out[:, 0]] >= 0]
    k, v = rank[out[:, 0]], out[:, 1]
    wanted = np.minimum(onto[k], v) * n + np.maximum(onto[k], v)
    at = np.minimum(np.searchsorted(keys, wanted), len(keys) - 1)
    return np.bincount(k, keys[at] == wanted, minlength=len(onto)).astype(np.int64)


def _upright(points: Floats, normals: Floats, triangles: Ints) -> Bools:
    a, b, c = np.moveaxis(points[triangles], 1, 0)
    normal = unit(np.cross(b - a, c - a))
    return np.asarray((np.einsum("tk,tck->tc", normal, normals[triangles]) > SMOOTH).all(axis=1))
