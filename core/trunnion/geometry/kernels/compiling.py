"""Progress while kernels are compiled: the first use of one takes seconds, and the compiler runs inside the call of the kernel.

The compiler tells listeners of every pass over a function (numba.core.event). A listener that raises ends the compilation like an error
in the kernel does: nothing half made is kept.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from threading import get_ident
from typing import Any

from numba.core import event

from trunnion.progress import Progress

TEXT = "preparing the fast routines (first use only)"
PASS = "numba:run_pass"


class _Teller(event.Listener):
    """Looks at progress before each pass of the compiler in the thread that made this."""

    def __init__(self, progress: Progress) -> None:
        self._progress, self._thread = progress, get_ident()

    def on_start(self, event: Any) -> None:
        if get_ident() == self._thread:
            self._progress.doing(TEXT)

    def on_end(self, event: Any) -> None:
        """Nothing: the next pass begins at once."""


@contextmanager
def compiling(progress: Progress) -> Iterator[None]:
    """Look at `progress` whenever a kernel is compiled in this thread meanwhile; raises what that raises."""
    with event.install_listener(PASS, _Teller(progress)):
        yield
