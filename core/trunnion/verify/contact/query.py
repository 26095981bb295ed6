"""Clearance of poses for planners: how far a pose may tilt, plunge or lengthen before its tool touches part or fixtures.

Leaning and plunging are queried as motions, not as poses at their end: a thin rib on the way is not jumped over. A lean goes on in steps,
each a turning move about the pivot, until one touches; within it, and for what only grows, halves close in on the first touch.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.model.tool import Tool
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.verify.contact import PartContact
from trunnion.verify.cutter import bodies_of
from trunnion.verify.kernels.contact import strips as columns
from trunnion.verify.motion import Moves, poses_of

STEP = math.radians(5.0)
"""Lean in one step: about a pivot 6 mm from the tip the tip's chord is 6 um from its arc."""
HALVES = 12
"""Halvings that close in on a touch: 5 degrees to 5 seconds of arc, 100 mm to 25 um."""
STICKOUT_STEP = 0.1
"""mm: stick-outs are set no finer."""
POSES = 512
"""Moves queried together, between two looks at cancel."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PoseClearance:
    """What each of k poses may do before its tool touches deeper than allowed; all of it is clear up to the figure given.

    clear (k,): whether the pose itself is; 0 and NaN elsewhere where it isn't. towards (k, n, 3): the n directions across the axis into
    which it may lean, lean (k, n) rad by how much. plunge (k,) mm along the axis. stickout (k,) mm: the shortest that keeps the holder
    clear, NaN when none does; a pose whose holder touches may still have one.
    """

    clear: Bools
    towards: Floats
    lean: Floats
    plunge: Floats
    stickout: Floats


def pose_clearance(
    contact: PartContact,
    tool: Tool,
    tip: Floats,
    axis: Floats,
    *,
    pivot: Floats | None = None,
    directions: int = 8,
    most_lean: float = math.pi / 2,
    most_plunge: float = 100.0,
    longest: float | None = None,
    allowed: float = tolerance.GOUGE,
    progress: Progress = NO_PROGRESS,
) -> PoseClearance:
    """Return what poses of one tool may do: tips (k, 3), unit axes (k, 3), queried all together.

    Leaning turns about `pivot` (k, 3), the tip when not given; the first direction is the setup's x (y where the axis lies along x) seen
    across the axis, the others follow anticlockwise. `longest` is the largest stick-out that is tried (by default 50 mm more than the
    tool's). Contact needs facets.
    """
    tip, axis = (np.asarray(v, dtype=np.float64).reshape(-1, 3) for v in (tip, axis))
    pivot = tip if pivot is None else np.asarray(pivot, dtype=np.float64).reshape(-1, 3)
    query = _MotionQuery(contact, tool, allowed, progress)
    k = len(tip)
    clear = query(tip, tip, axis, axis)
    towards = _around(axis, directions)
    lean = np.zeros((k, directions))
    of = np.repeat(np.arange(k), directions)
    lean[...] = _leans(
        query, tip[of], axis[of], pivot[of], towards.reshape(-1, 3), clear[of], most_lean
    ).reshape(k, directions)
    plunge = _furthest(
        lambda rows, by: query(
            tip[rows], tip[rows] - by[:, None] * axis[rows], axis[rows], axis[rows]
        ),
        clear,
        np.full(k, most_plunge),
    )
    stickout = _stickouts(query, tip, axis, tool.stickout + 50.0 if longest is None else longest)
    return PoseClearance(clear=clear, towards=towards, lean=lean, plunge=plunge, stickout=stickout)


@dataclass(slots=True, eq=False)
class _MotionQuery:
    """Queries whether straight moves, whose axis turns evenly on the way, are clear."""

    contact: PartContact
    tool: Tool
    allowed: float
    progress: Progress

    def __call__(self, start: Floats, end: Floats, first: Floats, last: Floats) -> Bools:
        still = poses_of(self.tool, end, last)
        # Only a move that starts and ends upright is upright.
        upright = still.upright & poses_of(self.tool, start, first).upright
        row = still.row.copy()
        row[:, [columns.X0, columns.Y0, columns.Z_START]] = start
        return self.of(
            replace(
                still,
                start=start,
                start_axis=first,
                upright=upright,
                row=row,
                length=np.linalg.norm(end - start, axis=1),
            )
        )

    def of(self, moves: Moves) -> Bools:
        clear = np.zeros(len(moves), bool)
        for at in range(0, len(moves), POSES):
            self.progress.check()
            some = np.arange(at, min(at + POSES, len(moves)))
            clear[some] = self.contact.clear(moves.some(some), self.allowed)
        return clear


def _around(axis: Floats, count: int) -> Floats:
    """Return directions across axes (k, n, 3)."""
    along = np.where(np.abs(axis[:, :1]) < 0.9, [1.0, 0.0, 0.0], [0.0, 1.0, 0.0])
    first = along - (along * axis).sum(axis=1, keepdims=True) * axis
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    second = np.cross(axis, first)
    angle = 2.0 * np.pi * np.arange(count) / max(count, 1)
    return np.asarray(
        np.cos(angle)[:, None] * first[:, None] + np.sin(angle)[:, None] * second[:, None]
    )


def _leans(
    query: _MotionQuery,
    tip: Floats,
    axis: Floats,
    pivot: Floats,
    towards: Floats,
    clear: Bools,
    most: float,
) -> Floats:
    """Return how far (k,) poses may lean, each towards a direction (k, 3)."""

    def leaned(rows: Ints, angle: Floats) -> tuple[Floats, Floats]:
        c, s = np.cos(angle)[:, None], np.sin(angle)[:, None]
        a, e, away = axis[rows], towards[rows], tip[rows] - pivot[rows]
        up, out = (away * a).sum(axis=1, keepdims=True), (away * e).sum(axis=1, keepdims=True)
        turned = away + up * (c * a + s * e - a) + out * (c * e - s * a - e)
        return pivot[rows] + turned, c * a + s * e

    def between(rows: Ints, a: Floats, b: Floats) -> Bools:
        (start, first), (end, last) = leaned(rows, a), leaned(rows, b)
        return query(start, end, first, last)

    reached, advancing = np.zeros(len(tip)), clear.copy()
    steps = max(1, math.ceil(most / STEP - tolerance.PARAMETRIC))
    blocked = np.zeros(len(tip), bool)
    for k in range(steps):
        rows = np.flatnonzero(advancing)
        fits = between(
            rows, np.full(len(rows), most * k / steps), np.full(len(rows), most * (k + 1) / steps)
        )
        reached[rows[fits]] = most * (k + 1) / steps
        advancing[rows[~fits]], blocked[rows[~fits]] = False, True
    start = reached.copy()
    more = _furthest(
        lambda rows, by: between(rows, start[rows], start[rows] + by),
        blocked,
        np.full(len(tip), most / steps),
    )
    return reached + more


def _furthest(fits: Callable[[Ints, Floats], Bools], possible: Bools, most: Floats) -> Floats:
    """Return the largest values (k,) up to `most` that fit, by halves, 0 where not possible. Whatever is below one that fits, fits."""
    low, high = np.zeros(len(most)), most.copy()
    rows = np.flatnonzero(possible)
    if len(rows):
        whole = fits(rows, most[rows])
        low[rows[whole]] = most[rows[whole]]
        rows = rows[~whole]
    for _ in range(HALVES if len(rows) else 0):
        middle = 0.5 * (low[rows] + high[rows])
        good = fits(rows, middle)
        low[rows] = np.where(good, middle, low[rows])
        high[rows] = np.where(good, high[rows], middle)
    return low


def _stickouts(query: _MotionQuery, tip: Floats, axis: Floats, longest: float) -> Floats:
    """Return the shortest stick-outs (k,) that are clear, in steps of `STICKOUT_STEP`; the neck stays out of the holder."""
    tool = query.tool
    most = max(math.floor((longest - tool.neck_length) / STICKOUT_STEP + tolerance.PARAMETRIC), 0)

    def fits(rows: Ints, steps: Ints) -> Bools:
        each, which = np.unique(steps, return_inverse=True)
        tools = tuple(_stuck_out(tool, tool.neck_length + STICKOUT_STEP * int(n)) for n in each)
        poses = poses_of(tool, tip[rows], axis[rows])
        return query.of(
            replace(poses, tools=tools, tool=which.astype(np.int64), bodies=bodies_of(tools))
        )

    rows = np.arange(len(tip))
    low, high = np.full(len(tip), -1), np.full(len(tip), most)
    rows = rows[fits(rows, high)]
    out = np.full(len(tip), np.nan)
    some = rows
    while len(some):
        middle = (low[some] + high[some]) // 2
        good = np.zeros(len(some), bool)
        unsettled = middle > low[some]
        good[unsettled] = fits(some[unsettled], middle[unsettled])
        high[some[good]] = middle[good]
        low[some[~good]] = np.maximum(middle[~good], low[some[~good]])
        some = some[high[some] - low[some] > 1]
    out[rows] = tool.neck_length + STICKOUT_STEP * high[rows]
    return out


def _stuck_out(tool: Tool, stickout: float) -> Tool:
    return replace(
        tool, stickout=stickout, gauge_length=tool.gauge_length - tool.stickout + stickout
    )
