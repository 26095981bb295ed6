"""The tool's direction while a text is read whose control follows the tip: vectors then, else along z of the plane in force."""

from __future__ import annotations

import math
from collections.abc import Mapping

from trunnion.findings import BadInput
from trunnion.model.spindle import FeedMode
from trunnion.post.readers.sections import Pace, Point
from trunnion.post.readers.tilted_sections import TiltedSections
from trunnion.post.readers.word_address.blocks import Block
from trunnion.post.readers.word_address.language import ControlLanguage
from trunnion.post.readers.word_address.rotary import Rotary
from trunnion.post.readers.word_address.state import ModalState

LEAST_VECTOR = 1e-3
"""A vector shorter than this says no direction: its decimals would be all there is."""
_UPRIGHT = [0.0, 0.0, 1.0]


class Directions(Rotary):
    """Unit vectors in place of angles; `begins` is the code by which the control follows the tip, `tilts` that of a plane."""

    def __init__(self, sections: TiltedSections, language: ControlLanguage) -> None:
        super().__init__("", language.inverse)
        self.sections, self.words = sections, language.directions
        self.begins, self.tilts = (
            next((code for code, m in language.meanings.items() if m == meaning), "")
            for meaning in ("tip control", "plane")
        )

    def turns(self, words: Mapping[str, float]) -> bool:
        """Return whether a line has a word of a direction."""
        return not words.keys().isdisjoint(self.words)

    def turned(self, words: Mapping[str, float]) -> list[float]:
        """Return the direction after a line, in the plane in force; a number of the vector that is left out is 0."""
        if self.sections.follows and self.turns(words):
            vector = [words.get(word, 0.0) for word in self.words]
            length = math.hypot(*vector)
            return [v / length for v in vector]
        if self.sections.follows:
            axis = self.sections.axis
            return [math.nan] * 3 if axis is None else list(axis)
        return list(_UPRIGHT)

    def step(self, block: Block, before: Point) -> list[float]:
        """Return the direction after a line; see `Rotary`."""
        words = block.words
        if not self.turns(words):
            self.refuse_lost(block.line)
            return self.turned(words)
        x, y, z = [words.get(word, 0.0) for word in self.words]
        length = math.hypot(x, y, z)
        if not self.sections.follows or length < LEAST_VECTOR:
            self.check(block)
        angle = [x / length, y / length, z / length]
        self.refuse_far_turn(block.line, before, angle)
        return angle

    def check(self, block: Block) -> None:
        """Raise `BadInput` for directions that are none, or that nothing follows."""
        if not self.turns(block.words):
            return
        listed = " ".join(self.words)
        if not self.sections.follows:
            raise BadInput(
                f"line {block.line}: {listed} without {self.begins}; put {self.begins} first"
            )
        if math.hypot(*(block.words.get(word, 0.0) for word in self.words)) < LEAST_VECTOR:
            raise BadInput(
                f"line {block.line}: {listed} is no direction; give a vector of length 1"
            )

    def refuse_far_turn(self, line: int, before: Point, after: list[float]) -> None:
        """Raise `BadInput` for a turn straight back: there is no one plane to turn in."""
        if math.dist(before, [-v for v in after]) < LEAST_VECTOR:
            raise BadInput(f"line {line}: the tool turns straight back in one block; write several")

    def refuse_lost(self, line: int) -> None:
        """Raise `BadInput` while it is not known where the tool points."""
        sections = self.sections
        if sections.follows and sections.axis is None:
            raise BadInput(
                f"line {line}: it is not known where the tool points; begin with a rapid that has {' '.join(self.words)}"
            )
        if not sections.follows and not sections.known:
            raise BadInput(
                f"line {line}: it is not known where the rotary axes stand; put {self.tilts} with the plane, or {self.begins}, first"
            )

    def pace(self, block: Block, state: ModalState, end: Point) -> Pace:
        """Return how fast a block is fed: the tip at its feed, or in its time."""
        if state.feed_mode is FeedMode.INVERSE:
            if "F" not in block.words:
                raise BadInput(
                    f"line {block.line}: a feed move in inverse time ({self.inverse}) needs an F word of its own"
                )
            return Pace(state.feed, 1.0 / state.feed, FeedMode.INVERSE)
        return Pace(state.feed)
