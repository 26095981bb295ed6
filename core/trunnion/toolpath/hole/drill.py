"""Drills holes: one cycle each, by how deep it is, in a short tour."""

from __future__ import annotations

import numpy as np

from trunnion import tolerance
from trunnion.findings import Finding, remark, warning
from trunnion.model.motion.cycle import BACK_OFF, Cycle, CycleKind
from trunnion.model.operation import CuttingData
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.plan.holes.drive import SPOT, HoleDrive
from trunnion.plan.holes.hole import PlannedHole
from trunnion.plan.holes.settings import DrillSettings
from trunnion.plan.holes.tools import SAME_ANGLE, tip_of
from trunnion.progress import Progress
from trunnion.toolpath.contract import Planned, strategy
from trunnion.toolpath.motion.builder import PathBuilder
from trunnion.toolpath.motion.hole_access import kept_off
from trunnion.toolpath.motion.hole_cycles import HoleCycle, cycle_path, retract_plane, top_at
from trunnion.toolpath.motion.tour import short_tour
from trunnion.toolpath.stock.heightfield import PlanningStock
from trunnion.units import trimmed


@strategy(settings=DrillSettings, drive=HoleDrive, leaves=("hole.floor",), own_faces=True)
def drill(
    drive: HoleDrive,
    tool: Tool,
    data: CuttingData,
    stock: PlanningStock,
    setup: Setup,
    settings: DrillSettings,
    progress: Progress,
) -> Planned:
    """Return the cycles that drill holes, and which holes the drill can't go to the bottom of."""
    builder = PathBuilder(tool, data, stock, setup, settings.safety)
    cycles: list[HoleCycle] = []
    findings: list[Finding] = []
    spots = drive.kind == SPOT
    for hole in progress.each(drive.holes):
        tip = spot_tip(hole, tool) if spots else tip_of(hole, tool, settings.breakthrough)
        stopped = (None if spots else _too_wide(hole, tool)) or kept_off(builder, hole, tip)
        if stopped is not None:
            findings.append(stopped)
            continue
        plane, deep = retract_plane(builder, hole), max(top_at(builder, hole) - tip, 0.0)
        cycle = cycle_of(plane - tip, 0.0 if spots else deep, tool, settings)
        cycles.append(HoleCycle(hole=hole, plane=plane, cycle=cycle))
        findings += [] if spots else _left(hole, tool)
    if not cycles:
        return Planned(findings=tuple(findings))
    order = short_tour(np.array([c.hole.position for c in cycles]), progress)
    return Planned(path=cycle_path(builder, [cycles[k] for k in order]), findings=tuple(findings))


def spot_tip(hole: PlannedHole, tool: Tool) -> float:
    """Return how deep a spot drill's tip goes: its cone as wide as the hole, or as it is itself, where the hole begins."""
    return hole.top - tool.point_length * min(hole.diameter / tool.diameter, 1.0)


def cycle_of(depth: float, deep: float, tool: Tool, settings: DrillSettings) -> Cycle:
    """Return the cycle of a hole: `depth` mm from the retract plane, `deep` mm in material, which decides by the diameter whether chips are
    broken, or brought out."""
    times = deep / tool.diameter
    peck = settings.peck * tool.diameter
    if times < min(settings.chip_break_from, settings.peck_from) or not BACK_OFF < peck < deep:
        return Cycle(kind=CycleKind.DRILL, depth=depth)
    kind = CycleKind.PECK if times >= settings.peck_from else CycleKind.CHIP_BREAK
    return Cycle(kind=kind, depth=depth, peck=peck)


def _too_wide(hole: PlannedHole, tool: Tool) -> Finding | None:
    """Return the finding on a hole that a drill would make wider than the proof lets it."""
    if tool.radius - hole.radius <= tolerance.GOUGE:
        return None
    return warning(
        "hole.too-narrow",
        f"{hole.feature} is not drilled: {tool.name} is wider than its {trimmed(hole.diameter, 3)} mm",
        hole.feature,
        remedy="choose a drill of the hole's diameter",
    )


def _left(hole: PlannedHole, tool: Tool) -> list[Finding]:
    """Return what is to be said of the bottom that a drill leaves in a blind hole."""
    if hole.through:
        return []
    if hole.is_flat:
        if tool.point_length == 0.0:
            return []
        return [
            remark(
                "hole.floor",
                f"{hole.feature}: its flat floor is left {trimmed(tool.point_length, 2)} mm high at the rim by the drill's point",
                hole.feature,
                remedy="mill the floor after drilling",
            )
        ]
    if abs(tool.point_angle - hole.point_angle) <= SAME_ANGLE:
        return []
    return [
        remark(
            "hole.point",
            f"{hole.feature}: its point has {trimmed(hole.point_angle, 1)} degrees, the drill's {trimmed(tool.point_angle, 1)}: "
            "the cone at its bottom differs",
            hole.feature,
            remedy=f"add a drill of D {trimmed(hole.diameter, 3)} with that point to the tools folder, or accept it",
        )
    ]
