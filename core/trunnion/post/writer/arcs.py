"""The words I and J of an arc's centre, in ticks of the last written decimal."""

from __future__ import annotations

from collections.abc import Callable

Centre = Callable[[list[int], int, int], tuple[int, int]]
"""Returns I and J for a centre (x, y, z) and the X and Y that the arc starts at."""


def from_start(centre: list[int], x: int, y: int) -> tuple[int, int]:
    """Return I and J as they count from the start of the arc."""
    return centre[0] - x, centre[1] - y


def absolute(centre: list[int], x: int, y: int) -> tuple[int, int]:
    """Return I and J as they count from the zero of the work offset."""
    return centre[0], centre[1]


CENTRES: dict[str, Centre] = {"start": from_start, "absolute": absolute}
"""By what `IsoWords.centres` says."""
