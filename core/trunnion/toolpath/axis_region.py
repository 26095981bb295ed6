"""Where a cutter's axis may be."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from trunnion import tolerance
from trunnion.findings import Refused
from trunnion.geometry.arrays import Floats
from trunnion.geometry.plane.curve import Curve
from trunnion.geometry.plane.curve_parts import SPACING
from trunnion.geometry.plane.region import Region, union_all
from trunnion.plan.prismatic.drive import DriveLevel, PlaneDrive

OPEN_MARGIN = 0.5
"""mm: a boundary that runs on past the wanted area by more than this is open there."""


@dataclass(frozen=True, slots=True, eq=False)
class AxisRegion:
    """The plane area where the axis may be at one height."""

    region: Region

    @staticmethod
    def of(boundary: Region, distance: float, *, mitred: bool = False) -> AxisRegion:
        """Return the axis region that keeps `distance` from the rim of `boundary`.

        Round a sharp edge of the part the axis may go in an arc; when `mitred`, only straight on to where both its walls' passes meet: a
        fillet at the foot of such walls is mitred at their edge, and a cutter that went round would cut into the mitre.
        """
        axis_region = boundary.offset(-distance)
        return AxisRegion(
            axis_region.minus(union_all(_mitres(boundary, distance)))
            if mitred and axis_region
            else axis_region
        )

    def off(self, frame: Region, radius: float) -> AxisRegion:
        """Return what of it keeps a cutter of a radius out of an area, itself where that is empty."""
        return (
            AxisRegion(self.region.minus(frame.offset(radius - tolerance.SEW))) if frame else self
        )

    def depth(self, points: ArrayLike) -> Floats:
        """Return how far inside the axis region points (k, 2) are (negative outside)."""
        return self.region.signed_distance(np.atleast_2d(np.asarray(points, dtype=np.float64)))

    def holds(self, points: ArrayLike) -> bool:
        """Return whether all points (k, 2) are in the axis region, its rim included."""
        return bool(self.region) and bool((self.depth(points) >= -tolerance.ON_REGION).all())

    def holds_line(self, start: ArrayLike, end: ArrayLike) -> bool:
        """Return whether the straight path between two points (2,) stays in the axis region."""
        a, b = np.asarray(start, dtype=np.float64)[:2], np.asarray(end, dtype=np.float64)[:2]
        count = max(2, int(np.hypot(*(b - a)) / SPACING) + 2)
        return self.holds(a + np.linspace(0.0, 1.0, count)[:, None] * (b - a))


class AxisRegions:
    """Axis regions that are asked for again and again, made once each."""

    def __init__(self) -> None:
        self._made: dict[tuple[int, float, bool], tuple[Region, AxisRegion]] = {}

    def of(self, boundary: Region, distance: float, *, mitred: bool = False) -> AxisRegion:
        """Return the axis region of a boundary, as `AxisRegion.of` makes it."""
        key = (id(boundary), distance, mitred)
        if key not in self._made:
            # The boundary is kept as well: another one can't get its number then.
            self._made[key] = boundary, AxisRegion.of(boundary, distance, mitred=mitred)
        return self._made[key][1]


def is_closed(level: DriveLevel) -> bool:
    """Return whether a band's walls close it all round: its boundary does not run on past what is wanted."""
    return not level.boundary.minus(level.wanted.offset(OPEN_MARGIN))


def _mitres(boundary: Region, distance: float) -> list[Region]:
    """Return the kites between the sharp edges of the part in a boundary's rim and the meeting points of the passes beside them."""
    kites = []
    for curve in boundary.curves():
        seg = curve.segments()
        straight = np.isnan(seg.radius)
        before = np.roll(np.arange(len(seg)), 1)
        directions = np.divide(seg.end - seg.start, seg.length[:, None])
        turns = directions[before, 0] * directions[:, 1] - directions[before, 1] * directions[:, 0]
        # The region lies on the left: where its rim turns right by more than a blend does, the part has a sharp edge.
        for k in np.flatnonzero(straight & straight[before] & (turns < -np.sin(tolerance.TANGENT))):
            left = (
                np.array([[-w[1], w[0]] for w in (directions[before[k]], directions[k])]) * distance
            )
            along = left.sum(axis=0)
            tip = along * (2.0 * distance**2 / (along @ along))
            kites.append(
                Region.of(
                    [Curve.polygon(seg.start[k] + np.array([np.zeros(2), left[1], tip, left[0]]))]
                )
            )
    return kites


def level_at(drive: PlaneDrive, z: float) -> DriveLevel:
    """Return the band of a drive that the tip is in at a height: a height on two bands belongs to the upper one.

    Raises `Refused` when the drive has no levels.
    """
    if not drive.levels:
        raise Refused(
            f"{drive.feature}: nothing says where the cutter may be; give the operation's drive its levels"
        )
    for level in drive.levels:
        if z >= level.bottom - tolerance.SEW:
            return level
    return drive.levels[-1]
