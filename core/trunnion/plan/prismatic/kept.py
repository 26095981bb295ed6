"""Plane drives that leave what features keep on purpose: floors are raised, cutters stay off walls by so much more.

A cutter also comes by walls of other features, as outside of an outline or over a low rib: there the area that it may use is narrower.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from trunnion import tolerance
from trunnion.geometry.plane.region import Region
from trunnion.model.operation import Operation
from trunnion.plan.prismatic.drive import KEPT_ON_FLOORS, KEPT_ON_WALLS, DriveLevel, PlaneDrive


def kept_by(operation: Operation) -> tuple[float, float]:
    """Return what an operation leaves on walls and on floors because its feature keeps it, mm."""
    wall, floor = (operation.choices.get(key, 0.0) for key in (KEPT_ON_WALLS, KEPT_ON_FLOORS))
    return (
        float(wall) if isinstance(wall, (int, float)) else 0.0,
        float(floor) if isinstance(floor, (int, float)) else 0.0,
    )


def with_kept(drive: PlaneDrive, wall: float, floor: float) -> PlaneDrive:
    """Return a drive whose floors lie `floor` mm higher, with the levels and walls that end at them, and whose walls keep `wall` mm.

    A level that the floors' allowance takes all of is none any more. Where a drive names no floors, its levels and walls all end at some.
    """
    heights = [f.z for f in drive.floors] or [
        *(level.bottom for level in drive.levels),
        *(guide.bottom for guide in drive.walls),
    ]

    def raised(z: float) -> float:
        return z + floor if any(abs(z - h) < tolerance.SEW for h in heights) else z

    levels = tuple(
        level
        for level in (
            replace(each, top=raised(each.top) if n else each.top, bottom=raised(each.bottom))
            for n, each in enumerate(drive.levels)
        )
        if level.top - level.bottom > tolerance.SEW
    )
    walls, beside = (
        tuple(
            replace(guide, bottom=raised(guide.bottom))
            for guide in guides
            if guide.top - raised(guide.bottom) > tolerance.SEW
        )
        for guides in (drive.walls, drive.beside)
    )
    return replace(
        drive,
        levels=levels or drive.levels,
        floors=tuple(replace(f, z=raised(f.z)) for f in drive.floors),
        walls=walls,
        beside=beside,
        wall_allowance=drive.wall_allowance + wall,
        earlier_allowance=drive.earlier_allowance + wall,
        kept=wall,
    )


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class KeptArea:
    """The plan area of a feature whose walls keep `amount` mm."""

    feature: str
    area: Region
    amount: float


def off_kept(drive: PlaneDrive, areas: Sequence[KeptArea]) -> PlaneDrive:
    """Return a drive whose levels leave free, at the walls in each area, what these keep: of a boundary b the rim b - (b offset by -a)."""
    if not areas:
        return drive
    return replace(drive, levels=tuple(_off(level, areas) for level in drive.levels))


def _off(level: DriveLevel, areas: Sequence[KeptArea]) -> DriveLevel:
    boundary = level.boundary
    for kept in areas:
        rim = level.boundary.minus(level.boundary.offset(-kept.amount)).intersect(kept.area)
        boundary = boundary.minus(rim) if rim else boundary
    return level if boundary is level.boundary else replace(level, boundary=boundary)
