"""A least-recently-used cache of immutable results."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Hashable
from typing import Generic, TypeVar

Answer = TypeVar("Answer")


class Cache(Generic[Answer]):
    """The last `most` results by key. Results must be immutable: every caller gets the same object."""

    def __init__(self, most: int) -> None:
        self._most = most
        self._answers: OrderedDict[Hashable, Answer] = OrderedDict()

    def __len__(self) -> int:
        return len(self._answers)

    def answer(self, asked: Hashable, work_out: Callable[[], Answer]) -> Answer:
        """Return the result to what is asked, worked out when it is not known."""
        if asked in self._answers:
            self._answers.move_to_end(asked)
            return self._answers[asked]
        found = work_out()
        self._answers[asked] = found
        if len(self._answers) > self._most:
            self._answers.popitem(last=False)
        return found
