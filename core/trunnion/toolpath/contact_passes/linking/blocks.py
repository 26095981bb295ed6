"""The blocks of a path in the making: feeds, and travels through the air from one pass to another."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import cached_property

import numpy as np

from trunnion import tolerance
from trunnion.findings import Refused
from trunnion.geometry.arrays import Bools, Floats
from trunnion.model.motion.toolpath import Mark, Motion, Toolpath
from trunnion.model.operation import CuttingData
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.plan.freeform.drive import SurfaceDrive
from trunnion.toolpath.contact_passes.linking.leaning_links import LinkMoves
from trunnion.toolpath.contact_passes.linking.parameters import SAME, LinkParameters, is_upright
from trunnion.toolpath.contact_passes.overhang import overhang_tops
from trunnion.toolpath.contact_passes.passes import UPRIGHT
from trunnion.toolpath.contact_passes.stock_clearance import LEAST_STOCK, STOCK_SHARE
from trunnion.toolpath.motion.builder import PathBuilder
from trunnion.toolpath.motion.link import is_free, lowest_tip
from trunnion.toolpath.stock.heightfield import PlanningStock

REORIENT = math.cos(math.radians(60.0))
"""The least part along z of an axis that may turn on a move over the work; a tool that leans more is set upright before."""


class Blocks:
    """A toolpath in the making, in arrays: most of it are whole passes."""

    def __init__(
        self,
        tool: Tool,
        data: CuttingData,
        stock: PlanningStock,
        setup: Setup,
        drive: SurfaceDrive,
        parameters: LinkParameters,
    ) -> None:
        # A builder without a block: it answers how low the tip may go over the stock before the operation.
        self._air = PathBuilder(tool, data, stock, setup, parameters.safety)
        self._has_retreats = parameters.link_clearance is not None
        self._thickness = max(STOCK_SHARE * data.depth, LEAST_STOCK)
        self._tool, self._data, self._drive = tool, data, drive
        held = [
            drive.low,
            drive.high,
            *(setup.frame.to_local(f.mesh.points) for f in setup.fixtures),
        ]
        corners = np.vstack(held)[:, :2]
        self._low, self._high = corners.min(axis=0), corners.max(axis=0)
        self._parts: list[tuple[Floats, Floats, Motion, float, Mark]] = []

    @property
    def here(self) -> Floats:
        """Where the tip is (3,)."""
        return self._parts[-1][0][-1]

    @property
    def axis(self) -> Floats:
        """How the tool stands (3,)."""
        return self._parts[-1][1][-1]

    @cached_property
    def _overhang_top(self) -> Callable[[Floats], float]:
        return overhang_tops(self._drive.skin, self._tool, self._thickness)

    def feed(self, tips: Floats, axis: Floats, mark: Mark) -> None:
        """Feed along tips (k, 3) with one axis (3,) or an axis each (k, 3)."""
        if len(tips):
            self._parts.append(
                (tips, np.broadcast_to(axis, tips.shape), Motion.LINE, self._data.feed, mark)
            )

    def follow(self, link: Sequence[LinkMoves]) -> None:
        """Go along a link of a leaning tool."""
        for moves in link:
            if moves.rapid:
                motion, feed = Motion.RAPID, 0.0
            else:
                motion, feed = Motion.LINE, self._data.feed
            self._parts.append((moves.tip, moves.axis, motion, feed, moves.mark))

    def travel(self, position: Floats, axis: Floats, retract: float, approach: float) -> None:
        """Bring the tip to a position (3,) through the air, at the end by a feed; it goes off and comes at feed for so many mm at least."""
        stops = self._outside(position, axis)
        if self._parts and is_upright(self.axis) and is_upright(axis):
            self._lift(position, retract)
        else:
            if self._parts:
                self._leave(retract)
                if min(self.axis[2], axis[2]) < REORIENT:
                    self._rapid(self.here, UPRIGHT)
                    self._rapid(np.append(stops[-1][:2], self.here[2]), UPRIGHT)
            for stop in stops[::-1]:
                self._rapid(stop, axis)
            if self._has_retreats:
                self._rapid(_towards(position, axis, stops[0], approach), axis)
        if is_upright(axis):
            self._down(position)
        else:
            self._add(position, axis, Motion.LINE, self._data.feed, Mark.LEAD)

    def finished(self, retract: float) -> Toolpath:
        """Return the path, its last block a retract to the clearance height; the tool goes off at feed for so many mm."""
        self._leave(retract)
        count = [len(p[0]) for p in self._parts]
        position, axis = (np.concatenate([p[k] for p in self._parts]) for k in (0, 1))
        motion, feed, mark = (np.repeat([p[k] for p in self._parts], count) for k in (2, 3, 4))
        kept = _goes(position, axis)
        return Toolpath(
            position=position[kept],
            axis=axis[kept],
            motion=motion[kept],
            feed=feed[kept],
            mark=mark[kept],
            centre=np.full((int(kept.sum()), 3), np.nan),
        )

    def _lift(self, position: Floats, retract: float) -> None:
        """Go over a position, upright, at feed for so many mm: no higher than what may be in between demands."""
        safe = lowest_tip(self._air, self.here[:2], position[:2]) + self._air.safety
        height = min(max(safe, float(self.here[2]), float(position[2])), self._air.clearance)
        self._rise(height, retract)
        self._rapid(np.append(self.here[:2], height), UPRIGHT)
        self._rapid(np.append(position[:2], height), UPRIGHT)

    def _rise(self, height: float, retract: float) -> None:
        """Feed up for so many mm, and to a height at most as far as something hangs over beside the tool, or a wall stands beside it that
        it could not be led off: what was left there stands in its way."""
        top = max(self._overhang_top(self.here), float(self.here[2]) + retract)
        if self._led_straight_up():
            top = max(top, self._air.stock().height(self.here, self.here, self._tool.radius))
        if top > self.here[2]:
            self.feed(np.append(self.here[:2], min(top, height))[None], UPRIGHT, Mark.LEAD)

    def _led_straight_up(self) -> bool:
        """Return whether the tool was just led straight up off a pass: beside something steep, where it had no space for an arc."""
        tips, axis, _, _, mark = self._parts[-1]
        return (
            mark is Mark.LEAD
            and bool(tips[-1, 2] - tips[0, 2] > tolerance.SHORT_MOVE)
            and bool(np.ptp(tips[:, :2], axis=0).max() < SAME)
            and is_upright(axis[-1])
        )

    def _down(self, position: Floats) -> None:
        """Come down upright: at rapid as far as the stock allows, then at feed, slowly where there is material."""
        safe = (
            max(lowest_tip(self._air, position[:2], position[:2]), float(position[2]))
            + self._air.safety
        )
        self._rapid(np.append(position[:2], min(safe, float(self.here[2]))), UPRIGHT)
        if is_free(self._air, position[:2], float(position[2])):
            self._add(position, UPRIGHT, Motion.LINE, self._data.feed, Mark.LEAD)
        else:
            self._add(position, UPRIGHT, Motion.LINE, self._data.plunge_feed, Mark.ENTRY)

    def _leave(self, retract: float) -> None:
        axis, stops = self.axis, self._outside(self.here, self.axis)
        if self._has_retreats:
            self.feed(_towards(self.here, axis, stops[0], retract)[None], axis, Mark.LEAD)
        elif is_upright(axis):
            self._rise(float(stops[0][2]), retract)
        for stop in stops:
            self._rapid(stop, axis)

    def _outside(self, here: Floats, axis: Floats) -> list[Floats]:
        """Return the positions that a tool passes along its axis from the work up to clearance: past blank and fixtures and up
        from there where it leans so much that the path up is longer."""
        height = self._air.clearance + _below(self._tool, float(axis[2]))
        up = (height - here[2]) / axis[2] if axis[2] > 0.0 else math.inf
        aside = (
            max([self._tool.radius, *(max(r0, r1) for _, r0, _, r1 in self._tool.profile())])
            + self._air.safety
        )
        wall = np.where(axis[:2] > 0.0, self._high + aside, self._low - aside)
        to_wall = np.divide(
            wall - here[:2], axis[:2], out=np.full(2, math.inf), where=axis[:2] != 0.0
        ).min()
        if axis[2] >= REORIENT or up <= to_wall:
            return [here + up * axis]
        if to_wall == math.inf:
            raise Refused(
                f"{self._drive.feature}: a tool that points straight up can't be brought to the part"
            )
        stop = here + max(to_wall, 0.0) * axis
        return [stop, np.append(stop[:2], max(height, stop[2]))]

    def _rapid(self, position: Floats, axis: Floats) -> None:
        self._add(position, axis, Motion.RAPID, 0.0, Mark.RETRACT)

    def _add(self, position: Floats, axis: Floats, motion: Motion, feed: float, mark: Mark) -> None:
        self._parts.append((np.asarray(position)[None], np.asarray(axis)[None], motion, feed, mark))


def _towards(here: Floats, axis: Floats, stop: Floats, lift: float) -> Floats:
    """Return the position so many mm along an axis from here, on the way to a stop (3,) at most."""
    far = max(float((stop - here) @ axis), 0.0)
    return np.asarray(here + min(lift, far) * axis)


def _below(tool: Tool, upright: float) -> float:
    """Return how far anything on the spindle is below the tip when the axis has a part `upright` along z."""
    across = math.sqrt(max(1.0 - upright * upright, 0.0))
    rings = [
        (0.0, tool.radius),
        *((z, r) for z0, r0, z1, r1 in tool.profile() for z, r in ((z0, r0), (z1, r1))),
    ]
    return max(0.0, *(r * across - z * upright for z, r in rings))


def _goes(position: Floats, axis: Floats) -> Bools:
    """Return which blocks (n,) go anywhere or turn the tool: posts write four decimals, so a shorter move would be an empty block."""
    kept = np.ones(len(position), dtype=bool)
    while True:
        rows = np.flatnonzero(kept)
        still = (np.linalg.norm(np.diff(position[rows], axis=0), axis=1) < tolerance.SHORT_MOVE) & (
            np.abs(np.diff(axis[rows], axis=0)).max(axis=1) < SAME
        )
        # Of several short moves in a row every other one goes; what is left may then be long enough.
        still[1:] &= ~still[:-1]
        if not still.any():
            return kept
        kept[rows[1:][still]] = False
