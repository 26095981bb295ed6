"""A program of motions: what a post writes and what a reader gives back from text. The proof reads nothing else."""

from __future__ import annotations

from dataclasses import dataclass

from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.model.toolpath import Toolpath

STANDING = 0.5
"""1/min: a spindle at this speed or below stands: speeds are written in whole turns."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ProgramSection:
    """The motions of one operation with one tool. `spindle` 1/min; `block_lines` the text line of each block when read back, else empty.

    `width` ae and `depth` ap mm are the engagement that a `feed` in mm/min was chosen for; 0 where nothing is known of it. `dwell` s is how
    long the text makes the tool wait in all.
    """

    operation: str
    tool: Tool
    spindle: float
    path: Toolpath
    coolant: str = "flood"
    block_lines: tuple[int, ...] = ()
    width: float = 0.0
    depth: float = 0.0
    feed: float = 0.0
    dwell: float = 0.0

    @property
    def spindle_stands(self) -> bool:
        """Whether the spindle does not turn."""
        return self.spindle <= STANDING


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Program:
    """The sections of one setup, in order."""

    name: str
    setup: Setup
    sections: tuple[ProgramSection, ...]

    def n_blocks(self) -> int:
        """Return the number of motion blocks."""
        return sum(len(s.path) for s in self.sections)
