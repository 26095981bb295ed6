"""Passes along the contour that a tool reaches: the whole of finishing, and the end of roughing."""

from __future__ import annotations

import math

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from trunnion.model.motion.toolpath import Mark
from trunnion.plan.turning.contour_spans import contour_spans, stock_after
from trunnion.plan.turning.reach import DEEP, TurningReach, touching
from trunnion.toolpath.turning_passes.passes import TurningPath

CONTACT_DEPTH = 1e-3
"""mm: stock that the insert enters by less than this is only touched."""


def contour_passes(
    path: TurningPath,
    reach: TurningReach,
    stock: BaseGeometry,
    clearance: float,
    bridge: float,
    most: float = math.inf,
) -> None:
    """Follow the contour wherever stock (u, v) stands on it, no more than `most` mm thick.

    Each stretch is come to from away from the work and left the same way: such moves are clear of the part wherever the contour is.
    """
    for piece in contour_spans(reach, stock, bridge=bridge, beyond=clearance, most=most):
        (u, v), end = piece[0].tolist(), piece[-1]
        if path.here is not None:
            path.rapid(path.here[0], path.away)
        path.rapid(u, path.away)
        path.rapid(u, min(path.away, _stock_above(reach, stock, (u, v), path.away) + clearance))
        path.feed(u, v, Mark.LEAD)
        path.contour(piece)
        stock = stock_after(reach, stock, [piece])
        back = np.array([end, end + [-clearance, clearance]])
        if reach.is_clear(back):
            path.feed(float(back[1, 0]), float(back[1, 1]), Mark.LEAD)
        u, v = path.here if path.here is not None else tuple(end.tolist())
        top = _stock_above(reach, stock, (u, v), path.away)
        path.feed(u, min(path.away, top + clearance), Mark.LEAD)
        path.rapid(u, path.away)


def _stock_above(
    reach: TurningReach, stock: BaseGeometry, point: tuple[float, float], away: float
) -> float:
    """Return how high above a position the insert still touches stock as it is lifted straight away from the work, or its own height."""
    u, v = point
    near = stock.buffer(-CONTACT_DEPTH).intersection(
        shapely.box(u - reach.size, -DEEP, u + reach.size, DEEP)
    )
    if near.is_empty or away <= v:
        return v
    met = shapely.LineString([(u, v), (u, away)]).intersection(touching(near, reach.coarse))
    return v if met.is_empty else float(met.bounds[3])
