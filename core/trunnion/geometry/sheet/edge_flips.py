"""Edges of a sheet's triangles flipped towards Delaunay's condition in a measure: a field over triangles is as good as these are.

The two angles opposite an edge make no more than a half turn, which is to say that the sum of their cotangents is not negative (Lawson's
flips; for lengths in a measure: Fisher, Springborn, Schröder and Bobenko, An algorithm for the construction of intrinsic Delaunay
triangulations, 2007). Flips go round by round, in each one the worst of every triangle. A flipped edge keeps its row and only the edges of
flipped triangles are measured again, so that a round costs what it changes.
"""

from __future__ import annotations

import numpy as np

from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.sheet.sheet import SMOOTH, Measure, edges_of, unit
from trunnion.progress import NO_PROGRESS, Progress

ROUNDS = 12
"""Rounds of flips at most; after a few hardly any are left."""
OBTUSE = 0.05
"""Sum of cotangents that is still no obtuse pair: edges of points on a grid would flip for ever."""


def flipped(
    points: Floats,
    normals: Floats,
    triangles: Ints,
    face: Ints,
    measure: Measure,
    progress: Progress = NO_PROGRESS,
) -> Ints:
    """Return the triangles (t, 3) with edges flipped where their pairs of triangles are obtuse in a measure. Edges between faces, and those
    in bent or hollow quadrangles, stay; so do those of more than two triangles."""
    net = _Net(points, normals, triangles, face, measure)
    for _ in range(ROUNDS):
        progress.check()
        if not net.flip(net.worst()):
            break
    return net.triangles


class _Net:
    """Triangles with their edges: `ends` (e, 2) lower point first, `side` (t, 3) the edges of the triangles' sides, `half` (e, 2) the sides
    (3 t + k) of an edge, `cotangent` (t, 3) of the angles opposite the sides, `lean` (e,) their sum at edges that may be flipped."""

    def __init__(
        self, points: Floats, normals: Floats, triangles: Ints, face: Ints, measure: Measure
    ) -> None:
        self.points, self.normals, self.measure = points, normals, measure
        self.triangles = triangles.copy()
        self.ends, self.side = edges_of(triangles, len(points))
        self.half = _halves(self.side, len(self.ends))
        inner = np.flatnonzero((self.half >= 0).all(axis=1))
        one, two = self.half[inner].T // 3
        self.may_flip = np.zeros(len(self.ends), dtype=bool)
        self.may_flip[inner] = face[one] == face[two]
        # Keys of edges as they were at first, in ascending order, those that are gone, and those that came.
        self.first_keys = self._keys(*self.ends.T)
        self.gone = np.zeros(len(self.first_keys), dtype=bool)
        self.come = np.zeros(0, dtype=np.int64)
        self.square, self.cotangent = np.zeros(len(self.ends)), np.zeros(self.side.shape)
        self.lean = np.zeros(len(self.ends))
        self._measured(np.arange(len(self.ends)), np.arange(len(triangles)))

    def _keys(self, a: Ints, b: Ints) -> Ints:
        return np.asarray(np.minimum(a, b) * len(self.points) + np.maximum(a, b))

    def _measured(self, edges: Ints, changed: Ints) -> None:
        """Measure edges (k,) anew, then the angles of the triangles (m,) that changed, then how obtuse the pairs at their edges are."""
        a, b = self.ends[edges].T
        self.square[edges] = (
            self.measure(self.points[a], self.normals[a], self.points[b], self.normals[b]) ** 2
        )
        square = self.square[self.side[changed]]
        total = square.sum(axis=1, keepdims=True)
        # Four times the area, by Heron's formula; a triangle that is none in this measure is as slim as may be.
        four = np.sqrt(
            np.maximum(total**2 - 2.0 * (square**2).sum(axis=1, keepdims=True), 1e-24 * total**2)
        )
        self.cotangent[changed] = (total - 2.0 * square) / four
        is_around = np.zeros(len(self.ends), dtype=bool)
        is_around[self.side[changed]] = True
        around = np.flatnonzero(is_around & self.may_flip)
        low, high = np.sort(self.half[around], axis=1).T
        self.lean[around] = self.cotangent.ravel()[low] + self.cotangent.ravel()[high]

    def worst(self) -> Ints:
        """Return the edges (k,) of obtuse pairs that are the most obtuse of both their triangles."""
        wrong = np.flatnonzero(self.may_flip & (self.lean < -OBTUSE))
        wrong = wrong[np.argsort(self._keys(*self.ends[wrong].T))]
        rank = np.empty(len(wrong), dtype=np.int64)
        rank[np.argsort(self.lean[wrong], kind="stable")] = np.arange(len(wrong))
        one, two = self.half[wrong].T // 3
        first = np.full(len(self.triangles), len(wrong))
        np.minimum.at(first, one, rank)
        np.minimum.at(first, two, rank)
        return np.asarray(wrong[(first[one] == rank) & (first[two] == rank)])

    def flip(self, edges: Ints) -> bool:
        """Flip those of edges (k,), no two of them of one triangle, whose quadrangle is neither bent nor hollow; return whether any was."""
        one, two = np.sort(self.half[edges], axis=1).T
        (a, b, c), d = (self._corner(one, k) for k in range(3)), self._corner(two, 2)
        made = np.column_stack([a, d, c]), np.column_stack([d, b, c])
        good = self._is_new(c, d)
        good &= self._is_upright(made[0]) & self._is_upright(made[1])
        if not good.any():
            return False
        edges, one, two, c, d = (x[good] for x in (edges, one, two, c, d))
        t, u = one // 3, two // 3
        # The sides of both triangles, and where they are after the flip: a to d, d to c (the edge), c to a; d to b, b to c, c to d.
        outer = [self._side_at(two, 1), self._side_at(one, 2), self._side_at(two, 2)]
        outer.append(self._side_at(one, 1))
        moves = [(two, 1, 3 * t), (one, 2, 3 * t + 2), (two, 2, 3 * u), (one, 1, 3 * u + 1)]
        moved = [
            (edge, self.half[edge, 0] == 3 * (old // 3) + (old + k) % 3, new)
            for edge, (old, k, new) in zip(outer, moves, strict=True)
        ]
        for edge, is_first, new in moved:
            self.half[edge, np.where(is_first, 0, 1)] = new
            self.side.ravel()[new] = edge
        self.half[edges] = np.column_stack([3 * t + 1, 3 * u + 2])
        self.side[t, 1] = self.side[u, 2] = edges
        self.triangles[t], self.triangles[u] = made[0][good], made[1][good]
        self._renamed(edges, c, d)
        self._measured(edges, np.concatenate([t, u]))
        return True

    def _corner(self, half: Ints, k: int) -> Ints:
        return np.asarray(self.triangles[half // 3, (half + k) % 3])

    def _side_at(self, half: Ints, k: int) -> Ints:
        return np.asarray(self.side[half // 3, (half + k) % 3])

    def _renamed(self, edges: Ints, c: Ints, d: Ints) -> None:
        """Let edges (k,) run from points c (k,) to d."""
        old = self._keys(*self.ends[edges].T)
        at = np.minimum(np.searchsorted(self.first_keys, old), len(self.first_keys) - 1)
        was_first = self.first_keys[at] == old
        self.gone[at[was_first]] = True
        # Both are in order: a stable sort merges them.
        left = self.come[~_are_in(self.come, np.sort(old))]
        self.come = np.sort(np.concatenate([left, np.sort(self._keys(c, d))]), kind="stable")
        self.ends[edges] = np.column_stack([np.minimum(c, d), np.maximum(c, d)])

    def _is_new(self, c: Ints, d: Ints) -> Bools:
        """Return whether no edge runs between points c (k,) and d, and none that comes before it in the same order would."""
        keys = self._keys(c, d)
        at = np.minimum(np.searchsorted(self.first_keys, keys), len(self.first_keys) - 1)
        known = (self.first_keys[at] == keys) & ~self.gone[at]
        first = np.zeros(len(keys), dtype=bool)
        first[np.unique(keys, return_index=True)[1]] = True
        return np.asarray(first & ~known & ~_are_in(keys, self.come))

    def _is_upright(self, triangles: Ints) -> Bools:
        """Return which triangles (k, 3) face, all but a little, as the faces do at their corners."""
        a, b, c = np.moveaxis(self.points[triangles], 1, 0)
        normal = unit(np.cross(b - a, c - a))
        facing = np.einsum("tk,tck->tc", normal, self.normals[triangles])
        return np.asarray((facing > SMOOTH).all(axis=1))


def _are_in(keys: Ints, ordered: Ints) -> Bools:
    """Return which keys (k,) are among others (n,) in ascending order."""
    if not len(ordered):
        return np.zeros(len(keys), dtype=bool)
    at = np.minimum(np.searchsorted(ordered, keys), len(ordered) - 1)
    return np.asarray(ordered[at] == keys)


def _halves(side: Ints, count: int) -> Ints:
    """Return for each of `count` edges both sides (e, 2) of triangles that it is, rows of the flat sides (3 t,); -1 where it is one's or
    more than two's."""
    flat = side.ravel()
    order, uses = np.argsort(flat, kind="stable"), np.bincount(flat, minlength=count)
    start, twice = np.cumsum(uses) - uses, uses == 2
    half = np.full((count, 2), -1)
    half[twice] = np.column_stack([order[start[twice]], order[start[twice] + 1]])
    return half
