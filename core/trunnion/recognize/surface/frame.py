"""The frame of a part of curved surfaces: one side that sees all its curved faces is where it is milled from, however it lies in its file.

A part whose curved faces look to several sides, such as a blade, keeps its file's frame: no single direction is right for it.
"""

from __future__ import annotations

import numpy as np

from trunnion.geometry.arrays import Bools, Floats
from trunnion.geometry.facegraph import FaceGraph
from trunnion.geometry.frame import WORLD, Frame
from trunnion.tolerance import ANGLE
from trunnion.units import radians

FACING = radians(5.0)
"""A position is seen from a direction when its normal rises by this at least: upright walls are cut from the side anyway, in radians."""
AWAY = 0.02
"""Share of the curved area that may look away from a direction that sees the part's curved side: edges rounded on the back."""
AS_GOOD = 0.9
"""Share of what the best direction sees from which on the file's own z is kept: a designer who drew the part upright meant it."""


def frame_of(graph: FaceGraph) -> Frame:
    """Return the frame whose z sees the largest curved area among the main directions from which nothing curved looks away; the file's own
    where that sees nearly as much, or where there is none."""
    curved = (np.array(graph.surface) != "plane") & (graph.area > 0.0)
    most = AWAY * float(graph.area[curved].sum())
    seen = [
        (_seen(graph, curved, direction), direction)
        for direction in _directions(graph)
        if _seen(graph, curved, -direction) <= most
    ]
    area, best = max(seen, key=lambda found: found[0], default=(0.0, WORLD.z))
    if _seen(graph, curved, WORLD.z) >= AS_GOOD * area:
        return WORLD
    return Frame(np.zeros(3), _across(best), best)


def _seen(graph: FaceGraph, curved: Bools, direction: Floats) -> float:
    """Return the curved area (mm2) whose normals rise towards a direction; each sample of a face represents its share of it."""
    each = np.bincount(graph.sample_face, minlength=len(graph.surface))[graph.sample_face]
    rises = (graph.sample_normal @ direction > np.sin(FACING)) & curved[graph.sample_face]
    return float((graph.area[graph.sample_face] / each)[rises].sum())


def _directions(graph: FaceGraph) -> list[Floats]:
    """Return the file's axes and the normals of planes, both senses, each once."""
    planes = graph.normal[(np.array(graph.surface) == "plane") & (graph.area > 0.0)]
    found: list[Floats] = []
    for direction in (*np.eye(3)[::-1], *-np.eye(3)[::-1], *planes, *-planes):
        if not any(direction @ known > np.cos(ANGLE) for known in found):
            found.append(np.asarray(direction, dtype=float))
    return found


def _across(direction: Floats) -> Floats:
    """Return the unit direction across a direction that is nearest to the file's x, or to its y where that is along it."""
    for axis in np.eye(3)[:2]:
        across = axis - (axis @ direction) * direction
        length = float(np.linalg.norm(across))
        if length > 0.5:
            return np.asarray(across / length, dtype=float)
    raise AssertionError("no direction is along x and y at once")
