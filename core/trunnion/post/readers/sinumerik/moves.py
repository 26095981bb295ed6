"""What the positions of a Sinumerik text make the tool do: in tilted planes, under TRAORI, along helices of several turns, in cycles."""

from __future__ import annotations

import math

from trunnion.findings import BadInput
from trunnion.model.motion.toolpath import Motion
from trunnion.model.spindle import FeedMode, per_minute
from trunnion.model.tool import AnyTool
from trunnion.post.readers.hole_strokes import HoleStroke
from trunnion.post.readers.numbers import NumberRange
from trunnion.post.readers.sections import NOWHERE, CuttingState, Pace, Point
from trunnion.post.readers.sinumerik.cycles import CycleCall
from trunnion.post.readers.tip_moves import TipMover
from trunnion.post.readers.word_address.blocks import Block

TURNS = NumberRange(0.0, 999.0, "turns")
"""Whole turns of a helix before its last one (TURN=)."""


class SinumerikMover(TipMover):
    """Moves the tool of a Sinumerik text."""

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
