"""What a leaning cutter reaches where one along the tool's direction doesn't, and which cutter of the catalogue reaches enough of it."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from trunnion.geometry.arrays import Bools, Floats
from trunnion.model.tool import Tool
from trunnion.plan.clearance import ClearanceQuery
from trunnion.plan.freeform.cutters.choice import NEGLIGIBLE, AreaCutters
from trunnion.plan.freeform.cutters.cutter import tip_at
from trunnion.plan.freeform.reach import AreaSamples
from trunnion.plan.tool_choice import depth_reached
from trunnion.progress import NO_PROGRESS, Progress

LEANS = np.radians([25.0, 50.0, 70.0])
"""Leans from the normal that are tried, the least one first; point milling finds what lies between."""
AROUND = 8
"""Directions of a lean."""
SAMPLES = 200
"""Samples of an area that are enough to choose a leaning cutter by: each is queried at many poses."""


def reached_leaning(
    samples: AreaSamples, tool: Tool, query: ClearanceQuery, progress: Progress = NO_PROGRESS
) -> Bools:
    """Return which samples (k,) a cutter touches with some lean, nothing of the tool in the part, and an axis that the machine can hold."""
    found = np.zeros(len(samples), dtype=bool)
    tried = list(_axes(samples.normal))
    for n, axis in enumerate(tried):
        progress.at(n / len(tried), f"leaning {tool.name}")
        rows = np.flatnonzero(~found)
        tip = tip_at(tool, samples.point[rows], samples.normal[rows], axis[rows])
        found[rows] = query(tip, axis[rows])
        if found.all():
            break
    return found


def leaning_cutter(
    samples: AreaSamples,
    tools: Sequence[Tool],
    query_for: Callable[[Tool], ClearanceQuery],
    share: float,
    wanted: Tool | None = None,
    progress: Progress = NO_PROGRESS,
) -> AreaCutters:
    """Return the largest cutter that, leaning, reaches at least a share of what any one reaches of samples, the shortest of its size; or
    the one that is `wanted`. What it misses goes to the largest smaller one that reaches nearly all any does of that."""
    ranked = sorted(tools, key=lambda t: (-t.diameter, depth_reached(t), t.name))
    reach: dict[str, Bools] = {}

    def of(tool: Tool) -> Bools:
        if tool.name not in reach:
            reach[tool.name] = reached_leaning(samples, tool, query_for(tool), progress)
        return reach[tool.name]

    none = np.zeros(len(samples), dtype=bool)
    # The smallest cutter of each length says what can be reached at all.
    reachable = np.logical_or.reduce(
        [none, *(of(t) for t in ranked[-2:]), *([of(wanted)] if wanted else [])]
    )
    if not reachable.any():
        return AreaCutters(tool=None, reached=none, reachable=reachable, missed=none, rest=None)
    tool = wanted or next(
        (t for t in ranked if (of(t) & reachable).sum() >= share * reachable.sum()), ranked[-1]
    )
    reachable = np.logical_or.reduce([none, *reach.values()])
    missed = reachable & ~of(tool)
    missed = missed if missed.sum() > NEGLIGIBLE * reachable.sum() else none
    smaller = [t for t in ranked if t.diameter < tool.diameter]
    rest = (
        next((t for t in smaller if (of(t) & missed).sum() >= share * missed.sum()), None)
        if missed.any()
        else None
    )
    return AreaCutters(tool=tool, reached=of(tool), reachable=reachable, missed=missed, rest=rest)


def _axes(normal: Floats) -> list[Floats]:
    """Return axes (k, 3) to be tried at samples with normals (k, 3): the normal itself, then leans from it all round."""
    first = np.where(np.abs(normal[:, 2:]) < 0.9, [0.0, 0.0, 1.0], [1.0, 0.0, 0.0])
    x = first - (first * normal).sum(axis=1, keepdims=True) * normal
    x /= np.linalg.norm(x, axis=1, keepdims=True)
    y = np.cross(normal, x)
    turns = 2.0 * math.pi * np.arange(AROUND) / AROUND
    return [
        normal,
        *(
            math.cos(lean) * normal + math.sin(lean) * (math.cos(turn) * x + math.sin(turn) * y)
            for lean in LEANS
            for turn in turns
        ),
    ]
