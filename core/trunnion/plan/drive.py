"""Drive geometry: what an operation is driven by, rebuilt from face tags through the part's sections whenever it is wanted.

Everything here lies in the SETUP frame (`Setup.frame`: z up to the spindle, z = 0 where the work offset is, so parts mostly lie below
zero), in mm. Regions and curves are lines and arcs in that frame's xy. Nothing here is corrected for a cutter: a strategy offsets by its
own radius.
"""

from __future__ import annotations

from dataclasses import dataclass

from trunnion.geometry.curve import Curve
from trunnion.geometry.region import Region


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class DriveLevel:
    """What is to be cleared between two heights, `top` above `bottom`; the same plan area everywhere in the band.

    `wanted`: the plan area whose material the operation shall remove, with vertical walls up to `bottom` (a fillet at the foot is
    suppressed: `Floor.fillet` says how large it is). `boundary`: where the cutter's envelope may be in this band. It contains `wanted`,
    follows the walls of the finished part, and runs on past open sides by plenty. The tip's axis may thus be in
    `boundary.offset(-radius)` and has to reach all of `wanted`.
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
    """

    curve: Curve
    top: float
    bottom: float
    fillet: float
    faces: tuple[int, ...]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PlaneDrive:
    """All that a plane strategy needs to know of the geometry.

    `levels` go down from the top and touch each other. `floors` and `walls` carry the finished heights. `fillet`: the largest radius at
    the foot of the walls. A cutter with corner radius rc < fillet whose tip is t above a floor must keep
    e = (rf - rc) - sqrt((rf - rc)^2 - (rf - rc - t)^2) more than its radius from the wall while t < rf - rc, with rf the fillet
    (`foot_clearance`); a corner radius of rf comes out exactly. `stock_top`: the height of the material over the feature when the
    operation begins (the blank's top before facing, the part's top after). `wall_allowance`, `floor_allowance`: what a roughing operation
    leaves (0 for finishing); `levels`, `floors` and `walls` are the finished part's, allowances not taken off. `earlier_radius`: radius of
    the cutter that was in the corners before (rest roughing and corners; 0: none), `earlier_allowance` what it left on the walls.
    `faces`: the tags that the operation finishes.
    """

    feature: str
    kind: str
    levels: tuple[DriveLevel, ...]
    floors: tuple[Floor, ...] = ()
    walls: tuple[WallGuide, ...] = ()
    fillet: float = 0.0
    stock_top: float = 0.0
    faces: tuple[int, ...] = ()
    wall_allowance: float = 0.0
    floor_allowance: float = 0.0
    earlier_radius: float = 0.0
    earlier_allowance: float = 0.0

    @property
    def top(self) -> float:
        """The height where the first level begins."""
        return self.levels[0].top

    @property
    def bottom(self) -> float:
        """The height where the last level ends."""
        return self.levels[-1].bottom


def foot_clearance(fillet: float, corner_radius: float, above: float) -> float:
    """Return how much further than its radius a cutter stays from a wall, its tip `above` a floor that meets the wall in a fillet.

    >>> foot_clearance(3.0, 0.0, 0.0), foot_clearance(3.0, 3.0, 0.0), foot_clearance(3.0, 1.0, 2.0)
    (3.0, 0.0, 0.0)
    """
    gap = fillet - corner_radius
    if above >= gap:
        return 0.0
    return float(gap - (gap**2 - (gap - max(above, 0.0)) ** 2) ** 0.5)
