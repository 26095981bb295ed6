"""The stock that a turning path leaves: its meridian without what the insert has swept."""

from __future__ import annotations

import math

import numpy as np
import shapely

from trunnion.geometry.arrays import Floats
from trunnion.geometry.frame import Frame
from trunnion.model.blank import Revolved
from trunnion.model.motion.toolpath import Motion, Toolpath
from trunnion.model.tool import TurningTool
from trunnion.plan.turning.meridian import meridian_in, turned_to
from trunnion.plan.turning.reach import NOSE_CHORD, swept_along


def turned_by(blank: Revolved, frame: Frame, path: Toolpath, tool: TurningTool) -> Revolved:
    """Return what a path in a setup's frame leaves of a blank of revolution about its z."""
    insert = tool.insert_profile(NOSE_CHORD)
    start, sweep = path.starts()[:, [0, 2]], path.sweeps()
    parts = [
        swept_along(
            insert,
            _points(start[k], path.position[k, [0, 2]], path.centre[k, [0, 2]], float(sweep[k])),
        )
        for k in np.flatnonzero(path.motion != Motion.RAPID)
    ]
    if not parts:
        return blank
    left = meridian_in(blank, frame).difference(shapely.union_all(parts))
    return turned_to(blank, frame, left)


def _points(start: Floats, end: Floats, centre: Floats, sweep: float) -> Floats:
    """Return points (k, 2) of x and z along a block: a line, or an arc that turns from z to x where its sweep (rad) is above 0."""
    if sweep == 0.0:
        return np.stack([start, end])
    x, z = start - centre
    radius = math.hypot(x, z)
    step = 2.0 * math.acos(max(1.0 - NOSE_CHORD / max(radius, NOSE_CHORD), -1.0))
    angle = math.atan2(x, z) + np.linspace(0.0, sweep, max(2, math.ceil(abs(sweep) / step) + 1))
    return np.asarray(centre + radius * np.column_stack([np.sin(angle), np.cos(angle)]))
