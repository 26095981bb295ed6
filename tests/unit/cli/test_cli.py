"""The command line as a person meets it: quick help, one clear line for bad input, exit codes."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import cadquery as cq
import pytest

from parts import PARTS, needs_parts
from trunnion import registry
from trunnion.cli.main import BAD, CANCELLED, GENERAL, main
from trunnion.findings import BadInput, Refused
from trunnion.pipeline import Engine, steps

HEAVY = ("OCP", "cadquery", "vtkmodules", "pyvista", "PySide6", "numba", "shapely")


def test_help_loads_nothing_heavy() -> None:
    code = (
        "import sys\nfrom trunnion.cli.main import main\n"
        "try:\n    main(['--help'])\nexcept SystemExit:\n    pass\n"
        f"print('HEAVY', [m for m in {HEAVY!r} if m in sys.modules])"
    )
    said = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    ).stdout
    assert said.splitlines()[-1] == "HEAVY []"
    general = (module.rpartition(".")[2] for module in GENERAL)
    assert all(command in said for command in (*general, *registry.names("commands")))


@pytest.mark.parametrize(("given", "threads"), [(None, "1"), ("4", "4")])
def test_linear_algebra_has_one_thread_unless_a_person_sets_it(given, threads) -> None:
    own = {k: v for k, v in os.environ.items() if k != "OPENBLAS_NUM_THREADS"}
    if given is not None:
        own["OPENBLAS_NUM_THREADS"] = given
    code = (
        "import os, sys, trunnion\n"
        "print(os.environ['OPENBLAS_NUM_THREADS'], 'numpy' in sys.modules)"
    )
    said = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, env=own
    ).stdout
    assert said.split() == [threads, "False"]


@pytest.mark.parametrize(
    "arguments", [["frobnicate"], ["program", "x.step"], ["info"], ["recognize", "--colour"]]
)
def test_a_call_it_does_not_understand_is_one_line_and_exit_2(
    arguments: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as left:
        main(arguments)
    said = capsys.readouterr()
    assert left.value.code == BAD
    assert said.out == "" and len(said.err.strip().splitlines()) == 1


def test_a_missing_file_is_one_line_and_exit_2(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["info", str(tmp_path / "none.step")]) == BAD
    said = capsys.readouterr()
    assert said.out == "" and "none.step" in said.err and len(said.err.strip().splitlines()) == 1


@pytest.mark.parametrize("content", [None, b"\xff\xfe\x00G1"])
def test_an_nc_file_that_can_not_be_read_is_told_before_anything_is_computed(
    tmp_path: Path,
    content: bytes | None,
    sample_part: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    file = tmp_path / "edited.nc"
    if content is not None:
        file.write_bytes(content)
    monkeypatch.setattr(
        "trunnion.pipeline.Engine.open", lambda *_, **__: pytest.fail("the part was opened first")
    )
    assert main(["verify", str(sample_part), "--nc", str(file)]) == BAD
    said = capsys.readouterr().err.strip()
    assert len(said.splitlines()) == 1 and said.count("edited.nc") == 1 and "Errno" not in said


def test_a_setting_without_a_value_is_refused(
    capsys: pytest.CaptureFixture[str], sample_part: Path
) -> None:
    assert main(["recognize", str(sample_part), "--set", "plane.rough.slot_feed"]) == BAD
    assert "--set wants KEY=VALUE" in capsys.readouterr().err


def test_an_unknown_setting_is_refused_with_what_may_be_meant(
    capsys: pytest.CaptureFixture[str], sample_part: Path
) -> None:
    assert main(["recognize", str(sample_part), "--set", "plane.ruff.slot_feed=0.4"]) == BAD
    assert "plane.rough.slot_feed" in capsys.readouterr().err


def test_a_value_out_of_range_is_refused_in_words(
    capsys: pytest.CaptureFixture[str], sample_part: Path
) -> None:
    assert main(["recognize", str(sample_part), "--set", "plane.rough.slot_feed=7"]) == BAD
    assert "must be" in capsys.readouterr().err


def test_features_come_as_json_with_the_documented_keys(
    capsys: pytest.CaptureFixture[str], sample_part: Path
) -> None:
    main(["recognize", str(sample_part), "--json"])
    said = json.loads(capsys.readouterr().out)
    assert {
        "part",
        "digest",
        "family",
        "taken_for",
        "frame",
        "features",
        "unexplained",
        "findings",
    } <= said.keys()
    assert {"id", "kind", "faces", "sizes"} <= said["features"][0].keys()


def test_the_table_of_features_names_the_faces_that_move_takes(
    capsys: pytest.CaptureFixture[str], sample_part: Path
) -> None:
    assert (
        main(
            [
                "recognize",
                str(sample_part),
                "--set",
                "recognize.family=surface",
                "--move",
                "1,2=new",
                "--quiet",
            ]
        )
        == 0
    )
    said = capsys.readouterr().out.splitlines()[1:]
    assert said[0].split() == ["feature", "kind", "n", "faces", "sizes"]
    assert any(" 1,2 " in line for line in said)
    assert any(line.endswith(" groups") for line in said)


def test_the_table_of_features_says_why_some_are_local(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    plate = cq.Workplane("XY").box(60.0, 40.0, 8.0)
    boss = cq.Workplane("XY").sphere(5.0).translate((0.0, 0.0, 4.0))
    cq.exporters.export(plate.union(boss), str(tmp_path / "boss.step"))
    main(["recognize", str(tmp_path / "boss.step"), "--set", "recognize.family=surface"])
    shown = capsys.readouterr()
    assert "sizes of connected faces jump from" in shown.out
    assert "proposed as local" in shown.out


def test_sizes_blank_route_and_optimize_each_print_json(
    capsys: pytest.CaptureFixture[str], sample_part: Path
) -> None:
    for command, key in (
        ("size", "sizes"),
        ("blank", "volume"),
        ("route", "operations"),
        ("optimize", "operations"),
    ):
        main([command, str(sample_part), "--json"])
        assert key in json.loads(capsys.readouterr().out), command


def test_optimize_tells_the_highest_load_and_where_it_is(
    capsys: pytest.CaptureFixture[str], sample_part: Path
) -> None:
    main(["optimize", str(sample_part)])
    said = capsys.readouterr().out
    assert "peak kW" in said.splitlines()[0]
    (line,) = [line for line in said.splitlines() if line.startswith("highest load: ")]
    assert re.fullmatch(
        r"highest load: \S+, \d+\.\d of 28\.0 kW where [a-z ]+ \(\d+\.\d kW steady\)", line
    )


def test_every_setting_is_listed_with_its_range(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["settings", "--json"]) == 0
    listed = {entry["key"]: entry for entry in json.loads(capsys.readouterr().out)}
    assert {"recognize.family", "plane.rough.slot_feed", "blank.top"} <= listed.keys()
    assert listed["blank.top"]["unit"] == "mm"


@pytest.mark.parametrize("command", ["program", "post"])
def test_a_folder_that_can_not_be_made_is_refused_before_the_part_is_read(
    command: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "file").write_text("in the way", encoding="utf-8")
    assert (
        main([command, str(tmp_path / "none.step"), "-o", str(tmp_path / "file" / "deeper")]) == BAD
    )
    said = capsys.readouterr().err
    assert (
        said
        == f"trunnion: {tmp_path / 'file' / 'deeper'}: can't be written to: {tmp_path / 'file'} is not a folder\n"
    )


def test_an_empty_folder_name_is_refused_not_taken_for_the_current_folder(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as left:
        main(["program", str(tmp_path / "none.step"), "-o", ""])
    assert left.value.code == BAD and "the name of a folder is empty" in capsys.readouterr().err


def test_a_name_that_is_no_file_name_is_refused_before_the_part_is_read(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert (
        main(["program", str(tmp_path / "none.step"), "-o", str(tmp_path), "--name", "a/b"]) == BAD
    )
    assert "can't be the name of files" in capsys.readouterr().err


@pytest.mark.parametrize("reason", [Refused("the machine can't follow"), KeyboardInterrupt()])
def test_toolpaths_are_kept_where_the_program_can_not_be_made(
    capsys: pytest.CaptureFixture[str],
    sample_part: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    reason: BaseException,
) -> None:
    def stop(*_: object) -> None:
        raise reason

    monkeypatch.setattr(steps, "prove_session", stop)
    code = main(["program", str(sample_part), "-o", str(tmp_path / "out"), "--name", "kept"])
    assert code == (BAD if isinstance(reason, Refused) else CANCELLED)
    kept = tmp_path / "out" / "kept.trunnion"
    assert f"plan and toolpaths are kept in {kept}" in capsys.readouterr().err
    session = Engine().open(kept)
    assert session.paths and all(len(p.path) for p in session.paths)


def test_why_there_is_no_program_is_said_where_toolpaths_can_not_be_kept_either(
    capsys: pytest.CaptureFixture[str],
    sample_part: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def stop(*_: object) -> None:
        raise Refused("the machine can't follow")

    def full(*_: object) -> None:
        raise BadInput("no space is left")

    monkeypatch.setattr(steps, "prove_session", stop)
    monkeypatch.setattr(Engine, "save", full)
    assert main(["program", str(sample_part), "-o", str(tmp_path / "out")]) == BAD
    said = capsys.readouterr().err
    assert "the machine can't follow; plan and toolpaths can't be kept in" in said
    assert "no space is left" in said


def test_a_user_folder_that_is_missing_is_refused(
    capsys: pytest.CaptureFixture[str], sample_part: Path, tmp_path: Path
) -> None:
    assert main(["info", str(sample_part), "--user-folder", str(tmp_path / "shop")]) == BAD
    assert (
        capsys.readouterr().err
        == f"trunnion: {tmp_path / 'shop'}: no such folder of tools, materials, machines and plans\n"
    )


def test_a_blank_that_can_not_be_written_is_one_line(
    capsys: pytest.CaptureFixture[str], sample_part: Path, tmp_path: Path
) -> None:
    assert main(["blank", str(sample_part), "--step", str(tmp_path / "none" / "blank.step")]) == BAD
    said = capsys.readouterr().err
    assert (
        "blank.step: can't be written: No such file or directory" in said
        and len(said.splitlines()) == 1
    )


@needs_parts
@pytest.mark.parametrize(
    ("part", "cause"),
    [
        (
            "open_shell.step",
            "the faces enclose no material and can't be machined from any one side",
        ),
        ("huge_20_metres.step", "the blank exceeds the machine's travel"),
    ],
)
def test_a_part_that_can_not_be_planned_is_named_with_the_cause(
    part: str, cause: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert PARTS is not None
    assert main(["program", str(PARTS / "nasty" / part), "-o", str(tmp_path / "out")]) == BAD
    said = capsys.readouterr().err
    assert said.startswith(f"trunnion: {part}: ") and cause in said and len(said.splitlines()) == 1
    assert not (tmp_path / "out").exists()


def test_a_window_without_a_screen_is_refused_in_one_line(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(sys, "platform", "linux")
    assert main(["gui"]) == BAD
    said = capsys.readouterr().err
    assert (
        said.startswith("trunnion: no screen to open the window on") and len(said.splitlines()) == 1
    )
