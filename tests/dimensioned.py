"""STEP files of plates whose holes have dimensions as data, written by the CAD kernel as AP242."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

PITCH = 30.0
"""mm between the holes of a plate, and its width."""
UNITS = {"mm": "MM", "inch": "INCH"}


@dataclass(frozen=True, slots=True, kw_only=True)
class Sized:
    """A diameter of some holes of the plate, by their positions: value and deviations in the file's unit, or a fit ("H7")."""

    holes: tuple[int, ...]
    value: float
    lower: float | None = None
    upper: float | None = None
    fit: str = ""
    kind: str = "Size_Diameter"


def plate_of_holes(diameters: Sequence[float], start: float = 0.0) -> Any:
    """Return a plate 10 mm thick with a row of through holes of some diameters, mm, from a position in x on."""
    from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut
    from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakeCylinder
    from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt

    corner = gp_Pnt(start, 0.0, 0.0)
    shape = BRepPrimAPI_MakeBox(corner, PITCH * len(diameters), PITCH, 10.0).Shape()
    for n, diameter in enumerate(diameters):
        axis = gp_Ax2(gp_Pnt(start + PITCH * (n + 0.5), 0.5 * PITCH, 0.0), gp_Dir(0.0, 0.0, 1.0))
        shape = BRepAlgoAPI_Cut(
            shape, BRepPrimAPI_MakeCylinder(axis, 0.5 * diameter, 10.0).Shape()
        ).Shape()
    return shape


def bores(shape: Any) -> list[Any]:
    """Return the cylinders of a plate in the order of its holes."""
    from OCP.BRepAdaptor import BRepAdaptor_Surface
    from OCP.GeomAbs import GeomAbs_Cylinder

    from trunnion.part.topology.identity import faces_of

    found = [f for f in faces_of(shape) if BRepAdaptor_Surface(f).GetType() == GeomAbs_Cylinder]
    return sorted(found, key=lambda f: BRepAdaptor_Surface(f).Cylinder().Location().X())


def write_dimensioned(
    path: Path,
    diameters: Sequence[float],
    sizes: Sequence[Sized],
    unit: str = "mm",
    second: Sequence[float] = (),
    twice: bool = False,
    as_kernel: bool = False,
) -> Path:
    """Write a plate with holes of some diameters (mm) and dimensions of them as STEP AP242.

    `second` are holes of another plate beside it, numbered on; `twice` makes it an assembly that holds the plate twice; `as_kernel` leaves
    the grades of fits that the kernel writes.
    """
    from OCP.gp import gp_Trsf, gp_Vec
    from OCP.IFSelect import IFSelect_RetDone
    from OCP.Interface import Interface_Static
    from OCP.STEPCAFControl import STEPCAFControl_Writer
    from OCP.STEPControl import STEPControl_AsIs
    from OCP.TCollection import TCollection_ExtendedString
    from OCP.TDF import TDF_LabelSequence
    from OCP.TDocStd import TDocStd_Document
    from OCP.TopLoc import TopLoc_Location
    from OCP.XCAFDoc import XCAFDoc_DocumentTool

    from trunnion.part.build import compound
    from trunnion.part.read.kernel_messages import hush

    hush()
    document = TDocStd_Document(TCollection_ExtendedString("plate"))
    shapes = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    tolerances = XCAFDoc_DocumentTool.DimTolTool_s(document.Main())
    shape = plate_of_holes(diameters)
    if second:
        shape = compound([shape, plate_of_holes(second, PITCH * (len(diameters) + 1))])
    holes = bores(shape)
    whole = shapes.AddShape(shape, False)
    if twice:
        aside = gp_Trsf()
        aside.SetTranslation(gp_Vec(0.0, 2.0 * PITCH, 0.0))
        assembly = shapes.NewShape()
        shapes.AddComponent(assembly, whole, TopLoc_Location())
        shapes.AddComponent(assembly, whole, TopLoc_Location(aside))
        shapes.UpdateAssemblies()
    for size in sizes:
        faces = TDF_LabelSequence()
        for n in size.holes:
            faces.Append(shapes.AddSubShape(whole, holes[n]))
        label = tolerances.AddDimension()
        tolerances.SetDimension(faces, TDF_LabelSequence(), label)
        _set(label, size)
    writer = STEPCAFControl_Writer()
    Interface_Static.SetCVal_s("write.step.schema", "AP242DIS")
    Interface_Static.SetCVal_s("write.step.unit", UNITS[unit])
    writer.SetDimTolMode(True)
    assert writer.Transfer(document, STEPControl_AsIs)
    assert writer.Write(str(path)) == IFSelect_RetDone
    if not as_kernel:
        path.write_text(_with_grades(path.read_text(), sizes))
    return path


def _with_grades(text: str, sizes: Sequence[Sized]) -> str:
    """Return a text with the grades that fits should have, and not in the kernel's name: it writes wrong ones."""
    grades = iter([re.sub(r"\D", "", s.fit) for s in sizes if s.fit])
    text = text.replace("Open CASCADE STEP processor", "plates of tests")
    return re.sub(
        r"(LIMITS_AND_FITS\('\w+','\w+',)'\d+'", lambda found: f"{found[1]}'{next(grades)}'", text
    )


def _set(label: Any, size: Sized) -> None:
    import OCP.XCAFDimTolObjects as objects
    from OCP.XCAFDoc import XCAFDoc_Dimension

    made = objects.XCAFDimTolObjects_DimensionObject()
    prefix = "XCAFDimTolObjects_Dimension"
    made.SetType(getattr(objects, f"{prefix}Type_{size.kind}"))
    made.SetValue(size.value)
    if size.lower is not None and size.upper is not None:
        # The kernel takes a lower deviation without its sign.
        made.SetLowerTolValue(-size.lower)
        made.SetUpperTolValue(size.upper)
    if size.fit:
        letters, grade = re.fullmatch(r"([A-Za-z]+)(\d+)", size.fit).groups()
        made.SetClassOfTolerance(
            letters.isupper(),
            getattr(objects, f"{prefix}FormVariance_{letters.upper()}"),
            getattr(objects, f"{prefix}Grade_IT{grade}"),
        )
    XCAFDoc_Dimension.Set_s(label).SetObject(made)
