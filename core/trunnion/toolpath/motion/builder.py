"""Collects motions into a `Toolpath`, block by block, and knows where the tool is and what its cuts have already removed.

Everything is made robust against the four decimals that posts write: moves that go nowhere are dropped, arcs are cut in halves before
they come near a full turn, and each arc's centre is put where both of its ends agree on the radius.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import ArrayLike

from trunnion import tolerance
from trunnion.geometry.arrays import Floats
from trunnion.geometry.plane.curve import Curve, turn
from trunnion.model.motion.toolpath import EMPTY, Mark, Motion, Toolpath
from trunnion.model.operation import CuttingData
from trunnion.model.setup import Setup
from trunnion.model.tabs import Tab
from trunnion.model.tool import Tool
from trunnion.toolpath.motion.feed import arc_feed
from trunnion.toolpath.motion.fixture_links import FixtureSurface
from trunnion.toolpath.motion.tab_lift import TabLift
from trunnion.toolpath.stock.heightfield import PlanningStock
from trunnion.toolpath.stock.over_flutes import StockOverFlutes

WIDEST_ARC = math.radians(200.0)
NOWHERE = (math.nan, math.nan, math.nan)


class PathBuilder:
    """A path in the making. `here` is the tip's position (3,), or None before the first block.

    Feed moves that would cut into one of `tabs` are lifted over it, whatever heights they are given.
    """

    def __init__(
        self,
        tool: Tool,
        data: CuttingData,
        stock: PlanningStock,
        setup: Setup,
        safety: float,
        tabs: Sequence[Tab] = (),
    ) -> None:
        self.tool = tool
        self.data = data
        self.clearance = setup.clearance
        self.safety = safety
        self.fixtures = FixtureSurface.of(setup)
        self.here: Floats | None = None
        self._over_tabs = TabLift(tabs, tool.radius) if tabs else None
        self._wanted_height = 0.0
        self._stock = stock
        self._over_flutes = StockOverFlutes(stock, tool)
        self._known = 0
        self._position: list[tuple[float, float, float]] = []
        self._motion: list[Motion] = []
        self._centre: list[tuple[float, float, float]] = []
        self._feed: list[float] = []
        self._mark: list[Mark] = []

    def __len__(self) -> int:
        return len(self._motion)

    def tops(self) -> list[float]:
        """Return the heights over which the tip need not avoid some area any more."""
        return (
            []
            if self.fixtures is None
            else [float(z) for z in np.unique(self.fixtures.avoid[:, 4])]
        )

    def heading(self) -> Floats:
        """Return the direction (2,) in the plane in which the last block ended; zeros when it went straight up or down."""
        if len(self) < 2:
            return np.zeros(2)
        end, start = np.array(self._position[-1]), np.array(self._position[-2])
        direction = end[:2] - start[:2]
        if self._motion[-1] >= Motion.ARC_CW:
            ray = end[:2] - np.array(self._centre[-1])[:2]
            direction = np.array([-ray[1], ray[0]]) * (
                1.0 if self._motion[-1] == Motion.ARC_CCW else -1.0
            )
        size = float(np.hypot(*direction))
        return direction / size if size > tolerance.SHORT_MOVE else np.zeros(2)

    def stock(self) -> PlanningStock:
        """Return the stock as the moves so far leave it."""
        if self._known < len(self):
            if self._known == 0:
                self._stock = self._stock.working()
            self._stock.lower(self._made(max(self._known - 1, 0)), self.tool)
            self._known = len(self)
        return self._stock

    def rapid(self, point: ArrayLike) -> None:
        """Move at rapid to a point (3,)."""
        self._add(Motion.RAPID, _three(point), NOWHERE, 0.0, Mark.RETRACT)
        self._wanted_height = float(self._at()[2])

    def lift(self, z: float) -> None:
        """Go straight up to a height: at feed where the flutes scrape stock that the tool stands beside with its neck, else at rapid."""
        here = self._at()
        if self._over_flutes.may_be_there(here):
            top = min(self._over_flutes.top(here, self._made(0)), z)
            if top > here[2]:
                self.line((here[0], here[1], top), self.data.feed, Mark.LEAD)
        self.rapid((here[0], here[1], z))

    def line(self, point: ArrayLike, feed: float, mark: Mark = Mark.CUT) -> None:
        """Feed straight to a point (3,), over the tabs that are in between."""
        if self._over_tabs is None:
            self._add(Motion.LINE, _three(point), NOWHERE, feed, mark)
            return
        goal, start = np.array(_three(point)), self._start()

        def position(share: Floats) -> Floats:
            return np.asarray(start + share[:, None] * (goal - start))

        for _, end, own_feed in self._lifted(position, math.dist(start, goal), feed):
            self._add(Motion.LINE, _three(end), NOWHERE, own_feed, mark)
        self._wanted_height = float(goal[2])

    def arc(
        self, end: ArrayLike, centre: ArrayLike, sweep: float, feed: float, mark: Mark = Mark.CUT
    ) -> None:
        """Feed along an arc about `centre` (2,) to a point (3,), turning by about `sweep` radians (its sign gives the direction).

        The height changes evenly along it.
        """
        start, goal, middle = (
            self._start(),
            np.array(_three(end)),
            np.asarray(centre, dtype=np.float64)[:2],
        )
        radius = float(np.hypot(*(start[:2] - middle)))
        if abs(sweep) > WIDEST_ARC:
            angle = math.atan2(start[1] - middle[1], start[0] - middle[0]) + 0.5 * sweep
            half = (
                middle[0] + radius * math.cos(angle),
                middle[1] + radius * math.sin(angle),
                0.5 * (start[2] + goal[2]),
            )
            self.arc(half, middle, 0.5 * sweep, feed, mark)
            self.arc(goal, middle, 0.5 * sweep, feed, mark)
            return
        if self._over_tabs is None:
            self._arc(goal, middle, sweep, feed, mark)
            return
        ray = start[:2] - middle

        def position(share: Floats) -> Floats:
            height = start[2] + share * (goal[2] - start[2])
            plan = middle + turn(np.tile(ray, (len(share), 1)), share * sweep)
            # Both ends may be off the circle in the last digits: the move ends where it is to end.
            return np.column_stack([np.where((share == 1.0)[:, None], goal[:2], plan), height])

        before = 0.0
        for share, point, own_feed in self._lifted(position, radius * abs(sweep), feed):
            self._arc(point, middle, (share - before) * sweep, own_feed, mark)
            before = share
        self._wanted_height = float(goal[2])

    def _arc(self, goal: Floats, middle: Floats, sweep: float, feed: float, mark: Mark) -> None:
        """Add an arc of less than a turn, a straight line where it is too short for one."""
        start = self._at()
        exact = (
            None
            if math.dist(start[:2], middle) * abs(sweep) < tolerance.SHORT_ARC
            else _equidistant(start[:2], goal[:2], middle)
        )
        if exact is None:
            self._add(Motion.LINE, _three(goal), NOWHERE, feed, mark)
            return
        motion = Motion.ARC_CCW if sweep > 0.0 else Motion.ARC_CW
        self._add(
            motion, _three(goal), (float(exact[0]), float(exact[1]), float(start[2])), feed, mark
        )

    def curve(
        self,
        curve: Curve,
        z: float,
        feed: float,
        mark: Mark = Mark.CUT,
        *,
        start_z: float | None = None,
        at_rim: bool = True,
    ) -> None:
        """Feed along a plane curve from where the tool is (its start), at height `z`, or evenly down to it from `start_z`.

        The feed is that of the cutter's rim on the contour; of its centre where not `at_rim`.
        """
        seg = curve.segments()
        done = np.cumsum(seg.length)
        first = z if start_z is None else start_z
        for k in range(len(seg)):
            height = first + (z - first) * float(done[k] / done[-1])
            goal = (float(seg.end[k, 0]), float(seg.end[k, 1]), height)
            sweep = float(seg.sweep[k])
            if sweep == 0.0:
                self.line(goal, feed, mark)
            else:
                self.arc(
                    goal,
                    seg.centre[k],
                    sweep,
                    arc_feed(feed, float(seg.radius[k]), self.tool.radius, sweep)
                    if at_rim
                    else feed,
                    mark,
                )

    def finished(self) -> Toolpath:
        """Return the path, its last block a retract to the setup's clearance height."""
        if self.here is None:
            return EMPTY
        self.lift(self.clearance)
        return self._made(0)

    def _lifted(
        self, position: Callable[[Floats], Floats], length: float, feed: float
    ) -> list[tuple[float, Floats, float]]:
        """Return the ends of the pieces of a feed move that goes over tabs: share of it, tip (3,), feed; its own end where none is.

        `position` returns the tips (k, 3) that are wanted at shares (k,). Down a ramp the tool goes no faster than it plunges.
        """
        here, ends = self._at(), position(np.array([0.0, 1.0]))
        assert self._over_tabs is not None  # without tabs nothing is lifted
        shares = self._over_tabs.breaks(position, length, float(ends[:, 2].min()))
        if shares is None:
            return [(1.0, ends[1], feed)]
        shares = np.concatenate([[0.0], shares])
        tips = position(shares)
        tips[:, 2] = np.maximum(tips[:, 2], self._over_tabs.lowest(tips[:, :2]))
        pieces, before = [], here
        for share, tip in zip(shares.tolist(), tips, strict=True):
            drop = float(before[2] - tip[2])
            travelled = math.hypot(math.dist(before[:2], tip[:2]), drop)
            steep = drop > tolerance.SHORT_MOVE and drop * feed > self.data.plunge_feed * travelled
            pieces.append((share, tip, self.data.plunge_feed * travelled / drop if steep else feed))
            before = tip
        return pieces

    def _start(self) -> Floats:
        """Return where the next move would begin if nothing had been lifted over a tab (3,)."""
        here = self._at()
        return here if self._over_tabs is None else np.array([*here[:2], self._wanted_height])

    def _at(self) -> Floats:
        if self.here is None:
            raise ValueError("a path must begin with a rapid")
        return self.here

    def _add(
        self,
        motion: Motion,
        point: tuple[float, float, float],
        centre: tuple[float, float, float],
        feed: float,
        mark: Mark,
    ) -> None:
        if (
            self.here is not None
            and motion <= Motion.LINE
            and float(np.abs(self.here - point).max()) < tolerance.SHORT_MOVE
        ):
            return
        self._position.append(point)
        self._motion.append(motion)
        self._centre.append(centre)
        self._feed.append(feed)
        self._mark.append(mark)
        self.here = np.array(point)

    def _made(self, first: int) -> Toolpath:
        n = len(self) - first
        motion = np.array(self._motion[first:], dtype=np.int64)
        position, centre, feed = (
            np.array(self._position[first:]),
            np.array(self._centre[first:]),
            np.array(self._feed[first:]),
        )
        if first:
            # A later piece begins where the one before ended, which a path can only say by a rapid to that position.
            motion[0], feed[0], centre[0] = Motion.RAPID, 0.0, np.nan
        return Toolpath(
            position=position,
            axis=np.tile([0.0, 0.0, 1.0], (n, 1)),
            motion=motion,
            centre=centre,
            feed=feed,
            mark=np.array(self._mark[first:], dtype=np.int64),
        )


def _three(point: ArrayLike) -> tuple[float, float, float]:
    x, y, z = np.asarray(point, dtype=np.float64)
    return float(x), float(y), float(z)


def _equidistant(start: Floats, end: Floats, centre: Floats) -> Floats | None:
    """Return the point nearest to `centre` that is as far from `start` as from `end`; None when the two are one point."""
    chord = end - start
    square = float(chord @ chord)
    if square < tolerance.SHORT_MOVE**2:
        return None
    middle = 0.5 * (start + end)
    moved: Floats = centre - chord * (float((centre - middle) @ chord) / square)
    return moved
