"""Memory that is free is given back to the system: a shop's computer has other programs, and ours has several processes.

The C library keeps what is freed in pieces below some megabytes for the next request: hundreds of megabytes after triangles were made or a
picture was drawn, for as long as the process lives.
"""

from __future__ import annotations

import ctypes
import sys
from collections.abc import Callable
from functools import cache


def trim_memory() -> None:
    """Give free memory back, where the C library can: some milliseconds."""
    trim = _trim()
    if trim is not None:
        trim(0)


@cache
def _trim() -> Callable[[int], int] | None:
    """Return glibc's `malloc_trim`; other systems' libraries have none."""
    if not sys.platform.startswith("linux"):
        return None
    found: Callable[[int], int] | None = getattr(ctypes.CDLL(None), "malloc_trim", None)
    return found
