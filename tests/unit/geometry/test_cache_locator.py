"""Compiled kernels of an installed program are found again, wherever its files are mounted."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from numba import config

from trunnion.geometry.kernels import edge_numbers
from trunnion.geometry.kernels.cache_locator import ModuleCacheLocator
from trunnion.geometry.kernels.signatures import Signature

LOCATOR = f"{ModuleCacheLocator.__module__}.{ModuleCacheLocator.__qualname__}"
NUMBERS = "edge_numbers"
COMPILED = """
import sys
from trunnion.geometry.kernels.signatures import signatures_of
package = "trunnion.geometry.kernels"
first = next(s for s in signatures_of(package) if s.module == f"{package}.edge_numbers")
first.compile()
stats = first.kernel.stats
print(stats.cache_path, sum(stats.cache_hits.values()), sum(stats.cache_misses.values()))
"""


def kernel_function():
    """Give a plain function of a module of kernels, as numba hands it to a locator."""
    signature = Signature("trunnion.geometry.kernels", first_line(NUMBERS))
    return signature.kernel.py_func


def first_line(module: str) -> str:
    """Return the first line of the list of signatures about a module."""
    text = (Path(edge_numbers.__file__).parent / "signatures.txt").read_text()
    return next(line for line in text.splitlines() if line.startswith(f"{module}."))


def test_the_folder_is_the_modules_wherever_its_source_lies(tmp_path, monkeypatch):
    monkeypatch.setattr(config, "CACHE_DIR", str(tmp_path / "loops"))
    folders = set()
    for mounted in ("first", "second"):
        source = tmp_path / mounted / "edge_numbers.py"
        source.parent.mkdir()
        source.write_text("")
        locator = ModuleCacheLocator.from_function(kernel_function(), str(source))
        assert locator is not None
        folders.add(locator.get_cache_path())
    assert folders == {str(tmp_path / "loops" / "trunnion.geometry.kernels.edge_numbers")}


def test_other_packages_kernels_are_left_to_numba(tmp_path, monkeypatch):
    monkeypatch.setattr(config, "CACHE_DIR", str(tmp_path))
    assert ModuleCacheLocator.from_function(subprocess.run, subprocess.__file__) is None


@pytest.mark.parametrize("folder", ["", "a-file/loops"])
def test_without_a_folder_that_can_be_written_numba_is_asked_for_another(
    folder, tmp_path, monkeypatch
):
    (tmp_path / "a-file").write_text("")
    monkeypatch.setattr(config, "CACHE_DIR", folder and str(tmp_path / folder))
    assert ModuleCacheLocator.from_function(kernel_function(), edge_numbers.__file__) is None


def test_what_one_process_compiled_the_next_one_loads(tmp_path):
    named = {"NUMBA_CACHE_DIR": str(tmp_path), "NUMBA_CACHE_LOCATOR_CLASSES": LOCATOR}
    found = [
        subprocess.run(
            [sys.executable, "-P", "-c", COMPILED],
            env=os.environ | named,
            capture_output=True,
            text=True,
            check=True,
        ).stdout.split()
        for _ in range(2)
    ]
    folder = str(tmp_path / "trunnion.geometry.kernels.edge_numbers")
    assert found == [[folder, "0", "1"], [folder, "1", "0"]]
