"""What every strategy promises: from drive geometry, cutter and stock to motions, and what they leave.

    @strategy(settings=RoughSettings)
    def rough(drive, tool, data, stock, setup, settings, progress) -> Planned: ...

A strategy is pure and deterministic. Its path begins with a rapid at the setup's clearance height over its start and ends with a retract
to that height. What it can't cut is a finding with the area in mm2 and a remedy, never an empty path without a word.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol, TypeVar

from trunnion.findings import Finding
from trunnion.model.operation import CuttingData
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


class Strategy(Protocol):
    """From drive geometry to motions; `settings` is the class of the settings it takes."""

    settings: type

    def __call__(self, drive: PlaneDrive, tool: Tool, data: CuttingData, stock: PlanningStock, setup: Setup, settings: Any,
                 progress: Progress) -> Planned:
        """Return the motions in the setup frame."""


def strategy(*, settings: type) -> Callable[[F], F]:
    """Mark a function as a strategy and tell which settings it takes."""

    def mark(function: F) -> F:
        function.settings = settings  # type: ignore[attr-defined]
        return function

    return mark
