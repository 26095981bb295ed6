"""Which poses of a tool keep neck, shank and holder out of the blank: nothing is known to be gone there."""

from __future__ import annotations

import math
from collections.abc import Callable

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


def body_outside(
    tool: Tool, inward: Callable[[Floats], Floats]
) -> Callable[[Floats, Floats], Bools]:
    """Return the question at which tips and axes (k, 3) all that is above a tool's flutes stays outside of the blank, but for what is no
    wider than the cutter: that goes where this has been.

    `inward` says how deep below the blank's surface points (n, 3) lie, negative outside.
    """
    places = []
    for z0, r0, z1, r1 in tool.profile():
        if max(r0, r1) <= tool.radius:
            continue
        count = max(2, math.ceil((z1 - z0) / ALONG) + 1)
        places += [
            (z0 + s * (z1 - z0), r0 + s * (r1 - r0)) for s in np.linspace(0.0, 1.0, count).tolist()
        ]
    rings = np.array(places)
    turn = 2.0 * math.pi * np.arange(AROUND) / AROUND

    def outside(tip: Floats, axis: Floats) -> Bools:
        first = np.where(np.abs(axis[:, 2:]) < 0.9, [[0.0, 0.0, 1.0]], [[1.0, 0.0, 0.0]])
        x = first - (first * axis).sum(axis=1, keepdims=True) * axis
        x /= np.linalg.norm(x, axis=1, keepdims=True)
        y = np.cross(axis, x)
        found = np.ones(len(tip), dtype=bool)
        for z, r in rings.tolist():
            rows = np.flatnonzero(found)
            if not len(rows):
                break
            centre = tip[rows] + z * axis[rows]
            ring = (
                centre[:, None]
                + r * np.cos(turn)[:, None] * x[rows][:, None]
                + r * np.sin(turn)[:, None] * y[rows][:, None]
            )
            deep = inward(ring.reshape(-1, 3)).reshape(len(rows), AROUND)
            found[rows] = deep.max(axis=1) < -(tolerance.HOLDER_CLEARANCE + BODY_CLEARANCE)
        return found

    return outside
