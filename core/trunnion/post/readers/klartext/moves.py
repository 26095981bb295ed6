"""What the blocks of a Klartext make the tool do: lines, arcs, helices, holes; in tilted planes and with the tool's direction."""

from __future__ import annotations

import math

import numpy as np

from trunnion.findings import BadInput
from trunnion.model.motion.toolpath import Motion
from trunnion.model.tool import AnyTool
from trunnion.post.klartext_words import KlartextWords
from trunnion.post.readers.directions import LEAST_VECTOR
from trunnion.post.readers.klartext.blocks import PathWords
from trunnion.post.readers.klartext.state import KlartextState
from trunnion.post.readers.numbers import FEED, LENGTH, NumberRange
from trunnion.post.readers.sections import NOWHERE, Pace, Point
from trunnion.post.readers.tilted_sections import TiltedSections, TipPoses
from trunnion.post.readers.word_address.arcs import (
    centre_by_offset,
    refuse_nearly_closed,
    refuse_no_radius,
)

AXES, ROTARY = ("X", "Y", "Z"), ("A", "B", "C")
ANGLE = NumberRange(-99_999.9999, 99_999.9999, "degrees")
HELIX = NumberRange(-5400.0, 5400.0, "degrees")
UP = (0.0, 0.0, 1.0)


class KlartextMover:
    """Moves the tool; the motions go to the sections of the state."""

    def __init__(self, words: KlartextWords, state: KlartextState) -> None:
        self.words, self.state = words, state

    @property
    def tilted(self) -> TiltedSections | None:
        """The sections of a machine with rotary axes, None on three axes."""
        sections = self.state.sections
        return sections if isinstance(sections, TiltedSections) else None

    @property
    def at(self) -> Point | None:
        """Where the tool is, in the plane in force."""
        tilted = self.tilted
        return self.state.sections.at if tilted is None else tilted.local

    @property
    def follows(self) -> bool:
        """Whether the control follows the tip."""
        return self.tilted is not None and self.tilted.follows

    def line(self, line: int, given: PathWords, is_vector: bool) -> None:
        """Go straight (`L`), or with a tool axis (`LN`)."""
        self.check(line, given)
        if given.turns:
            raise BadInput(f"line {line}: DR is of arcs; remove it")
        if "M91" in given.functions:
            self.to_top(line, given, is_vector)
            return
        if any(letter in given.numbers for letter in ROTARY):
            self.turn_axes(line, given)
            return
        if not given.numbers:
            if given.rapid or is_vector:
                raise BadInput(f"line {line}: a move to nowhere; give X, Y or Z")
            return
        tool = self.state.ready(line)
        direction = self.direction(line, given, is_vector)
        point = self.target(line, given, direction, tool)
        if point is None:
            return
        if given.rapid:
            self.state.sections.rapid(line, point, tool, self.state.cutting())
        else:
            self.feed(line, Motion.LINE, point, NOWHERE, tool)

    def check(self, line: int, given: PathWords) -> None:
        """Take over the feed; raise `BadInput` for numbers out of range."""
        for word, value in given.numbers.items():
            if word in AXES or word == "IZ":
                LENGTH.check(line, word, value)
            elif word in ROTARY:
                ANGLE.check(line, word, value)
        if given.feed is not None:
            FEED.check(line, "F", given.feed)
            self.state.feed = given.feed * self.state.feed_unit

    def direction(self, line: int, given: PathWords, is_vector: bool) -> Point:
        """Return the tool's direction after a block, in the plane in force; raise `BadInput` where it is none or not known."""
        tilted, listed = self.tilted, " ".join(self.words.directions)
        vector = [given.numbers.get(word) for word in self.words.directions]
        if not is_vector:
            if tilted is None:
                return ()
            if not tilted.follows:
                if not tilted.known:
                    raise BadInput(
                        f"line {line}: it is not known where the rotary axes stand; put PLANE SPATIAL, or FUNCTION TCPM, first"
                    )
                return UP
            if tilted.axis is None:
                raise BadInput(
                    f"line {line}: it is not known where the tool points; begin with LN and {listed}"
                )
            return tilted.axis
        x, y, z = vector
        if x is None or y is None or z is None:
            raise BadInput(f"line {line}: LN needs {listed}")
        if tilted is None or not tilted.follows:
            raise BadInput(
                f"line {line}: {listed} without tip control; put {self.words.tip_control[0]} first"
            )
        length = math.hypot(x, y, z)
        if length < LEAST_VECTOR:
            raise BadInput(f"line {line}: {listed} is no direction; give a vector of length 1")
        return (x / length, y / length, z / length)

    def target(self, line: int, given: PathWords, direction: Point, tool: AnyTool) -> Point | None:
        """Return the end of a move; None for a rapid in XY while the tool is still above everything at an unknown height."""
        state, at, unit = self.state, self.at, self.state.unit
        x, y, z = (
            given.numbers[letter] * unit if letter in given.numbers else None for letter in AXES
        )
        if at is not None:
            if (
                direction
                and self.follows
                and math.dist(at[3:], [-v for v in direction]) < LEAST_VECTOR
            ):
                raise BadInput(
                    f"line {line}: the tool turns straight back in one block; write several"
                )
            return (
                at[0] if x is None else x,
                at[1] if y is None else y,
                at[2] if z is None else z,
                *direction,
            )
        if not given.rapid:
            raise BadInput(
                f"line {line}: a feed move before it is known where the tool is; begin with a rapid to X, Y and Z"
            )
        if x is not None and y is not None:
            state.over = (x, y)
        elif x is not None or y is not None or state.over is None or self.follows:
            raise BadInput(
                f"line {line}: it is not known where the tool is; begin with a rapid to X, Y and Z"
            )
        if z is None and self.follows:
            raise BadInput(
                f"line {line}: it is not known where the tool is; begin with a rapid to X, Y and Z in one block"
            )
        return None if z is None else (*state.over, z, *direction)

    def to_top(self, line: int, given: PathWords, is_vector: bool) -> None:
        """Go straight up to the top of the machine: `L Z0 FMAX M91` alone, in no tilted plane and without tip control."""
        tilted = self.tilted
        if given.numbers != {"Z": 0.0} or not given.rapid or is_vector:
            raise BadInput(
                f"line {line}: of M91 only {self.words.top}, straight up to the top of the machine, is understood"
            )
        if self.follows:
            raise BadInput(
                f"line {line}: M91 under tip control is not understood; put {self.words.no_tip_control} first"
            )
        if tilted is not None and not tilted.level:
            raise BadInput(
                f"line {line}: M91 in a tilted plane is not understood; put {self.words.no_plane} first"
            )
        if self.state.tool is not None:
            self.state.sections.lift(line, self.state.tool, self.state.cutting())
        self.state.over = None

    def turn_axes(self, line: int, given: PathWords) -> None:
        """Turn the machine's own rotary axes: a rapid of them alone at the top of the machine."""
        tilted = self.tilted
        if tilted is None:
            raise BadInput(
                f"line {line}: A, B or C on {self.state.setup.machine}, a machine without rotary axes; remove it"
            )
        assert isinstance(tilted.interpreter, TipPoses)
        work_position = tilted.interpreter.work_position
        letters = list(work_position.names)
        if tilted.follows or tilted.at is not None or not given.rapid or not tilted.level:
            raise BadInput(
                f"line {line}: {' and '.join(letters)} are understood in a rapid of their own at the top of the machine; elsewhere "
                f"use LN under tip control"
            )
        if sorted(given.numbers) != sorted(letters):
            raise BadInput(
                f"line {line}: give {' and '.join(letters)} and nothing else, so that it is known where the rotary axes stand"
            )
        angles = np.radians([given.numbers[letter] for letter in letters])
        tilted.turned_away(angles, work_position)

    def set_pole(self, line: int, given: PathWords) -> None:
        """Take over the centre of the arcs that follow (`CC`)."""
        self.check(line, given)
        if sorted(given.numbers) != ["X", "Y"] or given.rapid or given.turns or given.functions:
            raise BadInput(f"line {line}: CC needs X and Y, and nothing else")
        unit = self.state.unit
        self.state.pole = (given.numbers["X"] * unit, given.numbers["Y"] * unit)

    def arc(self, line: int, given: PathWords) -> None:
        """Go along an arc about the last centre (`C`)."""
        tool, motion, start, pole = self.begun(line, given, "C")
        if "Z" in given.numbers or not given.numbers:
            raise BadInput(f"line {line}: C needs X or Y, and climbs not; use CP with IPA and IZ")
        point = self.target(line, given, start[3:], tool)
        assert point is not None
        offset = (pole[0] - start[0], pole[1] - start[1])
        centre = centre_by_offset(line, start, point, offset, "CC")
        self.feed(line, motion, point, centre, tool)

    def helix(self, line: int, given: PathWords) -> None:
        """Go round the last centre by an angle (`CP`), and up or down evenly; each turn is a block."""
        tool, motion, start, pole = self.begun(line, given, "CP")
        angle = given.numbers.get("IPA", 0.0)
        HELIX.check(line, "IPA", angle)
        if angle * given.turns <= 0.0:
            raise BadInput(f"line {line}: CP needs IPA, the angle it turns by, with the sign of DR")
        radius = math.dist(start[:2], pole)
        refuse_no_radius(line, radius, "CC")
        climb, whole = given.numbers.get("IZ", 0.0) * self.state.unit, int(abs(angle) // 360.0)
        rest = abs(angle) - 360.0 * whole
        for k in range(1, whole + 1):
            share = 360.0 * k / abs(angle)
            self.turned_to(
                line, motion, (*start[:2], start[2] + share * climb, *start[3:]), pole, tool
            )
        if rest > 0.0:
            turn = math.copysign(math.radians(rest), angle)
            c, s = math.cos(turn), math.sin(turn)
            x, y = start[0] - pole[0], start[1] - pole[1]
            end = (pole[0] + c * x - s * y, pole[1] + s * x + c * y, start[2] + climb)
            refuse_nearly_closed(line, start, end)
            self.turned_to(line, motion, (*end, *start[3:]), pole, tool)

    def turned_to(
        self, line: int, motion: Motion, point: Point, pole: tuple[float, float], tool: AnyTool
    ) -> None:
        """Add a turn of a helix, or a part of one."""
        at = self.at
        assert at is not None
        self.feed(line, motion, point, (*pole, at[2]), tool)

    def begun(
        self, line: int, given: PathWords, word: str
    ) -> tuple[AnyTool, Motion, Point, tuple[float, float]]:
        """Return tool, motion, start and centre of an arc; raise `BadInput` where one is missing or not known."""
        self.check(line, given)
        tool, start, pole = self.state.ready(line), self.at, self.state.pole
        if start is None:
            raise BadInput(
                f"line {line}: a feed move before it is known where the tool is; begin with a rapid to X, Y and Z"
            )
        if pole is None:
            raise BadInput(f"line {line}: {word} without a centre; put CC first")
        if given.rapid or not given.turns:
            raise BadInput(f"line {line}: {word} needs DR+ or DR-, and no FMAX")
        if self.tilted is not None:
            self.direction(line, given, is_vector=False)
            if start[3:] != UP:
                raise BadInput(
                    f"line {line}: an arc of a tool that leans is not understood; write lines, or use PLANE SPATIAL"
                )
        return tool, Motion.ARC_CCW if given.turns > 0 else Motion.ARC_CW, start, pole

    def feed(self, line: int, motion: Motion, point: Point, centre: Point, tool: AnyTool) -> None:
        """Add a feed move."""
        state = self.state
        state.check_feed(line, state.feed)
        state.sections.feed(line, motion, point, centre, Pace(state.feed), tool, state.cutting())

    def cut_cycle(self, line: int) -> None:
        """Cut a hole where the tool is, as the cycle in force says."""
        state, start = self.state, self.at
        tool = state.ready(line)
        if not state.cycle:
            raise BadInput(
                f"line {line}: a cycle is called, and none is defined; put CYCL DEF first"
            )
        if start is None:
            raise BadInput(
                f"line {line}: a cycle before it is known where the tool is; begin with a rapid to X, Y and Z"
            )
        if self.follows or start[3:] not in ((), UP):
            raise BadInput(
                f"line {line}: a cycle under tip control is not understood; use PLANE SPATIAL, or write the moves out"
            )
        self.direction(line, PathWords(), is_vector=False)
        cutting = state.cutting()
        for n, stroke in enumerate(state.cycle):
            point = (*start[:2], stroke.height, *start[3:])
            if n == 0 and point == self.at:
                continue
            if stroke.feed is None:
                state.sections.rapid(line, point, tool, cutting)
            else:
                state.check_feed(line, stroke.feed)
                pace = Pace(stroke.feed)
                state.sections.feed(line, Motion.LINE, point, NOWHERE, pace, tool, cutting)
            if stroke.dwell > 0.0:
                state.sections.dwell(stroke.dwell)
