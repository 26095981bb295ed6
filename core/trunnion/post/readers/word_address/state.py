"""The modal state of a control while a text runs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from trunnion.model.motion.cycle import CycleKind
from trunnion.model.motion.toolpath import Motion
from trunnion.model.setup import Setup
from trunnion.model.spindle import FeedMode, limited_turns
from trunnion.model.tool import AnyTool
from trunnion.post.readers.sections import CuttingState, Sections


@dataclass(slots=True, kw_only=True)
class ModalCycle:
    """A drilling cycle that is in force: its code and kind; `level` Z in mm where it began, None before its first hole; `bottom` and
    `retract` Z in mm, `peck` mm and `dwell` s as they were last given."""

    code: str
    kind: CycleKind
    level: float | None = None
    bottom: float | None = None
    retract: float | None = None
    peck: float = 0.0
    dwell: float | None = None


@dataclass(slots=True, kw_only=True)
class ModalState:
    """What the control knows. Lengths are mm in the setup frame.

    `unit` mm of a written length; `feed` mm/min, mm a revolution or in inverse time 1/min, 0 when it must be given; `spindle` 1/min as it
    was given, or the highest while it `keeps_surface` at `surface_speed` in m/min; it turns while `turning`, is held at its angle while
    `locked`; `tool` is in the spindle, `next_tool` was chosen; `length_on` says that the tool's length counts; `over` is X and Y of a tool
    above everything whose height is not known yet. `cycle` is in force in place of a motion; it ends at the level where it began
    (`returns_to_level`) or at its retract plane.
    Arcs lie in the plane ZX while `in_zx`; `diameters`: X is one.
    """

    tools: Mapping[int, AnyTool]
    setup: Setup
    sections: Sections
    unit: float = 1.0
    units_given: bool = False
    offset: str = ""
    motion: Motion | None = None
    tool: AnyTool | None = None
    next_tool: AnyTool | None = None
    length_on: bool = False
    over: tuple[float, float] | None = None
    feed: float = 0.0
    feed_mode: FeedMode = FeedMode.MINUTE
    spindle: float = 0.0
    surface_speed: float = 0.0
    keeps_surface: bool = False
    speed_given: bool = False
    turning: bool = False
    locked: bool = False
    coolant: str = "off"
    cycle: ModalCycle | None = None
    returns_to_level: bool = True
    in_zx: bool = False
    diameters: bool = False

    @property
    def x_unit(self) -> float:
        """mm from the work's axis of a written X."""
        return 0.5 * self.unit if self.diameters else self.unit

    def cutting(self) -> CuttingState:
        """Return what a move runs with, for the section that it belongs to."""
        return CuttingState(
            self.spindle, self.coolant, self.surface_speed if self.keeps_surface else 0.0
        )

    def turns_at(self, x: float) -> float:
        """Return the spindle speed in 1/min where the tool is at an X in mm."""
        if not self.keeps_surface:
            return self.spindle
        return float(limited_turns(self.surface_speed, 2.0 * abs(x), self.spindle))
