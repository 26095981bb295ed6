"""The operations over the bottoms of a casing laid flat: layers of falling cutters, the bottom, and the feet of what stands on it."""

from __future__ import annotations

from collections.abc import Sequence

from trunnion.findings import Finding, Refused, error, face_tags, warning
from trunnion.geometry.plane.region import EMPTY_REGION, Region
from trunnion.model.feature import Feature
from trunnion.model.tool import Tool
from trunnion.plan.casing.grounds import bottom_of, ground_under
from trunnion.plan.casing.plan_state import CasingPlanState
from trunnion.plan.cutting.milling import roughing_depth, roughing_width
from trunnion.plan.development.drives import (
    FLOOR,
    HAIR,
    ROUGH,
    GroundCutter,
    remaining_on,
    ring_of,
    shank_clearance,
    tangent_reach,
)
from trunnion.plan.development.ground import DevelopedGround
from trunnion.plan.freeform.cutters.choice import named
from trunnion.plan.freeform.lands import ABOVE_TOOL, AROUND_TOOL, STOCK
from trunnion.plan.prismatic.drive import FLOOR_ALLOWANCE, WALL_ALLOWANCE
from trunnion.plan.tool_choice import depth_reached
from trunnion.recognize.casing.kinds import BOTTOM, POCKET
from trunnion.settings import Value
from trunnion.shop import Stage
from trunnion.units import trimmed

LAYERS, REST_LAYERS, BOTTOM_CUTTER, FOOT = "layers", "rest_layers", "bottom", "foot"
"""Words that a typical plan may give for the cutter of a stage on bottoms."""
BESIDE = 0.5
"""mm that shank and holder keep from the part, beside the cutter's own allowance."""
CORNER = 0.5
"""mm: the corner radius that roughing cutters last longest with and leave little at feet."""
SMALLEST = 4.0
"""mm: smaller end mills rough nothing."""
OPENED = 0.5
"""Of the square of a cutter's diameter: the least area of a gap or corner that is worth roughing with it."""
WORTH = 0.004
"""Share of a bottom that a small cutter must finish more to be worth its change."""
FALLING = 0.65
"""Largest diameter of the next smaller cutter over that of the one before."""
WIDTH = 0.6
"""Distance of passes over the width of an end mill's flat."""
FEET = 2.0
"""Radius of the cutter for feet over how far a level disc finishes bent ground, at most."""
LEAST = 0.02
"""mm: the depth that cutting data are found for where roughing leaves nothing."""


def plan_grounds(state: CasingPlanState) -> None:
    """Lay flat the bottoms of all pockets; tell of those that can't be."""
    pockets = [p for p in state.recognition.of_kind(POCKET) if p.with_role(BOTTOM)]
    for n, pocket in enumerate(pockets):
        progress = state.progress.part(n / len(pockets), (n + 1) / len(pockets))
        progress.at(0.0, f"laying flat {pocket.id}")
        try:
            bottom = bottom_of(state.recognition, state.part, pocket.id)
            ground = ground_under(
                bottom, state.recognition, state.part, state.mesh, state.blank, progress
            )
        except Refused as reason:
            state.findings.append(_not_planned(pocket, str(reason)))
            continue
        if ring_of(ground):
            state.grounds[pocket.id] = ground.watched(state.progress)
            if bottom.is_recess:
                state.hosts[pocket.id] = bottom.recess_of


def plan_layers(state: CasingPlanState, stage: Stage, pocket: Feature) -> None:
    """Add the first roughing of a bottom, or all the smaller cutters after it. A recess is roughed with the smaller ones: only then is all
    clear that stands over it."""
    ground = state.grounds[pocket.id]
    ring = ring_of(ground).minus(ground.over(state.route.floor_allowance))
    recess = pocket.id in state.hosts
    if recess != (stage.cutter == LAYERS):
        wanted = "" if recess else state.settings.rough_cutter
        tool = named(state.shop, wanted) if wanted else _rougher(state, pocket, ground, ring)
        if tool is None:
            state.findings.append(_no_cutter(pocket, stage, ground))
            return
        _add_layers(state, stage, pocket, ground, tool, "")
    if stage.cutter == LAYERS:
        return
    before = [o.cutter for o in state.operations if o.feature == pocket.id and o.kind == ROUGH]
    if not before:
        return
    last, reached = before[-1], _roughed(state, pocket, ground, before[-1], ring)
    n = 1
    for tool in _rough_candidates(state, ground):
        if tool.diameter > FALLING * last.diameter or tool.diameter < SMALLEST:
            continue
        tip = ground.free_for_tip(state.route.floor_allowance)
        if not _opens(_cleared(state, tip, tool, ring), reached, tool):
            # Then it opens no gap with its shank and holder in the way either.
            continue
        more = _roughed(state, pocket, ground, tool, ring)
        if not _opens(more, reached, tool):
            continue
        _add_layers(state, stage, pocket, ground, tool, f"-{n}")
        last, reached, n = tool, more, n + 1


def plan_floor(state: CasingPlanState, stage: Stage, pocket: Feature) -> None:
    """Add the finishing of a bottom, or of what its cutter leaves at feet."""
    ground = state.grounds[pocket.id]
    ring = ring_of(ground).minus(ground.over(LEAST)).minus(state.gaps.get(pocket.id, EMPTY_REGION))
    before = [
        GroundCutter.of(o) for o in state.operations if o.feature == pocket.id and o.kind == FLOOR
    ]
    reach = tangent_reach(ground)
    if stage.cutter == BOTTOM_CUTTER:
        wanted = state.settings.finish_cutter
        tool = named(state.shop, wanted) if wanted else _finisher(state, pocket, ground, ring)
    else:
        if not before or before[-1].tool.radius <= reach:
            return
        tool = _foot_cutter(state, ground, reach)
        left = remaining_on(ground, ring, before)
        if not left or left.area < WORTH * ring.area:
            return
    if tool is None:
        state.findings.append(_no_cutter(pocket, stage, ground))
        return
    stock = state.route.floor_allowance
    width = min(WIDTH * (tool.diameter - 2.0 * tool.corner_radius), 2.0 * reach)
    state.add(
        stage,
        pocket.id,
        pocket.id,
        tool,
        depth=stock,
        width=width,
        faces=pocket.with_role(BOTTOM),
        choices={
            STOCK: stock,
            AROUND_TOOL: cutter_clearance(state, ground, tool, pocket, 0.0),
            ABOVE_TOOL: state.route.reach_clearance,
            "plane.floor.wall_distance": 0.0,
        },
        why=f"{tool.name}: {trimmed(width, 2)} mm between passes on a radius of {trimmed(ground.least_radius, 1)} mm.",
    )


def _add_layers(
    state: CasingPlanState,
    stage: Stage,
    pocket: Feature,
    ground: DevelopedGround,
    tool: Tool,
    name: str,
) -> None:
    bears = roughing_depth(tool, state.material, state.cutting)
    depth = min(bears, state.settings.layer) if state.settings.layer > 0.0 else bears
    wall, floor = state.route.wall_allowance, state.route.floor_allowance
    choices: dict[str, Value] = {
        WALL_ALLOWANCE: wall,
        FLOOR_ALLOWANCE: floor,
        AROUND_TOOL: cutter_clearance(state, ground, tool, pocket, wall),
        ABOVE_TOOL: state.route.reach_clearance,
    }
    state.add(
        stage,
        f"{pocket.id}{name}",
        pocket.id,
        tool,
        depth=depth,
        width=roughing_width(tool, state.material, state.cutting),
        choices=choices,
        why=f"{tool.name}: {trimmed(ground.top, 2)} mm stand over the bottom, layers of {trimmed(depth, 2)} mm at most; "
        f"{trimmed(wall, 2)} mm are left on sides, {trimmed(floor, 2)} mm on the bottom.",
    )


def _rough_candidates(state: CasingPlanState, ground: DevelopedGround) -> list[Tool]:
    """Return end mills that rough down to the bottom, the largest and shortest first."""
    fits = _deep_enough(
        state,
        ground,
        [
            t
            for t in state.cutters("rough")
            if t.form in ("flat", "bull") and t.diameter <= state.route.largest
        ],
    )
    fits.sort(key=lambda t: (-t.diameter, depth_reached(t), abs(t.corner_radius - CORNER), t.name))
    return _one_a_size(fits)


def _deep_enough(
    state: CasingPlanState, ground: DevelopedGround, tools: Sequence[Tool]
) -> list[Tool]:
    """Return the tools that reach down to ground from the top of the blank, or, of a size that none does, only from the ceiling over it:
    what stands higher is cut before, and is beside the recess if anywhere."""
    found = list[Tool]()
    for height in sorted({max(ground.ring_top, ground.top), ground.top}, reverse=True):
        deep, sizes = height + state.route.reach_clearance, {t.diameter for t in found}
        found += [t for t in tools if t.diameter not in sizes and depth_reached(t) >= deep]
    return found


def _one_a_size(tools: Sequence[Tool]) -> list[Tool]:
    """Return the first of the tools of each diameter."""
    found: dict[float, Tool] = {}
    for tool in tools:
        found.setdefault(tool.diameter, tool)
    return list(found.values())


def _rougher(
    state: CasingPlanState, pocket: Feature, ground: DevelopedGround, ring: Region
) -> Tool | None:
    tools = _rough_candidates(state, ground)
    for tool in tools:
        if _roughed(state, pocket, ground, tool, ring).area >= state.settings.share * ring.area:
            return tool
    return tools[-1] if tools else None


def _roughed(
    state: CasingPlanState, pocket: Feature, ground: DevelopedGround, tool: Tool, ring: Region
) -> Region:
    """Return what of a ring a roughing cutter clears."""
    wall = state.route.wall_allowance
    around = cutter_clearance(state, ground, tool, pocket, wall)
    free = ground.free(state.route.floor_allowance, tool, around, state.route.reach_clearance)
    return _cleared(state, free, tool, ring)


def _cleared(state: CasingPlanState, free: Region, tool: Tool, ring: Region) -> Region:
    """Return what of a ring a roughing cutter clears that stays in a free area."""
    kept = tool.radius + state.route.wall_allowance
    axis_region = free.offset(-kept)
    return axis_region.offset(kept).intersect(ring) if axis_region else axis_region


def _opens(more: Region, reached: Region, tool: Tool) -> bool:
    """Return whether what a cutter clears has a gap or corner, not reached before, that is worth roughing with it."""
    opened = more.minus(reached).opened(HAIR).split()
    return max((piece.area for piece in opened), default=0.0) >= OPENED * tool.diameter**2


def cutter_clearance(
    state: CasingPlanState, ground: DevelopedGround, tool: Tool, pocket: Feature, own: float
) -> float:
    """Return what (mm) shank and holder of a cutter with an allowance of its `own` keep from the part."""
    over = {pocket.id, *state.hosts_of(pocket.id)}
    before = [o.cutter for o in state.operations if o.feature in over and o.kind == ROUGH]
    return max(own + BESIDE, shank_clearance(ground, tool, before, state.route.wall_allowance))


def _finisher(
    state: CasingPlanState, pocket: Feature, ground: DevelopedGround, ring: Region
) -> Tool | None:
    flat = [
        t for t in state.cutters("finish") if t.form == "flat" and t.diameter <= state.route.largest
    ]
    fits = _deep_enough(state, ground, flat)
    tools = _one_a_size(sorted(fits, key=lambda t: (-t.diameter, depth_reached(t), t.name)))
    for tool in tools:
        around = cutter_clearance(state, ground, tool, pocket, 0.0)
        free = ground.free(0.0, tool, around, state.route.reach_clearance)
        axis_region = free.offset(-tool.radius)
        if axis_region:
            done = axis_region.offset(tool.radius).intersect(ring)
            if done.area >= state.settings.share * ring.area:
                return tool
    return tools[-1] if tools else None


def _foot_cutter(state: CasingPlanState, ground: DevelopedGround, reach: float) -> Tool | None:
    """Return the largest end mill whose disc finishes bent ground nearly to its rim."""
    fits = _deep_enough(state, ground, [t for t in state.cutters("finish") if t.form == "flat"])
    small = [t for t in fits if t.radius <= FEET * reach]
    pool = small or sorted(fits, key=lambda t: t.diameter)[:1]
    return max(pool, key=lambda t: (t.diameter, -depth_reached(t), t.name), default=None)


def _not_planned(pocket: Feature, reason: str) -> Finding:
    return warning(
        "route.not-planned",
        reason,
        pocket.id,
        *face_tags(pocket.tags),
        remedy="mill it by operations added by hand",
    )


def _no_cutter(pocket: Feature, stage: Stage, ground: DevelopedGround) -> Finding:
    return error(
        "route.no-cutter",
        f"{stage.name} of {pocket.id}: no end mill reaches {trimmed(ground.top, 1)} mm down between what stands there",
        pocket.id,
        remedy="add a longer or smaller cutter to the tools folder",
    )


def grounds_in_order(state: CasingPlanState) -> Sequence[Feature]:
    """Return the pockets whose bottoms are laid flat, recesses after what they are sunk into."""
    found = [p for p in state.recognition.of_kind(POCKET) if p.id in state.grounds]
    return sorted(found, key=lambda p: len(state.hosts_of(p.id)))
