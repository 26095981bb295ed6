"""A surface made ready for dropping cutters on it and for pushing them against it."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.kernels.cutter_contact import drop_cutter_compiled as kernel
from trunnion.geometry.kernels.cutter_contact.drop_bvh import (
    BOX_COLUMNS,
    bvh_bounds_loop,
    bvh_sort_loop,
)
from trunnion.geometry.kernels.cutter_contact.drop_cutter import ROUND, A, C
from trunnion.geometry.kernels.cutter_contact.free_run_compiled import free_run_loop
from trunnion.geometry.kernels.cutter_contact.push_cutter_compiled import push_cutter_loop
from trunnion.geometry.lattice import Lattice, lattice_of
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.threads import in_parallel

CHUNK = 2000
"""Points that a thread drops the cutter on before it takes the next ones."""
LINES, FIRST_CAPACITY = 20, 256
"""Lines between two looks at cancel, and spans that each has room for at first."""
FACETS_A_LEAF = 2
"""How many facets the last nodes of a tree hold, or up to twice as many."""
FACETS_A_CELL = 2.0
"""How many facets a cell of the lattice that pushing looks at holds on an even mesh."""
STEEPEST = 100.0
"""Slope of the steepest plane over several facets: with more, digits of its height are lost."""
CUTTERS = 4
"""Cutters that a surface remembers how its planes lift them."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class DropSurface:
    """Facets (t, 19) as `kernels/drop_cutter_compiled.py` names their columns, and the tree that finds them.

    row (t,): which triangle each facet is; start (leaves + 1,) and boxes (nodes, 5) as `kernels/drop_bvh.py` describes them; planes:
    slopes along x and y and height over (0, 0) of planes that nothing is above of a node's facets (nodes, 3), and of a facet (t, 3).
    `avoid` (k, 5): boxes in plan, x and y of both corners, and the height below which no dropped tip goes inside them.
    """

    facets: Floats
    row: Ints
    start: Ints
    boxes: Floats
    planes: tuple[Floats, Floats]
    avoid: Floats = field(default_factory=lambda: np.zeros((0, 5)))
    _lifts: dict[bytes, _Lifts] = field(init=False, repr=False, default_factory=dict)
    _lattice: list[Lattice] = field(init=False, repr=False, default_factory=list)

    @staticmethod
    def of(points: Floats, triangles: Ints) -> DropSurface:
        """Return the surface of a mesh: points (v, 3), triangles (t, 3) rows of them; at least one triangle."""
        corners = np.asarray(points, dtype=np.float64)[triangles]
        leaves = 1 << int(math.log2(max(len(corners) / FACETS_A_LEAF, 1.0)))
        start = np.arange(leaves + 1) * len(corners) // leaves
        row = np.arange(len(corners))
        bvh_sort_loop(corners.mean(axis=1), start, row)
        facets = _facets(corners[row], _owned(triangles, len(points))[row])
        own = np.column_stack([facets[:, kernel.GX], facets[:, kernel.GY], np.zeros(len(facets))])
        own[:, 2] = np.where(
            facets[:, kernel.TURN] == 0.0,
            np.inf,
            (
                facets[:, [2, 5, 8]]
                - own[:, :1] * facets[:, [0, 3, 6]]
                - own[:, 1:2] * facets[:, [1, 4, 7]]
            ).max(axis=1),
        )
        boxes, planes = np.empty((2 * leaves - 1, BOX_COLUMNS)), np.zeros((2 * leaves - 1, 3))
        planes[:, :2] = _slopes(facets, start)
        bvh_bounds_loop(facets[:, :9], start, boxes, planes)
        return DropSurface(facets=facets, row=row, start=start, boxes=boxes, planes=(planes, own))

    def drop(
        self,
        points: Floats,
        pieces: Floats,
        lowest: float | Floats,
        progress: Progress = NO_PROGRESS,
        highest: float | Floats = np.inf,
    ) -> Floats:
        """Return the height (n,) of a cutter's tip over plan points (n, 2) when it comes down and touches, at least `lowest`, a height for
        all or for each (n,), and at most `highest`, which is quicker where it is touched higher than that.

        `pieces` (p, 6) is the cutter's lower side as `kernels/drop_cutter.py` describes it. Points that follow a
        path are quicker than loose ones. Inside boxes that are avoided it is at least their height.
        """
        height = self._found(points, pieces, lowest, highest, progress)[0]
        if len(self.avoid):
            height = np.maximum(height, tops_over(points, self.avoid))
        return np.minimum(height, highest)

    def contacts(
        self,
        points: Floats,
        pieces: Floats,
        lowest: float | Floats,
        progress: Progress = NO_PROGRESS,
    ) -> tuple[Floats, Ints, Floats]:
        """Return what `drop` does, with no box avoided, the triangle (n,) that is touched at each point, and where (n, 3).

        Where two triangles meet it is one of them; over nothing that is higher than `lowest`, -1 and NaN.
        """
        return self._found(points, pieces, lowest, np.inf, progress)

    def _found(
        self,
        points: Floats,
        pieces: Floats,
        lowest: float | Floats,
        highest: float | Floats,
        progress: Progress,
    ) -> tuple[Floats, Ints, Floats]:
        """Return what `contacts` does; where the height is no less than `highest`, any touch that is as high."""
        n = len(points)
        out, facet, contact = np.empty(n), np.empty(n, np.int64), np.empty((n, 3))
        points = np.ascontiguousarray(points, dtype=np.float64)
        lifts = self._lifted(pieces, n > CHUNK)
        floor, ceiling = (np.full(n, v, dtype=np.float64) for v in (lowest, highest))

        def work(first: int, last: int) -> None:
            kernel.drop_cutter_loop(
                first,
                last,
                points,
                self.facets,
                self.start,
                self.boxes,
                *self.planes,
                *lifts,
                pieces,
                _ball(pieces),
                floor,
                ceiling,
                out,
                facet,
                contact,
            )

        in_parallel(work, n, CHUNK, progress, "Dropping the cutter")
        return out, np.where(facet >= 0, self.row[facet], -1), contact

    def free_run(
        self,
        points: Floats,
        direction: Floats,
        height: Floats,
        most: Floats,
        pieces: Floats,
        close: float,
        progress: Progress = NO_PROGRESS,
    ) -> tuple[Floats, Bools]:
        """Return how far (n,) tips over plan points (n, 2) at heights (n,) go along unit directions (n, 2) until nothing blocks them, no
        more than `close` mm farther than they need, and whether they were blocked and come free within distances (n,); 0 where not.

        `pieces` as for `drop`; no box is avoided. Points that follow a path are quicker than loose ones.
        """
        n = len(points)
        out, found = np.empty(n), np.empty(n, dtype=bool)
        points, direction, height, most = (
            np.ascontiguousarray(v, dtype=np.float64) for v in (points, direction, height, most)
        )
        lifts = self._lifted(pieces, n > CHUNK)

        def work(first: int, last: int) -> None:
            free_run_loop(
                first,
                last,
                points,
                direction,
                height,
                most,
                close,
                self.facets,
                self.start,
                self.boxes,
                *self.planes,
                *lifts,
                pieces,
                _ball(pieces),
                out,
                found,
            )

        in_parallel(work, n, CHUNK, progress, "Pushing the cutter")
        return out, found

    def push(
        self, lines: Floats, pieces: Floats, progress: Progress = NO_PROGRESS
    ) -> tuple[Ints, Floats]:
        """Return where the tip is blocked along lines (n, 2), each along x at a y and a z: start (n + 1,) into spans (k, 2) from x to x.

        The spans of a line are apart from each other and ascend. `pieces` as for `drop`.
        """
        found, g, capacity = [], self._cells(), FIRST_CAPACITY
        lines = np.ascontiguousarray(lines, dtype=np.float64)
        for first in range(0, len(lines), LINES):
            progress.at(first / len(lines), "Pushing the cutter")
            last = min(first + LINES, len(lines))
            count = np.zeros(len(lines), np.int64)
            spans = np.empty((last - first, capacity, 2))
            while not push_cutter_loop(
                first,
                last,
                lines,
                self.facets,
                g.low,
                g.pitch,
                g.shape,
                g.start,
                g.rows,
                pieces,
                count,
                spans,
            ):
                capacity *= 2
                spans = np.empty((last - first, capacity, 2))
            found += [_merged(spans[k, : count[first + k]]) for k in range(last - first)]
        return np.cumsum([0, *(len(f) for f in found)]), np.vstack([np.zeros((0, 2)), *found])

    def _cells(self) -> Lattice:
        """Return the lattice over the facets' boxes; made on first use."""
        if not self._lattice:
            low, high = (
                self.facets[:, kernel.LOW_X : kernel.LOW_Y + 1],
                self.facets[:, kernel.HIGH_X : kernel.HIGH_Y + 1],
            )
            pitch = float(
                np.sqrt(np.prod(high.max(axis=0) - low.min(axis=0)) * FACETS_A_CELL / len(low))
            )
            self._lattice.append(lattice_of(low, high, max(pitch, tolerance.PLANE_REGION)))
        return self._lattice[0]

    def _lifted(self, pieces: Floats, whole: bool) -> tuple[Floats, Floats]:
        """Return how the planes lift a cutter, each (n, 8); remembered for the last few cutters.

        The `whole` of them is worked out at once, for threads to read. Else the kernel fills rows that are all 0 when it meets them: a few
        hundred points meet a small share of a part's triangles.
        """
        key = pieces.tobytes()
        if key not in self._lifts:
            if len(self._lifts) >= CUTTERS:
                self._lifts.pop(next(iter(self._lifts)))
            nodes, own = (np.zeros((len(p), kernel.LIFT_COLUMNS)) for p in self.planes)
            self._lifts[key] = _Lifts(nodes, own)
        kept = self._lifts[key]
        if whole and not kept.is_whole:
            for planes, lifts in zip(self.planes, (kept.nodes, kept.own), strict=True):
                kernel.plane_lift_loop(planes, pieces, lifts)
            kept.is_whole = True
        return kept.nodes, kept.own


@dataclass(slots=True)
class _Lifts:
    """How the planes of a tree's nodes (nodes, 8) and of its facets (t, 8) lift a cutter, and whether every row has been worked out."""

    nodes: Floats
    own: Floats
    is_whole: bool = False


def _ball(pieces: Floats) -> float:
    """Return the radius of a lower side that is a ball's; 0 for others."""
    return (
        float(pieces[0, C])
        if len(pieces) == 1 and pieces[0, ROUND] != 0.0 and pieces[0, A] == 0.0
        else 0.0
    )


def _facets(corners: Floats, owned: Ints) -> Floats:
    """Return the rows (t, 19) of triangles (t, 3, 3)."""
    facets = np.zeros((len(corners), kernel.FACET_COLUMNS))
    facets[:, :9] = corners.reshape(-1, 9)
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    up = normal[:, 2] != 0.0
    facets[up, kernel.GX : kernel.GY + 1] = -normal[up, :2] / normal[up, 2:]
    facets[:, kernel.STEEP] = np.hypot(facets[:, kernel.GX], facets[:, kernel.GY])
    facets[:, kernel.TURN] = normal[:, 2]
    facets[:, kernel.LOW_X : kernel.LOW_Y + 1], facets[:, kernel.HIGH_X : kernel.HIGH_Z + 1] = (
        corners.min(axis=1)[:, :2],
        corners.max(axis=1),
    )
    facets[:, kernel.OWNS] = owned
    return facets


def _slopes(facets: Floats, start: Ints) -> Floats:
    """Return the slopes (nodes, 2) along x and y of a tree's nodes: those of their facets in the mean, seen from above."""
    # What looks down, the other side of a part, says nothing of how steep the side is that a cutter comes to, large as it may be.
    weight = np.maximum(
        facets[:, kernel.TURN], np.finfo(float).eps * np.abs(facets[:, kernel.TURN])
    )
    sums = [
        np.add.reduceat(
            weight[:, None]
            * np.column_stack([np.ones(len(facets)), facets[:, kernel.GX : kernel.GY + 1]]),
            start[:-1],
        )
    ]
    while len(sums[-1]) > 1:
        sums.append(sums[-1][::2] + sums[-1][1::2])
    total = np.concatenate(sums[::-1])
    slopes = np.divide(
        total[:, 1:], total[:, :1], out=np.zeros((len(total), 2)), where=total[:, :1] > 0.0
    )
    size = np.hypot(slopes[:, 0], slopes[:, 1])[:, None]
    return np.asarray(
        slopes * np.divide(STEEPEST, size, out=np.ones_like(size), where=size > STEEPEST)
    )


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


def tops_over(points: Floats, boxes: Floats, around: float = 0.0) -> Floats:
    """Return the height (n,) of the highest box (k, 5), as `DropSurface.avoid` has them, over plan points (n, 2); -inf outside all. Each
    box is wider by `around` mm on every side."""
    top = np.full(len(points), -np.inf)
    for x0, y0, x1, y1, height in boxes:
        x, y = points[:, 0], points[:, 1]
        inside = (x > x0 - around) & (x < x1 + around) & (y > y0 - around) & (y < y1 + around)
        top[inside] = np.maximum(top[inside], height)
    return top
