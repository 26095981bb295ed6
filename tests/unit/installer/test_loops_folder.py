"""An installed program keeps compiled loops in the user's cache, begun with those that the installation compiled."""

from __future__ import annotations

import subprocess
from importlib import import_module

import pytest

from installer import files

BUILD = "0.1.0-abc"
PRINTED = '. ./loops.sh\nprintf "%s\\n%s\\n" "$NUMBA_CACHE_DIR" "$NUMBA_CACHE_LOCATOR_CLASSES"\n'


@pytest.fixture
def start(tmp_path):
    """Give a function that runs what a command does before it starts Python, and returns what became of it."""
    text = files.filled(files.HERE / "loops.sh.in", {"BUILD": BUILD})
    (tmp_path / "loops.sh").write_text(text)

    def run(environment, compiled=""):
        return subprocess.run(
            ["sh", "-euc", f"compiled={compiled}\n{PRINTED}"],
            cwd=tmp_path,
            env={"PATH": "/usr/bin:/bin", **environment},
            capture_output=True,
            text=True,
            check=False,
        )

    return run


def test_the_first_start_copies_what_was_compiled_and_the_second_leaves_it(start, tmp_path):
    compiled = tmp_path / "compiled"
    (compiled / "trunnion.a").mkdir(parents=True)
    (compiled / "trunnion.a" / "loop.nbi").write_text("installed")
    folder = tmp_path / "home" / ".cache" / "trunnion" / f"loops-{BUILD}"
    for content in ("installed", "the user's"):
        said = start({"HOME": str(tmp_path / "home")}, compiled)
        assert said.stdout.splitlines()[0] == str(folder), said.stderr
        copy = folder / "trunnion.a" / "loop.nbi"
        assert copy.read_text() == content
        copy.write_text("the user's")
    assert [p.name for p in folder.parent.iterdir()] == [folder.name]


def test_without_compiled_loops_the_folder_is_made_empty(start, tmp_path):
    said = start({"XDG_CACHE_HOME": str(tmp_path / "cache")}, tmp_path / "nothing")
    folder = tmp_path / "cache" / "trunnion" / f"loops-{BUILD}"
    assert said.stdout.splitlines()[0] == str(folder) and list(folder.iterdir()) == []


def test_a_folder_that_the_user_names_is_taken_as_it_is(start, tmp_path):
    said = start({"HOME": str(tmp_path), "NUMBA_CACHE_DIR": "/somewhere"})
    assert said.stdout.splitlines()[0] == "/somewhere"
    assert not (tmp_path / ".cache").exists()


@pytest.mark.parametrize("environment", [{}, {"HOME": "FILE"}])
def test_where_no_folder_can_be_made_one_line_says_so(environment, start, tmp_path):
    (tmp_path / "FILE").write_text("")
    given = {name: str(tmp_path / value) for name, value in environment.items()}
    said = start(given | ({} if given else {"XDG_CACHE_HOME": "/proc/nobody"}))
    assert said.returncode == 2 and len(said.stderr.splitlines()) == 1
    assert "XDG_CACHE_HOME" in said.stderr


def test_the_locators_that_it_names_are_there(start, tmp_path):
    own, *others = start({"HOME": str(tmp_path)}).stdout.splitlines()[1].split(",")
    module, _, name = own.rpartition(".")
    assert hasattr(import_module(module), name)
    assert all(hasattr(import_module("numba.core.caching"), other) for other in others)
