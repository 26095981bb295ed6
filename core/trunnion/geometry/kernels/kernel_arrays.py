"""How kernels are compiled that only borrow the arrays they are given: without numba's counts of who holds an array.

A compiled function counts up each array that it is given and down again when it is done, in one place in memory for all threads. In small
functions that are called millions of times this took three tenths of the time (of the stock of rays, by samples of one thread). Numba
refuses to compile a function so that makes an array; views of arrays are fine as long as none is returned. `_nrt` is numba's own name for
the counts and none that it documents: another version of numba may want another one.
"""

from __future__ import annotations

from typing import Any

BORROWED: dict[str, Any] = {"cache": True, "nogil": True, "_nrt": False}
"""Options of `numba.njit` for such a kernel."""
