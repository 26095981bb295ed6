"""How passes are linked."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.plan.clearance import ClearanceQuery
from trunnion.toolpath.contact_passes.passes import UPRIGHT

NEAR = 3.0
"""Stepovers: a pass that begins no farther from the end of the one before is reached without lifting."""
SAME = 1e-9
"""Two directions that differ by less are one."""


class PassStock(Protocol):
    """What stands beside passes of a tool while they are cut in their order (`upright.stock_contact`, `flank.flank_stock`)."""

    def is_free(self, tips: Floats, axes: Floats, cut: Ints) -> Bools:
        """Return at which tips with axes (k, 3) the tool meets no stock above its flutes when so many passes (k,) are cut."""

    def tops(self, tips: Floats, cut: Ints) -> Floats:
        """Return how high (k,) mm stock stands within the cutter's radius of tips (k, 3) when so many passes (k,) are cut; minus infinity
        where there is none."""


class LinkClearance(Protocol):
    """Where rapids of a leaning tool touch neither part and fixtures nor what stands of the blank (`stock_clearance.StockClearance`)."""

    def retreats(self, tip: Floats, axis: Floats) -> Floats:
        """Return how far (k,) in mm a tool at tips (k, 3) is fed out along its axes (k, 3) before it goes on at rapid; infinite where its
        way out is nowhere known to be clear."""

    def is_free_between(
        self, start_tip: Floats, start_axis: Floats, tip: Floats, axis: Floats
    ) -> Bools:
        """Return which rapids (k,) are clear all along: straight for the tip, at an even turn for the axis."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LinkParameters:
    """How passes are linked: the `stepover` between them, the `safety` distance of rapids and the `lead_radius` in mm; `order` is "given",
    "nearest" or "shorter", which is nearest where that takes the tool less far through the air; `reversing` allows passes to be cut the
    other way where that is nearer; `chord` is the chord error of links, mm. With `arcs` a near pass is reached by the leads of both, and
    above the stock where these have no space: for walls, beside which a cutter that follows the surface would be lifted to their tops.
    Closed passes go on over their start by the `overlap` in mm. `pass_stock` says where leads and links may go for what stands.

    Of leaning tools: `query` says which straight moves are clear, `link_clearance` which rapids are (None: any along the axis, none
    across); on a mm over the surface the axis turns by no more than `turn` rad.
    """

    stepover: float
    safety: float = 2.0
    lead_radius: float = 1.0
    order: str = "given"
    reversing: bool = False
    chord: float = 2e-3
    arcs: bool = False
    overlap: float = 0.0
    pass_stock: PassStock | None = None
    turn: float = math.inf
    query: ClearanceQuery | None = None
    link_clearance: LinkClearance | None = None


def is_upright(axis: Floats) -> bool:
    """Return whether an axis (3,) stands along z."""
    return bool(np.abs(axis - UPRIGHT).max() < SAME)
