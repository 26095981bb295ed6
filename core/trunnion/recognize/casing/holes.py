"""The holes of a casing: round openings in any direction that are narrower than its own bore."""

from __future__ import annotations

import numpy as np

from trunnion.geometry.facegraph import FaceGraph
from trunnion.geometry.frame import Frame
from trunnion.progress import Progress
from trunnion.recognize.casing.frame import turned_faces
from trunnion.recognize.casing.settings import CasingSettings
from trunnion.recognize.holes.hole import Hole
from trunnion.recognize.holes.recognize import find_holes
from trunnion.tolerance import ANGLE, SLIVER

OF_BORE = 0.01
"""Share of the part's area from which on a hollow turned face is part of the casing's bore; below, it is a groove or a small bore."""
NARROWER = 0.98
"""Share of the bore's diameter up to which an opening is a hole: a bore that is turned in steps may be known by its narrowest only."""


def casing_holes(
    graph: FaceGraph, frame: Frame, settings: CasingSettings, progress: Progress
) -> tuple[Hole, ...]:
    """Return the holes of a casing; what turns about its own axis is none. Raises `Cancelled` when asked to stop."""
    largest = settings.hole_diameter or NARROWER * _bore(graph, frame)
    found = find_holes(graph, largest, frame.z, progress)
    return tuple(h for h in found if not _on_axis(h, frame))


def _bore(graph: FaceGraph, frame: Frame) -> float:
    """Return the narrowest diameter (mm) of the hollow turned faces; of the whole part where it has none."""
    hollow = turned_faces(graph, frame) & (graph.bend < 0)
    hollow &= graph.area > OF_BORE * graph.area.sum()
    away = np.linalg.norm(frame.to_local(graph.sample_point)[:, :2], axis=1)
    mine = hollow[graph.sample_face]
    return 2.0 * float(away[mine].min() if mine.any() else away.max())


def _on_axis(hole: Hole, frame: Frame) -> bool:
    """Return whether a hole's axis is the main axis."""
    off = np.linalg.norm(frame.to_local(hole.mouth)[:2])
    return bool(abs(hole.direction @ frame.z) > np.cos(ANGLE) and off < SLIVER)
