"""Small parts with holes of every sort, built with cadquery, and their face graphs without a file between.

graph_of(drilled(flat_hole(8, 10)))             the face graph of a block with one blind hole in the middle of its top
drilled(through(8), (20, 20), (40, 20))         a block with holes at two positions
"""

from __future__ import annotations

from collections.abc import Sequence
from math import radians, tan
from typing import Any

import cadquery as cq
import numpy as np

from trunnion.geometry.facegraph import FaceGraph
from trunnion.part.topology.graph import face_graph
from trunnion.part.topology.identity import faces_of
from trunnion.recognize.holes.hole import Hole
from trunnion.recognize.holes.recognize import find_holes
from trunnion.recognize.holes.sizes import hole_sizes

LENGTH, WIDTH, HEIGHT = 60.0, 40.0, 20.0
"""mm: the block, a corner at the origin."""
MIDDLE = (20.0, 20.0)
OVER = 5.0
"""mm: how far cutters go past the faces that they come through."""
UP = np.array([0.0, 0.0, 1.0])


def graph_of(shape: Any) -> FaceGraph:
    """Return the face graph of a cadquery object or an OCP solid."""
    solid = shape.val().wrapped if isinstance(shape, cq.Workplane) else shape
    faces = dict(enumerate(faces_of(solid), start=1))
    return face_graph(solid, faces, len(faces))


def holes_in(shape: Any, largest: float = 30.0) -> tuple[Hole, ...]:
    """Return the holes of a shape."""
    return find_holes(graph_of(shape), largest, UP)


def sizes_in(shape: Any, largest: float = 30.0) -> list[dict[str, Any]]:
    """Return the sizes of the holes of a shape."""
    return [hole_sizes(h) for h in holes_in(shape, largest)]


def box(size: Sequence[float], at: Sequence[float] = (0.0, 0.0, 0.0)) -> cq.Workplane:
    """Return a box with its lowest corner at a point."""
    return cq.Workplane("XY").box(*size, centered=False).translate(tuple(at))


def block() -> cq.Workplane:
    """Return the plain block."""
    return box((LENGTH, WIDTH, HEIGHT))


def cylinder(
    diameter: float, length: float, at: Sequence[float], along: Sequence[float] = (0, 0, 1)
) -> cq.Workplane:
    """Return a cylinder from a point on its axis along a direction."""
    solid = cq.Solid.makeCylinder(diameter / 2.0, length, cq.Vector(*at), cq.Vector(*along))
    return cq.Workplane("XY").add(solid)


def cone(
    low: float, high: float, length: float, at: Sequence[float], along: Sequence[float] = (0, 0, 1)
) -> cq.Workplane:
    """Return a cone with the diameter `low` at a point and `high` at its other end."""
    solid = cq.Solid.makeCone(low / 2.0, high / 2.0, length, cq.Vector(*at), cq.Vector(*along))
    return cq.Workplane("XY").add(solid)


# Cutters: what a hole takes out of a block with its top at z 0, the axis along z through the origin


def through(diameter: float, thickness: float = HEIGHT) -> cq.Workplane:
    """Return a plain through hole."""
    return cylinder(diameter, thickness + 2.0 * OVER, (0, 0, -thickness - OVER))


def flat_hole(diameter: float, depth: float) -> cq.Workplane:
    """Return a blind hole with a flat bottom."""
    return cylinder(diameter, depth + OVER, (0, 0, -depth))


def pointed(diameter: float, depth: float, point: float = 118.0) -> cq.Workplane:
    """Return a blind hole with a drill point, `depth` to where that begins."""
    tip = 0.5 * diameter / tan(radians(point) / 2.0)
    return flat_hole(diameter, depth).union(cone(0.0, diameter, tip, (0, 0, -depth - tip)))


def counterbored(hole: cq.Workplane, diameter: float, depth: float) -> cq.Workplane:
    """Return a hole with a counterbore."""
    return hole.union(flat_hole(diameter, depth))


def countersunk(
    hole: cq.Workplane, diameter: float, own: float, angle: float = 90.0
) -> cq.Workplane:
    """Return a hole of the diameter `own` with a countersink."""
    deep = 0.5 * (diameter - own) / tan(radians(angle) / 2.0)
    return hole.union(cone(own, diameter, deep, (0, 0, -deep)))


def drilled(cutter: cq.Workplane, *at: Sequence[float]) -> cq.Workplane:
    """Return the block with a hole at positions (x, y), else at one."""
    found = block()
    for x, y in at or (MIDDLE,):
        found = found.cut(cutter.translate((x, y, HEIGHT)))
    return found


def halved(shape: cq.Workplane, y: float = MIDDLE[1]) -> cq.Workplane:
    """Return the same body with every face that the plane y crosses in two."""
    far = 1000.0
    low = shape.intersect(box((2 * far, far + y, 2 * far), (-far, -far, -far)))
    high = shape.intersect(box((2 * far, far, 2 * far), (-far, y, -far)))
    return low.union(high, clean=False)
