"""Work in copies of this process: for what holds the interpreter's lock, so that threads would not make it quicker.

A copy knows all that this process knows, without a word sent; only its answer comes back. Threads are not copied: none may be at work when
a copy is made, for the locks that it held would never be released there.
"""

from __future__ import annotations

import os
import pickle
import signal
import struct
import sys
import tempfile
import time
from collections.abc import Callable
from mmap import mmap
from typing import Generic, NoReturn, TypeVar

from trunnion.progress import LOOK_S, Progress

T = TypeVar("T")
FIRST_PAUSE = 1e-3
"""Seconds between the first two looks at a copy: longer and longer ones follow, so that short work is not waited for long."""
FRACTION = struct.Struct("d")
"""How far a copy is, in the memory that it shares."""


def copies() -> int:
    """Return how many copies may be at work beside each other: one a core, none where there is but one, or a process can't be copied."""
    cores = len(os.sched_getaffinity(0)) if sys.platform == "linux" else 1
    return cores if cores > 1 else 0


class Fork(Generic[T]):
    """A piece of work in a copy of this process, begun at once. It must not change anything outside of it: nobody would see that."""

    def __init__(self, work: Callable[[Progress], T]) -> None:
        self._work, self._done = work, False
        self._shared = mmap(-1, FRACTION.size)
        # The answer is kept until it is asked for: a pipe would make the copy wait.
        self._output = tempfile.TemporaryFile()  # noqa: SIM115 - closed with the answer, or by stop
        for stream in (sys.stdout, sys.stderr):
            if stream is not None:
                stream.flush()
        parent = os.getpid()
        self.process = os.fork()
        if self.process == 0:
            self._work_in_copy(parent)

    def is_done(self) -> bool:
        """Return whether the work has ended, one way or the other."""
        if not self._done:
            self._done = os.waitpid(self.process, os.WNOHANG)[0] != 0
        return self._done

    def result(self, progress: Progress) -> T:
        """Return what the work returns, or raise what it raises, once it has ended. Where the copy was ended from outside (no memory
        left), the work is done here."""
        pause = FIRST_PAUSE
        while not self.is_done():
            progress.at(FRACTION.unpack_from(self._shared)[0])
            time.sleep(pause)
            pause = min(2.0 * pause, LOOK_S)
        self._output.seek(0)
        try:
            value, reason = pickle.load(self._output)
        except (EOFError, pickle.UnpicklingError):
            return self._work(progress)
        finally:
            self._output.close()
        if reason is not None:
            raise reason
        made: T = value
        return made

    def stop(self) -> None:
        """End the work where it stands."""
        if not self.is_done():
            os.kill(self.process, signal.SIGKILL)
            os.waitpid(self.process, 0)
            self._done = True
        self._output.close()

    def _work_in_copy(self, parent: int) -> NoReturn:
        """Do the work and leave the answer; nothing of what the process would do at its end is done here."""
        status = 1
        try:
            progress = Progress(
                lambda fraction, _: FRACTION.pack_into(self._shared, 0, fraction),
                lambda: os.getppid() != parent,
            )
            outcome: tuple[T | None, Exception | None]
            try:
                outcome = (self._work(progress), None)
            except Exception as reason:  # noqa: BLE001 - raised where the answer is asked for
                outcome = (None, reason)
            pickle.dump(outcome, self._output)
            self._output.flush()
            status = 0
        finally:
            os._exit(status)
