"""The frame of a casing: the main axis by the vote of its faces of revolution, z from the lower end face to the upper one.

Which end is the lower one is as in the part's file, and so is x unless a person wants it through a boss.
"""

from __future__ import annotations

import numpy as np

from trunnion.findings import BadInput
from trunnion.geometry.arrays import Bools, Floats
from trunnion.geometry.facegraph import FaceGraph
from trunnion.geometry.frame import Frame
from trunnion.recognize.extent import box
from trunnion.recognize.revolution import RevolutionAxis, main_axis, of_revolution
from trunnion.tolerance import ANGLE

LEVEL = 1e-6
"""Share of a direction below which it has no part along an axis of the file: the noise of a turned part."""
ACROSS = 0.1
"""Length of what an axis of the file has across the main axis from which on it may be the frame's x."""


def casing_frame(graph: FaceGraph) -> Frame:
    """Return the frame with x as in the part's file; raise `BadInput` for a part without an axis."""
    axis = main_axis(graph) if len(graph) else None
    if axis is None:
        raise BadInput(
            "no face is of revolution about an axis: a casing needs one; choose another family with recognize.family"
        )
    z = _upward(axis.direction)
    x = next(e for e in np.eye(3) if np.linalg.norm(e - (e @ z) * z) > ACROSS)
    on_axis = Frame(axis.point, x, z)
    low, _ = box(graph.in_frame(on_axis))
    return on_axis.moved(np.array([0.0, 0.0, float(low[2])]))


def turned_about(frame: Frame, towards: Floats) -> Frame:
    """Return a frame turned about its z, its x towards a point (3,) given in it."""
    away = np.asarray(towards)
    across = np.array([away[0], away[1], 0.0])
    if np.linalg.norm(across) < ANGLE * max(float(np.linalg.norm(away)), 1.0):
        return frame
    return Frame(frame.origin, frame.world_direction(across), frame.z)


def turned_faces(graph: FaceGraph, frame: Frame) -> Bools:
    """Return which faces (n,) are of revolution about a frame's z."""
    return of_revolution(graph, RevolutionAxis(point=frame.origin, direction=frame.z))


def _upward(direction: Floats) -> Floats:
    """Return an axis's direction along the file's z, or where it lies across that, along its y, or x."""
    for k in (2, 1, 0):
        if abs(direction[k]) > LEVEL:
            return np.asarray(direction * np.sign(direction[k]))
    return direction
