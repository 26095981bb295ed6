"""The walls of a blade: whether they are ruled from root to tip, how far they lean out of the meridian, and how thick the blade is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import cKDTree

from trunnion.geometry.arrays import Floats
from trunnion.progress import Progress
from trunnion.recognize.impeller.lines import (
    ALONG,
    MeridianCurve,
    SurfacePoints,
    meridian_of,
    trimmed_lines,
)
from trunnion.units import degrees

if TYPE_CHECKING:
    from trunnion.part.shape.exact import ExactFace

LINES = 33
"""Lines of a face that are compared with their chords."""
OPPOSITE = 0.7
"""Part of the step between two nearest points of the walls that must be square to them: beyond the end of one nothing is opposite."""
RULED = 0.02
"""mm: walls whose lines stay so near to their chords are ruled: what sizes are given to."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SizePoint:
    """A value of a size with the point (x, y, z) in the frame of the wheel that it is measured at."""

    value: float
    at: tuple[float, ...] = ()


def ruling_deviation(
    faces: Sequence[ExactFace], hub: MeridianCurve, progress: Progress
) -> SizePoint:
    """Return the largest distance (mm) of walls' lines across the flow, from root fillet to tip, from their chords.

    The lines are those of one of a face's two parameters: of the one along which they rise steepest from the hub.
    """
    worst = SizePoint(value=0.0)
    for face in faces:
        progress.check()
        both = [_lines(face, hub, way) for way in (0, 1)]
        lines = max(both, key=lambda found: found[1])[0]
        for line in lines:
            chord = line[-1] - line[0]
            length = float(np.linalg.norm(chord))
            if length <= 0.0:
                continue
            off = np.linalg.norm(np.cross(line - line[0], chord), axis=1) / length
            far = int(off.argmax())
            if off[far] > worst.value:
                worst = SizePoint(value=float(off[far]), at=tuple(line[far].tolist()))
    return worst


def _lines(face: ExactFace, hub: MeridianCurve, way: int) -> tuple[list[Floats], float]:
    """Return the lines (ALONG, 3) of a face along one parameter, each from its first point inside the trim to its last, and how steeply
    they rise from the hub on average: height over length."""
    found, rise = [], []
    share = np.linspace(0.0, 1.0, ALONG)[:, None]
    for first, last in trimmed_lines(face, way, LINES):
        line = face.at(first + share * (last - first)).point
        found.append(line)
        position = meridian_of(line[[0, -1]])
        height = np.linalg.norm(position - hub.foot(position)[0], axis=1)
        length = np.linalg.norm(np.diff(line, axis=0), axis=1).sum()
        rise.append(abs(float(height[1] - height[0])) / max(float(length), 1e-12))
    return found, float(np.mean(rise)) if rise else -1.0


def largest_lean(points: SurfacePoints, hub: MeridianCurve) -> SizePoint:
    """Return the largest lean of walls in degrees: the angle to the meridian of the line on the wall that stands square over the hub's
    flow."""
    if not len(points.point):
        return SizePoint(value=0.0)
    parts = points.parts
    up = hub.directions(points.meridian)[1]
    rise = parts[:, 0] * up[:, 0] + parts[:, 2] * up[:, 1]
    lean = np.arctan2(np.abs(rise), np.abs(parts[:, 1]))
    row = int(lean.argmax())
    return SizePoint(value=degrees(float(lean[row])), at=tuple(points.point[row].tolist()))


def thickness(ahead: SurfacePoints, behind: SurfacePoints) -> tuple[SizePoint, SizePoint]:
    """Return the least and the largest thickness (mm) of a blade: from points of one wall to the plane that touches the other nearest to
    them."""
    if not len(ahead.point) or not len(behind.point):
        return SizePoint(value=0.0), SizePoint(value=0.0)
    nearest = cKDTree(behind.point).query(ahead.point)[1]
    step = ahead.point - behind.point[nearest]
    away = np.abs((step * behind.normal[nearest]).sum(axis=1))
    opposite = np.flatnonzero(away > OPPOSITE * np.linalg.norm(step, axis=1))
    if not len(opposite):
        return SizePoint(value=0.0), SizePoint(value=0.0)
    thin, thick = (int(opposite[pick(away[opposite])]) for pick in (np.argmin, np.argmax))
    return tuple(  # type: ignore[return-value]
        SizePoint(value=float(away[k]), at=tuple(ahead.point[k].tolist())) for k in (thin, thick)
    )
