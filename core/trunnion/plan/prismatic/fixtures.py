"""What fixtures, or areas to avoid, keep a cutter from, seen along the tool: it is cut off a plane drive before passes are laid.

Below its top a fixture is taken as solid down to the table: no upright tool gets under a clamp. A fixture that is nowhere higher than the
blank's underside carries the blank, and a cutter may come down to it.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Protocol

import numpy as np

from trunnion import tolerance
from trunnion.findings import Finding, face_tags, warning
from trunnion.geometry.arrays import Floats
from trunnion.geometry.plane.curve import Curve
from trunnion.geometry.plane.plan_area import plan_area_above
from trunnion.geometry.plane.region import EMPTY_REGION, Region, union_all
from trunnion.model.blank import Blank
from trunnion.model.fixture import Fixture
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.plan.prismatic.drive import DriveLevel, PlaneDrive

SMALLEST = 1.0
"""mm2: less that is cut off needs no word."""
SPACING = 0.5
"""mm between the positions of a wall that are looked at."""
KEPT_OFF = "fixture.kept-off"
"""Code of the finding on what a fixture keeps a cutter from."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class KeepOutLevel:
    """What is cut off a level: mm2 in plan and of walls, a place there (3,) in the setup's frame, and the region that is kept out of."""

    plan: float
    walls: float
    at: Floats
    out: Region


@dataclass(frozen=True, slots=True, eq=False)
class PlanFixture:
    """A fixture in a setup's frame: corners (t, 3, 3) of its triangles that are seen from above, its top, and the height `foot` up to
    which it carries the blank."""

    name: str
    corners: Floats
    top: float
    foot: float
    _areas: dict[float, Region] = field(init=False, repr=False, default_factory=dict)

    @staticmethod
    def of(fixture: Fixture, setup: Setup, blank: Blank) -> PlanFixture:
        """Return a fixture as it stands in a setup."""
        corners = setup.frame.to_local(fixture.mesh.corners().reshape(-1, 3)).reshape(-1, 3, 3)
        across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        seen = np.abs(across[:, 2]) > tolerance.PARAMETRIC * np.linalg.norm(across, axis=1)
        foot = float(blank.box_in(setup.frame)[0][2]) + tolerance.SEW
        return PlanFixture(fixture.name, corners[seen], float(corners[:, :, 2].max()), foot)

    def keeps_out(self, tool: Tool, z: float, within: Region) -> Region:
        """Return what the envelope of an upright cutter must stay out of, its tip at a height or higher, for all of the tool to keep
        its room from the fixture; the same whatever region it is within."""
        found = []
        for above, radius in tool.rings():
            height = max(z + above - tolerance.FIXTURE_CLEARANCE, self.foot)
            if self.top > height + tolerance.COINCIDENT:
                more = radius - tool.radius + tolerance.FIXTURE_CLEARANCE
                found.append(self._over(height).offset(more))
        return union_all(found) if found else EMPTY_REGION

    def changes(self, tool: Tool) -> list[float]:
        """Return the heights of the tip over which less of the tool is beside the fixture than below."""
        if self.top <= self.foot:
            return []
        return [self.top + tolerance.FIXTURE_CLEARANCE - above for above, _ in tool.rings()]

    def _over(self, z: float) -> Region:
        if z not in self._areas:
            self._areas[z] = plan_area_above(self.corners, z)
        return self._areas[z]


class KeepOut(Protocol):
    """What keeps a cutter out of some of the plan: a fixture, or an area to avoid."""

    @property
    def name(self) -> str:
        """What a finding calls it."""

    def keeps_out(self, tool: Tool, z: float, within: Region) -> Region:
        """Return what the envelope of an upright cutter must stay out of, its tip at a height; elsewhere it may be `within`."""

    def changes(self, tool: Tool) -> list[float]:
        """Return the heights of the tip over which it keeps out of less."""


Notice = Callable[[str, str, Sequence[str], Tool, Floats, Sequence[str]], Finding]
"""How it is told what is left out: of what, its size in words, by what, the tool, a position (3,) in the part's coordinates, and the names
for `Finding.where`."""


def off_fixtures(
    drive: PlaneDrive, tool: Tool, setup: Setup, fixtures: Sequence[PlanFixture]
) -> tuple[PlaneDrive, tuple[Finding, ...]]:
    """Return a drive without what fixtures, as they stand in its setup, keep a cutter from, and a finding that names it."""
    return kept_out(drive, tool, setup, fixtures, kept_off)


def kept_out(
    drive: PlaneDrive, tool: Tool, setup: Setup, fixtures: Sequence[KeepOut], notice: Notice
) -> tuple[PlaneDrive, tuple[Finding, ...]]:
    """Return a drive without what a cutter is kept out of, and the finding that a notice makes of it.

    Levels are parted where less of the tool is beside a fixture: over a low clamp all is cut that was wanted.
    """
    levels = [part for level in drive.levels for part in _parted(level, fixtures, tool)]
    cut = [_cut(level, fixtures, tool) for level in levels]
    floors = tuple(
        replace(f, region=f.region.minus(_keep_out(fixtures, tool, f.z, f.region, within)))
        for f, within in ((f, _boundary(levels, f.z)) for f in drive.floors)
    )
    lost = [
        _lost(level, was, drive, tool, _of_level(fixtures, tool, was))
        for level, was in zip(cut, levels, strict=True)
    ]
    kept = replace(drive, levels=tuple(cut), floors=tuple(f for f in floors if f.region))
    found = [one for one in lost if one]
    return kept, _findings(drive, levels, found, fixtures, tool, setup, notice)


def _boundary(levels: Sequence[DriveLevel], z: float) -> Region:
    """Return where a cutter may be with its tip at a height: in the lowest level that reaches up to it, or the first."""
    return next((v for v in levels if v.bottom <= z + tolerance.SEW), levels[-1]).boundary


def kept_off(
    what: str, size: str, by: Sequence[str], tool: Tool, at: Floats, where: Sequence[str]
) -> Finding:
    """Return the finding on what of something fixtures keep a cutter from, its size in words; `at` (3,) is there, in the part's
    coordinates."""
    x, y, z = (float(v) + 0.0 for v in at)
    return warning(
        KEPT_OFF,
        f"{size} of {what} at x {x:.1f} y {y:.1f} z {z:.1f} are left out: fixture {', '.join(by)} is in the way of {tool.name}",
        *where,
        remedy="move the fixture, or finish what it covers in another setup",
    )


def _parted(level: DriveLevel, fixtures: Sequence[KeepOut], tool: Tool) -> list[DriveLevel]:
    low, high = level.bottom + tolerance.SEW, level.top - tolerance.SEW
    near = [f for f in fixtures if _of_level((f,), tool, level)]
    heights = sorted({z for f in near for z in f.changes(tool) if low < z < high}, reverse=True)
    ends = [level.top, *heights, level.bottom]
    return [
        replace(level, top=a, bottom=b) if heights else level for a, b in itertools.pairwise(ends)
    ]


def _cut(level: DriveLevel, fixtures: Sequence[KeepOut], tool: Tool) -> DriveLevel:
    out = _of_level(fixtures, tool, level)
    if not out:
        return level
    return replace(level, wanted=level.wanted.minus(out), boundary=level.boundary.minus(out))


def _of_level(fixtures: Sequence[KeepOut], tool: Tool, level: DriveLevel) -> Region:
    return _keep_out(fixtures, tool, level.bottom, level.boundary, level.boundary)


def _keep_out(
    fixtures: Sequence[KeepOut], tool: Tool, z: float, near: Region, within: Region
) -> Region:
    """Return what all fixtures keep a cutter out of that may be within a region at a height, those that don't come near left out."""
    found = [f.keeps_out(tool, z, within) for f in fixtures]
    found = [r for r in found if r and r.intersect(near)]
    return union_all(found) if found else EMPTY_REGION


def _lost(
    level: DriveLevel, was: DriveLevel, drive: PlaneDrive, tool: Tool, out: Region
) -> KeepOutLevel | None:
    """Return what is cut off a level: of its plan area, and of the walls along which the axis would be too near to a fixture."""
    if not out:
        return None
    plan, walls = was.wanted.minus(level.wanted), 0.0
    near, points = out.offset(tool.radius), []
    for guide in drive.walls:
        height = min(guide.top, was.top) - max(guide.bottom, was.bottom)
        point, left, step = _spread(guide.curve)
        met = near.contains(point + tool.radius * left) if height > 0.0 else np.zeros(0, bool)
        if met.any():
            walls += step * int(met.sum()) * height
            points.append(point[met])
    if plan:
        points.append(np.array(plan.box()))
    if not points or max(plan.area, walls) < SMALLEST:
        return None
    found = np.concatenate(points)
    middle = 0.5 * (found.min(axis=0) + found.max(axis=0))
    return KeepOutLevel(plan=plan.area, walls=walls, at=np.append(middle, level.bottom), out=out)


def _spread(curve: Curve) -> tuple[Floats, Floats, float]:
    """Return positions (k, 2) spread evenly along a curve, the normals (k, 2) to its left there, and how far they are apart in mm."""
    seg = curve.segments()
    count = max(1, math.ceil(curve.length / SPACING))
    s, ends = (np.arange(count) + 0.5) * (curve.length / count), np.cumsum(seg.length)
    rows = np.minimum(np.searchsorted(ends, s), len(seg) - 1)
    along = s - (ends[rows] - seg.length[rows])
    direction = seg.directions(rows, along)
    return (
        seg.at(rows, along),
        np.column_stack([-direction[:, 1], direction[:, 0]]),
        curve.length / count,
    )


def _findings(
    drive: PlaneDrive,
    levels: Sequence[DriveLevel],
    lost: Sequence[KeepOutLevel],
    fixtures: Sequence[KeepOut],
    tool: Tool,
    setup: Setup,
    notice: Notice,
) -> tuple[Finding, ...]:
    """Return one finding on what is cut off a drive, none where nothing is."""
    if not lost:
        return ()
    most = max(lost, key=lambda one: one.plan + one.walls)
    plan, walls = max(one.plan for one in lost), sum(one.walls for one in lost)
    sizes = [f"{plan:.0f} mm2 in plan"] if plan >= SMALLEST else []
    sizes += [f"{walls:.0f} mm2 of walls"] if walls >= SMALLEST else []
    within = _boundary(levels, float(most.at[2]))
    by = [
        f.name for f in fixtures if f.keeps_out(tool, float(most.at[2]), within).intersect(most.out)
    ]
    where = (drive.feature, *face_tags(drive.faces))
    at = setup.frame.to_world(most.at)
    return (notice(drive.feature, " and ".join(sizes), by, tool, at, where),)
