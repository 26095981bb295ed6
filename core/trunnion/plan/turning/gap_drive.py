"""The drive geometry of interrupted turning: circles about the main axis with the gaps between bosses that are cut on each."""

from __future__ import annotations

from dataclasses import dataclass

from trunnion.geometry.development import Development


@dataclass(frozen=True, slots=True, kw_only=True)
class GapPass:
    """One turn of the table: the tool is `along` mm up the ground's straight lines, in each of the `gaps` down on the ground and between
    them `lift` mm over it. A gap is two angles (rad) from the development's middle, the second one above the first."""

    along: float
    lift: float
    gaps: tuple[tuple[float, float], ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class GapDrive:
    """Passes over ground that turns under a tool, in order; `clearance` mm over the ground the tool is clear of all."""

    development: Development
    passes: tuple[GapPass, ...]
    clearance: float

    @property
    def is_empty(self) -> bool:
        """Whether there is no gap to turn."""
        return not self.passes
