"""Writes shapes as STEP and IGES files."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

from trunnion.findings import BadInput
from trunnion.part.identity import Shape
from trunnion.part.quiet import hush

UNITS = {"mm": "MM", "inch": "INCH", "metre": "M"}


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
