"""Which face is which: `face N` is the N-th face of the shape as read; what was healed or sewn keeps its number."""

from __future__ import annotations

from typing import Any

from OCP.TopAbs import TopAbs_EDGE, TopAbs_FACE, TopAbs_SHELL, TopAbs_SOLID
from OCP.TopExp import TopExp
from OCP.TopoDS import TopoDS
from OCP.TopTools import TopTools_IndexedMapOfShape

Shape = Any
"""A `TopoDS_Shape`; the CAD kernel ships no types."""


def _listed(shape: Shape, kind: Any) -> list[Shape]:
    found = TopTools_IndexedMapOfShape()
    TopExp.MapShapes_s(shape, kind, found)
    return [found.FindKey(n) for n in range(1, found.Extent() + 1)]


def faces_of(shape: Shape) -> list[Shape]:
    """Return the faces of a shape, each once; the face of tag N of a shape as read is at position N - 1."""
    return [TopoDS.Face_s(s) for s in _listed(shape, TopAbs_FACE)]


def edges_of(shape: Shape) -> list[Shape]:
    """Return the edges of a shape, each once."""
    return [TopoDS.Edge_s(s) for s in _listed(shape, TopAbs_EDGE)]


def shells_of(shape: Shape) -> list[Shape]:
    """Return the shells of a shape, each once."""
    return [TopoDS.Shell_s(s) for s in _listed(shape, TopAbs_SHELL)]


def solids_of(shape: Shape) -> list[Shape]:
    """Return the solids of a shape, each once, in the order of the file."""
    return [TopoDS.Solid_s(s) for s in _listed(shape, TopAbs_SOLID)]


def edge_index(shape: Shape) -> Any:
    """Return the kernel's indexed map of a shape's edges: `FindIndex(edge)` is the 1-based position, 0 when it is not there."""
    found = TopTools_IndexedMapOfShape()
    TopExp.MapShapes_s(shape, TopAbs_EDGE, found)
    return found


def face_index(shape: Shape) -> Any:
    """Return the kernel's indexed map of a shape's faces: `FindIndex(face)` is the 1-based position, 0 when it is not there."""
    found = TopTools_IndexedMapOfShape()
    TopExp.MapShapes_s(shape, TopAbs_FACE, found)
    return found
