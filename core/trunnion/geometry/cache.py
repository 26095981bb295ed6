"""A least-recently-used cache of immutable results."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Hashable
from typing import Generic, TypeVar

Result = TypeVar("Result")


class Cache(Generic[Result]):
    """The last `most` results by key. Results must be immutable: every caller gets the same object."""

    def __init__(self, most: int) -> None:
        self._most = most
        self._results: OrderedDict[Hashable, Result] = OrderedDict()

    def __len__(self) -> int:
        return len(self._results)

    def get(self, key: Hashable, compute: Callable[[], Result]) -> Result:
        """Return the result of a key, computed by `compute` when it is not kept."""
        if key in self._results:
            self._results.move_to_end(key)
            return self._results[key]
        found = compute()
        self._results[key] = found
        if len(self._results) > self._most:
            self._results.popitem(last=False)
        return found
