"""The process that owns the part and does all computing: frozen, numbered requests in, numbered replies out.

CAD calls hold the interpreter's lock for seconds, so they run in one spawned process (never forked). A thread sends, a thread
receives, and replies reach the window as a queued signal: the window never waits. A request is cancelled through a shared number
that its progress looks at; one that does not obey within `GRACE_S` (`WRITING_GRACE_S` while it writes files) has its process ended and a
fresh one started.
"""

from __future__ import annotations

import atexit
import contextlib
import importlib
import multiprocessing
import os
import queue
import signal
import threading
import time
from dataclasses import dataclass
from multiprocessing.connection import Connection
from typing import Any

from PySide6.QtCore import QObject, QTimer, Signal

from trunnion.findings import Cancelled, TrunnionError
from trunnion.progress import Progress
from trunnion_gui.worker.requests import Work, is_writing, work_of
from trunnion_gui.worker.session_changes import SharedSession, session_of
from trunnion_gui.worker.shared_memory import packed, unpacked

ENGINE = "trunnion.pipeline:Engine"
GRACE_S = 0.35
"""s: a person who cancels waits for half a second at most, the end of a process that hears nothing and the start of another included."""
WRITING_GRACE_S = 5.0
"""s: half a folder of programs is worse than a late answer."""
_SEND_EVERY_S, _SEND_NEWS_S = 0.05, 0.01
"""s between two reports of progress at least: the same words, and other ones, which must not be missing when the work then stands still."""
_CRASHES_IN_A_ROW = 3


@dataclass(frozen=True, slots=True)
class Request:
    """Something to do: `command` is a name in `VERBS`, or a function like these."""

    number: int
    command: str | Work
    arguments: tuple[Any, ...] = ()


@dataclass(frozen=True, slots=True)
class Reply:
    """What came of a request: `kind` is progress, stage (a step of a run is done), done, failed, cancelled or crashed.

    `value` is what the verb returns (of done and stage); `text` the line of a failure or of progress; `fraction` of progress.
    """

    number: int
    kind: str
    value: Any = None
    text: str = ""
    fraction: float = 0.0

    @property
    def is_last(self) -> bool:
        """Whether nothing comes after this reply."""
        return self.kind not in ("progress", "stage")


def serve(pipe: Connection, factory: str, cancelled: Any) -> None:
    """Answer requests until the window closes the pipe. The worker's outermost loop: a fault costs one request, never the process."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if hasattr(os, "setsid"):
        os.setsid()
    engine: Any = None
    while True:
        try:
            request = unpacked(pipe.recv())
        except (EOFError, OSError):
            return
        known = SharedSession(session_of(request.arguments))
        try:
            if engine is None:
                module, _, name = factory.partition(":")
                engine = getattr(importlib.import_module(module), name)()
            reply = _reply_to(engine, request, pipe, cancelled, known)
        except Cancelled:
            reply = Reply(request.number, "cancelled")
        except TrunnionError as reason:
            reply = Reply(request.number, "failed", text=str(reason))
        except Exception as fault:  # noqa: BLE001 - the outermost loop
            reply = Reply(request.number, "failed", text=_fault_line(request, fault))
        try:
            pipe.send(packed(reply, known, request.number))
        except OSError:
            return


def _fault_line(request: Request, fault: Exception) -> str:
    import traceback

    last = traceback.extract_tb(fault.__traceback__)[-1]
    where = f"{os.path.basename(last.filename)}:{last.lineno}"
    what = request.command if isinstance(request.command, str) else request.command.__name__
    return f"{what} met a fault of the program ({type(fault).__name__} at {where}: {fault})"


def _reply_to(
    engine: Any, request: Request, pipe: Connection, cancelled: Any, known: SharedSession
) -> Reply:
    sent_at, words = 0.0, ""

    def send(reply: Reply) -> None:
        pipe.send(packed(reply, known, request.number))

    def report(fraction: float, text: str) -> None:
        nonlocal sent_at, words
        now = time.monotonic()
        if now - sent_at >= (_SEND_EVERY_S if text == words else _SEND_NEWS_S):
            sent_at, words = now, text
            send(Reply(request.number, "progress", text=text, fraction=fraction))

    def send_event(kind: str, value: Any) -> None:
        if kind == "progress":
            send(Reply(request.number, kind, text=value[1], fraction=value[0]))
        else:
            send(Reply(request.number, kind, value=value))

    progress = Progress(report, lambda: cancelled.value >= request.number)
    progress.check()
    return Reply(
        request.number,
        "done",
        value=work_of(request.command)(engine, progress, send_event, *request.arguments),
    )


class Worker(QObject):
    """The window's end of the worker process. Everything here runs in the window's thread, except the two couriers."""

    replied = Signal(object)
    """A `Reply` to a request that is still awaited; late ones are dropped."""
    restarted = Signal()
    """A fresh process runs and has not read the part yet."""
    _arrived = Signal(int, object)

    def __init__(self, factory: str = ENGINE, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._factory = factory
        self._number = 0
        self._generation = 0
        self._awaited: list[Request] = []
        self._known: dict[int, SharedSession] = {}
        self._crashes = 0
        self._process: Any = None
        self._pipe: Connection | None = None
        self._outgoing: queue.SimpleQueue[Request | None] = queue.SimpleQueue()
        self._arrived.connect(self._receive)
        self._start()
        atexit.register(self.stop)

    @property
    def is_alive(self) -> bool:
        """Whether the process runs."""
        return self._process is not None and self._process.is_alive()

    @property
    def pid(self) -> int:
        """The id of the process, 0 when none runs."""
        return self._process.pid if self._process is not None else 0

    def send(self, command: str | Work, *arguments: Any) -> int:
        """Send a request and return its number; starts the process again when it had given up."""
        if self._process is None:
            self._crashes = 0
            self._start()
            self.restarted.emit()
        self._number += 1
        self._put(Request(self._number, command, arguments))
        return self._number

    def cancel(self, number: int) -> None:
        """Request that a job stops; end its process when it does not obey in time."""
        request = next((r for r in self._awaited if r.number == number), None)
        if self._process is None or request is None:
            return
        self._cancelled.value = max(self._cancelled.value, number)
        grace = WRITING_GRACE_S if is_writing(request.command) else GRACE_S
        QTimer.singleShot(int(grace * 1000), self, lambda: self._insist(number))

    def forget(self, number: int) -> None:
        """Await no reply to a request any more: it is dropped when it comes."""
        self._awaited = [r for r in self._awaited if r.number != number]

    def stop(self) -> None:
        """End the process; used when the window closes."""
        self._end()
        self._awaited.clear()
        atexit.unregister(self.stop)

    def _put(self, request: Request) -> None:
        self._awaited.append(request)
        self._known[request.number] = SharedSession(session_of(request.arguments))
        self._outgoing.put(request)

    def _start(self) -> None:
        context = multiprocessing.get_context("spawn")
        self._generation += 1
        self._cancelled = context.RawValue("q", 0)
        self._outgoing, self._known = queue.SimpleQueue(), {}
        here, there = context.Pipe()
        self._pipe = here
        # Not a daemon: reading a part starts a child process of its own.
        self._process = context.Process(
            target=serve, args=(there, self._factory, self._cancelled), name="trunnion-worker"
        )
        self._process.start()
        there.close()
        sending = (here, self._outgoing)
        receiving = (self, self._generation, here, self._outgoing, self._known)
        for target, arguments in ((_send_all, sending), (_receive_all, receiving)):
            threading.Thread(target=target, args=arguments, daemon=True).start()

    def _end(self) -> None:
        if self._process is None:
            return
        self._generation += 1
        self._outgoing.put(None)
        process, self._process = self._process, None
        if process.is_alive():
            _kill(process)
        process.join(5.0)
        if self._pipe is not None:
            self._pipe.close()

    def _insist(self, number: int) -> None:
        if any(r.number == number for r in self._awaited):
            self._replace("cancelled", "", number)

    def _replace(self, kind: str, text: str, number: int) -> None:
        """Start a fresh process; the request that ran gets the reply `kind`, those that waited behind it are sent again."""
        waiting = [r for r in self._awaited if r.number != number]
        self._awaited = []
        self._end()
        self._start()
        self.restarted.emit()
        for request in waiting:
            self._put(request)
        self.replied.emit(Reply(number, kind, text=text))

    def _receive(self, generation: int, reply: Reply | None) -> None:
        if generation != self._generation:
            return
        if reply is None:
            self._mourn()
            return
        if all(r.number != reply.number for r in self._awaited):
            return
        if reply.is_last:
            self._crashes = 0
            self.forget(reply.number)
        self.replied.emit(reply)

    def _mourn(self) -> None:
        """The process died by itself: the request it was working on (the first awaited) is lost, nothing else."""
        self._crashes += 1
        lost = self._awaited[0].number if self._awaited else 0
        if self._crashes <= _CRASHES_IN_A_ROW:
            self._replace(
                "crashed", "the computing process stopped unexpectedly and was started again", lost
            )
            return
        self._end()
        waiting, self._awaited = self._awaited, []
        text = "the computing process keeps stopping; it starts again with your next job"
        for request in waiting or [Request(0, "")]:
            self.replied.emit(Reply(request.number, "crashed", text=text))


def _kill(process: Any) -> None:
    """End a process with the children it may have started to read a part."""
    with contextlib.suppress(ProcessLookupError, PermissionError):
        if hasattr(os, "killpg") and os.getpgid(process.pid) == process.pid:
            os.killpg(process.pid, signal.SIGKILL)
    process.kill()


def _send_all(pipe: Connection, outgoing: queue.SimpleQueue[Request | None]) -> None:
    while (request := outgoing.get()) is not None:
        try:
            pipe.send(packed(request))
        except (OSError, ValueError):
            return


def _receive_all(
    worker: Worker,
    generation: int,
    pipe: Connection,
    outgoing: queue.SimpleQueue[Request | None],
    known: dict[int, SharedSession],
) -> None:
    while True:
        try:
            message = pipe.recv()
            reply: Reply | None = unpacked(message, known.get(message.number))
        except (EOFError, OSError, TypeError, ValueError):
            reply = None
        if reply is not None and reply.is_last:
            known.pop(reply.number, None)
        with contextlib.suppress(RuntimeError):  # the window is gone
            worker._arrived.emit(generation, reply)
        if reply is None:
            outgoing.put(None)
            return
