"""Reams bores to their fits: one cycle each, in and out at the feed, in a short tour."""

from __future__ import annotations

import numpy as np

from trunnion import tolerance
from trunnion.findings import Finding, remark, warning
from trunnion.model.motion.cycle import Cycle, CycleKind
from trunnion.model.operation import CuttingData
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.plan.holes.drive import HoleDrive
from trunnion.plan.holes.finish_tools import ream_tip
from trunnion.plan.holes.hole import PlannedHole
from trunnion.plan.holes.settings import ReamSettings
from trunnion.progress import Progress
from trunnion.toolpath.contract import Planned, strategy
from trunnion.toolpath.motion.builder import PathBuilder
from trunnion.toolpath.motion.hole_access import kept_off
from trunnion.toolpath.motion.hole_cycles import HoleCycle, cycle_path, retract_plane
from trunnion.toolpath.motion.tour import short_tour
from trunnion.toolpath.stock.heightfield import PlanningStock
from trunnion.units import trimmed


@strategy(settings=ReamSettings, drive=HoleDrive, own_faces=True)
def ream(
    drive: HoleDrive,
    tool: Tool,
    data: CuttingData,
    stock: PlanningStock,
    setup: Setup,
    settings: ReamSettings,
    progress: Progress,
) -> Planned:
    """Return the cycles that ream bores, and which bores the reamer does not make to their ends."""
    builder = PathBuilder(tool, data, stock, setup, settings.safety)
    cycles: list[HoleCycle] = []
    findings: list[Finding] = []
    for hole in progress.each(drive.holes):
        tip = ream_tip(hole, tool, settings)
        stopped = _of_another_size(hole, tool) or kept_off(builder, hole, tip)
        if stopped is not None:
            findings.append(stopped)
            continue
        plane = retract_plane(builder, hole)
        cycle = Cycle(kind=CycleKind.REAM, depth=plane - tip)
        cycles.append(HoleCycle(hole=hole, plane=plane, cycle=cycle))
        findings += _left(hole, tool)
    if not cycles:
        return Planned(findings=tuple(findings))
    order = short_tour(np.array([c.hole.position for c in cycles]), progress)
    return Planned(path=cycle_path(builder, [cycles[k] for k in order]), findings=tuple(findings))


def _of_another_size(hole: PlannedHole, tool: Tool) -> Finding | None:
    """Return the finding on a bore that a reamer does not make to its size."""
    if abs(tool.diameter - hole.diameter) <= tolerance.SEW:
        return None
    return warning(
        "hole.other-size",
        f"{hole.feature} is not reamed: {tool.name} makes D {trimmed(tool.diameter, 3)}, the bore has D {trimmed(hole.diameter, 3)}",
        hole.feature,
        remedy="choose a reamer of the bore's diameter",
    )


def _left(hole: PlannedHole, tool: Tool) -> list[Finding]:
    """Return what is to be said of the end of a blind bore that a reamer's lead does not make to size."""
    if hole.through or tool.lead <= 0.0:
        return []
    return [
        remark(
            "hole.reamed-depth",
            f"{hole.feature} is reamed to {trimmed(hole.depth - tool.lead, 2)} of its {trimmed(hole.depth, 2)} mm: "
            f"the reamer's lead takes {trimmed(tool.lead, 2)} mm",
            hole.feature,
            remedy="accept it, or demand the fit of a part that lets the reamer go on",
        )
    ]
