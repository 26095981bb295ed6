"""Gathers the motions that a reader understands into sections; adds where the tool comes from when the text leaves it open."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field, replace
from typing import NamedTuple, Protocol

import numpy as np

from trunnion import tolerance
from trunnion.findings import BadInput
from trunnion.geometry.arrays import Floats, Ints
from trunnion.model.motion.program import UNSAID, ProgramSection, Stance
from trunnion.model.motion.toolpath import ACROSS, Mark, Motion, Toolpath
from trunnion.model.spindle import FeedMode
from trunnion.model.tool import AnyTool

Point = tuple[float, ...]
"""A position as a reader counts it: x, y, z mm, and after them what else says where the tool is (rotary angles, the tool axis)."""
_OPERATION = re.compile(r"OPERATION\s+(\S+)$", re.IGNORECASE)
LEAST_FEED = 1e-3
"""mm/min: what a block is fed at in which the tip stands while an axis turns; how long it takes the machine's axes say."""
NOWHERE = (math.nan, math.nan, math.nan)


class CuttingState(NamedTuple):
    """What a move runs with: spindle in 1/min (at a constant surface speed in m/min the highest), coolant."""

    spindle: float
    coolant: str
    surface_speed: float = 0.0


class Pace(NamedTuple):
    """How fast a block is fed: its feed in mm/min, the minutes of one that is fed in inverse time, else 0, and what its text gives."""

    feed: float
    minutes: float = 0.0
    mode: FeedMode = FeedMode.MINUTE


@dataclass(slots=True, kw_only=True)
class SectionBlocks:
    """The blocks of a section while it grows; `minutes` are those of blocks fed in inverse time, else 0; `modes` how feeds are given,
    `stances` as in `ProgramSection`."""

    tool: AnyTool
    point: list[Point] = field(default_factory=list)
    motion: list[int] = field(default_factory=list)
    centre: list[Point] = field(default_factory=list)
    feed: list[float] = field(default_factory=list)
    minutes: list[float] = field(default_factory=list)
    line: list[int] = field(default_factory=list)
    dwell: list[float] = field(default_factory=list)
    modes: set[FeedMode] = field(default_factory=set)
    stances: list[tuple[int, Stance]] = field(default_factory=list)

    @property
    def feed_mode(self) -> FeedMode:
        """How the feeds are given: by the minute too where they are given in several ways."""
        return next(iter(self.modes)) if len(self.modes) == 1 else FeedMode.MINUTE


class PoseInterpreter(Protocol):
    """What the points of a text mean."""

    def above(self, point: Point, tool: AnyTool) -> Point | None:
        """Return where a tool at a point comes out when it is lifted above everything; None when it is as high already."""
        ...

    def opened(self, rows: SectionBlocks) -> tuple[Toolpath, tuple[int, ...]]:
        """Return the motions that the blocks amount to, and the line of each."""
        ...


@dataclass(frozen=True, slots=True)
class UprightPoses:
    """Points are tips in the setup frame, the tool stands along z; above everything is the clearance height."""

    clearance: float

    def above(self, point: Point, tool: AnyTool) -> Point | None:
        """See `PoseInterpreter`."""
        return (
            None
            if point[2] >= self.clearance - tolerance.WRITTEN
            else (point[0], point[1], self.clearance)
        )

    def opened(self, rows: SectionBlocks) -> tuple[Toolpath, tuple[int, ...]]:
        """See `PoseInterpreter`."""
        axis = np.tile((0.0, 0.0, 1.0) if rows.tool.rotates else ACROSS, (len(rows.motion), 1))
        return path_of(rows, np.array(rows.point), axis, np.array(rows.centre)), tuple(rows.line)


@dataclass(frozen=True, slots=True)
class TiltedPoses:
    """Points are tips in the setup frame and the unit axis of the tool; an upright one is lifted to the clearance height."""

    clearance: float

    def above(self, point: Point, tool: AnyTool) -> Point | None:
        """See `PoseInterpreter`; a leaning tool comes from wherever the text's machine brings it from."""
        high = point[2] >= self.clearance - tolerance.WRITTEN
        return (
            None
            if high or point[3:] != (0.0, 0.0, 1.0)
            else (point[0], point[1], self.clearance, *point[3:])
        )

    def opened(self, rows: SectionBlocks) -> tuple[Toolpath, tuple[int, ...]]:
        """See `PoseInterpreter`."""
        points = np.array(rows.point)
        axis = points[:, 3:] if rows.tool.rotates else np.tile(ACROSS, (len(points), 1))
        return path_of(rows, points[:, :3], axis, np.array(rows.centre)), tuple(rows.line)


def operation_of(comment: str) -> str | None:
    """Return the operation that a comment of ours begins; None for another comment.

    >>> operation_of("OPERATION pocket-01.rough")
    'pocket-01.rough'
    """
    found = _OPERATION.match(comment)
    return found.group(1) if found else None


def path_of(rows: SectionBlocks, position: Floats, axis: Floats, centre: Floats) -> Toolpath:
    """Return the path of rows whose tips, axes and centres are known."""
    motion, minutes = np.array(rows.motion), np.array(rows.minutes)
    path = Toolpath(
        position=position,
        axis=axis,
        motion=motion,
        centre=centre,
        feed=np.array(rows.feed),
        mark=marks_of(motion),
        dwell=np.array(rows.dwell),
        work_turns=not rows.tool.rotates,
    )
    timed = minutes > 0.0
    if not timed.any():
        return path
    feed = path.lengths() / np.where(timed, minutes, 1.0)
    return replace(path, feed=np.where(timed, np.maximum(feed, LEAST_FEED), path.feed))


def marks_of(motion: Ints) -> Ints:
    """Return what blocks are for as far as a text says it: rapids retract, all else cuts."""
    return np.where(motion == Motion.RAPID, Mark.RETRACT, Mark.CUT)


_IDLE = CuttingState(0.0, "off")
"""While nothing runs."""


@dataclass(slots=True, kw_only=True)
class _Open:
    """A section that still grows; `cutting` is spindle and coolant at its first feed move, `idle` at its last rapid before, `dwell` how
    long it waits, s."""

    operation: str
    rows: SectionBlocks
    cutting: CuttingState | None = None
    idle: CuttingState = _IDLE
    dwell: float = 0.0

    def closed(self, interpreter: PoseInterpreter) -> ProgramSection:
        path, lines = interpreter.opened(self.rows)
        spindle, coolant, surface_speed = self.cutting or self.idle
        return ProgramSection(
            operation=self.operation,
            tool=self.rows.tool,
            spindle=spindle,
            path=path,
            coolant=coolant,
            block_lines=lines,
            dwell=self.dwell,
            surface_speed=surface_speed,
            feed_mode=self.rows.feed_mode,
            stances=tuple(self.rows.stances),
        )


class Sections:
    """The sections of one setup while its text is read.

    A section ends where an operation begins, the tool changes, or spindle or coolant change between feed moves. Its first block is a rapid:
    when the text goes on from a position that is not up at the clearance height, that position is the first block, so that what follows is
    judged from where it really starts; after a tool change the tool comes from above, at the clearance height or higher. `stance` is what
    the text has said of the rotary axes for the block that comes next.
    """

    def __init__(self, interpreter: PoseInterpreter) -> None:
        self.interpreter = interpreter
        self.at: Point | None = None
        self._done: list[ProgramSection] = []
        self._open: _Open | None = None
        self._operation = ""
        self._waits = 0.0
        self.stance = UNSAID

    @property
    def local(self) -> Point | None:
        """Where the tool is as the text counts it; None while that is not known."""
        return self.at

    def operation(self, name: str) -> None:
        """Begin an operation; its tool may still change before the first motion."""
        self._close()
        self._operation = name

    def change_tool(self) -> None:
        """End the section: the tool that follows comes from an unknown position above everything."""
        if self._open is not None:
            began_with_it = self._open.cutting is not None
            self._close()
            self._operation = "" if began_with_it else self._operation
        self.at = None

    def lift(self, line: int, tool: AnyTool, state: CuttingState) -> None:
        """Take the tool straight up out of sight (G53 G0 Z0)."""
        if self.at is not None:
            if (up := self.interpreter.above(self.at, tool)) is not None:
                self.rapid(line, up, tool, state)
            self.at = None

    def rapid(self, line: int, point: Point, tool: AnyTool, state: CuttingState) -> None:
        """Add a rapid to a point; `state` is spindle and coolant, for a section that cuts nothing."""
        if self._open is None:
            self._begin(line, tool)
            start = self.interpreter.above(point, tool) if self.at is None else self.at
            if start is not None and (
                self.at is None
                or start[3:] != point[3:]
                or self.interpreter.above(start, tool) is not None
            ):
                self._add(line, Motion.RAPID, start, NOWHERE, 0.0)
        self._add(line, Motion.RAPID, point, NOWHERE, 0.0)
        if self._open is not None:
            self._open.idle = state

    def feed(
        self,
        line: int,
        motion: Motion,
        point: Point,
        centre: Point,
        pace: Pace,
        tool: AnyTool,
        cutting: CuttingState,
    ) -> None:
        """Add a feed move, a line or an arc, with the spindle and coolant it runs with."""
        if self.at is None:
            raise BadInput(
                f"line {line}: a feed move before it is known where the tool is; begin with a rapid to X, Y and Z"
            )
        opened = self._open
        if opened is not None and opened.cutting not in (None, cutting):
            self._close()
            opened = None
        if opened is None:
            start = self.at
            opened = self._begin(line, tool)
            self._add(line, Motion.RAPID, start, NOWHERE, 0.0)
        opened.cutting = cutting
        opened.rows.modes.add(pace.mode)
        self._add(line, motion, point, centre, pace.feed, pace.minutes)

    def dwell(self, seconds: float) -> None:
        """Wait: a dwell between two sections belongs to the one that follows, after the last to that."""
        if self._open is not None:
            self._open.dwell += seconds
            self._open.rows.dwell[-1] += seconds
        else:
            self._waits += seconds

    def finished(self) -> tuple[ProgramSection, ...]:
        """Return all sections; raise `BadInput` when nothing moves."""
        self._close()
        if not self._done:
            raise BadInput("the program moves nothing: it holds no feed move or rapid")
        self._done[-1] = replace(self._done[-1], dwell=self._done[-1].dwell + self._waits)
        self._waits = 0.0
        return tuple(self._done)

    def _begin(self, line: int, tool: AnyTool) -> _Open:
        self._open = _Open(
            operation=self._operation or f"line {line}",
            rows=SectionBlocks(tool=tool),
            dwell=self._waits,
        )
        self._waits = 0.0
        self._operation = self._open.operation
        return self._open

    def _add(
        self,
        line: int,
        motion: Motion,
        point: Point,
        centre: Point,
        feed: float,
        minutes: float = 0.0,
    ) -> None:
        assert self._open is not None
        rows = self._open.rows
        if self.stance != UNSAID:
            rows.stances.append((len(rows.point), self.stance))
            self.stance = UNSAID
        rows.point.append(point)
        rows.motion.append(motion)
        rows.centre.append(centre)
        rows.feed.append(feed)
        rows.minutes.append(minutes)
        rows.line.append(line)
        rows.dwell.append(0.0)
        self.at = point

    def _close(self) -> None:
        if self._open is not None:
            self._done.append(self._open.closed(self.interpreter))
            self._open = None
