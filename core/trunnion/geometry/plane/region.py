"""Plane areas bounded by lines and arcs: any number of pieces with islands, joined, cut, grown and shrunk."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field

import numpy as np
import shapely
from numpy.typing import ArrayLike

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.cache import Cache
from trunnion.geometry.plane import fit
from trunnion.geometry.plane.chords import Chords, chorded, polygons_of
from trunnion.geometry.plane.curve import (
    Curve,
    Segments,
    distance_to,
    join_segments,
    signed_distance,
    winding,
)
from trunnion.geometry.plane.offset import grown

KEPT_RESULTS = 4096
"""Results of offsets and of overlays that are kept, of some kB each: a large panel needs fewer in one step."""


@dataclass(frozen=True, slots=True, eq=False)
class Piece:
    """One connected area: `outer` goes anticlockwise round it, each of `holes` clockwise round an island left out.

    Raises `ValueError` when a curve is open or goes the wrong way round.
    """

    outer: Curve
    holes: tuple[Curve, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "holes", tuple(self.holes))
        if not self.outer.closed or not self.outer.area > 0.0:
            raise ValueError("piece outer: the curve must be closed and anticlockwise")
        if any(not h.closed or not h.area < 0.0 for h in self.holes):
            raise ValueError("piece holes: every curve must be closed and clockwise")

    @property
    def area(self) -> float:
        """The area in mm2."""
        return self.outer.area + sum(h.area for h in self.holes)


@dataclass(frozen=True, slots=True, eq=False)
class Region:
    """A plane area of any number of pieces that do not overlap; false when empty.

    What is made of lines and arcs stays so: operations return exact arcs, with radii exact to 1e-9 and corners to 1e-6.
    """

    pieces: tuple[Piece, ...] = ()
    _segments: list[Segments] = field(init=False, repr=False, default_factory=list)
    _digest: list[bytes] = field(init=False, repr=False, default_factory=list)

    def __post_init__(self) -> None:
        object.__setattr__(self, "pieces", tuple(self.pieces))

    @staticmethod
    def of(curves: Iterable[Curve]) -> Region:
        """Return the area inside an odd number of closed curves, which must not cross; their directions don't matter.

        Raises `ValueError` when a curve is open.
        """
        return _nested(list(curves))

    @staticmethod
    def rectangle(x0: float, y0: float, x1: float, y1: float) -> Region:
        """Return a rectangle."""
        return Region((Piece(Curve.rectangle(x0, y0, x1, y1)),))

    @staticmethod
    def circle(centre: ArrayLike, radius: float) -> Region:
        """Return a disc."""
        return Region((Piece(Curve.circle(centre, radius)),))

    def __bool__(self) -> bool:
        return bool(self.pieces)

    @property
    def area(self) -> float:
        """The area in mm2."""
        return sum(p.area for p in self.pieces)

    def box(self) -> tuple[Floats, Floats]:
        """Return the lowest and highest corner of the box around the region; raise `ValueError` when it is empty."""
        if not self:
            raise ValueError("box: an empty region has none")
        boxes = [p.outer.box() for p in self.pieces]
        return np.min([b[0] for b in boxes], axis=0), np.max([b[1] for b in boxes], axis=0)

    def curves(self) -> tuple[Curve, ...]:
        """Return all loops, piece by piece, the outer one first; the region lies on the left of each."""
        return tuple(c for p in self.pieces for c in (p.outer, *p.holes))

    def segments(self) -> Segments:
        """Return the lines and arcs of all loops as arrays."""
        if not self._segments:
            self._segments.append(join_segments(c.segments() for c in self.curves()))
        return self._segments[0]

    def loops(self) -> Ints:
        """Return of every segment (m,) which of the curves it belongs to, from 0."""
        curves = self.curves()
        return np.repeat(np.arange(len(curves)), [c.n_segments for c in curves])

    def digest(self) -> bytes:
        """Return a short digest of all loops: equal for regions of the same loops, and only for them."""
        if not self._digest:
            made = hashlib.blake2b(digest_size=16)
            for piece in self.pieces:
                made.update(len(piece.holes).to_bytes(4, "little"))
                for curve in (piece.outer, *piece.holes):
                    made.update(len(curve.points).to_bytes(4, "little"))
                    made.update(curve.points.tobytes())
                    made.update(curve.bulges.tobytes())
            self._digest.append(made.digest())
        return self._digest[0]

    def contains(self, points: ArrayLike, margin: float = 0.0) -> Bools:
        """Return for each point (k, 2) whether it is inside by at least `margin` mm (negative: at most so far outside)."""
        p = np.atleast_2d(np.asarray(points, dtype=np.float64))
        if not self:
            return np.zeros(len(p), dtype=bool)
        return self.signed_distance(p) >= margin if margin else winding(self.segments(), p) > 0

    def signed_distance(self, points: ArrayLike) -> Floats:
        """Return the exact distances (k,) of points (k, 2) from the boundary, positive inside; -inf when the region is empty."""
        p = np.atleast_2d(np.asarray(points, dtype=np.float64))
        if not self:
            return np.full(len(p), -np.inf)
        return signed_distance(self.segments(), p)

    def offset(self, distance: float) -> Region:
        """Return the region grown (positive, with round joins) or shrunk (negative) by a distance in mm.

        Pieces narrower than a sliver are dropped.
        """
        if not self or abs(distance) <= tolerance.PARAMETRIC:
            return self
        low, high = self.box()
        if distance < 0.0 and 2.0 * -distance >= (high - low).min():
            return EMPTY_REGION
        return _OFFSETS.get(
            (self.digest(), distance),
            lambda: restored_region(*grown(self.segments(), self.loops(), distance)),
        )

    def opened(self, radius: float) -> Region:
        """Return what a disc of this radius covers when it rolls inside the region: no neck narrower than it is left."""
        return self.offset(-radius).offset(radius)

    def closed(self, radius: float) -> Region:
        """Return the region with gaps filled that a disc of this radius can't enter from outside."""
        return self.offset(radius).offset(-radius)

    def union(self, other: Region) -> Region:
        """Return the area of either region."""
        if not self or not other:
            return self or other
        return overlay(self, other, shapely.union)

    def minus(self, other: Region) -> Region:
        """Return the area of this region that isn't of the other one."""
        if not self or not other:
            return self
        taken = _near_box(other, *self.box())
        return overlay(self, taken, shapely.difference) if taken else self

    def intersect(self, other: Region) -> Region:
        """Return the area of both regions."""
        if not self or not other:
            return EMPTY_REGION
        one, two = _near_box(self, *other.box()), _near_box(other, *self.box())
        return overlay(one, two, shapely.intersection) if one and two else EMPTY_REGION

    def holes_filled(self) -> Region:
        """Return the region with its islands filled, and pieces inside them swallowed."""
        outers = [p.outer for p in self.pieces]
        if len(outers) < 2:
            return Region(tuple(Piece(c) for c in outers))
        inside = [
            any(
                o is not c and winding(o.segments(), c.points[:1])[0] > 0 and o.area > c.area
                for o in outers
            )
            for c in outers
        ]
        return Region(
            tuple(Piece(c) for c, swallowed in zip(outers, inside, strict=True) if not swallowed)
        )

    def split(self) -> tuple[Region, ...]:
        """Return one region a piece."""
        return tuple(Region((p,)) for p in self.pieces)

    def moved(self, dx: float, dy: float) -> Region:
        """Return the region moved by a vector."""
        return self._mapped(lambda c: c.moved(dx, dy))

    def rotated(self, angle: float, centre: ArrayLike = (0.0, 0.0)) -> Region:
        """Return the region turned anticlockwise by an angle in radians about a point."""
        return self._mapped(lambda c: c.rotated(angle, centre))

    def mirrored(self, axis: int = 0) -> Region:
        """Return the region with the coordinate `axis` (0: x, 1: y) negated."""
        return self._mapped(lambda c: c.mirrored(axis).reversed())

    def _mapped(self, change: Callable[[Curve], Curve]) -> Region:
        return Region(
            tuple(Piece(change(p.outer), tuple(change(h) for h in p.holes)) for p in self.pieces)
        )


EMPTY_REGION = Region()
"""The region without any area."""

_OFFSETS: Cache[Region] = Cache(KEPT_RESULTS)
_OVERLAYS: Cache[Region] = Cache(KEPT_RESULTS)


def union_all(regions: Sequence[Region]) -> Region:
    """Return the area of any of the regions."""
    parts = [r for r in regions if r]
    if len(parts) < 2:
        return parts[0] if parts else EMPTY_REGION
    chords, areas = _opened_into_chords(parts)
    return restored_region(shapely.union_all(areas), chords)


def overlay(a: Region, b: Region, operation: Callable[..., shapely.Geometry]) -> Region:
    """Return what a set operation of shapely makes of two regions, with exact lines and arcs."""

    def work_out() -> Region:
        chords, (first, second) = _opened_into_chords([a, b])
        return restored_region(operation(first, second), chords)

    return _OVERLAYS.get((a.digest(), b.digest(), operation.__name__), work_out)


def restored_region(geometry: shapely.Geometry, chords: Chords) -> Region:
    """Return a shapely answer on chords as a region of lines and arcs."""
    pieces = []
    for outer, holes in fit.restored(geometry, chords):
        if outer.area > tolerance.AREA:
            pieces.append(Piece(outer, tuple(h for h in holes if h.area < -tolerance.AREA)))
    return Region(tuple(pieces))


def _opened_into_chords(regions: Sequence[Region]) -> tuple[Chords, list[shapely.Geometry]]:
    chords = chorded(join_segments(r.segments() for r in regions))
    areas = []
    row = 0
    for region in regions:
        pieces = []
        for piece in region.pieces:
            loops = []
            for curve in (piece.outer, *piece.holes):
                loops.append(range(row, row + curve.n_segments))
                row += curve.n_segments
            pieces.append(loops)
        areas.append(polygons_of(chords, pieces))
    return chords, areas


def _near_box(region: Region, low: Floats, high: Floats) -> Region:
    """Return a region without the pieces and islands that lie wholly outside a box: queries inside the box don't depend on them."""

    def near(curve: Curve) -> bool:
        first, last = curve.box()
        return bool((first <= high).all() and (last >= low).all())

    pieces = [p for p in region.pieces if near(p.outer)]
    if len(pieces) == len(region.pieces) and all(near(h) for p in pieces for h in p.holes):
        return region
    return Region(tuple(Piece(p.outer, tuple(h for h in p.holes if near(h))) for p in pieces))


def _nested(curves: list[Curve]) -> Region:
    if any(not c.closed for c in curves):
        raise ValueError("region: every curve must be closed")
    loops = sorted(((abs(c.area), n, c) for n, c in enumerate(curves)), key=lambda t: (-t[0], t[1]))
    kept = [c if c.area > 0.0 else c.reversed() for area, _, c in loops if area > tolerance.AREA]
    boxes = np.array([np.concatenate(c.box()) for c in kept]).reshape(-1, 4)
    parents: list[int] = []
    depths: list[int] = []
    for n, curve in enumerate(kept):
        around = [k for k in _boxed(boxes, n) if _is_inside(curve, kept[k])]
        parents.append(max(around, default=-1))
        depths.append(len(around))
    holes: dict[int, list[Curve]] = {n: [] for n, depth in enumerate(depths) if depth % 2 == 0}
    for n, depth in enumerate(depths):
        if depth % 2:
            holes[parents[n]].append(kept[n].reversed())
    return Region(tuple(Piece(kept[n], tuple(found)) for n, found in holes.items()))


def _boxed(boxes: Floats, n: int) -> list[int]:
    """Return which of the boxes (low x, low y, high x, high y) before row n hold box n."""
    slack = tolerance.COINCIDENT
    low, high = boxes[:n, :2] - slack, boxes[:n, 2:] + slack
    return [
        int(k)
        for k in np.flatnonzero(
            (boxes[n, :2] >= low).all(axis=1) & (boxes[n, 2:] <= high).all(axis=1)
        )
    ]


def _is_inside(inner: Curve, outer: Curve) -> bool:
    """Return whether most of one curve is inside another; they may touch."""
    s = inner.segments()
    rows = np.arange(len(s))
    probes = np.concatenate([s.start, s.at(rows, 0.5 * s.length)])
    away = distance_to(outer.segments(), probes)
    return bool(winding(outer.segments(), probes[[int(np.argmax(away))]])[0] > 0)
