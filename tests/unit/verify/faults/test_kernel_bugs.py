"""Faults of the CAD kernel that the code works around: when one of these tests fails after an upgrade, its workaround may go."""

from __future__ import annotations

from pathlib import Path

import pytest
from OCP.IGESControl import IGESControl_Reader
from OCP.STEPControl import STEPControl_Reader

import samples
from trunnion.part.topology.identity import faces_of


def test_the_step_reader_drops_a_damaged_face_in_silence(tmp_path: Path) -> None:
    file = tmp_path / "dangling.step"
    text = samples.written(samples.box_shape()).read_bytes()
    start = text.index(b"PLANE('',#")
    file.write_bytes(text[:start] + b"PLANE('',#999999" + text[text.index(b")", start) :])
    reader = STEPControl_Reader()
    reader.ReadFile(str(file))
    reader.TransferRoots()
    assert len(faces_of(reader.OneShape())) == 5


def test_the_iges_reader_gives_surfaces_of_revolution_for_cylinders() -> None:
    from OCP.BRepAdaptor import BRepAdaptor_Surface
    from OCP.GeomAbs import GeomAbs_SurfaceOfRevolution

    reader = IGESControl_Reader()
    reader.ReadFile(str(samples.written(samples.drilled_block_shape(), "igs")))
    reader.TransferRoots()
    kinds = [BRepAdaptor_Surface(f).GetType() for f in faces_of(reader.OneShape())]
    assert kinds.count(GeomAbs_SurfaceOfRevolution) == 1


def test_sewing_does_not_follow_faces_by_the_call_that_should() -> None:
    from OCP.BRepBuilderAPI import BRepBuilderAPI_Sewing

    reader = IGESControl_Reader()
    reader.ReadFile(str(samples.written(samples.box_shape(), "igs")))
    reader.TransferRoots()
    sewing = BRepBuilderAPI_Sewing(1e-3)
    sewing.Add(reader.OneShape())
    sewing.Perform()
    face = faces_of(reader.OneShape())[0]
    assert sewing.IsModifiedSubShape(face)
    assert sewing.Modified(face).IsSame(face)


@pytest.mark.parametrize("suffix", ["step", "igs"])
def test_the_reader_with_names_and_colours_keeps_the_order_of_faces(suffix: str) -> None:
    part = samples.read(samples.block_with_pocket_shape(), suffix)
    reader = IGESControl_Reader() if suffix == "igs" else STEPControl_Reader()
    reader.ReadFile(str(samples.block_with_pocket(suffix)))
    reader.TransferRoots()
    from OCP.BRepGProp import BRepGProp
    from OCP.GProp import GProp_GProps

    def place(face: object) -> tuple[float, ...]:
        found = GProp_GProps()
        BRepGProp.SurfaceProperties_s(face, found)
        return tuple(round(c, 6) for c in found.CentreOfMass().Coord())

    assert [place(f) for f in faces_of(reader.OneShape())] == [
        place(f) for f in faces_of(part.as_read)
    ]
