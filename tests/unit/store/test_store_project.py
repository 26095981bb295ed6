"""The project file: every field comes back, hostile files are refused, and a kill never loses the last good one."""

from __future__ import annotations

import io
import random
import signal
import subprocess
import sys
import time
import zipfile
from dataclasses import fields, replace
from pathlib import Path

import numpy as np
import pytest

import programs
from programs import PART_BYTES
from trunnion.findings import BadInput
from trunnion.model.session import PartInfo, PostedFile, Session
from trunnion.settings import digest
from trunnion.store import project
from trunnion.store.mapping import load_array
from trunnion.store.project import load_project, project_bytes, save_project


@pytest.fixture
def saved(tmp_path) -> Path:
    save_project(programs.session(), tmp_path / "B1.trunnion", PART_BYTES, ".step")
    return tmp_path / "B1.trunnion"


def members_of(path: Path) -> dict[str, bytes]:
    with zipfile.ZipFile(path) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def pack(path: Path, members: dict[str, bytes]) -> Path:
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in members.items():
            archive.writestr(name, data)
    return path


def edited(path: Path, old: bytes, new: bytes) -> Path:
    members = members_of(path)
    assert old in members["session.xml"]
    members["session.xml"] = members["session.xml"].replace(old, new, 1)
    return pack(path, members)


def test_a_session_comes_back_as_it_was(saved):
    session, part, suffix = load_project(saved)
    assert (part, suffix) == (PART_BYTES, ".step")
    for field in fields(Session):
        assert digest(getattr(session, field.name)) == digest(
            getattr(programs.session(), field.name)
        ), field.name


def test_a_session_saved_again_has_the_same_bytes(saved):
    session, part, suffix = load_project(saved)
    assert (
        project_bytes(session, part, suffix)
        == saved.read_bytes()
        == project_bytes(programs.session(), PART_BYTES, ".step")
    )


def test_a_session_in_which_every_field_holds_something_is_what_these_tests_use():
    assert all(
        getattr(programs.session(), field.name) not in (None, (), {}) for field in fields(Session)
    )


def test_an_empty_session_comes_back_empty(tmp_path):
    save_project(Session(), tmp_path / "a.trunnion", b"", "")
    session, part, suffix = load_project(tmp_path / "a.trunnion")
    assert (digest(session), part, suffix) == (digest(Session()), b"", "")


def test_whole_numbers_where_decimals_may_stand_stay_whole_numbers(tmp_path):
    part = replace(programs.part_info(), area=1000, volume=0.1 + 0.2)
    save_project(Session(part=part), tmp_path / "a.trunnion", PART_BYTES, ".step")
    again = load_project(tmp_path / "a.trunnion")[0].part
    assert again is not None
    assert (type(again.area), again.volume) == (int, 0.1 + 0.2)


TEXTS = [
    "",
    " ",
    "\n",
    "a\r\nb",
    "tab\tin",
    "\x00\x1f",
    "5° < & > \"'",
    "\ud800",
    "ü" * 5000,
    "back\\slash",
    "\ufffe",
]


@pytest.mark.parametrize("text", TEXTS)
def test_any_text_comes_back(tmp_path, text):
    posted = (PostedFile(suffix="S1.nc", dialect="linuxcnc", setup="S1", text=text),)
    save_project(Session(posted=posted), tmp_path / "a.trunnion", b"", "")
    assert load_project(tmp_path / "a.trunnion")[0].posted == posted


def test_arrays_come_back_to_the_last_bit_and_read_only(saved):
    session = load_project(saved)[0]
    path = session.paths[0].path
    assert path.position.tobytes() == programs.POCKET.position.tobytes()
    assert np.isnan(path.centre[0]).all()
    assert not path.position.flags.writeable
    assert session.recognition is not None
    assert session.recognition.frame.x.tobytes() == programs.recognition().frame.x.tobytes()


def test_toolpaths_stand_as_npy_and_the_part_as_it_was_read(saved):
    members = members_of(saved)
    assert members["part.step"] == PART_BYTES
    positions = [load_array(data, name) for name, data in members.items() if name.endswith(".npy")]
    assert any(a.shape == (10, 3) for a in positions)


def test_a_value_that_its_hint_forbids_is_not_saved():
    with pytest.raises(TypeError, match="a str stands where"):
        project_bytes(Session(sizes="wrong"), b"", "")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            b'version="1"',
            b'version="7"',
            "written in format 7; this Trunnion reads format 1: use the Trunnion that wrote it",
        ),
        (
            b"<trunnion-project",
            b"<!DOCTYPE a [<!ENTITY b 'c'>]><trunnion-project",
            "holds a document type or entities, which are never read",
        ),
        (
            b"<n-faces>42</n-faces>",
            b"<n-faces>many</n-faces>",
            r"session.xml, line 9: <n-faces> can't be read: invalid literal",
        ),
        (
            b"<n-faces>42</n-faces>",
            b"<colour>red</colour>",
            r"session.xml, line \d+: <colour> is not known in <part>",
        ),
        (
            b"<n-faces>42</n-faces>",
            b"",
            r"session.xml, line \d+: <part> can't be used: .*missing 1 required keyword-only argument: 'n_faces'",
        ),
        (
            b"<severity>info</severity>",
            b"<severity>loud</severity>",
            "'loud' is not a valid Severity",
        ),
        (b'part="part.step"', b'part="part.iges"', "the part file is missing in it"),
        (b"arrays/00", b"arrays/99", r"line \d+: the archive has no member arrays/99"),
        (b"</session>", b"", "damaged XML: Opening and ending tag mismatch"),
        (b"encoding='UTF-8'", b"encoding='ISO-8859-1'", "must be UTF-8 text, not ISO-8859-1"),
        (b'type="int">5<', b'type="tuple">5<', "says type tuple, which doesn't belong there"),
        (b"<trunnion-project", b"<other", "damaged XML"),
    ],
)
def test_a_spoiled_session_is_refused_in_one_line(saved, old, new, message):
    edited(saved, old, new)
    with pytest.raises(BadInput, match=message) as refused:
        load_project(saved)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(
    "name",
    [
        "../evil.txt",
        "/etc/passwd",
        "arrays/../../x.npy",
        "..\\evil",
        "C:evil",
        "arrays/00001.npy/x",
        "run.py",
    ],
)
def test_names_that_leave_the_archive_or_do_not_belong_are_refused(saved, name):
    pack(saved, {**members_of(saved), name: b"x"})
    with pytest.raises(BadInput, match="which no project has; it is not opened"):
        load_project(saved)


def test_a_member_that_stands_twice_is_refused(saved):
    with pytest.warns(UserWarning, match="Duplicate name"), zipfile.ZipFile(saved, "a") as archive:
        archive.writestr("part.step", b"other")
    with pytest.raises(BadInput, match="a member stands twice in it"):
        load_project(saved)


def test_a_member_that_would_open_too_large_is_refused(saved, monkeypatch):
    monkeypatch.setattr(project, "LARGEST_MEMBER", 1000)
    with pytest.raises(
        BadInput, match=r"session\.xml would open to \d+ bytes; at most 1000 are read"
    ):
        load_project(saved)


def test_members_that_together_open_too_large_are_refused(saved, monkeypatch):
    monkeypatch.setattr(project, "LARGEST_PROJECT", 1000)
    with pytest.raises(BadInput, match=r"would open to \d+ bytes; at most 1000 are read"):
        load_project(saved)


def test_a_member_that_lies_about_its_size_is_refused(saved):
    data = bytearray(saved.read_bytes())
    with zipfile.ZipFile(io.BytesIO(bytes(data))) as archive:
        size = archive.getinfo("part.step").file_size
    at = data.rindex(b"part.step") - 46 + 24
    assert int.from_bytes(data[at : at + 4], "little") == size
    data[at : at + 4] = (size - 5).to_bytes(4, "little")
    saved.write_bytes(bytes(data))
    with pytest.raises(BadInput, match="damaged, or not a project file"):
        load_project(saved)


def test_another_part_file_is_noticed(saved):
    pack(saved, {**members_of(saved), "part.step": b"another part"})
    with pytest.raises(
        BadInput, match="the part file in it is not the one that its plan was made for"
    ):
        load_project(saved)


@pytest.mark.parametrize("data", [b"", b"no zip at all", b"PK\x03\x04" + b"\0" * 60])
def test_what_is_no_project_is_refused(tmp_path, data):
    (tmp_path / "a.trunnion").write_bytes(data)
    with pytest.raises(BadInput, match="damaged, or not a project file"):
        load_project(tmp_path / "a.trunnion")


def test_a_zip_of_something_else_is_refused(tmp_path):
    with pytest.raises(BadInput, match=r"not a project file: it holds no session\.xml"):
        load_project(pack(tmp_path / "a.trunnion", {"hello.txt": b"x"}))


def test_a_file_that_is_not_there_is_refused(tmp_path):
    with pytest.raises(BadInput, match="can't be read: No such file or directory"):
        load_project(tmp_path / "a.trunnion")


def test_a_file_cut_anywhere_is_refused_in_one_line(saved):
    whole = saved.read_bytes()
    for share in (0.1, 0.5, 0.9, 0.999):
        saved.write_bytes(whole[: int(len(whole) * share)])
        with pytest.raises(BadInput, match="damaged, or not a project file"):
            load_project(saved)


def test_a_flipped_byte_never_gives_another_session(saved):
    whole, rng = saved.read_bytes(), random.Random(5)
    for _ in range(60):
        spoiled = bytearray(whole)
        spoiled[rng.randrange(len(whole))] ^= 1 << rng.randrange(8)
        saved.write_bytes(bytes(spoiled))
        try:
            again = load_project(saved)
        except BadInput:
            continue
        assert digest(again[0]) == digest(programs.session())
        assert again[1] == PART_BYTES


@pytest.mark.parametrize("data", [b"\x93NUMPY\x01\x00", b"\x93NUMPY\x02\x00" + b" " * 100, b"junk"])
def test_an_array_that_was_not_written_here_is_refused(data):
    with pytest.raises(BadInput, match="not an array that was written here"):
        load_array(data, "arrays/00001.npy")


def test_an_array_that_claims_more_than_it_has_is_refused():
    file = io.BytesIO()
    np.lib.format.write_array_header_1_0(
        file, {"descr": "<f8", "fortran_order": False, "shape": (10**12,)}
    )
    with pytest.raises(BadInput, match="the array's header doesn't fit its 0 bytes"):
        load_array(file.getvalue(), "arrays/00001.npy")


def test_an_array_of_objects_is_refused():
    file = io.BytesIO()
    np.lib.format.write_array_header_1_0(
        file, {"descr": "|O", "fortran_order": False, "shape": (1,)}
    )
    with pytest.raises(BadInput, match="the array's header doesn't fit"):
        load_array(file.getvalue() + b"x" * 8, "arrays/00001.npy")


def test_a_suffix_that_no_part_file_has_is_refused():
    with pytest.raises(BadInput, match="not the suffix of a part file"):
        project_bytes(Session(), b"", ".st/ep")


SAVER = """
import sys
sys.path.insert(0, sys.argv[1])
from dataclasses import replace
import programs
from trunnion.store.project import save_project
session, turn = programs.session(), 0
print("ready", flush=True)
while True:
    turn += 1
    save_project(replace(session, choices={"turn": turn}), sys.argv[2], programs.PART_BYTES, ".step")
"""


def test_killing_the_program_while_it_saves_never_loses_the_last_good_file(tmp_path):
    path, rng, turns = tmp_path / "B1.trunnion", random.Random(9), []
    for _ in range(8):
        with subprocess.Popen(
            [sys.executable, "-c", SAVER, str(Path(__file__).parents[2]), str(path)],
            stdout=subprocess.PIPE,
        ) as child:
            assert child.stdout is not None and child.stdout.readline() == b"ready\n"
            while not path.exists():
                time.sleep(0.001)
            time.sleep(rng.uniform(0.0, 0.06))
            child.send_signal(signal.SIGKILL)
        session, part, _ = load_project(path)
        turns.append(session.choices["turn"])
        assert part == PART_BYTES
        assert digest(session.paths) == digest(programs.session().paths)
    assert all(isinstance(t, int) and t >= 1 for t in turns)
    save_project(programs.session(), path, PART_BYTES, ".step")
    assert [p.name for p in tmp_path.iterdir()] == ["B1.trunnion"]


def test_what_a_session_keeps_of_its_part_has_no_field_that_is_not_saved(saved):
    again, before = load_project(saved)[0].part, programs.part_info()
    assert [digest(getattr(again, f.name)) for f in fields(PartInfo)] == [
        digest(getattr(before, f.name)) for f in fields(PartInfo)
    ]
