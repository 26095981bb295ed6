"""Scallops between neighbouring passes of a round cutter, and the stepover that keeps them to a height.

A pass of radius R (of the cutter, across the feed) leaves circular grooves; on a face that is curved across the feed, of radius rho, the
grooves stand on a circle instead of a line. Ra of such a profile is the mean distance from its mean line.
"""

from __future__ import annotations

import math

import numpy as np

from trunnion.geometry.arrays import Floats

HEIGHT_PER_RA = 2.5
"""Scallop height per wanted Ra: 0.004 mm for Ra 1.6 um (quick segmentation, experiment). By geometry alone it would be 3.9
(`roughness`); the rest is for the machine, the cutter's wear and the feed marks."""


def height_of(ra: float) -> float:
    """Return the scallop height in mm that is asked for a wanted Ra in um."""
    return HEIGHT_PER_RA * ra / 1000.0


def roughness(height: float) -> float:
    """Return the Ra in um, by geometry alone, of parabolic grooves with a scallop height in mm: 4 h / (9 sqrt 3)."""
    return 1000.0 * height * 4.0 / (9.0 * math.sqrt(3.0))


def stepover_on_plane(radius: float, height: float) -> float:
    """Return the stepover (mm) of passes of a radius on a plane that leaves scallops of a height: 2 sqrt(2 R h - h^2)."""
    return 2.0 * math.sqrt(max(2.0 * radius * height - height * height, 0.0))


def scallop_on_plane(radius: float, stepover: float) -> float:
    """Return the scallop height (mm) that a stepover leaves on a plane."""
    return radius - math.sqrt(max(radius * radius - 0.25 * stepover * stepover, 0.0))


def stepover_on_curve(radius: float, height: float, curvature: Floats) -> Floats:
    """Return the stepover (n,) along faces with a curvature (n,) 1/mm across the feed, + convex, - hollow.

    sqrt(8 R h / (1 + R k)), which is sqrt(8 R h rho / (rho + R)). Infinite where a hollow is as round as the cutter: one pass fits it all.
    """
    share = 1.0 + radius * np.asarray(curvature, dtype=np.float64)
    return np.sqrt(
        np.divide(8.0 * radius * height, share, out=np.full(share.shape, np.inf), where=share > 0.0)
    )


def radius_across(radius: float, corner: float, lean: float) -> float:
    """Return the radius, across the feed, of the groove that a flat, bull or ball end leaves while it leads by an angle (radians).

    The corner's circle about the axis, seen along the feed, is an ellipse of half axes R - r and (R - r) sin(lead); where it is lowest it
    is as round as (R - r) / sin(lead), and the corner adds r. Without lead a bull end stands on its flat: infinite.
    """
    inner = radius - corner
    if inner <= 0.0:
        return corner
    return inner / math.sin(lean) + corner if lean > 0.0 else math.inf
