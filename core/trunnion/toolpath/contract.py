"""What every strategy promises: from drive geometry, cutter and stock to motions, and what they leave.

    @strategy(settings=RoughSettings, drive=PlaneDrive, meets=full_width)
    def rough(drive, tool, data, stock, setup, settings, progress) -> Planned: ...

`drive` is the class of drive geometry that the strategy works from: the planner of the part's family makes one for each operation.
`tool_axis` says by the settings whether the tool keeps the axis of its cutting frame or leans from it. `leaves` are the codes of findings
on what the strategy leaves to others, `settles` those of what it cuts where others leave it: a finding is kept quiet where another
operation on the same faces settles it. `finds_rest`: the strategy finds for itself what an earlier cutter left. `goes_past` says by the
settings how far in mm at most tips are past where they touch the drive's faces, by leads and overlaps; without it nobody knows.
`earlier_cuts`: it wants to know where leaning tools have cut for the same feature before, unless it leaves an allowance. `own_faces`: an
operation that a person gives other faces is led by these.

`meets` is the largest engagement that the strategy can meet, from which the planner takes the peak of the load (`toolpath.engagement` has
those that several strategies share); without it a strategy promises to meet no more than the cutting data's depth and width.

A strategy is pure and deterministic. Its path begins with a rapid at the setup's clearance height over its start and ends with a retract
to that height. What it can't cut is a finding with the area in mm2 and a remedy, never an empty path without a word.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol, TypeVar

from trunnion.findings import Finding
from trunnion.model.motion.toolpath import EMPTY, Toolpath
from trunnion.model.operation import CuttingData, Engagement, Operation
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.plan.contract import ToolAxis
from trunnion.plan.prismatic.drive import PlaneDrive
from trunnion.progress import Progress
from trunnion.toolpath.stock.heightfield import PlanningStock
from trunnion.toolpath.stock.stock_reads import EVERYWHERE, StockBox

F = TypeVar("F", bound=Callable[..., Any])


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Planned:
    """The motions of one operation and what a person should know of them; `stock_box` (mm) is where the stock was looked at for them,
    nothing for all of it."""

    path: Toolpath = EMPTY
    findings: tuple[Finding, ...] = ()
    stock_box: StockBox = EVERYWHERE


Meets = Callable[[Tool, CuttingData, Any, Operation | None], Engagement]
"""From tool, cutting data, the strategy's settings and the operation that roughed there before to the largest engagement."""


AxisRule = Callable[[Any], ToolAxis]
"""From a strategy's settings to what its tool axis does."""


def fixed_axis(settings: Any) -> ToolAxis:
    """Return that the tool keeps the axis of its cutting frame, whatever the settings."""
    return ToolAxis.FIXED


def leaning_axis(settings: Any) -> ToolAxis:
    """Return that the tool leans, whatever the settings."""
    return ToolAxis.LEANING


def lead_and_tilt(settings: Any) -> ToolAxis:
    """Return that the tool leans where the settings' `lead` or `tilt` (degrees) is not zero."""
    return ToolAxis.LEANING if settings.lead != 0.0 or settings.tilt != 0.0 else ToolAxis.FIXED


def anywhere(settings: Any) -> float:
    """Return that tips may be any distance past the faces, whatever the settings."""
    return math.inf


class Strategy(Protocol):
    """From drive geometry to motions; `settings` is the class of the settings it takes, the others as in the module's description."""

    settings: type
    drive: type
    tool_axis: AxisRule
    leaves: tuple[str, ...]
    settles: tuple[str, ...]
    finds_rest: bool
    meets: Meets
    goes_past: Callable[[Any], float]
    earlier_cuts: bool
    own_faces: bool

    def __call__(
        self,
        drive: Any,
        tool: Tool,
        data: CuttingData,
        stock: PlanningStock,
        setup: Setup,
        settings: Any,
        progress: Progress,
    ) -> Planned:
        """Return the motions in the setup frame."""


def as_planned(
    tool: Tool, data: CuttingData, settings: Any, before: Operation | None
) -> Engagement:
    """Return the engagement of the cutting data: a strategy that meets no more."""
    return Engagement(width=data.width, depth=data.depth, share=1.0, at="")


def strategy(
    *,
    settings: type,
    drive: type = PlaneDrive,
    tool_axis: AxisRule = fixed_axis,
    leaves: tuple[str, ...] = (),
    settles: tuple[str, ...] = (),
    finds_rest: bool = False,
    meets: Meets = as_planned,
    goes_past: Callable[[Any], float] = anywhere,
    earlier_cuts: bool = False,
    own_faces: bool = False,
) -> Callable[[F], F]:
    """Mark a function as a strategy and tell what it takes, what it leaves to others, and what engagement it can meet."""
    declared = {
        "settings": settings,
        "drive": drive,
        "tool_axis": tool_axis,
        "leaves": leaves,
        "settles": settles,
        "finds_rest": finds_rest,
        "meets": meets,
        "goes_past": goes_past,
        "earlier_cuts": earlier_cuts,
        "own_faces": own_faces,
    }

    def mark(function: F) -> F:
        vars(function).update(declared)
        return function

    return mark
