"""Finishing of the hub between blades: streamlines from before the leading edges to the outlet, between the root fillets.

Lines of equal share of the way from camber to camber run with the stream. Where a gap widens more of them begin between the others. Each
ends where the cutter would touch a root fillet; two more follow these ends, so that nothing stays beside the fillets.
"""

from __future__ import annotations

import math

import numpy as np

from trunnion.findings import Refused
from trunnion.geometry.arrays import Floats
from trunnion.model.operation import CuttingData
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.plan.channel.drive import ChannelDrive
from trunnion.plan.channel.gap import Gap
from trunnion.plan.freeform.estimate.scallop import stepover_on_plane
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.settings import setting, settings
from trunnion.toolpath.contact_passes.blank_clearance import body_outside
from trunnion.toolpath.contact_passes.channel_finish import finished
from trunnion.toolpath.contact_passes.channel_levels import Columns, columns_of
from trunnion.toolpath.contact_passes.contacts import Contacts
from trunnion.toolpath.contract import Planned, leaning_axis, strategy
from trunnion.toolpath.motion.engagement import surface_leftovers
from trunnion.toolpath.stock.heightfield import PlanningStock

SHORT = 4
"""Contacts that a line has at least."""
HALVINGS = 7
"""Times that the place where a line must end is halved: to 2 um of a quarter of a mm."""
BESIDE = 1e-4
"""Share of a gap by which lines end before the cutter touches."""


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
    turn: float = setting(
        10.0,
        unit="deg/mm",
        low=0.5,
        high=60.0,
        label="Axis turn",
        help="How far the axis may turn on a mm of the cutter's way.",
    )
    chord: float = setting(
        0.001,
        unit="mm",
        low=0.0001,
        high=0.1,
        label="Chord error",
        help="How far a block may leave the hub, on either side.",
    )
    safety: float = setting(
        1.0,
        unit="mm",
        low=0.2,
        high=50.0,
        label="Safety distance",
        help="How far over the shroud the tool is fed out of a channel before it goes at rapid.",
    )


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
    """Return the path over the hub in the gaps of a period and its copies, and what the tool does not come to."""
    surface = drive.surface
    if surface.query_for is None:
        raise Refused(
            f"{surface.feature}: finishing between blades leans the tool; choose a machine with rotary axes"
        )
    stepover = stepover_on_plane(tool.corner_radius, surface.height)
    outside = body_outside(tool, drive.inward)
    lines: list[Contacts] = []
    axes: list[tuple[Floats, Floats, Floats]] = []
    for n, gap in enumerate(drive.gaps):
        share = progress.part(0.4 * n / len(drive.gaps), 0.4 * (n + 1) / len(drive.gaps))
        columns = columns_of(
            gap,
            tool,
            surface.allowance,
            surface.query_for,
            (settings.before, 0.5 * tool.radius),
            outside,
            share,
        )
        query = surface.query_for(tool)
        low, high = _ends(columns, lambda v, c=columns, q=query: _touches_nothing(c, v, q))
        lines += _lines(gap, columns.u, low, high, stepover)
        axes.append(
            (
                columns.point.reshape(-1, 3),
                columns.normal.reshape(-1, 3),
                columns.axis.reshape(-1, 3),
            )
        )
    point, normal, axis = (np.vstack([a[k] for a in axes]) for k in range(3))
    near = _nearest(point, axis)
    return finished(
        [line.reversed() if k % 2 else line for k, line in enumerate(lines)],
        drive,
        tool,
        data,
        setup,
        lambda places, normals: near(places),
        turn=math.radians(settings.turn),
        chord=settings.chord,
        safety=settings.safety,
        stepover=stepover,
        progress=progress.part(0.4, 1.0),
    )


def _nearest(point: Floats, axis: Floats):  # type: ignore[no-untyped-def]
    from scipy.spatial import cKDTree

    tree = cKDTree(point)
    return lambda places: axis[np.asarray(tree.query(places)[1])]


def _touches_nothing(columns: Columns, v: Floats, query):  # type: ignore[no-untyped-def]
    """Return where (nu,) the tool at places v (nu,) of each u is clear."""
    tip, axis = columns.at(v, np.zeros(len(v)))
    return query(tip, axis)


def _ends(columns: Columns, clear) -> tuple[Floats, Floats]:  # type: ignore[no-untyped-def]
    """Return between which v (nu,), (nu,) the tool reaches the hub at each u; NaN where nowhere."""
    free = columns.foot <= 0.0
    low, high = np.full(len(columns.u), np.nan), np.full(len(columns.u), np.nan)
    below, above = low.copy(), high.copy()
    for row, some in enumerate(free):
        edges = np.flatnonzero(np.diff(np.concatenate([[False], some, [False]]).astype(np.int8)))
        runs = edges.reshape(-1, 2)
        if not len(runs):
            continue
        a, b = max(runs.tolist(), key=lambda r: (r[1] - r[0], -r[0]))
        low[row], high[row] = columns.v[a], columns.v[b - 1]
        below[row] = columns.v[max(a - 1, 0)]
        above[row] = columns.v[min(b, len(columns.v) - 1)]
    known = np.isfinite(low)
    for _ in range(HALVINGS):
        for inner, outer in ((low, below), (high, above)):
            middle = np.where(known, 0.5 * (inner + outer), 0.5)
            good = clear(middle) & known
            inner[good] = middle[good]
            bad = ~good & known
            outer[bad] = middle[bad]
    return low, high


def _lines(gap: Gap, u: Floats, low: Floats, high: Floats, stepover: float) -> list[Contacts]:
    """Return the lines between the ends: those that follow the ends, those of equal v, closer where the gap is wider."""
    radius = gap.meridian.at(u, np.zeros_like(u))[:, 0]
    zero, one = np.zeros_like(u), np.ones_like(u)
    whole = radius * (gap.angle(u, one, zero) - gap.angle(u, zero, zero))
    known = np.isfinite(low) & (high > low)
    inside = known & (u >= 0.0)
    found = [line for ends in (low, high) for line in _runs(gap, u, ends, inside)]
    count = max(1, math.ceil(float(whole[known].min(initial=stepover)) / stepover))
    places = [(k + 0.5) / count for k in range(count)]
    wide = known
    while True:
        for v in places:
            at = np.full_like(u, v)
            found += _runs(gap, u, at, wide & (low + BESIDE <= at) & (at <= high - BESIDE))
        if (whole[known] / count).max(initial=0.0) <= stepover:
            return found
        # Each line gets one to both sides where a third of its room is still as wide as a stepover.
        wide = known & (whole / count > stepover)
        wide |= np.concatenate([wide[1:], [False]]) & known
        places = sorted([(k + s) / count for k in range(count) for s in (1.0 / 6.0, 5.0 / 6.0)])
        count *= 3


def _runs(gap: Gap, u: Floats, v: Floats, rows: np.ndarray) -> list[Contacts]:
    """Return the lines (u, v) over the hub in each run of rows (nu,)."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], rows, [False]]).astype(np.int8)))
    found = []
    for a, b in edges.reshape(-1, 2).tolist():
        if b - a >= SHORT:
            point, normal = gap.hub(u[a:b], v[a:b])
            found.append(Contacts(point=point, normal=normal))
    return found
