"""How kernels are compiled that only borrow the arrays they are given: without numba's counts of who holds an array.

A compiled function counts up each array that it is given and down again when it is done, in one place in memory for all threads. In a small
function that is called millions of times this took a third of the time with one thread, and more with two, which then wait for each other's
counts (measured on the stock of rays). Numba refuses to compile a function so that makes an array; views of arrays are fine as long as
none is returned.
"""

from __future__ import annotations

from typing import Any

BORROWED: dict[str, Any] = {"cache": True, "nogil": True, "_nrt": False}
"""Options of `numba.njit` for such a kernel."""
