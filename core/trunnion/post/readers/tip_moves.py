"""What positions make a tool do on a control that follows the tip: in tilted planes, and with directions as vectors."""

from __future__ import annotations

import numpy as np

from trunnion.findings import BadInput
from trunnion.model.motion.toolpath import Motion
from trunnion.model.tool import AnyTool
from trunnion.post.readers.directions import Directions
from trunnion.post.readers.sections import Point
from trunnion.post.readers.word_address.blocks import Block
from trunnion.post.readers.word_address.moves import ToolMover


class TipMover(ToolMover):
    """Moves the tool of a text whose control follows the tip and tilts its plane; on three axes as `ToolMover` does."""

    def move(self, block: Block) -> None:
        """Move as the words and the modal motion say; the rotary axes of the machine by themselves at its top alone."""
        if isinstance(self.rotary, Directions):
            if not block.words.keys().isdisjoint(self.language.rotary):
                self.turn_axes(block)
                return
            self.rotary.check(block)
            if self.language.machine in block.codes and self.rotary.sections.follows:
                raise BadInput(
                    f"line {block.line}: {self.language.machine} under {self.rotary.begins} is not understood; "
                    f"put {self.language.words.no_tip_control} first"
                )
        super().move(block)

    def turn_axes(self, block: Block) -> None:
        """Turn the machine's own rotary axes: a rapid of them alone at the top of the machine."""
        assert isinstance(self.rotary, Directions)
        sections, line, letters = self.rotary.sections, block.line, self.language.rotary
        others = set(block.words) - set(letters) - {"N"}
        if (
            sections.follows
            or sections.at is not None
            or others
            or self.state.motion != Motion.RAPID
        ):
            raise BadInput(
                f"line {line}: {' and '.join(letters)} are understood in a rapid of their own at the top of the machine; elsewhere "
                f"use {' '.join(self.language.directions)} under {self.rotary.begins}"
            )
        missing = [letter for letter in letters if letter not in block.words]
        if missing:
            raise BadInput(
                f"line {line}: give {' and '.join(missing)} too, so that it is known where the rotary axes stand"
            )
        work_position = sections.interpreter.work_position  # type: ignore[attr-defined]
        sections.turned_away(np.radians([block.words[letter] for letter in letters]), work_position)

    def first_target(self, block: Block, motion: Motion, tool: AnyTool) -> Point | None:
        """Return the end of a move after a tool change; with tip control it says all of X, Y and Z."""
        if not isinstance(self.rotary, Directions):
            return super().first_target(block, motion, tool)
        if not self.rotary.sections.follows:
            self.rotary.refuse_lost(block.line)
            return super().first_target(block, motion, tool)
        words, line, unit = block.words, block.line, self.state.unit
        if motion != Motion.RAPID or any(letter not in words for letter in "XYZ"):
            raise BadInput(
                f"line {line}: it is not known where the tool is; begin with a rapid to X, Y and Z in one line"
            )
        if not self.state.length_on:
            raise BadInput(
                f"line {line}: a move without the tool's length; put {self.language.length_of(tool)} first"
            )
        direction = self.rotary.turned(words)
        if not self.rotary.turns(words):
            self.rotary.refuse_lost(line)
        return (*(words[letter] * unit for letter in "XYZ"), *direction)

    def target(self, block: Block, motion: Motion, tool: AnyTool) -> Point | None:
        """Return the end of a move; raise `BadInput` where it is not known which way the tool points."""
        is_known = self.at is not None
        if isinstance(self.rotary, Directions) and is_known and not self.rotary.turns(block.words):
            self.rotary.refuse_lost(block.line)
        point = super().target(block, motion, tool)
        if motion >= Motion.ARC_CW and point is not None and self.at is not None:
            upright = (0.0, 0.0, 1.0)
            if len(point) > 3 and (point[3:] != upright or self.at[3:] != upright):
                raise BadInput(
                    f"line {block.line}: an arc of a tool that leans or turns is not understood; write lines, "
                    f"or use {getattr(self.rotary, 'tilts', '')}"
                )
        return point
