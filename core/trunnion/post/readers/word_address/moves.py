"""What the positions of a text make the tool do, by the modal state of the control."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from trunnion.findings import BadInput
from trunnion.model.motion.cycle import Cycle, Expansion, expanded
from trunnion.model.motion.toolpath import Motion
from trunnion.model.spindle import FeedMode, per_minute
from trunnion.model.tool import AnyTool
from trunnion.post.readers.numbers import FEED
from trunnion.post.readers.sections import NOWHERE, Pace, Point
from trunnion.post.readers.word_address.arcs import centre_by_offset, centre_by_radius
from trunnion.post.readers.word_address.blocks import Block
from trunnion.post.readers.word_address.cycles import UP, hole_of, path_over
from trunnion.post.readers.word_address.language import ControlLanguage, listed
from trunnion.post.readers.word_address.position_lines import PositionLines, end_of
from trunnion.post.readers.word_address.rotary import Rotary
from trunnion.post.readers.word_address.state import ModalCycle, ModalState

Offset = Callable[[float | None, float | None, Point], tuple[float, float]]
"""Returns how far the centre of an arc lies from its start, by I and J in mm and the start."""


def from_start(i: float | None, j: float | None, start: Point) -> tuple[float, float]:
    """Return I and J that count from the start of the arc; one that is missing is 0."""
    return i or 0.0, j or 0.0


def absolute(i: float | None, j: float | None, start: Point) -> tuple[float, float]:
    """Return the vector to a centre whose I and J count from the zero of the work offset; one that is missing is that of the start."""
    return (0.0 if i is None else i - start[0]), (0.0 if j is None else j - start[1])


OFFSETS: dict[str, Offset] = {"start": from_start, "absolute": absolute}
"""By what `IsoWords.centres` says."""


class ToolMover:
    """Moves the tool; the motions go to the sections of the state."""

    def __init__(self, language: ControlLanguage, state: ModalState, rotary: Rotary) -> None:
        self.language, self.state, self.rotary = language, state, rotary
        self.offset = OFFSETS[language.words.centres]

    @property
    def at(self) -> Point | None:
        """Where the tool is as the text counts it; None while that is not known."""
        return self.state.sections.local

    def move(self, block: Block) -> None:
        """Move as the words and the modal motion say."""
        state, line = self.state, block.line
        if self.language.machine in block.codes:
            self.machine_move(block)
            return
        if state.cycle is not None:
            self.drill(block, state.cycle)
            return
        motion = state.motion
        if motion is None:
            raise BadInput(f"line {line}: a position without {listed(self.language.motions)}")
        tool = self.ready(line)
        self.check_letters(block)
        point = self.target(block, motion, tool)
        if point is None:
            return
        if motion == Motion.RAPID:
            state.sections.rapid(line, point, tool, state.cutting())
            return
        self.check_feed(line, tool)
        centre: Point = NOWHERE
        if motion != Motion.LINE:
            centre = self.centre(block, motion, point)
            centre = (centre[1], 0.0, centre[0]) if state.in_zx else centre
        self.feed(block, motion, point, centre, tool)

    def straight(self) -> PositionLines | None:
        """Return what moves by lines of a position alone just as `move` does, until a line changes the modal state; None where `move` must
        look at each of them, or refuses them. A class whose `move` does more with them returns None."""
        state = self.state
        fed = state.motion == Motion.LINE
        if (
            not (fed or state.motion == Motion.RAPID)
            or (fed and state.feed_mode is not FeedMode.MINUTE)
            or state.in_zx
            or state.cycle is not None
            or self.rotary.letters
            or self.at is None
            or not state.length_on
        ):
            return None
        try:
            tool = self.ready(0)
            if fed:
                self.check_feed(0, tool)
        except BadInput:
            return None
        return PositionLines(
            sections=state.sections,
            rotary=self.rotary,
            tool=tool,
            cutting=state.cutting(),
            pace=Pace(state.feed) if fed else None,
            units=(state.x_unit, state.unit, state.unit),
        )

    def feed(
        self, block: Block, motion: Motion, point: Point, centre: Point, tool: AnyTool
    ) -> None:
        """Add a feed move."""
        state = self.state
        state.sections.feed(
            block.line, motion, point, centre, self.pace(block, point), tool, state.cutting()
        )

    def check_feed(self, line: int, tool: AnyTool) -> None:
        """Raise `BadInput` where a tool would feed without a turning spindle or a feed."""
        state = self.state
        if tool.locked != state.locked:
            raise BadInput(f"line {line}: {self.wrong_spindle(tool)}")
        if not (state.turning or state.locked):
            raise BadInput(
                f"line {line}: a feed move while the spindle stands; give S and {self.language.spindle} first"
            )
        if state.feed <= 0.0:
            raise BadInput(f"line {line}: a feed move without a feed; give F")
        if state.keeps_surface and tool.rotates:
            raise BadInput(
                f"line {line}: a constant surface speed with T{tool.number}, a tool that rotates; give the spindle speed"
            )

    def wrong_spindle(self, tool: AnyTool) -> str:
        """Return what to do where the spindle is locked for a tool that turns in it, or is not for one that must stand."""
        lock = self.language.locked_spindle
        if not tool.locked:
            return f"a feed move of T{tool.number} in a locked spindle; give S and {self.language.spindle} first"
        where = f"put {lock} first" if lock else "this control has no word for that"
        return f"T{tool.number} is a turning insert and cuts in a locked spindle; {where}"

    def drill(self, block: Block, mode: ModalCycle) -> None:
        """Drill a hole as the cycle in force says."""
        state, line, start = self.state, block.line, self.at
        tool = self.ready(line)
        if start is None or not state.length_on:
            raise BadInput(
                f"line {line}: a cycle before it is known where the tool is; begin with a rapid to X, Y and Z"
            )
        if state.in_zx:
            raise BadInput(
                f"line {line}: {mode.code} while the work turns is not understood; write the moves out"
            )
        if state.feed_mode is FeedMode.INVERSE or self.rotary.turns(block.words):
            raise BadInput(
                f"line {line}: a cycle with {self.language.inverse} or a turning axis is not understood; write the moves out"
            )
        self.check_feed(line, tool)
        cycle, top = hole_of(block, mode, state, self.language, start)
        over = self.path_to_hole(mode, start, top, cycle)
        for end in over:
            state.sections.rapid(line, (*end, *start[3:]), tool, state.cutting())
        plain = self.expansion(cycle, (over or [start])[-1], top)
        pace = self.pace(block, (*top, *start[3:]))
        for end, rapid, dwell in zip(
            plain.position.tolist(), plain.rapid, plain.dwell, strict=True
        ):
            point = (*end, *start[3:])
            if rapid:
                state.sections.rapid(line, point, tool, state.cutting())
            else:
                state.sections.feed(line, Motion.LINE, point, NOWHERE, pace, tool, state.cutting())
            if dwell > 0.0:
                state.sections.dwell(dwell)

    def path_to_hole(self, mode: ModalCycle, start: Point, top: Point, cycle: Cycle) -> list[Point]:
        """Return the ends of the rapids that bring a tool over a hole, mm."""
        return path_over(mode, start, top, cycle)

    def expansion(self, cycle: Cycle, start: Point, top: Point) -> Expansion:
        """Return the moves of a cycle from a start, on a hole whose axis meets the retract plane at `top`."""
        return expanded(cycle, np.array(start[:3]), np.array(top), UP)

    def pace(self, block: Block, end: Point) -> Pace:
        """Return how fast a block is fed that ends at a point."""
        state = self.state
        if state.feed_mode is FeedMode.REVOLUTION:
            return self.by_revolution(block, end)
        if state.feed_mode is FeedMode.INVERSE or self.rotary.letters:
            return self.rotary.pace(block, state, end)
        return Pace(state.feed)

    def by_revolution(self, block: Block, end: Point) -> Pace:
        """Return how fast a block is fed whose feed is given by the revolution; raise `BadInput` where that is no feed."""
        state, start = self.state, self.at
        turns = state.turns_at(end[0])
        if turns <= 0.0:
            raise BadInput(
                f"line {block.line}: a feed by the revolution while the spindle stands; give S"
            )
        if start is not None and start[3:] != end[3:]:
            raise BadInput(
                f"line {block.line}: a feed by the revolution while {' or '.join(self.rotary.letters)} turns is not understood; "
                f"use {self.language.inverse}"
            )
        feed = per_minute(state.feed, turns)
        FEED.check(block.line, f"at S{turns:g} a feed a minute of ", feed / state.unit)
        return Pace(feed, mode=FeedMode.REVOLUTION)

    @property
    def arc_letters(self) -> str:
        """The letters of an arc as a sentence lists them."""
        return listed(("I", "J", self.language.radius))

    def ready(self, line: int) -> AnyTool:
        """Return the tool when the control knows all it needs for a move in the work offset."""
        state = self.state
        if state.tool is None:
            raise BadInput(
                f"line {line}: a move before a tool is in the spindle; put {self.language.spoken_change} first"
            )
        if not state.units_given:
            raise BadInput(
                f"line {line}: a move before its unit is said; put {' or '.join(self.language.units)} first"
            )
        if not state.offset:
            raise BadInput(
                f"line {line}: a move before its work offset is said; put {state.setup.work_offset} first"
            )
        self.check_plane(line, state.tool)
        return state.tool

    def check_plane(self, line: int, tool: AnyTool) -> None:
        """Raise `BadInput` for a tool that rotates in the plane of turning, or one that stands still in another."""
        language, state = self.language, self.state
        if tool.rotates and state.in_zx:
            raise BadInput(
                f"line {line}: {language.turning_plane} with T{tool.number}, a tool that rotates; "
                f"arcs in the plane ZX are of turning, use {language.milling_plane}"
            )
        if not tool.rotates and not (state.in_zx and language.turns_work):
            raise BadInput(
                f"line {line}: T{tool.number} is a turning tool; "
                + (
                    f"put {language.turning_plane} first"
                    if language.turns_work
                    else "this control turns no work here"
                )
            )

    def check_letters(self, block: Block) -> None:
        """Raise `BadInput` for letters that are of another plane than the one in force."""
        strange = [
            letter for letter in ("YJ" if self.state.in_zx else "K") if letter in block.words
        ]
        if strange:
            raise BadInput(
                f"line {block.line}: {strange[0]} while {'the work turns' if self.state.in_zx else 'arcs are in XY'}; "
                f"it is not of the plane {'ZX' if self.state.in_zx else 'XY'}"
            )

    def target(self, block: Block, motion: Motion, tool: AnyTool) -> Point | None:
        """Return the end of a move; None for a rapid in XY while the tool is still above everything at an unknown height."""
        words, state, language = block.words, self.state, self.language
        if motion < Motion.ARC_CW and not language.arc.isdisjoint(words):
            arcs = listed(language.words.motions[Motion.ARC_CW :])
            raise BadInput(
                f"line {block.line}: {self.arc_letters} without an arc; put {arcs} first"
            )
        if language.retract != language.radius and language.retract in words:
            raise BadInput(
                f"line {block.line}: {language.retract} without {listed(language.cycles)}; remove it"
            )
        at, unit = self.at, state.unit
        if at is None:
            return self.first_target(block, motion, tool)
        angle = self.rotary.turned(words)
        if angle:
            self.rotary.refuse_far_turn(block.line, at[3:], angle)
        if not state.length_on:
            raise BadInput(
                f"line {block.line}: a move without the tool's length; put {language.length_of(tool)} first"
            )
        return end_of(words, at, (state.x_unit, unit, unit), angle)

    def first_target(self, block: Block, motion: Motion, tool: AnyTool) -> Point | None:
        """Return the end of a move after a tool change, once X, Y and Z are known; None until then."""
        words, state, rotary, line = block.words, self.state, self.rotary, block.line
        if motion != Motion.RAPID:
            raise BadInput(
                f"line {line}: a feed move before it is known where the tool is; begin with a rapid to X, Y and Z"
            )
        if "Z" in words and rotary.turns(words):
            raise BadInput(
                f"line {line}: turn {' and '.join(rotary.letters)} at the top of the machine, in a line before Z comes down"
            )
        angle = rotary.turned(words)
        x, y = words.get("X"), 0.0 if state.in_zx and "X" in words else words.get("Y")
        if x is not None and y is not None:
            state.over = (x * state.x_unit, y * state.unit)
        elif (
            x is not None
            or y is not None
            or (state.over is None and ("Z" in words or not rotary.turns(words)))
        ):
            raise BadInput(
                f"line {line}: it is not known where the tool is; begin with a rapid to X, Y and Z"
            )
        if "Z" not in words or state.over is None:
            return None
        if not state.length_on:
            raise BadInput(
                f"line {line}: a move in Z without the tool's length; put {self.language.length_of(tool)} first"
            )
        rotary.refuse_lost(line)
        return (*state.over, words["Z"] * state.unit, *angle)

    def machine_move(self, block: Block) -> None:
        """Move in machine coordinates: only a rapid straight up to the top of the machine, Z0."""
        words, line, state = block.words, block.line, self.state
        if (
            state.motion != Motion.RAPID
            or words.get("Z") != 0.0
            or "X" in words
            or "Y" in words
            or self.rotary.turns(words)
        ):
            raise BadInput(
                f"line {line}: of {self.language.machine} only {self.language.words.top}, straight up to the top of the "
                "machine, is understood"
            )
        if state.tool is not None:
            state.sections.lift(line, state.tool, state.cutting())
        state.over = None

    def centre(self, block: Block, motion: Motion, end: Point) -> Point:
        """Return the centre of an arc at the height of its start; raise `BadInput` for one that the control could take for another."""
        words, line, start, radius = (
            block.words,
            block.line,
            self.at,
            self.language.radius,
        )
        assert start is not None
        i, j, unit = words.get("I"), words.get("J"), self.state.unit
        if self.state.in_zx:
            i, j = words.get("K"), i
            start, end = (start[2], start[0], 0.0), (end[2], end[0], 0.0)
        if radius in words:
            if i is not None or j is not None:
                raise BadInput(
                    f"line {line}: an arc with {radius} and with I or J; keep one of them"
                )
            return centre_by_radius(line, motion, start, end, words[radius] * unit, radius)
        if i is None and j is None:
            raise BadInput(f"line {line}: an arc without {self.arc_letters}")
        self.check_turns(block)
        offset = self.offset(
            None if i is None else i * unit, None if j is None else j * unit, start
        )
        return centre_by_offset(line, start, end, offset, radius)

    def check_turns(self, block: Block) -> None:
        """Raise `BadInput` for an arc of several turns."""
        if block.words.get(self.language.turns, 1.0) != 1.0:
            raise BadInput(
                f"line {block.line}: an arc of several turns ({self.language.turns}) is not understood; write each turn"
            )
