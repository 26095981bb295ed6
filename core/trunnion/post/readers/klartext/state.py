"""What a control in Klartext knows while a text runs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from trunnion.findings import BadInput
from trunnion.model.setup import Setup
from trunnion.model.tool import AnyTool
from trunnion.post.readers.hole_strokes import HoleStroke
from trunnion.post.readers.sections import CuttingState, Sections
from trunnion.units import MM_PER_INCH

FEEDS_AN_INCH = 10.0
"""In a program in inches feeds are counted in tenths of an inch a minute."""


@dataclass(slots=True, kw_only=True)
class KlartextState:
    """Lengths are mm in the plane in force.

    `unit` mm of a written length; `feed` mm/min, 0 when it must be given; `spindle` 1/min, turning while `turning`; `preset` says that the
    setup's work offset is in force; `over` is X and Y of a tool above everything whose height is not known yet; `pole` X and Y of the last
    centre of an arc; `cycle` what is cut where a cycle is called.
    """

    tools: Mapping[int, AnyTool]
    setup: Setup
    sections: Sections
    unit: float = 1.0
    tool: AnyTool | None = None
    spindle: float = 0.0
    turning: bool = False
    coolant: str = "off"
    feed: float = 0.0
    preset: bool = False
    over: tuple[float, float] | None = None
    pole: tuple[float, float] | None = None
    cycle: tuple[HoleStroke, ...] = ()

    @property
    def feed_unit(self) -> float:
        """mm/min of a written feed."""
        return self.unit if self.unit == 1.0 else MM_PER_INCH / FEEDS_AN_INCH

    def cutting(self) -> CuttingState:
        """Return what a move runs with."""
        return CuttingState(self.spindle, self.coolant)

    def ready(self, line: int) -> AnyTool:
        """Return the tool when the control knows all it needs for a move; raise `BadInput` otherwise."""
        if self.tool is None:
            raise BadInput(
                f"line {line}: a move before a tool is in the spindle; put TOOL CALL first"
            )
        if not self.preset:
            raise BadInput(f"line {line}: a move before its preset is said; put CYCL DEF 247 first")
        if not self.tool.rotates:
            raise BadInput(
                f"line {line}: tool {self.tool.number} is a turning tool; this control turns no work here"
            )
        if self.tool.locked:
            raise BadInput(
                f"line {line}: tool {self.tool.number} is a turning insert, for which this control has no word that locks the spindle"
            )
        return self.tool

    def check_feed(self, line: int, feed: float) -> None:
        """Raise `BadInput` where a tool would feed without a turning spindle or a feed in mm/min."""
        if not self.turning:
            raise BadInput(
                f"line {line}: a feed move while the spindle stands; give S in TOOL CALL, and M3, first"
            )
        if feed <= 0.0:
            raise BadInput(f"line {line}: a feed move without a feed; give F or FMAX")
