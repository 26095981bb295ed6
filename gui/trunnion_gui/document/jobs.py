"""Requests to the worker: one job at a time that a person sees and can cancel, and queries that block nothing.

The worker computes and the signals report it; late replies are dropped.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from PySide6.QtCore import QObject, Signal

from trunnion.findings import Severity
from trunnion_gui.i18n import tr
from trunnion_gui.worker.requests import Work
from trunnion_gui.worker.worker import Reply, Worker

Finish = Callable[[Any], None]
"""What is done with the value of a reply."""
Notice = Callable[[str, str, Severity], None]
"""Shows a person a text, a remedy and how grave it is."""


@dataclass(frozen=True, slots=True)
class Job:
    """A piece of work that runs: its request number, verb, label, when it started (s), and what is done with its answer."""

    number: int
    command: str | Work
    label: str
    started: float
    finish: Finish


class Jobs(QObject):
    """The window's requests to its worker."""

    changed = Signal()
    """A job began or ended."""
    progressed = Signal(float, str)
    staged = Signal(object)
    """A step of the job begins or is done, as the verb reports."""
    stopped = Signal(object, object, str)
    """A job stopped short: the `Job`, its last `Reply`, and the words on what it was doing."""

    def __init__(self, factory: str, notice: Notice, parent: QObject) -> None:
        super().__init__(parent)
        self.job: Job | None = None
        self._notice = notice
        self._doing = ""
        self._queries: dict[int, tuple[str | Work, Finish]] = {}
        self._then: Callable[[], None] | None = None
        self.worker = Worker(factory, self)
        self.worker.replied.connect(self._receive)

    @property
    def is_busy(self) -> bool:
        """Whether a job runs."""
        return self.job is not None

    @property
    def is_querying(self) -> bool:
        """Whether a query has no reply yet."""
        return bool(self._queries)

    def is_free(self) -> bool:
        """Return whether no job runs; report to a person which one does."""
        if self.job is not None:
            self._notice(
                tr("{job} still runs").format(job=self.job.label),
                tr("cancel it first, or wait until it is done"),
                Severity.WARNING,
            )
        return self.job is None

    def start(self, command: str | Work, label: str, *arguments: Any, finish: Finish) -> None:
        """Begin a job; `finish` gets what it returns when it is done."""
        self._doing = ""
        self.job = Job(
            self.worker.send(command, *arguments), command, label, time.monotonic(), finish
        )
        self.changed.emit()
        self.progressed.emit(0.0, label)

    def cancel(self) -> None:
        """Request that the running job stops."""
        if self.job is not None:
            self._then = None
            self.worker.cancel(self.job.number)
            self.progressed.emit(-1.0, tr("cancelling"))

    def after(self, go_on: Callable[[], None]) -> None:
        """Do something right after the running job is done; never when it stops short."""
        self._then = go_on

    def query(self, command: str | Work, *arguments: Any, finish: Finish) -> None:
        """Send a query that blocks nothing; `finish` gets its reply."""
        self._queries[self.worker.send(command, *arguments)] = command, finish

    def awaits(self, command: str | Work) -> bool:
        """Return whether a query of a verb has no reply yet."""
        return any(running == command for running, _ in self._queries.values())

    def forget(self, command: str | Work) -> None:
        """Drop the queries of a verb."""
        for number in [n for n, (running, _) in self._queries.items() if running == command]:
            self.worker.forget(number)
            del self._queries[number]

    def close(self) -> None:
        """End the worker."""
        self.worker.stop()

    # replies

    def _receive(self, reply: Reply) -> None:
        if reply.number in self._queries:
            if reply.is_last:
                self._finish(self._queries.pop(reply.number)[1], reply)
        elif self.job is not None and reply.number == self.job.number:
            self._follow(self.job, reply)
        elif reply.kind == "crashed":
            self._notice(reply.text, "", Severity.WARNING)

    def _finish(self, finish: Finish, reply: Reply) -> None:
        if reply.kind in ("failed", "crashed"):
            self._notice(reply.text, "", Severity.ERROR)
        elif reply.kind == "done":
            finish(reply.value)

    def _follow(self, job: Job, reply: Reply) -> None:
        if reply.kind == "progress":
            self._doing = reply.text or self._doing
            self.progressed.emit(reply.fraction, reply.text)
        elif reply.kind == "stage":
            self.staged.emit(reply.value)
        else:
            self._end(job, reply)

    def _end(self, job: Job, reply: Reply) -> None:
        self.job = None
        if reply.kind == "done":
            job.finish(reply.value)
        else:
            self.stopped.emit(job, reply, self._doing)
        self.changed.emit()
        then, self._then = self._then, None
        if then is not None and reply.kind == "done":
            then()
