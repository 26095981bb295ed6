"""The cutter of an area: the largest of the catalogue that reaches enough of it, and the one for the rest."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from difflib import get_close_matches

import numpy as np

from trunnion.findings import BadInput
from trunnion.geometry.arrays import Bools
from trunnion.model.tool import Tool
from trunnion.plan.freeform.cutters.cutter import tip_at
from trunnion.plan.freeform.reach import AreaSamples, reached
from trunnion.plan.freeform.space import SurfaceSpace
from trunnion.plan.tool_choice import depth_reached
from trunnion.progress import Progress
from trunnion.shop import Shop

NEGLIGIBLE = 0.002
"""Share of an area that is left to no further cutter when its own one misses it."""
GOES = 0.1
"""Of an area's size: a cutter whose tip goes no farther while it touches all of it has no way to go there."""
NEAR = 3
"""Names of cutters that are offered in place of one that is not there."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class AreaCutters:
    """The cutter of an area and the samples (k,) it reaches, what any of the catalogue reaches, and the cutter for the `missed` ones.

    `by_name` is what each of them reaches of the samples, where that was asked for."""

    tool: Tool | None
    reached: Bools
    reachable: Bools
    missed: Bools
    rest: Tool | None
    by_name: Mapping[str, Bools] = field(default_factory=dict)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CutterStep:
    """A cutter, the samples (k,) of an area that it is for, and the cutter whose rest it takes, None where it is the first one."""

    tool: Tool
    rows: Bools
    earlier: Tool | None = None


def named(shop: Shop, name: str) -> Tool:
    """Return a cutter of the catalogue by its name; raise `BadInput` when there is none. A turning insert is no cutter that mills."""
    cutters = [t for t in shop.tools if not t.locked]
    for tool in cutters:
        if tool.name == name:
            return tool
    by_lower = {t.name.lower(): t.name for t in cutters}
    near = [
        by_lower[word] for word in get_close_matches(name.lower(), by_lower, n=NEAR, cutoff=0.0)
    ]
    raise BadInput(
        f"there is no cutter {name} in the catalogue; the nearest names are {', '.join(near)}"
    )


def by_diameter(tool: Tool) -> float:
    """Return a cutter's diameter: the largest is wanted, and smaller ones finish what it misses."""
    return tool.diameter


def by_corner(tool: Tool) -> float:
    """Return a cutter's corner radius: what is steep is finished in the fewest passes by the roundest one."""
    return tool.corner_radius


def cutter_for(
    space: SurfaceSpace,
    samples: AreaSamples,
    tools: Sequence[Tool],
    share: float,
    clearance: float,
    wanted: Tool | None,
    progress: Progress,
    size: Callable[[Tool], float] = by_diameter,
    below: float = 0.0,
) -> AreaCutters:
    """Return the largest cutter, by a size of cutters, that reaches at least a share of what any one reaches of samples, the shortest of
    its size; or the one that is `wanted`. Tips may be lower than the blank by what is allowed `below` it (mm).

    What it misses goes to the largest smaller one, or else to one of less diameter, that reaches nearly all any does of that. One that is
    nearly as round as a hollow is taken where no other one reaches as much: it touches all of it from one place, and its passes would have
    no length.
    """
    ranked = sorted(tools, key=lambda t: (-size(t), -t.diameter, depth_reached(t), t.name))
    reach: dict[str, Bools] = {}
    for n, tool in enumerate([*ranked, *([wanted] if wanted else [])]):
        if tool.name not in reach:
            reach[tool.name] = reached(
                space,
                samples,
                tool,
                clearance,
                0.0,
                progress.part(n / (len(ranked) + 1), (n + 1) / (len(ranked) + 1)),
                below,
            )
    none = np.zeros(len(samples), dtype=bool)
    reachable = np.logical_or.reduce([none, *reach.values()])
    if not reachable.any():
        return AreaCutters(tool=None, reached=none, reachable=reachable, missed=none, rest=None)
    total = int(reachable.sum())
    enough = [t for t in ranked if reach[t.name].sum() >= share * total]
    tool = wanted or next(
        (t for t in enough if _goes(t, samples.of(reach[t.name]))),
        enough[0] if enough else max(ranked, key=lambda t: int(reach[t.name].sum())),
    )
    missed = reachable & ~reach[tool.name]
    if missed.sum() <= NEGLIGIBLE * total:
        missed = none
    # Where none of a smaller size is there, as after a sharp end, a thinner one may still get in between faces.
    smaller = [t for t in ranked if size(t) < size(tool)]
    smaller += [t for t in ranked if size(t) >= size(tool) and t.diameter < tool.diameter]
    rest = (
        next((t for t in smaller if (reach[t.name] & missed).sum() >= share * missed.sum()), None)
        if missed.any()
        else None
    )
    return AreaCutters(
        tool=tool,
        reached=reach[tool.name],
        reachable=reachable,
        missed=missed,
        rest=rest,
        by_name=reach,
    )


def _goes(tool: Tool, samples: AreaSamples) -> bool:
    """Return whether the tip of an upright cutter moves while it touches one sample after the other."""
    axis = np.broadcast_to([0.0, 0.0, 1.0], samples.normal.shape)
    tips = tip_at(tool, samples.point, samples.normal, axis)
    moved, size = (float(np.linalg.norm(np.ptp(v, axis=0))) for v in (tips, samples.point))
    return moved > GOES * size


def steps_of(cutters: AreaCutters) -> tuple[CutterStep, ...]:
    """Return the cutters of an area in the order they cut: none, its own, or that one and the one for the rest."""
    if cutters.tool is None:
        return ()
    first = CutterStep(tool=cutters.tool, rows=cutters.reached)
    if cutters.rest is None:
        return (first,)
    return first, CutterStep(tool=cutters.rest, rows=cutters.missed, earlier=cutters.tool)


def with_larger_first(
    cutters: AreaCutters,
    tools: Sequence[Tool],
    area: float,
    rate: Callable[[Tool], float],
    change: float,
) -> tuple[CutterStep, ...]:
    """Return the cutters of an area in the order they cut, a larger one before its own where both together are quicker.

    A sample stands for `area` mm2, `rate` is what a cutter finishes in mm2/min, `change` what one more tool takes in min. The larger one
    cuts what it reaches, the area's own the rest: the time is the sum of both areas over their rates.
    """
    steps = steps_of(cutters)
    own = cutters.tool
    if own is None:
        return steps
    best, least = None, area * float(cutters.reached.sum()) / rate(own)
    for tool in sorted(tools, key=lambda t: (t.diameter, depth_reached(t), t.name)):
        if tool.diameter > own.diameter and (mine := cutters.by_name[tool.name]).any():
            left = float((cutters.reached & ~mine).sum())
            time = area * (float(mine.sum()) / rate(tool) + left / rate(own)) + change
            if time < least:
                best, least = tool, time
    if best is None:
        return steps
    mine = cutters.by_name[best.name]
    second = CutterStep(tool=own, rows=cutters.reached & ~mine, earlier=best)
    return CutterStep(tool=best, rows=mine), second, *steps[1:]


def with_rounder_between(
    cutters: AreaCutters,
    tools: Sequence[Tool],
    time: Callable[[Tool, Bools], float],
    change: float,
) -> tuple[CutterStep, ...]:
    """Return the cutters of an area in the order they cut, a rounder one before the one for the rest where both together are quicker.

    What a round cutter leaves in corners another one, smaller but round too, cuts in a few passes; what it leaves at sharp feet needs a
    corner as sharp, whose passes lie so much nearer to each other. `time` is what a cutter takes for samples (k,) in min, `change` what
    one more tool takes.
    """
    steps = steps_of(cutters)
    if len(steps) < 2:
        return steps
    first, rest = steps
    best, least = None, time(rest.tool, rest.rows)
    for tool in sorted(tools, key=lambda t: (-t.corner_radius, depth_reached(t), t.name)):
        mine = rest.rows & cutters.by_name.get(tool.name, np.zeros_like(rest.rows))
        if rest.tool.corner_radius < tool.corner_radius < first.tool.corner_radius and mine.any():
            taken = time(tool, mine) + time(rest.tool, rest.rows & ~mine) + change
            if taken < least:
                best, least = tool, taken
    if best is None:
        return steps
    mine = rest.rows & cutters.by_name[best.name]
    between = CutterStep(tool=best, rows=mine, earlier=first.tool)
    left = rest.rows & ~mine
    if left.sum() <= NEGLIGIBLE * cutters.reachable.sum():
        return first, between
    return first, between, CutterStep(tool=rest.tool, rows=left, earlier=best)
