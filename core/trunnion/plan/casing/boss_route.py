"""The operations on the bosses of a casing, each along its own normal: the top, the sides round its outline, the root fillet."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from trunnion import tolerance
from trunnion.findings import Finding, error, face_tags, warning
from trunnion.geometry.arrays import Floats
from trunnion.geometry.plane.region import Region
from trunnion.model.feature import Feature
from trunnion.model.tool import Tool
from trunnion.plan.casing.bottom_route import BESIDE
from trunnion.plan.casing.plan_state import CasingPlanState
from trunnion.plan.development.ground import SKIM, DevelopedGround
from trunnion.plan.freeform.estimate.scallop import stepover_on_plane
from trunnion.plan.freeform.finishing.chord import chord_choices
from trunnion.plan.freeform.keys import ALLOWANCE, OVERHANG, SCALLOP
from trunnion.plan.freeform.lands import (
    ABOVE_TOOL,
    AROUND_TOOL,
    LATERAL,
    STOCK,
    Land,
    LandClearances,
    PartAbove,
    lands_of,
)
from trunnion.plan.freeform.space import SurfaceSpace
from trunnion.plan.setups.frames import Direction
from trunnion.plan.tool_choice import depth_reached
from trunnion.recognize.casing.kinds import ROOT_FILLET, SIDE, TOP
from trunnion.settings import Value
from trunnion.shop import Stage
from trunnion.units import trimmed

TOP_CUTTER, SIDE_CUTTER, FILLET = "top", "side", "fillet"
"""Words that a typical plan may give for the cutter of a stage on bosses."""
WIDTH = 0.6
"""Distance of passes on a top over the width of an end mill's flat."""
DEEPEST = 1.0
"""mm: the thickest stock that comes off a top at once; more comes off in even steps."""
MARGIN = 0.2
"""mm that a top's stock is taken for thicker than it is worked out to be."""
SPARE = 1.0
"""mm of space on all sides that a top's end mill has between what stands around the top."""
WHOLE = 0.999
"""Share of a top that its end mill must cover."""
LARGEST_SIDE = 12.0
"""mm: larger cutters are no better at sides that are a dozen mm high."""
WAY = 0.05
"""mm that the way round a boss on which a cutter is tried is off its outline, and wide."""
ALL_ROUND = 0.98
"""Share of the way round a boss from which on a cutter goes all round it."""
CONCAVE = 0.9
"""Largest radius of a cutter over that of a hollow in a boss's outline."""


def plan_boss(state: CasingPlanState, stage: Stage, boss: Feature) -> None:
    """Add what a stage does to a boss; a boss that stands on no bottom laid flat is told of once, by the first stage."""
    ground = state.grounds.get(str(boss.attributes.get("on", "")))
    tops = boss.with_role(TOP)
    if ground is None or not tops:
        if stage.cutter == TOP_CUTTER:
            state.findings.append(_not_planned(boss))
        return
    if stage.cutter == TOP_CUTTER:
        _plan_top(state, stage, boss, ground)
    elif stage.cutter == SIDE_CUTTER:
        _plan_sides(state, stage, boss, ground)
    else:
        _plan_fillet(state, stage, boss)


def out_of(state: CasingPlanState, boss: Feature) -> Direction:
    """Return the direction of a boss's top in the setup's frame."""
    return state.direction(state.part.graph().normal[boss.with_role(TOP)[0] - 1])


def space_along(state: CasingPlanState, direction: Direction) -> SurfaceSpace:
    """Return the part as a tool from a direction in the setup's frame sees it."""
    skin = state.context.skin(tolerance.CHORD, state.progress)
    return SurfaceSpace.of(state.part, skin, state.blank, state.setup, direction)


def _plan_top(state: CasingPlanState, stage: Stage, boss: Feature, ground: DevelopedGround) -> None:
    direction = out_of(state, boss)
    tags = boss.with_role(TOP)
    space = space_along(state, direction)
    part_above = PartAbove(space, state.progress)
    lands = lands_of(space, tags)
    tool, clearances = _top_cutter(state, part_above, lands)
    if tool is None or not lands:
        state.findings.append(no_cutter(boss, tags, "covers its top beside what stands around it"))
        return
    stock = _over_top(state, boss, ground) + state.route.floor_allowance + MARGIN
    depth = stock / math.ceil(stock / DEEPEST)
    width = WIDTH * (tool.diameter - 2.0 * tool.corner_radius)
    state.add(
        stage,
        boss.id,
        boss.id,
        tool,
        depth=depth,
        width=width,
        faces=tags,
        choices={
            STOCK: stock,
            LATERAL: clearances.lateral,
            AROUND_TOOL: clearances.around,
            ABOVE_TOOL: clearances.above,
            "plane.floor.wall_distance": 0.0,
        },
        why=f"{tool.name}: up to {trimmed(stock, 2)} mm stand on the top, taken in steps of {trimmed(depth, 2)} mm.",
        direction=direction,
    )


def _top_cutter(
    state: CasingPlanState, part_above: PartAbove, lands: Sequence[Land]
) -> tuple[Tool | None, LandClearances]:
    """Return the largest end mill that covers a boss's top, and what it keeps; None where none does.

    It stays off what stands beside, or goes right up to it where the top does: a rib that the boss runs into is turned, and done.
    """
    kept = state.route.wall_allowance + BESIDE
    for lateral in (kept, 0.0):
        clearances = LandClearances(lateral=lateral, around=kept, above=state.route.reach_clearance)
        for tool in _end_mills(state):
            if all(_covers(land, part_above, tool, clearances) for land in lands):
                return tool, clearances
    return None, clearances


def _covers(land: Land, part_above: PartAbove, tool: Tool, clearances: LandClearances) -> bool:
    """Return whether an end mill covers a land from positions that leave it some space to move."""
    # Its axis goes over the land's rim by less than its radius and some space, and is kept off by what is as far beside that.
    near = land.region.offset(2.0 * (tool.radius + SPARE))
    axis_region = part_above.free(land.z, tool, clearances, near).offset(-tool.radius - SPARE)
    if not axis_region:
        return False
    flat = tool.radius - tool.corner_radius
    done = axis_region.offset(SPARE).offset(flat).intersect(land.region)
    return done.area >= WHOLE * land.region.area


def _over_top(state: CasingPlanState, boss: Feature, ground: DevelopedGround) -> float:
    """Return how much lower the middle of a top is than its rim, over the ground: layers over it follow the ground."""
    tags = boss.with_role(TOP)
    corners = state.mesh.points[state.mesh.triangles[np.isin(state.mesh.face, tags)]]
    rim = ground.development.to_local(corners.reshape(-1, 3))[:, 2]
    normal = state.part.graph().normal[tags[0] - 1]
    # The plane is nearest to the axis where the axis's own normal meets it, in the top or not.
    frame = ground.development.frame
    local, n = frame.to_local(corners.reshape(-1, 3)), frame.local_direction(normal)
    across = float(np.hypot(n[0], n[1]))
    middle = local.mean(axis=0)
    foot = (local @ n).mean() - n[2] * middle[2]
    least = float(foot / max(across, tolerance.COINCIDENT))
    turn = math.atan2(float(n[1]), float(n[0]))
    nearest = np.array([least * math.cos(turn), least * math.sin(turn), float(middle[2])])
    low = float(ground.development.to_local(frame.to_world(nearest))[2])
    return max(float(rim.max()) - min(low, float(rim.min())), 0.0)


def _end_mills(state: CasingPlanState) -> list[Tool]:
    tools = [
        t for t in state.cutters("finish") if t.form == "flat" and t.diameter <= state.route.largest
    ]
    tools.sort(key=lambda t: (-t.diameter, depth_reached(t), t.name))
    return tools


def _plan_sides(
    state: CasingPlanState, stage: Stage, boss: Feature, ground: DevelopedGround
) -> None:
    tags = boss.with_role(SIDE)
    if not tags:
        return
    fillet = _size(boss, "root_fillet")
    tool = _side_cutter(state, boss, ground, fillet)
    if tool is None:
        state.findings.append(no_cutter(boss, tags, "goes round its outline"))
        return
    hollow = _size(boss, "concave_radius") or math.inf
    if tool.radius > hollow:
        state.findings.append(remaining_in_hollows(boss, tags, tool, hollow))
    height = state.settings.scallop
    choices: dict[str, Value] = {
        SCALLOP: height,
        ALLOWANCE: 0.0,
        OVERHANG: state.route.wall_allowance,
        **chord_choices(stage.strategy, height),
    }
    state.add(
        stage,
        boss.id,
        boss.id,
        tool,
        depth=max(_size(boss, "height"), 1.0),
        width=state.route.wall_allowance,
        faces=tags,
        choices=choices,
        why=f"{tool.name}: goes between the boss and what stands around it.",
        direction=out_of(state, boss),
    )


def _side_cutter(
    state: CasingPlanState, boss: Feature, ground: DevelopedGround, fillet: float
) -> Tool | None:
    """Return the largest cutter that goes all round a boss beside its neighbours; its corner is no rounder than the root fillet. Where none
    is small enough for the hollows of its outline it is one of the smallest that go down: these leave least."""
    high = max(_size(boss, "height"), 1.0) + state.route.reach_clearance
    hollow = _size(boss, "concave_radius") or math.inf
    fits = [
        t
        for t in state.cutters("finish")
        if t.form in ("flat", "bull")
        and t.diameter <= LARGEST_SIDE
        and t.corner_radius <= fillet
        and depth_reached(t) >= high
    ]
    smallest = min((t.radius for t in fits), default=0.0)
    fits = [t for t in fits if t.radius <= max(CONCAVE * hollow, smallest)]
    fits.sort(key=lambda t: (-t.diameter, -t.corner_radius, depth_reached(t), t.name))
    over = ground.over(SKIM).split()
    at = ground.development.to_local(state.part.graph().centre[boss.with_role(TOP)[0] - 1])[:2]
    mine = min(over, key=lambda r: -float(r.signed_distance(at[None])[0]), default=None)
    if mine is None:
        return None
    lowest, highest = _box_of(state, boss, ground)
    best, most = None, 0.0
    for tool in fits:
        beside = tool.diameter
        near = Region.rectangle(*(lowest - beside).tolist(), *(highest + beside).tolist())
        share = _share_round(state, ground, mine, near, tool)
        if share >= ALL_ROUND:
            return tool
        if share > most + tolerance.COINCIDENT:
            best, most = tool, share
    return best or (fits[-1] if fits else None)


def _box_of(
    state: CasingPlanState, boss: Feature, ground: DevelopedGround
) -> tuple[Floats, Floats]:
    """Return the lowest and highest corner (2,) of a boss over the ground laid flat."""
    corners = state.mesh.points[state.mesh.triangles[np.isin(state.mesh.face, boss.tags)]]
    flat = ground.development.to_local(corners.reshape(-1, 3))[:, :2]
    return flat.min(axis=0), flat.max(axis=0)


def _share_round(
    state: CasingPlanState, ground: DevelopedGround, mine: Region, near: Region, tool: Tool
) -> float:
    """Return the share of the way round a boss, near it, that a cutter can go, its tip on the bottom, beside all that stands there: with
    its shank over the boss, and its holder beside flanges and neighbours."""
    state.progress.check()
    way = mine.offset(tool.radius + 2.0 * WAY).minus(mine.offset(tool.radius + WAY)).intersect(near)
    if not way:
        return 0.0
    within = way.offset(tool.radius + WAY)
    free = ground.free(0.0, tool, 0.0, state.route.reach_clearance, within)
    free_part = free.offset(-tool.radius).intersect(way)
    return free_part.area / way.area


def _plan_fillet(state: CasingPlanState, stage: Stage, boss: Feature) -> None:
    tags = boss.with_role(ROOT_FILLET)
    if not tags:
        return
    radius, high = _size(boss, "root_fillet"), max(_size(boss, "height"), 1.0)
    add_fillet(state, stage, boss, boss.id, tags, radius, high, out_of(state, boss))


def add_fillet(
    state: CasingPlanState,
    stage: Stage,
    feature: Feature,
    name: str,
    tags: tuple[int, ...],
    radius: float,
    high: float,
    direction: Direction,
) -> None:
    """Add the finishing of fillets of a radius (mm) at the feet of sides that are so high (mm), by a ball no larger than they are."""
    deep = high + state.route.reach_clearance
    balls = [
        t
        for t in state.cutters("surface")
        if t.form == "ball" and t.radius <= radius + tolerance.SLIVER and depth_reached(t) >= deep
    ]
    tool = max(balls, key=lambda t: (t.diameter, -depth_reached(t), t.name), default=None)
    if tool is None:
        state.findings.append(no_cutter(feature, tags, f"fits a fillet of {trimmed(radius, 2)} mm"))
        return
    height = state.settings.scallop
    state.add(
        stage,
        name,
        feature.id,
        tool,
        depth=state.route.wall_allowance + state.route.floor_allowance,
        width=stepover_on_plane(tool.radius, height),
        faces=tags,
        choices={
            SCALLOP: height,
            ALLOWANCE: 0.0,
            OVERHANG: state.route.wall_allowance,
            f"{stage.strategy}.steepest": 89.0,
            **chord_choices(stage.strategy, height),
        },
        why=f"{tool.name}: no rounder than the fillet of {trimmed(radius, 2)} mm.",
        direction=direction,
    )


def _size(boss: Feature, name: str) -> float:
    value = boss.sizes.get(name, 0.0)
    return float(value) if isinstance(value, (int, float)) else 0.0


def remaining_in_hollows(
    feature: Feature, tags: tuple[int, ...], tool: Tool, hollow: float
) -> Finding:
    """Return the finding that a cutter leaves something in hollows of an outline, of a radius in mm."""
    return warning(
        "route.no-cutter",
        f"{feature.id}: no cutter of the catalogue goes into hollows of R {trimmed(hollow, 2)} of its outline; {tool.name} leaves what "
        "is there",
        feature.id,
        *face_tags(tags),
        remedy="add a smaller or longer cutter to the tools folder",
    )


def _not_planned(boss: Feature) -> Finding:
    return warning(
        "route.not-planned",
        f"{boss.id}: it stands on no bottom that is milled all round from outside",
        boss.id,
        *face_tags(boss.tags),
        remedy="mill it by operations added by hand",
    )


def no_cutter(feature: Feature, tags: tuple[int, ...], what: str) -> Finding:
    """Return the finding that no cutter does what faces of a feature ask for."""
    return error(
        "route.no-cutter",
        f"{feature.id}: no cutter of the catalogue {what}",
        feature.id,
        *face_tags(tags),
        remedy="add a smaller or longer cutter to the tools folder",
    )
