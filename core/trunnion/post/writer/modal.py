"""The modal state of a text while it is written, and the words of a block: those alone that change."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import ClassVar

from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.model.motion.toolpath import Motion
from trunnion.model.spindle import FeedMode, per_revolution
from trunnion.post.iso_words import IsoWords
from trunnion.post.settings import PostSettings
from trunnion.post.ticks import TickScale, WrittenPath
from trunnion.post.writer.arcs import CENTRES
from trunnion.post.writer.feed import FeedFormat, feed_word, revolution_text
from trunnion.post.writer.plane import MILLING
from trunnion.post.writer.rotary import inverse_time

Block = tuple[list[int], list[int], int, float]
"""End point, centre, motion and feed in mm/min, as `WrittenPath.blocks` yields them."""


class WrittenState:
    """What the control knows at this line of the text. Positions, centres and angles are in ticks of their last decimal.

    `at` is the tip's position, None when it is not known; `angle` that of the rotary axes whose letters are `letters`, None before the
    first;
    `motion` -1 before the first; `feed` is as it was written, empty when it must be written again, and `feed_mode` what it is given by.
    `feeds` is how the section's feeds are written, `plane` which letters its points have.
    """

    scale_class: ClassVar[type[TickScale]] = TickScale
    """How the control writes numbers."""

    def __init__(self, words: IsoWords, settings: PostSettings, letters: str) -> None:
        self.words, self.letters = words, letters
        self.scale = self.scale_class.of(
            settings, words.extra_decimals_inch, words.feed_decimals, words.point
        )
        self.degrees = degrees_of(words, self.scale_class)
        self.centre_words = CENTRES[words.centres]
        self.tool: int | None = None
        self.at: tuple[int, int, int] | None = None
        self.angle: list[int] | None = None
        self.motion, self.feed, self.coolant = -1, "", "off"
        self.feed_mode, self.plane = FeedMode.MINUTE, MILLING
        self.feeds = FeedFormat(mode=FeedMode.MINUTE, spindle=0.0, surface_speed=0.0)

    def reached(self, point: list[int], angle: list[int], motion: int) -> None:
        """Take over where a block ends and how it went."""
        self.at, self.angle, self.motion = (point[0], point[1], point[2]), angle, motion

    def rapid(self, words: Iterable[str]) -> str:
        """Return a rapid block of some words; empty ones are left out."""
        return " ".join([self.words.motions[Motion.RAPID], *(w for w in words if w)])

    def lines(self, block: Block, angle: list[int], minutes: float) -> list[str]:
        """Return the lines that a block is on this control; see `block`."""
        return [self.block(block, angle, minutes)]

    def block(self, block: Block, angle: list[int], minutes: float) -> str:
        """Return the words of a block that ends with the rotary axes at `angle`: only what changes, but both ends of an arc's plane.

        `minutes` above 0 are how long a block takes that is fed in inverse time.
        """
        point, centre, motion, feed = block
        text, at, plane = self.scale.text, self.at or (0, 0, 0), self.plane
        arc, fed = motion >= Motion.ARC_CW, motion != Motion.RAPID
        parts = []
        mode = FeedMode.INVERSE if minutes > 0.0 else self.feeds.mode
        if fed and mode is not self.feed_mode:
            parts.append(self.switched(mode))
        if motion != self.motion:
            parts.append(self.words.motions[motion])
        first, second, third = plane.letters
        if arc or point[0] != at[0]:
            parts.append(first + text(point[0]))
        if arc or point[1] != at[1]:
            parts.append(second + text(plane.diameter * point[1]))
        if point[2] != at[2]:
            parts.append(third + text(point[2]))
        if angle != self.angle:
            parts += self.turned(angle)
        if arc:
            i, j = self.centre_words(centre, at[0], at[1])
            parts += [plane.centres[0] + text(i), plane.centres[1] + text(j)]
        if minutes > 0.0:
            parts.append("F" + self.scale.pointed(inverse_time(minutes)))
        elif fed and (feed_words := self.feed_text(feed, point[plane.radial])) != self.feed:
            parts.append("F" + feed_words)
            self.feed = feed_words
        self.at, self.angle, self.motion = (point[0], point[1], point[2]), angle, motion
        return " ".join(parts)

    def writes_many(self) -> bool:
        """Whether `straight` can write blocks from here on: milling, fed by the minute."""
        return self.plane is MILLING and self.feeds.mode is self.feed_mode is FeedMode.MINUTE

    def straight(self, path: WrittenPath, first: int, after: int) -> Iterator[str]:
        """Yield the lines of the rows from `first` to before `after`, all straight as the one before them, as `lines` returns them."""
        rows = slice(first - 1, after)
        point, more, motion = path.point[rows], path.more[rows], path.motion[rows]
        codes = [f" {self.words.motions[m]}" for m in motion[1:].tolist()]
        columns = [
            changed(codes, motion[1:] != motion[:-1]),
            *self.point_words(point),
            *self.axis_words(more),
            self.fed_words(motion[1:], path.feed[first:after]),
        ]
        self.reached(point[-1].tolist(), more[-1].tolist(), int(motion[-1]))
        yield from (words[1:] for words in map("".join, zip(*columns, strict=True)))

    def point_words(self, point: Ints, always: bool = False) -> list[list[str]]:
        """Return by letter the words of points (k, 3) after the first, each after a space; "" for a number that stays, or `always`."""
        return [
            changed(self.scale.texts(v[1:], f" {letter}"), (v[1:] != v[:-1]) | always)
            for letter, v in zip(self.plane.letters, point.T, strict=True)
        ]

    def axis_words(self, angle: Ints) -> list[list[str]]:
        """Return by letter the words of rotary axes at angles (k, a) after the first, as `point_words` does."""
        return [
            changed(self.degrees.texts(v[1:], f" {letter}"), v[1:] != v[:-1])
            for letter, v in zip(self.letters, angle.T, strict=True)
        ]

    def fed_words(self, motion: Ints, feed: Floats) -> list[str]:
        """Return the words of feeds (k,) in mm/min, each after a space; "" for rapids and where the feed is written already."""
        found: list[str] = []
        last: float | None = None
        for is_fed, value in zip((motion != Motion.RAPID).tolist(), feed.tolist(), strict=True):
            word = ""
            if is_fed and value != last:
                last, text = value, self.scale.feed(value)
                word, self.feed = "" if text == self.feed else f" F{text}", text
            found.append(word)
        return found

    def switched(self, mode: FeedMode) -> str:
        """Return the word that switches to another way of giving feeds; the feed must be written again after it."""
        self.feed_mode, self.feed = mode, ""
        return feed_word(self.words, mode)

    def feed_text(self, feed: float, x: int) -> str:
        """Return a feed in mm/min as it is written for a block that ends at an X in ticks."""
        if self.feeds.mode is not FeedMode.REVOLUTION:
            return self.scale.feed(feed)
        turns = self.feeds.turns(x * self.scale.unit / 10.0**self.scale.decimals)
        return self.scale.pointed(
            revolution_text(per_revolution(feed, turns), self.scale, self.words)
        )

    def turned(self, angle: list[int]) -> list[str]:
        """Return the words of the rotary axes that turn."""
        before = self.angle or angle
        return [
            letter + self.degrees.text(v)
            for letter, v, old in zip(self.letters, angle, before, strict=True)
            if v != old
        ]


def changed(words: list[str], where: Bools) -> list[str]:
    """Return words (k,), "" for those that do not stand where (k,) it is said."""
    if where.all():
        return words
    return [word if keep else "" for word, keep in zip(words, where.tolist(), strict=True)]


def degrees_of(words: IsoWords, scale_class: type[TickScale] = TickScale) -> TickScale:
    """Return how angles in degrees become written numbers."""
    return scale_class(
        unit=1.0,
        decimals=words.angle_decimals,
        feed_decimals=words.feed_decimals,
        point=words.point,
    )
