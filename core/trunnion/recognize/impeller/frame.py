"""The frame of a wheel: z along its axis to the inlet."""

from __future__ import annotations

import numpy as np

from trunnion.geometry.facegraph import FaceGraph
from trunnion.geometry.frame import Frame
from trunnion.recognize.impeller.coordinates import CylindricalSamples
from trunnion.tolerance import SLIVER


def wheel_frame(graph: FaceGraph, samples: CylindricalSamples) -> Frame:
    """Return the frame with z along the axis to the inlet and x nearest to the file's. Its origin is the file's own where that lies on the
    axis, between the ends of the wheel: a designer put it there; else the axis's point at the back."""
    axis = samples.axis
    edges = np.concatenate([graph.start, graph.middle, graph.end, graph.sample_point])
    height = axis.height(edges)
    home = np.zeros((1, 3))
    at = float(axis.height(home)[0])
    is_on = float(np.linalg.norm(axis.away(home))) < SLIVER
    if not (is_on and height.min() - SLIVER <= at <= height.max() + SLIVER):
        at = float(height.min())
    return Frame(axis.point + at * axis.direction, samples.zero, axis.direction)
