"""How closely passes on curved faces follow their path: chords no finer than the scallops beside them need; and how near they lie then."""

from __future__ import annotations

from trunnion import tolerance

SHARE, MOST = 0.5, 0.002
"""The chord error of passes, of the scallop height between them, and at most in mm: what chords leave of a face then stays below what lies
between passes, and below what a turning axis is judged to."""
HIGHEST = 1.1
"""How high the highest ridge is at most over the height that passes are laid for."""
COARSE_SHARE = 0.075
"""The same share where scallops are so coarse that it comes to more than `MOST`: there it is the roughness that is asked for."""


def chord_choices(strategy: str, height: float) -> dict[str, float]:
    """Return the choice of an operation for the chord error of a strategy's passes, from the scallop height in mm."""
    return {f"{strategy}.chord": max(min(SHARE * height, MOST), COARSE_SHARE * height)}


def laid_height(strategy: str, height: float) -> float:
    """Return the scallop height in mm that passes are laid for: the wanted one, or less where ridges that high would count as unfinished
    with what chords and triangles leave of the face besides. One that is wanted higher than that is as wanted."""
    if height > tolerance.GOUGE:
        return height
    besides = sum(chord_choices(strategy, height).values()) + tolerance.SKIN_CHORD
    return min(height, (tolerance.GOUGE - besides) / HIGHEST)
