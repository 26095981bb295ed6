"""Mills threads: helices about the bore's axis from the thread's lower end up, a pitch a turn, entered and left on half circles."""

from __future__ import annotations

import math

import numpy as np

from trunnion import tolerance
from trunnion.findings import Finding, warning
from trunnion.geometry.arrays import Floats
from trunnion.model.motion.toolpath import Mark
from trunnion.model.operation import CuttingData
from trunnion.model.setup import Setup
from trunnion.model.tool import THREAD_MILL, Tool
from trunnion.model.tool.thread_mill import groove_depth
from trunnion.plan.holes.drive import HoleDrive, no_thread
from trunnion.plan.holes.hole import HoleThread, PlannedHole
from trunnion.plan.holes.settings import ThreadMillSettings
from trunnion.plan.holes.thread_mills import (
    LEAD_RISE,
    ThreadHelix,
    full_depth,
    helix_of,
    mills_thread,
)
from trunnion.progress import Progress
from trunnion.toolpath.contract import Planned, strategy
from trunnion.toolpath.motion.builder import PathBuilder
from trunnion.toolpath.motion.feed import arc_feed
from trunnion.toolpath.motion.hole_access import kept_off
from trunnion.toolpath.motion.link import travel
from trunnion.toolpath.motion.tour import short_tour
from trunnion.toolpath.stock.heightfield import PlanningStock
from trunnion.units import trimmed

PASS_SLACK = 1e-3
"""Of a pass: what a width that was rounded may ask for more, without another pass."""


@strategy(settings=ThreadMillSettings, drive=HoleDrive, own_faces=True)
def thread_mill(
    drive: HoleDrive,
    tool: Tool,
    data: CuttingData,
    stock: PlanningStock,
    setup: Setup,
    settings: ThreadMillSettings,
    progress: Progress,
) -> Planned:
    """Return the helices that mill threads, and which threads the tool does not cut, or not as deep as is demanded."""
    builder = PathBuilder(tool, data, stock, setup, settings.safety)
    findings: list[Finding] = []
    order = short_tour(np.array([h.position for h in drive.holes]), progress)
    for row in progress.each(order):
        hole, thread = drive.threaded[row]
        if thread is None:
            findings.append(no_thread(hole))
            continue
        stopped = _of_another_thread(hole, thread, tool)
        if stopped is None:
            helix = helix_of(hole, thread, tool, settings)
            stopped = kept_off(builder, hole, helix.lowest, helix.radius)
        if stopped is not None:
            findings.append(stopped)
            continue
        for radius in pass_radii(helix, tool, data.width):
            _pass(builder, hole.position, helix, radius)
        findings += _short(hole, thread, helix, tool)
    return Planned(path=builder.finished(), findings=tuple(findings))


def pass_radii(helix: ThreadHelix, tool: Tool, width: float) -> list[float]:
    """Return the radii in mm of the passes of a helix, its own last; `width` is how deep the first may go.

    Pass k of n goes sqrt(k / n) of the groove's depth t: its section grows with the square of that, so each pass takes about as much.
    n is the least with t / sqrt(n) within the width.
    """
    depth = groove_depth(tool, helix.pitch)
    n = max(math.ceil((depth / width) ** 2 - PASS_SLACK), 1)
    return [helix.radius - depth * (1.0 - math.sqrt(k / n)) for k in range(1, n + 1)]


def _pass(builder: PathBuilder, centre: Floats, helix: ThreadHelix, radius: float) -> None:
    """Go down on the axis and mill the thread to a depth, from its lower end up; end on the axis."""
    tool, feed = builder.tool, builder.data.feed
    side, other = (centre + np.array([s * radius, 0.0]) for s in (1.0, -1.0))
    middle = 0.5 * (centre + side)
    # The tips of the teeth keep the feed: the tool's axis goes slower on its smaller circle.
    around = arc_feed(feed, radius, tool.radius, math.pi)
    rise = LEAD_RISE * helix.pitch
    # Turns that follow each other without a step between make one helix.
    apart = helix.step > helix.pitch + tolerance.COINCIDENT
    travel(builder, centre, helix.lowest)
    for turn in range(helix.turns):
        low = helix.start + turn * helix.step
        high = low + helix.pitch
        if apart or turn == 0:
            builder.line((*centre, low - rise), feed, Mark.LINK)
            builder.arc((*side, low), middle, math.pi, around, Mark.ENTRY)
        builder.arc((*other, 0.5 * (low + high)), centre, math.pi, around, Mark.CUT)
        builder.arc((*side, high), centre, math.pi, around, Mark.CUT)
        if apart or turn == helix.turns - 1:
            builder.arc((*centre, high + rise), middle, math.pi, around, Mark.LEAD)


def _of_another_thread(hole: PlannedHole, thread: HoleThread, tool: Tool) -> Finding | None:
    """Return the finding on a bore whose thread a tool does not mill."""
    if tool.form == THREAD_MILL and mills_thread(tool, hole, thread):
        return None
    return warning(
        "hole.other-thread",
        f"{hole.feature} is not milled: {tool.name} does not cut D {trimmed(thread.diameter, 3)} with a pitch of "
        f"{trimmed(thread.pitch, 4)} mm, or does not get into its bore",
        hole.feature,
        remedy="choose a thread mill of that pitch that is thinner than the bore",
    )


def _short(hole: PlannedHole, thread: HoleThread, helix: ThreadHelix, tool: Tool) -> list[Finding]:
    """Return what is to be said of a thread that ends higher than is demanded."""
    end = full_depth(hole, helix, tool)
    if thread.depth <= 0.0 or end >= thread.depth - tolerance.SEW:
        return []
    return [
        warning(
            "hole.thread-depth",
            f"{hole.feature}: its thread is full to {trimmed(max(end, 0.0), 2)} of {trimmed(thread.depth, 2)} mm, "
            f"the bore's bottom stops {tool.name}",
            hole.feature,
            remedy="choose a thread mill with a shorter tooth, or demand a shorter thread",
        )
    ]
