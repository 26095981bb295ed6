"""Taps threads: one cycle each, in at the pitch a revolution and out with the spindle reversed, in a short tour."""

from __future__ import annotations

import numpy as np

from trunnion import tolerance
from trunnion.findings import Finding, warning
from trunnion.model.motion.cycle import Cycle, CycleKind
from trunnion.model.operation import CuttingData
from trunnion.model.setup import Setup
from trunnion.model.spindle import per_minute
from trunnion.model.tool import Tool
from trunnion.plan.holes.drive import HoleDrive, no_thread
from trunnion.plan.holes.finish_tools import is_tap_of, tap_tip, thread_end
from trunnion.plan.holes.hole import HoleThread, PlannedHole
from trunnion.plan.holes.settings import TapSettings
from trunnion.progress import Progress
from trunnion.toolpath.contract import Planned, strategy
from trunnion.toolpath.motion.builder import PathBuilder
from trunnion.toolpath.motion.hole_access import kept_off
from trunnion.toolpath.motion.hole_cycles import HoleCycle, cycle_path, retract_plane
from trunnion.toolpath.motion.tour import short_tour
from trunnion.toolpath.stock.heightfield import PlanningStock
from trunnion.units import trimmed


@strategy(settings=TapSettings, drive=HoleDrive, own_faces=True)
def tap(
    drive: HoleDrive,
    tool: Tool,
    data: CuttingData,
    stock: PlanningStock,
    setup: Setup,
    settings: TapSettings,
    progress: Progress,
) -> Planned:
    """Return the cycles that tap threads, and which threads the tap does not cut, or not as deep as is demanded."""
    builder = PathBuilder(tool, data, stock, setup, settings.safety)
    cycles: list[HoleCycle] = []
    findings: list[Finding] = []
    for hole, thread in progress.each(drive.threaded):
        if thread is None:
            findings.append(no_thread(hole))
            continue
        tip = tap_tip(hole, thread, tool, settings)
        stopped = _of_another_thread(hole, thread, tool) or kept_off(builder, hole, tip)
        if stopped is not None:
            findings.append(stopped)
            continue
        plane = max(retract_plane(builder, hole), hole.top + settings.start_pitches * thread.pitch)
        plane = min(plane, builder.clearance)
        cycle = Cycle(kind=CycleKind.TAP, depth=plane - tip, pitch=thread.pitch)
        cycles.append(HoleCycle(hole=hole, plane=plane, cycle=cycle))
        findings += _short(hole, thread, tip, tool)
    if not cycles:
        return Planned(findings=tuple(findings))
    order = short_tour(np.array([c.hole.position for c in cycles]), progress)
    path = cycle_path(
        builder, [cycles[k] for k in order], float(per_minute(tool.pitch, data.spindle))
    )
    return Planned(path=path, findings=tuple(findings))


def _of_another_thread(hole: PlannedHole, thread: HoleThread, tool: Tool) -> Finding | None:
    """Return the finding on a bore whose thread a tool does not cut."""
    if is_tap_of(tool, thread):
        return None
    return warning(
        "hole.other-thread",
        f"{hole.feature} is not tapped: {tool.name} does not cut D {trimmed(thread.diameter, 3)} with a pitch of "
        f"{trimmed(thread.pitch, 4)} mm",
        hole.feature,
        remedy="choose a tap of that diameter and pitch",
    )


def _short(hole: PlannedHole, thread: HoleThread, tip: float, tool: Tool) -> list[Finding]:
    """Return what is to be said of a thread that ends higher than is demanded."""
    end = thread_end(hole, tip, tool)
    if thread.depth <= 0.0 or end >= thread.depth - tolerance.SEW:
        return []
    return [
        warning(
            "hole.thread-depth",
            f"{hole.feature}: its thread is full to {trimmed(max(end, 0.0), 2)} of {trimmed(thread.depth, 2)} mm, "
            f"the bore's bottom and the tap's lead of {trimmed(tool.lead, 2)} mm stop it",
            hole.feature,
            remedy="choose a tap with a shorter lead, or demand a shorter thread",
        )
    ]
