"""The session with its history, and the runs that compute its steps. Views read it and repaint.

A slot builds an edit and hands it over (`edit`), or asks for a run or a family's own work (`run`, `request`); the worker computes and the
signals report it. While a run goes on, `shown` holds what is done so far; `session` stays as it was until the run ends. Steps that a run
finished before it was cancelled, refused or crashed are kept, as one entry of the history.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from PySide6.QtCore import QObject, Signal

from trunnion.findings import Finding, Fix, Severity, TrunnionError
from trunnion.geometry.cut import Cut
from trunnion.geometry.mesh import Mesh
from trunnion.model.feature import Feature
from trunnion.model.operation import Operation
from trunnion.model.session import PostedFile, Session
from trunnion.settings import Value
from trunnion_gui import edits
from trunnion_gui.document.files import Files
from trunnion_gui.document.jobs import Finish, Job, Jobs
from trunnion_gui.document.library import Library
from trunnion_gui.document.selection import SelectionModel
from trunnion_gui.document.shop import ShopCatalogue
from trunnion_gui.edits import Edit, ExternalEdit, History
from trunnion_gui.i18n import tr
from trunnion_gui.worker.drawing import DrawnMesh
from trunnion_gui.worker.requests import SessionState, SettingsGroup, Work
from trunnion_gui.worker.steps import STEPS, TITLES, until
from trunnion_gui.worker.worker import ENGINE, Reply


class Document(QObject):
    """The open part's session and everything that happens to it: `jobs`, `files`, `selection`, `library` and `shop` are its parts."""

    changed = Signal()
    """The shown session is another one, or its states are."""
    mesh_changed = Signal()
    """Another part is there."""
    redrawn = Signal()
    """The part is the same, its faces are others: one was cut, or a cut was taken back."""
    noticed = Signal(object)
    """A `Finding` about the program itself: a failure, a crash, a refusal."""
    reported = Signal(str)
    """Words on what came of a job."""

    def __init__(self, factory: str = ENGINE, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.history = History(Session())
        self.shown = self.history.session
        self.states: dict[str, str] = {}
        self.programs: tuple[PostedFile, ...] = ()
        self.groups: Mapping[str, tuple[SettingsGroup, ...]] = {}
        self.drawing: DrawnMesh | None = None
        self.running_step = ""
        self._drawings: dict[tuple[Cut, ...], DrawnMesh] = {}
        self._settled: tuple[dict[str, str], tuple[PostedFile, ...]] = {}, ()
        self.jobs = Jobs(factory, self.notice, self)
        self.files, self.selection = Files(self), SelectionModel(self)
        self.library, self.shop = Library(self), ShopCatalogue(self)
        self.jobs.changed.connect(self._begin)
        self.jobs.staged.connect(self._take_stage)
        self.jobs.stopped.connect(self._stop)
        self.jobs.worker.restarted.connect(self._attach)
        self.jobs.query("settings", finish=self._take_groups)

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
        return self.jobs.is_busy

    @property
    def has_part(self) -> bool:
        """Whether a part is open."""
        return self.session.part is not None

    @property
    def has_unsaved_work(self) -> bool:
        """Whether anything would be lost: an edit, a run, or the steps that a run has finished so far."""
        return self.has_part and (self.history.is_dirty or self.shown is not self.session)

    def is_ready(self) -> bool:
        """Return whether there is a part and no job runs; show a person what prevents work."""
        return self.jobs.is_free() and self._needs_part()

    def feature(self, id: str) -> Feature | None:
        """Return the shown feature with an id, if there is one."""
        return next((f for f in (self.shown.recognition or ()) if f.id == id), None)

    def operation(self, id: str) -> Operation | None:
        """Return the shown operation with an id, if there is one."""
        process = self.shown.process
        return next((o for o in (process.operations if process else ()) if o.id == id), None)

    def notice(self, text: str, remedy: str = "", severity: Severity = Severity.ERROR) -> None:
        """Show the person a message about the program itself."""
        self.noticed.emit(Finding(severity=severity, code="window", text=text, remedy=remedy))

    # runs

    def run(self, last: str, label: str) -> None:
        """Compute what is stale up to and including a step. Called while a file is being opened, it runs right after."""
        if self.jobs.job is not None and self.jobs.job.command == "open":
            self.jobs.after(lambda: self.run(last, tr("Program")))
        elif self.is_ready():
            if self._is_done(last):
                self.notice(
                    tr("{job}: everything is up to date").format(job=label), severity=Severity.INFO
                )
            else:
                self.jobs.start(
                    "run",
                    label,
                    self.session,
                    last,
                    finish=lambda state: self._finish_run(label, state),
                )

    def program(self) -> None:
        """Do the whole line."""
        self.run("repair", tr("Program"))

    def request(self, work: str | Work, label: str, *arguments: Any, finish: Finish) -> None:
        """Do work on the session in the worker, by a verb's name or a family's own function; `finish` gets what it returns.

        Refused in words while a job runs.
        """
        if self.is_ready():
            self.jobs.start(work, label, self.session, *arguments, finish=finish)

    def apply_fix(self, fix: Fix) -> None:
        """Let the planner take up the fix of a finding: one entry of the history; what it changes is stale until it is run again."""
        label = tr("Fix {what}").format(what=fix.operation or fix.reason)
        self.request("fix", label, fix, finish=lambda state: self.keep(label, state))

    def change_operation(self, id: str, label: str, key: str, value: Value) -> None:
        """Let the planner change an operation's tool, speed or feed: one entry of the history; what depends on it is stale."""
        self.request(
            "change", label, id, {key: value}, finish=lambda state: self.keep(label, state)
        )

    def change_demand(self, ids: tuple[str, ...], label: str, values: dict[str, Value]) -> None:
        """Demand a fit or a thread of holes: one entry of the history; what depends on it is stale."""
        self.request("demand", label, ids, values, finish=lambda state: self.keep(label, state))

    def change_allowance(self, ids: tuple[str, ...], label: str, amounts: dict[str, Value]) -> None:
        """Have features keep material, by field and mm: one entry of the history; what depends on it is stale."""
        self.request("allowance", label, ids, amounts, finish=lambda state: self.keep(label, state))

    def copy_operation(self, id: str, feature: str = "") -> None:
        """Copy an operation, to another feature where one is given, and select the copy."""
        there = {o.id for o in self.session.process.operations} if self.session.process else set()
        label = tr("Copy {id}").format(id=f"{id} → {feature}" if feature else id)
        self.edit(label, edits.with_copy_on(id, feature) if feature else edits.with_copy(id))
        for o in self.session.process.operations if self.session.process else ():
            if o.id not in there:
                self.selection.select_operation(o.id)

    # the session

    def keep(
        self,
        label: str,
        state: SessionState,
        drawing: DrawnMesh | None = None,
        external: ExternalEdit | None = None,
    ) -> None:
        """Take a session into the history, with what is drawn of its part where its faces are others, and what changed outside of it."""
        if drawing is not None:
            self._drawings[state.session.cuts] = drawing
        # A change outside leaves the session as it is: what came back from the worker is a copy of it.
        session = self.session if external is not None else state.session
        self.history.push(label, session, external=external)
        self._show(session, state.steps, state.programs)

    def install(self, state: SessionState, drawing: DrawnMesh, is_saved: bool) -> None:
        """Take up the session of another part, with an empty history."""
        self.history = History(state.session)
        if not is_saved:
            self.history.mark_saved(None)
        self.drawing, self._drawings = drawing, {state.session.cuts: drawing}
        self.shown, self.states, self.programs = state.session, state.steps, state.programs
        self.mesh_changed.emit()
        self.selection.clear()
        self.changed.emit()

    def edit(self, label: str, edit: Edit, gesture: str = "") -> None:
        """Do an undoable edit; a refusal, or a job that runs, is shown in a message."""
        if self.is_busy:
            self.notice(
                tr("{label}: not while {job} runs").format(
                    label=label, job=self.jobs.job.label if self.jobs.job else ""
                ),
                tr("cancel the running job, or wait until it is done"),
                severity=Severity.WARNING,
            )
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
            self.refresh_states()

    def choose(self, key: str, label: str, value: Value, gesture: str = "") -> None:
        """Choose a setting by its full key."""
        self.edit(label, edits.with_choice(key, value), gesture)

    def undo(self) -> None:
        """Take the last edit or run back."""
        external = self.history.undo_external
        if external is not None:
            label = f"{tr('Undo')}: {self.history.undo_label}"
            self._go_external(external.undo, external, label, self.history.undo)
        elif self.jobs.is_free():
            self._show(self.history.undo())
            self.refresh_states()

    def redo(self) -> None:
        """Bring back what was undone."""
        external = self.history.redo_external
        if external is not None:
            label = f"{tr('Redo')}: {self.history.redo_label}"
            self._go_external(external.redo, external, label, self.history.redo)
        elif self.jobs.is_free():
            self._show(self.history.redo())
            self.refresh_states()

    # inside

    def _go_external(
        self, work: Work, edit: ExternalEdit, label: str, step: Callable[[], Session]
    ) -> None:
        """Change what is kept outside of the session, and go a step in the history once that is done."""

        def finish(state: SessionState) -> None:
            self._show(step(), state.steps, state.programs)
            self.library.refresh()

        self.request(work, label, edit.subject, finish=finish)

    def _needs_part(self) -> bool:
        if not self.has_part:
            self.notice(
                tr("There is no part yet"),
                tr("open a STEP or IGES file first (Ctrl+O), or drop one on the window"),
                severity=Severity.WARNING,
            )
        return self.has_part

    def _is_done(self, last: str) -> bool:
        """Whether nothing is stale up to a step; unknown while the states of a fresh edit are awaited."""
        return not self.jobs.awaits("states") and all(
            self.states.get(s) in ("done", "problem") for s in until(last)
        )

    def refresh_states(self) -> None:
        """Request the states of the steps: what they read is, or may be, another one."""
        self.jobs.forget("states")
        if self.has_part:
            self.jobs.query("states", self.session, finish=self._take_states)

    def refresh_groups(self) -> None:
        """Request the declared settings: the catalogues that some name things of are others."""
        self.jobs.forget("settings")
        self.jobs.query("settings", finish=self._take_groups)

    def _attach(self) -> None:
        """Give a fresh worker the part, and send it again the queries without a reply."""
        if self.has_part:
            self.jobs.query("attach", self.session, *self.files.kept, finish=lambda _: None)
        if not self.groups:
            self.jobs.query("settings", finish=self._take_groups)

    def _take_groups(self, groups: Mapping[str, tuple[SettingsGroup, ...]]) -> None:
        self.groups = groups
        self.changed.emit()

    def _take_states(self, state: SessionState) -> None:
        if not self.is_busy:
            self.states, self.programs = state.steps, state.programs
            self.changed.emit()

    def _show(
        self,
        session: Session,
        states: dict[str, str] | None = None,
        programs: tuple[PostedFile, ...] = (),
    ) -> None:
        """Show a session; while the worker has not sent its states yet, those before it stay."""
        self.shown = session
        if states is not None:
            self.states, self.programs = states, programs
        drawing = self._drawings.get(session.cuts, self.drawing)
        if drawing is not self.drawing:
            self.drawing = drawing
            self.redrawn.emit()
        self.selection.follow()
        self.changed.emit()

    def _begin(self) -> None:
        """Remember the states and programs that a job begins with."""
        if self.is_busy:
            self._settled = self.states, self.programs

    def _take_stage(self, stage: tuple[str, SessionState | None]) -> None:
        step, state = stage
        if state is None:
            self.running_step = step
            self.changed.emit()
        else:
            self._show(state.session, state.steps, state.programs)

    def _finish_run(self, label: str, state: SessionState) -> None:
        self.running_step = ""
        self.keep(label, state)
        if state.refusal:
            self.notice(state.refusal)

    def _stop(self, job: Job, reply: Reply, doing: str) -> None:
        """Keep the steps that a job finished before it stopped short, and show where it stopped and what is kept."""
        step, self.running_step = self.running_step, ""
        finished = [
            TITLES[s]
            for s in STEPS
            if s in self.shown.records and self.shown.records[s] != self.session.records.get(s)
        ]
        if finished:
            self.history.push(job.label, self.shown)
            self._show(self.shown, self.states, self.programs)
        else:
            self._show(self.session, *self._settled)
        kept = (
            tr("finished and kept: {steps}").format(steps=", ".join(tr(t) for t in finished))
            if finished
            else tr("your session is as it was")
        )
        if reply.kind == "cancelled":
            at = " · ".join(words for words in (tr(TITLES[step]) if step else "", doing) if words)
            where = (
                tr("{job} was cancelled at: {place}").format(job=job.label, place=at)
                if at
                else tr("{job} was cancelled").format(job=job.label)
            )
            self.notice(where, kept, severity=Severity.INFO)
        elif reply.kind == "crashed":
            self.notice(
                tr("{job} was lost: {reason}").format(job=job.label, reason=reply.text),
                tr("{kept}; try again, or save and report the part").format(kept=kept),
            )
        else:
            self.notice(reply.text, kept if finished else "")
