"""The modal state of a control while a text runs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.model.toolpath import Motion
from trunnion.post.readers.sections import Sections


@dataclass(slots=True, kw_only=True)
class ModalState:
    """What the control knows. Lengths are mm in the setup frame.

    `unit` mm of a written length; `feed` mm/min, in inverse time 1/min, 0 when it must be given; `spindle` 1/min as it was given, it turns
    while `turning`; `tool` is in the spindle, `next_tool` was chosen; `length_on` says that the tool's length counts; `over` is X and Y of
    a tool above everything whose height is not known yet.
    """

    tools: Mapping[int, Tool]
    setup: Setup
    sections: Sections
    unit: float = 1.0
    units_given: bool = False
    offset: str = ""
    motion: Motion | None = None
    tool: Tool | None = None
    next_tool: Tool | None = None
    length_on: bool = False
    over: tuple[float, float] | None = None
    feed: float = 0.0
    inverse: bool = False
    spindle: float = 0.0
    speed_given: bool = False
    turning: bool = False
    coolant: str = "off"

    def cutting(self) -> tuple[float, str]:
        """Return spindle and coolant, for the section that a move belongs to."""
        return self.spindle, self.coolant
