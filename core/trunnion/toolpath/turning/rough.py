"""Roughing by turning: layers one below the other, fed along the work or across it, then the contour with what finishing takes left on.

The stretches along which a tool may go at one height lie within those of the height above, for what must stand is closed downwards. So
layers form a tree, and each branch, the ground between two flanges say, is turned to its bottom before the next one.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from trunnion import tolerance
from trunnion.geometry.arrays import Floats
from trunnion.model.blank import Revolved
from trunnion.model.motion.toolpath import Mark
from trunnion.model.operation import CuttingData
from trunnion.model.setup import Setup
from trunnion.model.tool import TurningTool
from trunnion.plan.turning.contour_spans import THIN
from trunnion.plan.turning.drive import RevolvedDrive
from trunnion.plan.turning.reach import (
    DEEP,
    TurningReach,
    changes,
    swept_along,
    touching,
)
from trunnion.plan.turning.settings import TurningSettings
from trunnion.progress import Progress
from trunnion.toolpath.contract import Planned, strategy
from trunnion.toolpath.turning_passes.contour import contour_passes
from trunnion.toolpath.turning_passes.passes import TurningPath
from trunnion.toolpath.turning_passes.work import work_of

OVER = 1e-3
"""mm over the deepest ground at which the last layer goes: on it the tool would touch what must stand."""
SHORTEST = 0.5
"""mm: shorter stretches of a layer are left to the pass along the contour."""

Span = tuple[float, float]


@strategy(settings=TurningSettings, drive=RevolvedDrive)
def rough(
    drive: RevolvedDrive,
    tool: TurningTool,
    data: CuttingData,
    stock: Revolved,
    setup: Setup,
    settings: TurningSettings,
    progress: Progress,
) -> Planned:
    """Return layers of the data's depth, and a pass along the contour."""
    work = work_of(drive, tool, data, stock, setup, settings, settings.allowance)
    progress.at(0.3, "turning")
    layers = _Layers(work.path, work.reach, work.stock, data.depth, settings.clearance)
    layers.turn()
    progress.at(0.8, "following the contour")
    contour_passes(work.path, work.reach, layers.left(), settings.clearance, settings.bridge)
    return Planned(path=work.path.made())


class _Layers:
    """The layers of one operation; `passes` are those that were laid, from (u, v) to (u, v)."""

    def __init__(
        self,
        path: TurningPath,
        reach: TurningReach,
        stock: BaseGeometry,
        depth: float,
        clearance: float,
    ) -> None:
        self.path, self.reach, self.stock, self.clearance = path, reach, stock, clearance
        self.contact = touching(stock.buffer(-0.5 * THIN), reach.coarse)
        self.levels = self._levels(depth)
        self.passes: list[Floats] = []

    def _levels(self, depth: float) -> list[float]:
        """Return the heights of the layers, equally far apart, from the top down to the deepest ground that holds stock."""
        way = self.reach.allowed_ceiling()
        if len(way) < 2 or self.contact.is_empty:
            return []
        there = shapely.LineString(way).intersection(self.contact)
        if there.is_empty:
            return []
        top, low = self.stock.bounds[3], there.bounds[1] + OVER
        if low <= -0.5 * DEEP or top - low <= THIN:
            return []
        count = max(1, math.ceil((top - low) / depth))
        return [top + (low - top) * (k + 1) / count for k in range(count)]

    def turn(self) -> None:
        """Lay all layers."""
        if self.levels:
            for span in self.reach.intervals(self.stock.bounds[3] + self.clearance):
                self._below(span, 0, self.path.away)

    def left(self) -> BaseGeometry:
        """Return what the layers leave of the stock."""
        swept = [swept_along(self.reach.coarse, way) for way in self.passes]
        return self.stock.difference(shapely.union_all(swept)) if swept else self.stock

    def _below(self, above: Span, row: int, travel: float) -> None:
        """Turn the layer of a row, and all below it, within a stretch of the layer above; `travel` is the height at which the tool goes to
        and fro there."""
        if row == len(self.levels):
            return
        level = self.levels[row]
        for span in self.reach.intervals(level):
            low, high = max(span[0], above[0]), min(span[1], above[1])
            if high <= low:
                continue
            for begin, end in self._in_contact((low, high), level):
                if end - begin >= SHORTEST:
                    self._pass(begin, end, level, travel, low)
            self._below((low, high), row + 1, level + self.clearance)

    def _in_contact(self, span: Span, level: float) -> Sequence[Span]:
        """Return the stretches within a span along which the insert touches stock."""
        line = shapely.LineString([(span[0], level), (span[1], level)]).intersection(self.contact)
        found = []
        for part in shapely.get_parts(line):
            u = shapely.get_coordinates(part)[:, 0]
            if len(u) and np.ptp(u) > 0.0:
                found.append((float(u.min()), float(u.max())))
        joined: list[list[float]] = []
        for low, high in sorted(found):
            if joined and low - joined[-1][1] <= 2.0 * self.clearance:
                joined[-1][1] = high
            else:
                joined.append([low, high])
        return [(low, high) for low, high in joined]

    def _pass(self, begin: float, end: float, level: float, travel: float, low: float) -> None:
        """Turn one stretch: from before the stock where that is open, else down along what stands there from the layer above."""
        path, c = self.path, self.clearance
        if path.here is not None:
            path.rapid(path.here[0], max(travel, path.here[1]))
        if begin > low + tolerance.SHORT_MOVE:
            start = max(begin - c, low)
            path.rapid(start, travel)
            path.rapid(start, level + c)
            path.feed(start, level, Mark.LEAD)
        else:
            way = self._down(low, level, travel - c)
            path.rapid(float(way[0, 0]), travel)
            path.feed(float(way[0, 0]), float(way[0, 1]), Mark.LEAD)
            path.contour(way, Mark.ENTRY)
        path.feed(end, level)
        path.feed(max(end - c, low), level + c, Mark.LEAD)
        self.passes.append(np.array([[max(begin - c, low), level], [end, level]]))

    def _down(self, low: float, level: float, above: float) -> Floats:
        """Return the way (k, 2) along the ceiling from the height of the layer above, or from the ceiling's top before it where that is
        lower, to where a layer begins."""
        line = self.reach.between(self.reach.ends[0], low)
        higher = np.flatnonzero(line[:, 1] >= above)
        first = int(higher[-1]) if len(higher) else int(np.argmax(line[:, 1]))
        way = line[first:]
        if len(higher) and len(way) > 1:
            (u0, v0), (u1, v1) = way[0], way[1]
            share = (v0 - above) / (v0 - v1) if v0 > v1 else 0.0
            way = np.vstack([[u0 + share * (u1 - u0), min(v0, above)], way[1:]])
        way = np.vstack([way, [low, level]])
        return way[changes(way)]
