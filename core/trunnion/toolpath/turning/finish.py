"""Finishing by turning: one pass along the contour, nose radius and edges in it."""

from __future__ import annotations

from trunnion.model.blank import Revolved
from trunnion.model.operation import CuttingData
from trunnion.model.setup import Setup
from trunnion.model.tool import TurningTool
from trunnion.plan.turning.drive import RevolvedDrive
from trunnion.plan.turning.meridian import meridian_in
from trunnion.plan.turning.reach import reach_of
from trunnion.plan.turning.settings import MOST_LAYERS, TurningSettings
from trunnion.plan.turning.view import TurningSide
from trunnion.progress import Progress
from trunnion.toolpath.contract import Planned, strategy
from trunnion.toolpath.turning_passes.contour import contour_passes
from trunnion.toolpath.turning_passes.passes import TurningPath


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
    meridian = meridian_in(stock, setup.frame)
    reach = reach_of(
        tool,
        TurningSide(settings.side),
        drive.part_area,
        settings.limits,
        meridian,
        allowance=settings.finish_allowance,
    )
    progress.at(0.3, "turning")
    seen = reach.view.shape_seen(meridian)
    path = TurningPath(reach.view, data, seen.bounds[3] + settings.clearance, setup.clearance)
    most = MOST_LAYERS * data.depth
    contour_passes(path, reach, seen, settings.clearance, settings.bridge, most)
    return Planned(path=path.made())
