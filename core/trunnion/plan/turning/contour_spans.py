"""The stretches of a contour along which a turning tool passes: where stock stands on it, and no more of it than the pass bears."""

from __future__ import annotations

import math
from collections.abc import Sequence

import shapely
from shapely.geometry.base import BaseGeometry
from shapely.ops import substring

from trunnion import tolerance
from trunnion.geometry.arrays import Floats
from trunnion.plan.turning.reach import TurningReach, swept_along, touching

THIN = 0.02
"""mm: stock thinner than this all along is not worth a pass."""
SHORTEST = 5.0
"""mm: a stretch beside thick stock that is shorter is left with it."""

Span = tuple[float, float]


def contour_spans(
    reach: TurningReach,
    stock: BaseGeometry,
    *,
    bridge: float,
    beyond: float,
    most: float = math.inf,
) -> list[Floats]:
    """Return the stretches (k, 2) of a reach's ceiling, u growing, along which its insert cuts stock (u, v).

    Gaps up to `bridge` mm between them are passed over, and each is `beyond` mm longer at both ends. None goes where the insert would be
    more than `most` mm deep in stock.
    """
    way, thick = reach.allowed_ceiling(), stock.buffer(-0.5 * THIN)
    if len(way) < 2 or thick.is_empty:
        return []
    line = shapely.LineString(way)
    spans = _joined(_spans(line, touching(thick, reach.coarse)), bridge)
    spans = _joined(
        [(max(0.0, low - beyond), min(line.length, high + beyond)) for low, high in spans], 0.0
    )
    deep = shapely.Polygon() if math.isinf(most) else stock.buffer(-most)
    if not deep.is_empty:
        barred = _joined(_spans(line, touching(deep, reach.coarse)), 0.0)
        ends = {end for span in barred for end in span}
        spans = [
            (low, high)
            for low, high in _without(spans, barred)
            if high - low >= SHORTEST or not ends & {low, high}
        ]
    pieces = [shapely.get_coordinates(substring(line, low, high)) for low, high in spans]
    return [p for p in pieces if len(p) > 1]


def stock_after(
    reach: TurningReach, stock: BaseGeometry, stretches: Sequence[Floats]
) -> BaseGeometry:
    """Return what passes along stretches leave of stock, both as u and v."""
    for way in stretches:
        stock = stock.difference(swept_along(reach.coarse, way))
    return stock


def _spans(line: shapely.LineString, where: BaseGeometry) -> list[Span]:
    """Return from where to where along a line it lies in an area, in order."""
    found = []
    for part in shapely.get_parts(line.intersection(where)):
        if part.geom_type == "LineString" and not part.is_empty:
            ends = [line.project(shapely.Point(part.coords[k])) for k in (0, -1)]
            found.append((min(ends), max(ends)))
    return sorted(found)


def _joined(spans: Sequence[Span], gap: float) -> list[Span]:
    """Return spans in order, those with no more than a gap between them as one."""
    found: list[Span] = []
    for low, high in spans:
        if found and low - found[-1][1] <= gap:
            found[-1] = (found[-1][0], max(found[-1][1], high))
        else:
            found.append((low, high))
    return found


def _without(spans: Sequence[Span], barred: Sequence[Span]) -> list[Span]:
    """Return spans without others, both in order and apart."""
    found: list[Span] = []
    for low, high in spans:
        for first, last in barred:
            if first >= high or last <= low:
                continue
            if first > low + tolerance.SHORT_MOVE:
                found.append((low, first))
            low = max(low, last)
        if high > low + tolerance.SHORT_MOVE:
            found.append((low, high))
    return found
