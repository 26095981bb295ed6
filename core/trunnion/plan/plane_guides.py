"""Guide lines of plane curves: their points, and how the elements of walls' follow each other."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Floats
from trunnion.geometry.plane.curve import Curve
from trunnion.geometry.plane.region import Region
from trunnion.model.guides import GuideCurve, GuideKind, LinkRelation

ToWorld = Callable[[Floats], Floats]
"""Takes points (n, 3) of a drive's frame to the part's coordinates."""


def wall_line(
    kind: GuideKind, curve: Curve, z: float, faces: tuple[int, ...], to_world: ToWorld
) -> GuideCurve:
    """Return the guide line of a wall's curve, the part on its right, at a height in mm."""
    corners, relations = relations_along(curve)
    return GuideCurve(
        kind=kind,
        points=to_world(_at_height(curve.sampled(tolerance.PICTURE), z)),
        corners=to_world(_at_height(corners, z)),
        relations=relations,
        faces=faces,
    )


def area_lines(
    area: Region, z: float, faces: tuple[int, ...], to_world: ToWorld
) -> tuple[GuideCurve, ...]:
    """Return the rims of an area at a height in mm."""
    return tuple(
        GuideCurve(
            kind=GuideKind.AREA,
            points=to_world(_at_height(curve.sampled(tolerance.PICTURE), z)),
            corners=np.zeros((0, 3)),
            faces=faces,
        )
        for curve in area.curves()
    )


def line_along(
    kind: GuideKind, points: Floats, faces: tuple[int, ...], to_world: ToWorld
) -> GuideCurve:
    """Return the guide line through points (n, 3) of a drive's frame."""
    return GuideCurve(kind=kind, points=to_world(points), corners=np.zeros((0, 3)), faces=faces)


def relations_along(curve: Curve) -> tuple[Floats, tuple[LinkRelation, ...]]:
    """Return where elements of a wall's curve meet (k, 2), and how the next follows there: where the curve turns left the next wall stands
    in the tool's way, where it turns right the tool goes past the end of this one."""
    parts = curve.segments()
    first = np.arange(len(parts) if curve.closed else len(parts) - 1)
    after = (first + 1) % len(parts)
    before_it = parts.directions(first, parts.length[first])
    after_it = parts.directions(after, np.zeros(len(after)))
    sine = before_it[:, 0] * after_it[:, 1] - before_it[:, 1] * after_it[:, 0]
    angle = np.arctan2(sine, (before_it * after_it).sum(axis=1))
    relations = tuple(
        LinkRelation.TANGENT
        if abs(a) <= tolerance.TANGENT
        else LinkRelation.TO
        if a > 0.0
        else LinkRelation.PAST
        for a in angle.tolist()
    )
    return parts.end[first], relations


def _at_height(points: Floats, z: float) -> Floats:
    return np.column_stack([points, np.full(len(points), z)])
