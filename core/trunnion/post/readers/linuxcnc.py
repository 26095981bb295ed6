"""Reads LinuxCNC text, ours or edited by hand, into motions. What it doesn't understand it refuses with the line; nothing is skipped.

The order of work inside a line is LinuxCNC's own: feed, spindle speed, tool, spindle and coolant, units and offsets, motion, end.
On a machine with rotary axes the words are positions of its axes; what the tool does is reckoned from where the work stands.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence

from trunnion import tolerance
from trunnion.findings import BadInput
from trunnion.model.program import Program
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.model.toolpath import Motion
from trunnion.post.readers.arcs import centre_by_offset, centre_by_radius
from trunnion.post.readers.blocks import Block, split_line
from trunnion.post.readers.codes import KNOWN, MOTIONS, OFFSETS, letters_belong, one_of_a_group, why_not
from trunnion.post.readers.joints import Joints
from trunnion.post.readers.numbers import COUNT, DWELL, FEED, INVERSE_TIME, LENGTH, LINE_NUMBER, MOST_TURN, SPINDLE, Range
from trunnion.post.readers.sections import NOWHERE, Point, Sections, Upright
from trunnion.post.readers.tools import by_number, check_place, check_tool
from trunnion.shop.kinematics import SLACK, Place
from trunnion.units import LONGEST_BLOCK, MM_PER_INCH, SECONDS_PER_MINUTE

_OPERATION = re.compile(r"OPERATION\s+(\S+)$", re.IGNORECASE)
_RANGES = {**dict.fromkeys("XYZIJR", LENGTH), "T": COUNT, "H": COUNT, "N": LINE_NUMBER}
"""Ranges of the words whose numbers mean one thing; those of F, S, P and Q are checked where they are taken over."""
_PLAIN_LETTERS = frozenset("NFSTXYZIJRHPQ")


def read_linuxcnc(text: str, tools: Sequence[Tool], setup: Setup, place: Place | None = None) -> Program:
    """Return the motions of one setup's text, with the line of each block; raise `BadInput` naming the line of what isn't understood.

    `tools` are found by their T number; operations by our comments, else they are called `line N`. `place` says where the work stands on a
    machine with rotary axes.
    """
    control = _Control(by_number(tools), setup, place if place is not None and place.machine.rotary else None)
    for number, line in enumerate(text.split("\n"), 1):
        if line.strip() == "%":
            control.percent(number)
            continue
        block, comments = split_line(number, line)
        for comment in comments:
            if found := _OPERATION.match(comment):
                control.sections.operation(found.group(1))
            elif comment.startswith("TOOL "):
                check_tool(number, comment, control.tools)
            elif comment.startswith("STANDS "):
                check_place(number, comment, setup, control.place)
        if block is not None:
            control.run(block)
    if not control.ended:
        raise BadInput("the program has no end (M30 or M2): is the text complete?")
    return Program(name=setup.name, setup=setup, sections=control.sections.finished())


class _Control:
    """The modal state of the control while a text runs. Lengths are mm in the setup frame."""

    def __init__(self, tools: dict[int, Tool], setup: Setup, place: Place | None) -> None:
        self.tools, self.setup, self.place = tools, setup, place
        self.sections = Sections(Upright(setup.clearance) if place is None else Joints(place, setup.clearance))
        self.rotary = place.names if place else ""
        self.letters, self.angle = _PLAIN_LETTERS | set(self.rotary), [math.nan] * len(self.rotary)
        self.ranges = _RANGES | (_rotary_ranges(place) if place else {})
        self.known = KNOWN | ({"G93"} if place else set())
        self.inverse = False
        self.over: tuple[float, float] | None = None
        self.unit, self.offset, self.last_n = 1.0, "", -1.0
        self.motion: Motion | None = None
        self.tool: Tool | None = None
        self.next_tool: Tool | None = None
        self.length_on = self.turning = self.ended = self.units_said = self.begun = self.speed_said = False
        self.feed = self.spindle = 0.0
        self.coolant = "off"

    def percent(self, line: int) -> None:
        """Take a line of %: the first opens the text, the next ends it."""
        if self.begun and not self.ended:
            raise BadInput(f"line {line}: a % in the middle of the program ends it there; remove it")
        self.begun = True

    def run(self, block: Block) -> None:
        """Do what one line says, in LinuxCNC's order."""
        words, codes = block.words, block.codes
        self.begun = True
        self.check(block)
        if len(codes) > (1 if codes and codes[0] in MOTIONS else 0):
            self.modes(block)
        elif "F" in words or "S" in words or "T" in words:
            self.speeds(block)
        if codes and codes[0] in MOTIONS and len(codes) == 1:
            self.motion = MOTIONS[codes[0]]
        if "X" in words or "Y" in words or "Z" in words or "I" in words or "J" in words or "R" in words or self.turns(words):
            self.move(block)
        if "M30" in codes or "M2" in codes:
            self.ended = True

    def turns(self, words: Mapping[str, float]) -> bool:
        """Say whether a line has a word of a rotary axis."""
        return any(letter in words for letter in self.rotary)

    def check(self, block: Block) -> None:
        """Refuse what can't be understood or stands in a wrong place."""
        line, words, codes = block.line, block.words, block.codes
        if self.ended:
            raise BadInput(f"line {line}: stands after the end of the program; remove it or the M30 before it")
        for code in codes:
            if code not in self.known:
                raise BadInput(f"line {line}: {why_not(code)}")
        self.check_words(line, words)
        if len(codes) > 1:
            one_of_a_group(line, codes)
        letters_belong(block)

    def check_words(self, line: int, words: Mapping[str, float]) -> None:
        """Refuse letters that no word of this program begins with, numbers out of range, and lines out of order."""
        for letter, value in words.items():
            if letter not in self.letters:
                axes = f"a program for the axes XYZ{self.rotary}" if self.rotary else "a three-axis program"
                raise BadInput(f"line {line}: the word {letter} is not understood by {axes}; remove it")
            if letter in self.ranges:
                self.ranges[letter].check(line, letter, value)
        n = words.get("N")
        if n is not None:
            if n <= self.last_n:
                raise BadInput(f"line {line}: N{n:.10g} comes after N{self.last_n:.10g}: lines are out of order; put them back or renumber "
                               "them")
            self.last_n = n

    def speeds(self, block: Block) -> None:
        """Take over F, S and T."""
        line, words = block.line, block.words
        if "F" in words:
            if words["F"] <= 0.0:
                raise BadInput(f"line {line}: the feed F must be above zero")
            (INVERSE_TIME if self.inverse else FEED).check(line, "F", words["F"])
            self.feed = words["F"] if self.inverse else words["F"] * self.unit
        if "S" in words:
            if words["S"] < 0.0:
                raise BadInput(f"line {line}: the spindle speed S must not be negative")
            SPINDLE.check(line, "S", words["S"])
            self.spindle, self.speed_said = words["S"], True
        if "T" in words:
            tool = self.tools.get(int(words["T"]))
            if tool is None or words["T"] != int(words["T"]):
                known = ", ".join(str(t) for t in sorted(self.tools))
                raise BadInput(f"line {line}: T{words['T']:g} is not in the tool list; it has {known}")
            self.next_tool = tool

    def modes(self, block: Block) -> None:
        """Do what the G and M codes of a line say, all but motion and end."""
        line, words, codes = block.line, block.words, block.codes
        if "G20" in codes or "G21" in codes:
            unit = MM_PER_INCH if "G20" in codes else 1.0
            if self.feed and unit != self.unit:
                raise BadInput(f"line {line}: the units change in the middle of the program; keep one")
            if "F" in words:
                raise BadInput(f"line {line}: F and a change of units in one line: the feed's unit is not clear; write two lines")
            self.unit, self.units_said = unit, True
        if "G93" in codes or ("G94" in codes and self.inverse):
            self.inverse, self.feed = "G93" in codes, 0.0
        self.speeds(block)
        if "M6" in codes:
            self.change_tool(line)
        self.spindle_and_coolant(line, codes)
        for code in codes:
            if code in OFFSETS:
                self.work_offset(line, code)
        if "G43" in codes:
            self.length(line, words.get("H"))
        if "G49" in codes:
            self.length_on = False
        if "G64" in codes:
            self.path_tolerance(line, words)
        if "G4" in codes:
            self.dwell(line, words.get("P"))
        if "G80" in codes:
            self.motion = None
        for code in codes:
            if code in MOTIONS:
                self.motion = MOTIONS[code]

    def change_tool(self, line: int) -> None:
        if self.next_tool is None:
            raise BadInput(f"line {line}: M6 without a T word before it; say which tool")
        self.sections.change_tool()
        self.tool, self.length_on, self.turning, self.over = self.next_tool, False, False, None

    def spindle_and_coolant(self, line: int, codes: list[str]) -> None:
        if "M3" in codes:
            if not self.speed_said:
                raise BadInput(f"line {line}: M3 without a spindle speed; give S")
            self.turning = True
        if "M5" in codes:
            self.turning = False
        for code, coolant in (("M7", "mist"), ("M8", "flood"), ("M9", "off")):
            if code in codes:
                self.coolant = coolant

    def work_offset(self, line: int, code: str) -> None:
        if code != self.setup.work_offset:
            raise BadInput(f"line {line}: {code} is not the work offset of setup {self.setup.name}, {self.setup.work_offset}; use that")
        self.offset = code

    def length(self, line: int, number: float | None) -> None:
        if self.tool is None:
            raise BadInput(f"line {line}: G43 before a tool is in the spindle; put T and M6 first")
        if number is not None and number != self.tool.number:
            raise BadInput(f"line {line}: H{number:g} is the length of another tool than T{self.tool.number} in the spindle; "
                           f"use H{self.tool.number}")
        self.length_on = True

    def path_tolerance(self, line: int, words: Mapping[str, float]) -> None:
        """Check how far G64 lets the control leave the path: P at corners, Q where it joins lines into one."""
        limit, joined = words.get("P"), words.get("Q", 0.0)
        if limit is None:
            raise BadInput(f"line {line}: G64 without P rounds corners off without a limit; give P")
        if not 0.0 <= limit * self.unit <= tolerance.GOUGE:
            raise BadInput(f"line {line}: G64 P{limit:g} rounds corners off by more than {tolerance.GOUGE:g} mm; give a smaller P")
        if not 0.0 <= joined * self.unit <= tolerance.GOUGE:
            raise BadInput(f"line {line}: G64 Q{joined:g} joins lines that are more than {tolerance.GOUGE:g} mm apart; give a smaller Q")

    def dwell(self, line: int, seconds: float | None) -> None:
        """Wait as G4 says; its P is in seconds."""
        if seconds is None:
            raise BadInput(f"line {line}: G4 without P; say how many seconds")
        DWELL.check(line, "P", seconds)
        self.sections.dwell(seconds)

    def move(self, block: Block) -> None:
        """Move as the words and the modal motion say."""
        line = block.line
        if "G53" in block.codes:
            self.machine_move(block)
            return
        motion = self.motion
        if motion is None:
            raise BadInput(f"line {line}: a position without G0, G1, G2 or G3")
        tool = self.ready(line)
        point = self.target(block, motion, tool)
        if point is None:
            return
        if motion == Motion.RAPID:
            self.sections.rapid(line, point, tool, (self.spindle, self.coolant))
            return
        if not self.turning:
            raise BadInput(f"line {line}: a feed move while the spindle stands; give S and M3 first")
        if self.feed <= 0.0:
            raise BadInput(f"line {line}: a feed move without a feed; give F")
        centre = NOWHERE if motion == Motion.LINE else self.centre(block, motion, point)
        feed, minutes = (self.feed, 0.0) if not self.rotary else self.pace(block, point)
        self.sections.feed(line, motion, point, centre, feed, tool, (self.spindle, self.coolant), minutes)

    def pace(self, block: Block, end: Point) -> tuple[float, float]:
        """Return the feed of a block, and its minutes where they are what is said: in inverse time, or where rotary axes turn.

        In units a minute LinuxCNC feeds along X, Y and Z, and by degrees where none of them moves.
        """
        start = self.sections.at
        if self.inverse:
            if "F" not in block.words:
                raise BadInput(f"line {block.line}: a feed move in inverse time (G93) needs an F word of its own")
            return self.feed, 1.0 / self.feed
        if start is None or start[3:] == end[3:]:
            return self.feed, 0.0
        way = math.dist(start[:3], end[:3])
        minutes = way / self.feed if way > 0.0 else math.dist(start[3:], end[3:]) / (self.feed / self.unit)
        if minutes * SECONDS_PER_MINUTE > LONGEST_BLOCK:
            raise BadInput(f"line {block.line}: at this feed the block takes {minutes:.0f} min, no block takes more than "
                           f"{LONGEST_BLOCK / SECONDS_PER_MINUTE:.0f}; check F")
        return self.feed, minutes

    def ready(self, line: int) -> Tool:
        """Return the tool when the control knows all it needs for a move in the work offset."""
        if self.tool is None:
            raise BadInput(f"line {line}: a move before a tool is in the spindle; put T and M6 first")
        if not self.units_said:
            raise BadInput(f"line {line}: a move before its unit is said; put G21 or G20 first")
        if not self.offset:
            raise BadInput(f"line {line}: a move before its work offset is said; put {self.setup.work_offset} first")
        return self.tool

    def target(self, block: Block, motion: Motion, tool: Tool) -> Point | None:
        """Return the end of a move; None for a rapid in XY while the tool is still above everything at an unknown height."""
        words, unit = block.words, self.unit
        if motion < Motion.ARC_CW and ("I" in words or "J" in words or "R" in words):
            raise BadInput(f"line {block.line}: I, J or R without an arc; put G2 or G3 first")
        at = self.sections.at
        if at is None:
            return self.first_target(block, motion, tool)
        angle = self.turned(words)
        for letter, before, after in zip(self.rotary, at[3:], angle, strict=True):
            if abs(after - before) > MOST_TURN:
                raise BadInput(f"line {block.line}: {letter} turns by {abs(after - before):.10g} degrees in one block, at most "
                               f"{MOST_TURN:g} are understood; write several")
        if not self.length_on:
            raise BadInput(f"line {block.line}: a move without the tool's length; put G43 H{tool.number} first")
        x, y, z = words.get("X"), words.get("Y"), words.get("Z")
        return (at[0] if x is None else x * unit, at[1] if y is None else y * unit, at[2] if z is None else z * unit, *angle)

    def turned(self, words: Mapping[str, float]) -> list[float]:
        """Return where the rotary axes stand after a line, in degrees."""
        if self.rotary and self.turns(words):
            self.angle = [words.get(letter, angle) for letter, angle in zip(self.rotary, self.angle, strict=True)]
        return self.angle

    def first_target(self, block: Block, motion: Motion, tool: Tool) -> Point | None:
        words, unit, line = block.words, self.unit, block.line
        if motion != Motion.RAPID:
            raise BadInput(f"line {line}: a feed move before it is known where the tool is; begin with a rapid to X, Y and Z")
        if "Z" in words and self.turns(words):
            raise BadInput(f"line {line}: turn {' and '.join(self.rotary)} at the top of the machine, in a line before Z comes down")
        angle = self.turned(words)
        x, y = words.get("X"), words.get("Y")
        if x is not None and y is not None:
            self.over = (x * unit, y * unit)
        elif x is not None or y is not None or (self.over is None and ("Z" in words or not self.turns(words))):
            raise BadInput(f"line {line}: it is not known where the tool is; begin with a rapid to X, Y and Z")
        if "Z" not in words or self.over is None:
            return None
        if not self.length_on:
            raise BadInput(f"line {line}: a move in Z without the tool's length; put G43 H{tool.number} first")
        lost = [letter for letter, v in zip(self.rotary, angle, strict=True) if math.isnan(v)]
        if lost:
            raise BadInput(f"line {line}: it is not known where {' and '.join(lost)} stand; begin with a rapid that says so")
        return (*self.over, words["Z"] * unit, *angle)

    def machine_move(self, block: Block) -> None:
        """Do G53: only a rapid straight up to the top of the machine, Z0."""
        words, line = block.words, block.line
        if self.motion != Motion.RAPID or words.get("Z") != 0.0 or "X" in words or "Y" in words or self.turns(words):
            raise BadInput(f"line {line}: of G53 only G53 G0 Z0, straight up to the top of the machine, is understood")
        if self.tool is not None:
            self.sections.lift(line, self.tool, (self.spindle, self.coolant))
        self.over = None

    def centre(self, block: Block, motion: Motion, end: Point) -> Point:
        """Return the centre of an arc at the height of its start, checked as LinuxCNC does."""
        words, line, start = block.words, block.line, self.sections.at
        assert start is not None
        if "R" in words:
            if "I" in words or "J" in words:
                raise BadInput(f"line {line}: an arc with R and with I or J; keep one of them")
            return centre_by_radius(line, motion, start, end, words["R"] * self.unit)
        if "I" not in words and "J" not in words:
            raise BadInput(f"line {line}: an arc without I, J or R")
        if words.get("P", 1.0) != 1.0:
            raise BadInput(f"line {line}: an arc of several turns (P) is not understood; write each turn")
        return centre_by_offset(line, start, end, (words.get("I", 0.0) * self.unit, words.get("J", 0.0) * self.unit))


def _rotary_ranges(place: Place) -> dict[str, Range]:
    """Return the angles that the words of a machine's rotary axes may say: those within its limits, as a control checks them."""
    return {a.name: Range(a.low, a.high, "degrees", math.degrees(SLACK)) for a in place.machine.rotary}
