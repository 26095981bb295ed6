"""Machining regions: what a feature takes out of the part at each height, from the part's sections in a setup's frame.

A section's complement inside the blank falls into pieces; the piece over a pocket's floor is its removal region. Between two breaks (the
top, island tops, floors) the walls are vertical, so one section speaks for the whole band. Above the lowest rim the piece would run over
the ribs into the neighbours; there the region stays the one below the rim: the guide profile closed over the rib.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Protocol

import numpy as np

from trunnion import tolerance
from trunnion.findings import Refused
from trunnion.geometry.arrays import Bools, Floats
from trunnion.geometry.facegraph import CONVEX, FaceGraph
from trunnion.geometry.frame import Frame
from trunnion.geometry.plane.curve import Curve, joined
from trunnion.geometry.plane.region import EMPTY_REGION, Piece, Region, union_all
from trunnion.model.blank import Blank
from trunnion.model.feature import Feature, Recognition
from trunnion.model.setup import Setup
from trunnion.plan.prismatic.lean import LEANING, is_freeform
from trunnion.plan.setups import level_direction
from trunnion.recognize.grow import bend_radius
from trunnion.recognize.holes.sweep import arcs, axis_frame, holds

AROUND = 150.0
"""mm: how far free space is looked at around the blank; more than two diameters of the largest cutter."""

LEANING_SECTIONS = 9
"""Sections that the outline is the outermost of where sides of it lean; free-form ones may be widest anywhere."""

MOST_SECTIONS = 40
"""Sections between level faces that the outline of a part on its edge is made of at most."""
NEAR = 60.0
"""mm: how far free space is looked at around a top; more than a cutter of the largest diameter and its path in."""


class SectionSource(Protocol):
    """What planning asks of a part."""

    def section(self, frame: Frame, z: float) -> Region:
        """Return the material cut by a plane z of a frame."""

    def face_outline(self, frame: Frame, tag: int) -> Region:
        """Return the plan projection of a horizontal face."""

    def graph(self) -> FaceGraph:
        """Return the face graph in the part's coordinates."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Band:
    """A band of height of a pocket with the plan area that it removes there, and the area a cutter's envelope may use."""

    top: float
    bottom: float
    wanted: Region
    boundary: Region


ALL_ROUND = 0.5
"""Of the longer side of a face's box, by its edges' ends and middles: no face goes farther out of that."""


@dataclass(frozen=True, slots=True, eq=False)
class _Ceiling:
    """A face that looks down somewhere: the highest position where it does, its highest position at all, the heights of its edges with tops
    of the part, and its box in plan."""

    hangs: float
    top: float
    rims: tuple[float, ...]
    low: Floats
    high: Floats

    def sections_over(self, z: float) -> tuple[float, ...]:
        """Return the heights of sections that show all that hangs over a height: over a recess, and under the upper edges of a wall."""
        rims = (r - tolerance.OFF_PLANE for r in self.rims)
        return (self.top + tolerance.OFF_PLANE, *(r for r in rims if r > z))


@dataclass(frozen=True, slots=True, eq=False)
class SetupSpace:
    """A part in its blank as a setup sees it; every height and region is in the setup's frame.

    What is queried of it again for each operation, the bands of a pocket and what hangs over, is worked out once.
    """

    part: SectionSource
    recognition: Recognition
    setup: Setup
    blank: Blank
    blank_low: Floats
    blank_high: Floats
    bottom: float
    top: float
    _bands: dict[str, tuple[Band, ...]] = field(init=False, repr=False, default_factory=dict)
    _ceilings: list[_Ceiling] = field(init=False, repr=False, default_factory=list)
    _silhouette: list[Region] = field(init=False, repr=False, default_factory=list)
    _overheads: dict[tuple[int, float], Region] = field(
        init=False, repr=False, default_factory=dict
    )

    @staticmethod
    def of(part: SectionSource, recognition: Recognition, blank: Blank, setup: Setup) -> SetupSpace:
        """Return the part's space in a setup."""
        low, high = blank.box_in(setup.frame)
        graph = part.graph()
        points = np.vstack([graph.start, graph.middle, graph.end, graph.sample_point])
        z = setup.frame.to_local(points)[:, 2]
        return SetupSpace(
            part, recognition, setup, blank, low, high, float(z.min()), float(z.max())
        )

    def height_in(self, feature: Feature, z: float) -> float:
        """Return the setup's height of one that a feature gives: in the recognition's frame, or along its direction where that is level."""
        out = level_direction(feature)
        there = np.array([0.0, 0.0, z]) if out is None else z * out
        return float(self.setup.frame.to_local(self.recognition.frame.to_world(there))[2])

    def centre(self, tag: int) -> Floats:
        """Return a point (3,) inside a face."""
        return self.setup.frame.to_local(self.part.graph().centre[tag - 1])

    def section(self, z: float) -> Region:
        """Return the part's material at a height."""
        return self.part.section(self.setup.frame, z)

    def blank_area(self) -> Region:
        """Return the blank seen from above."""
        return self.blank.plan_area(self.setup.frame)

    def around(self) -> Region:
        """Return the blank's area and plenty around it."""
        return Region.rectangle(*(self.blank_low[:2] - AROUND), *(self.blank_high[:2] + AROUND))

    def material_over(self, z: float, near: Region) -> Region:
        """Return the part's material at a height, with all that hangs over it near a region: what an upright cutter must stay out of.

        A section through a recess in a wall shows free space that no upright cutter gets into; the section just over the recess closes it.
        A wall that leans over is widest at its upper edges.
        """
        material = self.section(z)
        return material.union(self.hanging_over(z, near)) if near else material

    def hanging_over(self, z: float, near: Region) -> Region:
        """Return what hangs over a height near a region, if anything: the part's material in the sections above it that show it, each no
        farther than around the face that hangs over."""
        low, high = near.box()
        return union_all(
            [
                self._overhead(n, height)
                for n, c in enumerate(self._hanging())
                if c.hangs > z and (c.low <= high).all() and (c.high >= low).all()
                for height in c.sections_over(z)
                if height < self.top
            ]
        )

    def _overhead(self, number: int, height: float) -> Region:
        """Return the part's material at a height around a face that looks down, by its number. Beyond it nothing stands out further than
        the material below, but for what other faces show."""
        if (number, height) not in self._overheads:
            ceiling = self._ceilings[number]
            around = ALL_ROUND * float((ceiling.high - ceiling.low).max()) + tolerance.OFF_PLANE
            window = Region.rectangle(*(ceiling.low - around), *(ceiling.high + around))
            self._overheads[number, height] = self.section(height).intersect(window)
        return self._overheads[number, height]

    def _hanging(self) -> list[_Ceiling]:
        """Return the faces that look down somewhere."""
        graph, frame = self.part.graph(), self.setup.frame
        if not self._ceilings:
            z = frame.to_local(graph.sample_point)[:, 2]
            down = frame.local_direction(graph.sample_normal)[:, 2] < -np.sin(tolerance.TANGENT)
            for row in dict.fromkeys(graph.sample_face[down].tolist()):
                own, edges = graph.sample_face == row, list(graph.edges_of[row])
                rim = np.vstack(
                    [graph.start[edges], graph.middle[edges], graph.end[edges], graph.centre[[row]]]
                )
                plan = frame.to_local(rim)[:, :2]
                crest = _crest(graph, row, frame)
                self._ceilings.append(
                    _Ceiling(
                        max(float(z[own & down].max()), crest),
                        max(float(z[own].max()), crest),
                        _upper_edges(graph, row, frame),
                        plan.min(axis=0),
                        plan.max(axis=0),
                    )
                )
        return self._ceilings

    def free_near(self, z: float, region: Region) -> Region:
        """Return where nothing of the part is at a height or hangs over it, around a region by plenty for a cutter over it."""
        low, high = region.box()
        window = Region.rectangle(*(low - NEAR), *(high + NEAR))
        return window.minus(self.material_over(z, window))

    def silhouette(self) -> Region:
        """Return the part's outline seen from above, its openings filled: where sides of it lean, their widest sections count; seen along
        the part, those between all its faces that lie level then."""
        if not self._silhouette:
            margin = tolerance.OFF_PLANE
            leans = any(
                f.with_role(*LEANING) if f.kind == "profile" else f.attributes.get("outer")
                for f in self.recognition
            )
            low, high = self.bottom + margin, self.top - margin
            heights: tuple[float, ...] = (low, 0.5 * (self.bottom + self.top), high)
            if leans:
                heights = tuple(np.linspace(low, high, LEANING_SECTIONS).tolist())
            if self.is_on_edge:
                heights = (*heights, *self._between_levels())
            sections = union_all([self.section(z).holes_filled() for z in heights])
            self._silhouette.append(sections.holes_filled())
        return self._silhouette[0]

    @property
    def is_on_edge(self) -> bool:
        """Whether the setup looks along the part."""
        z = self.recognition.frame.local_direction(self.setup.frame.z)
        return abs(float(z[2])) < np.sin(tolerance.ANGLE)

    def _between_levels(self) -> tuple[float, ...]:
        """Return the heights in the middle between faces that lie level in the setup, `MOST_SECTIONS` of them at most."""
        graph, frame = self.part.graph(), self.setup.frame
        level = np.abs(frame.local_direction(graph.normal)[:, 2]) > np.cos(tolerance.ANGLE)
        flat = level & (np.array(graph.surface) == "plane")
        heights = _distinct(frame.to_local(graph.centre[flat])[:, 2].tolist())
        middles = [0.5 * (a + b) for a, b in pairwise(heights)]
        return tuple(middles[:: 1 + len(middles) // MOST_SECTIONS])

    def top_of(self, feature: Feature) -> float:
        """Return where a feature begins: the part's top, or the floor that it is sunk into."""
        parent = parent_of(feature, self.recognition)
        if parent is not None and parent.kind != "rib" and "top_z" in feature.sizes:
            return self.height_in(feature, number(feature, "top_z"))
        return self.top

    def floors_of(self, feature: Feature) -> dict[int, float]:
        """Return the heights of a feature's floors by face tag, from the highest down."""
        found = {tag: float(self.centre(tag)[2]) for tag in feature.with_role("floor")}
        return dict(sorted(found.items(), key=lambda item: (-item[1], item[0])))

    def fillet_at(self, feature: Feature, z: float) -> float:
        """Return the largest radius between a feature's walls and its floors at a height; the feature's own where its faces tell none."""
        graph, blends = self.part.graph(), {tag - 1 for tag in feature.with_role("floor_fillet")}
        radii = [
            bend_radius(graph, row)
            for tag, height in self.floors_of(feature).items()
            if abs(height - z) < tolerance.SEW
            for row in blends.intersection(graph.neighbours(tag - 1))
        ]
        return max(filter(np.isfinite, radii), default=floor_fillet(feature))

    def islands_of(self, feature: Feature) -> tuple[Feature, ...]:
        """Return the islands that stand in a pocket."""
        return tuple(
            f
            for f in self.recognition.of_kind("island")
            if parent_of(f, self.recognition) is feature
        )

    def is_freeform(self, feature: Feature) -> bool:
        """Return whether a feature is a pocket that bands can't stand for: walls that lean, a floor that is curved."""
        return is_freeform(feature, self.islands_of(feature), self.part.graph())

    def island_top(self, island: Feature) -> float:
        """Return the height of an island's top."""
        tops = island.with_role("top")
        return (
            float(self.centre(tops[0])[2])
            if tops
            else self.height_in(island, number(island, "top_z"))
        )

    def bands_of(self, feature: Feature) -> tuple[Band, ...]:
        """Return the bands of a pocket from the top down; raise `Refused` when no free space is found over a floor."""
        if feature.id not in self._bands:
            self._bands[feature.id] = self._found_bands(feature)
        return self._bands[feature.id]

    def area_at(self, feature: Feature, z: float) -> Band:
        """Return the area of a pocket at one height alone, closed over what ends below it; raise `Refused` where no free space is there."""
        floors = self.floors_of(feature)
        points = [self.centre(tag)[:2] for tag in feature.with_role("floor")] or [
            self._middle_of(feature)
        ]
        sunken = [
            self.centre(tag)[:2]
            for island in self.islands_of(feature)
            if self.island_top(island) <= z
            for tag in island.with_role("top")
        ]
        low = min(floors.values(), default=self.bottom)
        return self._band(feature, self.top_of(feature), low, z, points, sunken)

    def _found_bands(self, feature: Feature) -> tuple[Band, ...]:
        floors, islands = self.floors_of(feature), self.islands_of(feature)
        points = {z: self.centre(tag)[:2] for tag, z in floors.items()}
        if not floors:
            points = {self.bottom: self._middle_of(feature)}
        top, lowest = self.top_of(feature), min(points)
        rim = (
            self.height_in(feature, number(feature, "lowest_rim_z"))
            if "lowest_rim_z" in feature.sizes
            else top
        )
        tops = {self.island_top(i): i for i in islands}
        breaks = _distinct([top, *points, *(z for z in tops if lowest < z < top)])
        fillets = {z: self.fillet_at(feature, z) for z in points}
        if len(breaks) < 2:
            raise Refused(
                f"{feature.id}: its floor lies at the part's top in {self.setup.name}; correct the feature"
            )
        rounding = max([*fillets.values(), *map(floor_fillet, islands)])
        bands: list[Band] = []
        peaks: set[float] = set()
        while len(bands) + 1 < len(breaks):
            high, low = breaks[len(bands) : len(bands) + 2]
            # Where the lowest rim lies under the band, what it is the rim of closes the section over it.
            over_rim = min(rim, high) - low <= tolerance.OFF_PLANE
            z = (
                low + tolerance.OFF_PLANE
                if low in peaks
                else _section_height(high, low, high if over_rim else rim, fillets.get(low, 0.0))
            )
            lips = self._lips(feature, low) if over_rim else EMPTY_REGION
            under = [points[f] for f in points if f <= low + tolerance.SEW]
            sunken = [
                self.centre(tag)[:2]
                for height, island in tops.items()
                if height <= low + tolerance.SEW
                for tag in island.with_role("top")
            ]
            band = self._band(feature, high, low, z, under, sunken, lips)
            peak = self._peak_in(band, z, feature, rounding)
            if peak is None:
                gap = fillets.get(low, 0.0) - (z - low)
                if low in fillets and gap > 0.0:
                    full = next((b for b in reversed(bands) if b.bottom not in peaks), None)
                    over = full or self._above_foot(feature, high, low + fillets[low])
                    grow = fillets[low] - (fillets[low] ** 2 - gap**2) ** 0.5
                    band = _up_to_walls(band, over, points[low], grow)
                bands.append(band)
                continue
            breaks.insert(len(bands) + 1, peak)
            # Over a peak the fillets of floors on both sides meet: that much of it is taken as the section at the peak shows it.
            rounded = above_fillets(peak, fillets)
            if rounded > peak + tolerance.OFF_PLANE:
                peaks.add(peak)
                if rounded < high - tolerance.SEW:
                    breaks.insert(len(bands) + 1, rounded)
        return tuple(bands)

    def _lips(self, feature: Feature, z: float) -> Region:
        """Return the level faces that a pocket's walls, or the fillets at their feet, end at under a height, seen from above: the tops of
        lowered ribs."""
        graph, own = self.part.graph(), {tag - 1 for tag in feature.tags}
        walls = [tag - 1 for tag in feature.with_role("wall", "corner", "floor_fillet")]
        ends = {
            graph.across(e, w)
            for w in walls
            for e in graph.edges_of[w]
            if graph.convexity[e] == CONVEX
        }
        up = self.setup.frame.local_direction(graph.normal)[:, 2] > np.cos(tolerance.ANGLE)
        heights = self.setup.frame.to_local(graph.centre)[:, 2]
        return union_all(
            [
                self.part.face_outline(self.setup.frame, row + 1)
                for row in sorted(ends - own)
                if graph.surface[row] == "plane" and up[row] and heights[row] < z
            ]
        )

    def _peak_in(self, band: Band, z: float, feature: Feature, rounding: float) -> float | None:
        """Return the height of the highest edge that is in a band below the section at `z` that speaks for it, or None.

        The part's edges over the band's plan area, the strip of the fillets at its walls left out: a lip between two pockets that share
        their space above it, the floor of a neighbour that broke through the wall between them. Below such an edge the section is wrong.
        """
        graph, own = self.part.graph(), {tag - 1 for tag in feature.tags}
        inner = band.wanted.offset(-rounding - tolerance.SEW)
        within = np.array([own.issuperset(faces) for faces in graph.edge_face.tolist()])
        strange = ~within | (graph.convexity == CONVEX)
        points = self.setup.frame.to_local(
            np.vstack([graph.start[strange], graph.middle[strange], graph.end[strange]])
        )
        points = points[
            (points[:, 2] > band.bottom + tolerance.SEW)
            & (points[:, 2] < min(z, band.top) - tolerance.SEW)
        ]
        if not inner or not len(points):
            return None
        over = points[inner.contains(points[:, :2])]
        return float(over[:, 2].max()) if len(over) else None

    def _band(
        self,
        feature: Feature,
        high: float,
        low: float,
        z: float,
        points: list[Floats],
        sunken: list[Floats],
        lips: Region = EMPTY_REGION,
    ) -> Band:
        material = self.material_over(z, self.plan_box(feature)).union(lips)
        if feature.kind == "open_pocket":
            wanted = holding(self.silhouette().minus(material), points)
            boundary = (
                holding(self.around().minus(material).intersect(wanted.offset(AROUND)), points)
                if wanted
                else EMPTY_REGION
            )
        else:
            wanted = boundary = enclosed(material, points)
        if not wanted:
            raise Refused(
                f"{feature.id}: at z {z:.3f} of {self.setup.name} the part has no space over its floor, or does not close it; "
                "correct the feature or machine it by hand"
            )
        wanted, boundary = filled_over(wanted, sunken), filled_over(boundary, sunken)
        return Band(top=high, bottom=low, wanted=wanted, boundary=boundary)

    def _above_foot(self, feature: Feature, top: float, foot: float) -> Band:
        """Return the free space around a pocket over the fillets at its foot: what bounds it where its rim is lower than they are high."""
        z = min(foot + tolerance.OFF_PLANE, top - tolerance.OFF_PLANE)
        free = self.around().minus(self.material_over(z, self.plan_box(feature)))
        inside = free.intersect(self.silhouette()) if feature.kind == "open_pocket" else free
        return Band(top=top, bottom=foot, wanted=inside, boundary=free)

    def plan_box(self, feature: Feature) -> Region:
        """Return the plan box of a feature's faces."""
        graph = self.part.graph()
        edges = sorted({e for tag in feature.tags for e in graph.edges_of[tag - 1]})
        if not edges:
            return EMPTY_REGION
        plan = self.setup.frame.to_local(
            np.vstack([graph.start[edges], graph.middle[edges], graph.end[edges]])
        )[:, :2]
        low, high = plan.min(axis=0), plan.max(axis=0)
        return (
            Region.rectangle(*low, *high)
            if (high - low > tolerance.COINCIDENT).all()
            else EMPTY_REGION
        )

    def _middle_of(self, feature: Feature) -> Floats:
        centre = feature.attributes.get("centre", feature.sizes.get("centre"))
        if not isinstance(centre, tuple) or len(centre) < 2:
            raise Refused(
                f"{feature.id}: nothing says where it is, it has neither a floor nor a centre; machine it by hand"
            )
        point = np.array([centre[0], centre[1], centre[2] if len(centre) > 2 else 0.0])
        return self.setup.frame.to_local(self.recognition.frame.to_world(point))[:2]


def _up_to_walls(band: Band, over: Band, on_floor: Floats, grow: float) -> Band:
    """Return a band whose section still lies in the fillet of its floor, which holds a point (2,): grown to the walls it would reach.

    The walls of the band over it, where they are not rounded, bound it; where a lip stands instead, its side is the wall that the fillet
    rises to, as far as the space behind the lip.
    """

    def grown(area: Region, bound: Region) -> Region:
        own = holding(area, [on_floor])
        rest = area.minus(own.offset(tolerance.SEW))
        return own.offset(grow).intersect(bound).minus(rest.offset(tolerance.OFF_PLANE)).union(rest)

    return replace(
        band,
        wanted=grown(band.wanted, over.wanted),
        boundary=grown(band.boundary, over.boundary),
    )


def above_fillets(z: float, fillets: Mapping[float, float]) -> float:
    """Return where the walls over a height are no more rounded by the fillets (radius by floor height) of floors at or below it.

    >>> above_fillets(9.0, {5.0: 6.0, 8.5: 1.0, 8.9: 0.05}), above_fillets(9.0, {5.0: 2.0})
    (11.0, 9.0)
    """
    return max([z, *(floor + radius for floor, radius in fillets.items() if floor <= z)])


def number(feature: Feature, name: str, default: float = 0.0) -> float:
    """Return a size of a feature as a number, the smallest when it has several."""
    value = feature.sizes.get(name, default)
    if isinstance(value, tuple):
        return float(min(value, default=default))
    return default if isinstance(value, str) else float(value)


def floor_fillet(feature: Feature) -> float:
    """Return the radius between a feature's floor and walls, 0 when it is sharp."""
    return number(feature, "floor_fillet")


def parent_of(feature: Feature, recognition: Recognition) -> Feature | None:
    """Return the feature that a feature is in or is sunk into, or None."""
    for name in ("in", "nested_in"):
        value = feature.sizes.get(name, feature.attributes.get(name))
        for other in recognition:
            if isinstance(value, str) and other.id == value:
                return other
    return None


def holding(region: Region, points: Iterable[Floats]) -> Region:
    """Return the pieces of a region that hold one of the points (2,)."""
    where = np.array(list(points))
    if not region or not len(where):
        return EMPTY_REGION
    return Region(tuple(p for p in region.pieces if Region((p,)).contains(where).any()))


def enclosed(material: Region, points: Iterable[Floats]) -> Region:
    """Return the spaces that material encloses and that hold one of the points (2,), without what is in them.

    They are holes of its pieces, so their curves are the section's own.
    """
    where = np.array(list(points))
    found = []
    for hole in (h.reversed() for p in material.pieces for h in p.holes):
        space = Region((Piece(hole),))
        if space.contains(where).any():
            island_walls = tuple(
                p.outer.reversed()
                for p in material.pieces
                if space.contains(p.outer.points[:1]).all()
            )
            inner = Region((Piece(hole, island_walls),))
            if inner.contains(where).any():
                found.append(inner.pieces[0])
    return Region(tuple(found))


def touching(region: Region, other: Region) -> Region:
    """Return the pieces of a region that share area with another region."""
    return Region(
        tuple(
            piece.pieces[0]
            for piece in region.split()
            if piece.intersect(other).area > tolerance.AREA
        )
    )


def filled_over(region: Region, points: Iterable[Floats]) -> Region:
    """Return a region without the holes that have one of the points (2,) in them."""
    where = np.array(list(points))
    if not len(where):
        return region
    return Region(
        tuple(
            Piece(
                p.outer,
                tuple(
                    h for h in p.holes if not Region((Piece(h.reversed()),)).contains(where).any()
                ),
            )
            for p in region.pieces
        )
    )


def runs(curve: Curve, keep: Bools) -> list[Curve]:
    """Return the runs of successive segments of a curve that are kept (n,) as open curves; the curve itself when all are."""
    wanted = np.asarray(keep, dtype=bool)
    if wanted.all():
        return [curve]
    if not wanted.any():
        return []
    n, before = curve.n_segments, np.roll(wanted, 1)
    if not curve.closed:
        before[0] = False
    first = int(np.argmax(wanted & ~before))
    found: list[list[Curve]] = []
    for k in range(n):
        i = (first + k) % n
        if wanted[i]:
            one = Curve(
                np.stack([curve.points[i], curve.points[(i + 1) % len(curve.points)]]),
                np.array([curve.bulges[i], 0.0]),
                False,
            )
            if k and before[i]:
                found[-1].append(one)
            else:
                found.append([one])
    return [joined(group) for group in found]


def on_rim(curve: Curve, region: Region) -> Bools:
    """Return for each segment of a curve (n,) whether its middle lies on the boundary of a region."""
    segments = curve.segments()
    middles = segments.at(np.arange(len(segments)), 0.5 * segments.length)
    return np.abs(region.signed_distance(middles)) < tolerance.SEW


def same_curve(a: Curve, b: Curve) -> bool:
    """Return whether two curves run along each other from end to end, both closed or both open."""
    if a.closed != b.closed or abs(a.length - b.length) >= tolerance.SEW:
        return False
    if a.closed and abs(a.area - b.area) >= tolerance.SEW * max(a.length, 1.0):
        return False
    return bool((a.distance(b.points) < tolerance.SEW).all())


def _crest(graph: FaceGraph, row: int, frame: Frame) -> float:
    """Return the height of the highest line of a lying hollow cylinder, minus infinity where the face has none: between its samples the
    vault of a hole in a wall is higher than these, and a section there would run out through it."""
    if graph.surface[row] != "cylinder" or graph.bend[row] >= 0:
        return -np.inf
    axis = frame.local_direction(graph.axis[row])
    if abs(float(axis[2])) > tolerance.ANGLE:
        return -np.inf
    around = axis_frame(graph.axis_point[row], graph.axis[row])
    up = around.local_direction(frame.z)
    if not holds(arcs(graph, graph.edges_of[row], around), float(np.arctan2(up[1], up[0]))):
        return -np.inf
    return float(frame.to_local(graph.axis_point[row])[2] + graph.radius[row])


def _upper_edges(graph: FaceGraph, row: int, frame: Frame) -> tuple[float, ...]:
    """Return the heights of a face's edges with faces that lie level and look up, each once."""
    up = frame.local_direction(graph.normal)[:, 2] > np.cos(tolerance.ANGLE)
    edges = [
        e
        for e in graph.edges_of[row]
        if up[graph.across(e, row)]
        and graph.surface[graph.across(e, row)] == "plane"
        and graph.convexity[e] == CONVEX
    ]
    heights = frame.to_local(graph.middle[edges])[:, 2] if edges else np.zeros(0)
    return tuple(_distinct(heights.tolist()))


def _distinct(heights: Iterable[float]) -> list[float]:
    """Return heights from the highest down, those closer than a sewing gap once."""
    kept: list[float] = []
    for z in sorted(heights, reverse=True):
        if not kept or kept[-1] - z > tolerance.SEW:
            kept.append(z)
    return kept


def _section_height(high: float, low: float, rim: float, fillet: float) -> float:
    """Return the height of the section that speaks for a band: over the fillet at its foot and below the lowest rim."""
    ceiling = min(high, rim)
    foot = low + fillet
    return (
        0.5 * (foot + ceiling)
        if ceiling - foot > tolerance.OFF_PLANE
        else ceiling - 0.5 * tolerance.OFF_PLANE
    )
