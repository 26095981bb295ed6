"""The playback's clock: where the tool is, how fast it goes, and which stock is requested from the worker.

The tool runs in the window's process; the stock arrives from the worker when it is ready. While playing, the stock of a position a little
ahead is requested: the tool goes there meanwhile, waits when it gets there first, and the stock changes as it passes. So tool and stock
never drift apart, and the window never waits.
"""

from __future__ import annotations

import math
import time
from typing import Any

import numpy as np
from PySide6.QtCore import QObject, Qt, QTimer, Signal

from trunnion.model.playback import Moment, Timeline
from trunnion.tolerance import GOUGE
from trunnion_gui.document import Document
from trunnion_gui.worker.worker import Reply

SPEEDS = (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000)
"""How many times faster than the machine; a block at a time: blocks a second."""
_TICK_MS = 33
_LONGEST_TICK_S = 0.25
"""A tick that was held up moves the tool no further than this."""
_LEAST_LEAD_S, _MOST_LEAD_S = 0.08, 1.0
"""How far ahead of the tool, in the person's time, the stock is requested: a little more than the worker needs."""
_RESPONSE_S = 0.25
"""Time after which the worker shows how far it got."""


class Player(QObject):
    """Plays the shown session's plan while it is switched on."""

    opened = Signal()
    """There is another timeline, or none."""
    moved = Signal(float)
    """The tool is at another position."""
    cut = Signal(object)
    """A `Moment`: the stock to show."""
    changed = Signal()
    """Playing or not, speed, mode."""

    def __init__(self, document: Document, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._document = document
        self.timeline: Timeline | None = None
        self.position = 0.0
        self.speed = 10
        self.by_block = False
        self.is_on = False
        self._source: tuple[Any, ...] = ()
        self._requested = 0
        self._requested_at, self._requested_for = 0.0, 0.0
        self._opening = 0
        self._ahead: Moment | None = None
        self._stock_at = -1.0
        self._lead = _LEAST_LEAD_S
        self._last = 0.0
        self._timer = QTimer(self)
        self._timer.setTimerType(Qt.TimerType.PreciseTimer)
        self._timer.setInterval(_TICK_MS)
        self._timer.timeout.connect(self._tick)
        document.jobs.worker.replied.connect(self._receive)
        document.jobs.worker.restarted.connect(self._restart)
        document.changed.connect(self._follow)
        document.jobs.changed.connect(self._follow)

    @property
    def is_playing(self) -> bool:
        """Whether the tool runs."""
        return self._timer.isActive()

    @property
    def is_settled(self) -> bool:
        """Whether the shown stock is where the tool is."""
        return self._stock_at == self.position

    @property
    def can_play(self) -> bool:
        """Whether the session has toolpaths, and the worker is free."""
        session = self._document.session
        return (
            not self._document.is_busy
            and session.blank is not None
            and any(len(p.path) for p in session.paths)
        )

    @property
    def is_ready(self) -> bool:
        """Whether the stock can follow the tool: there is a timeline, and no job keeps the worker."""
        return self.timeline is not None and not self._document.is_busy

    @property
    def end(self) -> float:
        """The last position."""
        return float(len(self.timeline)) if self.timeline is not None else 0.0

    def switch(self, on: bool) -> None:
        """Begin or end the playback."""
        self.is_on = on
        if on:
            self._follow()
        else:
            self.forget()

    def forget(self) -> None:
        """Let the timeline go; it is requested again when needed."""
        self.pause()
        self.timeline, self._source, self._opening, self._requested, self._ahead = (
            None,
            (),
            0,
            0,
            None,
        )
        self._stock_at = -1.0
        self.opened.emit()

    def play(self) -> None:
        """Run on from where the tool is; from the beginning when it is at the end. Not while a job runs: no stock would follow."""
        if not self.is_ready or self.is_playing:
            return
        if self.position >= self.end:
            self.go(0.0)
        self._last = time.perf_counter()
        self._ahead = None
        self._timer.start()
        self.changed.emit()
        self._request()

    def pause(self) -> None:
        """Stop where the tool is."""
        if self.is_playing:
            self._timer.stop()
            self._ahead = None
            self.changed.emit()
            self._request()

    def toggle(self) -> None:
        """Play, or pause."""
        (self.pause if self.is_playing else self.play)()

    def go(self, position: float) -> None:
        """Put the tool at a position; the stock follows."""
        self._ahead = None
        self._move(min(max(position, 0.0), self.end))
        self._request()

    def step(self, blocks: int) -> None:
        """Go some whole blocks on or back."""
        self.pause()
        self.go(float((math.floor if blocks > 0 else math.ceil)(self.position) + blocks))

    def skip(self, operations: int) -> None:
        """Go to the beginning of an operation: the next one, this one's, or the one before when the tool stands at a beginning."""
        if self.timeline is None:
            return
        first = self.timeline.first
        if operations > 0:
            after = first[first > self.position]
            self.go(float(after[0]) if len(after) else self.end)
        else:
            before = first[first < self.position]
            self.go(float(before[-1]) if len(before) else 0.0)

    def set_speed(self, speed: int) -> None:
        """Play so many times faster than the machine (a block at a time: so many blocks a second)."""
        self.speed = speed
        self.changed.emit()

    def faster(self, steps: int = 1) -> None:
        """Take the next higher speed, or a lower one."""
        nearest = min(range(len(SPEEDS)), key=lambda n: abs(SPEEDS[n] - self.speed))
        self.set_speed(SPEEDS[min(max(nearest + steps, 0), len(SPEEDS) - 1)])

    def set_by_block(self, on: bool) -> None:
        """Play a block at a time, each as long as the others, or at the machine's time."""
        self.by_block = on
        self.changed.emit()

    def load(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the removal rate of every block (n,) in cm3/min and which blocks (n,) the proof found at fault; both empty when it did not
        look at these blocks."""
        verdict, line = self._document.session.verdict, self.timeline
        blocks = (
            verdict.blocks
            if verdict is not None and line is not None and line.passages[0].file
            else ()
        )
        rate = np.concatenate([np.zeros(0), *(np.asarray(b.rate, dtype=float) for b in blocks)])
        if line is None or len(rate) != len(line):
            return np.zeros(0), np.zeros(0, bool)
        allowed = float(self._document.session.choices.get("verify.tolerance", GOUGE))
        bad = np.concatenate([np.maximum(b.gouge, b.collision) > allowed for b in blocks])
        return rate, bad

    # inside

    def _restart(self) -> None:
        """Play the plan anew in a fresh worker."""
        self.forget()
        self._follow()

    def _follow(self) -> None:
        """Request the timeline when the plan is another one; nothing is requested while a job runs."""
        if self._document.is_busy:
            self.pause()
        if not self.is_on or self._document.is_busy:
            return
        session = self._document.session
        source = (session.paths, session.posted, session.process, session.blank)
        if len(source) == len(self._source) and all(a is b for a, b in zip(source, self._source)):
            self._request()
            return
        if not self.can_play:
            self.forget()
            return
        self._source = source
        self._opening = self._document.jobs.worker.send("playback", session)

    def _after(self, position: float, seconds: float) -> float:
        """Return the position some of the person's seconds later."""
        assert self.timeline is not None
        if self.by_block:
            return min(position + seconds * self.speed, self.end)
        return self.timeline.position_at(self.timeline.seconds_at(position) + seconds * self.speed)

    def _tick(self) -> None:
        now = time.perf_counter()
        passed, self._last = min(now - self._last, _LONGEST_TICK_S), now
        bound = (
            self._ahead.position
            if self._ahead is not None
            else self._requested_for
            if self._requested
            else self.end
        )
        self._move(max(min(self._after(self.position, passed), bound), self.position))
        if self._ahead is not None and self.position >= self._ahead.position:
            self._show(self._ahead)
        if self._ahead is None and not self._requested:
            if self.position >= self.end:
                self.pause()
            else:
                self._request()

    def _move(self, position: float) -> None:
        self.position = position
        self.moved.emit(position)

    def _show(self, moment: Moment) -> None:
        self._ahead, self._stock_at = None, moment.position
        self.cut.emit(moment)

    def _request(self) -> None:
        """Request the stock where the tool is, or where it will be when the reply comes; one request at a time."""
        if self.timeline is None or self._requested or self._document.is_busy:
            return
        wanted = self._after(self.position, self._lead) if self.is_playing else self.position
        if wanted != self._stock_at:
            self._requested_at, self._requested_for = time.perf_counter(), wanted
            self._requested = self._document.jobs.worker.send(
                "moment", self.timeline.key, wanted, _RESPONSE_S
            )

    def _receive(self, reply: Reply) -> None:
        if not reply.is_last or reply.number not in (self._opening, self._requested):
            return
        if reply.number == self._opening:
            self._opening = 0
            self._open(reply)
            return
        self._requested = 0
        if reply.kind != "done":
            self._source = ()
            if reply.kind == "failed":
                self._document.notice(reply.text)
            return
        needed = time.perf_counter() - self._requested_at
        self._lead = min(max(0.5 * self._lead + 0.6 * needed, _LEAST_LEAD_S), _MOST_LEAD_S)
        if self.is_playing and reply.value.position > self.position:
            self._ahead = reply.value
        else:
            self._show(reply.value)
            self._request()

    def _open(self, reply: Reply) -> None:
        if reply.kind != "done":
            self.forget()
            if reply.kind == "failed":
                self._document.notice(reply.text)
            return
        self.timeline, self._ahead, self._stock_at = reply.value, None, -1.0
        self.position = min(self.position, self.end)
        self.opened.emit()
        self.go(self.position)
