"""How an operation's speed and feed are given, and the closed forms between the ways of giving them.

The speed is the spindle's, or the constant one of the surface that is cut with a highest spindle speed; the feed is by the minute, by the
revolution, or the time of each block in inverse (ISO 6983-1: G97 and G96, G94, G95 and G93). Speeds are v = pi d n, feeds f = f_n n.
"""

from __future__ import annotations

import math
from enum import StrEnum
from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike

from trunnion.geometry.arrays import Floats
from trunnion.units import MM_PER_METRE

Number = TypeVar("Number", float, Floats)


class SpindleMode(StrEnum):
    """What of the spindle stays the same along a path."""

    RPM = "rpm"
    SURFACE = "surface-speed"
    """The speed of the surface that is cut; the spindle turns faster where the diameter is smaller, up to a highest speed."""


class FeedMode(StrEnum):
    """What a feed is given by."""

    MINUTE = "minute"
    REVOLUTION = "revolution"
    INVERSE = "inverse"
    """One over the minutes that a block takes."""


def turns_of(speed: Number, diameter: Number) -> Number:
    """Return the spindle speed in 1/min at which a diameter in mm has a surface speed in m/min.

    >>> round(turns_of(314.159265, 100.0), 3)
    1000.0
    """
    return speed * MM_PER_METRE / (math.pi * diameter)


def surface_speed(turns: Number, diameter: Number) -> Number:
    """Return the surface speed in m/min of a diameter in mm at a spindle speed in 1/min."""
    return turns * math.pi * diameter / MM_PER_METRE


def limited_turns(speed: float, diameter: ArrayLike, highest: float) -> Floats:
    """Return the spindle speeds (n,) 1/min at diameters (n,) mm for a constant surface speed in m/min, none above the highest."""
    smallest = turns_of(speed, 1.0) / highest
    kept: Floats = turns_of(speed * np.ones(()), np.maximum(diameter, smallest))
    return np.where(np.asarray(diameter) > smallest, np.minimum(kept, highest), highest)


def per_revolution(feed: Number, turns: Number) -> Number:
    """Return the feed in mm a revolution that a feed in mm/min is at a spindle speed in 1/min."""
    return feed / turns


def per_minute(feed: Number, turns: Number) -> Number:
    """Return the feed in mm/min that a feed in mm a revolution is at a spindle speed in 1/min."""
    return feed * turns


def inverse_feed(feed: Number, length: Number) -> Number:
    """Return one over the minutes that a block of a length in mm takes at a feed in mm/min."""
    return feed / length


def feed_of_inverse(inverse: Number, length: Number) -> Number:
    """Return the feed in mm/min of a block of a length in mm that takes one over `inverse` minutes."""
    return inverse * length
