"""The moves of a drilling cycle as a control makes them, where they differ from those of RS274/NGC."""

from __future__ import annotations

from typing import NamedTuple


class HoleStroke(NamedTuple):
    """One move of a cycle to a height Z in mm, aside by `shift` (x, y) mm; `feed` mm/min or mm a revolution, 0 for the one in force, None
    for a rapid."""

    height: float
    feed: float | None
    dwell: float = 0.0
    shift: tuple[float, float] = (0.0, 0.0)
