"""What every turning strategy begins with: what its tool reaches, the stock as it sees it, and an empty path over it."""

from __future__ import annotations

from dataclasses import dataclass

from shapely.geometry.base import BaseGeometry

from trunnion.model.blank import Revolved
from trunnion.model.operation import CuttingData
from trunnion.model.setup import Setup
from trunnion.model.tool import TurningTool
from trunnion.plan.turning.drive import RevolvedDrive
from trunnion.plan.turning.meridian import meridian_in
from trunnion.plan.turning.reach import TurningReach, reach_of
from trunnion.plan.turning.settings import TurningSettings
from trunnion.plan.turning.view import TurningSide
from trunnion.toolpath.turning_passes.passes import TurningPath


@dataclass(frozen=True, eq=False)
class TurningWork:
    """A tool's reach, the stock's meridian as u and v, and the path in the making."""

    reach: TurningReach
    stock: BaseGeometry
    path: TurningPath


def work_of(
    drive: RevolvedDrive,
    tool: TurningTool,
    data: CuttingData,
    stock: Revolved,
    setup: Setup,
    settings: TurningSettings,
    allowance: float,
) -> TurningWork:
    """Return what an operation works on that leaves an allowance (mm); raise `Refused` for stock that is none of revolution."""
    meridian = meridian_in(stock, setup.frame)
    reach = reach_of(
        tool,
        TurningSide(settings.side),
        drive.part_area,
        settings.limits,
        meridian,
        allowance=allowance,
    )
    seen = reach.view.shape_seen(meridian)
    away = float(seen.bounds[3]) + settings.clearance
    return TurningWork(reach, seen, TurningPath(reach.view, data, away, setup.clearance))
