"""A surface made ready for dropping cutters on it and for pushing them against it."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Floats, Ints
from trunnion.geometry.kernels import drop_compiled as kernel
from trunnion.geometry.kernels.drop import ROUND, A, C
from trunnion.geometry.kernels.push_compiled import push_loop
from trunnion.geometry.lattice import Lattice, lattice_of
from trunnion.progress import QUIET, Progress

CHUNK = 2000
"""Points between two looks at cancel."""
LINES, FIRST_ROOM = 20, 256
"""Lines between two looks at cancel, and spans that each has room for at first."""
FACETS_A_CELL = 2.0
"""How many facets a cell of the lattice holds on an even mesh."""
BLOCK = 8
"""Cells along each side of the squares that are looked at before their cells."""
CUTTERS = 4
"""Cutters that a surface remembers how its planes lift them."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class DropSurface:
    """Facets (t, 19) as `kernels/drop_compiled.py` names their columns, and the lattice that finds them.

    summit (cells,): how high the facets of each cell reach. planes: slopes along x and y and height over (0, 0) of planes that nothing is
    above of a facet, of a cell's facets, of a square of `BLOCK` by `BLOCK` cells, each (n, 3).
    """

    facets: Floats
    lattice: Lattice
    summit: Floats
    planes: tuple[Floats, Floats, Floats]
    _lifts: dict[bytes, tuple[Floats, Floats, Floats]] = field(init=False, repr=False, default_factory=dict)

    @staticmethod
    def of(points: Floats, triangles: Ints) -> DropSurface:
        """Return the surface of a mesh: points (v, 3), triangles (t, 3) rows of them; at least one triangle."""
        corners = np.asarray(points, dtype=np.float64)[triangles]
        facets = np.zeros((len(corners), kernel.FACET_COLUMNS))
        facets[:, :9] = corners.reshape(-1, 9)
        normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        up = normal[:, 2] != 0.0
        facets[up, kernel.GX:kernel.GY + 1] = -normal[up, :2] / normal[up, 2:]
        facets[:, kernel.STEEP] = np.hypot(facets[:, kernel.GX], facets[:, kernel.GY])
        facets[:, kernel.TURN] = normal[:, 2]
        low, high = corners.min(axis=1), corners.max(axis=1)
        facets[:, kernel.LOW_X:kernel.LOW_Y + 1], facets[:, kernel.HIGH_X:kernel.HIGH_Z + 1] = low[:, :2], high
        facets[:, kernel.OWNS] = _owned(triangles, len(points))
        pitch = float(np.sqrt(np.prod(high[:, :2].max(axis=0) - low[:, :2].min(axis=0)) * FACETS_A_CELL / len(corners)))
        lattice = lattice_of(low[:, :2], high[:, :2], max(pitch, tolerance.PLANE_REGION))
        cell = np.repeat(np.arange(int(lattice.shape.prod())), np.diff(lattice.start))
        summit = np.full(int(lattice.shape.prod()), -np.inf)
        np.maximum.at(summit, cell, high[lattice.rows, 2])
        return DropSurface(facets=facets, lattice=lattice, summit=summit, planes=_covers(facets, lattice, cell))

    def drop(self, points: Floats, pieces: Floats, lowest: float, progress: Progress = QUIET) -> Floats:
        """Return the height (n,) of a cutter's tip over plan points (n, 2) when it comes down and touches, at least `lowest`.

        `pieces` (p, 6) is the cutter's lower side as `kernels/drop.py` describes it. Points that follow a way are quicker than loose ones.
        """
        return self.touch(points, pieces, lowest, progress)[0]

    def touch(self, points: Floats, pieces: Floats, lowest: float, progress: Progress = QUIET) -> tuple[Floats, Ints, Floats]:
        """Return what `drop` does, the triangle (n,) that is touched at each point, and where (n, 3).

        Where two triangles meet it is one of them; over nothing that is higher than `lowest`, -1 and NaN.
        """
        n, g = len(points), self.lattice
        out, facet, contact = np.empty(n), np.empty(n, np.int64), np.empty((n, 3))
        points, lifts, roundness = np.ascontiguousarray(points, dtype=np.float64), self._lifted(pieces), _roundness(pieces)
        for first in range(0, n, CHUNK):
            progress.at(first / n, "Dropping the cutter")
            kernel.touch_loop(first, min(first + CHUNK, n), points, self.facets, g.low, g.pitch, g.shape, g.start, g.rows, self.summit,
                              BLOCK, *lifts, pieces, roundness, lowest, out, facet, contact)
        return out, facet, contact

    def push(self, lines: Floats, pieces: Floats, progress: Progress = QUIET) -> tuple[Ints, Floats]:
        """Return where the tip is blocked along lines (n, 2), each along x at a y and a z: start (n + 1,) into spans (k, 2) from x to x.

        The spans of a line are apart from each other and ascend. `pieces` as for `drop`.
        """
        found, g, room = [], self.lattice, FIRST_ROOM
        lines = np.ascontiguousarray(lines, dtype=np.float64)
        for first in range(0, len(lines), LINES):
            progress.at(first / len(lines), "Pushing the cutter")
            last = min(first + LINES, len(lines))
            count = np.zeros(len(lines), np.int64)
            spans = np.empty((last - first, room, 2))
            while not push_loop(first, last, lines, self.facets, g.low, g.pitch, g.shape, g.start, g.rows, pieces, count, spans):
                room *= 2
                spans = np.empty((last - first, room, 2))
            found += [_merged(spans[k, :count[first + k]]) for k in range(last - first)]
        return np.cumsum([0, *(len(f) for f in found)]), np.vstack([np.zeros((0, 2)), *found])

    def _lifted(self, pieces: Floats) -> tuple[Floats, Floats, Floats]:
        """Return how the planes lift a cutter, each (n, 6); remembered for the last few cutters."""
        key = pieces.tobytes()
        if key not in self._lifts:
            if len(self._lifts) >= CUTTERS:
                self._lifts.pop(next(iter(self._lifts)))
            made = tuple(np.empty((len(planes), kernel.LIFT_COLUMNS)) for planes in self.planes)
            for planes, lifts in zip(self.planes, made, strict=True):
                kernel.lift_loop(planes, pieces, lifts)
            self._lifts[key] = (made[0], made[1], made[2])
        return self._lifts[key]


def _roundness(pieces: Floats) -> float:
    """Return the least curvature (1/mm) of a lower side in any direction: 0 where any of it is straight, along or around the axis."""
    is_round = bool((pieces[:, ROUND] != 0.0).all() and (pieces[:, A] <= 0.0).all())
    return float(1.0 / pieces[:, C].max()) if is_round else 0.0


def _covers(facets: Floats, lattice: Lattice, cell: Ints) -> tuple[Floats, Floats, Floats]:
    """Return planes (n, 3) that nothing is above of each facet, each cell's facets (cell (k,) of each of the lattice's rows), and each
    square's: as steep as those are in the mean."""
    own = np.column_stack([facets[:, kernel.GX], facets[:, kernel.GY], np.zeros(len(facets))])
    upright = facets[:, kernel.TURN] == 0.0
    own[:, 2] = np.where(upright, np.inf, (facets[:, [2, 5, 8]] - own[:, :1] * facets[:, [0, 3, 6]]
                                           - own[:, 1:2] * facets[:, [1, 4, 7]]).max(axis=1))
    nx, ny = lattice.shape.tolist()
    blocks = -(-nx // BLOCK), -(-ny // BLOCK)
    block = (cell // nx // BLOCK) * blocks[0] + cell % nx // BLOCK
    return own, _cover(facets[lattice.rows], cell, nx * ny), _cover(facets[lattice.rows], block, blocks[0] * blocks[1])


def _cover(facets: Floats, group: Ints, n: int) -> Floats:
    """Return for each of n groups of facets (k, 19), group (k,), a plane (n, 3) that nothing of them is above."""
    # What looks down, the other side of a part, says nothing of how steep the side is that a cutter comes to, large as it may be.
    weight = np.maximum(facets[:, kernel.TURN], np.finfo(float).eps * np.abs(facets[:, kernel.TURN]))
    total = np.bincount(group, weight, n)
    out = np.zeros((n, 3))
    for column, slope in ((0, kernel.GX), (1, kernel.GY)):
        out[:, column] = np.divide(np.bincount(group, weight * facets[:, slope], n), total, out=np.zeros(n), where=total > 0.0)
    out[:, 2] = -np.inf
    for k in (0, 3, 6):
        np.maximum.at(out[:, 2], group, facets[:, k + 2] - out[group, 0] * facets[:, k] - out[group, 1] * facets[:, k + 1])
    return out


def _merged(spans: Floats) -> Floats:
    """Return spans (k, 2) in ascending order, those that meet as one."""
    spans = spans[np.argsort(spans[:, 0], kind="stable")]
    end = np.maximum.accumulate(spans[:, 1])
    begins = np.concatenate([[True], spans[1:, 0] > end[:-1]]) if len(spans) else np.zeros(0, bool)
    lasts = np.concatenate([begins[1:], [True]]) if len(spans) else begins
    return np.column_stack([spans[begins, 0], end[lasts]])


def _owned(triangles: Ints, n_points: int) -> Ints:
    """Return the bits of edges and corners that each triangle looks after: the first one that has them."""
    bits = np.zeros(len(triangles), dtype=np.int64)
    start, end = triangles.ravel(), triangles[:, [1, 2, 0]].ravel()
    edge = np.minimum(start, end) * n_points + np.maximum(start, end)
    for keys, first_bit in ((edge, 0), (start, 3)):
        firsts = np.unique(keys, return_index=True)[1]
        np.bitwise_or.at(bits, firsts // 3, 1 << (firsts % 3 + first_bit))
    return bits
