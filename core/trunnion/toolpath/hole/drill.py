"""Drills holes: one cycle each, by how deep it is, in a short tour."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from trunnion import tolerance
from trunnion.findings import Finding, remark
from trunnion.geometry.arrays import Floats
from trunnion.model.motion.cycle import BACK_OFF, Cycle, CycleKind
from trunnion.model.motion.drilling import drilled
from trunnion.model.motion.toolpath import Mark, Motion, Toolpath
from trunnion.model.operation import CuttingData
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.plan.holes.drive import SPOT, HoleDrive
from trunnion.plan.holes.hole import PlannedHole
from trunnion.plan.holes.settings import DrillSettings
from trunnion.plan.holes.tools import tip_of
from trunnion.progress import Progress
from trunnion.toolpath.contract import Planned, strategy
from trunnion.toolpath.motion.builder import PathBuilder
from trunnion.toolpath.motion.hole_access import kept_off
from trunnion.toolpath.motion.link import lowest_tip
from trunnion.toolpath.motion.tour import short_tour
from trunnion.toolpath.stock.heightfield import PlanningStock
from trunnion.units import trimmed

SAME_POINT = 0.5
"""Degrees: a drill's point that differs by less from the hole's own is the hole's."""


@dataclass(frozen=True, slots=True, kw_only=True)
class HoleCycle:
    """How one hole is drilled: the tip's lowest height and the height of the retract plane, mm."""

    hole: PlannedHole
    tip: float
    plane: float

    @property
    def over(self) -> Floats:
        """Where the axis meets the retract plane (3,)."""
        return np.array([self.hole.x, self.hole.y, self.plane])


@strategy(settings=DrillSettings, drive=HoleDrive, leaves=("hole.floor",))
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
    strokes: list[HoleCycle] = []
    findings: list[Finding] = []
    for hole in progress.each(drive.holes):
        tip = (
            spot_tip(hole, tool)
            if drive.kind == SPOT
            else tip_of(hole, tool, settings.breakthrough)
        )
        blocked = kept_off(builder, hole, tip)
        if blocked is not None:
            findings.append(blocked)
            continue
        plane = max(lowest_tip(builder, hole.position, hole.position), hole.top) + settings.safety
        strokes.append(HoleCycle(hole=hole, tip=tip, plane=min(plane, setup.clearance)))
        if drive.kind != SPOT:
            findings += _left(hole, tool)
    if not strokes:
        return Planned(findings=tuple(findings))
    order = short_tour(np.array([s.hole.position for s in strokes]), progress)
    return Planned(
        path=_path(builder, [strokes[k] for k in order], drive.kind == SPOT, settings),
        findings=tuple(findings),
    )


def spot_tip(hole: PlannedHole, tool: Tool) -> float:
    """Return how deep a spot drill's tip goes: its cone as wide as the hole, or as it is itself, where the hole begins."""
    return hole.top - tool.point_length * min(hole.diameter / tool.diameter, 1.0)


def cycle_of(depth: float, lift: float, deep: float, tool: Tool, settings: DrillSettings) -> Cycle:
    """Return the cycle of a hole: `depth` mm from the retract plane, `deep` mm in material, which decides by the diameter whether chips are
    broken, or brought out."""
    times = deep / tool.diameter
    peck = settings.peck * tool.diameter
    if times < min(settings.chip_break_from, settings.peck_from) or not BACK_OFF < peck < deep:
        return Cycle(kind=CycleKind.DRILL, depth=depth, lift=lift)
    kind = CycleKind.PECK if times >= settings.peck_from else CycleKind.CHIP_BREAK
    return Cycle(kind=kind, depth=depth, lift=lift, peck=peck)


def _path(
    builder: PathBuilder, strokes: Sequence[HoleCycle], spots: bool, settings: DrillSettings
) -> Toolpath:
    """Return the path from the clearance height over the first hole to that over the last.

    The tool stays as low between holes as stock and fixtures let it: on the retract planes where these are free from hole to hole, else on
    one level over all of the way, as cycles know it (G98).
    """
    level = max(s.plane for s in strokes)
    stays_low = True
    for a, b in pairwise(strokes):
        needed = lowest_tip(builder, a.hole.position, b.hole.position) + settings.safety
        stays_low = stays_low and needed <= max(a.plane, b.plane) + tolerance.COINCIDENT
        level = max(level, needed)
    level = min(level, builder.clearance)
    cycles = []
    for s in strokes:
        top = max(s.hole.top, _top_at(builder, s.hole))
        lift = 0.0 if stays_low else level - s.plane
        depth, deep = s.plane - s.tip, max(top - s.tip, 0.0)
        if spots:
            cycles.append(Cycle(kind=CycleKind.DRILL, depth=depth, lift=lift))
        else:
            cycles.append(cycle_of(depth, lift, deep, builder.tool, settings))
    first, last = strokes[0].hole.position, strokes[-1].hole.position
    path = drilled(
        np.append(first, level), np.array([s.over for s in strokes]), cycles, builder.data.feed
    )
    pieces = [path, _rapid(np.append(last, builder.clearance))]
    if builder.clearance > level + tolerance.SHORT_MOVE:
        pieces.insert(0, _rapid(np.append(first, builder.clearance)))
    return Toolpath.join(pieces)


def _top_at(builder: PathBuilder, hole: PlannedHole) -> float:
    """Return how high the stock stands on a hole's axis."""
    stock = builder.stock()
    return float(stock.height(hole.position, hole.position, stock.cell))


def _rapid(position: Floats) -> Toolpath:
    return Toolpath(
        position=position[None],
        axis=np.array([[0.0, 0.0, 1.0]]),
        motion=np.array([Motion.RAPID]),
        centre=np.full((1, 3), np.nan),
        feed=np.zeros(1),
        mark=np.array([Mark.RETRACT]),
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
    if abs(tool.point_angle - hole.point_angle) <= SAME_POINT:
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
