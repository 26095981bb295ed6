"""Files are written whole or not at all."""

from __future__ import annotations

import os
import stat

import pytest

from trunnion.findings import BadInput
from trunnion.store.atomic import write_bytes, write_text, write_with


def test_a_text_is_written_in_utf_8_with_its_line_ends(tmp_path):
    write_text(tmp_path / "a.txt", "Träger\r\n")
    assert (tmp_path / "a.txt").read_bytes() == b"Tr\xc3\xa4ger\r\n"


def test_only_the_file_is_left_in_the_folder(tmp_path):
    write_bytes(tmp_path / "a.txt", b"1")
    write_bytes(tmp_path / "a.txt", b"2")
    assert [p.name for p in tmp_path.iterdir()] == ["a.txt"]


def test_a_failure_in_the_middle_leaves_the_old_file_and_nothing_else(tmp_path):
    (tmp_path / "a.txt").write_text("good")

    def fail(file):
        file.write(b"half")
        raise OSError(28, "No space left on device")

    with pytest.raises(
        BadInput,
        match=r"a\.txt: can't be written: No space left on device; the file there is as it was",
    ):
        write_with(tmp_path / "a.txt", fail)
    assert (tmp_path / "a.txt").read_text() == "good"
    assert [p.name for p in tmp_path.iterdir()] == ["a.txt"]


def test_an_interrupt_in_the_middle_leaves_the_old_file(tmp_path):
    def interrupt(file):
        raise KeyboardInterrupt

    (tmp_path / "a.txt").write_text("good")
    with pytest.raises(KeyboardInterrupt):
        write_with(tmp_path / "a.txt", interrupt)
    assert [p.name for p in tmp_path.iterdir()] == ["a.txt"]


def test_a_folder_that_is_not_there_is_refused_in_words(tmp_path):
    with pytest.raises(BadInput, match="can't be written: No such file or directory"):
        write_bytes(tmp_path / "none" / "a.txt", b"1")


def test_what_a_killed_writer_left_is_cleared_away(tmp_path):
    gone = 2**22 + 1  # above the largest process number of Linux
    (tmp_path / f".a.txt.{gone}.saving").write_text("half")
    (tmp_path / ".b.txt.1.saving").write_text("another file's")
    write_bytes(tmp_path / "a.txt", b"1")
    assert sorted(p.name for p in tmp_path.iterdir()) == [".b.txt.1.saving", "a.txt"]


def test_a_link_stays_a_link(tmp_path):
    (tmp_path / "real.txt").write_text("old")
    (tmp_path / "link.txt").symlink_to("real.txt")
    write_bytes(tmp_path / "link.txt", b"new")
    assert (tmp_path / "link.txt").is_symlink()
    assert (tmp_path / "real.txt").read_text() == "new"


def test_a_new_file_has_the_rights_that_the_user_gives_new_files(tmp_path):
    (tmp_path / "plain.txt").write_text("")
    write_bytes(tmp_path / "a.txt", b"1")
    rights = [stat.S_IMODE(os.stat(tmp_path / name).st_mode) for name in ("plain.txt", "a.txt")]
    assert rights[0] == rights[1]
