"""The least time of an operation: what it removes at the highest removal rate, what it finishes at the highest area rate, whichever is
longer.

Both rates are the highest that spindle, machine, cutter and material allow, whatever strategy cuts: time over bound says how much is lost
in corners, links, air and entries, and how much other engagements could gain.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

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
from trunnion.plan.cutting.optimization.operation import OptimizationSettings, problem_at
from trunnion.plan.cutting.turning import TURNING_ROUGH
from trunnion.units import MM_PER_METRE, SECONDS_PER_MINUTE

SPEEDS, WIDTHS, DEPTHS = 33, 6, 6
"""Spindle speeds, widths and depths of cut that are looked at."""


@dataclass(frozen=True, slots=True, kw_only=True)
class HighestRates:
    """What steady cutting comes to at most: `removal` cm3/min and `area` mm2/min."""

    removal: float
    area: float


class RateSearch:
    """Looks for highest rates in a material; what a cutter bears in roughing is looked for once, whatever the depths of its pockets."""

    def __init__(self, material: Material) -> None:
        self._material = material
        self._roughing = dict[Any, float]()

    def rates(
        self, operation: Operation, machine: Machine, settings: OptimizationSettings
    ) -> HighestRates:
        """Return the highest rates of an operation of a rotating mill that keep the constraints of the optimiser in steady cutting.

        Roughing may take any width and depth that material and stickout let its cutter take, in slots, along walls or at constant
        engagement; another pass has the depth and width that its surface asks for. What it finishes a mm of way is the larger of both: of
        a floor or a curved face its step, of a wall its depth. Its own data count even where they pass the optimiser's limits: they are
        what it cuts with.
        """
        data = operation.data
        feed = max(data.feed, self._feed(operation, machine, settings, data.width, data.depth))
        removal = data.width * data.depth * feed / MM_PER_METRE
        if operation.kind in ROUGHING:
            key = operation.cutter, operation.kind, machine.name, settings
            if key not in self._roughing:
                self._roughing[key] = self._roughed(operation, machine, settings)
            removal = max(removal, self._roughing[key])
        return HighestRates(removal=removal, area=max(data.width, data.depth) * feed)

    def _roughed(
        self, operation: Operation, machine: Machine, settings: OptimizationSettings
    ) -> float:
        return max(
            width * depth * self._feed(operation, machine, settings, width, depth) / MM_PER_METRE
            for width, depth in _borne(operation.cutter, self._material, settings.cutting)
        )

    def _feed(
        self,
        operation: Operation,
        machine: Machine,
        settings: OptimizationSettings,
        width: float,
        depth: float,
    ) -> float:
        """Return the highest feed in mm/min in steady cutting of a width and depth in mm; 0 where nothing keeps the limits."""
        met = Engagement(width=width, depth=depth, share=1.0, at="")
        problem = problem_at(operation, met, met, self._material, machine, settings)
        spindle = np.geomspace(*problem.spindle, SPEEDS)
        feeds = problem.largest_feed(spindle) * operation.cutter.teeth * spindle
        return float(np.nan_to_num(feeds).max())


def _borne(
    tool: Tool, material: Material, limits: CuttingSettings
) -> Iterator[tuple[float, float]]:
    """Yield widths and depths in mm that a cutter bears in roughing: along walls, in layers that slots open, at constant engagement."""
    layers = (
        (roughing_width(tool, material, limits), roughing_depth(tool, material, limits)),
        (layer_width(tool, material, limits), layer_depth(tool, material, limits)),
    )
    flank = engaged_depth(tool, material, limits)
    for share in np.arange(1, DEPTHS + 1) / DEPTHS:
        borne = [(width, share * depth) for width, depth in layers]
        borne.append((engaged_width(tool, material, limits, share * flank), share * flank))
        for widest, depth in borne:
            for width in widest * np.arange(1, WIDTHS + 1) / WIDTHS:
                yield float(width), float(depth)


def least_seconds(operation: Operation, proof: OperationProof, rates: HighestRates | None) -> float:
    """Return the least time in s of an operation as it was proven, without its tool change and rapids.

    Without `rates` there are no models for it (`can_be_optimised`): roughing then takes what its data remove a minute, and any other
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


def _seconds(amount: float, rate: float) -> float:
    """Return the time in s of an amount at a rate a minute; 0 where there is none."""
    return amount / rate * SECONDS_PER_MINUTE if rate > 0.0 else 0.0
