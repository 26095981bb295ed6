"""A part's process and its limits: started, watched, ended at a limit or on request, and its end put in words.

Its memory is that of all processes it started, shared pages counted once (the proportional set size of proc(5)).
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from trunnion.batch.child import DONE, NO_MEMORY, REFUSAL, REFUSED, REPORT, REQUEST, RESULT
from trunnion.batch.request import PartRequest
from trunnion.findings import Cancelled
from trunnion.model.part_result import (
    CRASHED,
    OUT_OF_MEMORY,
    OVER_TIME,
    PartResult,
)
from trunnion.model.part_result import (
    REFUSED as REFUSED_PART,
)
from trunnion.store.atomic import write_bytes
from trunnion.units import timed

if TYPE_CHECKING:
    import psutil

Report = Callable[[float, str], None]
"""Is told how far a part is (0 to 1) and what is done."""
LOOK_S = 0.1
"""Seconds between two looks at a process: at its memory, its time and whether it should stop."""
CRASH_FILE = "crash.txt"
"""What a process that crashed wrote last, in the part's folder."""
_LAST_WORDS = 1 << 16
"""Bytes of it that are kept."""
_MEGA = 1 << 20
COMMAND = ("-P", "-m", "trunnion.batch.child")
"""What Python runs; the folder of the request follows. -P: nothing is imported from the folder that the batch was started in."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ProcessEnd:
    """How a process ended: its exit code (negative: the signal), the limit it was ended at (`memory`, `time` or none), the most memory
    its group held at once (MB) and how long it ran (s)."""

    code: int
    limit: str
    memory: float
    seconds: float


def part_processed(
    request: PartRequest,
    report: Report,
    is_stopped: Callable[[], bool],
    command: Sequence[str] = COMMAND,
) -> PartResult:
    """Program a part in a process of its own, within the request's limits, and return its result, whatever became of the process.

    Raises `Cancelled` once `is_stopped` says so; the process is gone then.
    """
    with tempfile.TemporaryDirectory(prefix="trunnion-batch-") as name:
        directory = Path(name)
        (directory / REQUEST).write_text(request.to_json(), encoding="utf-8")
        words = directory / "words"
        end = _watched(
            [sys.executable, *command, name],
            Path(request.start),
            words,
            request,
            report,
            is_stopped,
        )
        result = _result(request, end, directory)
        if result.verdict == CRASHED:
            last = words.read_bytes()[-_LAST_WORDS:]
            request.files_folder.mkdir(parents=True, exist_ok=True)
            write_bytes(request.files_folder / CRASH_FILE, last)
            result = replace(result, files=(CRASH_FILE,))
    return replace(
        result,
        seconds=round(end.seconds, 1),
        memory=round(end.memory),
        memory_limit=request.memory,
        time_limit=request.seconds,
    )


def _watched(
    command: Sequence[str],
    start: Path,
    words: Path,
    request: PartRequest,
    report: Report,
    is_stopped: Callable[[], bool],
) -> ProcessEnd:
    """Run a command in a group of processes of its own until it ends or is to be ended; nothing of the group is left then."""
    began, limit, progress = time.monotonic(), "", words.with_name(REPORT)
    with words.open("wb") as stream:
        child = subprocess.Popen(
            command,
            cwd=start,
            stdin=subprocess.PIPE,
            stdout=stream,
            stderr=stream,
            start_new_session=True,
            env=os.environ | {"PYTHONIOENCODING": "utf-8"},
        )
    memory = _GroupMemory(child.pid)
    try:
        while not _has_ended(child.pid):
            if is_stopped():
                raise Cancelled
            held = memory.held()
            if request.memory and held > request.memory:
                limit = "memory"
            elif request.seconds and time.monotonic() - began > request.seconds:
                limit = "time"
            if limit:
                break
            with suppress(OSError, ValueError):
                fraction, _, text = progress.read_text(encoding="utf-8").partition(" ")
                report(float(fraction), text)
            time.sleep(LOOK_S)
    finally:
        _end(child)
    return ProcessEnd(
        code=child.returncode,
        limit=limit,
        memory=memory.most,
        seconds=time.monotonic() - began,
    )


def _has_ended(process: int) -> bool:
    """Return whether a child has ended; its number stays its own until it is waited for, so that its group can be ended by it."""
    return os.waitid(os.P_PID, process, os.WEXITED | os.WNOHANG | os.WNOWAIT) is not None


def _end(child: subprocess.Popen[bytes]) -> None:
    """End a process and its group: also what it left behind when it ended by itself."""
    with suppress(ProcessLookupError):
        os.killpg(child.pid, signal.SIGKILL)
    child.wait()
    assert child.stdin is not None
    child.stdin.close()


class _GroupMemory:
    """The memory of a process and all that it started, and the most that it has been, MB."""

    def __init__(self, process: int) -> None:
        import psutil

        self._psutil = psutil
        self._process: psutil.Process | None = None
        with suppress(psutil.Error):
            self._process = psutil.Process(process)
        self.most = 0.0

    def held(self) -> float:
        """Return the memory held now. Pages that processes share are told apart only where it may be more than ever: that costs time."""
        if self._process is None:
            return 0.0
        with suppress(self._psutil.Error):
            group = [self._process, *self._process.children(recursive=True)]
            held = sum(map(self._resident, group)) / _MEGA
            if held > self.most:
                held = sum(map(self._proportional, group)) / _MEGA
                self.most = max(self.most, held)
            return held
        return 0.0

    def _resident(self, process: psutil.Process) -> int:
        with suppress(self._psutil.Error):
            return int(process.memory_info().rss)
        return 0

    def _proportional(self, process: psutil.Process) -> int:
        with suppress(self._psutil.Error):
            full = process.memory_full_info()
            # Systems other than Linux don't know the proportional size.
            return int(getattr(full, "pss", full.uss))
        return 0


def _result(request: PartRequest, end: ProcessEnd, directory: Path) -> PartResult:
    """Return what came of a part, from how its process ended and what it wrote."""

    def without(verdict: str, note: str) -> PartResult:
        return PartResult(part=request.part, folder=request.folder, verdict=verdict, note=note)

    if end.limit == "memory":
        return without(
            OUT_OF_MEMORY, f"needs more than {request.memory:.0f} MB of memory; raise --memory"
        )
    if end.limit == "time":
        return without(OVER_TIME, f"takes longer than {timed(request.seconds)}; raise --time-limit")
    if end.code == DONE and (directory / RESULT).is_file():
        return PartResult.of_dict(json.loads((directory / RESULT).read_text(encoding="utf-8")))
    refusal = directory / REFUSAL
    reason = refusal.read_text(encoding="utf-8") if refusal.is_file() else ""
    if end.code == REFUSED and reason:
        return without(REFUSED_PART, reason)
    if end.code == NO_MEMORY:
        return without(OUT_OF_MEMORY, reason or "no memory left on the computer")
    last = (directory / "words").read_bytes()[-_LAST_WORDS:].decode("utf-8", "replace")
    return without(CRASHED, _crash_words(end.code, last))


def _crash_words(code: int, last: str) -> str:
    """Return in a line how a process crashed: by a signal, or by an error that nobody expected, whose line it wrote last."""
    if code < 0:
        name = signal.Signals(-code).name
        likely = ", as the system does where memory ends" if -code == signal.SIGKILL else ""
        return f"its process was ended by {name}{likely}; {CRASH_FILE} has its last words"
    lines = [line.strip() for line in last.splitlines() if line.strip()]
    return f"its process ended with code {code}: {lines[-1] if lines else 'it wrote nothing'}"
