"""The cutting moves of a setup made ready for questions about points: how near what cuts comes to each, and which move comes nearest.

Level and upright moves of plain cutters are listed by plan cells; ramps, helices, other forms and leaning or turning axes are spans in a
tree of poses (`kernels/residual.py`). Distances are exact but for the bound of what has no closed form.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats, Ints, items_of
from trunnion.model.tool import PLAIN_FORMS
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.threads import in_parallel
from trunnion.verify.contact import Grid, grid_of
from trunnion.verify.cutter import Bodies
from trunnion.verify.kernels import body
from trunnion.verify.kernels import residual as kernel
from trunnion.verify.kernels.contact import strips as columns
from trunnion.verify.kernels.residual import Flutes, SpanTree
from trunnion.verify.motion import Moves

CELL = 4.0
"""mm, pitch of the cells: a few samples each, and few enough cells a move."""
CHUNK = 400
"""Samples between two looks at cancel."""
SPAN = 8.0
"""mm that a point of the cutter moves in one span of the tree: longer ones are met by too many points that they don't touch."""
MOST_SPANS = 64
"""Most spans of one move, so that memory stays linear in moves."""
RESIDUAL_BOUND = tolerance.CONTACT_BOUND / 4
"""How much smaller than reported a distance may be, mm."""
FAR_BOUND = 0.01
"""The same for distances beyond what is listed by cells: nothing is finished there, and mean and largest are reported in hundredths."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class BlockResidual:
    """Material left by each of n moves on the samples whose nearest move it is: smallest, mean (by area) and largest (n,) mm, NaN without
    samples, and how many there are (n,)."""

    least: Floats
    mean: Floats
    most: Floats
    count: Ints


@dataclass(frozen=True, slots=True, eq=False)
class Sweep:
    """The feed moves of a setup, made ready for questions about points.

    `near` is how far beside a cutter its move is still listed by cells, mm; `bound` how much smaller than reported a distance may be.
    """

    moves: Moves
    cutter: Floats
    low: Floats
    grid: Grid
    tree: SpanTree
    flutes: Flutes
    near: float
    bound: float

    @staticmethod
    def of(moves: Moves, near: float, bound: float = RESIDUAL_BOUND) -> Sweep:
        """Return the sweep of a setup's feed moves."""
        cutter = moves.cutters
        low = np.minimum(moves.row[:, columns.Z_START], moves.row[:, columns.Z_END])
        plain, feeds = _in_plan(moves), ~moves.rapid
        listed = np.flatnonzero(feeds & plain)
        order = listed[np.argsort(low[listed], kind="stable")]
        boxes = kernel.move_boxes(moves.row, cutter[:, 0] + near)
        grid = grid_of(boxes, CELL, order) if len(order) else grid_of(boxes[:0], CELL)
        flutes = flutes_of(moves)
        return Sweep(
            moves,
            cutter,
            low,
            grid,
            tree_of(moves, np.flatnonzero(feeds & ~plain), flutes),
            flutes,
            near,
            bound,
        )

    def residual(
        self, points: Floats, most: Floats, progress: Progress = NO_PROGRESS, threads: int = 0
    ) -> tuple[Floats, Ints]:
        """Return the smallest signed distance (s,) of points (s, 3) to what cuts over all feed moves, and the move (-1: none).

        Distances above `most` (s,) come back as it. Those above `near` are within `FAR_BOUND` where an upright move is nearest.
        """
        residual, nearest = np.array(most, dtype=np.float64), np.full(len(points), -1)
        points, g = np.ascontiguousarray(points, dtype=np.float64), self.grid
        # Neighbours in plan look at the same moves: visiting them together keeps those in the cache.
        order = progress.aside(lambda _: _by_cell(points, g), "Measuring material left")

        def some(first: int, last: int) -> None:
            kernel.residual_loop(
                first,
                last,
                points,
                order,
                self.moves.row,
                self.cutter,
                self.low,
                g.start,
                g.rows,
                g.frame,
                g.shape,
                self.tree,
                self.flutes,
                self.bound,
                residual,
                nearest,
            )

        in_parallel(
            some, len(points), CHUNK, progress.part(0.0, 0.7), "Measuring material left", threads
        )
        self._look_further(
            points,
            order[residual[order] > self.near],
            residual,
            nearest,
            progress.part(0.7, 1.0),
            threads,
        )
        return residual, nearest

    def _look_further(
        self,
        points: Floats,
        rows: Ints,
        residual: Floats,
        nearest: Ints,
        progress: Progress,
        threads: int,
    ) -> None:
        """Lower what is left on points further from everything than `near`, by moves that their cells don't list."""
        listed = np.unique(self.grid.rows)
        if not len(rows) or not len(listed):
            return
        tree = progress.aside(lambda _: tree_of(self.moves, listed, self.flutes))

        def some(first: int, last: int) -> None:
            kernel.residual_bvh_loop(
                first,
                last,
                points,
                rows,
                tree,
                self.flutes,
                max(FAR_BOUND, self.bound),
                residual,
                nearest,
            )

        in_parallel(some, len(rows), CHUNK, progress, "Measuring material left", threads)

    def cut_before(
        self, points: Floats, move: int | Ints, progress: Progress = NO_PROGRESS, threads: int = 0
    ) -> Bools:
        """Return for each point (s, 3) whether a feed move before a row, one for all or each point's own (s,), has removed it.

        Upright plain cutters also remove all above.
        """
        out, g = np.zeros(len(points), bool), self.grid
        points = np.ascontiguousarray(points, dtype=np.float64)
        before = np.ascontiguousarray(np.broadcast_to(move, len(points)), dtype=np.int64)

        def some(first: int, last: int) -> None:
            kernel.removed_loop(
                first,
                last,
                points,
                before,
                self.moves.row,
                self.cutter,
                self.low,
                g.start,
                g.rows,
                g.frame,
                g.shape,
                self.tree,
                self.flutes,
                self.bound,
                out,
            )

        in_parallel(some, len(points), CHUNK, progress, "Looking closer at rapids", threads)
        return out

    def cut_around(self, points: Floats, margin: float, move: int) -> Bools:
        """Return for each point (s, 3) whether one move before a row, of those with a closed form in plan, has removed all within a margin
        in plan of it and all above. Other moves are not looked at."""
        out, g = np.zeros(len(points), bool), self.grid
        points = np.ascontiguousarray(points, dtype=np.float64)
        kernel.surroundings_removed_loop(
            0,
            len(points),
            points,
            margin,
            move,
            self.moves.row,
            self.cutter,
            self.low,
            g.start,
            g.rows,
            g.frame,
            g.shape,
            out,
        )
        return out


def _by_cell(points: Floats, grid: Grid) -> Ints:
    """Return the order of points (s, 3) by the grid's cells."""
    cell = np.floor((points[:, :2] - grid.frame[:2]) / grid.frame[2])
    return np.lexsort((cell[:, 0], cell[:, 1]))


def residual_by_block(
    residual: Floats, nearest: Ints, n_moves: int, area: Floats | None = None
) -> BlockResidual:
    """Return the material residual (s,) on samples, gathered by the move (s,) that came nearest to each (-1: none).

    area (s,) weighs the mean.
    """
    hit = nearest >= 0
    rows, value, weight = (
        nearest[hit],
        residual[hit],
        np.ones(int(hit.sum())) if area is None else area[hit],
    )
    least, most = np.full(n_moves, np.inf), np.full(n_moves, -np.inf)
    np.minimum.at(least, rows, value)
    np.maximum.at(most, rows, value)
    count = np.bincount(rows, minlength=n_moves)
    total, sums = np.bincount(rows, weight, n_moves), np.bincount(rows, weight * value, n_moves)
    mean = np.divide(sums, total, out=np.full(n_moves, np.nan), where=total > 0.0)
    return BlockResidual(
        least=np.where(count, least, np.nan),
        mean=mean,
        most=np.where(count, most, np.nan),
        count=count.astype(np.int64),
    )


def _in_plan(moves: Moves) -> Bools:
    """Return which moves have a closed form in plan: upright, level or straight up and down, and of a plain cutter with room on its
    flank."""
    row = moves.row
    up = (
        (row[:, columns.KIND] == 0.0)
        & (row[:, columns.X0] == row[:, columns.X1])
        & (row[:, columns.Y0] == row[:, columns.Y1])
    )
    plain = np.array(
        [t.form in PLAIN_FORMS and t.flute_length >= 2.0 * t.corner_radius for t in moves.tools],
        dtype=bool,
    )
    return np.asarray(
        moves.upright
        & ((row[:, columns.Z_START] == row[:, columns.Z_END]) | up)
        & plain[moves.tool]
    )


def flutes_of(moves: Moves) -> Flutes:
    """Return the cutting bodies of the tools in use, closed at the flutes' top."""
    arcs: list[Floats] = []
    first, last, endless, start = [], [], [], [0]
    for k, tool in enumerate(moves.tools):
        cutting = _cutting(moves.bodies, k)
        for p, run in enumerate(cutting):
            is_top = p == len(cutting) - 1
            first.append(sum(map(len, arcs)))
            arcs.append(run)
            last.append(first[-1] + len(run))
            endless.append(last[-1] - int(is_top and tool.form in PLAIN_FORMS))
        start.append(len(first))
    return Flutes(
        arc=np.vstack([np.zeros((0, body.ARC_COLUMNS)), *arcs]),
        first=np.array(first, dtype=np.int64),
        last=np.array(last, dtype=np.int64),
        endless=np.array(endless, dtype=np.int64),
        start=np.array(start, dtype=np.int64),
        middle=np.array([min(t.core_radius, t.flute_length / 2) for t in moves.tools]),
    )


def _cutting(bodies: Bodies, tool: int) -> list[Floats]:
    """Return the arcs of each cutting body of a tool; the highest ends where the flutes do, not `OVERLAP` further on."""
    pieces = bodies.of(tool)
    pieces = pieces[pieces[:, body.KIND] == 0.0]
    runs = [bodies.arc[int(p[body.CLOSED_FIRST]) : int(p[body.CLOSED_LAST])].copy() for p in pieces]
    top = runs[-1][-1]
    beyond = top[body.CZ] - pieces[-1, body.Z_HIGH]
    if top[body.R] == 0.0 and beyond > tolerance.PARAMETRIC:
        top[body.CR] += beyond * top[body.A0Z] / top[body.A0R]
        top[body.CZ] = pieces[-1, body.Z_HIGH]
    return runs


def tool_motions(moves: Moves, rows: Ints) -> Floats:
    """Return how the tool moves in space along some moves (k, 18), as `kernels/residual.py` names the columns."""
    out = np.zeros((len(rows), kernel.MOTION_COLUMNS))
    a, b = moves.start_axis[rows], moves.end_axis[rows]
    a = np.where(moves.upright[rows, None], [0.0, 0.0, 1.0], a)
    turning = moves.turning(rows) & ~moves.upright[rows]
    across = b - (a * b).sum(axis=1, keepdims=True) * a
    # A still axis, or one that turns right over, may take any direction across it.
    aside = np.where(np.abs(a[:, :1]) < 0.9, [1.0, 0.0, 0.0], [0.0, 1.0, 0.0])
    aside = aside - (aside * a).sum(axis=1, keepdims=True) * a
    size = np.linalg.norm(across, axis=1)
    e = np.where((turning & (size > tolerance.PARAMETRIC))[:, None], across, aside)
    e = e / np.linalg.norm(e, axis=1, keepdims=True)
    out[:, kernel.PX : kernel.PZ + 1], out[:, kernel.DX : kernel.DZ + 1] = (
        moves.start[rows],
        moves.end[rows] - moves.start[rows],
    )
    out[:, kernel.AX : kernel.AZ + 1], out[:, kernel.EX : kernel.EZ + 1] = a, e
    out[:, kernel.TURN] = np.where(turning, np.arctan2(size, (a * b).sum(axis=1)), 0.0)
    arcs = np.flatnonzero(moves.sweep[rows] != 0.0)
    if len(arcs):
        n, centre, at = np.cross(a, e)[arcs], moves.centre[rows[arcs]], rows[arcs]
        c = np.column_stack([(centre * e[arcs]).sum(axis=1), (centre * n).sum(axis=1)])
        start, end = (
            np.column_stack([(p * e[arcs]).sum(axis=1), (p * n).sum(axis=1)]) - c
            for p in (moves.start[at], moves.end[at])
        )
        out[arcs, kernel.CENTRE_E : kernel.CENTRE_N + 1] = c
        # Posted ends are rounded: the mean of both radii halves what an end may lie off the arc.
        out[arcs, kernel.RADIUS] = 0.5 * (np.hypot(*start.T) + np.hypot(*end.T))
        out[arcs, kernel.PHASE], out[arcs, kernel.SWEEP] = (
            np.arctan2(start[:, 1], start[:, 0]),
            moves.sweep[at],
        )
    return out


def tree_of(moves: Moves, rows: Ints, flutes: Flutes) -> SpanTree:
    """Return some moves as spans in trees of poses, one a tool."""
    motion, tool = tool_motions(moves, rows), moves.tool[rows]
    run = moves.length[rows] + motion[:, kernel.TURN] * flutes.middle[tool]
    count = np.clip(np.ceil(run / SPAN), 1, MOST_SPANS).astype(np.int64)
    of, within = items_of(count)
    low, high, middle = within / count[of], (within + 1) / count[of], flutes.middle[tool[of]]
    pose, reach = kernel.span_poses(motion, of, low, high, middle)
    order = np.lexsort((_along_curve(pose[:, :3]), tool[of]))
    of, low, high, pose, reach = of[order], low[order], high[order], pose[order], reach[order]
    used, start = np.unique(tool[of], return_index=True)
    capacity = 4 * (len(of) // kernel.BUCKET + len(used))
    nodes, links, root = (
        np.zeros((capacity, 8)),
        np.zeros((capacity, 6), np.int64),
        np.zeros(len(used), np.int64),
    )
    n = kernel.build_pose_bvh(
        pose, reach, rows[of], np.append(start, len(of)), used, nodes, links, root
    )
    return SpanTree(
        motion,
        rows,
        tool,
        of,
        low,
        high,
        reach[:, 0] - middle[order] * reach[:, 1],
        nodes[:n].copy(),
        links[:n].copy(),
        root,
    )


def _along_curve(points: Floats) -> Ints:
    """Return the position of each point (k, 3) along a curve that fills space (Morton's), so that neighbours on it are neighbours in
    space."""
    if not len(points):
        return np.zeros(0, np.int64)
    low, size = points.min(axis=0), max(float(np.ptp(points, axis=0).max()), tolerance.PARAMETRIC)
    cells = np.minimum((points - low) / size * 2**20, 2**20 - 1).astype(np.int64)
    out = np.zeros(len(points), np.int64)
    for bit in range(20):
        for axis in range(3):
            out |= ((cells[:, axis] >> bit) & 1) << (3 * bit + axis)
    return out
