"""A surface made ready for dropping cutters on it and for pushing them against it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Floats, Ints
from trunnion.geometry.kernels import drop_compiled as kernel
from trunnion.geometry.kernels.push_compiled import push_loop
from trunnion.geometry.lattice import Lattice, lattice_of
from trunnion.progress import QUIET, Progress

CHUNK = 2000
"""Points between two looks at cancel."""
LINES, FIRST_ROOM = 20, 256
"""Lines between two looks at cancel, and spans that each has room for at first."""
FACETS_A_CELL = 2.0
"""How many facets a cell of the lattice holds on an even mesh."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class DropSurface:
    """Facets (t, 19) as `kernels/drop_compiled.py` names their columns, the lattice that finds them, and how high those of each of its
    cells reach (cells,)."""

    facets: Floats
    lattice: Lattice
    summit: Floats

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
        summit = np.full(int(lattice.shape.prod()), -np.inf)
        np.maximum.at(summit, np.repeat(np.arange(len(summit)), np.diff(lattice.start)), high[lattice.rows, 2])
        return DropSurface(facets=facets, lattice=lattice, summit=summit)

    def drop(self, points: Floats, pieces: Floats, lowest: float, progress: Progress = QUIET) -> Floats:
        """Return the height (n,) of a cutter's tip over plan points (n, 2) when it comes down and touches, at least `lowest`.

        `pieces` (p, 6) is the cutter's lower side as `kernels/drop.py` describes it.
        """
        out, g = np.empty(len(points)), self.lattice
        points = np.ascontiguousarray(points, dtype=np.float64)
        for first in range(0, len(points), CHUNK):
            progress.at(first / len(points), "Dropping the cutter")
            kernel.drop_loop(first, min(first + CHUNK, len(points)), points, self.facets, g.low, g.pitch, g.shape, g.start, g.rows,
                             self.summit, pieces, lowest, out)
        return out

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
