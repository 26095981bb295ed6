"""Point milling: a cutter led along passes of contacts, its axis leaning to a field and out of the way of everything.

Contacts come from flow lines or passes of constant scallop, axes from `lean`; where the cutter is follows from its form. Blocks are as
long as the cutter, carried straight from tip to tip while its axis turns evenly, stays within the chord error of the faces, on either side.
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence

import numpy as np

from trunnion.findings import BadInput, Finding, Refused, info, warning
from trunnion.geometry.frame import Frame
from trunnion.model.motion.toolpath import Mark, Toolpath
from trunnion.model.operation import CuttingData
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.plan.clearance import ClearanceQuery
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
from trunnion.toolpath.contact_passes.axis_search import LeanLimits, free_axes
from trunnion.toolpath.contact_passes.contacts import Contacts
from trunnion.toolpath.contact_passes.flow_lines import DenseFlowLines, FlowParameters, flow_lines
from trunnion.toolpath.contact_passes.leaning_passes import (
    PointMilledPasses,
    grooving,
    milled,
    rest_of,
)
from trunnion.toolpath.contact_passes.linking.link_passes import linked
from trunnion.toolpath.contact_passes.linking.parameters import LinkParameters
from trunnion.toolpath.contact_passes.stepover.fronts import scallop_passes
from trunnion.toolpath.contact_passes.stock_clearance import (
    LEAST_STOCK,
    STOCK_SHARE,
    StockClearance,
)
from trunnion.toolpath.contract import Planned, leaning_axis, strategy
from trunnion.toolpath.motion.load.engagement import surface_leftovers
from trunnion.toolpath.stock.heightfield import PlanningStock
from trunnion.units import trimmed

SMALLEST_LEFTOVER = 0.5
"""mm2: less than this is the rim of an area."""
SAMPLED = 2_000
"""Contacts of what is left that say how much of it an axis would come to if nothing stood there."""


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
        0.002,
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


@strategy(
    settings=PointSettings,
    drive=SurfaceDrive,
    tool_axis=leaning_axis,
    meets=surface_leftovers,
    own_faces=True,
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
    around = StockClearance(drive, tool, thickness)
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
    blocked = 0.0
    if around.has_stock and done.rest:
        some = _some_of(done.rest, SAMPLED)
        bare = free_axes(some, field, tool, query, limits, drive.allowance)
        blocked = float(np.concatenate([axes.free for axes in bare]).mean())
    findings = _remaining_findings(done, drive, tool, blocked)
    if not done.passes:
        return Planned(findings=(*pattern_findings, *findings))
    parameters = LinkParameters(
        stepover=stepover,
        safety=settings.safety,
        lead_radius=settings.lead_radius,
        order="shorter",
        turn=limits.turn,
        query=query,
        link_clearance=around,
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
    """Return the path through all passes; what touches something between them is a finding."""
    path = linked(done.passes, drive, tool, data, stock, setup, parameters, progress)
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


def _some_of(lines: Sequence[Contacts], most: int) -> list[Contacts]:
    """Return lines evenly taken from all, with no more contacts than wanted and one line's more."""
    each = max(1, math.ceil(sum(len(line) for line in lines) / most))
    return list(lines[::each])


def _remaining_findings(
    done: PointMilledPasses, drive: SurfaceDrive, tool: Tool, blocked: float
) -> tuple[Finding, ...]:
    """Return what is left, of which a share is `blocked` by stock."""
    corners = drive.skin.points[drive.skin.triangles[drive.skin.of(drive.faces)]]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = done.remaining * 0.5 * float(np.linalg.norm(across, axis=1).sum())
    found = []
    if area * blocked >= SMALLEST_LEFTOVER:
        found.append(
            warning(
                "point.in-stock",
                f"about {area * blocked:.0f} mm2 of {drive.feature} stay: stock that no roughing took is in the way of every axis of "
                f"{tool.name} there",
                drive.feature,
                remedy="rough it from another direction, or as the channel between such faces by the strategies of a family that knows it",
            )
        )
    if area * (1.0 - blocked) >= SMALLEST_LEFTOVER:
        found.append(
            warning(
                "point.left",
                f"{area * (1.0 - blocked):.0f} mm2 of {drive.feature} stay: {tool.name} finds no way to lean there",
                drive.feature,
                remedy="choose a smaller or longer cutter, a slimmer holder, or let it lean further from the normal",
            )
        )
    return tuple(found)
