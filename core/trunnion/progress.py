"""Progress with cancel: what every slow piece of work takes and looks at every 0.2 s."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterable, Iterator, Sized
from concurrent.futures import ThreadPoolExecutor, wait
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, TypeVar

from trunnion.findings import Cancelled

T = TypeVar("T")
Report = Callable[[float, str], None]
BEAT_S = 0.25
"""Seconds without a report after which a look repeats the last one: a person sees at least two a second, whatever the work can tell."""
LOOK_S = 0.05
"""Seconds between two looks while work in another thread is waited for."""


@dataclass(slots=True)
class _Last:
    """What a whole job reported last, and when (s, monotonic)."""

    fraction: float
    text: str = ""
    time: float = 0.0


class Progress:
    """How far a piece of work is (0 to 1), what it is doing, and whether it should stop.

    `report` is told of each step; `cancelled` is asked by `check`. A part of a longer job gets its own share with `part`; its texts begin
    with `name` where it has one. What is told of one piece of work never goes back.
    """

    def __init__(
        self,
        report: Report | None = None,
        cancelled: Callable[[], bool] | None = None,
        start: float = 0.0,
        end: float = 1.0,
        name: str = "",
    ) -> None:
        self._report = report
        self._cancelled = cancelled
        self._start = start
        self._end = end
        self._name = name
        self._last = _Last(start)

    def check(self) -> None:
        """Raise `Cancelled` when a person asked to stop; repeat the last report when it is `BEAT_S` old."""
        self._look()
        if (
            self._report is not None
            and self._last.time
            and time.monotonic() - self._last.time > BEAT_S
        ):
            self._emit(self._last.fraction, self._last.text)

    def at(self, fraction: float, text: str = "") -> None:
        """Tell how far the work is, and stop here when asked to."""
        self._look()
        if self._report is not None:
            share = min(max(fraction, 0.0), 1.0)
            self._emit(float(self._start + share * (self._end - self._start)), self._named(text))

    def doing(self, text: str) -> None:
        """Tell what the work does now, as far as it was before, and stop here when asked to."""
        self._look()
        if self._report is not None:
            self._emit(self._last.fraction, self._named(text))

    def part(self, start: float, end: float, name: str = "") -> Progress:
        """Return the progress of a part of this work, from `start` to `end` of it."""
        span = self._end - self._start
        made = Progress(
            self._report,
            self._cancelled,
            self._start + start * span,
            self._start + end * span,
            self._named(name),
        )
        made._last = self._last
        return made

    def afresh(self) -> Progress:
        """Return the same progress for a new piece of work: what it tells may be less than what was told before."""
        made = self.part(0.0, 1.0)
        made._last = _Last(self._start)
        return made

    def over(self, things: Iterable[T], text: str = "") -> Iterator[T]:
        """Yield the things one by one, telling how far the work is before each."""
        total = len(things) if isinstance(things, Sized) else 0
        for n, thing in enumerate(things):
            self.at(n / total if total else 0.0, text)
            yield thing

    def each(self, things: Iterable[T]) -> Iterator[T]:
        """Yield the things one by one with a look before each, where nothing new is to be told."""
        for thing in things:
            self.check()
            yield thing

    def slices(self, count: int, size: int, text: str = "") -> Iterator[slice]:
        """Yield the rows from 0 to `count` in slices of at most `size`, telling how far the work is before each."""
        for first in range(0, count, size):
            self.at(first / count, text)
            yield slice(first, min(first + size, count))

    def aside(self, work: Callable[[Progress], T], text: str = "") -> T:
        """Return what `work` returns, done in a thread of its own while this one looks: for arrays and compiled loops that can't look.

        `work` must not change what others use: cancelled, it is left to itself, and ends when it looks at the progress it was given.
        Raises what `work` raises.
        """
        stop, done = threading.Event(), threading.Event()
        outcome: list[Any] = [None, None]

        def run() -> None:
            try:
                outcome[0] = work(Progress(cancelled=stop.is_set))
            except BaseException as reason:  # noqa: BLE001 - raised again in the thread that waits
                outcome[1] = reason
            done.set()

        if self._report is None and self._cancelled is None:
            return work(self)
        if text:
            self.doing(text)
        threading.Thread(target=run, daemon=True, name="trunnion-aside").start()
        try:
            while not done.wait(LOOK_S):
                self.check()
        except BaseException:
            stop.set()
            raise
        if outcome[1] is not None:
            raise outcome[1]
        made: T = outcome[0]
        return made

    @contextmanager
    def in_turn(self) -> Iterator[Callable[[Callable[[Progress], T]], Callable[[], T]]]:
        """Let pieces of work be done one after another in a thread of their own while the block runs.

        The block is given what takes a piece and returns what waits for it and returns what it returns. No piece may change what the block
        uses. What a piece raises is raised by its wait. When the block fails or is cancelled, what is at work is told to stop and waited
        for, and what has not begun is dropped.
        """
        stop = threading.Event()

        def cancelled() -> bool:
            if self._cancelled is not None and self._cancelled():
                stop.set()
            return stop.is_set()

        own = Progress(cancelled=cancelled)
        with ThreadPoolExecutor(1, "trunnion-beside") as pool:

            def begin(work: Callable[[Progress], T]) -> Callable[[], T]:
                def piece() -> T:
                    own.check()
                    return work(own)

                future = pool.submit(piece)

                def result() -> T:
                    while not wait([future], timeout=LOOK_S).done:
                        self.check()
                    return future.result()

                return result

            try:
                yield begin
            except BaseException:
                stop.set()
                pool.shutdown(cancel_futures=True)
                raise

    @contextmanager
    def beside(self, work: Callable[[Progress], T]) -> Iterator[Callable[[], T]]:
        """Do `work` in a thread of its own while the block runs, as the only piece of `in_turn`; the block is given what waits for it."""
        with self.in_turn() as begin:
            yield begin(work)

    def _look(self) -> None:
        if self._cancelled is not None and self._cancelled():
            raise Cancelled

    def _emit(self, fraction: float, text: str) -> None:
        """Report, never less than what this piece of work told before: two parts of it may have been given the same share."""
        last = self._last
        last.fraction, last.text, last.time = max(fraction, last.fraction), text, time.monotonic()
        if self._report is not None:
            self._report(last.fraction, text)

    def _named(self, text: str) -> str:
        return ": ".join(word for word in (self._name, text) if word)


NO_PROGRESS = Progress()
"""Progress that nobody looks at."""
