"""Roughing of channels between blades: layers from shroud to hub, passes along the stream, the tool along the walls' rulings.

Layers are morphed: each is as deep as the same share of the way from hub to shroud, so that they follow both. A pass begins and ends
outside of the blank, before the leading edges and behind the outlet: nothing is plunged into.

A wide cutter first takes what it reaches from there. Behind it a smaller one goes only where its ball meets something: held against the
poses of the cutters before, not against what was planned for them.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import partial

import numpy as np

from trunnion.findings import Finding, warning
from trunnion.geometry.arrays import Bools, Floats, Ints
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
from trunnion.toolpath.contact_passes.linking.sphere_links import (
    SphereLinkParameters,
    copied,
    linked_round,
    straight_links,
)
from trunnion.toolpath.contact_passes.passes import Pass
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
OFF_HUB = 0.02
"""mm more than the allowance that the lowest layer stays off the hub: what its normals change by under a ball."""
OUTSIDE = 0.5
"""Of the ball's radius: how far its centre is outside of the blank where a pass begins from outside; its rim comes down beside it."""
GONE = 0.15
"""mm: a ball that would cut no more than this behind an earlier cutter does not go there; finishing takes twice the allowance."""
OVERLAP, JOINED = 2.0, 20.0
"""mm that a pass goes on beyond the end of what was left, through what is cut; and up to which it goes on to the next stretch: a link
through the air takes longer."""


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
    wide: bool = setting(
        False,
        label="Wide parts only",
        help="Rough only what is reached from outside of the blank; a smaller cutter goes into the narrow places after it.",
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
    # What the ridges leave is less than what is looked for behind them.
    ridge = 0.5 * GONE if settings.wide else math.inf
    paths, findings = [], []
    for n, channel in enumerate(drive.channels):
        share = progress.part(n / len(drive.channels), (n + 1) / len(drive.channels))
        passes: list[Pass] = []
        groups: list[int] = []
        all_lines = missed = 0.0
        levels = layers(
            channel, tool, data, allowance, settings.safety, ridge, share.part(0.0, 0.1)
        )
        share = share.part(0.1, 1.0)
        for k, lines in enumerate(levels):
            part = share.part(k / len(levels), (k + 1) / len(levels))
            all_lines += _length(lines)
            lines = still_to_cut(lines, tool, drive)
            if not lines:
                continue
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
            passes += (
                from_outside(done.passes, tool, drive.inward, parameters)
                if settings.wide
                else in_turn(done.passes)
            )
            groups += [k] * (len(passes) - len(groups))
            missed += done.remaining * _length(lines)
        paths.append(linked_round(passes, parameters, groups))
        if not settings.wide and missed > SMALLEST_LEFTOVER * all_lines:
            findings.append(_left(missed / all_lines, surface.feature, tool))
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
    ridge: float = math.inf,
    progress: Progress = NO_PROGRESS,
) -> list[list[Contacts]]:
    """Return the lines of contacts of all layers, from the shroud to `allowance` mm over the hub, as they are cut to and fro.

    Layers are no deeper than the data's depth, lines no farther apart than their width; on the lowest one they leave ridges no higher than
    `ridge` mm.
    """
    run = channel.meridian.hub.run
    deepest = float(channel.meridian.height(np.linspace(0.0, 1.0, 33)).max())
    beyond = (widest(tool, deepest) + safety) / run
    u = np.linspace(-beyond, 1.0 + beyond, max(3, math.ceil((1.0 + 2.0 * beyond) * run / ALONG)))
    tall = channel.meridian.height(np.clip(u, 0.0, 1.0))
    count = max(1, math.ceil((deepest - allowance) / data.depth))
    ridge = min(ridge, tool.corner_radius)
    # Balls of radius R at a distance w leave ridges of h between them: w^2 = 4 h (2 R - h).
    apart_at_hub = 2.0 * math.sqrt(ridge * (2.0 * tool.corner_radius - ridge))
    found = []
    for k in progress.over(range(1, count + 1), "Laying layers through the channel"):
        share = 1.0 - k / count
        height = allowance + OFF_HUB + share * (tall - allowance)
        w = height / tall
        # As far off the walls as the ball is wide at a level: on the lowest ones it lies in the root fillets.
        low, high = between_walls(channel, u, w, tool.radius + allowance)
        surface = level_of(
            channel, partial(_between, u, height), tool.corner_radius, allowance + OFF_HUB
        )
        apart = min(data.width, apart_at_hub) if k == count else data.width
        sets = lines_between(surface, u, low, high, apart)
        found.append([line for some in sets for line in some])
    return [[line.reversed() if n % 2 else line for n, line in enumerate(lines)] for lines in found]


def _between(u: Floats, height: Floats, at: Floats) -> Floats:
    """Return the height (k,) of a level at coordinates (k,), from those at u (nu,)."""
    return np.asarray(np.interp(at, u, height))


def still_to_cut(lines: Sequence[Contacts], tool: Tool, drive: ChannelDrive) -> list[Contacts]:
    """Return the stretches of lines on which a ball still meets something behind the cutters before; all of them where there were none."""
    if not drive.cut or not lines:
        return list(lines)
    # Five positions on the ball, across the path; all of a level at once.
    point, normal, feed = (
        np.concatenate([getattr(line, name) for line in lines])
        for name in ("point", "normal", "feed")
    )
    across, radius = np.cross(normal, feed), tool.corner_radius
    centre = point + radius * normal
    meets = np.zeros(len(point), dtype=bool)
    for down, side in ((1.0, 0.0), (0.7, 0.7), (0.7, -0.7), (0.0, 1.0), (0.0, -1.0)):
        way = side * across - down * normal
        at = centre + radius * way / np.linalg.norm(way, axis=1, keepdims=True)
        in_stock = drive.inward(at) > 0.0
        for space in drive.cut:
            rows = np.flatnonzero(in_stock)
            in_stock[rows] = ~space.holds(at[rows], GONE)
        meets |= in_stock
    found, first = list[Contacts](), 0
    for line in lines:
        rows = np.flatnonzero(meets[first : first + len(line)])
        first += len(line)
        for begin, end in _stretches(rows, line.travel(radius)):
            found.append(line.of(slice(begin, end)))
    return found


def _stretches(rows: Ints, travel: Floats) -> list[tuple[int, int]]:
    """Return the first row and the one after the last of stretches of a line with travel (n,) mm that hold `rows` (k,) and an overlap
    beyond; those with little between them are one."""
    if not len(rows):
        return []
    ends = np.flatnonzero(np.diff(travel[rows]) > JOINED)
    begin, end = np.append(0, ends + 1), np.append(ends, len(rows) - 1)
    low = np.searchsorted(travel, travel[rows[begin]] - OVERLAP)
    high = np.searchsorted(travel, travel[rows[end]] + OVERLAP, side="right")
    return [(int(a), int(b)) for a, b in zip(low, high, strict=True) if b - a > 1]


def from_outside(
    passes: Sequence[Pass],
    tool: Tool,
    inward: Callable[[Floats], Floats],
    parameters: SphereLinkParameters,
) -> list[Pass]:
    """Return the passes of a layer that are reached from outside of the blank, or straight from the end of the one before, in such an
    order."""
    left, order = list(passes), list[Pass]()
    while left:
        here = order[-1] if order else None
        candidates = []
        for k, one in enumerate(left):
            for way in (one, one.reversed()):
                start = way.tip[0] + tool.corner_radius * way.axis[0]
                outside = bool(inward(start[None])[0] <= -OUTSIDE * tool.corner_radius)
                away = float(np.linalg.norm(way.tip[0] - here.tip[-1])) if here else 0.0
                candidates.append((away, outside, k, way))
        candidates.sort(key=lambda w: w[0])
        for _, outside, k, way in candidates:
            if outside or (here and straight_links([here, way], parameters, [0, 0])[0]):
                order.append(way)
                del left[k]
                break
        else:
            return order
    return order


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


def _length(lines: Sequence[Contacts]) -> float:
    return sum(float(line.travel(0.0)[-1]) for line in lines)


def _left(share: float, feature: str, tool: Tool) -> Finding:
    return warning(
        "wheel.left",
        f"{tool.name} does not go on {trimmed(100.0 * share, 0)} % of the way through the channels",
        feature,
        remedy="rough what is left with a smaller cutter, or choose a smaller allowance",
    )
