"""From passes of an upright tool to what its strategy returns: linked at the scallop's stepover, with findings on what they leave."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Protocol

import numpy as np

from trunnion import tolerance
from trunnion.findings import Finding, warning
from trunnion.model.motion.toolpath import Toolpath
from trunnion.model.operation import CuttingData
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.plan.freeform.drive import SurfaceDrive
from trunnion.plan.freeform.estimate.scallop import stepover_on_plane
from trunnion.progress import Progress
from trunnion.toolpath.contact_passes.choices import LOW
from trunnion.toolpath.contact_passes.linking.link_passes import extended_in_order, linked_in_order
from trunnion.toolpath.contact_passes.linking.parameters import LinkParameters
from trunnion.toolpath.contact_passes.passes import Pass
from trunnion.toolpath.contact_passes.upright.fixed_axis import UprightPasses
from trunnion.toolpath.contact_passes.upright.stock_contact import without_stock_contact
from trunnion.toolpath.contract import Planned
from trunnion.toolpath.stock.heightfield import PlanningStock
from trunnion.units import trimmed


class LinkSettings(Protocol):
    """Settings of a strategy that links passes: `safety` and `lead_radius` in mm, as `LinkParameters` has them."""

    @property
    def safety(self) -> float: ...

    @property
    def lead_radius(self) -> float: ...


def upright_path(
    passes: Sequence[Pass],
    made: UprightPasses,
    drive: SurfaceDrive,
    tool: Tool,
    data: CuttingData,
    stock: PlanningStock,
    setup: Setup,
    settings: LinkSettings,
    progress: Progress,
    *,
    order: str = "given",
    reversing: bool = False,
) -> Planned:
    """Return the motions over `passes`, those that were `made` in the order that a strategy wants, and findings on what these leave."""
    stepover = stepover_on_plane(tool.corner_radius, drive.height)
    parameters = LinkParameters(
        stepover=stepover,
        safety=settings.safety,
        lead_radius=settings.lead_radius,
        order=order,
        reversing=reversing,
    )
    path, blocked = linked_without_contact(
        passes, stepover, drive, tool, data, stock, setup, parameters, progress
    )
    return Planned(path=path, findings=(*made.remaining_findings(drive, tool, stepover), *blocked))


def linked_without_contact(
    passes: Sequence[Pass],
    stepover: float,
    drive: SurfaceDrive,
    tool: Tool,
    data: CuttingData,
    stock: PlanningStock,
    setup: Setup,
    parameters: LinkParameters,
    progress: Progress,
) -> tuple[Toolpath, tuple[Finding, ...]]:
    """Return the toolpath over what of passes, a stepover (mm) apart, an upright tool cuts without meeting stock above its flutes, and
    findings of the area that is left and of how far the tool comes below the blank.

    What stands beside a pass depends on those before it: passes are put in order first.
    """
    passes = extended_in_order(passes, drive, tool, parameters, progress.part(0.0, 0.2))
    clear, along, blocked = without_stock_contact(passes, drive, tool, stock, stepover, progress)
    parameters = replace(parameters, pass_stock=along)
    path = linked_in_order(
        clear, drive, tool, data, stock, setup, parameters, progress.part(0.2, 1.0)
    )
    return path, (*blocked, *_low(path, drive, tool))


def _low(path: Toolpath, drive: SurfaceDrive, tool: Tool) -> tuple[Finding, ...]:
    """Return how far an upright tool comes down beside the blank: no table is in the proof."""
    deep = float(drive.low[2] - path.position[:, 2].min(initial=np.inf))
    if deep <= tolerance.SEW:
        return ()
    return (
        warning(
            LOW,
            f"{tool.name} comes {trimmed(deep, 1)} mm lower than the blank's underside beside {drive.feature}",
            drive.feature,
            remedy=f"let the part stand at least {trimmed(math.ceil(deep), 0)} mm above the table",
        ),
    )
