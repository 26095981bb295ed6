"""Interrupted turning: the table turns the ground under the tool, which is down in the gaps and lifted over what stands between them.

The table never stops: one turn goes from gap to gap at an even angular speed, up and down as quickly as the tool's axis may, from rest to
rest (`plan/turning/retract.py`). Each block is a chord of the way; on the ground chords lie half their error on either side of the circle.
Between two passes the tool moves along the ground while it is lifted.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from trunnion.findings import Finding, warning
from trunnion.geometry.arrays import Floats, Ints
from trunnion.model.motion.toolpath import EMPTY, Mark, Motion, Toolpath
from trunnion.model.operation import CuttingData
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.plan.turning.gap_drive import GapDrive, GapPass
from trunnion.plan.turning.gap_motion import PER_MINUTE, GapMotion
from trunnion.plan.turning.retract import travelled
from trunnion.progress import Progress
from trunnion.settings import setting, settings
from trunnion.toolpath.contract import Planned, leaning_axis, strategy
from trunnion.toolpath.stock.heightfield import PlanningStock
from trunnion.units import SECONDS_PER_MINUTE

TURN = 2.0 * math.pi
STEPS = 12
"""Blocks of a way out of a gap, or back into it."""
LIFTED_CHORD = 0.1
"""mm that blocks of a lifted tool may be off their circles."""


@settings("turning.interrupted")
class GapSettings:
    """How the tool leaves gaps and comes back while the table turns; the planner of a casing gives all but the chord."""

    retract_speed: float = setting(
        20.0,
        unit="m/min",
        low=0.1,
        high=500.0,
        label="Speed of retracting",
        help="Highest speed of the axis that takes the tool out of the gap and back.",
    )
    acceleration: float = setting(
        3000.0,
        unit="mm/s2",
        low=1.0,
        high=50000.0,
        label="Acceleration",
        help="Acceleration of that axis.",
    )
    margin: float = setting(
        5.0,
        unit="mm",
        low=0.0,
        high=1000.0,
        label="Margin",
        help="Length of a gap that is kept free for reaction times, half of it at either end.",
    )
    shortest: float = setting(
        30.0,
        unit="mm",
        low=0.0,
        high=10000.0,
        label="Shortest cut",
        help="Length of ground that must be cut in a gap to be worth the way in and out.",
    )
    threshold: float = setting(
        0.0,
        unit="mm",
        low=0.0,
        high=10000.0,
        label="Shortest gap",
        help="Length that a gap must have in any case; 0: what its ends and the shortest cut need.",
    )
    chord: float = setting(
        0.004,
        unit="mm",
        low=0.0005,
        high=0.1,
        label="Chord error",
        help="How far blocks may be off their circles, half of it on either side.",
    )

    @property
    def motion(self) -> GapMotion:
        """How the tool moves in gaps."""
        return GapMotion(
            retract_speed=self.retract_speed,
            acceleration=self.acceleration,
            margin=self.margin,
            shortest=self.shortest,
            threshold=self.threshold,
        )


@strategy(settings=GapSettings, drive=GapDrive, tool_axis=leaning_axis)
def interrupted(
    drive: GapDrive,
    tool: Tool,
    data: CuttingData,
    stock: PlanningStock,
    setup: Setup,
    settings: GapSettings,
    progress: Progress,
) -> Planned:
    """Return the motions that turn every gap of the drive, the table turning one way all along."""
    if drive.is_empty:
        return Planned()
    path = _GapPath(drive, settings, data.speed * PER_MINUTE)
    short = 0
    for each in progress.each(drive.passes):
        radius = float(drive.development.radius_at(np.array([each.along]))[0])
        least = 2.0 * settings.motion.end(data.speed, each.lift) / radius
        gaps = tuple(g for g in each.gaps if g[1] - g[0] > least)
        short += len(each.gaps) - len(gaps)
        path.add(replace(each, gaps=gaps))
    return Planned(path=path.made(setup), findings=_left(short, tool))


def _left(short: int, tool: Tool) -> tuple[Finding, ...]:
    if not short:
        return ()
    return (
        warning(
            "turning.gap-too-short",
            f"{short} gaps are no longer than {tool.name} takes out of them and in again: they are not turned",
            remedy="choose a lower speed of the ground, or a quicker retract (turning.interrupted.retract_speed)",
        ),
    )


class _GapPath:
    """The way of the tool's tip in the making: rows of place along the ground, angle, height (mm, rad, mm) and what they are for."""

    def __init__(self, drive: GapDrive, settings: GapSettings, speed: float) -> None:
        self.drive, self.settings, self.speed = drive, settings, speed
        self.motion = settings.motion
        self._rows: list[Floats] = []
        self._marks: list[Ints] = []
        self._turn: float | None = None
        self._lifted: tuple[float, float] = (0.0, 0.0)

    def add(self, each: GapPass) -> None:
        """Go through the gaps of a pass, in the order in which they come."""
        if not each.gaps:
            return
        radius = float(self.drive.development.radius_at(np.array([each.along]))[0])
        begun = self._turn if self._turn is not None else each.gaps[0][0]
        for start, end in sorted(each.gaps, key=lambda g: (g[0] - begun) % TURN):
            ahead = start + TURN * math.ceil((begun - start) / TURN - 1e-12)
            ahead = ahead if self._turn is None or ahead >= self._turn else ahead + TURN
            self._gap(each, radius, ahead, ahead + end - start)

    def _gap(self, each: GapPass, radius: float, start: float, end: float) -> None:
        """Come to a gap lifted, go down, cut and go up again; angles in rad as the table has turned."""
        margin = 0.5 * self.settings.margin / radius
        ramp = self.motion.end(self.speed / PER_MINUTE, each.lift) / radius - margin
        begin, stop = start + margin, end - margin
        self._lifted_to(each, radius, begin)
        share = np.arange(1, STEPS + 1) / STEPS
        half = 0.5 * self.settings.chord
        down = each.lift - half
        out = travelled(
            share * self.motion.time_out(each.lift),
            down,
            self.settings.retract_speed * PER_MINUTE,
            self.settings.acceleration,
        )
        out = np.minimum(out, down)
        out[-1] = down
        self._put(each.along, begin + share * ramp, each.lift - out, Mark.ENTRY)
        step = 2.0 * math.acos(1.0 - self.settings.chord / radius)
        low, high = begin + ramp, stop - ramp
        count = max(1, math.ceil((high - low) / step))
        cut = low + (high - low) * np.arange(1, count + 1) / count
        self._put(each.along, cut, np.full(count, half), Mark.CUT)
        self._put(each.along, high + share * ramp, half + out, Mark.LEAD)
        self._turn, self._lifted = stop, (each.along, each.lift)

    def _lifted_to(self, each: GapPass, radius: float, turn: float) -> None:
        """Go on lifted from where the last gap was left, along the ground to the next pass where it is another one."""
        if self._turn is None:
            self._put(each.along, np.array([turn]), np.array([each.lift]), Mark.RETRACT)
            return
        step = 2.0 * math.acos(1.0 - LIFTED_CHORD / (radius + each.lift))
        count = max(1, math.ceil((turn - self._turn) / step))
        share = np.arange(1, count + 1) / count
        along, lift = self._lifted
        # As high as the higher of both passes all the way between them.
        high = max(lift, each.lift)
        heights = np.full(count, high)
        heights[-1] = each.lift
        self._put(
            along + share * (each.along - along),
            self._turn + share * (turn - self._turn),
            heights,
            Mark.LINK,
        )

    def _put(self, along: float | Floats, turns: Floats, heights: Floats, mark: Mark) -> None:
        self._rows.append(np.column_stack([np.broadcast_to(along, turns.shape), turns, heights]))
        self._marks.append(np.full(len(turns), mark))

    def made(self, setup: Setup) -> Toolpath:
        """Return the path in a setup's frame: a rapid over its start first, one up to where all is clear last."""
        if not self._rows:
            return EMPTY
        rows = np.concatenate(self._rows)
        ends = rows[[0, -1]].copy()
        ends[:, 2] = self.drive.clearance
        rows = np.vstack([ends[:1], rows, ends[1:]])
        marks = np.concatenate([[Mark.RETRACT], *self._marks, [Mark.RETRACT]])
        development, frame = self.drive.development, setup.frame
        position = frame.to_local(development.points_about_axis(*rows.T))
        n = len(rows)
        motion = np.full(n, Motion.LINE)
        motion[[0, 1, -1]] = Motion.RAPID
        radius = development.radius_at(rows[:, 0])
        length = np.zeros(n)
        length[1:] = np.linalg.norm(np.diff(position, axis=0), axis=1)
        seconds = np.zeros(n)
        seconds[1:] = np.diff(rows[:, 1]) * radius[1:] / self.speed
        cuts = (motion == Motion.LINE) & (seconds > 0.0)
        feed = np.divide(SECONDS_PER_MINUTE * length, seconds, out=np.zeros(n), where=cuts)
        return Toolpath(
            position=position,
            axis=frame.local_direction(development.normals_about_axis(rows[:, 1])),
            motion=motion,
            centre=np.full((n, 3), np.nan),
            feed=feed,
            mark=marks,
            dwell=None,
        )
