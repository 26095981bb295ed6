"""Which poses of a tool keep neck, shank and holder out of the blank: nothing is known to be gone there."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats
from trunnion.model.tool import Tool

AROUND = 8
"""Points on each circle of the body."""
ALONG = 3.0
"""mm between two circles, about."""
BODY_CLEARANCE = 0.5
"""mm that the body keeps from the blank, beside `tolerance.HOLDER_CLEARANCE`: points on it are so far from each other."""

Outside = Callable[[Floats, Floats], Bools]
"""From tips and axes (k, 3) to whether some of a tool is outside of the blank there."""


def body_outside(tool: Tool, inward: Callable[[Floats], Floats]) -> Outside:
    """Return the question at which tips and axes (k, 3) all that is above a tool's flutes stays outside of the blank, but for what is no
    wider than the cutter: that goes where this has been.

    `inward` says how deep below the blank's surface points (n, 3) lie, negative outside.
    """
    return _outside(_wider(tool), inward, tolerance.HOLDER_CLEARANCE + BODY_CLEARANCE)


def tool_outside(tool: Tool, inward: Callable[[Floats], Floats], clearance: float) -> Outside:
    """Return the question at which tips and axes (k, 3) all of a tool stays a clearance (mm) away from the blank."""
    flank = math.tan(math.radians(tool.taper_angle)) if tool.form == "taper" else 0.0
    top = tool.radius + flank * max(tool.flute_length - tool.corner_radius, 0.0)
    cutter = (0.0, tool.radius, tool.flute_length, top)
    return _outside([cutter, *_wider(tool)], inward, clearance)


def _wider(tool: Tool) -> list[tuple[float, float, float, float]]:
    return [row for row in tool.profile() if max(row[1], row[3]) > tool.radius]


def _outside(
    rows: Sequence[tuple[float, float, float, float]],
    inward: Callable[[Floats], Floats],
    clearance: float,
) -> Outside:
    positions = []
    for z0, r0, z1, r1 in rows:
        count = max(2, math.ceil((z1 - z0) / ALONG) + 1)
        positions += [
            (z0 + s * (z1 - z0), r0 + s * (r1 - r0)) for s in np.linspace(0.0, 1.0, count).tolist()
        ]
    # The widest circles are the first to meet the blank.
    rings = sorted(positions, key=lambda position: -position[1])
    turn = 2.0 * math.pi * np.arange(AROUND) / AROUND

    def outside(tip: Floats, axis: Floats) -> Bools:
        first = np.where(np.abs(axis[:, 2:]) < 0.9, [[0.0, 0.0, 1.0]], [[1.0, 0.0, 0.0]])
        x = first - (first * axis).sum(axis=1, keepdims=True) * axis
        x /= np.linalg.norm(x, axis=1, keepdims=True)
        y = np.cross(axis, x)
        found = np.ones(len(tip), dtype=bool)
        for z, r in rings:
            rows = np.flatnonzero(found)
            if not len(rows):
                break
            centre = tip[rows] + z * axis[rows]
            # A point's depth changes by no more than its way: the middle of a circle decides far from the blank's surface.
            deep = inward(centre)
            found[rows] = deep < -clearance
            close = np.flatnonzero(found[rows] & (deep >= -clearance - r))
            if not len(close):
                continue
            ring = (
                centre[close, None]
                + r * np.cos(turn)[:, None] * x[rows[close]][:, None]
                + r * np.sin(turn)[:, None] * y[rows[close]][:, None]
            )
            around = inward(ring.reshape(-1, 3)).reshape(len(close), AROUND)
            found[rows[close]] = around.max(axis=1) < -clearance
        return found

    return outside
