"""Swarf milling: a cutter's flank lies along the rulings of walls that lean, and takes them in a few passes, one below the other.

The lowest pass of a wall begins where its fillet ends: a cutter with the fillet's corner radius leaves that too. Where its end would meet
a floor, as under a wall that leans over, it is lifted along the ruling.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from trunnion import tolerance
from trunnion.findings import Finding, Refused, warning
from trunnion.geometry.arrays import Bools, Floats
from trunnion.geometry.sheet.skin import Skin
from trunnion.model.operation import CuttingData
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.plan.clearance import ClearanceQuery
from trunnion.plan.freeform.drive import SurfaceDrive
from trunnion.plan.freeform.swarf.feet import border_of, depths
from trunnion.plan.freeform.swarf.guide_lines import GuideLine, guide_lines
from trunnion.plan.freeform.swarf.level_sections import level_sections
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.settings import setting, settings
from trunnion.toolpath.contact_passes.flank.flank_passes import flank_passes, lifts, stretches
from trunnion.toolpath.contact_passes.flank.flank_stock import FlankStock
from trunnion.toolpath.contact_passes.flank.flank_trimming import passes_off_stock
from trunnion.toolpath.contact_passes.linking.link_passes import extended_in_order, linked_in_order
from trunnion.toolpath.contact_passes.linking.parameters import LinkParameters
from trunnion.toolpath.contact_passes.passes import Pass
from trunnion.toolpath.contact_passes.stock_clearance import (
    LEAST_STOCK,
    STOCK_SHARE,
    StockClearance,
)
from trunnion.toolpath.contract import Planned, leaning_axis, strategy
from trunnion.toolpath.motion.load.engagement import contour_leftovers
from trunnion.toolpath.stock.heightfield import PlanningStock
from trunnion.units import trimmed

SMALLEST_SHARE = 0.002
"""Less of the guide lines than this may be left without a word."""
LEAST_SHARE = 0.5
"""Of passes whose tool has to stay clear of stock above the flutes: where less of their length does, the cutter is too short, not corners
too tight. They stay whole then: the proof finds the contact, and how much longer a cutter has to be."""
SHORTEST = 0.25
"""Of the cutter's diameter: a shorter line is none. Where faces run on past what is finished of them, scraps of these stay."""
LOWEST = 3.0
"""mm over the lowest foot that the lowest line is at most: the fillets of walls that lean differently end at different heights."""


@settings("surface.swarf")
class SwarfSettings:
    """How walls are cut by the flank."""

    step: float = setting(
        0.0,
        unit="mm",
        low=0.0,
        high=200.0,
        label="Step",
        help="Height from pass to pass; 0: as deep as the flutes allow.",
    )
    feet: bool = setting(
        False,
        label="Feet alone",
        help="Only the lowest pass of each wall, where a larger cutter was lifted off a floor before.",
    )
    chord: float = setting(
        0.002,
        unit="mm",
        low=0.0001,
        high=0.1,
        label="Chord error",
        help="How far a block may leave the walls, on either side.",
    )
    lead_radius: float = setting(
        1.0,
        unit="mm",
        low=0.0,
        high=20.0,
        label="Lead radius",
        help="Radius of the arcs onto and off the walls.",
    )
    safety: float = setting(
        2.0,
        unit="mm",
        low=0.2,
        high=50.0,
        label="Safety distance",
        help="How far rapids stay from the blank.",
    )


@strategy(
    settings=SwarfSettings,
    drive=SurfaceDrive,
    tool_axis=leaning_axis,
    meets=contour_leftovers,
    earlier_cuts=True,
    own_faces=True,
)
def swarf(
    drive: SurfaceDrive,
    tool: Tool,
    data: CuttingData,
    stock: PlanningStock,
    setup: Setup,
    settings: SwarfSettings,
    progress: Progress = NO_PROGRESS,
) -> Planned:
    """Return the path of a flank along the drive's walls, from the top down, and what it must leave."""
    if drive.query_for is None:
        raise Refused(
            f"{drive.feature}: swarf milling leans the tool; choose a machine with rotary axes, or waterlines"
        )
    query = drive.query_for(tool)
    step = settings.step or tool.flank_step(_height(drive.skin, drive.faces))
    lines = progress.aside(
        lambda _: _lines(drive, tool, step, query, feet_alone=settings.feet), "Looking for rulings"
    )
    around = StockClearance(drive, tool, max(STOCK_SHARE * data.width, LEAST_STOCK))
    found = flank_passes(
        lines, tool, drive.allowance, query, settings.chord, progress.part(0.1, 0.5)
    )
    parameters = LinkParameters(
        stepover=step,
        safety=settings.safety,
        lead_radius=settings.lead_radius,
        query=query,
        link_clearance=around,
    )
    extended = extended_in_order(found.passes, drive, tool, parameters, progress.part(0.5, 0.55))
    # What stands is cut by the passes themselves, from the top down: necks go where flanks have been.
    passes, beside = passes_off_stock(
        extended, tool, stock, drive.leaning_cuts, drive.frame, progress.part(0.55, 0.65)
    )
    share = _length(passes) / max(_length(extended), tolerance.COINCIDENT)
    if share < LEAST_SHARE:
        passes, share = tuple(extended), 1.0
        beside = FlankStock.after(passes, tool, stock, drive.leaning_cuts, drive.frame)
    findings = _remaining_findings(share * found.done, found.whole, drive, tool)
    if not passes:
        return Planned(findings=findings)
    parameters = replace(parameters, pass_stock=beside)
    path = linked_in_order(
        passes, drive, tool, data, stock, setup, parameters, progress.part(0.65, 1.0)
    )
    return Planned(path=path, findings=findings)


def _length(passes: Sequence[Pass]) -> float:
    """Return how long the paths of tips on passes are as a whole, mm."""
    return sum(p.length for p in passes)


def _height(skin: Skin, faces: tuple[int, ...]) -> float:
    """Return how high faces stand as a whole, mm."""
    z = skin.points[np.unique(skin.triangles[skin.of(faces)]), 2]
    return float(z.max() - z.min())


def _lines(
    drive: SurfaceDrive, tool: Tool, step: float, query: ClearanceQuery, *, feet_alone: bool
) -> list[GuideLine]:
    """Return the guide lines of all passes, from the top down: level ones a step apart, and at the feet of walls along these, or these
    alone."""
    border = border_of(drive.skin, drive.faces)
    levels = _levels(drive.skin, drive.faces, step)
    found = list[GuideLine]()
    for k, level in enumerate(levels):
        below = levels[k + 1] if k + 1 < len(levels) else -np.inf
        for section in level_sections(drive.skin, drive.faces, level):
            for line in guide_lines(section, tool.radius + drive.allowance):
                if line.length < SHORTEST * tool.diameter:
                    continue
                deep = depths(line, border)
                down = deep * line.ruling[:, 2]
                ends = line.point[:, 2] - down >= below
                # So little over its foot as the lowest lines are a line is the foot's alone.
                if not feet_alone and (down > LOWEST + tolerance.SEW).any():
                    found.append(line)
                found += _feet(line, deep, ends, tool, drive.allowance, query)
    return found


def _levels(skin: Skin, faces: tuple[int, ...], step: float) -> list[float]:
    """Return the heights of level lines, from the top down: even ones no more than a step apart, and more so that every face is met.

    The lowest ones are little over the lowest feet: there they meet all walls round these.
    """
    spans = np.array(
        [
            (float(z.min()), float(z.max()))
            for t in faces
            if len(z := skin.points[np.unique(skin.triangles[skin.of((t,))]), 2])
        ]
    )
    top, bottom = float(spans[:, 1].max()), float(spans[:, 0].min())
    count = max(1, math.ceil((top - bottom) / step - tolerance.COINCIDENT))
    found = np.linspace(top, bottom, count + 1)[1:-1].tolist()
    for low, high in sorted(spans.tolist()):
        if not any(low < z < high and z - low <= step for z in found):
            found.append(low + min(LOWEST, 0.5 * (high - low)))
    return sorted(found, reverse=True)


def _feet(
    line: GuideLine,
    deep: Floats,
    ends: Bools,
    tool: Tool,
    allowance: float,
    query: ClearanceQuery,
) -> list[GuideLine]:
    """Return the lines at the feet of a line's walls, where these end before the next level: down by `deep` mm, and up again where the
    cutter's end touches something there."""
    found = list[GuideLine]()
    for rows, closed in stretches(ends & np.isfinite(deep), closed=line.closed):
        some = replace(line, closed=True) if closed else line.of(rows)
        foot = some.at(some.point - deep[rows, None] * some.ruling)
        lift = lifts(foot, tool, allowance, query, tool.diameter)
        lift[~np.isfinite(lift)] = 0.0
        found.append(foot.at(foot.point + lift[:, None] * foot.ruling))
    return found


def _remaining_findings(
    done: float, whole: float, drive: SurfaceDrive, tool: Tool
) -> tuple[Finding, ...]:
    """Return what is said of guide lines (mm) that no pass goes along."""
    if whole > 0.0 and done >= (1.0 - SMALLEST_SHARE) * whole:
        return ()
    share = 100.0 * (1.0 - done / whole) if whole > 0.0 else 100.0
    return (
        warning(
            "swarf.left",
            f"{trimmed(share, 1)} % of the way round the walls of {drive.feature} stay: {tool.name} finds no room along their rulings",
            drive.feature,
            remedy="finish them by waterlines or point milling, or choose a smaller or longer cutter",
        ),
    )
