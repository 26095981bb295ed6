"""Clears an area at one height at constant engagement: entries, passes, links that stay down; then what only passes along walls reach."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from scipy import ndimage

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats
from trunnion.geometry.plane.arc_fitting import arcs_through_many
from trunnion.geometry.plane.curve import Curve
from trunnion.geometry.plane.curve_parts import parts_near
from trunnion.geometry.plane.region import Region
from trunnion.model.motion.toolpath import Mark
from trunnion.model.operation import CuttingData
from trunnion.progress import Progress
from trunnion.toolpath.axis_region import AxisRegion
from trunnion.toolpath.constant_engagement.cleared_area import ClearedArea
from trunnion.toolpath.constant_engagement.passes import EngagedPass, engaged_passes
from trunnion.toolpath.motion.builder import PathBuilder
from trunnion.toolpath.motion.link import step_aside, top_under, travel
from trunnion.toolpath.offsetting.area_clearing import (
    ClearingLayer,
    ClearingParameters,
    clear_area,
    cut_rims,
)
from trunnion.toolpath.offsetting.entry import helix, helix_radius
from trunnion.toolpath.offsetting.levels import steps_down
from trunnion.toolpath.offsetting.rings import OffsetRing, depth_first, ring_tree
from trunnion.toolpath.stock.heightfield import PlanningStock
from trunnion.units import SECONDS_PER_MINUTE

ROUNDED = 0.15
"""Radii: passes round corners of the axis region so, and leave out necks narrower than twice that: a pass along the walls follows."""

OUTSIDE = 0.3
"""Radii that the axis may go on beyond the clip of an open area: crescents begin and end outside of what stands there."""

NECK = 0.02
"""Squares of the radius: a neck with less to stand on is a corner."""

FITTED = 0.002
"""Radii: how far arcs may pass from the positions that were marched: 0.02 mm of a cutter of 20 mm."""

INSET = 0.003
"""Radii that marched positions keep off the walls, for what arcs and the grid's bilinear cells add."""

BEYOND = 0.5
"""Radii that a pass along walls begins before and ends behind a corner or a neck."""

RINGS = 1.3
"""How much longer contour-parallel passes take than their ways: centres go slower on arcs, feeds are eased in corners. Measured on pockets
of 100 to 300 mm."""

LINK = 0.1 / SECONDS_PER_MINUTE
"""min that a link takes to speed up and to come to rest."""

FED_LINK = 3.0 / SECONDS_PER_MINUTE
"""min that a link through what was cleared may take at its feed; over longer ways the cutter is lifted."""

RIM = 3.0
"""Cells at the rim of an area that a wall may keep high though everything is cut."""

STRIP = 1.0
"""Cells of the stock: what stands no wider than twice that is the rim of something that was cut, and no more is known of it."""


@dataclass(frozen=True, slots=True, eq=False)
class _StockAbove:
    """Where material stands over a height: cells (nx, ny) of a side (mm) from a corner (2,), and up to which height at most."""

    cells: Bools
    corner: Floats
    cell: float
    highest: float

    @staticmethod
    def of(stock: PlanningStock, z: float, piece: Region, radius: float) -> _StockAbove:
        """Return where a stock stands over a height about a piece of an axis region: but for strips along what was cut."""
        low, high = piece.box()
        near = stock.cropped(low - 2.0 * radius, high + 2.0 * radius)
        cells = near.heights > z
        if not cells.all():
            core = ndimage.distance_transform_edt(np.pad(cells, 1, constant_values=True)) > STRIP
            cells = (ndimage.distance_transform_edt(~core) <= STRIP)[1:-1, 1:-1]
        return _StockAbove(np.asarray(cells), near.corner, near.cell, float(near.heights.max()))

    def holds(self, points: Floats) -> Bools:
        """Return whether material stands at points (k, 2); none does beside the stock."""
        cell = np.floor((points - self.corner) / self.cell).astype(np.int64)
        inside = ((cell >= 0) & (cell < self.cells.shape)).all(axis=1)
        found = np.zeros(len(points), dtype=np.bool_)
        found[inside] = self.cells[tuple(cell[inside].T)]
        return found


@dataclass(frozen=True, slots=True, eq=False)
class _LaidPass:
    """A pass, and how the cutter comes to it: by a helix about `centre` (2,), or `straight` through what was cleared by then."""

    curve: Curve
    centre: Floats | None
    straight: bool


@dataclass(frozen=True, slots=True, eq=False)
class _Laid:
    """The passes of a piece of a layer, as they were laid for the cells (nx, ny) of the stock that stood there, and for a way down of
    `drop` mm."""

    cells: Bools
    drop: float
    passes: tuple[_LaidPass, ...]

    def is_for(self, above: _StockAbove, drop: float) -> bool:
        """Return whether they fit what stands and a way down."""
        return np.array_equal(self.cells, above.cells) and math.isclose(self.drop, drop)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Piece:
    """A piece of an axis region with the passes over it, which are cut at a share of the feed; `top` mm is as high as material stands."""

    region: Region
    top: float
    share: float
    laid: _Laid

    def time(self, data: CuttingData) -> float:
        """Return the minutes that passes and links take, without the ways down; of a piece that has none, no end of them."""
        if not self.laid.passes:
            return math.inf
        links = [
            float(np.hypot(*(after.curve.start - before.curve.end)))
            for before, after in pairwise(self.laid.passes)
            if after.centre is None
        ]
        cut = sum(p.curve.length for p in self.laid.passes) / (self.share * data.feed)
        return cut + sum(links) / data.link_feed + LINK * len(links)


class EngagedClearing:
    """Clears the layers of a pocket with one cutter at constant engagement; with `by_time` by contour-parallel passes the
    layers where these are quicker. Layers over the same shape that stand alike share their passes."""

    def __init__(self, data: CuttingData, parameters: ClearingParameters, *, by_time: bool) -> None:
        self._data, self._parameters, self._by_time = data, parameters, by_time
        self._laid: dict[tuple[bytes, float], _Laid] = {}

    def clear(self, builder: PathBuilder, layer: ClearingLayer, progress: Progress) -> None:
        """Cut all of a layer that the cutter reaches."""
        reached = layer.axis_region.region
        radius = builder.tool.radius
        if layer.clip is not None:
            reached = reached.intersect(layer.clip.offset(OUTSIDE * radius))
        wide = reached.opened(ROUNDED * radius).offset(-INSET * radius)
        narrow = reached.minus(wide.offset(2.0 * INSET * radius))
        is_corner = [p.area <= NECK * radius**2 for p in narrow.pieces]
        corners, necks = (
            Region(tuple(p for p, c in zip(narrow.pieces, is_corner, strict=True) if c is wanted))
            for wanted in (True, False)
        )
        clip = corners.offset(BEYOND * radius)
        rounded = [part for c in reached.curves() for part in _parts_in(c, clip)]
        pieces = self._pieces(builder, layer, wide, rounded, progress)
        top = max((p.top for p in pieces), default=layer.z)
        if self._by_time and self._ring_time(layer.rings, layer.clip, top - layer.z) < sum(
            p.time(self._data) for p in pieces
        ):
            self._cut_by_rings(builder, layer, top, progress)
            return
        for piece in pieces:
            self._cut_piece(builder, layer, piece, progress)
        if necks and not _is_cut(builder, layer, necks.offset(radius)):
            self._cut_necks(builder, layer, necks, top, progress)
        if layer.wanted is not None:
            stock = builder.stock()
            inner = reached.offset(radius - RIM * stock.cell).intersect(layer.wanted)
            if not _is_cut(builder, layer, inner):
                # What the grid took for the rim of something is cut where the stock still knows it.
                clip = layer.clip or layer.wanted.offset(radius)
                self._cut_by_rings(builder, replace(layer, clip=clip), top, progress)

    def _pieces(
        self,
        builder: PathBuilder,
        layer: ClearingLayer,
        wide: Region,
        rounded: Sequence[Curve],
        progress: Progress,
    ) -> list[_Piece]:
        """Return the pieces of a region in which material stands over a layer, with their passes, each next the one nearest to the piece
        before. `rounded` are the passes into corners that are left out of the region."""
        found = []
        for region in _nearest_first(wide, builder.here):
            above = _StockAbove.of(
                builder.stock(), layer.z + layer.worth, region, builder.tool.radius
            )
            if not above.cells.any():
                continue
            highest = above.highest if layer.top is None else min(above.highest, layer.top)
            top = max(highest, layer.z)
            shallow = top - layer.z <= self._data.deepest_slot + tolerance.COINCIDENT
            width = (self._data.layer_width if shallow else 0.0) or self._data.width
            near = [c for c in rounded if float(region.signed_distance(c.start)[0]) > -0.1]
            found.append(
                _Piece(
                    region=region,
                    top=top,
                    share=self._data.layer_share if shallow else 1.0,
                    laid=self._passes(builder, layer, region, above, top, width, near, progress),
                )
            )
        return found

    def _cut_piece(
        self, builder: PathBuilder, layer: ClearingLayer, piece: _Piece, progress: Progress
    ) -> None:
        axis_region = AxisRegion(piece.region)
        if not piece.laid.passes:
            rings = ring_tree(piece.region, self._parameters.step)
            inside = replace(layer, rings=rings, axis_region=axis_region)
            self._cut_by_rings(builder, inside, piece.top, progress)
            return
        for one in piece.laid.passes:
            progress.check()
            self._come_to(builder, layer, one, axis_region, piece.top)
            # At constant engagement the removal goes with the centre's way, however the path bends.
            builder.curve(one.curve, layer.z, piece.share * builder.data.feed, at_rim=False)
        step_aside(builder, builder.heading(), layer.axis_region)

    def _passes(
        self,
        builder: PathBuilder,
        layer: ClearingLayer,
        piece: Region,
        above: _StockAbove,
        top: float,
        width: float,
        rounded: Sequence[Curve],
        progress: Progress,
    ) -> _Laid:
        """Return the passes of a width over a piece of an axis region and into its corners, those of a layer before that stood alike."""
        radius, drop = builder.tool.radius, top - layer.z
        wanted = piece.offset(radius) if layer.wanted is None else layer.wanted
        key = (piece.digest() + wanted.digest(), width)
        known = self._laid.get(key)
        if known is not None and known.is_for(above, drop):
            return known
        area = ClearedArea.of(piece, wanted, radius, above.holds)
        passes = engaged_passes(
            area,
            contact_angle(radius, width),
            lambda depth: helix_radius(builder, depth, drop, self._parameters.ramp),
            progress,
        )
        laid = [_LaidPass(_fitted(p, FITTED * radius), p.centre, p.straight) for p in passes]
        left = list(rounded) if laid else []
        while left:
            here = laid[-1].curve.end
            left.sort(key=lambda c: float(np.hypot(*(c.start - here))))
            corner = left.pop(0)
            laid.append(_LaidPass(corner, None, area.line_is_free(here, corner.start)))
        self._laid[key] = _Laid(above.cells, drop, tuple(laid))
        return self._laid[key]

    def _ring_time(self, rings: tuple[OffsetRing, ...], clip: Region | None, drop: float) -> float:
        """Return the minutes that contour-parallel passes down a way of `drop` mm take."""
        way = sum(
            part.length * (1.0 if ring.inner else 1.0 / self._parameters.slot)
            for ring in depth_first(rings)
            for curve in ring.curves()
            for part in ([curve] if clip is None else _parts_in(curve, clip))
        )
        layers = len(steps_down(drop, 0.0, self._data.deepest_slot))
        return RINGS * layers * way / (self._data.layer_share * self._data.feed)

    def _cut_by_rings(
        self, builder: PathBuilder, layer: ClearingLayer, top: float, progress: Progress
    ) -> None:
        """Clear a layer by contour-parallel passes, no deeper at once than slots may be."""
        known = layer.top
        for z in steps_down(top, layer.z, self._data.deepest_slot):
            clear_area(builder, replace(layer, z=z, top=known), self._parameters, progress)
            known = None if known is None else z

    def _cut_necks(
        self,
        builder: PathBuilder,
        layer: ClearingLayer,
        necks: Region,
        top: float,
        progress: Progress,
    ) -> None:
        """Cut necks of the axis region along their walls, no deeper at once than slots may be."""
        clip = necks.offset(BEYOND * builder.tool.radius)
        if layer.clip is not None:
            clip = clip.intersect(layer.clip)
        for z in steps_down(top, layer.z, self._data.deepest_slot):
            cut_rims(builder, replace(layer, z=z, clip=clip), self._parameters, progress)

    def _come_to(
        self,
        builder: PathBuilder,
        layer: ClearingLayer,
        one: _LaidPass,
        axis_region: AxisRegion,
        top: float,
    ) -> None:
        """Bring the cutter to the start of a pass."""
        start = one.curve.start
        if one.centre is not None:
            radius = float(np.hypot(*(start - one.centre)))
            highest = max(min(top_under(builder, one.centre, radius), top), layer.z)
            helix(builder, one.centre, radius, start, highest, layer.z, self._parameters.ramp)
            return
        here = builder.here
        if one.straight and here is not None:
            feed = self._data.link_feed
            if float(np.hypot(*(start - here[:2]))) <= FED_LINK * feed:
                builder.line((*start, layer.z), feed, Mark.LINK)
                return
        travel(builder, start, layer.z, axis_region)


def contact_angle(radius: float, width: float) -> float:
    """Return the angle of contact (rad) of a straight cut of a width in mm: cos(angle) = 1 - ae / r.

    >>> round(math.degrees(contact_angle(10.0, 5.0)), 6)
    60.0
    """
    return math.acos(max(1.0 - width / radius, -1.0))


def _fitted(one: EngagedPass, within: float) -> Curve:
    """Return a pass as lines and arcs."""
    points, bulges = arcs_through_many(one.points, within)
    return Curve(points, np.append(bulges, 0.0), False)


def _is_cut(builder: PathBuilder, layer: ClearingLayer, area: Region) -> bool:
    """Return whether no stock stands over a layer in an area."""
    return not len(builder.stock().positions_above(layer.z + layer.worth, area))


def _parts_in(curve: Curve, clip: Region) -> list[Curve]:
    """Return the parts of a curve in a region."""
    return parts_near(curve, clip, clip.signed_distance) if clip else []


def _nearest_first(region: Region, here: Floats | None) -> list[Region]:
    """Return the pieces of a region, each next the one nearest to the piece before."""
    left, found = list(region.split()), []
    at = None if here is None else here[:2]
    while left:
        if at is not None:
            position = at
            left.sort(key=lambda r: abs(float(r.signed_distance(position)[0])))
        found.append(left.pop(0))
        at = found[-1].pieces[0].outer.start
    return found
