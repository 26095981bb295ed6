"""Push-cutter: between which positions along a line a cutter's tip is blocked by triangles. Plain
reference, by dropping it there.

A line runs along x at (y, z). The cutter is the graph of its lower side, as in `kernels/drop_cutter.py`,
and extends upwards for ever. Its tip is blocked where it would have to stand higher: what a
triangle blocks is one interval, since the height that it lifts the tip to is concave along the
line. mm, tool axis +z (the push-cutter of opencamlib).
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from trunnion.geometry.arrays import Floats
from trunnion.geometry.kernels.cutter_contact.drop_cutter import HALVINGS, RHO1, drop_cutter

SAMPLES, REFINEMENTS = 21, 12
"""Positions along a line that are searched for the highest one, and how often they are drawn closer round it."""
NOWHERE = -1e9
"""mm: how low a cutter falls that meets nothing."""


def push_cutter(lines: Floats, corners: Floats, pieces: Floats) -> Floats:
    """Return the intervals of x in which each triangle (t, 3, 3) blocks the tip along lines (n, 2) of
    y and z: (n, t, 2), NaN where it doesn't."""
    out = np.full((len(lines), len(corners), 2), np.nan)
    for n, (y, z) in enumerate(lines):
        for t, triangle in enumerate(corners):
            out[n, t] = _triangle_interval(triangle[None], float(y), float(z), pieces)
    return out


def _triangle_interval(triangle: Floats, y: float, z: float, pieces: Floats) -> tuple[float, float]:
    """Return the interval in which one triangle (1, 3, 3) blocks the line.

    A grid drawn closer round the highest position finds a blocked one, if there is any; then bisection
    of both ends.
    """

    def height(x: Floats) -> Floats:
        """Return the tip's height over the triangle at positions x (n,) of the line."""
        return drop_cutter(np.column_stack([x, np.full(len(x), y)]), triangle, pieces, NOWHERE)

    radius = pieces[-1, RHO1]
    # Beyond a radius from the triangle nothing is blocked.
    low, high = float(triangle[..., 0].min()) - radius, float(triangle[..., 0].max()) + radius
    a, b = low, high
    # Concave in x: the highest of the grid and its neighbours bracket the maximum.
    for _ in range(REFINEMENTS):
        x = np.linspace(a, b, SAMPLES)
        top = height(x)
        k = int(np.argmax(top))
        # A blocked position splits the search: one end of the interval on either side of it.
        if top[k] >= z:
            return _bisect_end(height, z, float(x[k]), low), _bisect_end(
                height, z, float(x[k]), high
            )
        a, b = x[max(k - 1, 0)], x[min(k + 1, SAMPLES - 1)]
    return np.nan, np.nan


def _bisect_end(
    height: Callable[[Floats], Floats], z: float, inside: float, outside: float
) -> float:
    """Return the last blocked x between a blocked position and a free one, by bisection to the last
    digit."""
    for _ in range(HALVINGS):
        middle = 0.5 * (inside + outside)
        if middle in (inside, outside):
            break
        if height(np.array([middle]))[0] >= z:
            inside = middle
        else:
            outside = middle
    return inside
