"""Fields over a sheet in a metric of its own: distances from a line, a blend between two lines, turns about a tube.

A metric is given by the lengths of the sheet's edges; where these are stepovers, a distance counts passes. The blend is the function
that is 0 on one line and 1 on the other and of all these has the least energy of its slope's power: with 2 it is harmonic and crowds
where lines come together, with higher powers its steps grow more even (the limit spaces them evenly along every way from line to line).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.sparse import coo_matrix, csr_matrix
from scipy.sparse.csgraph import dijkstra
from scipy.sparse.linalg import splu

from trunnion.geometry.arrays import Floats, Ints
from trunnion.geometry.kernels.shortest_paths import fast_marching_compiled as kernel
from trunnion.geometry.sheet.sheet import Sheet
from trunnion.progress import NO_PROGRESS, Progress

POWERS = (2.0, 3.0, 4.0, 4.0, 6.0, 6.0, 6.0)
"""Powers of the slope, one after the other: each begins where the one before ended."""
BEYOND = 0.05
"""How far a blend may go past the values of its guides."""
PIVOT = 0.01
"""Share of a column's largest entry from which on its diagonal is taken as the pivot: rows keep their symmetric order."""
FLATTEST = 1e-3
"""Slope, as a share of the middle one, below which a triangle's weight falls no further: a weight of nothing can't be solved for."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Metric:
    """A sheet and the lengths (t, 3) of its triangles' sides, from corner k to the next one, in whatever unit steps are counted."""

    sheet: Sheet
    lengths: Floats

    @staticmethod
    def of(sheet: Sheet, edge_lengths: Floats) -> Metric:
        """Return the metric in which edges, as `Sheet.edges` has them, have lengths (e,)."""
        return Metric(sheet=sheet, lengths=np.ascontiguousarray(edge_lengths[sheet.edges()[1]]))

    def slope(self, field: Floats, turns: Ints | None = None) -> Floats:
        """Return how much a field (v,) changes for a step of length one in each triangle (t,); `turns` as for `whole_levels`."""
        cot, area = self._cotangents()
        rise = self._rise(field, turns)
        return np.sqrt(np.maximum((cot * rise * rise).sum(axis=1) / (2.0 * area), 0.0))

    def area(self) -> Floats:
        """Return the areas of the triangles (t,) in this metric."""
        return self._cotangents()[1]

    def _rise(self, field: Floats, turns: Ints | None) -> Floats:
        value = field[self.sheet.triangles] + (0 if turns is None else turns)
        return np.asarray(value[:, [1, 2, 0]] - value)

    def _cotangents(self) -> tuple[Floats, Floats]:
        """Return the cotangents (t, 3) of the angles opposite the sides, and the areas (t,)."""
        square = self.lengths**2
        total = square.sum(axis=1)
        four = np.sqrt(np.maximum(total**2 - 2.0 * (square**2).sum(axis=1), 1e-12 * total**2))
        return (total[:, None] - 2.0 * square) / four[:, None], four / 4.0

    def stiffness(self, weight: Floats) -> csr_matrix:
        """Return the matrix (v, v) whose quadratic form is the energy of slopes with weights (t,)."""
        cot = 0.5 * weight[:, None] * self._cotangents()[0]
        a, b = self.sheet.triangles, self.sheet.triangles[:, [1, 2, 0]]
        rows, columns = (
            np.concatenate([x.ravel() for x in p]) for p in ((a, b, a, b), (b, a, a, b))
        )
        values = np.concatenate([-cot.ravel(), -cot.ravel(), cot.ravel(), cot.ravel()])
        n = len(self.sheet.points)
        return coo_matrix((values, (rows, columns)), shape=(n, n)).tocsr()


def distances(
    metric: Metric, rows: Ints, times: Floats | float = 0.0, farthest: float = np.inf
) -> tuple[Floats, Floats]:
    """Return how far all points are from some, by rows, that have distances of their own: (v,), and the position (v, 3) each came from.

    Distances are true along the surface to a few hundredths of an edge; farther than `farthest` they are infinite.
    """
    sheet = metric.sheet
    points, sizes = kernel.stencils(sheet.triangles, metric.lengths, beyond(sheet))
    named = points[:, 1:].ravel()
    order = np.argsort(named, kind="stable")
    start = np.concatenate([[0], np.cumsum(np.bincount(named, minlength=len(sheet.points)))])
    time, foot = np.full(len(sheet.points), np.inf), sheet.points.copy()
    np.minimum.at(time, rows, np.broadcast_to(times, len(rows)))
    kernel.fast_march(points, sizes, start, order // 2, time, foot, farthest)
    return time, foot


def beyond(sheet: Sheet) -> Ints:
    """Return for each side (t, 3) of the triangles the side on its other side, 3 * triangle + side, -1: none."""
    n = len(sheet.points)
    start, end = sheet.triangles.ravel(), sheet.triangles[:, [1, 2, 0]].ravel()
    key, other = start * n + end, end * n + start
    order = np.argsort(key, kind="stable")
    at = np.minimum(np.searchsorted(key[order], other), len(key) - 1)
    return np.where(key[order][at] == other, order[at], -1).reshape(-1, 3)


def blend(metric: Metric, zero: Ints, one: Ints, progress: Progress = NO_PROGRESS) -> Floats:
    """Return the field (v,) that goes from 0 at some points to 1 at others in steps as even as the sheet allows."""
    n = len(metric.sheet.points)
    field, fixed = np.zeros(n), np.zeros(n, bool)
    field[one] = 1.0
    fixed[zero], fixed[one] = True, True
    weight, free = np.ones(len(metric.sheet.triangles)), np.flatnonzero(~fixed)
    even = field.copy()
    for turn, power in enumerate(POWERS if len(free) else ()):
        progress.at(turn / len(POWERS), "Laying flow lines")
        matrix = metric.stiffness(weight)[free]
        try:
            solve = _factorized(matrix[:, free])
        except RuntimeError:
            # Weights that ran away on folded triangles leave nothing to solve: the blend of less power is taken.
            if not turn:
                raise
            break
        wanted = solve(-(matrix[:, np.flatnonzero(fixed)] @ field[fixed]))
        field[free] += (wanted - field[free]) / (power - 1.0)
        slope = metric.slope(field)
        middle = float(np.median(slope))
        weight = np.maximum(slope / middle, FLATTEST) ** (
            POWERS[min(turn + 1, len(POWERS) - 1)] - 2.0
        )
        even = field.copy() if _is_between(field) else even
    return np.asarray(np.clip(even, 0.0, 1.0))


def _factorized(matrix: csr_matrix) -> Callable[[Floats], Floats]:
    """Return what solves for a symmetric matrix: its LU factors, ordered for one (minimum degree of A + A^T), which fill up less.

    Raises `RuntimeError` for a singular one.
    """
    solve: Callable[[Floats], Floats] = splu(
        matrix.tocsc(),
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=PIVOT,
        options={"SymmetricMode": True},
    ).solve
    return solve


def _is_between(field: Floats) -> bool:
    """Return whether a blend keeps the maximum principle: no value beyond those at the guides, but for what obtuse triangles may add.

    On a folded or nearly flat triangle the powers of the slope run away; a blend of less power is taken then.
    """
    return bool(np.isfinite(field).all() and np.abs(field - 0.5).max(initial=0.0) <= 0.5 + BEYOND)


def turns_about(metric: Metric, first: Ints, second: Ints) -> tuple[Floats, Ints]:
    """Return the field (v,) and the turns (t, 3) of its corners, which together grow by one on each way round a tube between two rims.

    `first` and `second`: the rims' points. Growing goes against the way of the first rim, anticlockwise seen from outside of its sheet.
    """
    sheet = metric.sheet
    cut = _path_between(sheet, first, second)
    turns = _left_of(sheet, cut)
    matrix = metric.stiffness(np.ones(len(sheet.triangles)))
    cot, _ = metric._cotangents()
    rise = turns[:, [1, 2, 0]] - turns
    push = np.zeros(len(sheet.points))
    np.add.at(push, sheet.triangles, 0.5 * cot * rise)
    np.add.at(push, sheet.triangles[:, [1, 2, 0]], -0.5 * cot * rise)
    field = np.zeros(len(sheet.points))
    rest = np.delete(np.arange(len(field)), cut[0])
    field[rest] = _factorized(matrix[rest][:, rest])(push[rest])
    return field, turns


def _path_between(sheet: Sheet, first: Ints, second: Ints) -> list[int]:
    """Return the points of a shortest way over edges from one rim to another."""
    ends, _ = sheet.edges()
    size = np.linalg.norm(sheet.points[ends[:, 0]] - sheet.points[ends[:, 1]], axis=1)
    graph = coo_matrix((size, ends.T), shape=(len(sheet.points),) * 2).tocsr()
    away, before, _ = dijkstra(
        graph, directed=False, indices=first, min_only=True, return_predecessors=True
    )
    path = [int(second[np.argmin(away[second])])]
    while before[path[-1]] >= 0:
        path.append(int(before[path[-1]]))
    return path[::-1]


def _left_of(sheet: Sheet, path: list[int]) -> Ints:
    """Return 1 for the corners (t, 3) on a way from rim to rim of the triangles on its left, 0 for all others."""
    turns, across = np.zeros(sheet.triangles.shape, np.int64), beyond(sheet)
    steps = set(pairwise(path))
    on_path = np.isin(sheet.triangles, path)
    touching = {v: np.flatnonzero((sheet.triangles == v).any(axis=1)).tolist() for v in path}
    for v in path:
        # Around a point, what hangs together with a triangle on the left without crossing the way is on the left.
        mine, left = touching[v], set()
        sides = {
            t: [
                (int(sheet.triangles[t, k]), int(sheet.triangles[t, (k + 1) % 3])) for k in range(3)
            ]
            for t in mine
        }
        todo = [t for t in mine if any(side in steps and v in side for side in sides[t])]
        while todo:
            t = todo.pop()
            if t in left:
                continue
            left.add(t)
            for k, (a, b) in enumerate(sides[t]):
                other = int(across[t, k]) // 3
                if (
                    v in (a, b)
                    and across[t, k] >= 0
                    and (a, b) not in steps
                    and (b, a) not in steps
                ):
                    todo.append(other)
        rows = np.array(sorted(left), dtype=np.int64)
        turns[rows] |= (sheet.triangles[rows] == v) & on_path[rows]
    return turns
