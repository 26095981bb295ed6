"""Passes along the feet of upright walls: where a floor rises or falls along a wall no level ends at its foot, and the tip follows it.

The plan of a level's pass is that of the wall, whatever its height: brought down along it, the cutter comes to rest on the foot.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import shapely

from trunnion.geometry.arrays import Bools, Floats
from trunnion.model.tool import Tool
from trunnion.plan.freeform.cutters.cutter import lower_side
from trunnion.plan.freeform.drive import SurfaceDrive
from trunnion.progress import Progress
from trunnion.toolpath.contact_passes.passes import Pass
from trunnion.toolpath.contact_passes.upright.foot_heights import FOOT, OFF
from trunnion.toolpath.contact_passes.upright.tracing import follow

LEAST = 0.05
"""mm: a foot that is no farther under a level, or over the next one, has no pass of its own."""
BELOW = 2.0 * LEAST
"""mm under the next level: how far feet are looked for at all."""
STEEPEST = 1.0
"""Height over way in plan: where the foot is steeper, on its way to another floor, a pass ends."""


BESIDE = 0.1
"""mm in plan: a level's pass that is no farther from a position is its own."""


def foot_passes(
    passes: Sequence[Pass],
    levels: Floats,
    is_on_area: Callable[[Floats], Bools],
    drive: SurfaceDrive,
    tool: Tool,
    chord: float,
    progress: Progress,
) -> list[Pass]:
    """Return passes where feet lie between a level's pass and the next lower one, each as the tip follows them, within a chord error.

    `levels` (p,) are the heights of the tip upwards, the lowest one that of the lowest foot; a level may have no pass where its height is
    that of the foot, to a hair. `is_on_area` says which tips (k, 3) touch the area.
    """
    level = [int(np.abs(levels - p.tip[0, 2]).argmin()) for p in passes]
    over_others = [(p, n) for p, n in zip(passes, level, strict=True) if n > 0]
    if not over_others:
        return []
    off = OFF + 2.0 * chord
    lines = [p.tip[:, :2] + off * p.normal[:, :2] for p, _ in over_others]
    # Nobody asks for more than whether it is lower than the level, as on a wall that leans it hardly is, or than the next one, as over a
    # floor that lies deeper.
    raised = drive.allowance + FOOT
    highest = np.array([p.tip[0, 2] - LEAST for p, _ in over_others]) - drive.allowance
    lowest = np.array([levels[n - 1] - BELOW for _, n in over_others]) - raised
    followed = follow(
        drive.skin.drop,
        lower_side(tool, drive.allowance),
        lines,
        chord,
        lowest,
        progress,
        highest,
    )
    found: list[Pass] = []
    for (made, n), tips in zip(over_others, followed, strict=True):
        foot = tips + [0.0, 0.0, raised]
        over = foot[:, 2] - levels[n - 1]
        lower = [p for p, m in zip(passes, level, strict=True) if m == n - 1]
        wanted = (over > LEAST) | ((over > -LEAST) & ~_beside(foot, lower))
        wanted &= foot[:, 2] < made.tip[0, 2] - LEAST
        wanted[wanted] = is_on_area(foot[wanted])
        whole = made.closed and bool(wanted.all())
        found += [_pass(foot[rows], made, whole=whole) for rows in _runs(foot, wanted)]
    return found


def _beside(foot: Floats, passes: Sequence[Pass]) -> Bools:
    """Return which positions (k, 3) some passes go by in plan."""
    lines = shapely.union_all([shapely.LineString(p.tip[:, :2]) for p in passes])
    return np.asarray(shapely.dwithin(shapely.points(foot[:, :2]), lines, BESIDE))


def _runs(foot: Floats, wanted: Bools) -> list[slice]:
    """Return the runs of positions (k, 3) that are wanted (k,), ended where the foot is steep."""
    step = np.diff(foot, axis=0)
    flat = np.abs(step[:, 2]) <= STEEPEST * np.hypot(step[:, 0], step[:, 1])
    joined = wanted[1:] & wanted[:-1] & flat
    edges = np.flatnonzero(np.diff(joined.astype(np.int8), prepend=0, append=0)).reshape(-1, 2)
    return [slice(a, b + 1) for a, b in edges.tolist()]


def _pass(tips: Floats, level: Pass, *, whole: bool) -> Pass:
    """Return the pass of tips (k, 3) beside a wall, which a level's pass goes along too: its normals hold where it is nearest."""
    way = np.diff(tips[:, :2], axis=0)
    way /= np.maximum(np.hypot(way[:, 0], way[:, 1]), OFF)[:, None]
    before = np.vstack([way[-1:] if whole else way[:1], way])
    after = np.vstack([way, way[:1] if whole else way[-1:]])
    ahead = before + after
    long = np.hypot(ahead[:, 0], ahead[:, 1])
    ahead = np.where((long > OFF)[:, None], ahead / np.maximum(long, OFF)[:, None], after)
    return Pass(
        tip=tips,
        axis=np.broadcast_to(level.axis[0], (len(tips), 3)),
        normal=np.column_stack([-ahead[:, 1], ahead[:, 0], np.zeros(len(tips))]),
        closed=whole,
    )
