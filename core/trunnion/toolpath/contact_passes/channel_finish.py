"""Finishing passes of a period of a wheel: axes with space around them, passes, links, and the copies all around."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from trunnion import tolerance
from trunnion.findings import Finding, warning
from trunnion.geometry.arrays import Bools, Floats
from trunnion.model.operation import CuttingData
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.plan.channel.drive import ChannelDrive
from trunnion.plan.channel.meridian import cylindrical
from trunnion.plan.clearance import ClearanceQuery
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.toolpath.contact_passes.axis_search import LeanLimits, thickened
from trunnion.toolpath.contact_passes.blank_clearance import body_outside, tool_outside
from trunnion.toolpath.contact_passes.contacts import Contacts
from trunnion.toolpath.contact_passes.leaning_passes import PointMilledPasses, milled
from trunnion.toolpath.contact_passes.linking.clearance_links import ClearanceLinks
from trunnion.toolpath.contact_passes.linking.sphere_links import (
    Retreat,
    SphereLinkParameters,
    copied,
    linked_round,
)
from trunnion.toolpath.contact_passes.open_axes import open_axes
from trunnion.toolpath.contact_passes.stock_clearance import LEAST_STOCK
from trunnion.toolpath.contract import Planned
from trunnion.toolpath.motion.reorient import clearance_sphere

OFF = 0.8 * tolerance.CHORD
"""mm that cutters stay off what they finish: the triangles that they are held against stand out of hollow faces by as much."""
SAMPLES = 260
"""Contacts at which axes are looked for; between them they are even."""
CLEARANCE = math.radians(0.5)
"""How far a cutter's flank stays off the face that its ball touches."""
LINK_TURN = math.radians(25.0)
"""Largest turn of the axis on a straight link."""
NEAR = 3.0
"""Stepovers: a pass that begins no farther from the end of the one before is reached straight."""
QUICK, QUICKEST = 3.0, 6000.0
"""Times the feed of cuts: the feed of links that go where stock may stand beside them; and its bound in mm/min, below any machine's."""
CLOSE = 0.5
"""mm before material where links go on at the feed of cuts."""
AIR = 2.0
"""mm that a tool stays off the blank while it goes at rapid over it: its axes may turn one before the other."""
SMALLEST_LEFTOVER = 0.003
"""Share of the passes: less than this is the rim of an area."""


def steepest_of(tool: Tool) -> float:
    """Return the largest angle, rad, of a cutter's axis and the normal where it touches: its flank stays off the face."""
    flank = tool.taper_angle if tool.form == "taper" else 0.0
    return 0.5 * math.pi - math.radians(flank) - CLEARANCE


def wanted_axes(
    drive: ChannelDrive, tool: Tool, point: Floats, normal: Floats, lean: float
) -> Floats:
    """Return the axes (k, 3) that are wanted at contacts (k, 3): along the rulings, the flank leant off the face by `lean` rad at least."""
    ruling = drive.rulings(point)
    least = 0.5 * math.pi - steepest_of(tool) + lean
    rise = np.arcsin(np.clip((ruling * normal).sum(axis=1), -1.0, 1.0))
    along = ruling - np.sin(rise)[:, None] * normal
    size = np.linalg.norm(along, axis=1, keepdims=True)
    along = np.divide(along, size, out=np.zeros_like(along), where=size > 1e-9)
    rise = np.maximum(rise, least)[:, None]
    axis = np.cos(rise) * along + np.sin(rise) * normal
    return np.asarray(axis / np.linalg.norm(axis, axis=1, keepdims=True))


def finished(
    lines: Sequence[Contacts],
    drive: ChannelDrive,
    tool: Tool,
    data: CuttingData,
    setup: Setup,
    wanted: Callable[[Floats, Floats], Floats],
    *,
    turn: float,
    chord: float,
    safety: float,
    stepover: float,
    findings: tuple[Finding, ...] = (),
    progress: Progress = NO_PROGRESS,
) -> Planned:
    """Return the path along lines of contacts, which are cut in their order and direction, and its copies around the wheel.

    `wanted` says which axes are wanted at points with normals, near which space is looked for. Neck, shank and holder stay out of the blank
    and, by a millimetre, off the part; where no axis does so they stay off the part alone.
    """
    surface = drive.surface
    query_for = drive.leaning_query("finishing between blades")
    lines = [line for line in lines if len(line) > 1]
    if not lines:
        return Planned(findings=findings)
    queries = (
        outside_query(query_for(thickened(tool, LEAST_STOCK)), body_outside(tool, drive.inward)),
        query_for(tool),
    )
    done = passes_along(
        lines,
        tool,
        wanted,
        queries,
        LeanLimits(turn=turn, steepest=steepest_of(tool)),
        chord,
        surface.allowance + OFF,
        progress,
    )
    left = remaining_findings(done, surface.feature, tool)
    if not done.passes:
        return Planned(findings=(*findings, *left))
    sphere = clearance_sphere(drive.blank, setup)
    parameters = SphereLinkParameters(
        near=NEAR * stepover,
        turn=LINK_TURN,
        feed=data.feed,
        link_feed=link_feed(data),
        close=CLOSE + data.depth,
        sphere=sphere,
        retreat=out_of_channel(drive, safety),
        query=queries[-1],
        air=clearance_links(drive, tool),
    )
    path = linked_round(done.passes, parameters)
    return Planned(path=copied(path, drive.copies, sphere), findings=(*findings, *left))


def passes_along(
    lines: Sequence[Contacts],
    tool: Tool,
    wanted: Callable[[Floats, Floats], Floats],
    queries: Sequence[ClearanceQuery],
    limits: LeanLimits,
    chord: float,
    allowance: float,
    progress: Progress = NO_PROGRESS,
    samples: int = SAMPLES,
) -> PointMilledPasses:
    """Return the passes along lines, in the order of these, with axes of much space: what the first query lets not be the next one may."""
    done = PointMilledPasses(passes=(), rest=tuple(lines), remaining=1.0)
    for n, query in enumerate(queries):
        share = progress.part(0.9 * n / len(queries), 0.9 * (n + 1) / len(queries))
        if not done.rest:
            break
        point, normal = _some(done.rest, samples)
        found = open_axes(
            point,
            normal,
            wanted(point, normal),
            tool,
            query,
            limits.steepest,
            allowance=allowance,
            progress=share.part(0.0, 0.4),
        )
        if not found.free.any():
            continue
        more = milled(
            done.rest, tool, found.field(), query, limits, chord, allowance, share.part(0.4, 1.0)
        )
        done = PointMilledPasses(
            passes=(*done.passes, *more.passes),
            rest=more.rest,
            remaining=done.remaining * more.remaining,
        )
    return done


def out_of_channel(drive: ChannelDrive, safety: float) -> Retreat:
    """Return how far a tool is fed out along its axis: as far as blades are high, and a safety distance."""
    deep = float(drive.channels[0].meridian.height(np.linspace(0.0, 1.0, 9)).max())
    return lambda tip, axis: deep + safety


def off_hub(
    lines: Sequence[Contacts], drive: ChannelDrive, tool: Tool
) -> tuple[tuple[Contacts, ...], tuple[Finding, ...]]:
    """Return the stretches of lines on which the ball of a tool does not stand in the hub, above its radius in a sharp root, and what is
    left below."""
    hub, found = drive.channels[0].meridian.hub, list[Contacts]()
    for line in lines:
        rz = cylindrical(line.point + tool.corner_radius * line.normal)[0]
        away = np.linalg.norm(hub.places(hub.nearest(rz)) - rz, axis=1)
        clear = np.concatenate([[False], away >= tool.corner_radius - OFF, [False]])
        edges = np.flatnonzero(np.diff(clear.astype(np.int8))).reshape(-1, 2)
        found += [line.of(slice(a, b)) for a, b in edges.tolist() if b - a > 1]
    whole, kept = (sum(float(c.travel(0.0)[-1]) for c in some) for some in (lines, found))
    if kept > (1.0 - SMALLEST_LEFTOVER) * whole:
        return tuple(found), ()
    feature = drive.surface.feature
    left = warning(
        "wheel.left",
        f"{100.0 * (1.0 - kept / whole):.1f} % of the passes over {feature} lie deeper in a sharp root than {tool.name} comes",
        feature,
        remedy="choose a smaller cutter, or give the roots fillets",
    )
    return tuple(found), (left,)


def link_feed(data: CuttingData) -> float:
    """Return the feed in mm/min of links along the tool's axis."""
    return max(data.feed, min(QUICK * data.feed, QUICKEST))


def clearance_links(drive: ChannelDrive, tool: Tool) -> ClearanceLinks | None:
    """Return the links of a tool over the blank; None where fixtures stand that it knows nothing of."""
    if drive.fixed:
        return None
    return ClearanceLinks(
        outside=tool_outside(tool, drive.inward, AIR),
        holds=lambda tip, axis: drive.holds(axis),
    )


def _some(lines: Sequence[Contacts], samples: int) -> tuple[Floats, Floats]:
    """Return some points and normals (k, 3) of lines, evenly many of each."""
    point, normal = (
        np.vstack([getattr(line, name) for line in lines]) for name in ("point", "normal")
    )
    rows = np.unique(np.linspace(0, len(point) - 1, samples).astype(np.int64))
    return point[rows], normal[rows]


def outside_query(
    query: ClearanceQuery, outside: Callable[[Floats, Floats], Bools]
) -> ClearanceQuery:
    """Return a query that demands what another one does, and that what is above the flutes is outside of the blank."""

    def both(
        tip: Floats,
        axis: Floats,
        *,
        start_tip: Floats | None = None,
        start_axis: Floats | None = None,
    ) -> Bools:
        clear = np.asarray(outside(tip, axis))
        some = np.flatnonzero(clear)
        starts = [None if v is None else v[some] for v in (start_tip, start_axis)]
        clear[some] = query(tip[some], axis[some], start_tip=starts[0], start_axis=starts[1])
        return clear

    return both


def remaining_findings(done: PointMilledPasses, feature: str, tool: Tool) -> tuple[Finding, ...]:
    if done.remaining < SMALLEST_LEFTOVER:
        return ()
    return (
        warning(
            "wheel.left",
            f"{100.0 * done.remaining:.1f} % of the passes over {feature} stay: {tool.name} finds no way to lean there",
            feature,
            remedy="choose a smaller or longer cutter, or a slimmer holder",
        ),
    )
