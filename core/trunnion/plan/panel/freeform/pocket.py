"""The space of a pocket with leaning walls or a curved floor: where an upright cutter may be over each of its floors and at each height.

Walls that lean away are narrowest at their foot, walls that lean over at their upper edge: what the vertical projection of everything above
leaves free is all that an upright cutter gets into.
"""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import dataclass, field

import numpy as np

from trunnion import tolerance
from trunnion.findings import Refused
from trunnion.geometry.plane.curve import Curve
from trunnion.geometry.plane.region import Region, union_all
from trunnion.model.feature import Feature
from trunnion.plan.freeform.reach import AreaSamples
from trunnion.plan.freeform.roughing.layers import LayerArea
from trunnion.plan.freeform.space import AROUND, SurfaceSpace
from trunnion.plan.prismatic.drive import DriveLevel, Floor, WallGuide
from trunnion.plan.prismatic.lean import SIDES, curved_floors, level_floors
from trunnion.plan.prismatic.regions import (
    SetupSpace,
    floor_fillet,
    number,
    on_rim,
    runs,
)

MARGIN = 1.0
"""mm that the map of a pocket goes on past its rim."""
LEAST_COVERED = 1.0
"""mm2: less of a floor that something hangs over is none."""
FLATTEST = math.radians(30.0)
"""Walls rise by at least this much from level: what rises less grows a pocket's rim by no more."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FreeformPocket:
    """A pocket that is more than upright walls round level floors, in the frame of its setup.

    `level` are the tags of its level floors, `curved` those of its curved ones, `sides` those of all that stands around and in it, islands'
    too. `bottom` and `top` are heights, `crest` that of the highest place of its floors, `rim` that of its lowest rim; `mouth` is the plan
    area that is free just below the rim; `ribs` are the shares of lower ribs' outlines that are beside it, with their heights. `growth` and
    `hang` are by how much its walls lean away and over at most, in mm a mm of height. `fillet` is the smallest radius at the
    foot of its sides, 0 where one is sharp. `near_overhangs`: faces hang over where its cutters go, of its own sides or of a neighbour
    that it joins over a lower rib; a rib as high as the pocket keeps necks off all that hangs over behind it.
    """

    feature: Feature
    space: SetupSpace
    level: tuple[int, ...]
    curved: tuple[int, ...]
    sides: tuple[int, ...]
    tops: tuple[float, ...]
    ribs: tuple[tuple[float, Region], ...]
    bottom: float
    crest: float
    top: float
    rim: float
    mouth: Region
    growth: float
    hang: float
    fillet: float
    near_overhangs: bool
    _floors: list[tuple[tuple[Floor, ...], tuple[DriveLevel, ...]]] = field(
        init=False, repr=False, default_factory=list
    )

    @staticmethod
    def of(
        feature: Feature, space: SetupSpace, curved: SurfaceSpace, beside: Collection[str]
    ) -> FreeformPocket:
        """Return the space of a pocket, with the features `beside` it by id; raise `Refused` where the part has no free space over it."""
        graph, frame = space.part.graph(), space.setup.frame
        islands = space.islands_of(feature)
        level = level_floors(feature, graph, frame)
        bent = curved_floors(feature, graph)
        if not (level or bent) or len(level) + len(bent) < len(feature.with_role("floor")):
            raise Refused(
                f"{feature.id}: it has no floor, or one that lies inclined; machine it by hand"
            )
        skin = curved.skin
        heights = [float(space.centre(t)[2]) for t in level]
        for t in bent:
            z = skin.points[skin.triangles[skin.of((t,))], 2]
            heights += [float(z.min()), float(z.max())]
        top = space.top_of(feature)
        lowest = number(feature, "lowest_rim_z")
        rim = min(space.height_in(feature, lowest), top) if "lowest_rim_z" in feature.sizes else top
        sides = tuple(dict.fromkeys(t for f in (feature, *islands) for t in f.with_role(*SIDES)))
        band = space.area_at(feature, rim - tolerance.OFF_PLANE)
        mouth = band.boundary.intersect(band.wanted.offset(AROUND))
        growth = _growth(curved, feature.with_role("outer_convergence", "corner"), 1.0)
        hang = _growth(curved, feature.with_role("inner_convergence", "corner"), -1.0)
        ribs = [f for f in space.recognition.of_kind("rib") if f.id in beside]
        # As far past the mouth as the thickest of them is thick: where ribs cross, one ends beyond another.
        thick = max((float(np.max(r.sizes.get("thickness", 0.0))) for r in ribs), default=0.0)
        past = thick + max(growth, hang) * (top - rim)
        return FreeformPocket(
            feature=feature,
            space=space,
            level=level,
            curved=bent,
            sides=sides,
            tops=tuple(space.island_top(i) for i in islands),
            ribs=tuple(
                (float(space.centre(t)[2]), own)
                for rib in ribs
                for t in rib.with_role("top")
                if (own := _beside(space.part.face_outline(frame, t), mouth, past))
            ),
            bottom=min(heights),
            crest=max(heights),
            top=top,
            rim=rim,
            mouth=mouth,
            growth=growth,
            hang=hang,
            fillet=min(floor_fillet(f) for f in (feature, *islands)),
            near_overhangs=_growth(curved, sides, -1.0) > 0.0 or rim < top - tolerance.SEW,
        )

    def limit(self, z: float) -> Region:
        """Return the plan area that is the pocket's at a height: below its lowest rim its mouth; above, where its space joins that of its
        neighbours, the same over the ribs between and grown as its walls lean."""
        over = [outline for height, outline in self.ribs if height <= z]
        return union_all([self.mouth, *over]).offset(
            self.growth * max(z - self.rim, 0.0) + tolerance.OFF_PLANE
        )

    def free_at(self, z: float) -> Region:
        """Return where nothing of the part is at a height or hangs over it, as far as that is the pocket's."""
        return self.space.free_near(z, self.mouth).intersect(self.limit(z))

    def holds(self, samples: AreaSamples) -> AreaSamples:
        """Return the samples that are the pocket's own, what hangs over among them: faces may run on into its neighbours."""
        return samples.of(self.under_overhangs().contains(samples.point[:, :2]))

    def under_overhangs(self) -> Region:
        """Return the plan area that is the pocket's with all that lies under its walls that lean over."""
        return self.limit(self.top).offset(self.hang * (self.top - self.bottom))

    def layer_area(self) -> LayerArea:
        """Return where the pocket is roughed by layers."""
        low, high = self.limit(self.top).box()
        z = float(self.space.blank_low[2]), float(self.space.blank_high[2])
        heights = [float(self.space.centre(t)[2]) for t in self.level]
        heights += [*self.tops, *(height for height, _ in self.ribs)]
        return LayerArea(
            low=np.array([*(low - MARGIN), z[0]]),
            high=np.array([*(high + MARGIN), z[1]]),
            level=tuple(sorted(set(heights), reverse=True)),
            within=self.limit,
        )

    def floors(self) -> tuple[tuple[Floor, ...], tuple[DriveLevel, ...]]:
        """Return the level floors from the highest down, as far as an upright cutter comes to them, and where it may be at their heights.

        A fillet at the foot is suppressed: a cutter with a corner radius up to the fillet's, that keeps its radius from the rim, covers the
        floor up to where the fillet begins (`plan.prismatic.drive.foot_clearance`). Found on first use.
        """
        if not self._floors:
            self._floors.append(self._found_floors())
        return self._floors[0]

    def overhang_rims(self) -> tuple[WallGuide, ...]:
        """Return the upper edges of walls that lean over level floors, seen from above: what stands outside of them down to the floor is
        cut by a flank that goes along them, like a wall's. Where a fillet at a wall's foot comes out from under its edge, the flank keeps
        off it as off the fillet of an upright wall there."""
        if self.hang <= 0.0:
            return ()
        found = []
        for level in self.floors()[1]:
            z = level.bottom + tolerance.OFF_PLANE
            hanging = self.space.hanging_over(z, level.wanted)
            if not hanging:
                continue
            material = self.space.section(z)
            feet = level.boundary.intersect(material)
            for curve in level.boundary.curves():
                rim = on_rim(curve, hanging) & ~on_rim(curve, material)
                found += [
                    WallGuide(
                        curve=run,
                        top=self.top,
                        bottom=level.bottom,
                        fillet=self.fillet if _meets(run, feet) else 0.0,
                        faces=(),
                    )
                    for run in runs(curve, rim)
                ]
        return tuple(found)

    def overhung_floors(self, past: float) -> tuple[tuple[int, ...], Region]:
        """Return the tags of level floors that something hangs over, and what of them it covers in plan, gone on by `past` mm."""
        tags, areas = list[int](), list[Region]()
        for tag in self.level:
            z = float(self.space.centre(tag)[2])
            outline = self.space.part.face_outline(self.space.setup.frame, tag)
            covered = outline.intersect(self.space.hanging_over(z + tolerance.OFF_PLANE, outline))
            if covered.area > LEAST_COVERED:
                tags.append(tag)
                areas.append(covered.offset(past).intersect(outline))
        return tuple(tags), union_all(areas)

    def _found_floors(self) -> tuple[tuple[Floor, ...], tuple[DriveLevel, ...]]:
        space, found = self.space, []
        for tag in self.level:
            z = float(space.centre(tag)[2])
            outline = space.part.face_outline(space.setup.frame, tag)
            covered = outline.offset(self.fillet)
            own = covered.minus(space.hanging_over(z + tolerance.OFF_PLANE, covered))
            if own:
                found.append(Floor(z=z, region=own, fillet=self.fillet, face=tag))
        floors = tuple(sorted(found, key=lambda f: (-f.z, f.face)))
        levels, above = [], space.top
        for z in dict.fromkeys(f.z for f in floors):
            wanted = union_all([f.region for f in floors if f.z == z])
            # What goes down to lower floors passes by here as well.
            below = union_all([f.region for f in floors if f.z <= z])
            free = space.area_at(self.feature, z + tolerance.OFF_PLANE).boundary
            boundary = free.intersect(below.offset(AROUND)).union(wanted)
            levels.append(DriveLevel(top=above, bottom=z, wanted=wanted, boundary=boundary))
            above = z
        return floors, tuple(levels)


def _meets(curve: Curve, region: Region) -> bool:
    """Return whether a curve runs along a region's boundary or into it somewhere."""
    if not region:
        return False
    segments = curve.segments()
    middles = segments.at(np.arange(len(segments)), 0.5 * segments.length)
    points = np.vstack([curve.points, middles])
    return bool((region.signed_distance(points) > -tolerance.SEW).any())


def _beside(outline: Region, mouth: Region, past: float) -> Region:
    """Return what of a rib's outline is no farther than `past` mm beside a mouth: a rib may go all across the part, past many pockets, each
    of which has its own share."""
    low, high = mouth.box()
    around = past + MARGIN
    return outline.intersect(Region.rectangle(*(low - around), *(high + around)))


def _growth(curved: SurfaceSpace, tags: tuple[int, ...], away: float) -> float:
    """Return by how much faces lean away (1) or over (-1) at most, in mm a mm of height; 0 where they stand upright to rounding."""
    skin = curved.skin
    normals = skin.normals[np.unique(skin.triangles[skin.of(tags)])]
    if not (away * normals[:, 2] > math.sin(tolerance.ANGLE)).any():
        return 0.0
    rise = math.pi / 2.0 - np.arcsin(np.clip(away * normals[:, 2], 0.0, 1.0))
    return float(1.0 / math.tan(max(float(rise.min()), FLATTEST)))
