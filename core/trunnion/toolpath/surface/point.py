"""Point milling: a cutter led along passes of contacts, its axis leaning to a field and out of the way of everything.

Contacts come from flow lines or passes of constant scallop, axes from `lean`; where the cutter is follows from its form. Blocks are as
long as the cutter, carried straight from tip to tip while its axis turns evenly, stays within the chord error of the faces, on either side.
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import cKDTree

from trunnion import tolerance
from trunnion.findings import BadInput, Finding, Refused, info, warning
from trunnion.geometry.arrays import Bools, Floats
from trunnion.geometry.frame import Frame
from trunnion.geometry.kernels.cutter_contact.drop_cutter import ROUND, C
from trunnion.model.motion.toolpath import Mark, Toolpath
from trunnion.model.operation import CuttingData
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.plan.clearance import ClearanceQuery
from trunnion.plan.freeform.cutters.cutter import lower_side, tip_at, touching
from trunnion.plan.freeform.drive import SurfaceDrive
from trunnion.plan.freeform.estimate.scallop import stepover_on_plane
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.settings import setting, settings
from trunnion.toolpath.contact_passes.axis_fields import (
    AxisField,
    fixed,
    from_point,
    interpolated,
    leaning,
)
from trunnion.toolpath.contact_passes.axis_search import (
    STEP,
    AxisSearch,
    FreeAxes,
    LeanLimits,
    free_axes,
)
from trunnion.toolpath.contact_passes.contacts import Contacts, between, slerp
from trunnion.toolpath.contact_passes.flow_lines import DenseFlowLines, FlowParameters, flow_lines
from trunnion.toolpath.contact_passes.linking import LinkParameters, linked
from trunnion.toolpath.contact_passes.passes import Pass
from trunnion.toolpath.contact_passes.stepover.fronts import scallop_passes
from trunnion.toolpath.contact_passes.stock_clearance import (
    LEAST_STOCK,
    STOCK_SHARE,
    StockClearance,
)
from trunnion.toolpath.contract import Planned, leaning_axis, strategy
from trunnion.toolpath.motion.engagement import surface_leftovers
from trunnion.toolpath.stock.heightfield import PlanningStock
from trunnion.units import trimmed

SHARES = (0.25, 0.5, 0.75)
"""Where on a block its chord error is looked at, beside the contacts on its path."""
HALVINGS = 12
TRIES = 4
"""Times that axes are chosen again where a move between two clear ones touched something."""
OVERLAP = 0.25
"""Of an earlier cutter's radius: how far what it left is cut beyond its end."""
LEADS = (1.0, 0.4, 0.0)
"""Shares of the lead radius that are tried where leads touch something."""
STRAIGHT = 1000.0
"""mm: a cutter that is flatter where it touches counts as this round."""
SMALLEST_LEFTOVER = 0.5
"""mm2: less than this is the rim of an area."""


@settings("surface.point")
class PointSettings:
    """How the tool leans, how its axis may turn, and how finely the path is cut."""

    pattern: str = setting(
        "flow",
        label="Pattern",
        help="Along flow lines between two guides, or as far from pass to pass as keeps the "
        "scallop the same everywhere.",
        choices=("flow", "constant"),
    )
    axis: str = setting(
        "normal",
        label="Tool axis",
        help="What the axis keeps to: the face's normal with lead and tilt, a fixed "
        "direction, away from a place, towards a place, or between given vectors. It leaves that where it must.",
        choices=("normal", "fixed", "away", "towards", "vectors"),
    )
    lead: float = setting(
        10.0,
        unit="deg",
        low=-60.0,
        high=60.0,
        label="Lead angle",
        help="Lean from the normal towards the feed.",
    )
    tilt: float = setting(
        0.0,
        unit="deg",
        low=-60.0,
        high=60.0,
        label="Tilt angle",
        help="Lean from the normal to the left of the feed.",
    )
    axis_from: str = setting(
        "",
        label="Axis from",
        help="In the part's coordinates: a direction x y z, a place x y z, or vectors as "
        "x y z > i j k; x y z > i j k.",
    )
    turn: float = setting(
        10.0,
        unit="deg/mm",
        low=0.5,
        high=60.0,
        label="Axis turn",
        help="How far the axis may turn on a mm of the cutter's way.",
    )
    steepest: float = setting(
        75.0,
        unit="deg",
        low=10.0,
        high=85.0,
        label="Steepest lean",
        help="Largest angle of axis and normal.",
    )
    first_guide: str = setting(
        "",
        label="First guide",
        help="Faces beyond the rim where the flow lines begin, as in: face 12, face 13.",
    )
    second_guide: str = setting(
        "", label="Second guide", help="Faces beyond the rim where the flow lines end."
    )
    spiral: bool = setting(
        True,
        label="Spiral",
        help="Cut a tube or ring in one continuous spiral instead of closed passes.",
    )
    way: str = setting(
        "one",
        label="Way",
        help="Every pass in the climbing direction, or to and fro, which unwinds rotary axes that can't "
        "turn for ever.",
        choices=("one", "both"),
    )
    chord: float = setting(
        0.0005,
        unit="mm",
        low=0.0001,
        high=0.1,
        label="Chord error",
        help="How far a block may leave the faces, on either side.",
    )
    lead_radius: float = setting(
        0.5,
        unit="mm",
        low=0.0,
        high=20.0,
        label="Lead radius",
        help="Radius of the arcs onto and off the face.",
    )
    safety: float = setting(
        2.0,
        unit="mm",
        low=0.2,
        high=50.0,
        label="Safety distance",
        help="How far rapids stay from the blank.",
    )
    wary: bool = setting(
        False,
        label="Wary of stock",
        help="Leave out what the tool comes to only where its shank or holder may meet stock that earlier tools left on the part.",
    )


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PointMilledPasses:
    """Passes of a leaning cutter, the stretches of the contact lines that had to be left, and their share of the paths."""

    passes: tuple[Pass, ...]
    rest: tuple[Contacts, ...]
    remaining: float


@strategy(
    settings=PointSettings, drive=SurfaceDrive, tool_axis=leaning_axis, meets=surface_leftovers
)
def point(
    drive: SurfaceDrive,
    tool: Tool,
    data: CuttingData,
    stock: PlanningStock,
    setup: Setup,
    settings: PointSettings,
    progress: Progress = NO_PROGRESS,
) -> Planned:
    """Return the path of a leaning tool over the drive's faces, or over what an earlier cutter left of them, and what it must leave."""
    if drive.query_for is None:
        raise Refused(
            f"{drive.feature}: point milling leans the tool; choose a machine with rotary axes, or another strategy"
        )
    query, lead, tilt = (
        drive.query_for(tool),
        math.radians(settings.lead),
        math.radians(settings.tilt),
    )
    ball = grooving(tool, lead, tilt)
    contact_lines, pattern_findings = _contact_lines(drive, ball, settings, progress.part(0.0, 0.3))
    if settings.way == "both":
        contact_lines = tuple(
            contacts.reversed() if k % 2 else contacts for k, contacts in enumerate(contact_lines)
        )
    limits = LeanLimits(turn=math.radians(settings.turn), steepest=math.radians(settings.steepest))
    field = field_of(settings, drive.frame)
    if drive.earlier is not None:
        contact_lines = rest_of(
            contact_lines,
            drive.earlier,
            field,
            drive.query_for(drive.earlier),
            limits,
            drive.allowance,
            progress.part(0.3, 0.4),
        )
        if not contact_lines:
            return Planned(
                findings=(
                    info(
                        "point.nothing-left",
                        f"{drive.earlier.name} left nothing of {drive.feature}",
                        drive.feature,
                    ),
                )
            )
    thickness = max(STOCK_SHARE * data.depth, LEAST_STOCK)
    around = StockClearance.of(drive, tool, thickness)
    queries = around.queries(drive.query_for, query, wary=settings.wary)
    done = PointMilledPasses(passes=(), rest=contact_lines, remaining=1.0)
    for n, free in enumerate(queries):
        more = milled(
            done.rest,
            tool,
            field,
            free,
            limits,
            settings.chord,
            drive.allowance,
            progress.part(0.4 + 0.5 * n / len(queries), 0.4 + 0.5 * (n + 1) / len(queries)),
        )
        done = PointMilledPasses(
            passes=(*done.passes, *more.passes),
            rest=more.rest,
            remaining=done.remaining * more.remaining,
        )
    stepover = stepover_on_plane(max(ball.radius, drive.height), drive.height)
    findings = _remaining_findings(done, drive, tool)
    if not done.passes:
        return Planned(findings=(*pattern_findings, *findings))
    parameters = LinkParameters(
        stepover=stepover,
        safety=settings.safety,
        lead_radius=settings.lead_radius,
        retreat=around.retreat,
        query=query,
    )
    path, met = _linked(
        done, drive, tool, data, stock, setup, parameters, query, progress.part(0.9, 1.0)
    )
    return Planned(
        path=path, findings=(*pattern_findings, *findings, *met, *_low(path, drive, tool))
    )


def _contact_lines(
    drive: SurfaceDrive, ball: Tool, settings: PointSettings, progress: Progress
) -> tuple[tuple[Contacts, ...], tuple[Finding, ...]]:
    """Return the lines of contacts that the pattern requests, or those of constant scallop where flow lines don't suit the area, and then
    a finding that says so."""
    pattern_findings: tuple[Finding, ...] = ()
    if settings.pattern == "flow":
        flow = FlowParameters(
            first_guide=settings.first_guide,
            second_guide=settings.second_guide,
            spiral=settings.spiral,
        )
        try:
            return flow_lines(drive, ball, flow, progress), pattern_findings
        except DenseFlowLines as reason:
            pattern_findings = (
                info(
                    "point.pattern",
                    f"{drive.feature}: cut at a constant scallop, for {reason}",
                    drive.feature,
                    remedy="set surface.point.pattern to constant to have it so without this note",
                ),
            )
    # They run with what is inside on their left: the other way round a cutter that turns clockwise climbs.
    return tuple(
        contacts.reversed() for contacts in scallop_passes(drive, ball, settings.chord, progress)
    ), pattern_findings


def milled(
    contact_lines: Sequence[Contacts],
    tool: Tool,
    field: AxisField,
    query: ClearanceQuery | None,
    limits: LeanLimits,
    chord: float,
    allowance: float = 0.0,
    progress: Progress = NO_PROGRESS,
) -> PointMilledPasses:
    """Return the passes of a cutter over contact passes, its axis as near to a field as `query` and the limits let it.

    The cutter stays within `chord` mm of where it touches, thicker by the allowance. Moves that touch what they must not are left out.
    """
    if not contact_lines:
        return PointMilledPasses(passes=(), rest=(), remaining=0.0)
    # Axes first, then the poses along them; moves that touch something go back to the search (`met`) until TRIES are over.
    search = AxisSearch(contact_lines, field, tool, query, limits, allowance)
    axes_of_lines = search.found_axes(progress.part(0.0, 0.5))
    found: list[list[tuple[Floats, Pass]]] = [[] for _ in contact_lines]
    again = list(range(len(contact_lines)))
    for n in range(TRIES):
        share = progress.part(1.0 - 0.5 ** (n + 1), 1.0 - 0.5 ** (n + 2))
        for k in share.over(again, "Following flow lines with a leaning tool"):
            found[k], met = _cut(
                [
                    located(contact_lines[k], run, tool, chord, allowance)
                    for run in axes_of_lines[k].runs()
                ],
                query,
            )
            if len(met) and n + 1 < TRIES:
                search.met(k, met)
        again = np.flatnonzero(search.dirty).tolist()
        axes_of_lines = search.found_axes(share) if again else axes_of_lines
    # What no pass covers is the rest, in rows of the contacts: left to a thinner tool or reported.
    gaps = [
        _gaps(
            len(contacts) - 1.0,
            [(float(position[0]), float(position[-1])) for position, _ in pieces],
        )
        for contacts, pieces in zip(contact_lines, found, strict=True)
    ]
    whole, remaining = (
        sum(_run(contacts, 0.0, len(contacts) - 1.0) for contacts in contact_lines),
        sum(_run(contacts, *g) for contacts, some in zip(contact_lines, gaps) for g in some),
    )
    rest = tuple(
        contacts.of(slice(math.floor(a), math.ceil(b) + 1))
        for contacts, some in zip(contact_lines, gaps, strict=True)
        for a, b in some
    )
    return PointMilledPasses(
        passes=tuple(one for pieces in found for _, one in pieces),
        rest=rest,
        remaining=remaining / whole if whole > 0.0 else 0.0,
    )


def rest_of(
    contact_lines: Sequence[Contacts],
    earlier: Tool,
    field: AxisField,
    query: ClearanceQuery,
    limits: LeanLimits,
    allowance: float = 0.0,
    progress: Progress = NO_PROGRESS,
) -> tuple[Contacts, ...]:
    """Return the stretches of contact passes where an earlier cutter had no free axis, and a little more all round."""
    axes_of_lines = free_axes(contact_lines, field, earlier, query, limits, allowance, progress)
    gone = np.vstack(
        [
            np.zeros((0, 3)),
            *(
                between(contacts.point, contacts.normal, contacts.feed, axes.position[~axes.free])[
                    0
                ]
                for contacts, axes in zip(contact_lines, axes_of_lines, strict=True)
            ),
        ]
    )
    if not len(gone):
        return ()
    tree, overlap, found = cKDTree(gone), OVERLAP * earlier.radius + STEP / limits.turn, []
    for contacts in contact_lines:
        near = tree.query(contacts.point)[0] <= overlap
        edges = np.flatnonzero(np.diff(np.concatenate([[False], near, [False]]).astype(np.int64)))
        found += [contacts.of(slice(a, b)) for a, b in edges.reshape(-1, 2).tolist() if b - a > 1]
    return tuple(found)


def located(
    contacts: Contacts, run: FreeAxes, tool: Tool, chord: float, allowance: float = 0.0
) -> tuple[Floats, Pass]:
    """Return where a cutter is along a run of a contact pass: the positions (k,) of the path and the pass itself."""
    radius, feed = max(tool.corner_radius, 0.25 * tool.radius), contacts.feed
    travel = contacts.travel(radius)
    position = run.position
    rows = np.arange(len(contacts), dtype=np.float64)
    rows = rows[(rows > position[0]) & (rows < position[-1])]
    normal, axis, tip = _poses_at(contacts, feed, run, tool, allowance, position)
    # Halve: off is the distance between the straight block and the contact's tip, along the face's normal.
    for _ in range(HALVINGS):
        share = np.concatenate([position[:-1] + s * np.diff(position) for s in SHARES])
        probe = np.concatenate([rows, share])
        block = np.clip(np.searchsorted(position, probe, side="right") - 1, 0, len(position) - 2)
        gone = np.interp(probe, np.arange(len(contacts)), travel)
        ends = np.interp(position, np.arange(len(contacts)), travel)
        part = np.clip(
            (gone - ends[block]) / np.maximum(ends[block + 1] - ends[block], tolerance.PARAMETRIC),
            0.0,
            1.0,
        )
        turned = slerp(axis[block], axis[block + 1], part)
        at, out = between(contacts.point, contacts.normal, feed, probe)
        tip_at_block = tip[block] + part[:, None] * (tip[block + 1] - tip[block])
        off = np.abs(
            ((tip_at_block - tip_at(tool, at + allowance * out, out, turned)) * out).sum(axis=1)
        )
        worst = np.zeros(len(position) - 1)
        np.maximum.at(worst, block, off)
        split = np.flatnonzero(
            (worst > chord)
            & (np.linalg.norm(np.diff(tip, axis=0), axis=1) > 2.0 * tolerance.SHORT_MOVE)
        )
        if not len(split):
            break
        position = np.sort(
            np.concatenate([position, 0.5 * (position[split] + position[split + 1])])
        )
        normal, axis, tip = _poses_at(contacts, feed, run, tool, allowance, position)
    return position, Pass(tip=tip, axis=axis, normal=normal)


def grooving(tool: Tool, lead: float, tilt: float) -> Tool:
    """Return the ball that leaves the same grooves as a cutter that leans by a lead and a tilt (rad): how wide apart passes may lie.

    Where a cutter touches, it is as round as its profile in the plane of its axis, and round about its axis across that plane.
    """
    if tool.form == "ball" or (tool.form == "taper" and tool.corner_radius == tool.radius):
        radius = tool.corner_radius
    else:
        lean = math.acos(math.cos(lead) * math.cos(tilt))
        pieces = lower_side(tool)
        rho = float(touching(tool, np.array([lean]))[0][0])
        profile = next(
            (1.0 / row[C] for row in pieces if row[ROUND] and row[0] <= rho <= row[1]), 0.0
        )
        # The share of the lean that lies across the feed.
        across = (math.sin(tilt) / math.sin(lean)) ** 2 if lean > 0.0 else 0.0
        curved = across * profile + (1.0 - across) * (
            math.sin(lean) / rho if rho > 0.0 else profile
        )
        radius = 1.0 / max(curved, 1.0 / STRAIGHT)
    return replace(
        tool,
        form="ball",
        diameter=2.0 * radius,
        corner_radius=radius,
        flute_length=max(tool.flute_length, radius),
        neck_length=max(tool.neck_length, radius),
        stickout=max(tool.stickout, radius),
        gauge_length=max(tool.gauge_length, radius),
        taper_angle=0.0,
        barrel_radius=0.0,
    )


def field_of(settings: PointSettings, frame: Frame) -> AxisField:
    """Return the axis field that settings ask for; positions and directions are given in the part's coordinates."""
    numbers = _numbers(settings.axis_from)
    if settings.axis == "normal":
        return leaning(math.radians(settings.lead), math.radians(settings.tilt))
    if settings.axis == "vectors" and len(numbers) and len(numbers) % 6 == 0:
        rows = np.array(numbers).reshape(-1, 6)
        return interpolated(frame.to_local(rows[:, :3]), frame.local_direction(rows[:, 3:]))
    if settings.axis != "vectors" and len(numbers) == 3:
        if settings.axis == "fixed":
            return fixed(frame.local_direction(np.array(numbers)))
        return from_point(frame.to_local(np.array(numbers)), settings.axis == "away")
    wanted = (
        "vectors as x y z > i j k; x y z > i j k"
        if settings.axis == "vectors"
        else "three numbers x y z"
    )
    raise BadInput(
        f"Axis from (surface.point.axis_from) must be {wanted} while the tool axis is {settings.axis}; got {settings.axis_from!r}"
    )


def _linked(
    done: PointMilledPasses,
    drive: SurfaceDrive,
    tool: Tool,
    data: CuttingData,
    stock: PlanningStock,
    setup: Setup,
    parameters: LinkParameters,
    query: ClearanceQuery,
    progress: Progress,
) -> tuple[Toolpath, tuple[Finding, ...]]:
    """Return the path through all passes; leads that touch something are tried shorter, what touches in the end is a finding."""
    path, has_contact = Toolpath.join([]), np.zeros(0, dtype=bool)
    for n, share in enumerate(LEADS):
        path = linked(
            done.passes,
            drive,
            tool,
            data,
            stock,
            setup,
            replace(parameters, lead_radius=share * parameters.lead_radius),
            progress.part(n / len(LEADS), (n + 1) / len(LEADS)),
        )
        between_cuts = np.flatnonzero(path.mark[1:] != Mark.CUT) + 1
        has_contact = ~query(
            path.position[between_cuts],
            path.axis[between_cuts],
            start_tip=path.position[between_cuts - 1],
            start_axis=path.axis[between_cuts - 1],
        )
        if not has_contact.any():
            return path, ()
    return path, (
        warning(
            "point.link",
            f"{int(has_contact.sum())} moves between the passes of {drive.feature} touch part or fixtures",
            drive.feature,
            remedy="choose a smaller cutter or another lead, or cut fewer faces in one operation",
        ),
    )


def _low(path: Toolpath, drive: SurfaceDrive, tool: Tool) -> tuple[Finding, ...]:
    """Return how far the leaning tool comes down beside the blank: no table is in the proof."""
    nose = path.position + tool.gauge_length * path.axis
    reach = np.sqrt(np.maximum(1.0 - path.axis[:, 2] ** 2, 0.0)) * tool.holder.radius
    deep = float(drive.low[2] - (nose[:, 2] - reach).min(initial=np.inf))
    if deep <= 0.0:
        return ()
    return (
        warning(
            "point.low",
            f"the holder of {tool.name} comes {trimmed(deep, 0)} mm lower than the blank's underside while it leans",
            drive.feature,
            remedy=f"let the part stand at least {trimmed(deep, 0)} mm above the table",
        ),
    )


def _numbers(text: str) -> list[float]:
    try:
        return [float(word) for word in re.split(r"[\s,;>]+", text.strip()) if word]
    except ValueError:
        return []


def _poses_at(
    contacts: Contacts, feed: Floats, run: FreeAxes, tool: Tool, allowance: float, position: Floats
) -> tuple[Floats, Floats, Floats]:
    """Return the normals, axes and tips (k, 3) at positions (k,) of a run."""
    point, normal = between(contacts.point, contacts.normal, feed, position)
    axis = run.at(position)
    return normal, axis, tip_at(tool, point + allowance * normal, normal, axis)


def _cut(
    runs: Sequence[tuple[Floats, Pass]], query: ClearanceQuery | None
) -> tuple[list[tuple[Floats, Pass]], Floats]:
    """Return the stretches of runs whose moves are clear, and the positions where a move is not."""
    if query is None:
        return list(runs), np.zeros(0)
    pieces, met = [], [np.zeros(0)]
    for position, one in runs:
        clear = query(one.tip[1:], one.axis[1:], start_tip=one.tip[:-1], start_axis=one.axis[:-1])
        pieces += [(position[s], one.of(s)) for s in _stretches(clear)]
        met.append(0.5 * (position[:-1] + position[1:])[~clear])
    return pieces, np.concatenate(met)


def _stretches(clear: Bools) -> list[slice]:
    """Return the rows of ends of blocks (k,) that are clear one after the other."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], clear, [False]]).astype(np.int64)))
    return [slice(a, b + 1) for a, b in edges.reshape(-1, 2).tolist()]


def _gaps(end: float, done: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
    """Return the stretches between positions 0 and `end` that lie in none of those that are done."""
    found, here = [], 0.0
    for a, b in [*sorted(done), (end, end)]:
        if a > here + tolerance.COINCIDENT:
            found.append((here, a))
        here = max(here, b)
    return found


def _run(contacts: Contacts, start: float, end: float) -> float:
    """Return the length in mm of the contact line from a position to another."""
    length = contacts.travel(0.0)
    return float(np.diff(np.interp([start, end], np.arange(len(contacts)), length))[0])


def _remaining_findings(
    done: PointMilledPasses, drive: SurfaceDrive, tool: Tool
) -> tuple[Finding, ...]:
    corners = drive.skin.points[drive.skin.triangles[drive.skin.of(drive.faces)]]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = done.remaining * 0.5 * float(np.linalg.norm(across, axis=1).sum())
    if area < SMALLEST_LEFTOVER:
        return ()
    return (
        warning(
            "point.left",
            f"{area:.0f} mm2 of {drive.feature} stay: {tool.name} finds no way to lean there",
            drive.feature,
            remedy="choose a smaller or longer cutter, a slimmer holder, or let it lean further from the normal",
        ),
    )
