"""The dimensions of a STEP file on the faces of the part: from the numbers of entities in the text to tags.

The kernel numbers entities in the order of the text, so a face is found by its position there; whether the kernel took as many entities as
the text has, and what it made of each, is checked. Edges are circles at the ends of cylinders: a diameter on one is the cylinder's. The
size of a thread is often tied to curves that draw its cylinder: it is that of the hole's faces within.
"""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from OCP.BRepAdaptor import BRepAdaptor_Curve, BRepAdaptor_Surface
from OCP.GeomAbs import GeomAbs_Circle, GeomAbs_Cylinder
from OCP.STEPConstruct import STEPConstruct
from OCP.StepShape import StepShape_EdgeCurve, StepShape_FaceSurface
from OCP.TopAbs import TopAbs_EDGE, TopAbs_FACE
from OCP.TopLoc import TopLoc_Location
from OCP.TopTools import TopTools_IndexedMapOfShape

from trunnion import tolerance
from trunnion.findings import Finding, remark
from trunnion.geometry.dimension import Dimension
from trunnion.part.read.step_curves import DrawnThread, cylinders_in
from trunnion.part.read.step_dimensions import MARK, FileDimensions, dimensions_in
from trunnion.part.topology.identity import Shape, edges_of, faces_of

_BLOCK = 1 << 20
"""Bytes of a file that are looked through at a time."""
_MOST_PROBLEMS = 3
"""Problems that a finding says; it counts the others."""


@dataclass(frozen=True, slots=True)
class ReadDimensions:
    """The dimensions on faces of all solids in a file, and in words what can't be used."""

    dimensions: tuple[Dimension, ...] = ()
    problems: tuple[str, ...] = ()

    def of_faces(self, tags: Collection[int]) -> tuple[Dimension, ...]:
        """Return the dimensions of some faces, the others left out of them."""
        kept = [replace(d, faces=tuple(t for t in d.faces if t in tags)) for d in self.dimensions]
        return tuple(d for d in kept if d.faces)

    def findings(self, file: str) -> list[Finding]:
        """Return the finding on what can't be used; none where all can."""
        if not self.problems:
            return []
        listed = "; ".join(self.problems[:_MOST_PROBLEMS])
        more = len(self.problems) - _MOST_PROBLEMS
        rest = f"; and {more} more" if more > 0 else ""
        text = f"dimensions in the file that can't be used: {listed}{rest}"
        return [
            remark(
                "part.dimensions",
                text,
                file,
                remedy="export the part with semantic PMI again, or see to these sizes by hand",
            )
        ]


def has_dimensions(file: Path) -> bool:
    """Return whether a STEP file may give sizes as data, without holding more than a block of it in memory."""
    before = b""
    with file.open("rb") as stream:
        while block := stream.read(_BLOCK):
            if MARK in before + block:
                return True
            before = block[-len(MARK) :]
    return False


def read_dimensions(reader: Any, file: Path, shape: Shape) -> ReadDimensions:
    """Return the dimensions that a STEP file gives of the faces of a shape; `reader` is the kernel's, after its transfer."""
    if not has_dimensions(file):
        return ReadDimensions()
    data = file.read_bytes()
    given = dimensions_in(data)
    model = reader.StepModel()
    if given.dimensions and model.NbEntities() != given.count:
        problem = f"the CAD kernel takes {model.NbEntities()} entities of {given.count}, so no size can be tied to its faces"
        return ReadDimensions(problems=(*given.problems, problem))
    process = reader.WS().TransferReader().TransientProcess()

    def made_of(position: int) -> Shape | None:
        entity = model.Value(position)
        if not isinstance(entity, StepShape_FaceSurface | StepShape_EdgeCurve):
            return None
        made = STEPConstruct.FindShape_s(process, entity)
        return None if made.IsNull() else made

    faces = _ShapeTags(shape)
    tags = _tags(given, made_of, faces) | _drawn_tags(given, data, faces)
    found, problems = [], list(given.problems)
    for dimension in given.dimensions:
        own = sorted({tag for item in dimension.items for tag in tags.get(item, ())})
        strange = [
            f"#{item}"
            for item in dimension.items
            if item not in given.positions and not tags.get(item)
        ]
        if strange and own:
            problems.append(f"#{dimension.number} is of {', '.join(strange)} too, which is no face")
        if own:
            found.append(replace(dimension.dimension, faces=tuple(own)))
        else:
            problems.append(
                f"#{dimension.number} is left out, it is of no cylinder of the shape and no thread about one"
            )
    return ReadDimensions(tuple(found), tuple(problems))


def _tags(
    given: FileDimensions, made_of: Callable[[int], Shape | None], faces: _ShapeTags
) -> dict[int, tuple[int, ...]]:
    """Return the tags of the faces that each item of the dimensions stands for; an assembly may hold one several times."""
    found = {}
    for number in {item for d in given.dimensions for item in d.items}:
        if number in given.positions:
            made = made_of(given.positions[number])
            if made is not None:
                found[number] = faces.of(made)
    return found


def _drawn_tags(
    given: FileDimensions, data: bytes, faces: _ShapeTags
) -> dict[int, tuple[int, ...]]:
    """Return the tags of the faces within cylinders that curves draw, as those of threads are, by the numbers of the curves."""
    # Without the thread's designation nothing says that the hole is not to have the drawn diameter.
    threads = [d for d in given.dimensions if d.dimension.thread]
    curves = {i for d in threads for i in d.items if i not in given.positions}
    if not curves:
        return {}
    return {number: faces.within(drawn) for number, drawn in cylinders_in(data, curves).items()}


class _ShapeTags:
    """The tags of a shape's faces by what the kernel made of one entity, wherever in an assembly that is."""

    def __init__(self, shape: Shape) -> None:
        self._faces = faces_of(shape)
        self._by_face = _TagMap()
        for tag, face in enumerate(self._faces, 1):
            self._by_face.add(face, tag)

    def of(self, made: Shape) -> tuple[int, ...]:
        """Return the tags of a face, or of the cylinders that a circle ends."""
        kind = made.ShapeType()
        if kind == TopAbs_FACE:
            return self._by_face.of(made)
        return self._by_edge.of(made) if kind == TopAbs_EDGE else ()

    def within(self, drawn: DrawnThread) -> tuple[int, ...]:
        """Return the tags of the cylinders of one radius about the axis of a drawn one, no wider than that and beside it along the axis.

        None where they have several radii, or an assembly moves the shape that the curves belong to.
        """
        found: dict[int, float] = {}
        for tag, face in enumerate(self._faces, 1):
            surface = BRepAdaptor_Surface(face)
            if surface.GetType() == GeomAbs_Cylinder and _is_within(surface, drawn):
                if not face.Location().IsIdentity():
                    return ()
                found[tag] = surface.Cylinder().Radius()
        radii = found.values()
        alike = bool(found) and max(radii) - min(radii) < tolerance.COINCIDENT
        return tuple(found) if alike else ()

    @cached_property
    def _by_edge(self) -> _TagMap:
        """The tags of cylinders by the circles at their ends."""
        found = _TagMap()
        for tag, face in enumerate(self._faces, 1):
            surface = BRepAdaptor_Surface(face)
            if surface.GetType() != GeomAbs_Cylinder:
                continue
            for edge in edges_of(face):
                if _is_circle(edge, surface.Cylinder().Radius()):
                    found.add(edge, tag)
        return found


class _TagMap:
    """Tags by shapes, wherever these lie."""

    def __init__(self) -> None:
        self._index = TopTools_IndexedMapOfShape()
        self._tags: dict[int, list[int]] = {}

    def add(self, shape: Shape, tag: int) -> None:
        """Add a tag to those of a shape."""
        self._tags.setdefault(self._index.Add(shape.Located(TopLoc_Location())), []).append(tag)

    def of(self, shape: Shape) -> tuple[int, ...]:
        """Return the tags of a shape."""
        return tuple(self._tags.get(self._index.FindIndex(shape.Located(TopLoc_Location())), ()))


def _is_circle(edge: Shape, radius: float) -> bool:
    curve = BRepAdaptor_Curve(edge)
    return (
        curve.GetType() == GeomAbs_Circle
        and abs(curve.Circle().Radius() - radius) < tolerance.COINCIDENT
    )


def _is_within(surface: Any, drawn: DrawnThread) -> bool:
    """Return whether a cylinder has the axis of a drawn one, is no wider, and overlaps it along the axis."""
    cylinder = surface.Cylinder()
    if cylinder.Radius() > drawn.radius + tolerance.FITTED:
        return False
    origin, direction = cylinder.Axis().Location(), cylinder.Axis().Direction()
    start = np.array([origin.X(), origin.Y(), origin.Z()]) - drawn.point
    along = np.array([direction.X(), direction.Y(), direction.Z()])
    ends = np.array(
        [start + v * along for v in (surface.FirstVParameter(), surface.LastVParameter())]
    )
    heights = ends @ drawn.axis
    aside = np.linalg.norm(ends - heights[:, None] * drawn.axis, axis=1)
    overlap = min(heights.max(), drawn.high) - max(heights.min(), drawn.low)
    return bool(aside.max() < tolerance.FITTED and overlap > tolerance.FITTED)
