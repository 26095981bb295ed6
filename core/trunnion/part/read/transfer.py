"""From a file to a part: the CAD kernel's readers, the file's unit, names and colours, and the solid that is meant.

Runs in the reading process (`child`), because a damaged file may crash or bloat the kernel.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from OCP.Standard import Standard_Failure
from OCP.TopLoc import TopLoc_Location
from OCP.TopTools import TopTools_IndexedMapOfShape

from trunnion.findings import BadInput, Finding, error, face_tags, warning
from trunnion.part.part import Part, PartMetadata
from trunnion.part.read.dimension_faces import ReadDimensions, read_dimensions
from trunnion.part.read.heal import Body, bodies_of
from trunnion.part.read.kernel_messages import hush
from trunnion.part.read.request import ReadRequest
from trunnion.part.topology.identity import Shape, face_index, faces_of

_IGES_UNITS = {
    1: "inch",
    2: "mm",
    4: "foot",
    5: "mile",
    6: "metre",
    7: "km",
    8: "mil",
    9: "micrometre",
    10: "cm",
    11: "microinch",
}
ANY_RESULT = -1
"""Of the kernel's search for a shape's entity: among all results, those inside others too."""
_UNIT_WORDS = {
    "millimetre": "mm",
    "millimeter": "mm",
    "centimetre": "cm",
    "centimeter": "cm",
    "metre": "metre",
    "meter": "metre",
}


@dataclass(frozen=True, slots=True, kw_only=True)
class TransferResult:
    """What was read: the shape in mm, the file's unit, names and colours by face tag, lines of IGES entities, dimensions of STEP files."""

    shape: Shape
    unit: str
    names: Mapping[int, str] = field(default_factory=dict)
    colours: Mapping[int, tuple[float, float, float]] = field(default_factory=dict)
    entities: Mapping[int, int] = field(default_factory=dict)
    dimensions: ReadDimensions = field(default_factory=ReadDimensions)


def read_file(file: Path, request: ReadRequest) -> Part:
    """Return the part in a file whose text has been checked; raise `BadInput` when the kernel can't make a solid of it."""
    hush()
    try:
        read = _read_step(file, request) if request.kind == "step" else _read_iges(file, request)
        return _part(read, request)
    except Standard_Failure as reason:
        words = " ".join(str(reason).split())[:120]
        raise BadInput(
            f"{request.file}: the CAD kernel can't use this file ({type(reason).__name__}: {words}); export it again"
        ) from None


def _read_step(file: Path, request: ReadRequest) -> TransferResult:
    from OCP.IFSelect import IFSelect_RetDone
    from OCP.STEPCAFControl import STEPCAFControl_Reader
    from OCP.TColStd import TColStd_SequenceOfAsciiString

    reader = STEPCAFControl_Reader()
    reader.SetNameMode(True)
    reader.SetColorMode(True)
    # Dimensions are read from the text; the kernel needn't meet damaged ones, nor pictures of them.
    reader.SetGDTMode(False)
    reader.SetViewMode(False)
    if reader.ReadFile(str(file)) != IFSelect_RetDone:
        raise BadInput(f"{request.file}: the STEP file can't be understood; export the part again")
    lengths, angles, solids = (TColStd_SequenceOfAsciiString() for _ in range(3))
    reader.ChangeReader().FileUnits(lengths, angles, solids)
    unit = lengths.Value(1).ToCString().lower() if lengths.Length() else "mm"
    read = _with_document(reader, reader.ChangeReader(), request, _UNIT_WORDS.get(unit, unit))
    return replace(read, dimensions=read_dimensions(reader.ChangeReader(), file, read.shape))


def _read_iges(file: Path, request: ReadRequest) -> TransferResult:
    from OCP.IFSelect import IFSelect_RetDone
    from OCP.IGESCAFControl import IGESCAFControl_Reader

    reader = IGESCAFControl_Reader()
    reader.SetNameMode(True)
    reader.SetColorMode(True)
    if reader.ReadFile(str(file)) != IFSelect_RetDone:
        raise BadInput(f"{request.file}: the IGES file can't be understood; export the part again")
    unit = _IGES_UNITS.get(reader.IGESModel().GlobalSection().UnitFlag(), "mm")
    read = _with_document(reader, reader, request, unit)
    return replace(read, entities=_entities(reader, faces_of(read.shape)))


def _entities(reader: Any, faces: list[Shape]) -> dict[int, int]:
    """Return the line in the directory of the entity that each face was made from, by tag; nothing of faces that the reader split."""
    process, model, found = reader.WS().TransferReader(), reader.IGESModel(), {}
    for tag, face in enumerate(faces, start=1):
        entity = process.EntityFromShapeResult(face, ANY_RESULT)
        if entity is not None:
            found[tag] = model.DNum(entity)
    return found


def _with_document(reader: Any, plain: Any, request: ReadRequest, unit: str) -> TransferResult:
    from OCP.TCollection import TCollection_ExtendedString
    from OCP.TDocStd import TDocStd_Document

    document = TDocStd_Document(TCollection_ExtendedString("part"))
    if not reader.Transfer(document):
        raise BadInput(
            f"{request.file}: no shape could be made from the file; export the part again as a solid"
        )
    shape = plain.OneShape()
    if shape is None or shape.IsNull() or not faces_of(shape):
        raise BadInput(
            f"{request.file}: the file holds no faces (curves or points only); export the part as a solid"
        )
    faces = faces_of(shape)
    return TransferResult(
        shape=shape, unit=unit, names=_names(document, shape), colours=_colours(document, faces)
    )


def _names(document: Any, shape: Shape) -> dict[int, str]:
    from OCP.TDataStd import TDataStd_Name
    from OCP.TDF import TDF_LabelSequence
    from OCP.XCAFDoc import XCAFDoc_DocumentTool, XCAFDoc_ShapeTool

    index, found = face_index(shape), {}
    tool = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    labels, inside = TDF_LabelSequence(), TDF_LabelSequence()
    tool.GetShapes(labels)
    for n in range(1, labels.Length() + 1):
        inside.Clear()
        XCAFDoc_ShapeTool.GetSubShapes_s(labels.Value(n), inside)
        for k in range(1, inside.Length() + 1):
            label = inside.Value(k)
            tag = index.FindIndex(XCAFDoc_ShapeTool.GetShape_s(label))
            # Getting an absent attribute crashes the kernel, so its id is looked up first.
            if tag and label.IsAttribute(TDataStd_Name.GetID_s()):
                name = TDataStd_Name()
                label.FindAttribute(TDataStd_Name.GetID_s(), name)
                found[tag] = name.Get().ToExtString()
    return found


def _colours(document: Any, faces: list[Shape]) -> dict[int, tuple[float, float, float]]:
    from OCP.Quantity import Quantity_Color
    from OCP.XCAFDoc import XCAFDoc_ColorSurf, XCAFDoc_DocumentTool

    tool, colour = XCAFDoc_DocumentTool.ColorTool_s(document.Main()), Quantity_Color()
    found = {}
    for tag, face in enumerate(faces, start=1):
        if tool.GetColor(face, XCAFDoc_ColorSurf, colour):
            found[tag] = (round(colour.Red(), 4), round(colour.Green(), 4), round(colour.Blue(), 4))
    return found


def _part(read: TransferResult, request: ReadRequest) -> Part:
    tagged = faces_of(read.shape)
    bodies, findings = bodies_of(read.shape)
    if not bodies:
        raise BadInput(
            f"{request.file}: no solid and no shell could be made of its {len(tagged)} faces; export the part as a solid"
        )
    number = _body_number(bodies, request)
    body = bodies[number - 1]
    notes = [
        *findings,
        *body.findings,
        *_count_findings(tagged, request),
        *_other_solids(bodies, number, request),
    ]
    notes += _loose(bodies, len(tagged), request)
    notes += read.dimensions.findings(request.file)
    if not body.is_closed:
        notes.append(
            warning(
                "part.open",
                f"the part is not closed: {body.open_edges} edges have a face on one side only; its faces can be "
                "machined from one side (open.side)",
                request.file,
                remedy="where it is to be a solid, close the gaps in the CAD system and export it again",
            )
        )
    facts = PartMetadata(
        path=request.path,
        name=request.name,
        digest=request.digest,
        unit=read.unit,
        n_faces=len(tagged),
        n_solids=len(bodies),
        solid=number,
        is_closed=body.is_closed,
        area=body.area,
        volume=body.volume,
        tags=body.tags,
        names=read.names,
        colours=read.colours,
        entities=read.entities,
        dimensions=read.dimensions.of_faces(frozenset(body.tags)),
        findings=tuple(notes),
    )
    return Part(facts, body.shape, read.shape)


def _body_number(bodies: list[Body], request: ReadRequest) -> int:
    if request.solid is None:
        return (
            max(range(len(bodies)), key=lambda n: (bodies[n].is_closed, *_size(bodies[n]), -n)) + 1
        )
    if not 1 <= request.solid <= len(bodies):
        have = "one solid" if len(bodies) == 1 else f"{len(bodies)} solids"
        raise BadInput(
            f"{request.file}: there is no solid {request.solid}; the file holds {have}, counted from 1"
        )
    return request.solid


def _size(body: Body) -> tuple[float, float]:
    """Return volume and area to nine figures: solids that are alike must not be distinguished by rounding."""
    return float(f"{abs(body.volume):.9g}"), float(f"{body.area:.9g}")


def _other_solids(bodies: list[Body], number: int, request: ReadRequest) -> list[Finding]:
    if len(bodies) == 1 or request.solid is not None:
        return []
    others = ", ".join(
        f"{n} ({len(b.tags)} faces, {b.volume:.0f} mm3)"
        for n, b in enumerate(bodies, start=1)
        if n != number
    )
    text = f"the file holds {len(bodies)} solids; solid {number}, the largest, is taken; the others: {others}"
    return [
        warning(
            "part.several-solids",
            text,
            request.file,
            remedy="choose one with --solid N, or export the part alone",
        )
    ]


def _loose(bodies: list[Body], count: int, request: ReadRequest) -> list[Finding]:
    loose = set(range(1, count + 1)) - {tag for body in bodies for tag in body.tags}
    if not loose:
        return []
    text = (
        f"{len(loose)} of {count} faces belong to no solid and are left out; nothing is cut on them"
    )
    remedy = "remove them in the CAD system, or make them part of the solid"
    return [warning("part.loose-faces", text, request.file, *face_tags(loose), remedy=remedy)]


def _count_findings(tagged: list[Shape], request: ReadRequest) -> list[Finding]:
    """Compare what was transferred with what the file lists; an assembly's repeated faces count once."""
    alone = TopTools_IndexedMapOfShape()
    for face in tagged:
        alone.Add(face.Located(TopLoc_Location()))
    unlike = alone.Extent()
    if unlike < request.listed:
        text = f"the file lists {request.listed} faces, only {unlike} could be read"
        return [
            error(
                "part.lost-faces",
                text,
                request.file,
                remedy="export the part again; don't trust a plan for this one",
            )
        ]
    if unlike > request.listed > 0:
        text = f"the file lists {request.listed} faces, the reader split them into {unlike}, as it does where an outline crosses itself"
        return [
            warning(
                "part.split-faces",
                text,
                request.file,
                remedy="look at the outline in the CAD system",
            )
        ]
    return []
