"""A program of motions: what a post writes and what a reader gives back from text. The proof reads nothing else."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from trunnion.geometry.arrays import Floats
from trunnion.model.guides import GuideChain
from trunnion.model.motion.toolpath import Toolpath
from trunnion.model.operation import Operation
from trunnion.model.setup import Setup
from trunnion.model.spindle import FeedMode, limited_turns
from trunnion.model.tool import AnyTool, Tool, rotating

STOPPED = 0.5
"""1/min: a spindle at this speed or below stands: speeds are written in whole turns."""


class Stance(NamedTuple):
    """How rotary axes stand: `side` is the sign of the angle of the axis that leans the tool (`model.material.leaning_axis`), 0 where it is
    not said; `angles` in rad those of all of them, empty where they are not."""

    side: int = 0
    angles: tuple[float, ...] = ()


UNSAID = Stance()
"""A text that leaves it to the control."""
NO_STANCES: Mapping[int, Stance] = MappingProxyType({})
"""Stances of a text that leaves all to the control."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ProgramSection:
    """The motions of one operation with one tool. `spindle` 1/min; `block_lines` the text line of each block when read back, else empty.

    `width` ae and `depth` ap mm are the engagement that a `feed` in mm/min was chosen for; 0 where nothing is known of it. `dwell` s is how
    long the text makes the tool wait in all, the path's own dwells in it. At a constant `surface_speed` in m/min (0: none) the work turns
    about the setup's z and `spindle` is never passed. `feed_mode` is how a text gives the feeds, which the path has in mm/min. `stances`
    are what it says of the rotary axes, each with the block at whose end they stand so. `guides` are the guide lines that led the
    operation, where they are known.
    """

    operation: str
    tool: AnyTool
    spindle: float
    path: Toolpath
    coolant: str = "flood"
    block_lines: tuple[int, ...] = ()
    width: float = 0.0
    depth: float = 0.0
    feed: float = 0.0
    dwell: float = 0.0
    surface_speed: float = 0.0
    feed_mode: FeedMode = FeedMode.MINUTE
    stances: tuple[tuple[int, Stance], ...] = ()
    guides: tuple[GuideChain, ...] = ()

    @property
    def spindle_stopped(self) -> bool:
        """Whether the spindle does not turn."""
        return self.spindle <= STOPPED

    @property
    def cutter(self) -> Tool:
        """The tool where it rotates; raises `BadInput` for a turning tool."""
        return rotating(self.tool, self.operation)

    def turns(self) -> Floats:
        """Return the spindle speed (n,) in 1/min at the end of each block."""
        if self.surface_speed <= 0.0:
            return np.full(len(self.path), self.spindle)
        return limited_turns(
            self.surface_speed, 2.0 * np.abs(self.path.position[:, 0]), self.spindle
        )


def section_of(
    operation: Operation, path: Toolpath, guides: tuple[GuideChain, ...] = ()
) -> ProgramSection:
    """Return the section that an operation's toolpath makes, with the engagement that its feed was chosen for, and the guide lines that led
    it."""
    data = operation.data
    return ProgramSection(
        operation=operation.id,
        tool=operation.tool,
        spindle=operation.spindle,
        surface_speed=operation.surface_speed,
        path=path,
        dwell=float(path.dwells().sum()),
        width=data.width,
        depth=data.depth,
        feed=data.feed,
        feed_mode=data.feed_mode,
        guides=guides,
    )


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Program:
    """The sections of one setup, in order."""

    name: str
    setup: Setup
    sections: tuple[ProgramSection, ...]

    def n_blocks(self) -> int:
        """Return the number of motion blocks."""
        return sum(len(s.path) for s in self.sections)
