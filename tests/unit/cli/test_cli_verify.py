"""`trunnion verify --nc` with numbers that no machine could do: exit codes, one line, and JSON that every reader takes."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from samples import block_with_pocket
from trunnion.cli.main import BAD, main
from trunnion.findings import BadInput
from trunnion.pipeline import Engine
from trunnion.pipeline.proof import external_nc


@pytest.fixture(scope="module")
def programmed(tmp_path_factory) -> tuple[Path, str, float]:
    """The project of a block with a pocket, its NC text, and its machining time, s."""
    folder = tmp_path_factory.mktemp("block")
    engine = Engine()
    session = engine.run(engine.open(block_with_pocket()))
    engine.write(session, folder, name="block")
    return (
        folder / "block.trunnion",
        (folder / "block.S1.nc").read_text(),
        session.verdict.machining_time_s,
    )


def verify(project: Path, file: Path, capsys, *more: str) -> tuple[int, str, str]:
    code = main(["verify", str(project), "--nc", str(file), "--json", *more])
    said = capsys.readouterr()
    return code, said.out, said.err


def with_line(text: str, new: str) -> str:
    """Return a text with a line put in before its first feed move."""
    lines = text.split("\n")
    row = next(n for n, line in enumerate(lines) if " G1 " in line)
    return "\n".join([*lines[:row], new, *lines[row:]])


def finite_json(text: str) -> dict:
    return json.loads(text, parse_constant=lambda word: pytest.fail(f"{word} is no number of JSON"))


@pytest.mark.parametrize(
    ("new", "code"),
    [
        ("S0", "verify.spindle-stands"),
        ("G1 X30 F0.001", "verify.endless"),
        ("G0 X99999", "verify.travel"),
    ],
)
def test_what_no_machine_should_run_is_a_failed_verdict_and_exit_1(
    programmed, tmp_path, capsys, new, code
):
    project, text, _ = programmed
    (tmp_path / "edited.nc").write_text(with_line(text, new))
    left, out, _ = verify(project, tmp_path / "edited.nc", capsys)
    said = finite_json(out)
    assert (left, said["verdict"]) == (1, "failed")
    assert code in {f["code"] for f in said["findings"] if f["severity"] == "error"}


@pytest.mark.parametrize(
    ("new", "words"),
    [
        ("G1 X" + "9" * 400, "Xinf is out of range"),
        ("G4 P99999999999", "P99999999999 is out of range"),
        ("G3 I0 F100", "an arc without a radius"),
        ("F0", "the feed F must be above zero"),
    ],
)
def test_what_cannot_be_read_is_one_line_that_names_the_file_and_exit_2(
    programmed, tmp_path, capsys, new, words
):
    project, text, _ = programmed
    (tmp_path / "edited.nc").write_text(with_line(text, new))
    left, out, err = verify(project, tmp_path / "edited.nc", capsys)
    row = with_line(text, new).split("\n").index(new) + 1
    assert (left, out) == (BAD, "") and len(err.strip().splitlines()) == 1
    assert f"edited.nc: line {row}: {words}" in err


def test_a_dwell_is_in_the_machining_time(programmed, tmp_path, capsys):
    project, text, plain = programmed
    (tmp_path / "waits.nc").write_text(with_line(text, "G4 P120"))
    left, out, _ = verify(project, tmp_path / "waits.nc", capsys)
    assert left == 0
    assert finite_json(out)["machining_time_s"] == pytest.approx(plain + 120.0)


def test_cl_text_is_judged_in_the_same_way(programmed, tmp_path, capsys):
    project = programmed[0]
    text = re.sub(
        "SPINDL/RPM,[0-9]+", "SPINDL/RPM,0", project.with_suffix(".cl").read_text(), count=1
    )
    (tmp_path / "edited.cl").write_text(text)
    left, out, _ = verify(project, tmp_path / "edited.cl", capsys, "--set", "post.dialect=apt")
    assert left == 1
    assert [f["code"] for f in finite_json(out)["findings"] if f["severity"] == "error"] == [
        "verify.spindle-stands"
    ]


def test_a_stream_without_an_end_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(external_nc, "MOST_BYTES", 1000)
    (tmp_path / "endless.nc").write_text("G0 X1\n" * 1000)
    with pytest.raises(BadInput, match="endless.nc: is larger than 0 MB"):
        external_nc.text_of(tmp_path / "endless.nc")
