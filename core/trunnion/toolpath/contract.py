"""What every strategy promises: from drive geometry, cutter and stock to motions, and what they leave.

    @strategy(settings=RoughSettings, meets=full_width)
    def rough(drive, tool, data, stock, setup, settings, progress) -> Planned: ...

`meets` is the largest engagement that the strategy can meet, from which the planner takes the peak of the load (`toolpath.engagement` has
those that several strategies share); without it a strategy promises to meet no more than the cutting data's depth and width.

A strategy is pure and deterministic. Its path begins with a rapid at the setup's clearance height over its start and ends with a retract
to that height. What it can't cut is a finding with the area in mm2 and a remedy, never an empty path without a word.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol, TypeVar

from trunnion.findings import Finding
from trunnion.model.operation import CuttingData, Engagement, Operation
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.model.toolpath import EMPTY, Toolpath
from trunnion.plan.drive import PlaneDrive
from trunnion.progress import Progress
from trunnion.toolpath.stock import PlanningStock

F = TypeVar("F", bound=Callable[..., Any])


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Planned:
    """The motions of one operation and what a person should know of them."""

    path: Toolpath = EMPTY
    findings: tuple[Finding, ...] = ()


Meets = Callable[[Tool, CuttingData, Any, Operation | None], Engagement]
"""From tool, cutting data, the strategy's settings and the operation that roughed there before to the largest engagement."""


class Strategy(Protocol):
    """From drive geometry to motions; `settings` is the class of the settings it takes, `meets` tells its largest engagement."""

    settings: type
    meets: Meets

    def __call__(self, drive: PlaneDrive, tool: Tool, data: CuttingData, stock: PlanningStock, setup: Setup, settings: Any,
                 progress: Progress) -> Planned:
        """Return the motions in the setup frame."""


def as_planned(tool: Tool, data: CuttingData, settings: Any, before: Operation | None) -> Engagement:
    """Return the engagement of the cutting data: a strategy that meets no more."""
    return Engagement(width=data.width, depth=data.depth, share=1.0, at="")


def strategy(*, settings: type, meets: Meets = as_planned) -> Callable[[F], F]:
    """Mark a function as a strategy and tell which settings it takes and what engagement it can meet."""

    def mark(function: F) -> F:
        function.settings = settings  # type: ignore[attr-defined]
        function.meets = meets  # type: ignore[attr-defined]
        return function

    return mark
