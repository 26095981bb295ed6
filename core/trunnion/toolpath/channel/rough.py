"""Roughing of channels between blades: layers from shroud to hub, passes along the stream, the tool along the walls' rulings.

Layers are morphed: each is as deep as the same share of the way from hub to shroud, so that they follow both. A pass begins and ends
outside of the blank, before the leading edges and behind the outlet: nothing is plunged into.
"""

from __future__ import annotations

import math

import numpy as np

from trunnion.findings import Finding, Refused, warning
from trunnion.geometry.arrays import Floats
from trunnion.model.motion.toolpath import Toolpath
from trunnion.model.operation import CuttingData, Engagement, Operation
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.plan.channel.drive import ChannelDrive
from trunnion.plan.clearance import ClearanceQuery
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.settings import setting, settings
from trunnion.toolpath.contact_passes.blank_clearance import body_outside
from trunnion.toolpath.contact_passes.channel_levels import Columns, columns_of
from trunnion.toolpath.contact_passes.orbit import OrbitParameters, copied, orbited
from trunnion.toolpath.contact_passes.passes import Pass
from trunnion.toolpath.contact_passes.stock_clearance import grown
from trunnion.toolpath.contract import Planned, leaning_axis, strategy
from trunnion.toolpath.motion.reorient import clearance_sphere
from trunnion.toolpath.stock.heightfield import PlanningStock
from trunnion.units import trimmed

LINK_TURN = math.radians(40.0)
"""Largest turn of the axis on a link in the air."""
SHORT = 3
"""A piece of a pass with fewer poses than this cuts nothing worth the way."""


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
    """Return the path that roughs the gaps of a period and its copies, and what stays because the tool does not go there."""
    surface = drive.surface
    if surface.query_for is None:
        raise Refused(
            f"{surface.feature}: roughing channels leans the tool; choose a machine with rotary axes"
        )
    allowance = surface.allowance
    thick = surface.query_for(grown(tool, allowance))

    def query(
        tip: Floats,
        axis: Floats,
        *,
        start_tip: Floats | None = None,
        start_axis: Floats | None = None,
    ) -> np.ndarray:
        begin = None if start_tip is None else start_tip - allowance * _given(start_axis, axis)
        return thick(tip - allowance * axis, axis, start_tip=begin, start_axis=start_axis)

    sphere = clearance_sphere(drive.blank, setup)
    paths, findings = [], []
    for n, gap in enumerate(drive.gaps):
        share = progress.part(n / len(drive.gaps), (n + 1) / len(drive.gaps))
        deepest = float(gap.meridian.height(np.linspace(0.0, 1.0, 9)).max())
        wide = widest(tool, deepest)
        columns = columns_of(
            gap,
            tool,
            allowance,
            surface.query_for,
            (wide + settings.safety, wide + settings.safety),
            body_outside(tool, drive.inward),
            share.part(0.0, 0.7),
        )
        passes, groups, left = layers(columns, tool, data, query, share.part(0.7, 1.0))
        parameters = OrbitParameters(
            near=2.0 * deepest,
            turn=LINK_TURN,
            feed=data.feed,
            link_feed=data.feed,
            sphere=sphere,
            retreat=_retreat(deepest + settings.safety),
            query=query,
        )
        paths.append(orbited(passes, parameters, groups))
        findings += _left(left, surface.feature, tool)
    whole = Toolpath.join([p for p in paths if len(p)])
    return Planned(path=copied(whole, drive.copies, sphere), findings=tuple(findings))


def layers(
    columns: Columns,
    tool: Tool,
    data: CuttingData,
    query: ClearanceQuery,
    progress: Progress = NO_PROGRESS,
) -> tuple[list[Pass], list[int], float]:
    """Return the passes of all layers from shroud to hub, to and fro, the layer of each, and the share of the hub's places along u that stay out of reach.

    Layers are no deeper than the data's depth, passes no farther apart than their width, at the widest place of each.
    """
    count = max(1, math.ceil(float(columns.height.max()) / data.depth))
    passes: list[Pass] = []
    groups: list[int] = []
    reached = np.ones(len(columns.u), dtype=bool)
    for k in range(1, count + 1):
        progress.at(k / count, "Laying layers between hub and shroud")
        share = 1.0 - k / count
        low, high, reached = columns.open(share)
        for lines in _lines(columns, low, high, share, data.width):
            if passes and lines and _far(passes[-1], lines[0]) > _far(passes[-1], lines[-1]):
                lines = lines[::-1]
            for line in lines:
                if passes and np.linalg.norm(line.tip[0] - passes[-1].tip[-1]) > np.linalg.norm(
                    line.tip[-1] - passes[-1].tip[-1]
                ):
                    line = line.reversed()
                passes += _clear(line, query)
                groups += [k] * (len(passes) - len(groups))
    return passes, groups, 1.0 - float(reached.mean())


def widest(tool: Tool, height: float) -> float:
    """Return the largest radius in mm of a cutter up to a height above its tip."""
    flank = math.tan(math.radians(tool.taper_angle)) * max(height - tool.corner_radius, 0.0)
    return tool.radius + (flank if tool.form == "taper" else 0.0)


def _given(axis: Floats | None, other: Floats) -> Floats:
    return other if axis is None else axis


def _lines(
    columns: Columns, low: Floats, high: Floats, share: float, stepover: float
) -> list[list[Pass]]:
    """Return the passes side by side at a share of the height, as they lie: first those that go all along, close enough where the gap is
    narrowest; then, halving by halving, those between them, only where they are needed.

    A gap widens along the stream: passes as close as its widest place asks for would cut air everywhere else.
    """
    ends = [columns.at(v, _rise(columns, v, share))[0] for v in (low, high)]
    width = np.linalg.norm(ends[1] - ends[0], axis=1)
    count = max(1, math.ceil(float(width.min()) / stepover))
    found = [
        [_line(columns, low, high, share, s, slice(None)) for s in np.linspace(0.0, 1.0, count + 1)]
    ]
    while (width / count).max() > stepover:
        wide = width / count > stepover
        # A place more at either end: there the passes beside have cleared all.
        wide |= np.concatenate([wide[1:], [False]]) | np.concatenate([[False], wide[:-1]])
        edges = np.flatnonzero(np.diff(np.concatenate([[False], wide, [False]]).astype(np.int8)))
        found.append(
            [
                _line(columns, low, high, share, s, slice(a, b))
                for s in ((np.arange(count) + 0.5) / count).tolist()
                for a, b in edges.reshape(-1, 2).tolist()
                if b - a >= SHORT
            ]
        )
        count *= 2
    return found


def _line(columns: Columns, low: Floats, high: Floats, share: float, s: float, rows: slice) -> Pass:
    v = (1.0 - s) * low + s * high
    tip, axis = columns.at(v, _rise(columns, v, share))
    return Pass(tip=tip[rows], axis=axis[rows], normal=axis[rows])


def _rise(columns: Columns, v: Floats, share: float) -> Floats:
    """Return how high (nu,) mm above the root a pass is: at its share of the height, or at the foot of its column where that is higher."""
    rise = share * columns.heights(v)
    foot = np.array([_foot(columns.v, row, x) for x, row in zip(v, columns.foot, strict=True)])
    return np.maximum(rise, np.where(np.isfinite(foot), foot, rise))


def _foot(at: Floats, row: Floats, v: float) -> float:
    """Return the higher foot of the columns beside a place."""
    place = float(np.interp(v, at, np.arange(len(at))))
    low, high = math.floor(place), math.ceil(place)
    return float(max(row[low], row[high])) if high > low else float(row[low])


def _far(one: Pass, line: Pass) -> float:
    here = one.tip[-1]
    return float(min(np.linalg.norm(line.tip[0] - here), np.linalg.norm(line.tip[-1] - here)))


def _clear(line: Pass, query: ClearanceQuery) -> list[Pass]:
    """Return the pieces of a pass whose moves are clear."""
    clear = query(line.tip[1:], line.axis[1:], start_tip=line.tip[:-1], start_axis=line.axis[:-1])
    edges = np.flatnonzero(np.diff(np.concatenate([[False], clear, [False]]).astype(np.int8)))
    return [
        line.of(slice(a, b + 1)) for a, b in edges.reshape(-1, 2).tolist() if b + 1 - a >= SHORT
    ]


def _retreat(distance: float):  # type: ignore[no-untyped-def]
    return lambda tip, axis: distance


def _left(share: float, feature: str, tool: Tool) -> list[Finding]:
    if share <= 0.0:
        return []
    return [
        warning(
            "channel.left",
            f"{tool.name} does not come down to the hub on {trimmed(100.0 * share, 0)} % of the way through {feature}",
            feature,
            remedy="rough what is left with a smaller cutter, or choose a smaller allowance",
        )
    ]
