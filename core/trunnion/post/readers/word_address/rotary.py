"""Where the rotary axes stand while a text is read, and how long a block lasts in which they turn."""

from __future__ import annotations

import math
from collections.abc import Mapping

from trunnion.findings import BadInput
from trunnion.model.spindle import FeedMode
from trunnion.post.readers.numbers import MOST_TURN
from trunnion.post.readers.sections import Pace, Point
from trunnion.post.readers.word_address.blocks import Block
from trunnion.post.readers.word_address.state import ModalState
from trunnion.units import LONGEST_BLOCK, SECONDS_PER_MINUTE


class Rotary:
    """The rotary axes of a machine by their `letters`, "" on three axes; `angle` in degrees, NaN while it is not known."""

    def __init__(self, letters: str, inverse: str) -> None:
        self.letters, self.inverse = letters, inverse
        self.angle = [math.nan] * len(letters)

    def turns(self, words: Mapping[str, float]) -> bool:
        """Return whether a line has a word of a rotary axis."""
        return not words.keys().isdisjoint(self.letters)

    def turned(self, words: Mapping[str, float]) -> list[float]:
        """Return where the axes stand after a line."""
        if self.letters and self.turns(words):
            self.angle = [
                words.get(letter, angle)
                for letter, angle in zip(self.letters, self.angle, strict=True)
            ]
        return self.angle

    def step(self, block: Block, before: Point) -> list[float]:
        """Return where the axes stand after a line, from where they stood; raise `BadInput` for a turn that is not understood."""
        angle = self.turned(block.words)
        self.refuse_far_turn(block.line, before, angle)
        return angle

    def refuse_far_turn(self, line: int, before: Point, after: list[float]) -> None:
        """Raise `BadInput` for a turn in one block of more than the proof looks at."""
        for letter, first, last in zip(self.letters, before, after, strict=True):
            if abs(last - first) > MOST_TURN:
                raise BadInput(
                    f"line {line}: {letter} turns by {abs(last - first):.10g} degrees in one block, at most "
                    f"{MOST_TURN:g} are understood; write several"
                )

    def refuse_lost(self, line: int) -> None:
        """Raise `BadInput` while it is not known where an axis stands."""
        lost = [letter for letter, v in zip(self.letters, self.angle, strict=True) if math.isnan(v)]
        if lost:
            raise BadInput(
                f"line {line}: it is not known where {' and '.join(lost)} stand; begin with a rapid that says so"
            )

    def pace(self, block: Block, state: ModalState, end: Point) -> Pace:
        """Return how fast a block is fed, with its minutes where they are what is given: in inverse time, or where rotary axes turn.

        In units a minute the control feeds along X, Y and Z, and by degrees where none of them moves.
        """
        start = state.sections.at
        if state.feed_mode is FeedMode.INVERSE:
            if "F" not in block.words:
                raise BadInput(
                    f"line {block.line}: a feed move in inverse time ({self.inverse}) needs an F word of its own"
                )
            return Pace(state.feed, 1.0 / state.feed, FeedMode.INVERSE)
        if start is None or start[3:] == end[3:]:
            return Pace(state.feed)
        length = math.dist(start[:3], end[:3])
        minutes = (
            length / state.feed
            if length > 0.0
            else math.dist(start[3:], end[3:]) / (state.feed / state.unit)
        )
        if minutes * SECONDS_PER_MINUTE > LONGEST_BLOCK:
            raise BadInput(
                f"line {block.line}: at this feed the block takes {minutes:.0f} min, no block takes more than "
                f"{LONGEST_BLOCK / SECONDS_PER_MINUTE:.0f}; check F"
            )
        return Pace(state.feed, minutes)
