"""The status bar: what runs with its progress and a way to stop it on the left, the verdict on the right."""

from __future__ import annotations

import time

from PySide6.QtCore import QTimer
from PySide6.QtWidgets import QLabel, QProgressBar, QStatusBar, QToolButton

from trunnion.model.verdict import Outcome
from trunnion_gui.actions import Registry
from trunnion_gui.document import Document
from trunnion_gui.i18n import tr
from trunnion_gui.look import icons
from trunnion_gui.look.words import duration, share

_VERDICTS = {Outcome.PASSED: "good", Outcome.REMARKS: "warning", Outcome.FAILED: "bad"}
_TICK_MS = 250


class StatusBar(QStatusBar):
    """Everything has a fixed place, so that nothing jumps when a job ends."""

    def __init__(self, document: Document, registry: Registry) -> None:
        super().__init__()
        self._document = document
        self.setSizeGripEnabled(False)
        self.text, self.bar, self.cancel, self.verdict = (
            QLabel(),
            QProgressBar(),
            QToolButton(),
            QLabel(),
        )
        self.bar.setRange(0, 1000)
        self.bar.setTextVisible(False)
        self.bar.setFixedSize(220, 6)
        self.cancel.setDefaultAction(registry.action("job.cancel"))
        self.cancel.setToolTip(registry.action("job.cancel").toolTip())
        self.addWidget(self.bar)
        self.addWidget(self.cancel)
        self.addWidget(self.text, 1)
        self.addPermanentWidget(self.verdict)
        self.setContentsMargins(10, 0, 12, 0)
        self._doing, self._has_reported = "", False
        self._clock = QTimer(self)
        self._clock.setInterval(_TICK_MS)
        self._clock.timeout.connect(self._tick)
        document.jobs.changed.connect(self._job)
        document.jobs.progressed.connect(self._progress)
        document.changed.connect(self.refresh)
        document.files.saved.connect(
            lambda path: self._report(tr("Saved {path}").format(path=path))
        )
        document.reported.connect(self._report)
        document.files.written.connect(
            lambda what: self._report(
                tr("{n} files written to {folder}").format(n=len(what[1]), folder=what[0])
            )
        )
        self._job()
        self.refresh()

    def refresh(self) -> None:
        """Show the verdict of the shown session."""
        session = self._document.shown
        verdict = session.verdict
        if verdict is None or self._document.is_busy:
            self.verdict.setText(
                "" if session.part is None or self._document.is_busy else tr("no verdict yet")
            )
            self._colour("")
            return
        is_stale = self._document.states.get("verify") in ("stale", "empty")
        words = tr("verdict: {outcome}").format(outcome=tr(verdict.outcome.value))
        stale = f" · {tr('stale')}" if is_stale else ""
        self.verdict.setText(
            f"{words} · {tr('coverage')} {share(verdict.coverage)} · {duration(verdict.machining_time_s)}{stale}"
        )
        self._colour("warning" if is_stale else _VERDICTS[verdict.outcome])

    def _colour(self, name: str) -> None:
        self.verdict.setProperty("verdict", name)
        self.verdict.style().unpolish(self.verdict)
        self.verdict.style().polish(self.verdict)

    def hint(self, words: str) -> None:
        """Say something about what is under the mouse while nothing runs."""
        if self._document.jobs.job is None:
            self.text.setText(words)

    def _report(self, words: str) -> None:
        """Say what came of a job; it stays when the job is put away."""
        self._has_reported = True
        self.text.setText(words)

    def _job(self) -> None:
        job = self._document.jobs.job
        self.bar.setVisible(job is not None)
        self.cancel.setVisible(job is not None)
        if job is not None:
            self.bar.setValue(0)
            self._doing, self._has_reported = job.label, False
            self._clock.start()
            self._tick()
        else:
            self._clock.stop()
            if self._doing and not self._has_reported:
                self.text.setText("")
            self._doing = ""
        self.cancel.setIcon(icons.icon("cancel"))
        self.refresh()

    def _progress(self, fraction: float, text: str) -> None:
        if fraction >= 0.0:
            self.bar.setValue(max(self.bar.value(), round(fraction * self.bar.maximum())))
        self._doing = text or self._doing
        self._tick()

    def _tick(self) -> None:
        job = self._document.jobs.job
        if job is not None:
            self.text.setText(
                f"{duration(time.monotonic() - job.started)} · {self._doing} · {self.bar.value() // 10} %"
            )
