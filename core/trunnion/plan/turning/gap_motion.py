"""How a tool moves in the gaps of interrupted turning, and how much of a gap its ends take."""

from __future__ import annotations

from dataclasses import dataclass

from trunnion.plan.turning.retract import travel_time
from trunnion.units import MM_PER_METRE, SECONDS_PER_MINUTE

PER_MINUTE = MM_PER_METRE / SECONDS_PER_MINUTE
"""mm/s in a m/min."""


@dataclass(frozen=True, slots=True, kw_only=True)
class GapMotion:
    """How the tool leaves gaps and comes back while the table turns.

    `retract_speed` m/min and `acceleration` mm/s2 of its axis; the `margin`
    (mm) of a gap that is kept free, half of it at either end; the `shortest` length (mm) that must be cut; and the `threshold` (mm) that a
    gap must have in any case."""

    retract_speed: float
    acceleration: float
    margin: float
    shortest: float
    threshold: float

    def time_out(self, lift: float) -> float:
        """Return the time (s) that the tool takes out of a gap by `lift` mm, or back."""
        return travel_time(lift, self.retract_speed * PER_MINUTE, self.acceleration)

    def end(self, speed: float, lift: float) -> float:
        """Return the length (mm) at either end of a gap in which the tool is not down on ground that passes at a speed (m/min)."""
        return 0.5 * self.margin + speed * PER_MINUTE * self.time_out(lift)

    def needed(self, speed: float, lift: float) -> float:
        """Return the length (mm) that a gap must have."""
        return max(2.0 * self.end(speed, lift) + self.shortest, self.threshold)
