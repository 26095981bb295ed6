"""Finishing by turning: one pass along the contour, nose radius and edges in it."""

from __future__ import annotations

from trunnion.model.blank import Revolved
from trunnion.model.operation import CuttingData
from trunnion.model.setup import Setup
from trunnion.model.tool import TurningTool
from trunnion.plan.turning.drive import RevolvedDrive
from trunnion.plan.turning.settings import MOST_LAYERS, TurningSettings
from trunnion.progress import Progress
from trunnion.toolpath.contract import Planned, strategy
from trunnion.toolpath.turning_passes.contour import contour_passes
from trunnion.toolpath.turning_passes.work import work_of


@strategy(settings=TurningSettings, drive=RevolvedDrive)
def finish(
    drive: RevolvedDrive,
    tool: TurningTool,
    data: CuttingData,
    stock: Revolved,
    setup: Setup,
    settings: TurningSettings,
    progress: Progress,
) -> Planned:
    """Return the passes along the contour, in the direction that the tool cuts in."""
    work = work_of(drive, tool, data, stock, setup, settings, settings.finish_allowance)
    progress.at(0.3, "turning")
    most = MOST_LAYERS * data.depth
    contour_passes(work.path, work.reach, work.stock, settings.clearance, settings.bridge, most)
    return Planned(path=work.path.made())
