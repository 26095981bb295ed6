"""Drive geometry: what an operation is driven by, rebuilt from face tags through the part's sections whenever it is wanted.

Everything here lies in the SETUP frame (`Setup.frame`: z up to the spindle, z = 0 where the work offset is, so parts mostly lie below
zero), in mm. Regions and curves are lines and arcs in that frame's xy. Nothing here is corrected for a cutter: a strategy offsets by its
own radius.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from trunnion import tolerance
from trunnion.findings import Refused
from trunnion.geometry.arrays import Ints
from trunnion.geometry.plane.curve import Curve
from trunnion.geometry.plane.region import EMPTY_REGION, Region
from trunnion.model.feature import Feature
from trunnion.model.guides import GuideCurve, GuideKind
from trunnion.model.operation import Operation
from trunnion.model.process import ProcessTree
from trunnion.model.tabs import Tab, tabs_of
from trunnion.plan.plane_guides import GuideSpace, area_lines, wall_faces_on, wall_line
from trunnion.plan.prismatic.pits import PIT, pit_space
from trunnion.plan.prismatic.regions import (
    Band,
    SetupSpace,
    above_fillets,
    floor_fillet,
    on_rim,
    parent_of,
    runs,
    same_curve,
    touching,
)
from trunnion.plan.prismatic.tabs import frame_behind
from trunnion.plan.settings import HALVES
from trunnion.settings import added


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class DriveLevel:
    """What is to be cleared between two heights, `top` above `bottom`; the same plan area everywhere in the band.

    `wanted`: the plan area whose material the operation shall remove, with vertical walls up to `bottom` (a fillet at the foot is
    suppressed: `Floor.fillet` says how large it is). `boundary`: where the cutter's envelope may be in this band. It contains `wanted`,
    follows the walls of the finished part, and runs on past open sides by plenty. The tip's axis may thus be in
    `boundary.offset(-radius)` and has to reach all of `wanted`. `bottom` is a face of the finished part wherever the next level's
    `wanted` is smaller (a floor, an island's top), and the last level's everywhere.
    """

    top: float
    bottom: float
    wanted: Region
    boundary: Region


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Floor:
    """A horizontal floor to be finished at height `z`: `region` up to the vertical walls (as if there was no fillet), `fillet` the radius
    between floor and walls (0: sharp), `face` the tag of the part's face (0: none, as for the plane of an end face made of several)."""

    z: float
    region: Region
    fillet: float
    face: int


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class WallGuide:
    """A guide line for a wall: the wall's plan curve, THE PART'S MATERIAL ON THE RIGHT of its direction.

    So a cutter with M3 that follows the curve on its left side climbs: a pocket's outer loop runs anticlockwise, an island's and the
    outer profile's loop clockwise. `curve` is closed for a wall all round; open (its ends at the open side) otherwise, and a lead may run
    past both ends within the level's boundary. The wall stands from `bottom` (the floor's height, or where the wall ends) to `top`;
    `fillet` is the radius at its foot (0: sharp); `faces` the tags of walls, corner blends and floor fillets that are finished along it.
    `run_of` is all of the wall's curve where a person left faces out and `curve` is a run of what is left: past its ends goes a wall that
    is not to be cut.
    """

    curve: Curve
    top: float
    bottom: float
    fillet: float
    faces: tuple[int, ...]
    run_of: Curve | None = None

    @property
    def is_around(self) -> bool:
        """Whether the part's material is inside a closed guide line, as of an island."""
        return self.loop.closed and self.loop.area < 0.0

    @property
    def loop(self) -> Curve:
        """All of the wall's curve."""
        return self.curve if self.run_of is None else self.run_of

    def line(self, kind: GuideKind, space: GuideSpace) -> GuideCurve:
        """Return the guide line at the wall's foot."""
        return wall_line(kind, self.curve, self.bottom, self.faces_on(space), self.faces, space)

    def faces_on(self, space: GuideSpace) -> Ints:
        """Return the face (m,) of each segment of the curve, 0 where none of `faces` is found there."""
        foot = min(self.bottom + self.fillet, self.top)
        return wall_faces_on(self.curve, foot, self.top, self.faces, space)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PlaneDrive:
    """All that a plane strategy needs to know of the geometry.

    `levels` go down from the top and touch each other, except those that go up again to what the one before them had to leave over its
    bottom: their `top` is that one's. `floors` and `walls` carry the finished heights. `fillet`: the largest radius at
    the foot of the walls. A cutter with corner radius rc < fillet whose tip is t above a floor must keep
    e = (rf - rc) - sqrt((rf - rc)^2 - (rf - rc - t)^2) more than its radius from the wall while t < rf - rc, with rf the fillet
    (`foot_clearance`); a corner radius of rf comes out exactly. `stock_top`: the height of the material over the feature when the
    operation begins (the blank's top before facing, the part's top after). `wall_allowance`, `floor_allowance`: what a roughing operation
    leaves (0 for finishing); `levels`, `floors` and `walls` are the finished part's, allowances not taken off. `earlier_radius`: radius of
    the cutter that was in the corners before (rest roughing and corners; 0: none), `earlier_allowance` what it left on the walls.
    `kept`: what of `wall_allowance` the feature keeps when the program has run; `earlier_allowance` has it too.
    `faces`: the tags that the operation finishes. `beside`: walls that are not finished, but whose feet the cutter must stay off.
    `tabs`: bridges from an outline to the blank's frame that stay, `frame` the plan area of that frame, which no pass clears.
    """

    feature: str
    kind: str
    levels: tuple[DriveLevel, ...]
    floors: tuple[Floor, ...] = ()
    walls: tuple[WallGuide, ...] = ()
    beside: tuple[WallGuide, ...] = ()
    fillet: float = 0.0
    stock_top: float = 0.0
    faces: tuple[int, ...] = ()
    wall_allowance: float = 0.0
    floor_allowance: float = 0.0
    earlier_radius: float = 0.0
    earlier_allowance: float = 0.0
    tabs: tuple[Tab, ...] = added((), written=False)
    frame: Region = added(EMPTY_REGION, written=False)
    kept: float = added(0.0, written=False)

    @property
    def finishes(self) -> bool:
        """Whether nothing stays on the walls for later operations: only what the feature keeps."""
        return self.wall_allowance <= self.kept and self.floor_allowance <= 0.0

    @property
    def top(self) -> float:
        """The height where the first level begins."""
        return self.levels[0].top

    @property
    def bottom(self) -> float:
        """The height where the last level ends."""
        return self.levels[-1].bottom

    @property
    def is_empty(self) -> bool:
        """Whether no level has material that is wanted away."""
        return not any(level.wanted for level in self.levels)

    def guides(self, space: GuideSpace) -> tuple[GuideCurve, ...]:
        """Return the walls' guide lines at their feet, those of walls beside, and the rims of floors; without walls and floors those of
        what is cleared in each level."""
        walls = (
            *(w.line(GuideKind.WALL, space) for w in self.walls),
            *(w.line(GuideKind.FOOT, space) for w in self.beside),
        )
        floors = [
            line
            for f in self.floors
            for line in area_lines(f.region, f.z, (f.face,) if f.face else (), space)
        ]
        if walls or floors:
            return (*walls, *floors)
        return tuple(
            line
            for level in self.levels
            for line in area_lines(level.wanted, level.bottom, (), space)
        )


def foot_clearance(fillet: float, corner_radius: float, above: float) -> float:
    """Return how much further than its radius a cutter stays from a wall, its tip `above` a floor that meets the wall in a fillet.

    >>> foot_clearance(3.0, 0.0, 0.0), foot_clearance(3.0, 3.0, 0.0), foot_clearance(3.0, 1.0, 2.0)
    (3.0, 0.0, 0.0)
    """
    gap = fillet - corner_radius
    if above >= gap:
        return 0.0
    return float(gap - (gap**2 - (gap - max(above, 0.0)) ** 2) ** 0.5)


WALL_ALLOWANCE, FLOOR_ALLOWANCE = "route.wall_allowance", "route.floor_allowance"
"""Keys of an operation's choices that hold what it leaves on walls and floors, mm."""

KEPT_ON_WALLS, KEPT_ON_FLOORS = "feature.wall_allowance", "feature.floor_allowance"
"""Keys of an operation's choices that hold what its feature keeps on purpose on walls, and on floors or its top, mm."""

HALF_OVERLAP = 1.0
"""mm that halves of the outline cut from both sides go on past its middle, so that no film stays between them."""

OF_POCKETS = ("rough", "corner", "corner_finish", "floor", "wall", "foot")
"""Kinds of operation that a pocket's drive serves."""

FINISHES_OUTLINE = "profile_finish"
"""Kind of operation that finishes an outline all round."""

OF_OUTLINES = ("profile_rough", FINISHES_OUTLINE)
"""Kinds of operation that an outline's drive serves."""

IN_CORNERS = ("corner", "corner_finish")
"""Kinds of operation in corners, of pockets and of outlines."""


def drive_of(operation: Operation, process: ProcessTree, space: SetupSpace) -> PlaneDrive:
    """Return the drive geometry of an operation in the frame of the space's setup, from tags and sections alone.

    Raises `Refused` when the part's sections do not bear the feature out.
    """
    if operation.kind == "face":
        return _face(operation, space)
    feature = next((f for f in space.recognition if f.id == operation.feature), None)
    if feature is None:
        raise Refused(
            f"{operation.id}: its feature {operation.feature} is not there any more; delete the operation, or route again"
        )
    if operation.kind in OF_OUTLINES or (
        operation.kind in IN_CORNERS and feature.kind == "profile"
    ):
        return _profile(operation, process, feature, space)
    if operation.kind in OF_POCKETS:
        return _pocket(operation, process, feature, space)
    if operation.kind in ("rib_top", "boss_top"):
        return _free_top(operation, feature, space)
    if operation.kind == "island_top":
        return _island_top(operation, feature, space)
    if operation.kind == PIT:
        return _pit(operation, feature, space)
    raise Refused(
        f"{operation.id}: no drive geometry is known for operations of kind {operation.kind}"
    )


def _face(operation: Operation, space: SetupSpace) -> PlaneDrive:
    area, top = space.blank_area(), float(space.blank_high[2])
    tags = operation.faces
    level = DriveLevel(top=top, bottom=space.top, wanted=area, boundary=space.around())
    floor = Floor(z=space.top, region=area, fillet=0.0, face=tags[0] if tags else 0)
    return PlaneDrive(
        feature=operation.feature,
        kind=operation.kind,
        levels=(level,),
        floors=(floor,),
        stock_top=top,
        faces=tags,
    )


def _pocket(
    operation: Operation, process: ProcessTree, feature: Feature, space: SetupSpace
) -> PlaneDrive:
    bands = space.bands_of(feature)
    feet = [space.fillet_at(feature, z) for z in space.floors_of(feature).values()]
    own = max(feet, default=floor_fillet(feature))
    fillet = max([own, *map(floor_fillet, space.islands_of(feature))])
    earlier = _earlier(operation, process)
    floors = _floors(feature, bands, space)
    walls = _pocket_walls(feature, bands, space)
    beside: tuple[WallGuide, ...] = ()
    if operation.kind in ("rough", "corner"):
        floors += _island_tops(feature, bands, space)
    elif operation.kind == "foot":
        sharper = _sharper_feet(walls, floors, own)
        floors, walls, beside = (), sharper, walls
    return PlaneDrive(
        feature=feature.id,
        kind=operation.kind,
        levels=tuple(_level(b) for b in bands),
        floors=floors,
        walls=walls,
        beside=beside,
        fillet=fillet,
        stock_top=bands[0].top,
        faces=operation.faces,
        wall_allowance=_choice(operation, WALL_ALLOWANCE),
        floor_allowance=_choice(operation, FLOOR_ALLOWANCE),
        earlier_radius=earlier.cutter.radius if earlier else 0.0,
        earlier_allowance=_choice(earlier, WALL_ALLOWANCE) if earlier else 0.0,
    )


def _floors(feature: Feature, bands: tuple[Band, ...], space: SetupSpace) -> tuple[Floor, ...]:
    found = []
    islands = max(map(floor_fillet, space.islands_of(feature)), default=0.0)
    for tag, z in space.floors_of(feature).items():
        for n, band in enumerate(bands):
            if abs(band.bottom - z) < tolerance.SEW:
                below = bands[n + 1].wanted if n + 1 < len(bands) else None
                region = (
                    touching(
                        band.wanted.minus(below), space.part.face_outline(space.setup.frame, tag)
                    )
                    if below
                    else band.wanted
                )
                fillet = max(space.fillet_at(feature, z), islands)
                found.append(Floor(z=z, region=region, fillet=fillet, face=tag))
    return tuple(found)


def _island_tops(feature: Feature, bands: tuple[Band, ...], space: SetupSpace) -> tuple[Floor, ...]:
    frame = space.setup.frame
    return tuple(
        Floor(
            z=space.island_top(island),
            region=space.part.face_outline(frame, tag),
            fillet=0.0,
            face=tag,
        )
        for island in space.islands_of(feature)
        for tag in island.with_role("top")
        if bands[-1].bottom < space.island_top(island) < bands[0].top - tolerance.SEW
    )


def _pocket_walls(
    feature: Feature, bands: tuple[Band, ...], space: SetupSpace
) -> tuple[WallGuide, ...]:
    """Return the guide lines of a pocket, each as tall as the bands that share it; a lower one begins above the step's fillet."""
    floors = space.floors_of(feature).values()
    fillets = {z: space.fillet_at(feature, z) for z in floors}
    guides: list[WallGuide] = []
    for n, band in enumerate(bands):
        stepped = n > 0 and any(abs(z - band.top) < tolerance.SEW for z in floors)
        on_floor = any(abs(z - band.bottom) < tolerance.SEW for z in floors)
        fillet, over = (space.fillet_at(feature, z) for z in (band.bottom, band.top))
        for curve in _walled(feature, band):
            above = next(
                (
                    k
                    for k, g in enumerate(guides)
                    if abs(g.bottom - band.top) < tolerance.SEW and same_curve(g.curve, curve)
                ),
                None,
            )
            top = band.top if above is None else guides[above].top
            if above is None and n > 0:
                start = band.top + over if stepped else band.top
                top = min(max(start, above_fillets(band.top, fillets)), bands[0].top)
            island = _island_of(feature, curve, space)
            foot = fillet if island is None else floor_fillet(island)
            bottom = band.bottom if on_floor else above_fillets(band.bottom, fillets)
            if bottom > top - tolerance.SEW:
                continue
            guide = WallGuide(
                curve=curve,
                top=top,
                bottom=bottom,
                fillet=foot if on_floor else 0.0,
                faces=_wall_faces(feature, island),
            )
            if above is None:
                guides.append(guide)
            else:
                guides[above] = guide
    return tuple(guides)


def _walled(feature: Feature, band: Band) -> list[Curve]:
    """Return the loops of a band where they follow the part, the open side left out."""
    if feature.kind != "open_pocket":
        return list(band.wanted.curves())
    return [
        run for curve in band.wanted.curves() for run in runs(curve, on_rim(curve, band.boundary))
    ]


def _sharper_feet(
    walls: tuple[WallGuide, ...], floors: tuple[Floor, ...], fillet: float
) -> tuple[WallGuide, ...]:
    """Return the feet that are sharper than a pocket's fillet: what its walls' cutter, as round as the fillet, leaves around islands."""
    return tuple(
        replace(wall, top=min(wall.top, wall.bottom + fillet))
        for wall in walls
        if wall.fillet < fillet - tolerance.COINCIDENT
        and any(abs(floor.z - wall.bottom) < tolerance.SEW for floor in floors)
    )


def _island_of(feature: Feature, curve: Curve, space: SetupSpace) -> Feature | None:
    """Return the island that a guide line runs around, or None where it follows the pocket's own walls."""
    if not curve.closed or curve.area >= 0.0:
        return None
    inside = Region.of([curve])
    for island in space.islands_of(feature):
        at = island.with_role("top") or island.with_role("wall", "corner", "floor_fillet")
        if at and inside.contains(space.centre(at[0])[:2]).any():
            return island
    return None


def _wall_faces(feature: Feature, island: Feature | None) -> tuple[int, ...]:
    """Return the tags along a guide line: an island's own around an island, else the pocket's."""
    return (feature if island is None else island).with_role("wall", "corner", "floor_fillet")


def _free_top(operation: Operation, feature: Feature, space: SetupSpace) -> PlaneDrive:
    tags, frame = feature.with_role("top"), space.setup.frame
    if not tags:
        raise Refused(f"{feature.id}: it has no top face; give it one or suppress {operation.id}")
    z = float(space.centre(tags[0])[2])
    wanted = space.part.face_outline(frame, tags[0])
    for tag in tags[1:]:
        wanted = wanted.union(space.part.face_outline(frame, tag))
    wanted = wanted.minus(space.hanging_over(z + tolerance.OFF_PLANE, wanted))
    if not wanted:
        raise Refused(f"{feature.id}: the part hangs over all of its top; suppress {operation.id}")
    boundary = _free_over(z, wanted, space)
    walls = tuple(
        WallGuide(curve=run, top=space.top, bottom=z, fillet=0.0, faces=())
        for curve in wanted.curves()
        for run in runs(curve, on_rim(curve, boundary))
    )
    return _top(operation, feature, space, z, wanted, boundary, walls)


def _free_over(z: float, wanted: Region, space: SetupSpace) -> Region:
    """Return where a cutter may be at the height of a top of the part: free at the part's top as well, for under a wall that leans over no
    cutter gets in from above."""
    beside = tolerance.OFF_PLANE
    return touching(
        space.free_near(z + beside, wanted).intersect(space.free_near(space.top - beside, wanted)),
        wanted,
    )


def _island_top(operation: Operation, feature: Feature, space: SetupSpace) -> PlaneDrive:
    tags, pocket = feature.with_role("top"), parent_of(feature, space.recognition)
    if not tags or pocket is None:
        raise Refused(
            f"{feature.id}: it has no top face or stands in no pocket; give it both or suppress {operation.id}"
        )
    z = float(space.centre(tags[0])[2])
    if space.is_freeform(pocket):
        wanted = space.part.face_outline(space.setup.frame, tags[0])
        return _top(operation, feature, space, z, wanted, _free_over(z, wanted, space), ())
    over = next((b for b in space.bands_of(pocket) if abs(b.bottom - z) < tolerance.SEW), None)
    if over is None:
        raise Refused(
            f"{feature.id}: its top at z {z:.3f} of {space.setup.name} lies outside {pocket.id}; correct the feature"
        )
    return _top(
        operation,
        feature,
        space,
        z,
        space.part.face_outline(space.setup.frame, tags[0]),
        over.boundary,
        (),
    )


def _pit(operation: Operation, feature: Feature, space: SetupSpace) -> PlaneDrive:
    """Return the drive of a pit: a level over it, in which nothing is wanted and whose boundary is free for what follows the disc of a
    T-slot cutter, and one of its own."""
    pit = pit_space(feature, space)
    walls = tuple(
        WallGuide(curve=run, top=pit.roof, bottom=pit.floor, fillet=pit.fillet, faces=feature.tags)
        for curve in pit.wanted.curves()
        for run in runs(curve, on_rim(curve, pit.beside))
    )
    return PlaneDrive(
        feature=feature.id,
        kind=operation.kind,
        levels=(
            DriveLevel(top=pit.top, bottom=pit.roof, wanted=EMPTY_REGION, boundary=pit.over),
            DriveLevel(top=pit.roof, bottom=pit.floor, wanted=pit.wanted, boundary=pit.beside),
        ),
        walls=walls,
        fillet=pit.fillet,
        stock_top=pit.top,
        faces=operation.faces,
    )


def _top(
    operation: Operation,
    feature: Feature,
    space: SetupSpace,
    z: float,
    wanted: Region,
    boundary: Region,
    walls: tuple[WallGuide, ...],
) -> PlaneDrive:
    level = DriveLevel(top=space.top, bottom=z, wanted=wanted, boundary=boundary)
    floor = Floor(z=z, region=wanted, fillet=0.0, face=feature.with_role("top")[0])
    return PlaneDrive(
        feature=feature.id,
        kind=operation.kind,
        levels=(level,),
        floors=(floor,),
        walls=walls,
        stock_top=space.top,
        faces=operation.faces,
    )


def _profile(
    operation: Operation, process: ProcessTree, feature: Feature, space: SetupSpace
) -> PlaneDrive:
    outline, earlier = space.silhouette(), _earlier(operation, process)
    tabs = tabs_of(operation.choices, operation.id)
    bottom = profile_bottom(space, operation.choices.get(HALVES) is True)
    level = DriveLevel(
        top=space.top,
        bottom=bottom,
        wanted=space.blank_area().minus(outline),
        boundary=space.around().minus(outline),
    )
    walls = tuple(
        WallGuide(
            curve=piece.outer.reversed(),
            top=space.top,
            bottom=bottom,
            fillet=0.0,
            faces=feature.tags,
        )
        for piece in outline.pieces
    )
    return PlaneDrive(
        feature=feature.id,
        kind=operation.kind,
        levels=(level,),
        walls=walls,
        stock_top=space.top,
        faces=operation.faces,
        wall_allowance=_choice(operation, WALL_ALLOWANCE),
        floor_allowance=0.0,
        earlier_radius=earlier.cutter.radius if earlier else 0.0,
        earlier_allowance=_choice(earlier, WALL_ALLOWANCE) if earlier else 0.0,
        tabs=tabs,
        frame=frame_behind(tabs, outline, space.blank_area()),
    )


def profile_bottom(space: SetupSpace, half: bool) -> float:
    """Return how deep the outline is cut: to the part's bottom, or past its middle where the other half is cut from the other side."""
    return 0.5 * (space.top + space.bottom) - HALF_OVERLAP if half else space.bottom


def _level(band: Band) -> DriveLevel:
    return DriveLevel(top=band.top, bottom=band.bottom, wanted=band.wanted, boundary=band.boundary)


def _earlier(operation: Operation, process: ProcessTree) -> Operation | None:
    """Return the operation that was in a feature's corners before this one."""
    if operation.kind not in IN_CORNERS:
        return None
    before = (
        ("wall", "profile_finish", "corner_finish")
        if operation.kind == "corner_finish"
        else ("rough", "profile_rough", "corner")
    )
    found = None
    for other in process.of_setup(operation.setup):
        if other.id == operation.id:
            break
        if other.feature == operation.feature and other.kind in before:
            found = other
    return found


def _choice(operation: Operation, key: str) -> float:
    value = operation.choices.get(key, 0.0)
    return float(value) if isinstance(value, (int, float)) else 0.0
