"""The box around faces in any frame: only those that may reach farthest are asked."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve
from OCP.gp import gp_Trsf
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS

from trunnion import tolerance
from trunnion.geometry.arrays import Floats, Ints
from trunnion.geometry.facegraph import FaceGraph
from trunnion.geometry.frame import Frame
from trunnion.part.topology.canonical import recognised
from trunnion.part.topology.extent import Box, edge_extremes, face_box
from trunnion.part.topology.faces import TrimmedFace
from trunnion.part.topology.identity import Shape, edges_of
from trunnion.progress import NO_PROGRESS, Progress

ALONG_EDGE, GRID = 9, 13
"""Positions looked at along an edge, and along either side of a face, to tell what curve or surface it is."""


def box_in(
    frame: Frame,
    faces: Mapping[int, Shape],
    graph: FaceGraph,
    progress: Progress = NO_PROGRESS,
) -> Box:
    """Return the lowest and the highest corner (3,) of faces (by tag) in a frame.

    Exact where the farthest faces are plain ones, within `tolerance.FITTED` where they are free-form.
    Branch and bound: no face reaches farther than the corners of its box along the part's axes; the face that may reach farthest past
    what is known is asked exactly, until none may.
    """
    rows = np.array(sorted(faces)) - 1
    at_most_low, at_most_high = _around(graph, rows, frame)
    samples = graph.in_frame(frame)
    low, high = samples.box_low[rows].min(axis=0), samples.box_high[rows].max(axis=0)
    open_rows = np.ones(len(rows), dtype=bool)
    while True:
        progress.check()
        past = np.hstack([low - at_most_low, at_most_high - high]).max(axis=1)
        past[~open_rows] = -np.inf
        row = int(past.argmax())
        if past[row] <= tolerance.COINCIDENT:
            return low, high
        open_rows[row] = False
        own_low, own_high = _face_box_in(frame, faces[int(rows[row]) + 1], progress)
        low, high = np.minimum(low, own_low), np.maximum(high, own_high)


def _around(graph: FaceGraph, rows: Ints, frame: Frame) -> Box:
    """Return boxes (n, 3) in a frame around the boxes of faces along the part's axes."""
    sides = (graph.box_low[rows], graph.box_high[rows])
    corners = [
        frame.to_local(np.column_stack([sides[i][:, 0], sides[j][:, 1], sides[k][:, 2]]))
        for i in (0, 1)
        for j in (0, 1)
        for k in (0, 1)
    ]
    return np.min(corners, axis=0), np.max(corners, axis=0)


def _face_box_in(frame: Frame, face: Shape, progress: Progress) -> Box:
    """Return the box of one face in a frame."""
    turn = gp_Trsf()
    rows = np.column_stack([frame.axes, -frame.axes @ frame.origin]).tolist()
    turn.SetValues(*rows[0], *rows[1], *rows[2])
    view = TrimmedFace(TopoDS.Face_s(face.Moved(TopLoc_Location(turn))), 0)
    surface = recognised(view.adaptor, lambda: view.evaluated(view.grid(GRID)))
    rim = [BRepAdaptor_Curve(e) for e in edges_of(view.face) if not BRep_Tool.Degenerated_s(e)]
    extremes = [edge_extremes(adaptor, _points_along(adaptor)) for adaptor in rim]
    boundary = np.concatenate(extremes) if extremes else np.empty((0, 3))
    return face_box(view, surface, boundary, progress)


def _points_along(adaptor: BRepAdaptor_Curve) -> Floats:
    parameters = np.linspace(adaptor.FirstParameter(), adaptor.LastParameter(), ALONG_EDGE)
    return np.array([adaptor.Value(t).Coord() for t in parameters.tolist()])
