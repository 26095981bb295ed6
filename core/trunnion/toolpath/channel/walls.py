"""Finishing of blades, splitters and root fillets: along the stream, around the leading edge and back, the tool where most space is.

The faces of one blade are cut along flow lines from its tip to its root, of a root fillet from the wall to the hub; the path is turned to
all other blades. Passes go to and fro: between two walls a tool that is lifted after each pass cuts air most of the time.
"""

from __future__ import annotations

import math

from trunnion.findings import Finding, info
from trunnion.model.operation import CuttingData
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.plan.channel.drive import ChannelDrive
from trunnion.plan.freeform.estimate.scallop import stepover_on_plane
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.settings import setting, settings
from trunnion.toolpath.contact_passes.channel_choices import axis_turn, finishing_chord, over_shroud
from trunnion.toolpath.contact_passes.channel_finish import finished, off_hub, wanted_axes
from trunnion.toolpath.contact_passes.contacts import Contacts
from trunnion.toolpath.contact_passes.flow_lines import DenseFlowLines, FlowParameters, flow_lines
from trunnion.toolpath.contact_passes.leaning_passes import grooving
from trunnion.toolpath.contact_passes.stepover.fronts import scallop_passes
from trunnion.toolpath.contract import Planned, leaning_axis, strategy
from trunnion.toolpath.motion.load.engagement import surface_leftovers
from trunnion.toolpath.stock.heightfield import PlanningStock


@settings("channel.walls")
class ChannelWallSettings:
    """How finely walls are cut, and how the axis may turn."""

    lean: float = setting(
        6.0,
        unit="deg",
        low=0.5,
        high=45.0,
        label="Lean",
        help="How far the tool's flank is leant off the wall where there is space.",
    )
    turn: float = axis_turn()
    chord: float = finishing_chord("faces")
    safety: float = over_shroud()


@strategy(
    settings=ChannelWallSettings,
    drive=ChannelDrive,
    tool_axis=leaning_axis,
    meets=surface_leftovers,
)
def walls(
    drive: ChannelDrive,
    tool: Tool,
    data: CuttingData,
    stock: PlanningStock,
    setup: Setup,
    settings: ChannelWallSettings,
    progress: Progress = NO_PROGRESS,
) -> Planned:
    """Return the path over the drive's faces and their copies, and what the tool does not come to."""
    surface = drive.surface
    ball = grooving(tool, 0.0, 0.5 * math.pi)
    lines, findings = _lines(drive, ball, settings.chord, progress.part(0.0, 0.2))
    if drive.sharp:
        lines, left = off_hub(lines, drive, tool)
        findings = (*findings, *left)
    lean = math.radians(settings.lean)
    return finished(
        lines,
        drive,
        tool,
        data,
        setup,
        lambda point, normal: wanted_axes(drive, tool, point, normal, lean),
        turn=math.radians(settings.turn),
        chord=settings.chord,
        safety=settings.safety,
        stepover=stepover_on_plane(max(ball.radius, surface.height), surface.height),
        findings=findings,
        progress=progress.part(0.2, 1.0),
    )


def _lines(
    drive: ChannelDrive, ball: Tool, chord: float, progress: Progress
) -> tuple[tuple[Contacts, ...], tuple[Finding, ...]]:
    """Return the lines of contacts from the tips to the roots, every other one backwards; those of constant scallop where flow lines don't
    suit the faces."""
    surface = drive.surface
    flow = FlowParameters(
        first_guide=_named(drive.tips), second_guide=_named(drive.roots), chord=chord
    )
    findings: tuple[Finding, ...] = ()
    try:
        lines = flow_lines(surface, ball, flow, progress)
    except DenseFlowLines as reason:
        lines = tuple(scallop_passes(surface, ball, chord, progress))
        findings = (
            info(
                "wheel.pattern",
                f"{surface.feature}: cut at a constant scallop, for {reason}",
                surface.feature,
                remedy="nothing has to be done; other faces beyond the rims make other passes",
            ),
        )
    return tuple(line.reversed() if k % 2 else line for k, line in enumerate(lines)), findings


def _named(tags: tuple[int, ...]) -> str:
    return ", ".join(f"face {t}" for t in tags)
