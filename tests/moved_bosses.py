"""A sibling of the casing A2: four of its bosses elsewhere along its circumference, three of them nearer to their neighbours."""

from __future__ import annotations

from typing import Any

import cadquery as cq
from OCP.ShapeUpgrade import ShapeUpgrade_UnifySameDomain

from parts import PARTS

INSIDE, OUTSIDE = 200.0, 360.0
"""Radii in mm between which all of A2's wall and bosses lie."""
SECTORS = (
    (167.0, 167.6, 176.6, 68.0, 116.0),
    (40.7, 41.7, 53.0, 45.0, 107.0),
    (137.0, 138.2, 149.0, 190.0, 250.0),
    (235.0, 255.0, 269.0, 188.0, 262.0),
)
"""Sectors that change places: an empty one from the first angle (degrees) to the second, then one with a boss up to the third, between two
heights (mm). The gaps beside the first three bosses shrink from 9.4 to 6.3 mm, 17.8 to 12.6 mm and 20.4 to 14.1 mm."""


def sibling_of_a2() -> Any:
    """Return the solid: A2's volume and number of faces, other gaps."""
    body = cq.importers.importStep(str(PARTS / "casing" / "A2.step")).val()
    for sector in SECTORS:
        body = _swapped(body.Solids()[0], *sector)
    return body.Solids()[0].wrapped


def _swapped(body: Any, first: float, middle: float, last: float, low: float, high: float) -> Any:
    """Return a body of revolution in which two neighbouring sectors have changed places, its seams gone."""
    empty = body.intersect(_sector(first, middle, low, high))
    boss = body.intersect(_sector(middle, last, low, high))
    made = body.cut(_sector(first, last, low, high)).fuse(
        _turned(empty, last - middle), _turned(boss, first - middle), tol=1e-5
    )
    joined = ShapeUpgrade_UnifySameDomain(made.wrapped, True, True, True)
    joined.Build()
    return cq.Shape.cast(joined.Shape())


def _turned(shape: Any, degrees: float) -> Any:
    return shape.rotate((0, 0, 0), (0, 0, 1), degrees)


def _sector(first: float, last: float, low: float, high: float) -> Any:
    """Return the sector between two angles and two heights as a solid."""
    outline = cq.Workplane("XZ").moveTo(INSIDE, low).lineTo(OUTSIDE, low)
    closed = outline.lineTo(OUTSIDE, high).lineTo(INSIDE, high).close()
    return _turned(closed.revolve(last - first, (0, 0, 0), (0, 1, 0)).val(), first)
