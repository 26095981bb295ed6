"""How closely passes on curved faces follow their path: chords no finer than the scallops beside them need."""

from __future__ import annotations

from trunnion.settings import Value

SHARE, MOST = 0.5, 0.002
"""The chord error of passes, of the scallop height between them, and at most in mm: what chords leave of a face then stays below what lies
between passes, and below what a turning axis is judged to."""
COARSE_SHARE = 0.075
"""The same share where scallops are so coarse that it comes to more than `MOST`: there it is the roughness that is asked for."""


def chord_choices(strategy: str, height: float) -> dict[str, Value]:
    """Return the choice of an operation for the chord error of a strategy's passes, from the scallop height in mm."""
    return {f"{strategy}.chord": max(min(SHARE * height, MOST), COARSE_SHARE * height)}
