"""Bores brought to their size along their axes by reamers or boring bars: one cycle each, in and out at the feed, in a short tour."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from trunnion import tolerance
from trunnion.findings import Finding, remark, warning
from trunnion.model.motion.cycle import Cycle
from trunnion.model.motion.toolpath import Toolpath
from trunnion.model.tool import Tool
from trunnion.plan.holes.drive import HoleDrive
from trunnion.plan.holes.finish_tools import finish_tip
from trunnion.plan.holes.hole import PlannedHole
from trunnion.progress import Progress
from trunnion.toolpath.motion.builder import PathBuilder
from trunnion.toolpath.motion.hole_access import kept_off
from trunnion.toolpath.motion.hole_cycles import HoleCycle, cycle_path, retract_plane
from trunnion.toolpath.motion.tour import short_tour
from trunnion.units import trimmed


class CycleOfDepth(Protocol):
    """Returns the cycle of a bore that is `depth` mm deep from the retract plane."""

    def __call__(self, depth: float) -> Cycle: ...


def finished_bores(
    builder: PathBuilder,
    drive: HoleDrive,
    breakthrough: float,
    cycle_of: CycleOfDepth,
    progress: Progress,
) -> tuple[Toolpath | None, tuple[Finding, ...]]:
    """Return the path that brings bores to size, None where there is none, and which bores the tool does not make, or not to their ends.

    `breakthrough` is how far (mm) the tool's full diameter goes on past the end of a through hole.
    """
    tool = builder.tool
    cycles: list[HoleCycle] = []
    findings: list[Finding] = []
    for hole in progress.each(drive.holes):
        tip = finish_tip(hole, tool, breakthrough)
        stopped = _of_another_size(hole, tool) or kept_off(builder, hole, tip)
        if stopped is not None:
            findings.append(stopped)
            continue
        plane = retract_plane(builder, hole)
        cycles.append(HoleCycle(hole=hole, plane=plane, cycle=cycle_of(depth=plane - tip)))
        findings += _left(hole, tool)
    if not cycles:
        return None, tuple(findings)
    order = short_tour(np.array([c.hole.position for c in cycles]), progress)
    return cycle_path(builder, [cycles[k] for k in order]), tuple(findings)


def _of_another_size(hole: PlannedHole, tool: Tool) -> Finding | None:
    """Return the finding on a bore that a tool does not make to its size."""
    if abs(tool.diameter - hole.diameter) <= tolerance.SEW:
        return None
    return warning(
        "hole.other-size",
        f"{hole.feature} is not brought to size: {tool.name} makes D {trimmed(tool.diameter, 3)}, the bore has D "
        f"{trimmed(hole.diameter, 3)}",
        hole.feature,
        remedy="choose a tool of the bore's diameter",
    )


def _left(hole: PlannedHole, tool: Tool) -> list[Finding]:
    """Return what is to be said of the end of a blind bore that a tool's lead does not make to size."""
    if hole.through or tool.lead <= 0.0:
        return []
    return [
        remark(
            "hole.finished-depth",
            f"{hole.feature} is to size for {trimmed(hole.depth - tool.lead, 2)} of its {trimmed(hole.depth, 2)} mm: "
            f"the lead of {tool.name} takes {trimmed(tool.lead, 2)} mm",
            hole.feature,
            remedy="accept it, or demand the fit of a part that lets the tool go on",
        )
    ]
