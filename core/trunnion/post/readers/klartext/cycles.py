"""Drilling cycles of a TNC: what each does at a hole, stroke by stroke (User's Manual "Cycle Programming", chapter drilling)."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

from trunnion import tolerance
from trunnion.findings import BadInput
from trunnion.model.motion.cycle import MOST_PECKS
from trunnion.model.spindle import per_minute
from trunnion.post.readers.hole_strokes import HoleStroke
from trunnion.post.readers.numbers import DWELL, FEED, LENGTH

MOST_FEED = 99_999.0
"""A retraction at this feed is one in rapid: no cycle takes a higher one."""
_COMMON = (200, 201, 203, 204)
_ZERO = {
    395: "depths count from the tip",
    212: "pecks stay the same",
    257: "use cycle 203",
    379: "write the moves out",
}
"""Parameters that must be 0 where they are given, and what that means or what to do."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CycleWords:
    """A cycle as a block says it: its Q words, mm of a written length, mm/min of a written feed, the spindle's speed in 1/min."""

    line: int
    number: int
    values: Mapping[int, float]
    unit: float
    feed_unit: float
    spindle: float

    def length(self, number: int) -> float:
        """Return a length in mm."""
        value = self.values.get(number, 0.0)
        LENGTH.check(self.line, f"Q{number}=", value)
        return value * self.unit

    def feed(self, number: int, instead: float = 0.0) -> float | None:
        """Return a feed in mm/min, `instead` where it is 0, None for a rapid."""
        value = self.values.get(number, 0.0)
        if value == 0.0 and instead > 0.0:
            return instead
        if value >= MOST_FEED:
            return None
        FEED.check(self.line, f"Q{number}=", value)
        return value * self.feed_unit

    def cutting_feed(self) -> float:
        """Return the feed into the hole in mm/min."""
        feed = self.feed(206)
        if feed is None:
            raise self.wrong("feeds in rapid; give Q206")
        return feed

    def dwell(self, number: int) -> float:
        """Return a dwell in s."""
        value = self.values.get(number, 0.0)
        DWELL.check(self.line, f"Q{number}=", value)
        return value

    @property
    def clearance(self) -> float:
        """mm from the surface to the plane where the tool begins to feed."""
        return self.length(200)

    @property
    def plane(self) -> float:
        """Z in mm where the tool begins to feed."""
        return self.length(203) + self.clearance

    @property
    def bottom(self) -> float:
        """Z in mm of the hole's bottom."""
        return self.length(203) + self.length(201)

    @property
    def end(self) -> float:
        """Z in mm where the tool is after the cycle: at the second set-up clearance, never below the first."""
        return self.length(203) + max(self.length(204), self.clearance)

    def wrong(self, why: str) -> BadInput:
        """Return the refusal of this cycle."""
        return BadInput(f"line {self.line}: cycle {self.number} {why}")

    def depths(self) -> list[float]:
        """Return Z in mm at the bottom of each peck, the hole's bottom last."""
        peck, depth = self.length(202), -self.length(201)
        if peck <= 0.0:
            raise self.wrong("without a plunging depth; give Q202 above 0")
        pecks = max(1, math.ceil((depth - tolerance.COINCIDENT) / peck))
        if pecks > MOST_PECKS:
            raise self.wrong(f"with {pecks} pecks, at most {MOST_PECKS} are understood")
        return [self.length(203) - k * peck for k in range(1, pecks)] + [self.bottom]


def strokes_of(words: CycleWords) -> tuple[HoleStroke, ...]:
    """Return what a cycle makes the tool do at a hole; raise `BadInput` for one that is not known, or makes no hole."""
    if words.number not in _CYCLES:
        known = ", ".join(map(str, _CYCLES))
        raise BadInput(
            f"line {words.line}: CYCL DEF {words.number} is not understood, known are {known}; write the moves out"
        )
    needed, optional, made = _CYCLES[words.number]
    for number in (*_COMMON, *needed):
        if number not in words.values:
            raise words.wrong(f"needs Q{number}")
    for number, value in words.values.items():
        if number not in (*_COMMON, *needed, *optional):
            raise words.wrong(f"has no Q{number}; remove it")
        if number in _ZERO and value != 0.0:
            raise words.wrong(f"with Q{number} other than 0 is not understood: {_ZERO[number]}")
    if words.clearance < 0.0 or words.length(204) < 0.0:
        raise words.wrong("with a clearance below 0; check Q200 and Q204")
    if words.length(201) >= 0.0:
        raise words.wrong("with its bottom at or above the surface; give Q201 below 0")
    return (HoleStroke(words.plane, None), *made(words))


def _out(words: CycleWords, feed: float | None) -> Iterator[HoleStroke]:
    """Yield the strokes out of the hole: at a feed to the plane, further in rapid."""
    if feed is not None:
        yield HoleStroke(words.plane, feed)
        if words.end > words.plane:
            yield HoleStroke(words.end, None)
    else:
        yield HoleStroke(words.end, None)


def _drill(words: CycleWords) -> Iterator[HoleStroke]:
    """Yield the strokes of cycle 200: pecks with retraction to the plane, back to the clearance above the last depth."""
    feed, *depths, bottom = words.cutting_feed(), *words.depths()
    for depth in depths:
        yield HoleStroke(depth, feed)
        yield HoleStroke(words.plane, None, words.dwell(210))
        yield HoleStroke(depth + words.clearance, None)
    yield HoleStroke(bottom, feed, words.dwell(211))
    yield from _out(words, None)


def _drill_universally(words: CycleWords) -> Iterator[HoleStroke]:
    """Yield the strokes of cycle 203: chips are broken Q213 times, then the tool comes out to the plane."""
    feed, *depths, bottom = words.cutting_feed(), *words.depths()
    out, back, broken = words.feed(208, feed), words.length(256), 0
    if back < 0.0 or words.values.get(213, 0.0) < 0.0:
        raise words.wrong("with Q256 or Q213 below 0; check them")
    for depth in depths:
        yield HoleStroke(depth, feed)
        if broken < words.values.get(213, 0.0):
            broken += 1
            if back > 0.0:
                yield HoleStroke(min(depth + back, words.plane), out)
        else:
            broken = 0
            yield HoleStroke(words.plane, out, words.dwell(210))
            yield HoleStroke(depth + words.clearance, None)
    yield HoleStroke(bottom, feed, words.dwell(211))
    yield from _out(words, out)


def _peck(words: CycleWords) -> Iterator[HoleStroke]:
    """Yield the strokes of cycle 205: out to the plane after each peck, back to the advanced stop distance above its bottom."""
    feed, *depths, bottom = words.cutting_feed(), *words.depths()
    above = words.length(258)
    if above < 0.0 or above != words.length(259):
        raise words.wrong(
            "with stop distances that change or are below 0; give Q258 and Q259 the same"
        )
    for depth in depths:
        yield HoleStroke(depth, feed)
        yield HoleStroke(words.plane, None)
        yield HoleStroke(min(depth + above, words.plane), None)
    yield HoleStroke(bottom, feed, words.dwell(211))
    yield from _out(words, words.feed(208, feed))


def _ream(words: CycleWords) -> Iterator[HoleStroke]:
    """Yield the strokes of cycle 201: in, a wait, and out at feeds."""
    feed = words.cutting_feed()
    yield HoleStroke(words.bottom, feed, words.dwell(211))
    yield from _out(words, words.feed(208, feed))


def _tap(words: CycleWords) -> Iterator[HoleStroke]:
    """Yield the strokes of cycle 207: in and out at the pitch a revolution, the spindle reversed."""
    pitch = words.length(239)
    if pitch <= 0.0:
        raise words.wrong(
            "with a thread to the left or without a pitch is not understood; give Q239 above 0"
        )
    if words.spindle <= 0.0:
        raise words.wrong("without a spindle speed; give S in TOOL CALL first")
    feed = per_minute(pitch, words.spindle)
    yield HoleStroke(words.bottom, feed)
    yield from _out(words, feed)


_Made = Callable[[CycleWords], Iterator[HoleStroke]]
_CYCLES: Mapping[int, tuple[tuple[int, ...], tuple[int, ...], _Made]] = {
    200: ((202, 206), (210, 211, 395), _drill),
    201: ((206,), (208, 211), _ream),
    203: ((202, 206, 208, 256), (205, 210, 211, 212, 213, 395), _drill_universally),
    205: ((202, 206, 208, 258, 259), (205, 211, 212, 253, 256, 257, 379, 395), _peck),
    207: ((239,), (), _tap),
}
"""Which Q words a cycle needs beside `_COMMON`, which it may have, and what it does."""
