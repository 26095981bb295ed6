"""Writes shapes as STEP and IGES files."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Sequence
from pathlib import Path

from trunnion.findings import BadInput
from trunnion.part.build import compound
from trunnion.part.read.kernel_messages import hush
from trunnion.part.topology.identity import Shape

UNITS = {"mm": "MM", "inch": "INCH", "metre": "M"}
IGES, STEP = (".igs", ".iges"), (".step", ".stp")


def write_step(shape: Shape, path: str | os.PathLike[str], *, unit: str = "mm") -> None:
    """Write a shape (mm) as STEP AP214 in a unit of `UNITS`; the file is either whole or absent."""
    from OCP.IFSelect import IFSelect_RetDone
    from OCP.Interface import Interface_Static
    from OCP.STEPControl import STEPControl_AsIs, STEPControl_Writer

    hush()
    # A writer must exist before the kernel's settings have any effect.
    STEPControl_Writer()
    Interface_Static.SetCVal_s("write.step.schema", "AP214IS")
    Interface_Static.SetCVal_s("write.step.unit", UNITS[unit])
    writer = STEPControl_Writer()
    done = writer.Transfer(shape, STEPControl_AsIs) == IFSelect_RetDone
    _written(Path(path), lambda file: done and writer.Write(file) == IFSelect_RetDone)


def write_iges(shape: Shape, path: str | os.PathLike[str], *, unit: str = "mm") -> None:
    """Write a shape (mm) as IGES trimmed surfaces in a unit of `UNITS`; the file is either whole or absent."""
    from OCP.IGESControl import IGESControl_Controller, IGESControl_Writer

    hush()
    IGESControl_Controller.Init_s()
    writer = IGESControl_Writer(UNITS[unit], 0)
    done = writer.AddShape(shape)
    writer.ComputeModel()
    _written(Path(path), lambda file: done and writer.Write(file))


def write_faces(faces: Sequence[Shape], path: str | os.PathLike[str], *, unit: str = "mm") -> None:
    """Write faces and nothing else, as IGES trimmed surfaces (plane or B-spline) or as STEP shells, by the file's suffix.

    Faces that share an edge stay joined in STEP. Raises `BadInput` for another suffix.
    """
    suffix = Path(path).suffix.lower()
    if suffix in IGES:
        write_iges(compound(_as_splines(faces)), path, unit=unit)
    elif suffix in STEP:
        write_step(compound(_shells(faces)), path, unit=unit)
    else:
        raise BadInput(f"{path}: faces are written as {', '.join(IGES)} or {', '.join(STEP)}")


def _as_splines(faces: Sequence[Shape]) -> list[Shape]:
    """Return faces with every surface but a plane as a B-spline: readers trip over faces of revolution of IGES (entity 120)."""
    from OCP.BRepAdaptor import BRepAdaptor_Surface
    from OCP.BRepBuilderAPI import BRepBuilderAPI_NurbsConvert
    from OCP.GeomAbs import GeomAbs_BSplineSurface, GeomAbs_Plane
    from OCP.TopoDS import TopoDS

    plain = (GeomAbs_Plane, GeomAbs_BSplineSurface)
    return [
        f
        if BRepAdaptor_Surface(f).GetType() in plain
        else TopoDS.Face_s(BRepBuilderAPI_NurbsConvert(f, True).Shape())
        for f in faces
    ]


def _shells(faces: Sequence[Shape]) -> list[Shape]:
    """Return shells, each of faces that hang together by their edges."""
    from OCP.BRep import BRep_Builder
    from OCP.TopoDS import TopoDS_Shell
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    from trunnion.part.topology.identity import edge_index, edges_of

    index = edge_index(compound(faces))
    pairs = [(k, len(faces) + index.FindIndex(e)) for k, f in enumerate(faces) for e in edges_of(f)]
    count = len(faces) + index.Extent() + 1
    links = coo_array(([1] * len(pairs), tuple(zip(*pairs, strict=True))), shape=(count, count))
    owner = connected_components(links, directed=False)[1][: len(faces)].tolist()
    builder, shells = BRep_Builder(), {}
    for face, number in zip(faces, owner, strict=True):
        if number not in shells:
            shells[number] = TopoDS_Shell()
            builder.MakeShell(shells[number])
        builder.Add(shells[number], face)
    return list(shells.values())


def _written(path: Path, write: object) -> None:
    # The kernel opens files by narrow names; a temporary name beside the target is plain, and renaming is all or nothing.
    try:
        with tempfile.TemporaryDirectory(prefix=".trunnion-", dir=path.parent) as folder:
            made = os.path.join(folder, "shape")
            if not callable(write) or not write(made):
                raise BadInput(f"{path}: the shape can't be written")
            os.replace(made, path)
    except OSError as reason:
        raise BadInput(f"{path}: can't be written: {reason.strerror or reason}") from None
