"""What fixtures keep a cutter from, seen along the tool: it is cut off a plane drive before passes are laid.

Below its top a fixture is taken as solid down to the table: no upright tool gets under a clamp. A fixture that is nowhere higher than the
blank's underside carries the blank, and a cutter may come down to it.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from trunnion import tolerance
from trunnion.findings import Finding, face_tags, warning
from trunnion.geometry.arrays import Floats
from trunnion.geometry.plane.region import EMPTY_REGION, Region, union_all
from trunnion.geometry.plane.shadow import shadow_above
from trunnion.model.blank import Blank
from trunnion.model.fixture import Fixture
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.plan.prismatic.drive import DriveLevel, PlaneDrive

SMALLEST = 1.0
"""mm2: less that is cut off needs no word."""
KEPT_OFF = "fixture.kept-off"
"""Code of the finding on what a fixture keeps a cutter from."""


@dataclass(frozen=True, slots=True, eq=False)
class HeldFixture:
    """A fixture in a setup's frame: corners (t, 3, 3) of its triangles that are seen from above, its top, and the height `foot` up to
    which it carries the blank."""

    name: str
    corners: Floats
    top: float
    foot: float
    _shadows: dict[float, Region] = field(init=False, repr=False, default_factory=dict)

    @staticmethod
    def of(fixture: Fixture, setup: Setup, blank: Blank) -> HeldFixture:
        """Return a fixture as it stands in a setup."""
        corners = setup.frame.to_local(fixture.mesh.corners().reshape(-1, 3)).reshape(-1, 3, 3)
        across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        seen = np.abs(across[:, 2]) > tolerance.PARAMETRIC * np.linalg.norm(across, axis=1)
        foot = float(blank.box_in(setup.frame)[0][2]) + tolerance.SEW
        return HeldFixture(fixture.name, corners[seen], float(corners[:, :, 2].max()), foot)

    def keeps_out(self, tool: Tool, z: float) -> Region:
        """Return what the envelope of an upright cutter must stay out of, its tip at a height or higher, for all of the tool to keep
        its room from the fixture."""
        found = []
        for above, radius in tool_rings(tool):
            height = max(z + above - tolerance.FIXTURE_ROOM, self.foot)
            if self.top > height + tolerance.COINCIDENT:
                more = radius - tool.radius + tolerance.FIXTURE_ROOM
                found.append(self._over(height).offset(more))
        return union_all(found) if found else EMPTY_REGION

    def changes(self, tool: Tool) -> list[float]:
        """Return the heights of the tip over which less of the tool is beside the fixture than below."""
        if self.top <= self.foot:
            return []
        return [self.top + tolerance.FIXTURE_ROOM - above for above, _ in tool_rings(tool)]

    def _over(self, z: float) -> Region:
        if z not in self._shadows:
            self._shadows[z] = shadow_above(self.corners, z)
        return self._shadows[z]


def tool_rings(tool: Tool) -> list[tuple[float, float]]:
    """Return from which height above the tip a tool is how wide: (mm, radius in mm) of the cutter and of all that is wider."""
    wider = [
        (z0, max(r0, r1))
        for z0, r0, _, r1 in tool.profile()
        if max(r0, r1) > tool.radius + tolerance.COINCIDENT
    ]
    return [(0.0, tool.radius), *wider]


def off_fixtures(
    drive: PlaneDrive, tool: Tool, setup: Setup, blank: Blank
) -> tuple[PlaneDrive, tuple[Finding, ...]]:
    """Return a drive without what the fixtures of its setup keep a cutter from, and a finding that names it.

    Levels are parted where less of the tool is beside a fixture: over a low clamp all is cut that was wanted.
    """
    fixtures = [HeldFixture.of(f, setup, blank) for f in setup.fixtures]
    if not fixtures:
        return drive, ()
    levels = [part for level in drive.levels for part in _parted(level, fixtures, tool)]
    cut = [_cut(level, fixtures, tool) for level in levels]
    floors = tuple(
        replace(f, region=f.region.minus(_keep_out(fixtures, tool, f.z, f.region)))
        for f in drive.floors
    )
    lost = [(level, was.wanted.minus(level.wanted)) for level, was in zip(cut, levels, strict=True)]
    kept = replace(drive, levels=tuple(cut), floors=tuple(f for f in floors if f.region))
    return kept, _findings(drive, lost, fixtures, tool, setup)


def kept_off(
    what: str, area: float, by: Iterable[str], tool: Tool, at: Floats, where: Sequence[str]
) -> Finding:
    """Return the finding on an area in mm2 of something that fixtures keep a cutter from; `at` (3,) is in it, in the part's coordinates."""
    x, y, z = (float(v) + 0.0 for v in at)
    return warning(
        KEPT_OFF,
        f"{area:.0f} mm2 of {what} at x {x:.1f} y {y:.1f} z {z:.1f} are left out: fixture {', '.join(by)} is in the way of {tool.name}",
        *where,
        remedy="move the fixture, or finish what it covers in another setup",
    )


def _parted(level: DriveLevel, fixtures: Sequence[HeldFixture], tool: Tool) -> list[DriveLevel]:
    low, high = level.bottom + tolerance.SEW, level.top - tolerance.SEW
    near = [f for f in fixtures if f.keeps_out(tool, level.bottom).intersect(level.boundary)]
    heights = sorted({z for f in near for z in f.changes(tool) if low < z < high}, reverse=True)
    ends = [level.top, *heights, level.bottom]
    return [
        replace(level, top=a, bottom=b) if heights else level for a, b in itertools.pairwise(ends)
    ]


def _cut(level: DriveLevel, fixtures: Sequence[HeldFixture], tool: Tool) -> DriveLevel:
    out = _keep_out(fixtures, tool, level.bottom, level.boundary)
    if not out:
        return level
    return replace(level, wanted=level.wanted.minus(out), boundary=level.boundary.minus(out))


def _keep_out(fixtures: Sequence[HeldFixture], tool: Tool, z: float, near: Region) -> Region:
    """Return what all fixtures keep a cutter out of at a height, those that don't come to a region left out."""
    found = [f.keeps_out(tool, z) for f in fixtures]
    found = [r for r in found if r and r.intersect(near)]
    return union_all(found) if found else EMPTY_REGION


def _findings(
    drive: PlaneDrive,
    lost: Sequence[tuple[DriveLevel, Region]],
    fixtures: Sequence[HeldFixture],
    tool: Tool,
    setup: Setup,
) -> tuple[Finding, ...]:
    """Return one finding on the most that is cut off a level, none where nothing is."""
    level, area = max(lost, key=lambda one: one[1].area, default=(None, EMPTY_REGION))
    if level is None or area.area < SMALLEST:
        return ()
    low, high = area.box()
    at = setup.frame.to_world(np.array([*(0.5 * (low + high)), level.bottom]))
    by = [f.name for f in fixtures if f.keeps_out(tool, level.bottom).intersect(area)]
    where = (drive.feature, *face_tags(drive.faces))
    return (kept_off(drive.feature, area.area, by, tool, at, where),)
