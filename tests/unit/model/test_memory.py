"""Free memory is given back to the system."""

import os
from pathlib import Path

import pytest

from trunnion.memory import _trim, trim_memory

PIECE = 50_000
"""Bytes: below what the C library takes from the system piece by piece."""


def resident() -> int:
    """Return the bytes of memory that this process has of the system."""
    pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE")


@pytest.mark.skipif(_trim() is None, reason="this C library can't give memory back")
def test_what_is_freed_below_something_that_stays_is_given_back() -> None:
    pieces = [bytes(PIECE) for _ in range(2000)]
    held = resident()
    last = pieces[-1]
    del pieces
    trim_memory()
    assert held - resident() > 0.8 * 2000 * PIECE
    assert len(last) == PIECE


def test_a_system_that_can_not_is_left_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("trunnion.memory.sys.platform", "win32")
    _trim.cache_clear()
    trim_memory()
    assert _trim() is None
    _trim.cache_clear()
