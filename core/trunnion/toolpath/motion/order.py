"""In which order independent things are cut: the nearest next."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TypeVar

from trunnion.geometry.arrays import Floats

T = TypeVar("T")


def nearest_first(
    things: Sequence[T], here: Callable[[], Floats | None], away: Callable[[T, Floats], float]
) -> Iterator[T]:
    """Yield the things one by one, each time the one nearest to where the tool then is; the first one first when it is nowhere yet.

    `away` says how far a thing is from a point (2,).
    """
    remaining = list(things)
    while remaining:
        at = here()
        row = (
            0
            if at is None
            else min(range(len(remaining)), key=lambda k: away(remaining[k], at[:2]))
        )
        yield remaining.pop(row)
