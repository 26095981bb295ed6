"""Trims passes to where stock is before the cutter: what is left out of a pass would be air.

A pass engages where the front half of the cutter's rim, seen along the feed, touches material: what lies behind that half the pass itself
has cut already. So a pass begins a radius before the material, and ends where the front has run out of it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trunnion.geometry.arrays import Bools, Floats
from trunnion.geometry.plane.curve import Curve
from trunnion.geometry.plane.curve_parts import points_along
from trunnion.geometry.plane.region import Region
from trunnion.toolpath.motion.builder import PathBuilder
from trunnion.toolpath.stock.heightfield import PlanningStock
from trunnion.units import SECONDS_PER_MINUTE

MARGIN = 0.5
"""mm that a pass begins before and ends after the positions where it engages."""

WORTH = 0.1
"""mm: stock that stands no higher over a pass is not worth it."""

GRAZE = 0.5
"""Cells of the stock that a roughing pass may leave to the next one: what is known of an edge that goes through cells is no better."""

LINK = 0.4
"""s that a lift, a short rapid and a descent take, most of it in the ramps of the axes: gaps that are fed through in less stay."""


@dataclass(frozen=True, slots=True, eq=False)
class PassTrimming:
    """Trims the passes of one layer: the cells (nx, ny) of the stock that are to go, the height over which what is counts, and how deep
    in mm the cutter's side has to enter it to count. The heights of these cells alone are looked at."""

    wanted: Bools
    z: float
    graze: float = 0.0

    @staticmethod
    def of(builder: PathBuilder, area: Region, z: float, graze: float = 0.0) -> PassTrimming:
        """Return the trimming of a layer for the stock in an area that is higher than `z` before its first pass; what a pass would enter
        by less than `graze` cells is left to the next one."""
        stock = builder.stock()
        return PassTrimming(stock.cells_above(z, area), z, graze * stock.cell)

    def parts(self, builder: PathBuilder, curve: Curve) -> list[Curve]:
        """Return the parts of a pass on which the stock, as the path so far leaves it, is before the cutter; the curve itself when
        that is everywhere or all gaps are short."""
        stock, tool = builder.stock(), builder.tool
        s, points = points_along(curve, stock.cell)
        seg = curve.segments()
        ends = np.cumsum(seg.length)
        rows = np.minimum(np.searchsorted(ends, s, side="right"), len(seg) - 1)
        along = seg.directions(rows, s - (ends[rows] - seg.length[rows]))
        engaged = self._meets(stock, points, along, tool.radius - self.graze)
        if engaged.all():
            return [curve]
        if not engaged.any():
            return []
        gap = LINK * builder.data.feed / SECONDS_PER_MINUTE
        return _parts(curve, s, engaged, curve.length, MARGIN + stock.cell, gap)

    def area(self, builder: PathBuilder, curve: Curve) -> float:
        """Return the area in mm2 of the stock that a pass would meet."""
        stock = builder.stock()
        rows = np.argwhere(self.wanted & (stock.field > self.z))
        if not len(rows):
            return 0.0
        away = curve.distance(stock.corner + (rows + 0.5) * stock.cell)
        return float((away < builder.tool.radius).sum()) * stock.cell**2

    def _meets(self, stock: PlanningStock, points: Floats, along: Floats, radius: float) -> Bools:
        """Return for positions (k, 2) of a cutter with directions (k, 2) whether stock lies under the front half of its rim."""
        count = max(2, int(np.ceil(np.pi * radius / stock.cell)))
        angle = np.linspace(-0.5 * np.pi, 0.5 * np.pi, count + 1)
        left = np.stack([-along[:, 1], along[:, 0]], axis=1)
        rim = (
            points[:, None]
            + radius * np.cos(angle)[:, None] * along[:, None]
            + radius * np.sin(angle)[:, None] * left[:, None]
        )
        cell = np.floor((rim - stock.corner) / stock.cell).astype(np.int64)
        shape = stock.field.shape
        inside = ((cell >= 0) & (cell < shape)).all(axis=2)
        column, row = (np.clip(cell[..., k], 0, shape[k] - 1) for k in (0, 1))
        met: Bools = inside & self.wanted[column, row] & (stock.field[column, row] > self.z)
        return np.asarray(met.any(axis=1), dtype=np.bool_)


def _parts(
    curve: Curve, s: Floats, engaged: Bools, total: float, margin: float, gap: float
) -> list[Curve]:
    """Return the engaged runs of a pass, grown by a margin, those that are closer than a gap joined."""
    where = s[engaged]
    first = int(np.argmax(np.diff(where, append=where[0] + total))) + 1 if curve.closed else 0
    if curve.closed:
        # A closed pass is opened at its longest gap.
        where = np.concatenate([where[first:], where[:first] + total])
        if where[0] + total - where[-1] <= gap + 2.0 * margin:
            where = np.append(where, where[0] + total)
    breaks = np.flatnonzero(np.diff(where) > gap + 2.0 * margin)
    starts = where[np.append(0, breaks + 1)] - margin
    stops = where[np.append(breaks, len(where) - 1)] + margin
    if curve.closed:
        if stops[0] - starts[0] >= total:
            return [curve]
        return [curve.split(a, b) for a, b in zip(starts, stops, strict=True)]
    return [curve.split(max(a, 0.0), min(b, total)) for a, b in zip(starts, stops, strict=True)]
