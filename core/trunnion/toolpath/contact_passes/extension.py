"""Passes that run on past a free rim: straight along the face's tangent there, where the cutter leaves the part behind.

A rim is free where the cutter, brought past it by its own radius and the extension, finds nothing for a radius below it: the rim of open
faces, or an edge of a solid that is higher than the radius. At the border between two areas the part goes on, and the pass ends there.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats
from trunnion.model.tool import Tool
from trunnion.plan.clearance import ClearanceQuery
from trunnion.plan.freeform.cutters.cutter import lower_side
from trunnion.plan.freeform.drive import SurfaceDrive
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.toolpath.contact_passes.passes import UPRIGHT, Pass

TESTED = 8
"""Positions along an extension at which the cutter has to be clear."""
LEAST_RUN = 0.05
"""mm: a pass runs at least as far from its end to where its direction there is taken from: the very last move may be a thousandth long."""


def extended(
    passes: Sequence[Pass],
    drive: SurfaceDrive,
    tool: Tool,
    query: ClearanceQuery | None = None,
    progress: Progress = NO_PROGRESS,
) -> list[Pass]:
    """Return passes with those ends that lie at a free rim run on by `drive.extension` mm; closed passes have no ends.

    `query` says which straight moves of a leaning tool are clear; without it leaning passes stay as they are.
    """
    if drive.extension <= 0.0 or not passes:
        return list(passes)
    ends = [_tangent(p, at_end=at_end) for p in passes for at_end in (False, True)]
    tip = np.array([p.tip[row] for p in passes for row in (0, -1)])
    axis = np.array([p.axis[row] for p in passes for row in (0, -1)])
    along = np.array([np.zeros(3) if e is None else e for e in ends])
    has_end = along.any(axis=1)
    upright = np.abs(axis - UPRIGHT).max(axis=1) < tolerance.COINCIDENT
    longer = np.zeros(len(tip), dtype=bool)
    wanted = has_end & _is_free(tip, along, drive, tool, progress.part(0.0, 0.4))
    if (rows := np.flatnonzero(wanted & upright)).size:
        longer[rows] = _is_clear(tip[rows], along[rows], drive, tool, progress.part(0.4, 1.0))
    if query is not None and (rows := np.flatnonzero(wanted & ~upright)).size:
        further = tip[rows] + drive.extension * along[rows]
        longer[rows] = query(further, axis[rows], start_tip=tip[rows], start_axis=axis[rows])
    beyond = tip + drive.extension * along
    return [
        _with_ends(p, beyond[2 * k : 2 * k + 2], longer[2 * k : 2 * k + 2])
        for k, p in enumerate(passes)
    ]


def _tangent(one: Pass, *, at_end: bool) -> Floats | None:
    """Return the unit direction (3,) in which a pass leaves the area at an end, tangent to the face; None where it has no end."""
    if one.closed or len(one) < 2:
        return None
    tip, normal = (one.tip[::-1], one.normal[-1]) if at_end else (one.tip, one.normal[0])
    away = tip[0] - tip
    far = np.flatnonzero(np.linalg.norm(away, axis=1) >= LEAST_RUN)
    if not len(far):
        return None
    along = away[far[0]] - (away[far[0]] @ normal) * normal
    size = float(np.linalg.norm(along))
    return np.asarray(along / size) if size > tolerance.COINCIDENT else None


def _is_free(
    tip: Floats, along: Floats, drive: SurfaceDrive, tool: Tool, progress: Progress
) -> Bools:
    """Return at which tips (n, 3) the part ends: past the extension the cutter would fall by more than its radius."""
    past = tip + (drive.extension + tool.radius) * along
    return np.asarray(_floor(past, drive, tool, progress) < past[:, 2] - tool.radius)


def _is_clear(
    tip: Floats, along: Floats, drive: SurfaceDrive, tool: Tool, progress: Progress
) -> Bools:
    """Return along which extensions an upright cutter stays off the part."""
    run = np.linspace(0.0, drive.extension, TESTED + 1)[1:]
    at = tip[:, None] + run[:, None] * along[:, None]
    floor = _floor(at.reshape(-1, 3), drive, tool, progress).reshape(len(tip), TESTED)
    return np.asarray((floor + drive.allowance <= at[:, :, 2] + tolerance.SHORT_MOVE).all(axis=1))


def _floor(position: Floats, drive: SurfaceDrive, tool: Tool, progress: Progress) -> Floats:
    """Return the heights (n,) of the tip of an upright cutter that is dropped on the part at positions (n, 3)."""
    lowest = float(drive.low[2]) - tool.flute_length
    return np.asarray(
        drive.skin.drop.drop(position[:, :2], lower_side(tool, drive.allowance), lowest, progress)
    )


def _with_ends(one: Pass, beyond: Floats, longer: Bools) -> Pass:
    """Return a pass with further tips (2, 3) before its first and after its last, where it becomes longer (2,)."""
    if not longer.any():
        return one
    first, last = ((0,) if longer[0] else ()), ((-1,) if longer[1] else ())
    tip = np.vstack([*(beyond[r] for r in first), one.tip, *(beyond[r] for r in last)])
    rows = [*first, *range(len(one)), *(len(one) + r for r in last)]
    return Pass(tip=tip, axis=one.axis[rows], normal=one.normal[rows])
