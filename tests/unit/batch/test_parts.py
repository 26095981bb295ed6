"""Which parts a batch is of, and the folder of each."""

from __future__ import annotations

import os

import pytest
from hypothesis import given
from hypothesis import strategies as st

from trunnion.batch.parts import batch_parts, part_files
from trunnion.findings import BadInput


def folders(files, known=None):
    return [p.folder for p in batch_parts(files, known or {})]


@pytest.fixture
def tree(tmp_path, monkeypatch):
    """A folder with parts in folders, as the current one."""
    for name in ("a/rib.step", "a/panel.STP", "a/notes.txt", "b/rib.step", "b/c/rib.igs"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).touch()
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_a_folder_stands_for_the_part_files_in_it_by_name(tree):
    assert part_files(["a"]) == ("a/panel.STP", "a/rib.step")


def test_a_pattern_stands_for_the_part_files_it_meets_by_path(tree):
    assert part_files(["**/rib.*"]) == ("a/rib.step", "b/c/rib.igs", "b/rib.step")


def test_a_file_that_is_named_twice_is_one_part(tree):
    assert part_files(["b/rib.step", "b", str(tree / "b" / "rib.step")]) == ("b/rib.step",)


def test_a_file_that_is_not_there_stays_to_be_refused_by_itself(tree):
    assert part_files(["none.step"]) == ("none.step",)


@pytest.mark.parametrize("word", ["b/c/d", "a/*.igs"])
def test_a_folder_or_a_pattern_without_part_files_is_refused(tree, word):
    (tree / "b/c/d").mkdir()
    with pytest.raises(BadInput, match="no STEP or IGES file"):
        part_files([word])


def test_a_name_that_ledger_and_page_can_not_hold_is_refused(tree):
    (tree / "b" / os.fsdecode(b"r\xfcb.step")).touch()
    with pytest.raises(BadInput, match=r"'b/r\\udcfcb.step': the name is no UTF-8"):
        part_files(["b"])


def test_a_part_has_a_folder_of_its_name():
    files = ["x/rib.step", "x/panel.step.gz", "x/web.trunnion"]
    assert folders(files) == ["rib", "panel", "web"]


def test_parts_of_one_name_have_as_many_folders_before_it_as_tell_them_apart():
    files = ["/p/1/new/rib.step", "/p/2/new/rib.step", "/p/2/old/rib.step", "/p/web.step"]
    assert folders(files) == ["1-new-rib", "2-new-rib", "old-rib", "web"]


def test_files_of_one_folder_that_differ_in_the_ending_have_it_behind_the_name():
    assert folders(["/x/rib.step", "/x/rib.stp.gz", "/x/web.igs"]) == [
        "rib-step",
        "rib-stp-gz",
        "web",
    ]


def test_a_part_keeps_the_folder_that_it_had_in_an_earlier_run():
    assert folders(["/x/rib.step", "/y/rib.step"], {"/x/rib.step": "rib"}) == ["rib", "rib-2"]


def test_a_folder_of_a_part_that_is_not_in_this_batch_is_left_alone():
    assert folders(["/y/rib.step"], {"/x/rib.step": "RIB"}) == ["rib-2"]


NAMES = st.sampled_from(["rib", "Rib", "a-rib", "b-rib", "rib-2"])
FILES = st.builds(
    "/{}/{}{}".format,
    st.sampled_from(["a", "b", "a/b", "b/a"]),
    NAMES,
    st.sampled_from([".step", ".igs"]),
)


@given(files=st.lists(FILES, unique=True, max_size=12), known=st.dictionaries(FILES, NAMES))
def test_no_two_parts_share_a_folder_and_the_same_call_gives_the_same_names(files, known):
    owned = {name.casefold(): file for file, name in known.items()}
    known = {file: name for file, name in known.items() if owned[name.casefold()] == file}
    made = folders(files, known)
    assert len({name.casefold() for name in made}) == len(made)
    assert made == folders(files, known)
    assert all(os.sep not in name for name in made)
    for file, name in zip(files, made, strict=True):
        assert owned.get(name.casefold(), file) == file or known.get(file) == name
