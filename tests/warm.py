"""Processes for tests that are not about how they start: forked off a warm one, in a tenth of the time.

Each is still a process of its own that no test shares with another. The one it is forked off has imported modules and done nothing else,
and is neither pytest nor the window, so that no thread and no lock comes with it. A system without `fork` starts them as the program does.
"""

from __future__ import annotations

import os
import signal
import sys
from importlib.metadata import entry_points
from multiprocessing.context import ForkServerContext, ForkServerProcess
from pathlib import Path
from types import SimpleNamespace
from typing import IO, Any

GROUPS = ("families", "planners", "strategies", "fixes", "dialects")
"""Groups of registered things that a computing process looks up."""
MODULES = (
    "trunnion.part.read.transfer",
    "trunnion.pipeline.engine",
    "trunnion_gui.worker.worker",
    *sorted({e.module for group in GROUPS for e in entry_points(group=f"trunnion.{group}")}),
    "trunnion.part.topology.graph",
    "trunnion.part.topology.part_box",
    "trunnion.part.shape.section",
    "trunnion.part.shape.tessellate",
    "trunnion.post.readers.iso",
    "trunnion.verify.judge.verdict",
)
"""What the warm process imports: all that reading a part and computing for a window need."""
CAN_FORK = hasattr(os, "fork")


class _WarmProcess(ForkServerProcess):
    """A process with the environment and the folder of the test that starts it, as a spawned one has."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self._environment = dict(os.environ)

    def run(self) -> None:
        os.environ.clear()
        os.environ.update(self._environment)
        super().run()


class WarmContext(ForkServerContext):
    """Stands in for multiprocessing's context "spawn"."""

    Process = _WarmProcess


WARM = WarmContext()
WARM.set_forkserver_preload(list(MODULES))


class WarmReader:
    """Stands in for `subprocess.Popen` of `python -m trunnion.part.read.child FOLDER`."""

    def __init__(
        self, command: list[str], *, stdout: IO[bytes], stdin: int | None, **_: Any
    ) -> None:
        self.stdin: IO[bytes] | None = None
        requests = Path(command[-1], "requests")
        if stdin == READERS.PIPE:
            # Processes that are forked beforehand inherit no pipes: one with a name stands in.
            os.mkfifo(requests)
            self.stdin = os.fdopen(os.open(requests, os.O_RDWR), "wb")
        self._process = WARM.Process(target=_read, args=(command[-1], stdout.name))
        self._process.start()
        self.returncode: int | None = None

    def poll(self) -> int | None:
        self.returncode = self._process.exitcode
        return self.returncode

    def kill(self) -> None:
        self._process.kill()

    def wait(self) -> None:
        self._process.join()
        self.poll()


READERS = SimpleNamespace(Popen=WarmReader, DEVNULL=None, PIPE=-1)
"""Stands in for `subprocess` where a part is read."""


def _read(folder: str, words: str) -> None:
    from trunnion.part.read.child import main

    signal.signal(signal.SIGINT, signal.SIG_DFL)
    with open(words, "ab") as file:
        for stream in (1, 2):
            os.dup2(file.fileno(), stream)
    requests = Path(folder, "requests")
    if requests.exists():
        sys.stdin = requests.open(encoding="utf-8")
    os._exit(main(folder))
