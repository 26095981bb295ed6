"""Constant scallop: an upright cutter on passes as far apart as the wanted scallop height allows everywhere (`fronts.py`)."""

from __future__ import annotations

import math

from trunnion.model.operation import CuttingData
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.plan.freeform.drive import SurfaceDrive
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.settings import setting, settings
from trunnion.toolpath.contact_passes import choices
from trunnion.toolpath.contact_passes.choices import TOO_SHALLOW, TOO_STEEP
from trunnion.toolpath.contact_passes.stepover.fronts import scallop_passes
from trunnion.toolpath.contact_passes.upright.fixed_axis import upright_passes
from trunnion.toolpath.contact_passes.upright.upright_path import upright_path
from trunnion.toolpath.contract import Planned, strategy
from trunnion.toolpath.motion.choices import safety
from trunnion.toolpath.motion.load.engagement import surface_leftovers
from trunnion.toolpath.stock.heightfield import PlanningStock


@settings("surface.constant")
class ConstantSettings:
    """How an area is cut at a constant scallop height."""

    direction: str = setting(
        "climb",
        label="Cutting direction",
        help="With the uncut side on the right of the cutter, or on its left.",
        choices=("climb", "conventional"),
    )
    order: str = setting(
        "inwards",
        label="Order",
        help="From the rim inwards, or from the inside to the rim.",
        choices=("inwards", "outwards"),
    )
    steepest: float = choices.steepest()
    chord: float = choices.chord()
    lead_radius: float = choices.lead_radius()
    safety: float = safety()


@strategy(
    settings=ConstantSettings,
    drive=SurfaceDrive,
    leaves=(TOO_STEEP,),
    settles=(TOO_SHALLOW,),
    meets=surface_leftovers,
    goes_past=lambda settings: 2.0 * settings.lead_radius,
    own_faces=True,
)
def constant(
    drive: SurfaceDrive,
    tool: Tool,
    data: CuttingData,
    stock: PlanningStock,
    setup: Setup,
    settings: ConstantSettings,
    progress: Progress = NO_PROGRESS,
) -> Planned:
    """Return the motions of passes at a constant scallop height over the drive's faces, and what they leave."""
    contact_lines = scallop_passes(drive, tool, settings.chord, progress.part(0.0, 0.4))
    done = upright_passes(
        contact_lines,
        drive,
        tool,
        settings.chord,
        math.radians(settings.steepest),
        progress.part(0.4, 0.8),
    )
    inwards = settings.order == "inwards"
    passes = list(done.passes if inwards else done.passes[::-1])
    if inwards == (settings.direction == "climb"):
        passes = [p.reversed() for p in passes]
    return upright_path(
        passes, done, drive, tool, data, stock, setup, settings, progress.part(0.8, 1.0)
    )
