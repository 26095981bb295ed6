"""What is demanded of a bore beyond its shape, as the proof holds programs against it."""

from __future__ import annotations

from dataclasses import dataclass

from trunnion.geometry.arrays import Floats


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class BoreDemand:
    """A bore with a thread or a fit: `start` (3,) mm the middle of where it begins and `out` (3,) the unit way out of it, in the part's
    coordinates; `diameter` and `depth` mm of the bore, `words` as the drawing has the demand.

    Of a thread its nominal `thread_diameter` and `pitch` mm (0: it is a fit) and how deep it is full, `thread_depth` mm (0: nobody said).
    Of a fit the tolerance classes of reamers that make it, `fits`. `faces` are the tags of its side.
    """

    feature: str
    start: Floats
    out: Floats
    diameter: float
    depth: float
    through: bool
    words: str
    thread_diameter: float = 0.0
    pitch: float = 0.0
    thread_depth: float = 0.0
    fits: tuple[str, ...] = ()
    faces: tuple[int, ...] = ()

    @property
    def is_thread(self) -> bool:
        """Whether it is a thread and not a fit."""
        return self.pitch > 0.0
