"""What a file's text tells before the CAD kernel sees it."""

from __future__ import annotations

import pytest

import samples
from trunnion.findings import BadInput
from trunnion.part.read.text import check_iges, check_step, kind_of

STEP = samples.written(samples.box_shape()).read_bytes()
IGES = samples.written(samples.box_shape(), "igs").read_bytes()


def test_the_kind_is_told_by_the_content() -> None:
    assert kind_of(STEP, "a.igs") == "step"
    assert kind_of(IGES, "a.step") == "iges"


def test_the_faces_of_a_box_are_counted() -> None:
    assert check_step(STEP, "a.step") == 6
    assert check_iges(IGES, "a.igs") == 6


@pytest.mark.parametrize("data", [b"bread, butter, milk\n", bytes(range(256)) * 20])
def test_what_is_no_part_file_is_refused(data: bytes) -> None:
    with pytest.raises(BadInput, match="neither a STEP nor an IGES file"):
        kind_of(data, "a.step")


def test_an_empty_file_is_refused() -> None:
    with pytest.raises(BadInput, match=r"a\.step: the file is empty"):
        kind_of(b"", "a.step")


def test_a_step_file_cut_in_half_is_refused() -> None:
    with pytest.raises(BadInput, match="cut off"):
        check_step(STEP[: len(STEP) // 2], "a.step")


def test_a_reference_to_nothing_is_refused() -> None:
    with pytest.raises(BadInput, match="#999999 is referred to but not in the file"):
        check_step(STEP.replace(b"PLANE('',#", b"PLANE('',#999999,#", 1), "a.step")


def test_a_size_that_refers_to_nothing_loses_no_face() -> None:
    size = b"#900000=DIMENSIONAL_SIZE(#999999,'diameter');ENDSEC;"
    data = size.join(STEP.rsplit(b"ENDSEC;", 1))
    assert check_step(data, "a.step") == 6
    with pytest.raises(BadInput, match="#999998 is referred to"):
        check_step(data.replace(b"PLANE('',#", b"PLANE('',#999998,#", 1), "a.step")


def test_a_reference_inside_a_text_is_no_reference() -> None:
    assert (
        check_step(STEP.replace(b"PLANE('',", b"PLANE('see #999999 /* not a remark',", 1), "a.step")
        == 6
    )


@pytest.mark.parametrize("word", [b"NaN", b"inf", b"-1.#IND"])
def test_a_coordinate_that_is_no_number_is_refused_with_its_line(word: bytes) -> None:
    with pytest.raises(BadInput, match=r"in line \d+ is not a number"):
        check_step(
            STEP.replace(b"CARTESIAN_POINT('',(0.,", b"CARTESIAN_POINT('',(" + word + b",", 1),
            "a.step",
        )


def test_an_iges_file_without_its_last_section_is_refused() -> None:
    with pytest.raises(BadInput, match="T section is missing"):
        check_iges(b"\n".join(IGES.splitlines()[:-1]) + b"\n", "a.igs")


def test_an_iges_file_cut_in_mid_line_is_refused() -> None:
    with pytest.raises(BadInput, match="cut off or damaged"):
        check_iges(IGES[: len(IGES) * 2 // 3 + 7], "a.igs")


def test_an_iges_file_with_a_line_missing_is_refused() -> None:
    lines = IGES.splitlines()
    with pytest.raises(BadInput, match=r"section P of the IGES file has \d+ of \d+ lines"):
        check_iges(b"\n".join(lines[:-9] + lines[-8:]), "a.igs")
