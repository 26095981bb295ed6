"""Finishing of areas of curved faces: each by the largest cutter that reaches nearly all of it, with a larger one before it where that is
quicker; what these leave by a smaller or a leaning one."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from trunnion import registry
from trunnion.findings import face_tags, warning
from trunnion.model.tool import Tool
from trunnion.plan.cutting.milling import CuttingSettings, cutting_data
from trunnion.plan.freeform.cutters.choice import (
    NEGLIGIBLE,
    AreaCutters,
    CutterStep,
    cutter_for,
    named,
    steps_of,
    with_larger_first,
)
from trunnion.plan.freeform.estimate.scallop import stepover_on_plane
from trunnion.plan.freeform.finishing.areas import Area
from trunnion.plan.freeform.finishing.chord import chord_choices, laid_height
from trunnion.plan.freeform.keys import ALLOWANCE, EARLIER, EXTENSION, SCALLOP, UPRIGHT_EARLIER
from trunnion.plan.freeform.reach import AreaSamples, leans, reached, samples_on
from trunnion.plan.freeform.tilted_reach import SAMPLES as LEANING_SAMPLES
from trunnion.plan.freeform.tilted_reach import leaning_cutter
from trunnion.plan.surface.land_route import FinishedLands
from trunnion.plan.surface.order import FIRST
from trunnion.plan.surface.plan_state import SurfacePlanState
from trunnion.plan.surface.roughing_route import remaining_after_layers
from trunnion.plan.tool_choice import depth_reached
from trunnion.progress import Progress
from trunnion.settings import Value, choose
from trunnion.units import SECONDS_PER_MINUTE, trimmed

LARGEST_LEANING = 16.0
"""mm: larger balls have no space to lean on parts that need it."""
FOR_LOCAL = ("surface.constant", "surface.parallel")
FOR_SHALLOW = ("surface.parallel", "surface.constant")
"""Strategies for local features and for shallow faces, the best first."""
STEEP = "surface.waterline"
"""The strategy for steep faces."""
LEANING_STRATEGY = "surface.point"
"""The strategy for a cutter that leans."""
LEANING = "-leaning"
"""Ends the name of an operation on what the upright cutters of an area can't come to."""
REST_LEAD = 0.3
"""mm: radius of leads in rest finishing: what is left lies beside faces that stand up."""
SOME = 0.02
"""Share of a face that is worth another strategy."""
SLOPE_LIMITS = {
    "surface.waterline": ("surface.waterline.shallowest", -5.0),
    "surface.constant": ("surface.constant.steepest", 5.0),
    "surface.parallel": ("surface.parallel.steepest", 5.0),
}
"""Where strategies for shallow and steep positions meet: the setting that says it, and by how many degrees each goes on past the limit."""


def plan_area(
    state: SurfacePlanState, area: Area, level: FinishedLands, progress: Progress
) -> None:
    """Plan semi-finishing and finishing of an area with its own cutter, a larger one before it where both together are quicker, and of
    what that cutter leaves with a smaller one.

    The feet of sides that end mills finish with lands are no matter of its cutter.
    """
    settings = state.settings
    samples = samples_on(state.space.skin, area.tags)
    state.unsampled.update(set(area.tags) - set(samples.face.tolist()))
    samples = level.without_feet(samples)
    area = replace(area, tags=tuple(t for t in area.tags if (samples.face == t).any()))
    wanted = settings.local_cutter if area.local else settings.cutter
    found = cutter_for(
        state.space,
        samples,
        finishers(state),
        settings.share,
        state.route.reach_clearance,
        named(state.shop, wanted) if wanted else None,
        progress,
        below=state.setup.clearance,
    )
    _report_unreached(state, area, samples, found)
    if found.tool is None:
        return
    done: set[int] = set()
    for n, step in enumerate(_steps(state, samples, found, wanted=bool(wanted))):
        tags = tuple(t for t in area.tags if step.rows[samples.face == t].any())
        if step.earlier is None:
            mine = samples if step.tool is found.tool else samples.of(step.rows)
            _add_first(state, area, tags, step.tool, mine)
        else:
            # Of corners only faces that no cutter before ever touches are still as roughing left them.
            raw = tags if step.tool is found.tool else tuple(t for t in tags if t not in done)
            _add_rest(state, area, tags, raw, step, samples.of(step.rows), n)
        done |= set(tags)
    _leaning_rest(state, area, samples, found, progress)


def _steps(
    state: SurfacePlanState, samples: AreaSamples, found: AreaCutters, *, wanted: bool
) -> tuple[CutterStep, ...]:
    """Return the cutters of an area in the order they cut: a larger one before its own where both together are quicker, unless that one
    is wanted by name, or faces hang over: under these stands what roughing left, and a thick cutter meets it with its neck or shank."""
    if wanted or state.has_overhangs:
        return steps_of(found)
    change = state.machine.tool_change_s / SECONDS_PER_MINUTE
    return with_larger_first(
        found, finishers(state), samples.area, partial(_area_rate, state), change
    )


def _area_rate(state: SurfacePlanState, tool: Tool) -> float:
    """Return what a ball semi-finishes and finishes in mm2/min: the distance of its passes on a plane times its feed."""
    settings = state.settings
    heights = {"finish": settings.height()}
    if settings.semi_allowance > 0.0:
        heights["semi"] = settings.semi_scallop
    minutes = 0.0
    for kind, height in heights.items():
        width = stepover_on_plane(tool.corner_radius, height)
        cutting = choose(CuttingSettings, {})
        data = cutting_data(tool, state.material, state.machine, kind, cutting, height, width)
        minutes += 1.0 / (width * data.feed)
    return 1.0 / minutes


def _add_first(
    state: SurfacePlanState,
    area: Area,
    tags: tuple[int, ...],
    tool: Tool,
    samples: AreaSamples,
) -> None:
    """Plan semi-finishing and finishing of an area's faces with its first cutter."""
    for kind in ("semi", "finish") if state.settings.semi_allowance > 0.0 else ("finish",):
        for name, mine, strategy in _by_slope(
            area, tags, samples, math.radians(state.settings.steep)
        ):
            _add_finish(state, kind, name, mine, tool, strategy, samples)


def _add_rest(
    state: SurfacePlanState,
    area: Area,
    tags: tuple[int, ...],
    raw: tuple[int, ...],
    step: CutterStep,
    samples: AreaSamples,
    number: int,
) -> None:
    """Plan what the cutters before leave of an area's faces with its next one, the `number`-th, and semi-finishing of the `raw` ones."""
    end = f"-{number}" if number > 1 else ""
    kinds = (("rest_finish", f"{area.id}{end}", tags), ("semi", f"{area.id}-rest{end}", raw))
    for kind, id, faces in kinds[: 2 if state.settings.semi_allowance > 0.0 else 1]:
        part = Area(id=id, tags=faces, local=True)
        for name, mine, strategy in _by_slope(
            part, faces, samples, math.radians(state.settings.steep)
        ):
            _add_finish(state, kind, name, mine, step.tool, strategy, samples, earlier=step.earlier)


def _leaning_rest(
    state: SurfacePlanState,
    area: Area,
    samples: AreaSamples,
    found: AreaCutters,
    progress: Progress,
) -> None:
    """Plan for a leaning cutter what the upright ones of an area leave: what they can't touch, and what shank or holder keep them off."""
    if found.tool is None or not state.machine.rotary:
        return
    last, seen = found.tool, found.reached.copy()
    if found.rest is not None:
        last = found.rest
        missed = np.flatnonzero(~seen)
        seen[missed] = reached(
            state.space, samples.of(~seen), last, state.route.reach_clearance, 0.0, progress
        )
    tags = tuple(t for t in area.tags if not seen[samples.face == t].all())
    if (~seen).sum() <= NEGLIGIBLE * len(seen):
        return
    every = max(1, int((~seen).sum()) // LEANING_SAMPLES)
    few = samples.of(~seen & (np.cumsum(~seen) % every == 0))
    leaning = leaning_cutter(
        few, _leaning_finishers(state), state.around, state.settings.share, None, progress
    )
    if leaning.tool is None:
        return
    for kind in (
        ("semi", "rest_finish") if state.settings.semi_allowance > 0.0 else ("rest_finish",)
    ):
        _add_finish(
            state,
            kind,
            f"{area.id}{LEANING}",
            tags,
            leaning.tool,
            LEANING_STRATEGY,
            samples.of(~seen),
            upright=last,
        )


def plan_hidden_area(state: SurfacePlanState, area: Area, progress: Progress) -> None:
    """Plan semi-finishing and finishing of an area with a leaning cutter."""
    settings = state.settings
    samples, few = (
        samples_on(state.space.skin, area.tags),
        samples_on(state.space.skin, area.tags, LEANING_SAMPLES),
    )
    wanted = settings.local_cutter if area.local else settings.cutter
    own = named(state.shop, wanted) if wanted else None
    found = leaning_cutter(
        few, _leaning_finishers(state), state.around, settings.share, own, progress
    )
    _report_unreached(state, area, few, found)
    if found.tool is None:
        return
    if settings.semi_allowance > 0.0:
        _add_finish(state, "semi", area.id, area.tags, found.tool, LEANING_STRATEGY, samples)
    _add_finish(state, "finish", area.id, area.tags, found.tool, LEANING_STRATEGY, samples)
    if found.rest is not None:
        remaining = tuple(t for t in area.tags if (found.missed & (few.face == t)).any())
        _add_finish(
            state,
            "rest_finish",
            area.id,
            remaining,
            found.rest,
            LEANING_STRATEGY,
            samples,
            earlier=found.tool,
        )


def _by_slope(
    area: Area, tags: Sequence[int], samples: AreaSamples, limit: float
) -> list[tuple[str, tuple[int, ...], str]]:
    """Return the operations of an area: name, faces, strategy. Local features are of many slopes, which constant scallop suits best.

    Positions that lean by more than a limit (rad) are cut by waterlines: a face with some of both is in both operations.
    """
    above = leans(samples) > limit
    steep = tuple(t for t in tags if above[samples.face == t].mean() > SOME)
    if STEEP not in registry.names("strategies"):
        steep = ()
    shallow = tuple(
        t for t in tags if t not in steep or above[samples.face == t].mean() < 1.0 - SOME
    )
    found = (
        [(area.id, shallow, first_known(FOR_LOCAL if area.local else FOR_SHALLOW))]
        if shallow
        else []
    )
    return [*found, (f"{area.id}{FIRST}", steep, STEEP)] if steep else found


def first_known(names: Sequence[str]) -> str:
    """Return the first of some strategies that is there; the first one where none is."""
    known = registry.names("strategies")
    return next((name for name in names if name in known), names[0])


def _add_finish(
    state: SurfacePlanState,
    kind: str,
    name: str,
    tags: tuple[int, ...],
    tool: Tool,
    strategy: str,
    samples: AreaSamples,
    earlier: Tool | None = None,
    upright: Tool | None = None,
) -> None:
    stage, settings = state.stages[kind], state.settings
    if strategy not in registry.names("strategies"):
        state.findings.append(
            warning(
                "route.no-strategy",
                f"{name}: no strategy {strategy} is there; {kind} is left out",
                *face_tags(tags),
                remedy="install a package that has it",
            )
        )
        return
    semi = kind == "semi"
    allowance = settings.semi_allowance if semi else 0.0
    height = settings.semi_scallop if semi else laid_height(strategy, settings.height())
    after_rough = semi or settings.semi_allowance <= 0.0
    depth = (
        remaining_after_layers(state.space, settings) if after_rough else settings.semi_allowance
    )
    width = stepover_on_plane(tool.corner_radius or 0.5 * tool.radius, height)
    area = samples.area * float(np.isin(samples.face, tags).sum())
    rules = (
        stage.rule,
        f"{tool.name} over {trimmed(area, 0)} mm2: scallops of {trimmed(1000.0 * height, 1)} um, "
        f"{trimmed(width, 3)} mm between passes on a plane.",
        f"It leaves {trimmed(allowance, 2)} mm.",
    )
    choices: dict[str, Value] = {SCALLOP: height, ALLOWANCE: allowance}
    if settings.extension > 0.0:
        choices[EXTENSION] = settings.extension
    choices |= chord_choices(strategy, height)
    if strategy in SLOPE_LIMITS and STEEP in registry.names("strategies"):
        key, past = SLOPE_LIMITS[strategy]
        choices[key] = min(max(settings.steep + past, 1.0), 89.0)
    if semi and strategy == STEEP:
        # Finishing takes off the marks of passes against the climb, and what no piece of a pass was worth.
        choices |= {f"{STEEP}.way": "both", f"{STEEP}.trim": True}
    if earlier is not None or upright is not None:
        choices[f"{strategy}.lead_radius"] = REST_LEAD
    if earlier is not None:
        choices[EARLIER] = earlier.name
    if upright is not None:
        choices |= {UPRIGHT_EARLIER: upright.name, f"{strategy}.pattern": "constant"}
    state.add(
        kind,
        name,
        state.feature_of(tags),
        tool,
        tags,
        depth,
        width,
        choices,
        rules,
        strategy=strategy,
    )


def finishers(state: SurfacePlanState) -> tuple[Tool, ...]:
    """Return the balls that may finish curved faces."""
    return tuple(
        t
        for t in state.cutters("surface")
        if t.form == "ball" and t.diameter <= state.route.largest
    )


def _leaning_finishers(state: SurfacePlanState) -> tuple[Tool, ...]:
    """Return the longest ball of each diameter, the smallest first."""
    longest = {
        t.diameter: t
        for t in sorted(finishers(state), key=lambda t: (t.diameter, depth_reached(t), t.name))
    }
    return tuple(longest[d] for d in sorted(longest) if d <= LARGEST_LEANING)


def _report_unreached(
    state: SurfacePlanState, area: Area, samples: AreaSamples, found: AreaCutters
) -> None:
    """Return which faces no cutter reaches, or not the one that was requested."""
    lost = [t for t in area.tags if not found.reachable[samples.face == t].any()]
    if lost:
        size = samples.area * float(np.isin(samples.face, lost).sum())
        remedy = (
            "turn the part in another setup"
            if state.machine.rotary
            else "machine them on a machine with rotary axes (setup.machine), or turn the part in another setup"
        )
        state.findings.append(
            warning(
                "route.not-planned",
                f"{area.id}: no cutter reaches {len(lost)} of its faces, {trimmed(size, 0)} mm2 "
                "from the tool's direction",
                *face_tags(lost),
                remedy=remedy,
            )
        )
