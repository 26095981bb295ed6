"""What a person may choose about interrupted turning, and how much of a gap its ends take."""

from __future__ import annotations

from trunnion.plan.turning.retract import travel_time
from trunnion.settings import setting, settings
from trunnion.units import MM_PER_METRE, SECONDS_PER_MINUTE

PER_MINUTE = MM_PER_METRE / SECONDS_PER_MINUTE
"""mm/s in a m/min."""


@settings("gaps")
class GapSettings:
    """How the tool leaves gaps and comes back while the table turns; the planner of a casing gives all but the chord."""

    retract_speed: float = setting(
        20.0,
        unit="m/min",
        low=0.1,
        high=500.0,
        label="Speed of retracting",
        help="Highest speed of the axis that takes the tool out of the gap and back.",
    )
    acceleration: float = setting(
        3000.0,
        unit="mm/s2",
        low=1.0,
        high=50000.0,
        label="Acceleration",
        help="Acceleration of that axis.",
    )
    margin: float = setting(
        5.0,
        unit="mm",
        low=0.0,
        high=1000.0,
        label="Margin",
        help="Length of a gap that is kept free for reaction times, half of it at either end.",
    )
    shortest: float = setting(
        30.0,
        unit="mm",
        low=0.0,
        high=10000.0,
        label="Shortest cut",
        help="Length of ground that must be cut in a gap to be worth the way in and out.",
    )
    threshold: float = setting(
        0.0,
        unit="mm",
        low=0.0,
        high=10000.0,
        label="Shortest gap",
        help="Length that a gap must have in any case; 0: what its ends and the shortest cut need.",
    )
    chord: float = setting(
        0.004,
        unit="mm",
        low=0.0005,
        high=0.1,
        label="Chord error",
        help="How far blocks may be off their circles, half of it on either side.",
    )

    def time_out(self, lift: float) -> float:
        """Return the time (s) that the tool takes out of a gap by `lift` mm, or back."""
        return travel_time(lift, self.retract_speed * PER_MINUTE, self.acceleration)

    def end(self, speed: float, lift: float) -> float:
        """Return the length (mm) at either end of a gap in which the tool is not down on ground that passes at a speed (m/min)."""
        return 0.5 * self.margin + speed * PER_MINUTE * self.time_out(lift)

    def needed(self, speed: float, lift: float) -> float:
        """Return the length (mm) that a gap must have."""
        return max(2.0 * self.end(speed, lift) + self.shortest, self.threshold)
