"""How far a tip that triangles block has to go along a direction, at its height, until none does. Plain reference: each
triangle that blocks it is gone past by halving drops on that one alone, until none is left.

The height that a triangle lifts a tip to is concave along a line: what it blocks is one interval. mm, tool axis +z.
"""

from __future__ import annotations

import numpy as np

from trunnion.geometry.arrays import Bools, Floats
from trunnion.geometry.kernels.cutter_contact.drop_cutter import drop_cutter

HALVINGS = 40


def free_run(
    start: Floats, direction: Floats, height: Floats, most: Floats, corners: Floats, pieces: Floats
) -> tuple[Floats, Bools]:
    """Return how far (n,) tips at plan points (n, 2) and heights (n,) go along unit directions (n, 2) until no triangle (t, 3, 3) blocks
    them, and whether they were blocked and come free within distances (n,); 0 where not."""
    out, found = np.zeros(len(start)), np.zeros(len(start), dtype=bool)
    for n, z in enumerate(height):

        def blocks(triangle: Floats, at: float, n: int = n, z: float = z) -> bool:
            """Return whether one triangle (3, 3) lifts the tip that has gone so far."""
            plan = (start[n] + at * direction[n])[None]
            return bool(drop_cutter(plan, triangle[None], pieces, z)[0] > z)

        at = 0.0
        while at < most[n]:
            blocking = next((t for t in corners if blocks(t, at)), None)
            if blocking is None:
                found[n] = at > 0.0
                break
            low, high = at, float(most[n])
            if blocks(blocking, high):
                break
            for _ in range(HALVINGS):
                middle = 0.5 * (low + high)
                low, high = (middle, high) if blocks(blocking, middle) else (low, middle)
            at = high
        out[n] = at if found[n] else 0.0
    return out, found
