"""How closely passes on curved faces follow their path: coarse scallops need no finer chords."""

from __future__ import annotations

from trunnion.settings import Value

COARSE, CHORD_SHARE = 0.01, 0.075
"""mm: from this scallop height on passes need not follow their path as closely as strategies do by themselves; and how closely of it."""


def chord_choices(strategy: str, height: float) -> dict[str, Value]:
    """Return the choice of an operation for the chord error of a strategy's passes, none where a scallop height in mm asks for its own."""
    return {f"{strategy}.chord": CHORD_SHARE * height} if height >= COARSE else {}
