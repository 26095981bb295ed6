"""The least time of an operation: what it removes at the highest removal rate, what it finishes at the highest area rate, whichever is
longer.

Both rates are the highest that spindle, machine, cutter and material allow, whatever strategy cuts: time over bound says how much is lost
in corners, links, air and entries, and how much other engagements could gain.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from trunnion.model.material import Machine, Material
from trunnion.model.operation import Engagement, Operation
from trunnion.model.tool import Tool
from trunnion.model.verdict import OperationProof
from trunnion.plan.cutting.engaged import engaged_depth, engaged_width
from trunnion.plan.cutting.milling import (
    ROUGHING,
    CuttingSettings,
    layer_depth,
    layer_width,
    roughing_depth,
    roughing_width,
)
from trunnion.plan.cutting.optimization.operation import (
    OptimizationSettings,
    can_be_optimised,
    problem_at,
)
from trunnion.plan.cutting.turning import TURNING_ROUGH
from trunnion.units import MM_PER_METRE, SECONDS_PER_MINUTE

SPEEDS, WIDTHS, DEPTHS = 33, 6, 12
"""Spindle speeds, widths and depths of cut that are looked at."""


@dataclass(frozen=True, slots=True, kw_only=True)
class HighestRates:
    """What steady cutting comes to at most: `removal` cm3/min and `area` mm2/min."""

    removal: float
    area: float


def highest_rates(
    operation: Operation, material: Material, machine: Machine, settings: OptimizationSettings
) -> HighestRates:
    """Return the highest rates of an operation of a rotating mill that keep the constraints of the optimiser in steady cutting.

    Roughing may take any width and depth that material and stickout let its cutter take, in slots, along walls or at constant engagement;
    another pass has the depth and width that its surface asks for. What it finishes a mm of way is the larger of both: of a floor or a
    curved face its step, of a wall its depth. Its own data count even where they pass the optimiser's limits: they are what it cuts with.
    """
    tool, data = operation.cutter, operation.data
    removal, area = data.removal_rate, max(data.width, data.depth) * data.feed
    for width, depth in _engagements(operation, material, settings):
        met = Engagement(width=width, depth=depth, share=1.0, at="")
        problem = problem_at(operation, met, met, material, machine, settings)
        spindle = np.geomspace(*problem.spindle, SPEEDS)
        feed = problem.largest_feed(spindle) * tool.teeth * spindle
        fastest = float(np.nan_to_num(feed).max())
        removal = max(removal, width * depth * fastest / MM_PER_METRE)
        area = max(area, max(width, depth) * fastest)
    return HighestRates(removal=removal, area=area)


def _engagements(
    operation: Operation, material: Material, settings: OptimizationSettings
) -> Iterator[tuple[float, float]]:
    """Yield the widths and depths in mm that an operation may cut."""
    tool, data, limits = operation.cutter, operation.data, settings.cutting
    yield data.width, data.depth
    if operation.kind not in ROUGHING:
        return
    deepest = max(depth for _, depth in _borne(tool, material, limits))
    for depth in deepest * np.arange(1, DEPTHS + 1) / DEPTHS:
        widest = max(
            engaged_width(tool, material, limits, depth),
            *(w for w, d in _borne(tool, material, limits) if depth <= d),
        )
        for width in widest * np.arange(1, WIDTHS + 1) / WIDTHS:
            yield float(width), float(depth)


def _borne(
    tool: Tool, material: Material, limits: CuttingSettings
) -> tuple[tuple[float, float], ...]:
    """Return widths in mm that a cutter bears in roughing, each with the depth up to which: along walls, in layers that slots open, and at
    constant engagement."""
    deep = engaged_depth(tool, material, limits)
    return (
        (roughing_width(tool, material, limits), roughing_depth(tool, material, limits)),
        (layer_width(tool, material, limits), layer_depth(tool, material, limits)),
        (engaged_width(tool, material, limits, deep), deep),
    )


def least_seconds(operation: Operation, proof: OperationProof, rates: HighestRates | None) -> float:
    """Return the least time in s of an operation as it was proven, without its tool change and rapids.

    Without `rates` there are no models for its tool (`rates_known`): roughing then takes what its data remove a minute, and any other
    tool must go once through what it cuts, at the feed of its table.
    """
    if rates is None:
        rate = operation.data.removal_rate
        if operation.kind in (*ROUGHING, TURNING_ROUGH) and rate > 0.0:
            return min(proof.cutting_s, _seconds(proof.removed / MM_PER_METRE, rate))
        return proof.cutting_s
    finished = 0.0 if operation.kind in ROUGHING else proof.served
    return min(
        max(
            _seconds(proof.removed / MM_PER_METRE, rates.removal),
            _seconds(finished, rates.area),
        ),
        proof.time_s,
    )


def rates_known(operation: Operation) -> bool:
    """Return whether the highest rates of an operation can be told: of a mill whose data nobody has set by hand."""
    return can_be_optimised(operation)


def _seconds(amount: float, rate: float) -> float:
    """Return the time in s of an amount at a rate a minute; 0 where there is none."""
    return amount / rate * SECONDS_PER_MINUTE if rate > 0.0 else 0.0
