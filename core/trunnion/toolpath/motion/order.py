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
        yield remaining.pop(nearest(remaining, here(), away))


def nearest(things: Sequence[T], here: Floats | None, away: Callable[[T, Floats], float]) -> int:
    """Return the row of the thing nearest to where the tool is: the first one when it is nowhere yet."""
    if here is None:
        return 0
    return min(range(len(things)), key=lambda k: away(things[k], here[:2]))
