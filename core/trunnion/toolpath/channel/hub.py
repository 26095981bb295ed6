"""Finishing of the hub between blades: streamlines from before the leading edges to the outlet, between the root fillets.

Lines of equal share of the way from blade to blade run with the stream; where a channel widens more of them begin between the others. Two
more follow the toes of the root fillets.
"""

from __future__ import annotations

import math

import numpy as np

from trunnion.model.operation import CuttingData
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.plan.channel.drive import ChannelDrive
from trunnion.plan.freeform.estimate.scallop import stepover_on_plane
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.settings import setting, settings
from trunnion.toolpath.contact_passes.channel_choices import axis_turn, finishing_chord, over_shroud
from trunnion.toolpath.contact_passes.channel_finish import finished, wanted_axes
from trunnion.toolpath.contact_passes.channel_lines import (
    TOE_CLEARANCE,
    between_toes,
    hub_of,
    lines_between,
)
from trunnion.toolpath.contact_passes.contacts import Contacts
from trunnion.toolpath.contract import Planned, leaning_axis, strategy
from trunnion.toolpath.motion.load.engagement import surface_leftovers
from trunnion.toolpath.stock.heightfield import PlanningStock

ALONG = 0.4
"""mm between contacts of a line."""


@settings("channel.hub")
class ChannelHubSettings:
    """How finely the hub is cut, how far lines run out, and how the axis may turn."""

    before: float = setting(
        0.5,
        unit="mm",
        low=0.0,
        high=50.0,
        label="Before the leading edge",
        help="How far lines begin before the leading edges: the hub's nose is turned.",
    )
    lean: float = setting(
        6.0,
        unit="deg",
        low=0.5,
        high=45.0,
        label="Lean",
        help="How far the tool's flank is leant off the hub at least.",
    )
    turn: float = axis_turn()
    chord: float = finishing_chord("hub")
    safety: float = over_shroud()


@strategy(
    settings=ChannelHubSettings,
    drive=ChannelDrive,
    tool_axis=leaning_axis,
    meets=surface_leftovers,
)
def hub(
    drive: ChannelDrive,
    tool: Tool,
    data: CuttingData,
    stock: PlanningStock,
    setup: Setup,
    settings: ChannelHubSettings,
    progress: Progress = NO_PROGRESS,
) -> Planned:
    """Return the path over the hub in the channels of a period and its copies, and what the tool does not come to."""
    surface = drive.surface
    stepover = stepover_on_plane(tool.corner_radius, surface.height)
    lean = math.radians(settings.lean)
    lines: list[Contacts] = []
    for channel in progress.part(0.0, 0.1).each(drive.channels):
        run = channel.meridian.hub.run
        ends = -settings.before / run, 1.0 + 0.5 * tool.radius / run
        u = np.linspace(*ends, max(2, math.ceil((ends[1] - ends[0]) * run / ALONG)))
        # A ball touches the hub no nearer to a sharp root than it is round.
        off = tool.corner_radius if drive.sharp else TOE_CLEARANCE
        for some in lines_between(hub_of(channel), u, *between_toes(channel, u, off), stepover):
            lines += some
    return finished(
        [line.reversed() if k % 2 else line for k, line in enumerate(lines)],
        drive,
        tool,
        data,
        setup,
        lambda point, normal: wanted_axes(drive, tool, point, normal, lean),
        turn=math.radians(settings.turn),
        chord=settings.chord,
        safety=settings.safety,
        stepover=stepover,
        progress=progress.part(0.1, 1.0),
    )
