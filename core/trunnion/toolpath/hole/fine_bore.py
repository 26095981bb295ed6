"""Bores holes to their fits with an edge that is set to the diameter: one cycle each, in, a wait, and out at the feed."""

from __future__ import annotations

from trunnion.model.motion.cycle import Cycle, CycleKind
from trunnion.model.operation import CuttingData
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.plan.holes.drive import HoleDrive
from trunnion.plan.holes.settings import FineBoringSettings
from trunnion.progress import Progress
from trunnion.toolpath.contract import Planned, strategy
from trunnion.toolpath.motion.builder import PathBuilder
from trunnion.toolpath.motion.finished_bores import finished_bores
from trunnion.toolpath.stock.heightfield import PlanningStock


@strategy(settings=FineBoringSettings, drive=HoleDrive, own_faces=True)
def fine_bore(
    drive: HoleDrive,
    tool: Tool,
    data: CuttingData,
    stock: PlanningStock,
    setup: Setup,
    settings: FineBoringSettings,
    progress: Progress,
) -> Planned:
    """Return the cycles that bore holes to size, and which holes the bar does not make to their ends."""

    def cycle_of(depth: float) -> Cycle:
        return Cycle(kind=CycleKind.BORE, depth=depth, dwell=settings.dwell)

    builder = PathBuilder(tool, data, stock, setup, settings.safety)
    path, findings = finished_bores(builder, drive, settings.breakthrough, cycle_of, progress)
    return Planned(findings=findings) if path is None else Planned(path=path, findings=findings)
