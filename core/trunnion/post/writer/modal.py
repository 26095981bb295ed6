"""The modal state of a text while it is written, and the words of a block: those alone that change."""

from __future__ import annotations

from trunnion.model.toolpath import Motion
from trunnion.post.iso_words import IsoWords
from trunnion.post.settings import PostSettings
from trunnion.post.ticks import TickScale
from trunnion.post.writer.arcs import CENTRES
from trunnion.post.writer.rotary import inverse_time

Block = tuple[list[int], list[int], int, float]
"""End point, centre, motion and feed in mm/min, as `WrittenPath.blocks` yields them."""


class WrittenState:
    """What the control knows at this line of the text. Positions, centres and angles are in ticks of their last decimal.

    `at` is the tip's place, None when it is not known; `angle` that of the rotary axes whose letters are `letters`, None before the first;
    `motion` -1 before the first; `feed` is as it was written, empty when it must be written again.
    """

    def __init__(self, words: IsoWords, settings: PostSettings, letters: str) -> None:
        self.words, self.letters = words, letters
        self.scale = TickScale.of(settings, words.extra_decimals_inch, words.feed_decimals)
        self.degrees = degrees_of(words)
        self.centre_words = CENTRES[words.centres]
        self.tool: int | None = None
        self.at: tuple[int, int, int] | None = None
        self.angle: list[int] | None = None
        self.motion, self.feed, self.coolant = -1, "", "off"
        self.inverse = False

    def reached(self, point: list[int], angle: list[int], motion: int) -> None:
        """Take over where a block ends and how it went."""
        self.at, self.angle, self.motion = (point[0], point[1], point[2]), angle, motion

    def block(self, block: Block, angle: list[int], minutes: float) -> str:
        """Return the words of a block that ends with the rotary axes at `angle`: only what changes, but both ends of an arc's plane.

        `minutes` above 0 are how long a block takes that is fed in inverse time.
        """
        point, centre, motion, feed = block
        text, (x, y, z) = self.scale.text, self.at or (0, 0, 0)
        arc, fed = motion >= Motion.ARC_CW, motion != Motion.RAPID
        parts = []
        if fed and (minutes > 0.0) != self.inverse:
            parts.append(self.switched())
        if motion != self.motion:
            parts.append(self.words.motions[motion])
        if arc or point[0] != x:
            parts.append("X" + text(point[0]))
        if arc or point[1] != y:
            parts.append("Y" + text(point[1]))
        if point[2] != z:
            parts.append("Z" + text(point[2]))
        if angle != self.angle:
            parts += self.turned(angle)
        if arc:
            i, j = self.centre_words(centre, x, y)
            parts += ["I" + text(i), "J" + text(j)]
        if minutes > 0.0:
            parts.append("F" + inverse_time(minutes))
        elif fed and (said := self.scale.feed(feed)) != self.feed:
            parts.append("F" + said)
            self.feed = said
        self.at, self.angle, self.motion = (point[0], point[1], point[2]), angle, motion
        return " ".join(parts)

    def switched(self) -> str:
        """Return the word that switches between inverse time and feeds a minute; the feed must be written again after it."""
        self.inverse, self.feed = not self.inverse, ""
        return self.words.inverse_time if self.inverse else self.words.per_minute

    def turned(self, angle: list[int]) -> list[str]:
        """Return the words of the rotary axes that turn."""
        before = self.angle or angle
        return [
            letter + self.degrees.text(v)
            for letter, v, old in zip(self.letters, angle, before, strict=True)
            if v != old
        ]


def degrees_of(words: IsoWords) -> TickScale:
    """Return how angles in degrees become written numbers."""
    return TickScale(unit=1.0, decimals=words.angle_decimals, feed_decimals=words.feed_decimals)
