"""Roughing of channels between blades: layers from shroud to hub, passes along the stream, the tool along the walls' rulings.

Layers are morphed: each is as deep as the same share of the way from hub to shroud, so that they follow both. A pass begins and ends
outside of the blank, before the leading edges and behind the outlet: nothing is plunged into.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import partial

import numpy as np

from trunnion.findings import Finding, warning
from trunnion.geometry.arrays import Bools, Floats
from trunnion.model.motion.toolpath import Toolpath
from trunnion.model.operation import CuttingData, Engagement, Operation
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.plan.channel.blade_channel import BladeChannel
from trunnion.plan.channel.drive import ChannelDrive
from trunnion.plan.clearance import ClearanceQuery
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.settings import setting, settings
from trunnion.toolpath.contact_passes.axis_search import LeanLimits
from trunnion.toolpath.contact_passes.blank_clearance import body_outside
from trunnion.toolpath.contact_passes.channel_choices import axis_turn
from trunnion.toolpath.contact_passes.channel_finish import (
    CLOSE,
    OFF,
    clearance_links,
    link_feed,
    out_of_channel,
    outside_query,
    passes_along,
    steepest_of,
    wanted_axes,
)
from trunnion.toolpath.contact_passes.channel_lines import between_walls, level_of, lines_between
from trunnion.toolpath.contact_passes.contacts import Contacts
from trunnion.toolpath.contact_passes.passes import Pass
from trunnion.toolpath.contact_passes.sphere_links import SphereLinkParameters, copied, linked_round
from trunnion.toolpath.contact_passes.stock_clearance import grown
from trunnion.toolpath.contract import Planned, leaning_axis, strategy
from trunnion.toolpath.motion.reorient import clearance_sphere
from trunnion.toolpath.stock.heightfield import PlanningStock
from trunnion.units import trimmed

LINK_TURN = math.radians(40.0)
"""Largest turn of the axis on a link in the air."""
ALONG = 0.8
"""mm between contacts of a line."""
NEAR = 3.0
"""Stepovers: a pass that begins no farther from the end of the one before is reached straight."""
SAMPLES = 100
"""Contacts of a layer at which axes are looked for."""
SMALLEST_LEFTOVER = 0.02
"""Share of the passes of a channel: less than this lies beside its walls."""


@settings("channel.rough")
class ChannelRoughSettings:
    """How far passes run out, and how rapids keep away."""

    safety: float = setting(
        1.0,
        unit="mm",
        low=0.2,
        high=50.0,
        label="Safety distance",
        help="How far passes run out beyond the blank before they turn, and rapids stay from it.",
    )
    turn: float = axis_turn()
    chord: float = setting(
        0.03,
        unit="mm",
        low=0.0001,
        high=0.5,
        label="Chord error",
        help="How far a block may leave its level, on either side.",
    )


def full_slot(
    tool: Tool, data: CuttingData, settings: ChannelRoughSettings, before: Operation | None
) -> Engagement:
    """Return the largest engagement: the first pass of a layer is a slot as wide as the cutter."""
    return Engagement(
        width=tool.diameter,
        depth=data.depth,
        share=1.0,
        at="the first pass of a layer is a full slot",
    )


@strategy(
    settings=ChannelRoughSettings, drive=ChannelDrive, tool_axis=leaning_axis, meets=full_slot
)
def rough(
    drive: ChannelDrive,
    tool: Tool,
    data: CuttingData,
    stock: PlanningStock,
    setup: Setup,
    settings: ChannelRoughSettings,
    progress: Progress = NO_PROGRESS,
) -> Planned:
    """Return the path that roughs the channels of a period and its copies, and what stays because the tool does not go there."""
    surface, query_for = drive.surface, drive.leaning_query("roughing channels")
    allowance = surface.allowance
    query = outside_query(grown_query(query_for, tool, allowance), body_outside(tool, drive.inward))
    limits = LeanLimits(turn=math.radians(settings.turn), steepest=steepest_of(tool))
    sphere = clearance_sphere(drive.blank, setup)
    parameters = SphereLinkParameters(
        near=NEAR * data.width,
        turn=LINK_TURN,
        feed=data.feed,
        link_feed=link_feed(data),
        close=CLOSE + data.depth,
        sphere=sphere,
        retreat=out_of_channel(drive, settings.safety),
        query=query,
        air=clearance_links(drive, tool),
    )
    lean = math.radians(tool.taper_angle)
    paths, findings = [], []
    for n, channel in enumerate(drive.channels):
        share = progress.part(n / len(drive.channels), (n + 1) / len(drive.channels))
        passes: list[Pass] = []
        groups: list[int] = []
        remaining = []
        levels = layers(channel, tool, data, allowance, settings.safety, share.part(0.0, 0.1))
        share = share.part(0.1, 1.0)
        for k, lines in enumerate(levels):
            part = share.part(k / len(levels), (k + 1) / len(levels))
            done = passes_along(
                lines,
                tool,
                lambda point, normal: wanted_axes(drive, tool, point, normal, lean),
                (query,),
                limits,
                settings.chord,
                0.0,
                part,
                SAMPLES,
            )
            passes += in_turn(done.passes)
            groups += [k] * (len(passes) - len(groups))
            remaining.append(done.remaining)
        paths.append(linked_round(passes, parameters, groups))
        findings += _left(float(np.mean(remaining)), surface.feature, tool)
    whole = Toolpath.join([p for p in paths if len(p)])
    return Planned(path=copied(whole, drive.copies, sphere), findings=tuple(findings))


def grown_query(
    query_for: Callable[[Tool], ClearanceQuery], tool: Tool, allowance: float
) -> ClearanceQuery:
    """Return the query of a tool that keeps an allowance (mm) from everything."""
    thick = query_for(grown(tool, allowance))

    def query(
        tip: Floats,
        axis: Floats,
        *,
        start_tip: Floats | None = None,
        start_axis: Floats | None = None,
    ) -> Bools:
        first = axis if start_axis is None else start_axis
        begin = None if start_tip is None else start_tip - allowance * first
        return thick(tip - allowance * axis, axis, start_tip=begin, start_axis=start_axis)

    return query


def layers(
    channel: BladeChannel,
    tool: Tool,
    data: CuttingData,
    allowance: float,
    safety: float,
    progress: Progress = NO_PROGRESS,
) -> list[list[Contacts]]:
    """Return the lines of contacts of all layers, from the shroud to `allowance` mm over the hub, as they are cut to and fro.

    Layers are no deeper than the data's depth, lines no farther apart than their width.
    """
    run = channel.meridian.hub.run
    deepest = float(channel.meridian.height(np.linspace(0.0, 1.0, 33)).max())
    beyond = (widest(tool, deepest) + safety) / run
    u = np.linspace(-beyond, 1.0 + beyond, max(3, math.ceil((1.0 + 2.0 * beyond) * run / ALONG)))
    tall = channel.meridian.height(np.clip(u, 0.0, 1.0))
    count = max(1, math.ceil((deepest - allowance) / data.depth))
    found = []
    for k in progress.over(range(1, count + 1), "Laying layers through the channel"):
        share = 1.0 - k / count
        height = allowance + OFF + share * (tall - allowance)
        w = height / tall
        # As far off the walls as the ball is wide at a level: on the lowest ones it lies in the root fillets.
        low, high = between_walls(channel, u, w, tool.radius + allowance)
        surface = level_of(channel, partial(_between, u, height))
        sets = lines_between(surface, u, low, high, data.width)
        found.append([line for some in sets for line in some])
    return [[line.reversed() if n % 2 else line for n, line in enumerate(lines)] for lines in found]


def _between(u: Floats, height: Floats, at: Floats) -> Floats:
    """Return the height (k,) of a level at coordinates (k,), from those at u (nu,)."""
    return np.asarray(np.interp(at, u, height))


def in_turn(passes: Sequence[Pass]) -> list[Pass]:
    """Return the passes of a layer so that each begins near where the one before ends; the first one stays."""
    left, order = list(passes), list[Pass]()
    while left:
        here = order[-1].tip[-1] if order else left[0].tip[0]
        away = [
            min((float(np.linalg.norm(p.tip[e] - here)), k, e) for e in (0, -1))
            for k, p in enumerate(left)
        ]
        _, k, end = min(away)
        one = left.pop(k)
        order.append(one.reversed() if end else one)
    return order


def widest(tool: Tool, height: float) -> float:
    """Return the largest radius in mm of a cutter up to a height above its tip."""
    flank = math.tan(math.radians(tool.taper_angle)) * max(height - tool.corner_radius, 0.0)
    return tool.radius + (flank if tool.form == "taper" else 0.0)


def _left(share: float, feature: str, tool: Tool) -> list[Finding]:
    if share < SMALLEST_LEFTOVER:
        return []
    return [
        warning(
            "wheel.left",
            f"{tool.name} does not go on {trimmed(100.0 * share, 0)} % of the way through the channels",
            feature,
            remedy="rough what is left with a smaller cutter, or choose a smaller allowance",
        )
    ]
