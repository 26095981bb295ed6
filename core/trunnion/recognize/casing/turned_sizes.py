"""Sizes of what is turned on a casing: pockets by their bottom, profiles by their diameters and which side of the wall they are on."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from trunnion.model.feature import Size
from trunnion.recognize.casing.faces import CasingFaces
from trunnion.recognize.casing.meridian import Meridian
from trunnion.recognize.casing.pockets import PocketFaces
from trunnion.tolerance import SLIVER
from trunnion.units import degrees, rounded

FACING = 0.3
"""Cosine between a normal and the direction to the axis from which on a face is the other side of a wall, not a flange or a rim."""
HEIGHTS = 101
"""Heights at which the thickness of a wall is looked at: every millimetre or two of a pocket."""


def pocket_sizes(faces: CasingFaces, pocket: PocketFaces) -> dict[str, Any]:
    """Return `sizes` and `attributes` of a pocket: heights and radii of its bottom's ends, its half angle, how thick the wall under it is,
    whether it runs round."""
    meridian = Meridian.of(faces, pocket.bottom)
    first, last = meridian.ends
    radii = float(meridian.low[0]), float(meridian.high[-1])
    sizes: dict[str, Size] = {
        "z_low": rounded(first),
        "z_high": rounded(last),
        "radius_low": rounded(radii[0]),
        "radius_high": rounded(radii[1]),
        "half_angle": rounded(degrees(float(np.arctan2(radii[1] - radii[0], last - first)))),
        "bosses": len(pocket.bosses),
        **_wall(faces, meridian),
    }
    attributes: dict[str, Size] = {
        "where": "outside" if meridian.outward > 0.0 else "inside",
        "full_circle": any(faces.runs_round(r) for r in pocket.bottom),
    }
    return {"sizes": sizes, "attributes": attributes}


def _wall(faces: CasingFaces, meridian: Meridian) -> dict[str, Size]:
    """Return the smallest and the largest thickness of the wall under a bottom, mm: across it, to the turned faces of the other side.

    Nothing where no such face lies behind all of it; holes through the wall and what stands on its other side don't count.
    """
    graph = faces.graph
    behind = [
        Meridian.of(faces, [r])
        for r in np.flatnonzero(faces.turned & ~faces.across).tolist()
        if r not in faces.holes and faces.meridian_normals[r][0] * meridian.outward < -FACING
        if graph.box_high[r, 2] > meridian.ends[0] and graph.box_low[r, 2] < meridian.ends[1]
    ]
    first, last = meridian.ends
    at = first + (last - first) * (np.arange(HEIGHTS) + 0.5) / HEIGHTS
    radius = meridian.radius(at)
    gap = np.full(HEIGHTS, np.inf)
    for other in behind:
        inside = (at >= other.ends[0]) & (at <= other.ends[1])
        apart = meridian.outward * (radius - other.radius(at))
        gap = np.where(inside & (apart > SLIVER), np.minimum(gap, apart), gap)
    if not np.isfinite(gap).any():
        return {}
    thick = (gap * np.abs(meridian.normal(at)[:, 0]))[np.isfinite(gap)]
    return {
        "wall_thickness": rounded(float(thick.min())),
        "wall_thickness_max": rounded(float(thick.max())),
    }


def profile_sizes(faces: CasingFaces, rows: Sequence[int]) -> dict[str, Any]:
    """Return `sizes` and `attributes` of a profile: its ends along the axis, its smallest and largest diameter, the diameters of its
    cylinders on the inner and the outer side, and how many grooves and ring ribs it has."""
    graph, mine = faces.graph, list(rows)
    edges = sorted({e for r in rows for e in graph.edges_of[r]})
    owned = np.isin(graph.sample_face, mine)
    points = np.concatenate(
        [graph.sample_point[owned], graph.start[edges], graph.middle[edges], graph.end[edges]]
    )
    away = np.linalg.norm(points[:, :2], axis=1)
    sizes: dict[str, Size] = {
        "z_low": rounded(float(points[:, 2].min())),
        "z_high": rounded(float(points[:, 2].max())),
        "smallest_diameter": rounded(2.0 * float(away.min())),
        "largest_diameter": rounded(2.0 * float(away.max())),
    }
    for name, bend in (("inner_diameters", -1), ("outer_diameters", 1)):
        found = sorted(
            {
                rounded(2.0 * float(graph.radius[r]))
                for r in rows
                if graph.surface[r] == "cylinder" and graph.bend[r] == bend
            }
        )
        if found:
            sizes[name] = tuple(found)
    sides = {"inside" if graph.bend[r] < 0 else "outside" for r in rows if graph.bend[r] != 0}
    attributes: dict[str, Size] = {
        "where": next(iter(sides)) if len(sides) == 1 else "inside and outside" if sides else "end"
    }
    return {"sizes": sizes, "attributes": attributes}
