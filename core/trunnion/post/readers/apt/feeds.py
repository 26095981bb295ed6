"""Feeds of APT CL text: the statement FEDRAT, and how fast a block runs by it."""

from __future__ import annotations

from trunnion.findings import BadInput
from trunnion.model.spindle import FeedMode, limited_turns, per_minute
from trunnion.post.readers.apt.state import AptState
from trunnion.post.readers.numbers import FEED, FEED_PER_REVOLUTION, shown
from trunnion.post.readers.sections import Pace
from trunnion.units import MM_PER_INCH

FEED_WORDS = {
    "MMPM": (1.0, FeedMode.MINUTE),
    "IPM": (MM_PER_INCH, FeedMode.MINUTE),
    "MMPR": (1.0, FeedMode.REVOLUTION),
    "IPR": (MM_PER_INCH, FeedMode.REVOLUTION),
}
"""Words of a feed: mm of its unit of length, and what it is given by."""


def fedrat(state: AptState, line: int, rest: str) -> None:
    """Take over the feed, by the minute or by the revolution."""
    words = [w for w in rest.split(",") if w not in FEED_WORDS]
    unit_word = [w for w in rest.split(",") if w in FEED_WORDS]
    known = [w for w, (unit, _) in FEED_WORDS.items() if unit == state.scale(line)]
    if len(words) != 1 or len(unit_word) > 1 or not set(unit_word) <= set(known):
        raise BadInput(
            f"line {line}: FEDRAT/{shown(rest)} is not understood; write FEDRAT/feed,{known[0]}"
        )
    feed = state.numbers(line, words[0], 1)[0]
    if feed <= 0.0:
        raise BadInput(f"line {line}: the feed must be above zero")
    state.feed_mode = FEED_WORDS[unit_word[0]][1] if unit_word else FeedMode.MINUTE
    by_revolution = state.feed_mode is FeedMode.REVOLUTION
    (FEED_PER_REVOLUTION if by_revolution else FEED).check(line, "FEDRAT ", feed)
    state.feed, state.rapid = feed * state.unit, False


def pace(state: AptState, line: int, x: float) -> Pace:
    """Return how fast a block is fed that ends at an X in mm."""
    if state.feed_mode is not FeedMode.REVOLUTION:
        return Pace(state.feed)
    turns = state.spindle
    if state.surface_speed > 0.0:
        turns = float(limited_turns(state.surface_speed, 2.0 * abs(x), state.spindle))
    if turns <= 0.0:
        raise BadInput(
            f"line {line}: a feed by the revolution while the spindle stands; give its speed"
        )
    feed = per_minute(state.feed, turns)
    FEED.check(line, f"at {turns:g} 1/min a feed a minute of ", feed / state.unit)
    return Pace(feed, mode=FeedMode.REVOLUTION)
