"""The operations on the walls of recesses in a casing's bottoms: walls that one direction is upright to together, and fillets at feet."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from trunnion.findings import Finding, face_tags, info, warning
from trunnion.geometry.plane.region import Region
from trunnion.model.feature import Feature
from trunnion.model.tool import Tool
from trunnion.plan.casing.boss_route import (
    ALL_ROUND,
    CONCAVE,
    LARGEST_SIDE,
    add_fillet,
    no_cutter,
    remaining_in_hollows,
)
from trunnion.plan.casing.bottom_route import grounds_in_order
from trunnion.plan.casing.bottoms import casing_faces
from trunnion.plan.casing.grounds import bottom_of
from trunnion.plan.casing.plan_state import CasingPlanState
from trunnion.plan.casing.recess.walls import LEANING, RecessWalls, WallGroup, recess_walls
from trunnion.plan.development.ground import SKIM, DevelopedGround
from trunnion.plan.freeform.finishing.chord import chord_choices
from trunnion.plan.freeform.keys import ALLOWANCE, OVERHANG, SCALLOP
from trunnion.plan.setups.frames import Direction
from trunnion.plan.tool_choice import depth_reached
from trunnion.recognize.casing.kinds import BOTTOM
from trunnion.settings import Value
from trunnion.shop import Stage
from trunnion.units import degrees, trimmed

RECESS_SIDE, RECESS_FILLET = "recess_side", "recess_fillet"
"""Words that a typical plan may give for the cutter of a stage on the walls of recesses."""
RIM = 0.1
"""mm: width of the strip along the walls of a recess by which a cutter's way round is measured."""
CORNER_SHARE = 0.25
"""Share of a wall's height that a cutter may leave in the acute corner at its foot, where a smaller one leaves less."""
LEVELS = 8
"""Levels over the height of a wall that leans in over the bottom: the lowest one that a cutter comes to leaves as much more of it."""


def plan_recess(state: CasingPlanState, stage: Stage, pocket: Feature) -> None:
    """Add what a stage does to the walls of a recess; a bottom that runs round has none."""
    if pocket.id not in state.hosts:
        return
    walls = _walls_of(state, pocket)
    for n, group in enumerate(walls.groups):
        name = f"{pocket.id}-{n}" if n else pocket.id
        direction = state.direction(state.recognition.frame.world_direction(group.direction))
        if stage.cutter == RECESS_SIDE and group.walls:
            _plan_walls(state, stage, pocket, name, group, direction)
        elif stage.cutter == RECESS_FILLET and group.fillets:
            tags = _tags(group.fillets)
            add_fillet(state, stage, pocket, name, tags, group.fillet, group.height, direction)
    if stage.cutter == RECESS_SIDE and walls.hidden:
        state.findings.append(_hidden(pocket, _tags(walls.hidden)))


def remaining_recesses(state: CasingPlanState) -> list[Finding]:
    """Return what no operation cuts of the recesses laid flat, where a typical plan has no stages for it."""
    cut = {t for o in state.operations for t in o.faces}
    roughed = {o.feature for o in state.operations if not o.faces}
    reported = {w for f in state.findings for w in f.where}
    found = list[Finding]()
    for pocket in grounds_in_order(state):
        if pocket.id not in state.hosts or pocket.id in reported:
            continue
        walls = _walls_of(state, pocket)
        wanted = {t for g in walls.groups for t in (*_tags(g.walls), *_tags(g.fillets))}
        left = tuple(sorted((wanted | set(pocket.with_role(BOTTOM))) - cut))
        if left or pocket.id not in roughed:
            found.append(
                warning(
                    "route.not-planned",
                    f"{pocket.id}: the typical plan has no stages that rough and finish all of it",
                    pocket.id,
                    *face_tags(left),
                    remedy="choose the program's own plan for casings, or add operations by hand",
                )
            )
    return found


def _walls_of(state: CasingPlanState, pocket: Feature) -> RecessWalls:
    bottom = bottom_of(state.recognition, state.part, pocket.id)
    return recess_walls(casing_faces(state.recognition, state.part.graph()), bottom)


def _tags(rows: Sequence[int]) -> tuple[int, ...]:
    return tuple(r + 1 for r in rows)


def _plan_walls(
    state: CasingPlanState,
    stage: Stage,
    pocket: Feature,
    name: str,
    group: WallGroup,
    direction: Direction,
) -> None:
    tags = _tags(group.walls)
    tool = _wall_cutter(state, state.grounds[pocket.id], group)
    if tool is None:
        state.findings.append(no_cutter(pocket, tags, "goes along the walls of the recess"))
        return
    if tool.radius > group.hollow:
        state.findings.append(remaining_in_hollows(pocket, tags, tool, group.hollow))
    if group.acute > LEANING:
        state.findings.append(_acute(pocket, tags, tool, group))
    height, wall = state.settings.scallop, state.route.wall_allowance
    choices: dict[str, Value] = {
        SCALLOP: height,
        ALLOWANCE: 0.0,
        OVERHANG: wall,
        **chord_choices(stage.strategy, height),
    }
    if group.acute > LEANING:
        choices[f"{stage.strategy}.step"] = group.height / LEVELS
    state.add(
        stage,
        name,
        pocket.id,
        tool,
        depth=max(group.height, 1.0),
        width=wall + group.acute * group.height,
        faces=tags,
        choices=choices,
        why=f"{tool.name}: goes along the walls of the recess, upright to them, beside what stands in it.",
        direction=direction,
    )


def _wall_cutter(state: CasingPlanState, ground: DevelopedGround, group: WallGroup) -> Tool | None:
    """Return the largest cutter that goes along all walls, between them and bosses and into their corners, its own corner no rounder than
    the fillet at their feet. Where the bottom leans from a level disc of the radius f by an angle a, f sin(a) at least stays at the feet of
    walls along the slope, and 2 f sin(a) of those that lean in over it: there it must be small."""
    deep = max(group.height, 1.0) + state.route.reach_clearance
    fits = [
        t
        for t in state.cutters("finish")
        if t.form in ("flat", "bull")
        and t.diameter <= LARGEST_SIDE
        and t.corner_radius <= group.fillet
        and depth_reached(t) >= deep
    ]
    smallest = min((t.radius for t in fits), default=0.0)
    fits = [t for t in fits if t.radius <= max(CONCAVE * group.hollow, smallest)]
    if group.tilt > LEANING:
        flattest = min((t.radius - t.corner_radius for t in fits), default=0.0)
        most = CORNER_SHARE * group.height / max(2.0 * group.acute, group.tilt)
        most = max(most, flattest)
        fits = [t for t in fits if t.radius - t.corner_radius <= most]
    fits.sort(key=lambda t: (-t.diameter, -t.corner_radius, depth_reached(t), t.name))
    opening = ground.milled().minus(ground.over(SKIM)).opened(RIM)
    # What stands in the recess apart from its walls is none of them.
    filled = opening.holes_filled() if opening else opening
    rim = filled.minus(filled.offset(-RIM)) if filled else filled
    best, widest = None, 0.0
    for tool in fits:
        share = _share_along(state, ground, rim, tool)
        if share >= ALL_ROUND:
            return tool
        if share > widest:
            best, widest = tool, share
    return best or (fits[-1] if fits else None)


def _share_along(state: CasingPlanState, ground: DevelopedGround, rim: Region, tool: Tool) -> float:
    """Return the share of the strip along the walls of a recess that a cutter comes to, its tip on the bottom."""
    state.progress.check()
    if not rim:
        return 0.0
    free = ground.free(0.0, tool, 0.0, state.route.reach_clearance).offset(-tool.radius)
    return free.offset(tool.radius + RIM).intersect(rim).area / rim.area if free else 0.0


def _acute(pocket: Feature, tags: tuple[int, ...], tool: Tool, group: WallGroup) -> Finding:
    left = 2.0 * (tool.radius - tool.corner_radius) * group.acute
    return info(
        "route.acute-corner",
        f"{pocket.id}: walls lean in over the bottom by up to {trimmed(degrees(float(np.arcsin(group.acute))), 1)} degrees; {tool.name} "
        f"leaves up to {trimmed(left, 2)} mm in the corner at their feet",
        pocket.id,
        *face_tags(tags),
        remedy="nothing: no round cutter goes into an acute corner; a smaller one leaves less",
    )


def _hidden(pocket: Feature, tags: tuple[int, ...]) -> Finding:
    return warning(
        "route.not-planned",
        f"{pocket.id}: walls hang over from every direction out of the recess",
        pocket.id,
        *face_tags(tags),
        remedy="mill them by operations added by hand",
    )
