"""Countersinks holes: a cutter with the countersink's angle goes down until its cone is as wide at the mouth as is wanted, and waits."""

from __future__ import annotations

import numpy as np

from trunnion import tolerance
from trunnion.findings import Finding, warning
from trunnion.model.motion.cycle import Cycle, CycleKind
from trunnion.model.operation import CuttingData
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.plan.holes.drive import HoleDrive
from trunnion.plan.holes.hole import Countersink, PlannedHole
from trunnion.plan.holes.tools import SAME_ANGLE, ToolCone, cone_of, sink_tip
from trunnion.progress import Progress
from trunnion.settings import setting, settings
from trunnion.toolpath.contract import Planned, strategy
from trunnion.toolpath.motion.builder import PathBuilder
from trunnion.toolpath.motion.choices import safety
from trunnion.toolpath.motion.hole_access import kept_off
from trunnion.toolpath.motion.hole_cycles import HoleCycle, cycle_path, retract_plane
from trunnion.toolpath.motion.tour import short_tour
from trunnion.toolpath.stock.heightfield import PlanningStock
from trunnion.units import trimmed


@settings("hole.countersink")
class CountersinkSettings:
    """How holes are countersunk. Speed and feed come with the cutting data."""

    dwell: float = setting(
        0.2,
        unit="s",
        low=0.0,
        high=10.0,
        label="Dwell",
        help="How long the cutter waits at the bottom, so that the cone comes out round.",
    )
    safety: float = safety()


@strategy(settings=CountersinkSettings, drive=HoleDrive, own_faces=True)
def countersink(
    drive: HoleDrive,
    tool: Tool,
    data: CuttingData,
    stock: PlanningStock,
    setup: Setup,
    settings: CountersinkSettings,
    progress: Progress,
) -> Planned:
    """Return the cycles that countersink holes, and which cones the cutter can't make."""
    builder = PathBuilder(tool, data, stock, setup, settings.safety)
    cycles: list[HoleCycle] = []
    findings: list[Finding] = []
    for hole, sink in progress.each(list(zip(drive.holes, drive.sinks, strict=True))):
        cone = cone_of(tool)
        if cone is None or not _makes(cone, hole, sink):
            findings.append(
                warning(
                    "hole.other-cone",
                    f"{hole.feature}: {tool.name} does not make its countersink of D {trimmed(sink.diameter, 3)}, "
                    f"{trimmed(sink.angle, 1)} degrees",
                    hole.feature,
                    remedy="choose a countersink of that angle, at least as wide, with a tip that goes into the hole",
                )
            )
            continue
        tip = sink_tip(hole, sink, cone)
        stopped = kept_off(builder, hole, tip)
        if stopped is not None:
            findings.append(stopped)
            continue
        plane = retract_plane(builder, hole)
        kind = CycleKind.DWELL if settings.dwell > 0.0 else CycleKind.DRILL
        cycle = Cycle(kind=kind, depth=plane - tip, dwell=settings.dwell)
        cycles.append(HoleCycle(hole=hole, plane=plane, cycle=cycle))
    if not cycles:
        return Planned(findings=tuple(findings))
    order = short_tour(np.array([c.hole.position for c in cycles]), progress)
    return Planned(path=cycle_path(builder, [cycles[k] for k in order]), findings=tuple(findings))


def _makes(cone: ToolCone, hole: PlannedHole, sink: Countersink) -> bool:
    """Return whether a tool's cone makes a countersink: of its angle, as wide, and its tip goes into the hole."""
    return (
        abs(cone.angle - sink.angle) <= SAME_ANGLE
        and cone.wide >= sink.diameter - tolerance.COINCIDENT
        and cone.narrow <= hole.diameter + tolerance.COINCIDENT
    )
