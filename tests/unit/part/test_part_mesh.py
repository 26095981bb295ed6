"""Triangles, boxes of blanks, written files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import samples
from trunnion import tolerance
from trunnion.findings import BadInput
from trunnion.geometry.frame import Frame
from trunnion.part.build import box_blank
from trunnion.part.read.part_file import read_part
from trunnion.part.write import write_iges, write_step


@pytest.mark.parametrize("suffix", ["step", "igs"])
def test_a_mesh_encloses_the_volume_and_names_every_face(suffix: str) -> None:
    part = samples.read(samples.two_pockets_and_a_rib_shape(), suffix)
    mesh = part.mesh()
    a, b, c = np.moveaxis(mesh.corners(), 1, 0)
    assert (np.cross(a, b) * c).sum() / 6 == pytest.approx(part.volume, rel=1e-4)
    assert set(mesh.face.tolist()) == set(part.tags)


def test_a_mesh_of_a_placed_instance_lies_where_the_instance_is() -> None:
    part = samples.read(samples.moved(samples.box_shape(), (100, 0, 0)))
    low, high = part.mesh().box()
    assert np.concatenate([low, high]) == pytest.approx([100, 0, 0, 140, 30, 20])


def test_pictures_of_large_parts_are_as_coarse_as_nobody_sees() -> None:
    small, large = samples.read(samples.box_shape()), samples.read(samples.box_shape(3e3, 2e3))
    assert small.picture_chord == tolerance.PICTURE
    # A third of a pixel of a picture in which the diagonal has as many pixels as a part of 200 mm.
    pixel = np.linalg.norm(large.high - large.low) * tolerance.PICTURE / 200.0
    assert large.picture_chord == pytest.approx(pixel)
    # The window's are finer, since a person comes nearer.
    assert samples.read(samples.box_shape(4.0, 3.0, 2.0)).view_chord == tolerance.CHORD
    assert large.view_chord == pytest.approx(large.picture_chord * 0.4)


def test_a_blank_lies_in_its_frame(tmp_path: Path) -> None:
    frame = Frame(np.array([10.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0]), np.array([0.0, 0.0, 1.0]))
    write_step(box_blank(frame, (0, 0, -1), (50, 20, 4)), tmp_path / "blank.step")
    blank = read_part(tmp_path / "blank.step")
    assert np.concatenate([blank.low, blank.high]) == pytest.approx([-10, 0, -1, 10, 50, 4])


def test_a_blank_without_height_is_refused() -> None:
    with pytest.raises(BadInput, match="50 x 20 x 0 mm is not a box"):
        box_blank(
            Frame(np.zeros(3), np.array([1.0, 0, 0]), np.array([0, 0, 1.0])), (0, 0, 0), (50, 20, 0)
        )


@pytest.mark.parametrize("write", [write_step, write_iges])
def test_a_written_file_is_alone_and_reads_back(write: object, tmp_path: Path) -> None:
    file = tmp_path / ("Träger 部品." + ("step" if write is write_step else "igs"))
    write(samples.drilled_block_shape(), file)  # type: ignore[operator]
    assert [f.name for f in tmp_path.iterdir()] == [file.name]
    assert read_part(file).n_faces == 7
