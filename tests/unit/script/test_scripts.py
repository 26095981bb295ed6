"""Scripts: the examples of the page run, what is recorded does the same again, errors are one line."""

from __future__ import annotations

import inspect
import re
import shutil
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

import trunnion
from parts import ROOT
from trunnion.cli.main import BAD, DONE, main
from trunnion.findings import BadInput, TrunnionError
from trunnion.script.program import PartProgram
from trunnion.script.recording import HEAD, literal

PAGE = (ROOT / "docs" / "scripts.md").read_text()
EXAMPLES = re.findall(r"^```python\n(.*?)^```", PAGE, re.MULTILINE | re.DOTALL)
HEAVY = ("OCP", "numpy", "numba", "shapely", "scipy", "dask", "trunnion.pipeline")
METHODS = {
    name
    for name, method in inspect.getmembers(PartProgram, inspect.isfunction)
    if not name.startswith("_") and name != "run"
}


@pytest.fixture(scope="module")
def scripted(tmp_path_factory, sample_part):
    """The folder that the page's examples were run in, one after another, and the program they made."""
    folder = tmp_path_factory.mktemp("script")
    shutil.copy(sample_part, folder / "block.step")
    names: dict = {}
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        for example in EXAMPLES:
            exec(example, names)
    return SimpleNamespace(folder=folder, program=names["program"], files=names["files"])


@pytest.fixture
def opened(sample_part):
    """The program of the block, nothing computed yet."""
    return trunnion.open(sample_part)


def nc_of(folder):
    return {f.name: f.read_bytes() for f in sorted(folder.iterdir()) if f.suffix in (".nc", ".cl")}


def test_import_loads_nothing_heavy():
    code = f"import sys, trunnion; print([m for m in {HEAVY!r} if m in sys.modules])"
    said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert said.stdout.strip() == "[]"


def test_the_examples_of_the_page_run_and_write_a_released_program(scripted):
    assert len(EXAMPLES) >= 5
    assert scripted.program.session.verdict.releases
    assert set(scripted.files) == {"block.S1.nc", "block.cl"}
    assert "RELEASED" in (scripted.folder / "out" / "block.S1.nc").read_text()
    assert (scripted.folder / "block.trunnion").is_file()


def test_the_page_names_every_method_and_no_other_one():
    rows = "\n".join(line for line in PAGE.splitlines() if line.startswith("| `"))
    named = set(re.findall(r"`(\w+)\(", rows)) | set(re.findall(r"`(\w+)\(", PAGE))
    assert METHODS - {"script", "record"} <= named
    assert named - METHODS <= {"open"}
    for method, arguments in re.findall(r"`(\w+)\((\w[\w, ]*)\)`", rows):
        parameters = list(inspect.signature(getattr(PartProgram, method)).parameters)[1:]
        assert arguments.split(", ") == parameters, method


def test_a_recorded_session_run_again_writes_the_same_bytes(scripted, tmp_path, monkeypatch):
    script = scripted.program.script()
    assert "trunnion.open('block.step', settings={'blank.top': 3.0})" in script
    assert "feed=900.0)" in script
    shutil.copy(scripted.folder / "block.step", tmp_path)
    monkeypatch.chdir(tmp_path)
    exec(script, {})
    assert nc_of(tmp_path / "out") == nc_of(scripted.folder / "out")


def test_commands_append_what_they_do_to_a_script_that_does_it_again(
    scripted, tmp_path, monkeypatch, capsys
):
    first = scripted.program.session.process.operations[0].id
    for place in ("one", "two"):
        (tmp_path / place).mkdir()
        shutil.copy(scripted.folder / "block.step", tmp_path / place)
    monkeypatch.chdir(tmp_path / "one")
    record = ("--record", "session.py", "--quiet")
    change = ["change", "block.step", "--operation", first, "--feed", "800", *record]
    assert main([*change, "--out", "block.trunnion", "--set", "blank.top=2"]) == DONE
    assert main(["post", "block.trunnion", "-o", "out", *record]) == DONE
    script = Path("session.py").read_text()
    assert script == (
        f"{HEAD}\n"
        "program = trunnion.open('block.step', settings={'blank.top': '2'})\n"
        f"program.change('{first}', feed=800.0)\n"
        "program.save('block.trunnion')\n"
        "\n"
        "program = trunnion.open('block.trunnion')\n"
        "program.post('out')\n"
    )
    monkeypatch.chdir(tmp_path / "two")
    exec(script, {})
    written = nc_of(Path("out"))
    assert written and written == nc_of(tmp_path / "one" / "out")


def test_features_are_edited_as_the_command_does(sample_part, tmp_path, capsys):
    program = trunnion.open(sample_part)
    pocket = next(f for f in program.recognize() if f.kind == "pocket")
    face = pocket.tags[-1]
    program.take_faces(pocket.id, iter([face]))
    edited = next(f for f in program.session.recognition if f.id == pocket.id)
    assert face not in edited.tags and edited.by_hand
    script = tmp_path / "edit.py"
    out = ["--out", str(tmp_path / "edited.trunnion"), "--quiet"]
    call = ["edit", str(sample_part), "--take", f"{pocket.id}={face}", "--record", str(script)]
    main([*call, *out])
    (line,) = [x for x in script.read_text().splitlines() if "take_faces" in x]
    assert line == f"program.take_faces('{pocket.id}', [{face}])"
    assert line in program.script()
    saved = trunnion.open(tmp_path / "edited.trunnion").session.recognition
    assert saved.feature(pocket.id).tags == edited.tags


def test_operations_are_copied_changed_and_deleted(opened):
    last = opened.route()[-1].id
    copy = opened.copy(last)
    opened.change(copy, spindle=2000.0, own={"overlap": 1.5})
    made = {o.id: o for o in opened.optimize()}
    assert made[copy].data.spindle == 2000.0 and made[copy].by_hand
    opened.change(last, suppressed=True)
    assert opened.session.process.operation(last).suppressed
    opened.delete(copy)
    assert copy not in {o.id for o in opened.route()}


def test_a_face_is_cut(opened):
    low, high = opened.session.part.low, opened.session.part.high
    n = opened.session.part.n_faces
    side = next(
        f for f in range(1, n + 1) if _divides(opened, f, 0.5 * (low + high), (1.0, 0.0, 0.0))
    )
    assert opened.session.part.n_faces == n + 1
    assert f"program.cut_by_plane({side}, " in opened.script()


def _divides(program, face, point, normal):
    try:
        program.cut_by_plane(face, point, normal)
    except BadInput:
        return False
    return True


@pytest.mark.parametrize(
    ("act", "words"),
    [
        (lambda p: p.set({"blank.top": -1.0}), "blank.top"),
        (lambda p: p.merge(["pocket-01"]), "two features or more"),
        (lambda p: p.change("nothing-01", feed=100.0), "there is no operation nothing-01"),
        (lambda p: p.change("nothing-01"), "nothing to change of nothing-01"),
        (lambda p: p.cut_by_plane(1, (0.0, 0.0), (0.0, 0.0, 1.0)), "three numbers, not 2"),
        (lambda p: p.write("out", name="a/b"), "can't be the name of files"),
        (lambda p: p.record("session.txt"), "name it session.py"),
    ],
)
def test_what_can_not_be_done_is_one_line_and_is_not_recorded(opened, act, words):
    before = opened.script()
    with pytest.raises(TrunnionError, match=re.escape(words)) as reason:
        act(opened)
    assert "\n" not in str(reason.value)
    assert opened.script() == before


def test_a_file_that_is_none_is_refused(tmp_path):
    with pytest.raises(BadInput, match="no such file"):
        trunnion.open(tmp_path / "none.step")


def test_a_script_that_can_not_be_written_is_named(opened, tmp_path):
    opened.record(tmp_path / "none" / "session.py")
    with pytest.raises(BadInput, match=r"session\.py: can't be written"):
        opened.set({"blank.top": 2.0})


def test_opening_alone_leaves_no_script(opened, tmp_path):
    opened.record(tmp_path / "session.py")
    assert not (tmp_path / "session.py").exists()


def test_a_name_that_is_no_scripts_is_refused_by_the_command(sample_part, capsys):
    with pytest.raises(SystemExit) as left:
        main(["post", str(sample_part), "-o", "out", "--record", "session.txt"])
    assert left.value.code == BAD and "ends in .py" in capsys.readouterr().err


def test_progress_is_reported(sample_part):
    heard = []
    program = trunnion.open(sample_part, report=lambda share, text: heard.append((share, text)))
    program.recognize()
    assert heard[-1] == (1.0, "done") and all(0.0 <= share <= 1.0 for share, _ in heard)


@pytest.mark.parametrize(
    "value", [1, 2.5, True, "it's", ("a", 1), {"k": (1.0, None)}, 1e-7, -0.0, "zwölf\n"]
)
def test_values_are_written_as_python_reads_them(value):
    read = eval(literal(value))
    assert read == (list(value) if isinstance(value, tuple) else _with_lists(value))


def _with_lists(value):
    return {k: list(v) for k, v in value.items()} if isinstance(value, dict) else value
