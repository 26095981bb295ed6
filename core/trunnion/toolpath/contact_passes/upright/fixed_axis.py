"""From contacts to the passes of an upright tool: put on its contacts, followed over the skin, and cut only where it touches the area.

The tool's path in plan is that of its tips on the contacts; its height is that of a drop on the whole part, so whatever other face is in
the path lifts it. Where it then touches nothing of the area any more, the pass is interrupted.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from trunnion.findings import Finding, warning
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.model.tool import Tool
from trunnion.plan.freeform.cutters.cutter import lower_side, tip_at
from trunnion.plan.freeform.drive import SurfaceDrive
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.toolpath.contact_passes.choices import HINDERED, TOO_STEEP
from trunnion.toolpath.contact_passes.contacts import Contacts
from trunnion.toolpath.contact_passes.passes import UPRIGHT, Pass
from trunnion.toolpath.contact_passes.upright.tracing import follow

SHORTEST = 0.05
"""mm: a shorter piece of a pass between two interruptions is left out."""
SMALLEST_LEFTOVER = 0.5
"""mm2: less than this is the rim of an area."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class UprightPasses:
    """Passes of an upright tool, the number (p,) of the contact pass that each is of, and how much of the contacts' way in mm was too
    steep, behind other faces, or in a hollow as round as the tool, which touches it all from one place."""

    passes: tuple[Pass, ...]
    source: tuple[int, ...]
    steep: float
    hidden: float
    unmoved: float

    def remaining_findings(
        self, drive: SurfaceDrive, tool: Tool, stepover: float
    ) -> tuple[Finding, ...]:
        """Return what was left, as areas: lengths times a stepover (mm)."""
        steep, hidden = self.steep * stepover, self.hidden * stepover
        unmoved = self.unmoved * stepover
        found = []
        if steep > SMALLEST_LEFTOVER:
            found.append(
                warning(
                    TOO_STEEP,
                    f"{drive.feature}: about {steep:.1f} mm2 are too steep for passes of {tool.name} "
                    "along contacts",
                    drive.feature,
                    remedy="cut them by waterlines or from another direction",
                )
            )
        if hidden > SMALLEST_LEFTOVER:
            found.append(
                warning(
                    HINDERED,
                    f"{drive.feature}: about {hidden:.1f} mm2 are out of reach of {tool.name}: other "
                    "faces are in its way",
                    drive.feature,
                    remedy="finish them with a smaller cutter or a leaning one",
                )
            )
        if unmoved > SMALLEST_LEFTOVER:
            found.append(
                warning(
                    "surface.no-way",
                    f"{drive.feature}: about {unmoved:.1f} mm2 are a hollow as round as {tool.name}, which touches them from one place "
                    "and has no way to go there",
                    drive.feature,
                    remedy="finish them with a smaller cutter",
                )
            )
        return tuple(found)


def upright_passes(
    contact_lines: Sequence[Contacts],
    drive: SurfaceDrive,
    tool: Tool,
    chord: float,
    steepest: float,
    progress: Progress = NO_PROGRESS,
) -> UprightPasses:
    """Return the passes of an upright tool over contacts of the drive's faces, in the cutting frame.

    What leans by more than `steepest` (radians) from level is left out: there a tip says little of where it touches.
    """
    runs, source = [], []
    for k, contacts in enumerate(contact_lines):
        for piece in _runs(contacts.normal[:, 2] >= math.cos(steepest), contacts.closed):
            runs.append(
                Contacts(
                    point=contacts.point[piece],
                    normal=contacts.normal[piece],
                    closed=contacts.closed and len(piece) == len(contacts),
                )
            )
            source.append(k)
    whole, kept = (sum(_length(w.point) for w in some) for some in (contact_lines, runs))
    tips = [
        tip_at(
            tool,
            w.point + drive.allowance * w.normal,
            w.normal,
            np.broadcast_to(UPRIGHT, w.point.shape),
        )
        for w in runs
    ]
    pieces, lowest = lower_side(tool, drive.allowance), float(drive.low[2]) - tool.flute_length
    followed = follow(
        drive.skin.drop, pieces, [t[:, :2] for t in tips], chord, lowest, progress.part(0.0, 0.7)
    )
    plan = np.concatenate([np.zeros((0, 2)), *(f[:, :2] for f in followed)])
    facet = drive.skin.drop.contacts(plan, pieces, lowest, progress.part(0.7, 0.95))[1]
    on_area = (facet >= 0) & drive.skin.of(drive.faces)[np.maximum(facet, 0)]
    passes, owner, begin = [], [], 0
    for contacts, tip, k, target in zip(runs, followed, source, tips, strict=True):
        on_faces, begin = on_area[begin : begin + len(tip)], begin + len(tip)
        tip = tip + drive.allowance * UPRIGHT
        normal = contacts.normal[cKDTree(target[:, :2]).query(tip[:, :2])[1]]
        for piece in _runs(on_faces, contacts.closed):
            if len(piece) > 1 and _length(tip[piece]) >= SHORTEST:
                passes.append(
                    Pass(
                        tip=tip[piece],
                        axis=np.broadcast_to(UPRIGHT, (len(piece), 3)),
                        normal=normal[piece],
                        closed=contacts.closed and len(piece) == len(tip),
                    )
                )
                owner.append(k)
    hidden = _lifted(tips, drive, pieces, lowest, 5.0 * chord)
    unmoved = sum(
        _length(w.point)
        for w, tip in zip(runs, tips, strict=True)
        if _length(tip) < SHORTEST <= _length(w.point)
    )
    return UprightPasses(
        passes=tuple(passes),
        source=tuple(owner),
        steep=whole - kept,
        hidden=hidden,
        unmoved=unmoved,
    )


def _lifted(
    tips: Sequence[Floats], drive: SurfaceDrive, pieces: Floats, lowest: float, error: float
) -> float:
    """Return over what length in mm tips (k, 3) on contacts can't stand, for another face would lift them by more than an error."""
    if not tips:
        return 0.0
    positions = np.concatenate(tips)
    lifted = (
        drive.skin.drop.drop(positions[:, :2], pieces, lowest) + drive.allowance
        > positions[:, 2] + error
    )
    line = np.repeat(np.arange(len(tips)), [len(t) for t in tips])
    both = lifted[1:] & lifted[:-1] & (line[1:] == line[:-1])
    return float(np.linalg.norm(np.diff(positions, axis=0), axis=1)[both].sum())


def _runs(wanted: Bools, closed: bool) -> list[Ints]:
    """Return the rows of each run of positions (k,) that are wanted; on a closed way, whose last place is its first one, a run may pass
    over where it begins."""
    if wanted.all():
        return [np.arange(len(wanted))]
    rows = np.arange(len(wanted))
    if closed:
        # Begin behind a position that isn't wanted, so that no run is torn.
        first = int(np.flatnonzero(~wanted[:-1])[0]) if not wanted[:-1].all() else 0
        rows = np.append(np.roll(rows[:-1], -first), first)
    ends = np.flatnonzero(np.diff(wanted[rows].astype(np.int8), prepend=0, append=0))
    return [rows[a:b] for a, b in ends.reshape(-1, 2).tolist() if b - a > 1]


def _length(points: Floats) -> float:
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())
