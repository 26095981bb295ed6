"""The process that programs one part of a batch: whatever the part does to it, no other part is hurt.

Started afresh (never forked) as `python -P -m trunnion.batch.child FOLDER`. The folder holds the request; how far the work is and what came
of it are written there. All that it starts is in its group of processes, which ends with it; it ends when its standard input does, for then
the batch is gone.
"""

from __future__ import annotations

import faulthandler
import fcntl
import json
import os
import select
import signal
import sys
import time
from collections.abc import Callable
from contextlib import ExitStack, suppress
from pathlib import Path

from trunnion.batch.outcome import part_result
from trunnion.batch.request import PartRequest
from trunnion.findings import OutOfMemory, TrunnionError
from trunnion.model.part_result import PartResult
from trunnion.progress import Progress
from trunnion.report.picture_process import PictureProcess
from trunnion.script.open_part import open_part
from trunnion.store.atomic import write_text

REQUEST, RESULT, REFUSAL, REPORT = "request.json", "result.json", "refused", "progress"
"""Files in the folder: what to do, what came of it, why it can't be done, and how far it is."""
DONE, REFUSED, NO_MEMORY = 0, 3, 4
"""Exit codes; any other one is a crash."""
PROVEN = "repair"
"""The step that a program is proven after."""
REPORT_S = 0.5
"""Seconds between two words on how far the work is."""
_KILLED_FIRST = 1000
"""The highest `oom_score_adj` (proc(5)): where the computer's memory ends, this process is ended and not the one that started it."""


def programmed(request: PartRequest, progress: Progress) -> PartResult:
    """Program a part, write its files and return its result; raises what opening, planning and writing raise."""
    with PictureProcess() as pictures, ExitStack() as running:
        engine, session = open_part(
            request.part,
            settings=request.settings,
            solid=request.solid,
            fixtures=request.fixtures,
            user_folder=Path(request.user_folder) if request.user_folder else None,
            progress=progress.part(0.0, 0.1),
            running=running,
        )
        session = engine.run(session, PROVEN, progress.part(0.1, 0.9), pictures.ahead)
        files = engine.write(
            session,
            request.files_folder,
            drawing=pictures.begin,
            progress=progress.part(0.9, 1.0),
        )
    return part_result(request.part, request.folder, session, files)


def main(folder: str) -> int:
    """Do what the folder's request says and write there what came of it; return the exit code."""
    directory = Path(folder)
    request = PartRequest.of_json((directory / REQUEST).read_text(encoding="utf-8"))
    try:
        result = programmed(request, Progress(_reporter(directory / REPORT)))
    except (OutOfMemory, MemoryError) as reason:
        write_text(directory / REFUSAL, str(reason))
        return NO_MEMORY
    except TrunnionError as reason:
        write_text(directory / REFUSAL, str(reason))
        return REFUSED
    write_text(directory / RESULT, json.dumps(result.as_dict()))
    return DONE


def _reporter(file: Path) -> Callable[[float, str], None]:
    """Return what writes how far the work is into a file, whole, and no oftener than somebody reads it."""
    begun, written = file.with_suffix(".begun"), 0.0

    def report(fraction: float, text: str) -> None:
        nonlocal written
        now = time.monotonic()
        if now - written < REPORT_S:
            return
        written = now
        begun.write_text(f"{fraction:.3f} {text}", encoding="utf-8")
        begun.replace(file)

    return report


def _end_with_batch() -> None:
    """Let the system end this process's group when the other end of its standard input is closed, however busy it is then.

    A thread that waits for that would need the interpreter's lock, which the CAD kernel holds for seconds. Linux alone sends a signal of
    one's choice to a group (fcntl(2), F_SETSIG); elsewhere what is at work ends by itself.
    """
    if not hasattr(fcntl, "F_SETSIG") or os.getpgrp() != os.getpid():
        return
    stream = sys.stdin.fileno()
    fcntl.fcntl(stream, fcntl.F_SETOWN, -os.getpgrp())
    fcntl.fcntl(stream, fcntl.F_SETSIG, signal.SIGKILL)
    fcntl.fcntl(stream, fcntl.F_SETFL, fcntl.fcntl(stream, fcntl.F_GETFL) | os.O_ASYNC)
    if select.select([stream], [], [], 0.0)[0]:
        # It was closed before: no signal comes any more.
        os.killpg(os.getpgrp(), signal.SIGKILL)


if __name__ == "__main__":
    faulthandler.enable()
    with suppress(OSError):
        Path("/proc/self/oom_score_adj").write_text(str(_KILLED_FIRST), encoding="ascii")
    _end_with_batch()
    # The CAD kernel's destructors are not waited for: they cost time and may crash after the answer is written.
    code = main(sys.argv[1])
    sys.stdout.flush()
    os._exit(code)
