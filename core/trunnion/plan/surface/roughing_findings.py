"""What no roughing cutter comes to: hollows that are still full when cutters come there that finish and are not meant for it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from trunnion.findings import face_tags, warning
from trunnion.geometry.arrays import Floats
from trunnion.plan.freeform.finishing.areas import Area
from trunnion.plan.freeform.reach import samples_on
from trunnion.plan.freeform.roughing.hollows import are_opened
from trunnion.plan.freeform.roughing.layers import remaining_on_walls
from trunnion.plan.surface.plan_state import SurfacePlanState
from trunnion.plan.surface.roughing_route import (
    FULL,
    ON_SKIN,
    REST_SHARE,
    remaining_after_layers,
)
from trunnion.progress import Progress
from trunnion.units import percent, trimmed

SOME = 0.1
"""Share of an area under full material that is told: corners that roughing rounds off are less."""
MOST = 0.9
"""Share of what is full that a cutter must come to, to be named as small enough."""
FEW = 1.0
"""Of the square of the smallest roughing cutter's diameter: less area than that is cleared by what finishes, slowly."""
SMALLEST = 0.5
"""mm: diameter of the smallest cutter that is tried."""


def report_hollows(state: SurfacePlanState, areas: Sequence[Area], progress: Progress) -> None:
    """Warn of each area of which a good part is under more material than its cutters are meant for: no roughing direction opens it.

    That is where the point above a place of a face, farther off along its normal than layers leave material and than the area's largest
    cutter is round, is in the blank and roughing comes to it from no direction.
    """
    if not state.roughing_sides:
        return
    for area in areas:
        cutters = [
            o.cutter
            for o in state.operations
            if o.kind in ON_SKIN and set(o.faces) & set(area.tags)
        ]
        samples = samples_on(state.space.skin, area.tags)
        if not cutters or not len(samples):
            continue
        over = max(
            FULL * remaining_after_layers(state.space, state.settings),
            *(c.corner_radius or c.radius for c in cutters),
        )
        above = samples.point + over * samples.normal
        full = np.isnan(_depth_opened(state, above, np.inf, progress))
        least = FEW * min(side.tool.diameter for side in state.roughing_sides) ** 2
        if full.mean() < SOME or samples.area * full.sum() < least:
            continue
        needed, remedy = _needed(state, above[full], progress)
        state.findings.append(
            warning(
                "route.not-roughed",
                f"{area.id}: no roughing cutter comes to {percent(float(full.mean()))} of it, "
                f"{trimmed(samples.area * float(full.sum()), 0)} mm2, where more than {trimmed(over, 1)} mm of material stays, "
                f"which cutters that finish are not meant for; {needed}",
                *face_tags(sorted(set(samples.face[full].tolist()))),
                remedy=remedy,
            )
        )


def _depth_opened(
    state: SurfacePlanState, points: Floats, widest: float, progress: Progress
) -> Floats:
    """Return how deep (k,) in mm points (k, 3) of the setup's frame lie for roughing cutters up to a diameter that come there; 0 outside
    the blank, NaN where none comes."""
    space, settings = state.space, state.settings
    found = np.where(space.blank.depth(points, space.frame) > 0.0, np.nan, 0.0)
    for side in state.roughing_sides:
        rows = np.flatnonzero(~(found <= 0.0))
        local = side.space.frame.to_local(space.frame.to_world(points[rows]))
        radius = min(side.tool.radius, 0.5 * widest) + remaining_on_walls(
            side.space, settings.rough_allowance, settings.cell
        )
        opened = are_opened(side.space, side.bottom, local, radius, progress)
        depth = np.where(opened, float(side.space.high[2]) - local[:, 2], np.nan)
        found[rows] = np.fmin(found[rows], depth)
    return found


def _needed(state: SurfacePlanState, points: Floats, progress: Progress) -> tuple[str, str]:
    """Return in words how small and how long a roughing cutter would have to be that comes to most of what is full, and the remedy."""
    diameter = REST_SHARE * min(side.tool.diameter for side in state.roughing_sides)
    while diameter > SMALLEST:
        depth = _depth_opened(state, points, diameter, progress)
        if np.isfinite(depth).mean() >= MOST:
            return (
                f"one of D {trimmed(diameter, 1)} that reaches {trimmed(float(np.nanmax(depth)), 0)} mm "
                "deep would come there",
                "add such a cutter to the tools folder",
            )
        diameter *= REST_SHARE
    return (
        f"from the {len(state.roughing_sides)} directions that are roughed no smaller one would either",
        "channels between blades need roughing that follows them: choose the family that has it (recognize.family), "
        "or turn the part in another setup",
    )
