"""From what was read to bodies: sewing of loose surfaces, repair of what the kernel calls invalid, normals pointing outward.

Every change keeps a map back to the faces as read. A repair that loses or splits a face is not taken.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from OCP.BRep import BRep_Tool
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeSolid, BRepBuilderAPI_Sewing
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepLib import BRepLib
from OCP.ShapeBuild import ShapeBuild_ReShape
from OCP.ShapeFix import ShapeFix_Shape
from OCP.TopTools import TopTools_IndexedMapOfShape

from trunnion import tolerance
from trunnion.findings import Finding, info, warning
from trunnion.part.topology.identity import (
    Shape,
    edges_of,
    face_index,
    faces_of,
    shells_of,
    solids_of,
)
from trunnion.part.topology.measure import area_of, open_edges, volume_of

_SEW_STEPS = (tolerance.FITTED, 0.1 * tolerance.SEW, tolerance.SEW)
Image = Callable[[Shape], Shape]


@dataclass(frozen=True, slots=True, kw_only=True)
class Body:
    """One solid, or open shell, of what was read: `tags` in the order of its own faces, area in mm2, volume in mm3."""

    shape: Shape
    tags: tuple[int, ...]
    area: float
    volume: float
    open_edges: int
    findings: tuple[Finding, ...] = ()

    @property
    def is_closed(self) -> bool:
        """Whether its faces enclose material without a gap."""
        return self.open_edges == 0 and self.volume > 0.0


def bodies_of(as_read: Shape) -> tuple[list[Body], list[Finding]]:
    """Return the solids of a shape as read, else the closed shells that its faces can be sewn to, with findings about the sewing.

    Where none closes, all faces are one open body: patches that don't meet belong together as much as those that do.
    """
    tagged = faces_of(as_read)
    solids = solids_of(as_read)
    if solids:
        return [_body(solid, tagged, _same) for solid in solids], []
    sewn, image, findings = _sewn(as_read)
    bodies = [_body(_solid(shell), tagged, image) for shell in shells_of(sewn)]
    whole = len(bodies) == 1 and len(bodies[0].tags) == len(tagged)
    if not whole and not any(body.is_closed for body in bodies):
        bodies = [_body(sewn, tagged, image)]
    return [body for body in bodies if body.tags], findings


def _same(face: Shape) -> Shape:
    return face


def _sewn(as_read: Shape) -> tuple[Shape, Image, list[Finding]]:
    """Return the faces sewn with the smallest tolerance that leaves no free edge, or the largest allowed.

    Sewing takes the longer the more it is allowed to move: those between are tried only where the largest closes the part.
    """
    smallest, *between, largest = _SEW_STEPS
    tolerated, tool = smallest, _sewing(as_read, smallest)
    if tool.NbFreeEdges():
        tolerated, tool = largest, _sewing(as_read, largest)
        for step in () if tool.NbFreeEdges() else between:
            finer = _sewing(as_read, step)
            if finer.NbFreeEdges() == 0:
                tolerated, tool = step, finer
                break

    def image(face: Shape) -> Shape:
        return tool.ModifiedSubShape(face) if tool.IsModifiedSubShape(face) else face

    sewn = tool.SewedShape()
    gap = max((BRep_Tool.Tolerance_s(edge) for edge in edges_of(sewn)), default=0.0)
    findings = []
    if gap > tolerance.COINCIDENT and tool.NbContigousEdges() > 0 and tolerated > _SEW_STEPS[0]:
        findings.append(
            info(
                "part.sewn",
                f"surfaces with gaps of up to {gap:.4f} mm between them were sewn together",
            )
        )
    return sewn, image, findings


def _sewing(as_read: Shape, tolerated: float) -> BRepBuilderAPI_Sewing:
    tool = BRepBuilderAPI_Sewing(tolerated)
    tool.Add(as_read)
    tool.Perform()
    return tool


def _solid(shell: Shape) -> Shape:
    if not BRep_Tool.IsClosed_s(shell):
        return shell
    solid = BRepBuilderAPI_MakeSolid(shell).Solid()
    BRepLib.OrientClosedSolid_s(solid)
    return solid


def _body(shape: Shape, tagged: list[Shape], image: Image) -> Body:
    tags = _tags(shape, tagged, image)
    findings: tuple[Finding, ...] = ()
    if not BRepCheck_Analyzer(shape).IsValid():
        shape, tags, findings = _repaired(shape, tagged, image, tags)
    volume = volume_of(shape)
    if volume < 0.0:
        shape, volume = shape.Reversed(), -volume
    return Body(
        shape=shape,
        tags=tags,
        area=area_of(shape),
        volume=volume,
        open_edges=open_edges(shape),
        findings=findings,
    )


def _tags(shape: Shape, tagged: list[Shape], image: Image) -> tuple[int, ...]:
    """Return the tag of each of a shape's own faces, in their order; empty when a face has none or several."""
    index: TopTools_IndexedMapOfShape = face_index(shape)
    found: dict[int, int] = {}
    for tag, face in enumerate(tagged, start=1):
        after = image(face)
        position = 0 if after is None or after.IsNull() else index.FindIndex(after)
        if position:
            found[position] = tag
    return tuple(found[n] for n in sorted(found)) if len(found) == index.Extent() else ()


def _repaired(
    shape: Shape, tagged: list[Shape], image: Image, tags: tuple[int, ...]
) -> tuple[Shape, tuple[int, ...], tuple[Finding, ...]]:
    changes = ShapeBuild_ReShape()
    tool = ShapeFix_Shape(shape)
    tool.SetContext(changes)
    tool.Perform()
    fixed = tool.Shape()
    inside = solids_of(fixed) or shells_of(fixed)
    if len(inside) == 1 and BRepCheck_Analyzer(inside[0]).IsValid():
        new = _tags(inside[0], tagged, lambda face: changes.Apply(image(face)))
        if sorted(new) == sorted(tags):
            return (
                inside[0],
                new,
                (
                    info(
                        "part.healed",
                        "the solid had faults in its edges or tolerances that were repaired",
                    ),
                ),
            )
    text = "the CAD kernel finds faults in this solid that can't be repaired without changing its faces"
    return shape, tags, (warning("part.invalid", text, remedy="check the solid in the CAD system"),)
