"""Streamline: an upright cutter along flow lines between two guide curves (`flow_lines.py`), lifted where another face is in its way."""

from __future__ import annotations

import math

from trunnion.model.operation import CuttingData
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.plan.freeform.drive import SurfaceDrive
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.settings import setting, settings
from trunnion.toolpath.contact_passes import choices
from trunnion.toolpath.contact_passes.choices import TOO_STEEP
from trunnion.toolpath.contact_passes.flow_lines import FlowParameters, flow_lines
from trunnion.toolpath.contact_passes.upright.fixed_axis import upright_passes
from trunnion.toolpath.contact_passes.upright.upright_path import upright_path
from trunnion.toolpath.contract import Planned, strategy
from trunnion.toolpath.motion.choices import safety
from trunnion.toolpath.motion.load.engagement import surface_leftovers
from trunnion.toolpath.stock.heightfield import PlanningStock


@settings("surface.streamline")
class StreamlineSettings:
    """How flow lines run and how finely they are cut."""

    first_guide: str = setting(
        "",
        label="First guide",
        help="Faces beyond the rim where the passes begin, as in: face 12, face 13. "
        "Without: a whole rim of a tube, or one of the two longest opposite sides.",
    )
    second_guide: str = setting(
        "", label="Second guide", help="Faces beyond the rim where the passes end."
    )
    spiral: bool = setting(
        True,
        label="Spiral",
        help="Cut a tube or ring in one continuous spiral instead of closed passes.",
    )
    pattern: str = setting(
        "zigzag",
        label="Pattern",
        help="Passes to and fro, or all of them in the climbing direction.",
        choices=("zigzag", "climb"),
    )
    steepest: float = choices.steepest()
    chord: float = choices.chord()
    lead_radius: float = choices.lead_radius()
    safety: float = safety()


@strategy(
    settings=StreamlineSettings,
    drive=SurfaceDrive,
    leaves=(TOO_STEEP,),
    meets=surface_leftovers,
    own_faces=True,
)
def streamline(
    drive: SurfaceDrive,
    tool: Tool,
    data: CuttingData,
    stock: PlanningStock,
    setup: Setup,
    settings: StreamlineSettings,
    progress: Progress = NO_PROGRESS,
) -> Planned:
    """Return the motions of an upright tool along flow lines over the drive's faces, and what it leaves."""
    flow = FlowParameters(
        first_guide=settings.first_guide,
        second_guide=settings.second_guide,
        spiral=settings.spiral,
        chord=settings.chord,
    )
    contact_lines = flow_lines(drive, tool, flow, progress.part(0.0, 0.4))
    to_and_fro = settings.pattern == "zigzag"
    done = upright_passes(
        contact_lines,
        drive,
        tool,
        settings.chord,
        math.radians(settings.steepest),
        progress.part(0.4, 0.8),
    )
    return upright_path(
        done.passes,
        done,
        drive,
        tool,
        data,
        stock,
        setup,
        settings,
        progress.part(0.8, 1.0),
        order="nearest" if to_and_fro else "given",
        reversing=to_and_fro,
    )
