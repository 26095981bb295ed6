"""Reading part files: what comes back, what is said, what is refused."""

from __future__ import annotations

import gzip
import os
from pathlib import Path

import numpy as np
import pytest

import samples
from parts import PARTS, needs_parts
from trunnion.findings import BadInput, Cancelled, OutOfMemory
from trunnion.part.part import Part
from trunnion.part.read.limits import ReadLimits
from trunnion.part.read.part_file import PartReading, read_part, read_part_bytes
from trunnion.progress import Progress


def codes(part: Part) -> list[str]:
    return [f.code for f in part.findings]


@pytest.mark.parametrize("suffix", ["step", "igs"])
def test_a_box_has_its_size_and_is_closed(suffix: str) -> None:
    part = samples.read(samples.box_shape(), suffix)
    assert part.volume == pytest.approx(40 * 30 * 20)
    assert part.area == pytest.approx(2 * (40 * 30 + 40 * 20 + 30 * 20))
    assert np.allclose(part.high - part.low, (40, 30, 20))
    assert part.is_closed and part.tags == (1, 2, 3, 4, 5, 6) and not part.findings


@pytest.mark.parametrize("suffix", ["step", "igs"])
@pytest.mark.parametrize("unit", ["inch", "metre"])
def test_a_file_in_another_unit_is_read_in_mm_and_its_unit_told(suffix: str, unit: str) -> None:
    part = samples.read(samples.box_shape(), suffix, unit)
    assert part.unit == unit
    assert part.volume == pytest.approx(24000.0, rel=1e-6)


@pytest.mark.cold
def test_a_gzipped_file_is_read_like_the_plain_one() -> None:
    assert read_part(samples.written(samples.box_shape(), "stpz")).volume == pytest.approx(24000.0)


def test_an_iges_file_named_step_is_read_by_its_content(tmp_path: Path) -> None:
    file = tmp_path / "block.step"
    file.write_bytes(samples.block_with_pocket("igs").read_bytes())
    assert read_part(file).n_faces == 23


@pytest.mark.cold
def test_bytes_are_read_as_the_file_they_came_from() -> None:
    file = samples.block_with_pocket()
    part = read_part_bytes(file.read_bytes(), "block_with_pocket", ".step")
    assert part.name == "block_with_pocket" and part.digest == read_part(file).digest


def test_of_several_solids_the_largest_is_taken_and_the_others_named() -> None:
    part = samples.read(samples.two_blocks_shape())
    assert (part.n_solids, part.solid, part.volume) == (2, 1, pytest.approx(24000.0))
    assert codes(part) == ["part.several-solids"] and "--solid" in part.findings[0].remedy


def test_a_solid_can_be_chosen_and_keeps_the_tags_of_the_file() -> None:
    part = samples.read(samples.two_blocks_shape(), solid=2)
    assert part.volume == pytest.approx(1000.0)
    assert part.tags == (7, 8, 9, 10, 11, 12) and part.face_shape(1) is None and codes(part) == []
    assert part.graph().area[:6].sum() == 0.0


def test_a_solid_that_is_not_there_is_refused() -> None:
    with pytest.raises(BadInput, match="there is no solid 3; the file holds 2 solids"):
        samples.read(samples.two_blocks_shape(), solid=3)


@pytest.mark.parametrize("suffix", ["step", "igs"])
def test_an_open_shell_is_an_error(suffix: str) -> None:
    part = samples.read(samples.open_box_shape(), suffix)
    assert not part.is_closed and "part.open" in codes(part)


def test_a_part_goes_through_bytes_unchanged() -> None:
    part = samples.read(samples.two_pockets_and_a_rib_shape(), "igs")
    again = Part.from_bytes(part.to_bytes())
    assert again.tags == part.tags and again.facts == part.facts
    assert again.graph().surface == part.graph().surface
    assert np.array_equal(again.graph().edge_face, part.graph().edge_face)
    assert np.allclose(again.graph().middle, part.graph().middle)


def test_bytes_that_hold_no_part_are_refused() -> None:
    with pytest.raises(BadInput, match="don't hold a part"):
        Part.from_bytes(b"nothing")


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda f: f.mkdir(), "is a folder"),
        (lambda f: None, "no such file"),
        (lambda f: f.symlink_to(f), "Too many levels of symbolic links"),
        (lambda f: os.mkfifo(f), "not a plain file"),
        (lambda f: f.write_bytes(b"\x1f\x8b damaged"), "gzipped file is damaged"),
        (
            lambda f: f.write_bytes(gzip.compress(b"x" * (3 << 20))),
            "larger than the limit of 2 MB when unpacked",
        ),
    ],
)
def test_what_can_not_be_read_is_refused_in_one_line(
    make: object, words: str, tmp_path: Path
) -> None:
    file = tmp_path / "part.step"
    make(file)  # type: ignore[operator]
    with pytest.raises(BadInput, match=words) as refusal:
        read_part(file, limits=ReadLimits(size=2))
    assert "part.step" in str(refusal.value) and "\n" not in str(refusal.value)


def test_a_file_without_read_permission_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "part.step"
    file.write_bytes(b"ISO-10303-21;")
    file.chmod(0)
    if os.access(file, os.R_OK):
        pytest.skip("this user may read everything")
    with pytest.raises(BadInput, match="Permission denied"):
        read_part(file)


@pytest.mark.cold
def test_reading_that_takes_too_long_is_stopped() -> None:
    with pytest.raises(BadInput, match=r"longer than 0\.01 s and was stopped"):
        read_part(samples.block_with_pocket(), limits=ReadLimits(seconds=0.01))


@pytest.mark.cold
def test_reading_that_needs_too_much_memory_says_so() -> None:
    with pytest.raises((OutOfMemory, BadInput), match="memory|failed"):
        read_part(samples.block_with_pocket(), limits=ReadLimits(memory=200))


def test_a_reading_begun_before_gives_the_same_part_and_leaves_nothing_behind() -> None:
    file = samples.block_with_pocket()
    with PartReading.of_file(file) as reading:
        folder = Path(reading._process._folder.name)
        assert folder.is_dir()
        assert reading.part().to_bytes() == read_part(file).to_bytes()
    with PartReading.of_file(file) as given_up:
        left = Path(given_up._process._folder.name)
    assert not folder.exists() and not left.exists()
    assert given_up._process._child.poll() is not None


@pytest.mark.cold
def test_reading_can_be_cancelled() -> None:
    asked = []
    with pytest.raises(Cancelled):
        read_part(
            samples.block_with_pocket(),
            progress=Progress(cancelled=lambda: len(asked) > 1 or bool(asked.append(1))),
        )


REFUSED = (
    "empty.step",
    "garbage_text.step",
    "binary_garbage.step",
    "binary_garbage.igs",
    "truncated.step",
    "header_only.step",
    "dangling_reference.step",
    "not_a_number.step",
    "curves_only.step",
    "cut_in_p_section.igs",
    "part.step",
)
READ = {
    "open_shell.step": ["part.open"],
    "two_solids.step": ["part.several-solids"],
    "assembly_twice.step": ["part.several-solids"],
    "sliver_faces.step": [],
    "zero_thickness.step": ["part.loose-faces"],
    "tiny_half_millimetre.step": [],
    "huge_20_metres.step": [],
    "inch_box.step": [],
    "metre_box.step": [],
    "self_intersecting.step": ["part.split-faces"],
    "not_sewn.igs": ["part.sewn"],
    "iges_inside.step": [],
    "Träger 部品 n°1 (copy).step": [],
    "crlf.step": [],
}


@needs_parts
@pytest.mark.parametrize("name", REFUSED)
def test_a_nasty_file_is_refused_by_name(name: str) -> None:
    assert PARTS is not None
    with pytest.raises(BadInput, match=name.replace(".", r"\.")) as refusal:
        read_part(PARTS / "nasty" / name)
    assert "\n" not in str(refusal.value)


@needs_parts
@pytest.mark.parametrize("name", READ)
def test_an_awkward_file_is_read_and_its_trouble_named(name: str) -> None:
    assert PARTS is not None
    assert codes(read_part(PARTS / "nasty" / name)) == READ[name]


@needs_parts
@pytest.mark.parametrize("name", ["panel/B2.step", "panel/B1.igs", "nasty/assembly_twice.step"])
def test_face_tags_are_those_of_the_plain_reader(name: str) -> None:
    from OCP.BRepGProp import BRepGProp
    from OCP.GProp import GProp_GProps
    from OCP.IGESControl import IGESControl_Reader
    from OCP.STEPControl import STEPControl_Reader

    from trunnion.part.topology.identity import faces_of

    assert PARTS is not None
    plain = IGESControl_Reader() if name.endswith("igs") else STEPControl_Reader()
    plain.ReadFile(str(PARTS / name))
    plain.TransferRoots()

    def mark(face: object) -> tuple[float, ...]:
        found = GProp_GProps()
        BRepGProp.SurfaceProperties_s(face, found)
        return found.Mass(), *found.CentreOfMass().Coord()

    part = read_part(PARTS / name)
    wanted = np.array([mark(f) for f in faces_of(plain.OneShape())])
    assert np.allclose(wanted, [mark(f) for f in faces_of(part.as_read)])
    own = {tag: mark(part.face_shape(tag)) for tag in part.tags}
    # Faces of surfaces of revolution lie against their surface in IGES: the kernel's area is then of the other sign.
    assert np.allclose(
        [np.abs(wanted[tag - 1][0]) for tag in own], [abs(m[0]) for m in own.values()], rtol=1e-3
    )
    assert np.allclose(
        [wanted[tag - 1][1:] for tag in own], [m[1:] for m in own.values()], atol=0.05
    )
