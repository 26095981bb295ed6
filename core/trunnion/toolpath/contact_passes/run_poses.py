"""Where a leaning cutter is along runs of axes: in blocks as long as their chord error and the axes allow.

Many runs are worked on together, one after the other in the same arrays: most are short, and one by one they would cost more in calls than
in numbers.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Floats, Ints, items_of
from trunnion.geometry.sphere import angle_between
from trunnion.model.tool import Tool
from trunnion.plan.freeform.cutters.cutter import tip_at
from trunnion.toolpath.contact_passes.axis_search import FreeAxes
from trunnion.toolpath.contact_passes.contacts import Contacts, between_rows, slerp
from trunnion.toolpath.contact_passes.passes import Pass

SHARES = (0.25, 0.5, 0.75)
"""Where on a block its chord error is looked at, beside the contacts on its path."""
HALVINGS = 16
"""Times that a block is halved at most."""
MOST_AXES, FEWEST_BLOCKS = 16, 4
"""Axes that one block spans at most, and blocks that a pass has at least before they are halved: the ends of a loop meet."""
ASTRAY = math.radians(0.5)
"""rad: how far a block's axis may be from the run's, between its ends."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class AxisRuns:
    """Runs of axes along contact lines, one run after the other, and the cutter that follows them.

    Of the contacts (n, 3) of all lines: point, normal, feed and how far (n,) the cutter has come; of each run (r,) the row of its line's
    first contact and of its last. Of the axes (m, 3) of all runs: their positions (m,), as `contacts.between` counts them along their line,
    ascending in each run, and from `start` (r + 1,) on those of each run.
    """

    tool: Tool
    allowance: float
    point: Floats
    normal: Floats
    feed: Floats
    travel: Floats
    first: Ints
    last: Ints
    axis_position: Floats
    axis: Floats
    start: Ints

    @staticmethod
    def of(
        runs: Sequence[tuple[Contacts, FreeAxes]], tool: Tool, allowance: float = 0.0
    ) -> AxisRuns:
        """Return runs, at least one, each with its contact line, for a cutter that keeps `allowance` mm from the contacts."""
        radius = max(tool.corner_radius, 0.25 * tool.radius)
        lines = list({id(contacts): contacts for contacts, _ in runs}.values())
        ends = np.cumsum([len(line) for line in lines])
        row = {id(line): k for k, line in enumerate(lines)}
        of_run = np.array([row[id(contacts)] for contacts, _ in runs])
        return AxisRuns(
            tool=tool,
            allowance=allowance,
            point=np.concatenate([line.point for line in lines]),
            normal=np.concatenate([line.normal for line in lines]),
            feed=np.concatenate([line.feed for line in lines]),
            travel=np.concatenate([line.travel(radius) for line in lines]),
            first=np.concatenate([[0], ends[:-1]])[of_run],
            last=(ends - 1)[of_run],
            axis_position=np.concatenate([run.position for _, run in runs]),
            axis=np.concatenate([run.axis for _, run in runs]),
            start=np.cumsum([0, *(len(run.position) for _, run in runs)]),
        )

    def order(self, run: Ints, position: Floats) -> Floats:
        """Return numbers (k,) that ascend from run to run and along each: by them positions are looked up and merged."""
        # A number left out between runs keeps the end of one apart from the start of the next.
        begin = np.concatenate([[0], np.cumsum(self.last - self.first + 2)[:-1]])
        return np.asarray(begin[run] + position)

    def contact(self, run: Ints, position: Floats) -> tuple[Floats, Floats]:
        """Return contact points and unit normals (k, 3) at positions (k,) of runs (k,)."""
        return between_rows(self.point, self.normal, self.feed, *self._rows(run, position))

    def travelled(self, run: Ints, position: Floats) -> Floats:
        """Return how far (k,) the cutter has come at positions (k,) of runs (k,)."""
        row, share = self._rows(run, position)
        return np.asarray(self.travel[row] + share * (self.travel[row + 1] - self.travel[row]))

    def axis_at(self, run: Ints, position: Floats) -> Floats:
        """Return the axes (k, 3) at positions (k,) of runs (k,)."""
        _, own = self.axes_in_order()
        row = np.searchsorted(own, self.order(run, position), side="right") - 1
        row = np.clip(row, self.start[run], self.start[run + 1] - 2)
        before, after = self.axis_position[row], self.axis_position[row + 1]
        share = np.clip((position - before) / (after - before), 0.0, 1.0)
        return slerp(self.axis[row], self.axis[row + 1], share)

    def poses(self, run: Ints, position: Floats) -> Pass:
        """Return the cutter at positions (k,) of runs (k,)."""
        point, normal = self.contact(run, position)
        axis = self.axis_at(run, position)
        tip = tip_at(self.tool, point + self.allowance * normal, normal, axis)
        return Pass(tip=tip, axis=axis, normal=normal)

    def begun(self) -> RunPoses:
        """Return poses at the ends of all runs and at every so many axes between."""
        run, position = [], []
        for k, (a, b) in enumerate(pairwise(self.start.tolist())):
            stride = max(1, min(MOST_AXES, (b - a - 1) // FEWEST_BLOCKS))
            position.append(
                np.append(self.axis_position[a : b - 1 : stride], self.axis_position[b - 1])
            )
            run.append(np.full(len(position[-1]), k))
        of_run, at = np.concatenate(run), np.concatenate(position)
        return RunPoses(runs=self, run=of_run, position=at, poses=self.poses(of_run, at))

    def inner(self) -> tuple[Ints, Floats]:
        """Return run and position (k,), in order, of all axes and of all contacts that lie within runs."""
        low = np.floor(self.axis_position[self.start[:-1]]).astype(np.int64)
        count = np.ceil(self.axis_position[self.start[1:] - 1]).astype(np.int64) - low
        number = np.arange(len(self.first))
        run = np.concatenate([np.repeat(number, np.diff(self.start)), np.repeat(number, count)])
        position = np.concatenate([self.axis_position, low.repeat(count) + items_of(count)[1]])
        order = np.argsort(self.order(run, position), kind="stable")
        return run[order], position[order]

    def axes_in_order(self) -> tuple[Ints, Floats]:
        """Return the runs (m,) that the axes belong to, and the numbers (m,) that they go by in `order`."""
        run = np.repeat(np.arange(len(self.first)), np.diff(self.start))
        return run, self.order(run, self.axis_position)

    def _rows(self, run: Ints, position: Floats) -> tuple[Ints, Floats]:
        """Return the rows (k,) of the contacts that positions (k,) lie behind, never a line's last one, and the shares (k,) of the way from
        there to the next."""
        row = self.first[run] + position.astype(np.int64)
        row = np.clip(row, self.first[run], self.last[run] - 1)
        return row, position - (row - self.first[run])


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RunPoses:
    """Poses of a cutter along runs: the number (k,) of the run of each, ascending, and its `position` (k,) on it, ascending in each run.

    Two poses of one run, one after the other, are the ends of a block, which goes by the row of the first.
    """

    runs: AxisRuns
    run: Ints
    position: Floats
    poses: Pass

    def blocks(self) -> Ints:
        """Return the rows (b,) of all blocks."""
        return np.flatnonzero(self.run[:-1] == self.run[1:])

    def with_positions(self, run: Ints, position: Floats) -> RunPoses:
        """Return them with poses at more positions (m,) of runs (m,), in order, at which there are none yet."""
        order = self.runs.order
        at = np.searchsorted(order(self.run, self.position), order(run, position))
        more = self.runs.poses(run, position)
        tip, axis, normal = (
            np.insert(getattr(self.poses, name), at, getattr(more, name), axis=0)
            for name in ("tip", "axis", "normal")
        )
        return RunPoses(
            runs=self.runs,
            run=np.insert(self.run, at, run),
            position=np.insert(self.position, at, position),
            poses=Pass(tip=tip, axis=axis, normal=normal),
        )

    def axes_within(self, blocks: Ints) -> tuple[Ints, Floats]:
        """Return run and position (m,), in order, of the runs' axes between the ends of some blocks (b,)."""
        runs = self.runs
        owner, own = runs.axes_in_order()
        here = runs.order(self.run, self.position)
        # Halves of halves may fall on an axis but for rounding: there is a pose already.
        low = np.searchsorted(own, here[blocks] + tolerance.PARAMETRIC)
        count = np.searchsorted(own, here[blocks + 1] - tolerance.PARAMETRIC) - low
        count = np.maximum(count, 0)
        row = np.repeat(low, count) + items_of(count)[1]
        return owner[row], runs.axis_position[row]

    def off(self, blocks: Ints, inner: tuple[Ints, Floats], chord: float) -> Floats:
        """Return how far some blocks (b,) are off, in what they may be: the straight block from the contact's tip along the face's normal,
        against the chord error (mm), and its axis, which turns evenly, from the run's, against `ASTRAY`.

        `inner`: run and position (i,) in order that are looked at beside `SHARES` of each block.
        """
        runs, position = self.runs, self.position
        order, here = runs.order(*inner), runs.order(self.run, position)
        low = np.searchsorted(order, here[blocks], side="left")
        count = np.searchsorted(order, here[blocks + 1], side="left") - low
        number = np.arange(len(blocks))
        block = np.concatenate([np.repeat(number, count), *(number for _ in SHARES)])
        width = position[blocks + 1] - position[blocks]
        probe = np.concatenate(
            [
                inner[1][np.repeat(low, count) + items_of(count)[1]],
                *(position[blocks] + share * width for share in SHARES),
            ]
        )
        start = blocks[block]
        run, tip, axis = self.run[start], self.poses.tip, self.poses.axis
        gone, begin, end = (
            runs.travelled(run, at) for at in (probe, position[start], position[start + 1])
        )
        part = np.clip((gone - begin) / np.maximum(end - begin, tolerance.PARAMETRIC), 0.0, 1.0)
        turned = slerp(axis[start], axis[start + 1], part)
        at, out = runs.contact(run, probe)
        tip_at_block = tip[start] + part[:, None] * (tip[start + 1] - tip[start])
        wanted = tip_at(runs.tool, at + runs.allowance * out, out, turned)
        far = np.abs(((tip_at_block - wanted) * out).sum(axis=1))
        astray = angle_between(turned, runs.axis_at(run, probe))
        worst = np.zeros(len(blocks))
        np.maximum.at(worst, block, np.maximum(far / chord, astray / ASTRAY))
        return worst


def poses_along(runs: AxisRuns, chord: float) -> RunPoses:
    """Return where a cutter is along runs, in blocks as long as the chord error (mm) and the axes allow."""
    made, inner = runs.begun(), runs.inner()
    blocks = made.blocks()
    for _ in range(HALVINGS):
        # Only blocks that the last halving made are looked at: all others are good already, or too short.
        worst = made.off(blocks, inner, chord)
        size = np.linalg.norm(made.poses.tip[blocks + 1] - made.poses.tip[blocks], axis=1)
        split = blocks[(worst > 1.0) & (size > 2.0 * tolerance.SHORT_MOVE)]
        if not len(split):
            break
        middle = 0.5 * (made.position[split] + made.position[split + 1])
        made = made.with_positions(made.run[split], middle)
        first = split + np.arange(len(split))
        blocks = np.column_stack([first, first + 1]).ravel()
    return made
