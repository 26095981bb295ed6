"""Moves cut into spans so short that within each every point runs straight past the tool, up to `tolerance.STOCK_CHORD`.

Seen from a tool that turns by theta about w while its tip goes by d, the way of a point at p bends by theta^2 p - 2 theta w x d
over a span. The second term is the same for all points, the first is never below 0 along the axis: a straight way through the middle
of what they make of it is twice as near as one through its ends, so spans of turning tools begin and end beside the tip's own path.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.verify.kernels import body as body_kernel
from trunnion.verify.kernels.stock.dexels import LEVEL
from trunnion.verify.kernels.stock.swept_bounds import SPAN_COLUMNS
from trunnion.verify.motion import AXIS_LEAN, EVERY, Moves
from trunnion.verify.stock.bundles import cycle

VECTORS = SPAN_COLUMNS // 3


@dataclass(frozen=True, slots=True, eq=False)
class Spans:
    """Spans of some moves, in the blank's frame: row (s, `SPAN_COLUMNS`) as `kernels/stock/dexels.py` names its columns; start (n + 1,)."""

    row: Floats
    start: Ints

    def along(self, axis: int) -> Floats:
        """Return the rows in the coordinates of a bundle."""
        turned = self.row.reshape(-1, VECTORS, 3)[:, :, cycle(axis)]
        return np.ascontiguousarray(turned.reshape(-1, SPAN_COLUMNS))


def whole_arcs(moves: Moves, along: Sequence[int]) -> Bools:
    """Return which moves (n,) are arcs that go level about one of the blank's axes `along`: each is one span."""
    climb = np.abs(((moves.end - moves.start) * moves.start_axis).sum(axis=1))
    axis = np.abs(moves.start_axis)
    straight = np.isin(axis.argmax(axis=1), along) & (
        np.sort(axis, axis=1)[:, :2].max(axis=1, initial=0.0) < LEVEL / 10.0
    )
    return np.asarray((moves.sweep != 0.0) & straight & (climb < LEVEL / 10.0) & ~moves.turning())


def spans_each(moves: Moves, whole: Bools) -> Ints:
    """Return into how many spans each move (n,) is cut; `whole` arcs are one."""
    size = _sizes(moves)[moves.tool]
    theta = _turns(moves, EVERY)
    run = np.linalg.norm(moves.end - moves.start, axis=1)
    # A point's way past a turning tool bends by the turn squared at arm's length, and by turn and way together; what is cut in
    # spans beside the path (`_Poses.beside`) strays by half as much as the chords of such a bend.
    is_arc = moves.sweep != 0.0
    arm = np.where(is_arc, np.hypot(size[:, 0], size[:, 2]), np.hypot(0.5 * size[:, 0], size[:, 2]))
    turning = np.sqrt(
        (theta**2 * arm + np.where(is_arc, 2.0, 1.0) * theta * run) / (8.0 * tolerance.STOCK_CHORD)
    )
    away = moves.start - np.where(np.isnan(moves.centre), moves.start, moves.centre)
    away -= (away * moves.start_axis).sum(axis=1, keepdims=True) * moves.start_axis
    radius = np.linalg.norm(away, axis=1)
    arcs = np.abs(moves.sweep) * np.sqrt(radius / (8.0 * tolerance.STOCK_CHORD))
    return np.where(
        whole, 1, np.maximum(1, np.ceil(np.maximum(turning, arcs) - tolerance.PARAMETRIC))
    ).astype(np.int64)


def spans_of(moves: Moves, rows: Ints, each: Ints, whole: Bools) -> Spans:
    """Return the spans of some moves given in the blank's frame; each (r,) how many of every one, and whether it is a whole arc."""
    start = np.concatenate([[0], np.cumsum(each)])
    move = np.repeat(rows, each)
    step, steps = np.arange(start[-1]) - np.repeat(start[:-1], each), np.repeat(each, each)
    row = np.empty((len(move), VECTORS, 3))
    poses, size = _Poses(moves, move), _sizes(moves)[moves.tool[move]]
    for k, share in enumerate((step / steps, (step + 1) / steps)):
        tip, frame = poses.at(share)
        row[:, 4 * k], row[:, 4 * k + 1 : 4 * k + 4] = (
            tip + poses.beside(steps, frame[:, 2], size[:, 0]),
            frame,
        )
    row[:, 12], row[:, 13] = np.minimum(row[:, 0], row[:, 4]), np.maximum(row[:, 0], row[:, 4])
    bent = np.repeat(whole, each)
    row[:, 14:] = 0.0
    row[bent, 14:] = poses.arcs()[bent]
    row[bent, 12:14] = poses.path_boxes(bent)
    row[:, 8:10] = _boxes(row, size[:, 0], size[:, 2])
    row[:, 10:12] = _boxes(row, size[:, 1], size[:, 3])
    return Spans(row.reshape(-1, SPAN_COLUMNS), start)


class _Poses:
    """Where the tools of some moves are, and how they stand."""

    def __init__(self, moves: Moves, rows: Ints) -> None:
        self.start, self.displacement = moves.start[rows], moves.end[rows] - moves.start[rows]
        self.sweep = moves.sweep[rows]
        axis = moves.start_axis[rows]
        self.theta = _turns(moves, rows)
        ahead = (
            moves.end_axis[rows] - (moves.end_axis[rows] * axis).sum(axis=1, keepdims=True) * axis
        )
        # A tool that keeps its axis may be looked at from anywhere across it.
        across = np.eye(3)[np.abs(axis).argmin(axis=1)]
        across = across - (across * axis).sum(axis=1, keepdims=True) * axis
        ahead = np.where((self.theta > 0.0)[:, None], ahead, across)
        self.axis, self.ahead = axis, ahead / np.linalg.norm(ahead, axis=1, keepdims=True)
        self.across = np.cross(self.axis, self.ahead)
        arc = self.sweep != 0.0
        away = np.where(arc[:, None], self.start - moves.centre[rows], 0.0)
        self.climb = (self.displacement * axis).sum(axis=1, keepdims=True) * axis
        self.away = away - (away * axis).sum(axis=1, keepdims=True) * axis
        self.over = np.cross(axis, self.away)
        self.arc = arc[:, None]

    def at(self, share: Floats) -> tuple[Floats, Floats]:
        """Return tips (s, 3) and tool frames (s, 3, 3) at shares (s,) of each way."""
        t = share[:, None]
        angle = t * self.sweep[:, None]
        bent = (
            self.start
            + t * self.climb
            + (np.cos(angle) - 1.0) * self.away
            + np.sin(angle) * self.over
        )
        tip = np.where(self.arc, bent, self.start + t * self.displacement)
        turn = t * self.theta[:, None]
        axis = self.axis * np.cos(turn) + self.ahead * np.sin(turn)
        ahead = self.ahead * np.cos(turn) - self.axis * np.sin(turn)
        return tip, np.stack([ahead, self.across, axis], axis=1)

    def beside(self, steps: Ints, axis: Floats, height: Floats) -> Floats:
        """Return by how much (s, 3) tips are set beside their straight path where each way is one of so many `steps` (s,) with the tool
        along `axis` (s, 3): by half of what ways past the tip bend, and past the middle of what cuts, `height` (s,) mm."""
        theta = np.where(self.arc[:, 0], 0.0, self.theta / steps)[:, None]
        way = self.displacement / steps[:, None]
        return np.asarray(
            theta * np.cross(self.across, way) / 8.0
            - theta * theta * (height / 16.0)[:, None] * axis
        )

    def arcs(self) -> Floats:
        """Return centre, direction of the middle, radius and cosine of half the angle of arcs (s, 4, 3), the last two three times."""
        radius, half = np.linalg.norm(self.away, axis=1, keepdims=True), 0.5 * self.sweep[:, None]
        middle = (np.cos(half) * self.away + np.sin(half) * self.over) / np.maximum(
            radius, tolerance.PARAMETRIC
        )
        three = np.ones((1, 3))
        return np.stack(
            [
                self.start - self.away,
                middle,
                radius * three,
                np.cos(np.clip(half, -np.pi, np.pi)) * three,
            ],
            axis=1,
        )

    def path_boxes(self, rows: Bools) -> Floats:
        """Return boxes (k, 2, 3) of the tips' paths along some arcs."""
        away, over, sweep = self.away[rows], self.over[rows], self.sweep[rows, None]
        centre, reach, angle = self.start[rows] - away, np.hypot(away, over), np.arctan2(over, away)
        end = centre + np.cos(sweep) * away + np.sin(sweep) * over
        low, high = np.minimum(centre + away, end), np.maximum(centre + away, end)
        # Each coordinate goes up and down over a turn: is its top, or its bottom, on the way?
        side = np.sign(sweep)
        top, bottom = (
            np.mod(side * (angle + half), 2.0 * np.pi) <= np.abs(sweep) for half in (0.0, np.pi)
        )
        return np.stack(
            [np.where(bottom, centre - reach, low), np.where(top, centre + reach, high)], axis=1
        )


def _turns(moves: Moves, rows: Ints | slice) -> Floats:
    """Return the angle that the axis of each of some moves turns by (k,), 0 where it keeps still."""
    first, last = moves.start_axis[rows], moves.end_axis[rows]
    across = np.linalg.norm(np.cross(first, last), axis=1)
    theta = np.arctan2(across, (first * last).sum(axis=1))
    return np.where(moves.turning(rows) & (across > AXIS_LEAN), theta, 0.0)


def _sizes(moves: Moves) -> Floats:
    """Return for each tool (t, 4): height of what cuts, of all of it, and the largest radius of both."""
    found = []
    for k in range(len(moves.tools)):
        piece = moves.bodies.of(k)
        cutting = piece[piece[:, body_kernel.KIND] == 0.0]
        found.append(
            [
                p[:, column].max()
                for column in (body_kernel.Z_HIGH, body_kernel.R_MAX)
                for p in (cutting, piece)
            ]
        )
    return np.array(found).reshape(-1, 4)


def _boxes(row: Floats, height: Floats, radius: Floats) -> Floats:
    """Return the boxes (s, 2, 3) of tools of some height and radius in spans."""
    low, high = np.full((len(row), 3), np.inf), np.full((len(row), 3), -np.inf)
    for tip, axis in (
        (row[:, 12], row[:, 3]),
        (row[:, 13], row[:, 3]),
        (row[:, 0], row[:, 3]),
        (row[:, 4], row[:, 7]),
    ):
        across = radius[:, None] * np.sqrt(np.clip(1.0 - axis**2, 0.0, None)) + 0.05
        top = tip + height[:, None] * axis
        low, high = (
            np.minimum(low, np.minimum(tip, top) - across),
            np.maximum(high, np.maximum(tip, top) + across),
        )
    return np.stack([low, high], axis=1)
