"""Which turning tool for what: strong inserts rough, slender ones follow the contour; the largest boring bar that goes in."""

from __future__ import annotations

from collections.abc import Sequence

from trunnion.model.tool import TurningTool
from trunnion.plan.turning.view import TurningSide

STRONG = 75.0
"""degrees: a corner this wide or wider is for roughing, and finishes only where there is no other."""
BAR_GRIPPED = 2.0
"""Diameters of a boring bar that its clamp holds."""


def candidates(
    tools: Sequence[TurningTool], side: TurningSide, hand: str, *, finish: bool
) -> list[TurningTool]:
    """Return the tools for a side, the preferred first, one for each corner angle: to rough the strongest corner first, to finish
    the slender ones only; of one angle the thickest bar and the largest nose."""
    fitting = [t for t in tools if t.inside is (side is TurningSide.INSIDE) and t.hand == hand]
    ordered = sorted(
        fitting,
        key=lambda t: (
            -t.insert.point_angle,
            -t.shank_width * t.inside,
            -t.insert.nose_radius,
            t.name,
        ),
    )
    by_angle: dict[float, TurningTool] = {}
    for tool in ordered:
        by_angle.setdefault(tool.insert.point_angle, tool)
    found = list(by_angle.values())
    slender = [t for t in found if t.insert.point_angle < STRONG]
    return (slender or found) if finish else found


def bars_that_fit(
    tools: Sequence[TurningTool], bore: float, depth: float, clearance: float
) -> list[TurningTool]:
    """Return the boring bars that go into a bore of a radius (mm) and reach a depth in it, in the order given."""
    return [
        t
        for t in tools
        if t.functional_width + t.shank_width / 2 + 2.0 * clearance < 2.0 * bore
        and depth + BAR_GRIPPED * t.shank_width <= t.functional_length
    ]
