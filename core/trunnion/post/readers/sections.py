"""Gathers the motions that a reader understands into sections; adds where the tool comes from when the text leaves it open."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from trunnion import tolerance
from trunnion.findings import BadInput
from trunnion.model.program import ProgramSection
from trunnion.model.tool import Tool
from trunnion.model.toolpath import Mark, Motion, Toolpath

Point = tuple[float, float, float]
NOWHERE = (math.nan, math.nan, math.nan)


@dataclass(slots=True, kw_only=True)
class _Open:
    """A section that still grows; `cutting` is spindle and coolant at its first feed move, `idle` at its last rapid before."""

    operation: str
    tool: Tool
    cutting: tuple[float, str] | None = None
    idle: tuple[float, str] = (0.0, "off")
    position: list[Point] = field(default_factory=list)
    motion: list[int] = field(default_factory=list)
    centre: list[Point] = field(default_factory=list)
    feed: list[float] = field(default_factory=list)
    line: list[int] = field(default_factory=list)

    def closed(self) -> ProgramSection:
        n = len(self.motion)
        axis = np.zeros((n, 3))
        axis[:, 2] = 1.0
        motion = np.array(self.motion)
        path = Toolpath(position=np.array(self.position), axis=axis, motion=motion, centre=np.array(self.centre),
                        feed=np.array(self.feed), mark=np.where(motion == Motion.RAPID, Mark.RETRACT, Mark.CUT))
        spindle, coolant = self.cutting or self.idle
        return ProgramSection(operation=self.operation, tool=self.tool, spindle=spindle, path=path, coolant=coolant,
                              block_lines=tuple(self.line))


class Sections:
    """The sections of one setup while its text is read.

    A section ends where an operation begins, the tool changes, or spindle or coolant change between feed moves. Its first block is a rapid:
    when the text goes on from a place that is not up at the clearance height, that place is the first block, so that what follows is judged
    from where it really starts; after a tool change the tool comes from above, at the clearance height or higher.
    """

    def __init__(self, clearance: float) -> None:
        self.clearance = clearance
        self.at: Point | None = None
        self._done: list[ProgramSection] = []
        self._open: _Open | None = None
        self._operation = ""

    def operation(self, name: str) -> None:
        """Begin an operation; its tool may still change before the first motion."""
        self._close()
        self._operation = name

    def change_tool(self) -> None:
        """End the section: the tool that follows comes from an unknown place above everything."""
        if self._open is not None:
            began_with_it = self._open.cutting is not None
            self._close()
            self._operation = "" if began_with_it else self._operation
        self.at = None

    def lift(self, line: int, tool: Tool, state: tuple[float, str]) -> None:
        """Take the tool straight up out of sight (G53 G0 Z0)."""
        if self.at is not None:
            if self.at[2] < self.clearance - tolerance.WRITTEN:
                self.rapid(line, (self.at[0], self.at[1], self.clearance), tool, state)
            self.at = None

    def rapid(self, line: int, point: Point, tool: Tool, state: tuple[float, str]) -> None:
        """Add a rapid to a point; `state` is spindle and coolant, for a section that cuts nothing."""
        if self._open is None:
            self._begin(line, tool)
            first = self.at if self.at is not None else (point[0], point[1], max(point[2], self.clearance))
            low = first[2] < self.clearance - tolerance.WRITTEN
            if low or (self.at is None and point[2] < self.clearance - tolerance.WRITTEN):
                self._add(line, Motion.RAPID, first, NOWHERE, 0.0)
        self._add(line, Motion.RAPID, point, NOWHERE, 0.0)
        if self._open is not None:
            self._open.idle = state

    def feed(self, line: int, motion: Motion, point: Point, centre: Point, feed: float, tool: Tool, cutting: tuple[float, str]) -> None:
        """Add a feed move, a line or an arc, with the spindle and coolant it runs with."""
        if self.at is None:
            raise BadInput(f"line {line}: a feed move before it is known where the tool is; begin with a rapid to X, Y and Z")
        opened = self._open
        if opened is not None and opened.cutting not in (None, cutting):
            self._close()
            opened = None
        if opened is None:
            start = self.at
            opened = self._begin(line, tool)
            self._add(line, Motion.RAPID, start, NOWHERE, 0.0)
        opened.cutting = cutting
        self._add(line, motion, point, centre, feed)

    def finished(self) -> tuple[ProgramSection, ...]:
        """Return all sections; raise `BadInput` when nothing moves."""
        self._close()
        if not self._done:
            raise BadInput("the program moves nothing: it holds no feed move or rapid")
        return tuple(self._done)

    def _begin(self, line: int, tool: Tool) -> _Open:
        self._open = _Open(operation=self._operation or f"line {line}", tool=tool)
        self._operation = self._open.operation
        return self._open

    def _add(self, line: int, motion: Motion, point: Point, centre: Point, feed: float) -> None:
        opened = self._open
        assert opened is not None
        opened.position.append(point)
        opened.motion.append(motion)
        opened.centre.append(centre)
        opened.feed.append(feed)
        opened.line.append(line)
        self.at = point

    def _close(self) -> None:
        if self._open is not None:
            self._done.append(self._open.closed())
            self._open = None
