"""The cutter with shank and holder as the proof sees it: convex bodies of revolution stacked along the axis.

The proof keeps its own cutter forms, apart from those that toolpaths are planned with: a shared one would hide a shared fault.
"""

from __future__ import annotations

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Floats
from trunnion.model.tool import Tool

PIECE_COLUMNS = 7


def pieces_of(tool: Tool) -> Floats:
    """Return the convex pieces of a tool (k, 7): form, radius low, radius high, z low, z high, free face below, free face above.

    Row 0 is the fluted cutter (form 0, its radius and corner radius); the others are truncated cones (form 1). A piece has a free face
    where its neighbour is thinner. Heights are from the tip, mm.
    """
    cones = [row for row in tool.profile() if row[2] - row[0] > tolerance.PARAMETRIC]
    below = [tool.radius, *(row[3] for row in cones)]
    above = [*(row[1] for row in cones[1:]), 0.0]
    rows = [(0.0, tool.radius, tool.corner_radius, 0.0, tool.flute_length, 0.0, 0.0)]
    for (z0, r0, z1, r1), under, over in zip(cones, below, above, strict=False):
        rows.append((1.0, r0, r1, z0, z1, float(r0 > under + tolerance.PARAMETRIC), float(r1 > over + tolerance.PARAMETRIC)))
    return np.array(rows)


def widest(pieces: Floats) -> float:
    """Return the largest radius of a tool's pieces."""
    return float(np.where(pieces[:, 0] == 0.0, pieces[:, 1], np.maximum(pieces[:, 1], pieces[:, 2])).max())


def lowest_height(tool: Tool, rho: Floats) -> Floats:
    """Return how high above the tip the fluted cutter begins at distances from the axis; infinite outside of it."""
    inner = tool.radius - tool.corner_radius
    out = np.clip(np.asarray(rho) - inner, 0.0, None)
    height = tool.corner_radius - np.sqrt(np.clip(tool.corner_radius**2 - out**2, 0.0, None))
    return np.where(np.asarray(rho) <= tool.radius, height, np.inf)
