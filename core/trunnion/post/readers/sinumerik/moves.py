"""What the positions of a Sinumerik text make the tool do: in tilted planes, under TRAORI, along helices of several turns, in cycles."""

from __future__ import annotations

import math

import numpy as np

from trunnion.findings import BadInput
from trunnion.model.motion.toolpath import Motion
from trunnion.model.spindle import FeedMode, per_minute
from trunnion.model.tool import AnyTool
from trunnion.post.readers.numbers import NumberRange
from trunnion.post.readers.sections import NOWHERE, CuttingState, Pace, Point
from trunnion.post.readers.sinumerik.cycles import CycleCall, HoleStroke
from trunnion.post.readers.sinumerik.directions import Directions
from trunnion.post.readers.tilted_sections import TiltedSections
from trunnion.post.readers.word_address.blocks import Block
from trunnion.post.readers.word_address.moves import ToolMover

TURNS = NumberRange(0.0, 999.0, "turns")
"""Whole turns of a helix before its last one (TURN=)."""


class SinumerikMover(ToolMover):
    """Moves the tool of a Sinumerik text."""

    @property
    def at(self) -> Point | None:
        """Where the tool is, in the plane in force."""
        sections = self.state.sections
        return sections.local if isinstance(sections, TiltedSections) else sections.at

    def move(self, block: Block) -> None:
        """Move as the words and the modal motion say; the rotary axes of the machine by themselves at its top alone."""
        if isinstance(self.rotary, Directions):
            if any(letter in block.words for letter in self.language.rotary):
                self.turn_axes(block)
                return
            self.rotary.check(block)
            if self.language.machine in block.codes and self.rotary.sections.follows:
                raise BadInput(
                    f"line {block.line}: {self.language.machine} under TRAORI is not understood; put TRAFOOF first"
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
                f"use {' '.join(self.language.directions)} under TRAORI"
            )
        missing = [letter for letter in letters if letter not in block.words]
        if missing:
            raise BadInput(
                f"line {line}: give {' and '.join(missing)} too, so that it is known where the rotary axes stand"
            )
        work_position = sections.interpreter.work_position  # type: ignore[attr-defined]
        sections.turned_away(np.radians([block.words[letter] for letter in letters]), work_position)

    def first_target(self, block: Block, motion: Motion, tool: AnyTool) -> Point | None:
        """Return the end of a move after a tool change; under TRAORI it says all of X, Y and Z."""
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
            raise BadInput(f"line {line}: a move without the tool's length; put D1 first")
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
                    f"line {block.line}: an arc of a tool that leans or turns is not understood; write lines, or use CYCLE800"
                )
        return point

    def check_turns(self, block: Block) -> None:
        """Raise `BadInput` for turns of a helix that are no whole number, or fed in inverse time."""
        turns = block.words.get(self.language.turns, 0.0)
        TURNS.check(block.line, self.language.turns, turns)
        if turns != int(turns) or (turns and self.state.feed_mode is FeedMode.INVERSE):
            raise BadInput(
                f"line {block.line}: {self.language.turns}{turns:g} must be a whole number, and not in inverse time (G93)"
            )

    def feed(
        self, block: Block, motion: Motion, point: Point, centre: Point, tool: AnyTool
    ) -> None:
        """Add a feed move; a helix turn by turn, at one climb all along."""
        turns, start = int(block.words.get(self.language.turns, 0.0)), self.at
        if turns and motion < Motion.ARC_CW:
            raise BadInput(f"line {block.line}: {self.language.turns} without an arc; remove it")
        if turns and start is not None:
            first = math.atan2(start[1] - centre[1], start[0] - centre[0])
            last = math.atan2(point[1] - centre[1], point[0] - centre[0])
            rest = (last - first) * (1.0 if motion == Motion.ARC_CCW else -1.0) % math.tau
            rest = math.tau if start[:2] == point[:2] else rest
            climb = (point[2] - start[2]) / (turns * math.tau + rest) * math.tau
            for k in range(1, turns + 1):
                end = (*start[:2], start[2] + k * climb, *point[3:])
                super().feed(block, motion, end, (*centre[:2], start[2] + (k - 1) * climb), tool)
        super().feed(block, motion, point, centre, tool)

    def cut_cycle(self, block: Block, cycle: CycleCall) -> None:
        """Cut a hole where the tool is as a cycle says."""
        state, line, start = self.state, block.line, self.at
        tool = self.ready(line)
        if start is None or not state.length_on:
            raise BadInput(
                f"line {line}: a cycle before it is known where the tool is; begin with a rapid to X, Y and Z"
            )
        if (
            state.in_zx
            or state.feed_mode is FeedMode.INVERSE
            or start[3:] not in ((), (0.0, 0.0, 1.0))
        ):
            raise BadInput(
                f"line {line}: {cycle.name} while the work turns, in inverse time or with a leaning tool is not understood; "
                "use CYCLE800, or write the moves out"
            )
        own_feeds = all(s.feed for s in cycle.strokes if s.feed is not None)
        feed, state.feed = state.feed, state.feed or float(own_feeds)
        self.check_feed(line, tool)
        state.feed = feed
        cutting = state.cutting()
        if cycle.spindle:
            cutting = CuttingState(cycle.spindle, cutting.coolant)
        for n, stroke in enumerate(cycle.strokes):
            point = (
                start[0] + stroke.shift[0],
                start[1] + stroke.shift[1],
                stroke.height,
                *start[3:],
            )
            if n == 0 and point == self.at:
                continue
            if stroke.feed is None:
                state.sections.rapid(line, point, tool, cutting)
            else:
                pace = self.cycle_pace(block, stroke, point, bool(cycle.spindle))
                state.sections.feed(line, Motion.LINE, point, NOWHERE, pace, tool, cutting)
            if stroke.dwell > 0.0:
                state.sections.dwell(stroke.dwell)

    def cycle_pace(self, block: Block, stroke: HoleStroke, end: Point, by_pitch: bool) -> Pace:
        """Return how fast a stroke is fed: at its own feed, in the mode in force, else at the program's."""
        if not stroke.feed:
            return self.pace(block, end)
        if by_pitch or self.state.feed_mode is FeedMode.MINUTE:
            return Pace(stroke.feed)
        return Pace(per_minute(stroke.feed, self.state.turns_at(end[0])), mode=FeedMode.REVOLUTION)
