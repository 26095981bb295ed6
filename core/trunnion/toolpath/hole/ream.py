"""Reams bores to their fits: one cycle each, in and out at the feed, in a short tour."""

from __future__ import annotations

from trunnion.model.motion.cycle import Cycle, CycleKind
from trunnion.model.operation import CuttingData
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.plan.holes.drive import HoleDrive
from trunnion.plan.holes.settings import ReamSettings
from trunnion.progress import Progress
from trunnion.toolpath.contract import Planned, strategy
from trunnion.toolpath.motion.builder import PathBuilder
from trunnion.toolpath.motion.finished_bores import finished_bores
from trunnion.toolpath.stock.heightfield import PlanningStock


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

    def cycle_of(depth: float) -> Cycle:
        return Cycle(kind=CycleKind.REAM, depth=depth)

    builder = PathBuilder(tool, data, stock, setup, settings.safety)
    path, findings = finished_bores(builder, drive, settings.breakthrough, cycle_of, progress)
    return Planned(findings=findings) if path is None else Planned(path=path, findings=findings)
