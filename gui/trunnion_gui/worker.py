"""The process that owns the part and does all computing: frozen, numbered requests in, numbered replies out.

CAD calls hold the interpreter's lock for seconds, so they run in one spawned process (never forked). A thread sends, a thread
receives, and replies reach the window as a queued signal: the window never waits. A request is cancelled through a shared number
that its progress looks at; one that does not obey within `GRACE_S` has its process ended and a fresh one started.
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
from collections.abc import Callable
from dataclasses import dataclass, replace
from multiprocessing.connection import Connection
from typing import Any

from PySide6.QtCore import QObject, QTimer, Signal

from trunnion.findings import Cancelled, TrunnionError
from trunnion.geometry.cut import Cut
from trunnion.model.session import Session
from trunnion.progress import Progress
from trunnion.settings import Declared, declared
from trunnion_gui.drawing import Drawing, drawing_of, drawn_map
from trunnion_gui.parcel import packed, unpacked
from trunnion_gui.steps import share, until

ENGINE = "trunnion.pipeline:Engine"
GRACE_S = 2.0
_TELL_EVERY_S = 0.05
_CRASHES_IN_A_ROW = 3


@dataclass(frozen=True, slots=True)
class Request:
    """Something to do: `verb` is a name in `VERBS`."""

    number: int
    verb: str
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


@dataclass(frozen=True, slots=True)
class State:
    """A session, the state of each step, and the line of the step that refused after others were done."""

    session: Session
    steps: dict[str, str]
    refusal: str = ""


@dataclass(frozen=True, slots=True)
class Opened:
    """A session as opened, with what the window draws, and the part file's bytes and suffix for a worker that must take over."""

    state: State
    drawing: Drawing
    kept: tuple[bytes, str]


@dataclass(frozen=True, slots=True)
class Patched:
    """A session after its part's patches were changed, and what the window draws of the part then."""

    state: State
    drawing: Drawing


@dataclass(frozen=True, slots=True)
class ErrorRow:
    """How exact the feature sizes are with so many points on each edge (-1: the paper's repair): errors as shares, wall time in s."""

    on_edge: int
    points: int
    largest: float
    mean: float
    seconds: float


@dataclass(frozen=True, slots=True)
class Accuracy:
    """Size errors by the number of points, and how far in mm the boundary of a face (the worst) is from its surface."""

    rows: tuple[ErrorRow, ...]
    boundary: float
    face: int


@dataclass(frozen=True, slots=True)
class AreaRow:
    """An operation that finishes an area: mm2, mm2/s, s."""

    operation: str
    tool: str
    area: float
    rate: float
    seconds: float


@dataclass(frozen=True, slots=True)
class Estimated:
    """The time of finishing by area rates, s; that of the slowest cutter alone, and what cutters of their own gain and save, as shares.

    `is_measured`: the rates are those of toolpaths, not computed from feed and passes.
    """

    rows: tuple[AreaRow, ...]
    seconds: float
    alone: str
    seconds_alone: float
    gain: float
    saving: float
    is_measured: bool


@dataclass(frozen=True, slots=True)
class Group:
    """The declared settings of one group, as the window's forms need them (the class stays in the worker)."""

    name: str
    title: str
    settings: tuple[Declared, ...]


Tell = Callable[[str, Any], None]


def _open(engine: Any, progress: Progress, tell: Tell, path: str, solid: int | None) -> Opened:
    session = engine.open(path, solid=solid, progress=progress.part(0.0, 0.8))
    tell("progress", (0.85, "preparing the picture"))
    return Opened(State(session, engine.states(session)), drawing_of(engine.mesh(session)), engine.keep())


def _run(engine: Any, progress: Progress, tell: Tell, session: Session, last: str) -> State:
    before = engine.states(session)
    steps = [s for s in until(last) if before[s] in ("empty", "stale")] or [last]
    for step in steps:
        tell("stage", (step, None))
        try:
            session = engine.run(session, until=step, progress=_own_share(progress.part(*share(step, steps)), step))
        except TrunnionError as reason:
            if step == steps[0]:
                raise
            return State(session, engine.states(session), str(reason))
        if step != steps[-1]:
            tell("stage", (step, State(session, engine.states(session))))
    return State(session, engine.states(session))


def _own_share(progress: Progress, step: str) -> Progress:
    """Return the progress of one step whose engine counts the steps before it, done long ago, as so many equal shares."""
    done = len(until(step)) - 1

    def is_cancelled() -> bool:
        try:
            progress.check()
        except Cancelled:
            return True
        return False

    return Progress(lambda fraction, text: progress.at(fraction * (done + 1) - done, text), is_cancelled)


def _states(engine: Any, _progress: Progress, _tell: Tell, session: Session) -> State:
    return State(session, engine.states(session))


def _attach(engine: Any, progress: Progress, _tell: Tell, session: Session, data: bytes, suffix: str) -> State:
    engine.attach(session, data, suffix, progress=progress)
    return State(session, engine.states(session))


def _save(engine: Any, _progress: Progress, _tell: Tell, session: Session, path: str) -> str:
    engine.save(session, path)
    return path


def _write(engine: Any, progress: Progress, _tell: Tell, session: Session, folder: str) -> tuple[str, ...]:
    return tuple(str(name) for name in engine.write(session, folder, progress=progress))


def _playback(engine: Any, _progress: Progress, _tell: Tell, session: Session) -> Any:
    return engine.playback(session)


def _moment(engine: Any, progress: Progress, _tell: Tell, key: str, position: float, seconds: float) -> Any:
    return engine.moment(key, position, seconds, progress)


def _deviation(engine: Any, _progress: Progress, _tell: Tell, session: Session) -> Any:
    return drawn_map(engine.deviation_map(session))


def _cut(engine: Any, progress: Progress, _tell: Tell, session: Session, cut: Cut) -> Patched:
    from trunnion.pipeline.patches import with_cut

    return _patched(engine, session, with_cut(engine, session, cut, progress.part(0.0, 0.5)), progress.part(0.5, 1.0))


def _uncut(engine: Any, progress: Progress, _tell: Tell, session: Session, number: int) -> Patched:
    from trunnion.pipeline.patches import without_cut

    return _patched(engine, session, without_cut(engine, session, number, progress.part(0.0, 0.5)), progress.part(0.5, 1.0))


def _patched(engine: Any, before: Session, after: Session, progress: Progress) -> Patched:
    """Return a session whose part has other faces with its features found anew, where they had been found before."""
    if engine.states(before)["recognize"] in ("done", "problem"):
        after = engine.run(after, until="recognize", progress=progress)
    return Patched(State(after, engine.states(after)), drawing_of(engine.mesh(after)))


def _move(engine: Any, _progress: Progress, _tell: Tell, session: Session, faces: tuple[int, ...], group: str) -> State:
    from trunnion.pipeline.patches import with_moved

    after = with_moved(engine, session, faces, group)
    return State(after, engine.states(after))


def _export(engine: Any, _progress: Progress, _tell: Tell, session: Session, what: tuple[str, ...], path: str) -> int:
    from trunnion.pipeline.patches import export

    return export(engine, session, what, path)


def _accuracy(engine: Any, progress: Progress, _tell: Tell, session: Session) -> Accuracy:
    from trunnion.pipeline.patches import boundary_errors, size_errors

    rows = tuple(ErrorRow(r.on_edge, r.points, r.largest, r.mean, r.seconds) for r in size_errors(engine, session, progress=progress))
    errors = boundary_errors(engine, session)
    worst = max(errors, key=lambda tag: errors[tag])
    return Accuracy(rows, errors[worst], worst)


def _estimate(engine: Any, _progress: Progress, _tell: Tell, session: Session) -> Estimated | None:
    from trunnion.pipeline.estimating import estimate

    found = estimate(session, engine.bench_of(session))
    if found is None:
        return None
    rows = tuple(AreaRow(a.operation, a.tool, a.area, a.rate, a.seconds) for a in found.areas)
    return Estimated(rows, found.seconds, found.alone, found.seconds_alone, found.gain, found.saving, bool(session.paths))


def _settings(engine: Any, _progress: Progress, _tell: Tell) -> dict[str, tuple[Group, ...]]:
    return {step: tuple(Group(c.GROUP, _title(c), tuple(_offered(d) for d in declared(c))) for c in classes)
            for step, classes in engine.settings().items()}


def _offered(setting: Declared) -> Declared:
    """Return a setting with the catalogue's names as its choices where it names a material or a machine."""
    catalogue = _CATALOGUES.get(setting.key)
    if catalogue is None or setting.choices:
        return setting
    from trunnion.shop import load_shop

    shop = load_shop()
    known = [tool.name for tool in shop.tools] if catalogue == "tools" else sorted(getattr(shop, catalogue))
    return replace(setting, choices=tuple(dict.fromkeys((str(setting.default), *known))))


_CATALOGUES = {"blank.material": "materials", "setup.machine": "machines", "surface.cutter": "tools", "surface.local_cutter": "tools",
               "surface.rough_cutter": "tools"}
"""Settings that name a thing of a catalogue: the form offers what there is."""
VERBS: dict[str, Callable[..., Any]] = {
    "open": _open, "run": _run, "states": _states, "attach": _attach, "save": _save, "write": _write, "settings": _settings,
    "playback": _playback, "moment": _moment, "deviation": _deviation, "cut": _cut, "uncut": _uncut, "move": _move, "export": _export,
    "accuracy": _accuracy, "estimate": _estimate}


def _title(group: Any) -> str:
    words = group.GROUP.split(".")[-1].replace("_", " ")
    return str(words[:1].upper() + words[1:])


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
        try:
            if engine is None:
                module, _, name = factory.partition(":")
                engine = getattr(importlib.import_module(module), name)()
            reply = _answer(engine, request, pipe, cancelled)
        except Cancelled:
            reply = Reply(request.number, "cancelled")
        except TrunnionError as reason:
            reply = Reply(request.number, "failed", text=str(reason))
        except Exception as fault:  # noqa: BLE001 - the outermost loop
            reply = Reply(request.number, "failed", text=_fault_line(request, fault))
        try:
            pipe.send(packed(reply))
        except OSError:
            return


def _fault_line(request: Request, fault: Exception) -> str:
    import traceback

    last = traceback.extract_tb(fault.__traceback__)[-1]
    where = f"{os.path.basename(last.filename)}:{last.lineno}"
    return f"{request.verb} met a fault of the program ({type(fault).__name__} at {where}: {fault}); your session is unchanged"


def _answer(engine: Any, request: Request, pipe: Connection, cancelled: Any) -> Reply:
    told = 0.0

    def report(fraction: float, text: str) -> None:
        nonlocal told
        now = time.monotonic()
        if now - told >= _TELL_EVERY_S:
            told = now
            pipe.send(packed(Reply(request.number, "progress", text=text, fraction=fraction)))

    def tell(kind: str, value: Any) -> None:
        if kind == "progress":
            pipe.send(packed(Reply(request.number, kind, text=value[1], fraction=value[0])))
        else:
            pipe.send(packed(Reply(request.number, kind, value=value)))

    progress = Progress(report, lambda: cancelled.value >= request.number)
    progress.check()
    return Reply(request.number, "done", value=VERBS[request.verb](engine, progress, tell, *request.arguments))


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

    def ask(self, verb: str, *arguments: Any) -> int:
        """Send a request and return its number; starts the process again when it had given up."""
        if self._process is None:
            self._crashes = 0
            self._start()
            self.restarted.emit()
        self._number += 1
        request = Request(self._number, verb, arguments)
        self._awaited.append(request)
        self._outgoing.put(request)
        return self._number

    def cancel(self, number: int) -> None:
        """Ask a request to stop; end its process when it does not obey in time."""
        if self._process is None or all(r.number != number for r in self._awaited):
            return
        self._cancelled.value = max(self._cancelled.value, number)
        QTimer.singleShot(int(GRACE_S * 1000), lambda: self._insist(number))

    def forget(self, number: int) -> None:
        """Await no reply to a request any more: it is dropped when it comes."""
        self._awaited = [r for r in self._awaited if r.number != number]

    def stop(self) -> None:
        """End the process; used when the window closes."""
        self._end()
        self._awaited.clear()
        atexit.unregister(self.stop)

    def _start(self) -> None:
        context = multiprocessing.get_context("spawn")
        self._generation += 1
        self._cancelled = context.RawValue("q", 0)
        self._outgoing = queue.SimpleQueue()
        here, there = context.Pipe()
        self._pipe = here
        # Not a daemon: reading a part starts a child process of its own.
        self._process = context.Process(target=serve, args=(there, self._factory, self._cancelled), name="trunnion-worker")
        self._process.start()
        there.close()
        for target in (_send_all, _receive_all):
            threading.Thread(target=target, args=(self, self._generation, here, self._outgoing), daemon=True).start()

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
        """Start a fresh process; the request that ran is answered with `kind`, those that waited behind it are asked again."""
        waiting = [r for r in self._awaited if r.number != number]
        self._awaited = []
        self._end()
        self._start()
        self.restarted.emit()
        for request in waiting:
            self._awaited.append(request)
            self._outgoing.put(request)
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
            self._replace("crashed", "the computing process stopped unexpectedly and was started again", lost)
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


def _send_all(worker: Worker, generation: int, pipe: Connection, outgoing: queue.SimpleQueue[Request | None]) -> None:
    while (request := outgoing.get()) is not None:
        try:
            pipe.send(packed(request))
        except (OSError, ValueError):
            return


def _receive_all(worker: Worker, generation: int, pipe: Connection, outgoing: queue.SimpleQueue[Request | None]) -> None:
    while True:
        try:
            reply: Reply | None = unpacked(pipe.recv())
        except (EOFError, OSError, TypeError, ValueError):
            reply = None
        with contextlib.suppress(RuntimeError):  # the window is gone
            worker._arrived.emit(generation, reply)
        if reply is None:
            outgoing.put(None)
            return
