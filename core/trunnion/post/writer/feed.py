"""How feeds and constant surface speeds become written numbers."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

from trunnion.model.spindle import FeedMode, limited_turns
from trunnion.post.iso_words import IsoWords
from trunnion.post.ticks import TickScale, shortened
from trunnion.units import METRES_PER_FOOT, trimmed

SURFACE_DECIMALS = 1
"""Decimals of a constant surface speed in m/min or ft/min."""
DWELL_DECIMALS = 3
"""Decimals of a dwell in seconds."""


class RevolutionWords(Protocol):
    """How many decimals a control's feeds by the revolution have."""

    @property
    def revolution_decimals(self) -> int: ...

    @property
    def extra_decimals_inch(self) -> int: ...


@dataclass(frozen=True, slots=True, kw_only=True)
class FeedFormat:
    """How the feeds of a section are written: what they are given by, at which spindle speed in 1/min or surface speed in m/min."""

    mode: FeedMode
    spindle: float
    surface_speed: float

    def turns(self, x: float) -> float:
        """Return the spindle speed in 1/min at an X in mm."""
        if self.surface_speed <= 0.0:
            return self.spindle
        return float(limited_turns(self.surface_speed, 2.0 * abs(x), self.spindle))


def feed_word(words: IsoWords, mode: FeedMode) -> str:
    """Return the code by which a control takes feeds in a mode, empty where it has none."""
    return {
        FeedMode.MINUTE: words.per_minute,
        FeedMode.REVOLUTION: words.per_revolution,
        FeedMode.INVERSE: words.inverse_time,
    }[mode]


def dwell_text(seconds: float, a_second: int = 1) -> str:
    """Return a dwell as it is written, in as many parts as the control counts `a_second` in; never zero.

    >>> dwell_text(0.5), dwell_text(0.5, 1000)
    ('0.5', '500')
    """
    decimals = max(0, DWELL_DECIMALS - round(math.log10(a_second)))
    return shortened(seconds * a_second, decimals)


def revolution_text(share: float, scale: TickScale, words: RevolutionWords) -> str:
    """Return a feed in mm a revolution as it is written; an inch is coarser and has more decimals."""
    extra = words.extra_decimals_inch if scale.unit != 1.0 else 0
    return shortened(share / scale.unit, words.revolution_decimals + extra)


def surface_text(speed: float, units: str) -> str:
    """Return a surface speed in m/min as it is written: in m/min or, where lengths are inches, in ft/min.

    >>> surface_text(180.0, "mm"), surface_text(60.96, "inch")
    ('180', '200')
    """
    return trimmed(speed / METRES_PER_FOOT if units == "inch" else speed, SURFACE_DECIMALS)
