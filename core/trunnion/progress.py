"""Progress with cancel: what every slow piece of work takes and looks at every 0.2 s."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sized
from typing import TypeVar

from trunnion.findings import Cancelled

T = TypeVar("T")
Report = Callable[[float, str], None]


class Progress:
    """How far a piece of work is (0 to 1), what it is doing, and whether it should stop.

    `report` is told of each step; `cancelled` is asked by `check`. A part of a longer job gets its own share with `part`.
    """

    def __init__(self, report: Report | None = None, cancelled: Callable[[], bool] | None = None,
                 start: float = 0.0, end: float = 1.0) -> None:
        self._report = report
        self._cancelled = cancelled
        self._start = start
        self._end = end

    def check(self) -> None:
        """Raise `Cancelled` when a person asked to stop."""
        if self._cancelled is not None and self._cancelled():
            raise Cancelled

    def at(self, fraction: float, text: str = "") -> None:
        """Tell how far the work is, and stop here when asked to."""
        self.check()
        if self._report is not None:
            share = min(max(fraction, 0.0), 1.0)
            self._report(self._start + share * (self._end - self._start), text)

    def part(self, start: float, end: float) -> Progress:
        """Return the progress of a part of this work, from `start` to `end` of it."""
        span = self._end - self._start
        return Progress(self._report, self._cancelled, self._start + start * span, self._start + end * span)

    def over(self, things: Iterable[T], text: str = "") -> Iterator[T]:
        """Yield the things one by one, telling how far the work is before each."""
        total = len(things) if isinstance(things, Sized) else 0
        for n, thing in enumerate(things):
            self.at(n / total if total else 0.0, text)
            yield thing


QUIET = Progress()
"""Progress that nobody looks at."""
