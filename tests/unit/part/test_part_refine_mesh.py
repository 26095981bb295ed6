"""Parts that enclose nothing: one patch, patches that don't meet, surfaces without a trim."""

from __future__ import annotations

import cadquery as cq
import pytest

from samples import box_shape, read
from trunnion.findings import BadInput
from trunnion.part.read.part_file import read_part


def faces(*selectors):
    return [cq.Workplane(cq.Shape.cast(box_shape())).faces(s).val() for s in selectors]


@pytest.mark.parametrize("suffix", ["step", "igs"])
def test_one_patch_alone_is_an_open_part(suffix) -> None:
    part = read(faces(">Z")[0].wrapped, suffix)
    assert part.tags == (1,) and not part.is_closed
    assert part.area == pytest.approx(1200.0)
    assert "part.open" in {f.code for f in part.findings}


@pytest.mark.parametrize("suffix", ["step", "igs"])
def test_pieces_of_several_patches_each_are_one_open_part(suffix) -> None:
    corner = cq.Shell.makeShell(faces(">Z", ">X"))
    pieces = [corner, corner.moved(cq.Location((100.0, 0.0, 0.0)))]
    part = read(cq.Compound.makeCompound(pieces).wrapped, suffix)
    assert part.n_faces == 4 and part.n_solids == 1 and not part.is_closed
    assert part.area == pytest.approx(2.0 * (40.0 * 30.0 + 30.0 * 20.0))


def test_patches_that_do_not_meet_are_one_open_part() -> None:
    part = read(cq.Compound.makeCompound(faces(">Z", "<Z", ">X")).wrapped, "igs")
    assert part.tags == (1, 2, 3) and part.n_solids == 1 and not part.is_closed


def test_surfaces_that_nothing_trims_are_faces(tmp_path) -> None:
    from OCP.BRep import BRep_Tool
    from OCP.GeomToIGES import GeomToIGES_GeomSurface
    from OCP.IGESControl import IGESControl_Writer

    writer = IGESControl_Writer("MM", 0)
    sheet = cq.Face.makeSplineApprox(
        [[cq.Vector(x, y, 0.02 * x * y) for y in range(0, 30, 5)] for x in range(0, 30, 5)]
    )
    surface = BRep_Tool.Surface_s(sheet.wrapped)
    maker = GeomToIGES_GeomSurface()
    maker.SetModel(writer.Model())
    writer.AddEntity(maker.TransferSurface(surface, *surface.Bounds()))
    writer.ComputeModel()
    file = tmp_path / "bare.igs"
    writer.Write(str(file))
    part = read_part(file)
    assert part.tags == (1,) and part.area == pytest.approx(sheet.Area(), rel=1e-4)


def test_a_file_of_curves_alone_is_refused(tmp_path) -> None:
    from OCP.IGESControl import IGESControl_Writer

    writer = IGESControl_Writer("MM", 0)
    writer.AddShape(cq.Edge.makeLine(cq.Vector(0, 0, 0), cq.Vector(1, 2, 3)).wrapped)
    file = tmp_path / "curve.igs"
    writer.Write(str(file))
    with pytest.raises(BadInput, match="no trimmed surfaces"):
        read_part(file)
