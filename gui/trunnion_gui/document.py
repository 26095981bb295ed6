"""What the window is about: the session with its history, what is selected, and the job that runs. Views read it and repaint.

A slot builds an edit and hands it over (`edit`), or asks for a job (`open`, `run`, `save`, `write`); the worker computes and the
signals tell. While a run goes on, `shown` holds what is done so far; `session` stays as it was until the run ends. Steps that a run
finished before it was cancelled, refused or crashed are kept, as one entry of the history.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from PySide6.QtCore import QObject, Signal

from trunnion.findings import Finding, Severity, TrunnionError
from trunnion.geometry.cut import Cut
from trunnion.geometry.mesh import Mesh
from trunnion.model.feature import Feature
from trunnion.model.operation import Operation
from trunnion.model.session import Session
from trunnion.settings import Value
from trunnion_gui import edits
from trunnion_gui.drawing import Drawing
from trunnion_gui.edits import Edit, History
from trunnion_gui.i18n import tr
from trunnion_gui.steps import STEPS, TITLES, until
from trunnion_gui.verbs import Group, Opened, State, Work
from trunnion_gui.worker import ENGINE, Reply, Worker


@dataclass(frozen=True, slots=True)
class Selection:
    """What is selected: `kind` is feature, operation, faces, or empty; `id` the feature's or operation's; `faces` their tags."""

    kind: str = ""
    id: str = ""
    faces: tuple[int, ...] = ()


Finish = Callable[[Any], None]


@dataclass(frozen=True, slots=True)
class Job:
    """A piece of work that runs: its request number, verb, label and when it started."""

    number: int
    verb: str | Work
    label: str
    started: float
    path: str = ""
    is_recovery: bool = False
    project: str = ""
    """The project file that recovered work belongs to."""
    finish: Finish | None = None
    """What a family does with the answer to a request of its own."""


NOTHING = Selection()
PROJECT = ".trunnion"


class Document(QObject):
    """The open part's session and everything that happens to it."""

    changed = Signal()
    """The shown session is another one, or its states are."""
    mesh_changed = Signal()
    """Another part is there."""
    redrawn = Signal()
    """The part is the same, its faces are others: one was cut, or a cut was taken back."""
    selected = Signal(object)
    job_changed = Signal()
    progressed = Signal(float, str)
    noticed = Signal(object)
    """A `Finding` about the program itself: a failure, a crash, a refusal."""
    opened = Signal(str)
    saved = Signal(str)
    said = Signal(str)
    """Words on what came of a job."""
    written = Signal(object)
    """The folder and the names of the files written there."""

    def __init__(self, factory: str = ENGINE, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.history = History(Session())
        self.shown = self.history.session
        self.states: dict[str, str] = {}
        self.groups: Mapping[str, tuple[Group, ...]] = {}
        self.drawing: Drawing | None = None
        self._drawings: dict[tuple[Cut, ...], Drawing] = {}
        self.path = ""
        self.project = ""
        self.selection = NOTHING
        self.job: Job | None = None
        self.running_step = ""
        self._doing = ""
        self._quiet: dict[int, str] = {}
        self._then = ""
        self._settled: dict[str, str] = {}
        self.kept = (b"", "")
        """The part file's bytes and suffix, as they go into a project file."""
        self.holds_work: Callable[[Callable[[], None]], bool] = lambda go_on: False
        """Asked before another part is opened: whether unsaved work stands in the way. It then calls what it is given later, or never."""
        self.worker = Worker(factory, self)
        self.worker.replied.connect(self._receive)
        self.worker.restarted.connect(self._attach)
        self._ask_quietly("settings")

    @property
    def session(self) -> Session:
        """The session as the history has it."""
        return self.history.session

    @property
    def mesh(self) -> Mesh | None:
        """The part's triangles."""
        return self.drawing.mesh if self.drawing is not None else None

    @property
    def is_busy(self) -> bool:
        """Whether a job runs."""
        return self.job is not None

    @property
    def has_part(self) -> bool:
        """Whether a part is open."""
        return self.session.part is not None

    @property
    def name(self) -> str:
        """The file's name that a person knows the work by: the project's, or the part's while there is none."""
        return Path(self.project or self.path).name

    @property
    def has_unsaved_work(self) -> bool:
        """Whether anything would be lost: an edit, a run, or the steps that a run has finished so far."""
        return self.has_part and (self.history.is_dirty or self.shown is not self.session)

    # jobs

    def open(self, path: str | Path, solid: int | None = None) -> None:
        """Open a part or a project file, after a person was asked about unsaved work."""
        self._open(tr("opening {name}").format(name=Path(path).name), str(path), solid)

    def recover(self, path: str | Path, project: str) -> None:
        """Take up work from an autosave; it belongs to a project file (empty: none yet) and still has to be saved there."""
        self._open(tr("recovering {name}").format(name=Path(project or path).name), str(path), None, is_recovery=True, project=project)

    def _open(self, label: str, path: str, solid: int | None, *, is_recovery: bool = False, project: str = "") -> None:
        def go_on() -> None:
            if self._is_free():
                self._start("open", label, path, solid, path=path, is_recovery=is_recovery, project=project)

        if self._is_free() and not self.holds_work(go_on):
            go_on()

    def run(self, last: str, label: str) -> None:
        """Compute what is stale up to and including a step. Asked while a file is being opened, it runs right after."""
        if self.job is not None and self.job.verb == "open":
            self._then = last
            return
        if not (self._is_free() and self._needs_part()):
            return
        if self._is_done(last):
            self.notice(tr("{job}: everything is up to date").format(job=label), severity=Severity.INFO)
            return
        self._start("run", label, self.session, last)

    def program(self) -> None:
        """Do the whole line."""
        self.run("verify", tr("Program"))

    def save(self, path: str | Path) -> None:
        """Write the project file."""
        if self._is_free() and self._needs_part():
            self._start("save", tr("saving {name}").format(name=Path(path).name), self.session, str(path), path=str(path))

    def write(self, folder: str | Path) -> None:
        """Write programs, tool list, XML and report into a folder."""
        if self._is_free() and self._needs_part():
            self._start("write", tr("writing files"), self.session, str(folder), path=str(folder))

    def request(self, work: Work, label: str, *arguments: Any, finish: Finish) -> None:
        """Do a family's own work on the session in the worker; `finish` gets what it returns. Refused in words while a job runs."""
        if self._is_free() and self._needs_part():
            self._start(work, label, self.session, *arguments, finish=finish)

    def keep(self, label: str, state: State, drawing: Drawing | None = None) -> None:
        """Take a session into the history, with what is drawn of its part where its faces are others."""
        if drawing is not None:
            self._drawings[state.session.cuts] = drawing
        self.history.push(label, state.session)
        self._show(state.session, state.steps)

    def cancel(self) -> None:
        """Ask the running job to stop."""
        if self.job is not None:
            self._then = ""
            self.worker.cancel(self.job.number)
            self.progressed.emit(-1.0, tr("cancelling"))

    # edits

    def edit(self, label: str, edit: Edit, gesture: str = "") -> None:
        """Do an undoable edit; a refusal, or a job that runs, is told in a message."""
        if self.is_busy:
            self.notice(tr("{label}: not while {job} runs").format(label=label, job=self.job.label if self.job else ""),
                        tr("cancel the running job, or wait until it is done"), severity=Severity.WARNING)
            self.changed.emit()
            return
        try:
            session = edit(self.session)
        except TrunnionError as reason:
            self.notice(str(reason), severity=Severity.WARNING)
            return
        if session is not self.session:
            self.history.push(label, session, gesture)
            self._show(session)
            self._ask_states()

    def choose(self, key: str, label: str, value: Value, gesture: str = "") -> None:
        """Choose a setting by its full key."""
        self.edit(label, edits.with_choice(key, value), gesture)

    def undo(self) -> None:
        """Take the last edit or run back."""
        if self._is_free():
            self._show(self.history.undo())
            self._ask_states()

    def redo(self) -> None:
        """Bring back what was undone."""
        if self._is_free():
            self._show(self.history.redo())
            self._ask_states()

    # selection

    def select(self, selection: Selection) -> None:
        """Make something the selection of every view."""
        if selection != self.selection:
            self.selection = selection
            self.selected.emit(selection)

    def select_feature(self, id: str) -> None:
        """Select a feature with its faces."""
        found = self.feature(id)
        self.select(Selection("feature", id, found.tags) if found else NOTHING)

    def select_operation(self, id: str) -> None:
        """Select an operation with the faces of its feature."""
        found = self.operation(id)
        feature = self.feature(found.feature) if found else None
        faces = found.faces or (feature.tags if feature else ()) if found else ()
        self.select(Selection("operation", id, faces) if found else NOTHING)

    def select_face(self, tag: int) -> None:
        """Select the feature a face belongs to, the smallest when there are several; the face itself when there is none."""
        owners = [f for f in (self.shown.recognition or ()) if tag in f.tags]
        if owners:
            self.select_feature(min(owners, key=lambda f: len(f.tags)).id)
        else:
            self.select(Selection("faces", f"face {tag}", (tag,)) if tag else NOTHING)

    def select_ids(self, words: Sequence[str]) -> bool:
        """Select features and faces by their ids (`group-05`, `face 12`, `12`), all together; say whether there was any."""
        features = [f for f in (self.shown.recognition or ()) if f.id in words]
        known = set(np.unique(self.mesh.face).tolist()) if self.mesh is not None else set()
        given = [w.removeprefix("face").strip() for w in words]
        faces = [int(w) for w in given if w.isdigit() and int(w) in known]
        if len(features) == 1 and not faces:
            self.select_feature(features[0].id)
        elif features or faces:
            names = [f.id for f in features] + [f"face {t}" for t in faces]
            tags = dict.fromkeys([t for f in features for t in f.tags] + faces)
            self.select(Selection("faces", ", ".join(names), tuple(tags)))
        return bool(features or faces)

    def select_face_alone(self, tag: int) -> None:
        """Select one face, whatever it belongs to."""
        self.select(Selection("faces", f"face {tag}", (tag,)) if tag else NOTHING)

    def toggle_face(self, tag: int) -> None:
        """Take one more face into the selection, or out of it again."""
        if tag:
            chosen = self.selection.faces if self.selection.kind in ("faces", "feature") else ()
            faces = tuple(t for t in chosen if t != tag) if tag in chosen else (*chosen, tag)
            self.select(Selection("faces", ", ".join(f"face {t}" for t in faces), faces) if faces else NOTHING)

    def select_where(self, words: tuple[str, ...]) -> None:
        """Select what the words of a finding name."""
        for word in words:
            if self.feature(word):
                self.select_feature(word)
                return
            if self.operation(word):
                self.select_operation(word)
                return
        tags = tuple(int(w[5:]) for w in words if w.startswith("face ") and w[5:].isdigit())
        if tags:
            self.select(Selection("faces", ", ".join(f"face {t}" for t in tags), tags))

    def feature(self, id: str) -> Feature | None:
        """Return the shown feature with an id, if there is one."""
        return next((f for f in (self.shown.recognition or ()) if f.id == id), None)

    def operation(self, id: str) -> Operation | None:
        """Return the shown operation with an id, if there is one."""
        process = self.shown.process
        return next((o for o in (process.operations if process else ()) if o.id == id), None)

    def notice(self, text: str, remedy: str = "", severity: Severity = Severity.ERROR) -> None:
        """Tell the person something about the program itself."""
        self.noticed.emit(Finding(severity=severity, code="window", text=text, remedy=remedy))

    def close(self) -> None:
        """End the worker."""
        self.worker.stop()

    # inside

    def _is_free(self) -> bool:
        if self.job is not None:
            self.notice(tr("{job} still runs").format(job=self.job.label), tr("cancel it first, or wait until it is done"),
                        severity=Severity.WARNING)
        return self.job is None

    def _needs_part(self) -> bool:
        if not self.has_part:
            self.notice(tr("There is no part yet"), tr("open a STEP or IGES file first (Ctrl+O), or drop one on the window"),
                        severity=Severity.WARNING)
        return self.has_part

    def _is_done(self, last: str) -> bool:
        """Whether nothing is stale up to a step; while the states of a fresh edit are still asked for, nobody knows."""
        return "states" not in self._quiet.values() and all(self.states.get(s) in ("done", "problem") for s in until(last))

    def _start(self, verb: str | Work, label: str, *arguments: Any, path: str = "", is_recovery: bool = False,
               project: str = "", finish: Finish | None = None) -> None:
        self._settled, self._doing = self.states, ""
        self.job = Job(self.worker.ask(verb, *arguments), verb, label, time.monotonic(), path, is_recovery, project, finish)
        self.job_changed.emit()
        self.progressed.emit(0.0, label)

    def _ask_quietly(self, verb: str, *arguments: Any) -> None:
        self._quiet[self.worker.ask(verb, *arguments)] = verb

    def _ask_states(self) -> None:
        for number in [n for n, verb in self._quiet.items() if verb == "states"]:
            self.worker.forget(number)
            del self._quiet[number]
        if self.has_part:
            self._ask_quietly("states", self.session)

    def _attach(self) -> None:
        if self.has_part:
            self._ask_quietly("attach", self.session, *self.kept)
        if not self.groups:
            self._ask_quietly("settings")

    def _show(self, session: Session, states: dict[str, str] | None = None) -> None:
        self.shown = session
        if states is not None:
            self.states = states
        drawing = self._drawings.get(session.cuts, self.drawing)
        if drawing is not self.drawing:
            self.drawing = drawing
            self.redrawn.emit()
        self._keep_selection()
        self.changed.emit()

    def _keep_selection(self) -> None:
        """Drop a selection whose feature or operation is gone, follow one whose faces changed."""
        chosen = self.selection
        if chosen.kind == "feature":
            found = self.feature(chosen.id)
            self.select(replace(chosen, faces=found.tags) if found else NOTHING)
        elif chosen.kind == "operation" and self.operation(chosen.id) is None:
            self.select(NOTHING)

    def _receive(self, reply: Reply) -> None:
        if reply.number in self._quiet:
            if reply.is_last:
                self._receive_quiet(self._quiet.pop(reply.number), reply)
        elif self.job is not None and reply.number == self.job.number:
            self._receive_job(self.job, reply)
        elif reply.kind == "crashed":
            self.notice(reply.text, severity=Severity.WARNING)

    def _receive_quiet(self, verb: str, reply: Reply) -> None:
        if reply.kind in ("failed", "crashed"):
            self.notice(reply.text)
        elif reply.kind == "done" and verb == "settings":
            self.groups = reply.value
            self.changed.emit()
        elif reply.kind == "done" and verb == "states" and not self.is_busy:
            self.states = reply.value.steps
            self.changed.emit()

    def _receive_job(self, job: Job, reply: Reply) -> None:
        if reply.kind == "progress":
            self._doing = reply.text or self._doing
            self.progressed.emit(reply.fraction, reply.text)
        elif reply.kind == "stage":
            self._receive_stage(*reply.value)
        else:
            step, self.job, self.running_step = self.running_step, None, ""
            if reply.kind == "done":
                self._finish(job, reply)
            else:
                self._stop(job, reply, step)
            self.job_changed.emit()
            then, self._then = self._then, ""
            if then and job.verb == "open" and reply.kind == "done":
                self.run(then, tr("Program"))

    def _receive_stage(self, step: str, state: State | None) -> None:
        if state is None:
            self.running_step = step
            self.changed.emit()
        else:
            self._show(state.session, state.steps)

    def _stop(self, job: Job, reply: Reply, step: str) -> None:
        """Keep the steps that a job finished before it stopped short, and tell where it stopped and what is kept."""
        finished = [TITLES[s] for s in STEPS if s in self.shown.records and self.shown.records[s] != self.session.records.get(s)]
        if finished:
            self.history.push(job.label, self.shown)
            self._show(self.shown, self.states)
        else:
            self._show(self.session, self._settled)
        kept = tr("finished and kept: {steps}").format(steps=", ".join(tr(t) for t in finished)) if finished else \
            tr("your session is as it was")
        if reply.kind == "cancelled":
            at = " · ".join(words for words in (tr(TITLES[step]) if step else "", self._doing) if words)
            where = tr("{job} was cancelled at: {place}").format(job=job.label, place=at) if at else \
                tr("{job} was cancelled").format(job=job.label)
            self.notice(where, kept, severity=Severity.INFO)
        elif reply.kind == "crashed":
            self.notice(tr("{job} was lost: {reason}").format(job=job.label, reason=reply.text),
                        tr("{kept}; try again, or save and report the part").format(kept=kept))
        else:
            self.notice(reply.text, kept if finished else "")

    def _finish(self, job: Job, reply: Reply) -> None:
        if job.finish is not None:
            job.finish(reply.value)
        elif job.verb == "open":
            self._install(job, reply.value)
        elif job.verb == "run":
            self.keep(job.label, reply.value)
            if reply.value.refusal:
                self.notice(reply.value.refusal)
        elif job.verb == "save":
            self.project = job.path
            self.history.mark_saved(self.session)
            self.saved.emit(job.path)
            self.changed.emit()
        elif job.verb == "write":
            self.written.emit((job.path, reply.value))
            self._warn_of_rejected(reply.value)

    def _warn_of_rejected(self, files: Sequence[str]) -> None:
        """Name the files that must not run, which a person may have expected under other names."""
        rejected = [name for name in files if ".REJECTED." in name]
        if rejected:
            self.notice(tr("The proof failed, so the programs are {files}").format(files=", ".join(rejected)),
                        tr("they must not run; see the messages for what the proof found"))

    def _install(self, job: Job, opened: Opened) -> None:
        part = opened.state.session.part
        self.path = part.path if job.is_recovery and part is not None else job.path
        self.project = job.project if job.is_recovery else job.path if job.path.endswith(PROJECT) else ""
        self.history = History(opened.state.session)
        if job.is_recovery:
            self.history.mark_saved(None)
        self.drawing, self.kept = opened.drawing, opened.kept
        self._drawings = {opened.state.session.cuts: opened.drawing}
        self.selection = NOTHING
        self.shown, self.states = opened.state.session, opened.state.steps
        self.mesh_changed.emit()
        self.selected.emit(NOTHING)
        self.changed.emit()
        self.opened.emit(self.path)
