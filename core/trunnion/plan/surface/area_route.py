"""Finishing of areas of curved faces: each by the largest cutter that reaches it, what that leaves by a smaller or a leaning one."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from trunnion import registry
from trunnion.findings import face_tags, warning
from trunnion.model.tool import Tool
from trunnion.plan.freeform.cutters.choice import NEGLIGIBLE, AreaCutters, cutter_for, named
from trunnion.plan.freeform.estimate.scallop import stepover_on_plane
from trunnion.plan.freeform.finishing.areas import Area
from trunnion.plan.freeform.finishing.chord import chord_choices
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
from trunnion.settings import Value
from trunnion.units import trimmed

LARGEST_LEANING = 16.0
"""mm: larger balls have no space to lean on parts that need it."""
FOR_LOCAL = ("surface.constant", "surface.parallel")
FOR_SHALLOW = ("surface.parallel", "surface.constant")
"""Strategies for local features and for shallow faces, the best first."""
STEEP = "surface.waterline"
"""The strategy for steep faces."""
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
    """Plan semi-finishing and finishing of an area with its own cutter, and of what that cutter leaves with a smaller one.

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
    )
    _report_unreached(state, area, samples, found)
    if found.tool is None:
        return
    tags = tuple(t for t in area.tags if found.reached[samples.face == t].any())
    for kind in ("semi", "finish") if settings.semi_allowance > 0.0 else ("finish",):
        for name, mine, strategy in _by_slope(area, tags, samples, math.radians(settings.steep)):
            _add_finish(state, kind, name, mine, found.tool, strategy, samples)
    if found.rest is not None:
        missed = samples.of(found.missed)
        remaining = Area(
            id=area.id, tags=tuple(t for t in area.tags if (missed.face == t).any()), local=True
        )
        for name, mine, strategy in _by_slope(
            remaining, remaining.tags, missed, math.radians(settings.steep)
        ):
            _add_finish(
                state, "rest_finish", name, mine, found.rest, strategy, missed, earlier=found.tool
            )
        # Faces that the larger cutter never touches are still as roughing left them.
        raw = replace(
            remaining, id=f"{area.id}-rest", tags=tuple(t for t in remaining.tags if t not in tags)
        )
        if raw.tags and settings.semi_allowance > 0.0:
            for name, mine, strategy in _by_slope(
                raw, raw.tags, missed, math.radians(settings.steep)
            ):
                _add_finish(state, "semi", name, mine, found.rest, strategy, missed)
    _leaning_rest(state, area, samples, found, progress)


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
            "surface.point",
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
        _add_finish(state, "semi", area.id, area.tags, found.tool, "surface.point", samples)
    _add_finish(state, "finish", area.id, area.tags, found.tool, "surface.point", samples)
    if found.rest is not None:
        remaining = tuple(t for t in area.tags if (found.missed & (few.face == t)).any())
        _add_finish(
            state,
            "rest_finish",
            area.id,
            remaining,
            found.rest,
            "surface.point",
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
    height = settings.semi_scallop if semi else settings.height()
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
        # To and fro, and where stock stands alone: the mark of neither stays.
        choices |= {f"{STEEP}.way": "both", f"{STEEP}.trim": True}
    if earlier is not None:
        choices |= {EARLIER: earlier.name, f"{strategy}.lead_radius": REST_LEAD}
    if upright is not None:
        choices |= {
            UPRIGHT_EARLIER: upright.name,
            "surface.point.pattern": "constant",
            "surface.point.lead_radius": REST_LEAD,
        }
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
