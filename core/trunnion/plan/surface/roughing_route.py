"""Roughing of a part of curved surfaces by layers: from one direction with cutters of falling sizes, the first the largest that reaches."""

from __future__ import annotations

from trunnion.findings import error
from trunnion.model.tool import Tool
from trunnion.plan.cutting.milling import CuttingSettings, roughing_depth, roughing_width
from trunnion.plan.freeform.cutters.choice import named
from trunnion.plan.freeform.keys import ALLOWANCE, BOTTOM, CELL, LAYER
from trunnion.plan.freeform.lands import LAND, REST_LAND
from trunnion.plan.freeform.reach import samples_on
from trunnion.plan.freeform.roughing.hollows import hollow_depths
from trunnion.plan.freeform.roughing.layers import remaining_on_walls
from trunnion.plan.freeform.space import SurfaceSpace
from trunnion.plan.surface.plan_state import RoughingSide, SurfacePlanState
from trunnion.plan.surface.settings import SurfaceRouteSettings
from trunnion.plan.tool_choice import depth_reached
from trunnion.progress import Progress
from trunnion.settings import Value, choose
from trunnion.units import trimmed

ROUGH_SHARE = 0.4
"""Largest roughing cutter over the blank's smaller side seen along the tool: it has to turn inside."""
REST_SHARE = 0.65
"""Largest cutter of rest roughing over the one before it."""
NEAR_FINISH = 1.6
"""Largest cutter of the last roughing over the smallest finishing cutter."""
LEAST_REST = 4.0
"""mm: rest roughing with a smaller cutter than this costs more than it spares the finishing."""
ON_SKIN = ("semi", "finish", "rest_finish")
"""Kinds of operations on curved faces."""
FULL = 2.0
"""Times what layers leave over a slope: as deep as passes on a skin meet material in an inner edge, where both faces have left theirs."""
OPENED = 0.5
"""Of the square of a cutter's diameter: area of hollows that are worth roughing with it."""


def plan_roughing(
    state: SurfacePlanState, space: SurfaceSpace, bottom: float, name: str, progress: Progress
) -> None:
    """Plan roughing by layers with a large cutter from a direction, and with falling sizes what those before left: down to about the size
    of the smallest finishing cutter, so that this one finds little, and on into hollows that are too narrow for that size."""
    deep, most = float(space.high[2]) - bottom, _largest_rougher(state, space)
    tool = _rougher(state, most, deep, state.settings.rough_cutter)
    if tool is None:
        state.findings.append(
            error(
                "route.no-cutter",
                f"no roughing cutter up to D {trimmed(most, 1)} reaches {trimmed(deep, 1)} mm deep",
                state.recognition.features[0].id,
                remedy="add a longer cutter to the tools folder",
            )
        )
        return
    _add_rough(state, "rough", name, tool, space, bottom)
    smallest = min(
        (o.cutter.diameter for o in state.operations if o.kind in ("finish", LAND, REST_LAND)),
        default=tool.diameter,
    )
    n = 1
    while True:
        rest = _rougher(state, REST_SHARE * tool.diameter, deep, "")
        if rest is None or rest.diameter < LEAST_REST:
            break
        if tool.diameter > NEAR_FINISH * smallest:
            _add_rough(state, "rest", f"{name}-{n}", rest, space, bottom)
        else:
            opened = _hollows(state, space, tool, progress) - _hollows(state, space, rest, progress)
            if opened < OPENED * rest.diameter**2:
                break
            why = (
                f"It opens hollows of {trimmed(opened, 0)} mm2 that {tool.name} doesn't come into."
            )
            _add_rough(state, "rest", f"{name}-{n}", rest, space, bottom, why)
        tool, n = rest, n + 1
    state.roughing_sides.append(RoughingSide(space=space, bottom=bottom, tool=tool))


def _hollows(state: SurfacePlanState, space: SurfaceSpace, tool: Tool, progress: Progress) -> float:
    """Return the area in mm2 of curved faces that roughing with a cutter leaves more material over than their cutters are meant for: it
    is too wide for what they lie in."""
    settings = state.settings
    tags = {t for o in state.operations if o.kind in ON_SKIN for t in o.faces}
    samples = samples_on(space.skin, tuple(sorted(tags)))
    samples = samples.of(samples.normal[:, 2] > 0.0)
    radius = tool.radius + remaining_on_walls(space, settings.rough_allowance, settings.cell)
    depths = hollow_depths(space, samples.point, radius, progress)
    return samples.area * float((depths > FULL * remaining_after_layers(space, settings)).sum())


def remaining_after_layers(space: SurfaceSpace, settings: SurfaceRouteSettings) -> float:
    """Return how thick, in mm and in the mean, roughing by layers leaves material on a slope: what it leaves on walls, and its steps."""
    return remaining_on_walls(space, settings.rough_allowance, settings.cell) + 0.5 * settings.layer


def _rougher(state: SurfacePlanState, most: float, deep: float, name: str) -> Tool | None:
    """Return the largest roughing cutter up to a diameter that reaches a depth, with the corner that leaves least of a slope."""
    if name:
        return named(state.shop, name)
    fits = [
        t for t in _roughers(state, most) if depth_reached(t) >= deep + state.route.reach_clearance
    ]
    return max(
        fits,
        key=lambda t: (
            t.diameter,
            -depth_reached(t),
            -abs(t.corner_radius - 0.1 * t.diameter),
            t.name,
        ),
        default=None,
    )


def _roughers(state: SurfacePlanState, most: float) -> list[Tool]:
    return [t for t in state.cutters("rough") if t.form in ("flat", "bull") and t.diameter <= most]


def _largest_rougher(state: SurfacePlanState, space: SurfaceSpace) -> float:
    """Return the largest diameter in mm of a roughing cutter from a direction."""
    size = float((space.high - space.low)[:2].min())
    return min(state.route.largest, ROUGH_SHARE * size)


def roughing_reach(state: SurfacePlanState, space: SurfaceSpace) -> float:
    """Return how deep in mm under the blank's top roughing comes from a direction."""
    deepest = max(
        (depth_reached(t) for t in _roughers(state, _largest_rougher(state, space))), default=0.0
    )
    return deepest - state.route.reach_clearance


def _add_rough(
    state: SurfacePlanState,
    kind: str,
    name: str,
    tool: Tool,
    space: SurfaceSpace,
    bottom: float,
    *why: str,
) -> None:
    stage, settings, cutting = state.stages[kind], state.settings, choose(CuttingSettings, {})
    depth = roughing_depth(tool, state.material, cutting)
    layer = min(settings.layer, depth)
    width = roughing_width(tool, state.material, cutting)
    rules = (
        stage.rule,
        f"{tool.name}: reaches {trimmed(depth_reached(tool), 1)} mm deep.",
        *why,
        f"It leaves {trimmed(settings.rough_allowance, 2)} mm all round, in layers of up to {trimmed(depth, 2)} mm and "
        f"steps of {trimmed(layer, 2)} mm up the slopes.",
    )
    choices: dict[str, Value] = {
        ALLOWANCE: settings.rough_allowance,
        BOTTOM: bottom,
        CELL: settings.cell,
        LAYER: layer,
    }
    state.add(
        kind,
        name,
        state.first_feature(),
        tool,
        (),
        depth,
        width,
        choices,
        rules,
        operation_kind="rough",
        direction=space.direction,
    )
