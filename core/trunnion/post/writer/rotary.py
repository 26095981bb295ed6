"""What a section's blocks are on three axes and, in joint form, on a machine with rotary ones; how long blocks take that turn.

Joint form means that the words are the positions of the machine's own axes: the control needs no kinematics of its own. A block in which a
rotary axis turns is fed in inverse time, so that the tip goes at its feed.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from trunnion.findings import Refused
from trunnion.geometry.arrays import Floats, Ints
from trunnion.model.motion.program import ProgramSection
from trunnion.model.motion.toolpath import Motion, Toolpath
from trunnion.model.spindle import FeedMode
from trunnion.model.tool import Tool
from trunnion.post.linearize import PathTolerance, joint_path
from trunnion.post.ticks import TickScale, WrittenPath, upright, written
from trunnion.shop.kinematics import UPRIGHT, WorkPosition, axes_of, poses_of

_DIGITS = 6
"""Digits of an inverse-time feed."""
_SAME_DIRECTION = 1e3 * UPRIGHT
"""Two directions closer than this (their difference's length) differ by what angles are rounded to."""
_SLOWEST = 1e-9
"""mm/min: stands for the feed of a rapid, whose time is not written."""


class AxisForm(Protocol):
    """How the motions of a section become positions that a text says; `letters` are those of the rotary axes among them."""

    @property
    def letters(self) -> str: ...

    def blocks(
        self, section: ProgramSection, angle: list[int] | None, goes_on: bool
    ) -> tuple[WrittenPath, Floats]:
        """Return the blocks of a section as they are written, and the minutes (m,) of those that are fed in inverse time, else 0.

        `angle` is where the rotary axes stand, None when that is not known; `goes_on` says that the tool comes straight from the section
        before. Raises `Refused` for what the machine can't do.
        """
        ...


@dataclass(frozen=True, slots=True, kw_only=True)
class ThreeAxes:
    """Tips of an upright tool."""

    scale: TickScale
    letters: str = ""

    def blocks(
        self, section: ProgramSection, angle: list[int] | None, goes_on: bool
    ) -> tuple[WrittenPath, Floats]:
        """See `AxisForm`; a leaning tool is refused."""
        path = written(upright(section.path, section.operation), self.scale, section.operation)
        return path, inverse_minutes(section, path, self.scale)


@dataclass(frozen=True, slots=True, kw_only=True)
class JointForm:
    """Positions of the axes of a machine on which the work stands at `work_position`; lengths in `scale`, angles in `degrees`."""

    work_position: WorkPosition
    scale: TickScale
    degrees: TickScale
    path_tolerance: PathTolerance

    @property
    def letters(self) -> str:
        """The letters of the rotary axes, in the machine's order."""
        return self.work_position.names

    def blocks(
        self, section: ProgramSection, angle: list[int] | None, goes_on: bool
    ) -> tuple[WrittenPath, Floats]:
        """See `AxisForm`."""
        start_angle = None if angle is None else self.radians(np.array(angle))
        joints = joint_path(
            section.path,
            section.cutter,
            self.work_position,
            start_angle,
            self.path_tolerance,
            section.operation,
        )
        moved = Toolpath(
            position=joints.words,
            axis=np.tile([0.0, 0.0, 1.0], (len(joints.words), 1)),
            motion=joints.motion,
            centre=joints.centre,
            feed=joints.feed,
            mark=np.zeros(len(joints.words), np.int64),
            dwell=joints.dwell,
        )
        path = written(
            moved, self.scale, section.operation, self.degrees.ticks(np.degrees(joints.angle))
        )
        if goes_on and path.more[0].tolist() != angle:
            self.refuse_another_direction(angle, path.more[0], section.operation)
        turning = self.minutes(path, section.cutter)
        return path, np.where(turning > 0.0, turning, inverse_minutes(section, path, self.scale))

    def refuse_another_direction(
        self, before: list[int] | None, after: Ints, operation: str
    ) -> None:
        """Refuse an operation that begins in another direction than the tool has: only its own path knows a safe way there."""
        old, new = axes_of(self.work_position, self.radians(np.array([before, after])))
        if np.linalg.norm(new - old) > _SAME_DIRECTION:
            raise Refused(
                f"operation {operation} begins with the tool in another direction than the one before it ends with: "
                "lead it there over the work first"
            )

    def minutes(self, path: WrittenPath, tool: Tool) -> Floats:
        """Return how long (m,) the blocks in which a rotary axis turns last, from what is written: the tip at its feed, unless an axis of
        the machine needs longer."""
        angle = self.radians(path.more)
        words = np.asarray(
            path.point * (self.scale.unit / 10.0**self.scale.decimals), dtype=np.float64
        )
        tip, _ = poses_of(self.work_position, words, angle, tool.gauge_length)
        rates = np.array(
            [self.work_position.machine.axis(name).rapid for name in (*"XYZ", *self.letters)]
        )
        axes = np.abs(np.diff(np.column_stack([words, np.degrees(angle)]), axis=0)) / rates
        time = np.maximum(
            np.linalg.norm(np.diff(tip, axis=0), axis=1) / np.maximum(path.feed[1:], _SLOWEST),
            axes.max(axis=1),
        )
        turns = (path.more[1:] != path.more[:-1]).any(axis=1) & (path.motion[1:] != Motion.RAPID)
        return np.concatenate([[0.0], np.where(turns, time, 0.0)])

    def radians(self, ticks: Ints) -> Floats:
        """Return angles in radians from ticks."""
        return np.asarray(np.radians(ticks / 10.0**self.degrees.decimals))


def inverse_minutes(section: ProgramSection, path: WrittenPath, scale: TickScale) -> Floats:
    """Return how long (m,) the feed blocks of a section last whose feeds are given in inverse time, from what is written; else 0."""
    if section.feed_mode is not FeedMode.INVERSE:
        return np.zeros(len(path.motion))
    feeds = path.motion != Motion.RAPID
    length = path.in_mm(scale).lengths()
    return np.divide(length, path.feed, out=np.zeros(len(feeds)), where=feeds)


def inverse_time(minutes: float) -> str:
    """Return an inverse-time feed, rounded down so that no block is faster than it was meant.

    >>> inverse_time(0.003)
    '333.333'
    """
    decimals = max(0, _DIGITS - 1 - math.floor(math.log10(1.0 / minutes)))
    text = f"{math.floor(10.0**decimals / minutes) / 10.0**decimals:.{decimals}f}"
    return text.rstrip("0").rstrip(".") if "." in text else text
