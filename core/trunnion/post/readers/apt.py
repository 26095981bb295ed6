"""Reads APT CL text into motions: ours, or edited by hand with the same words. Anything else is refused with its line."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence

from trunnion import tolerance
from trunnion.findings import BadInput
from trunnion.model.motion.program import Program
from trunnion.model.motion.toolpath import Motion
from trunnion.model.setup import Setup
from trunnion.model.spindle import FeedMode, limited_turns, per_minute
from trunnion.model.tool import AnyTool
from trunnion.post.readers.numbers import (
    DWELL,
    FEED,
    FEED_PER_REVOLUTION,
    LENGTH,
    SPINDLE,
    shown,
)
from trunnion.post.readers.sections import (
    NOWHERE,
    CuttingState,
    Pace,
    Point,
    Sections,
    TiltedPoses,
    operation_of,
)
from trunnion.post.readers.statements import statements
from trunnion.post.readers.tools import by_number, check_tool
from trunnion.post.readers.word_address.arcs import refuse_nearly_closed, refuse_no_radius
from trunnion.units import METRES_PER_FOOT, MM_PER_INCH

_SETUP = re.compile(r"SETUP\s+(\S+)\s+WORK OFFSET\s+(\S+)$", re.IGNORECASE)
FEED_WORDS = {
    "MMPM": (1.0, FeedMode.MINUTE),
    "IPM": (MM_PER_INCH, FeedMode.MINUTE),
    "MMPR": (1.0, FeedMode.REVOLUTION),
    "IPR": (MM_PER_INCH, FeedMode.REVOLUTION),
}
"""Words of a feed: mm of its unit of length, and what it is given by."""
SURFACE_WORDS = {"SMM": 1.0, "SFM": METRES_PER_FOOT}
"""Words of a constant surface speed, and m/min of their units."""
_NUMBER = re.compile(r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:E[-+]?[0-9]+)?")
_UP = (0.0, 0.0, 1.0)
_UNIT = 1e-4
"""How far the length of a tool axis may be from 1: other systems write four decimals."""


def read_apt(text: str, tools: Sequence[AnyTool], setups: Sequence[Setup]) -> tuple[Program, ...]:
    """Return the program of each setup that a CL text names; raise `BadInput` naming the line of what isn't understood.

    A text that names no setup belongs to the only one given.
    """
    reader = _Reader(by_number(tools), setups)
    for line, word, arguments in statements(text):
        reader.run(line, word, arguments)
    return reader.finished()


class _Reader:
    """The modal state of a CL text while it is read; lengths in mm."""

    def __init__(self, tools: dict[int, AnyTool], setups: Sequence[Setup]) -> None:
        self.tools, self.setups = tools, {s.name: s for s in setups}
        self.programs: list[Program] = []
        self.setup: Setup | None = setups[0] if len(setups) == 1 else None
        self.sections = Sections(TiltedPoses(self.setup.clearance if self.setup else 0.0))
        self.named = self.rapid = self.ended = self.leans = self.turning = False
        self.tool: AnyTool | None = None
        self.unit, self.feed, self.spindle, self.coolant = 0.0, 0.0, 0.0, "off"
        self.surface_speed, self.feed_mode = 0.0, FeedMode.MINUTE
        self.circle: list[float] | None = None
        self.words = {
            "PARTNO": self.text,
            "PPRINT": self.text,
            "REMARK": self.text,
            "UNITS": self.units,
            "MULTAX": self.multax,
            "LOADTL": self.load,
            "CUTTER": self.cutter,
            "SPINDL": self.spindl,
            "COOLNT": self.coolnt,
            "RAPID": self.go_rapid,
            "FEDRAT": self.fedrat,
            "GOTO": self.goto,
            "CIRCLE": self.arc,
            "DELAY": self.delay,
            "END": self.pause,
            "FINI": self.fini,
        }

    def run(self, line: int, word: str, rest: str) -> None:
        """Do one statement."""
        if self.ended:
            raise BadInput(f"line {line}: {shown(word)} stands after FINI; remove it")
        if word not in self.words:
            raise BadInput(
                f"line {line}: {shown(word)} is not understood; known are {', '.join(self.words)}"
            )
        if self.circle is not None and word != "GOTO":
            raise BadInput(
                f"line {line}: after CIRCLE comes the GOTO that ends the arc, not {shown(word)}"
            )
        self.words[word](line, rest)

    def finished(self) -> tuple[Program, ...]:
        """Return the programs; raise `BadInput` when the text has no end."""
        if not self.ended:
            raise BadInput("the text has no FINI: is it complete?")
        self.close()
        return tuple(self.programs)

    def close(self) -> None:
        if self.setup is not None:
            self.programs.append(
                Program(name=self.setup.name, setup=self.setup, sections=self.sections.finished())
            )

    def text(self, line: int, rest: str) -> None:
        if found := _SETUP.match(rest):
            self.next_setup(line, found.group(1), found.group(2))
        elif (operation := operation_of(rest)) is not None:
            self.sections.operation(operation)
        else:
            check_tool(line, rest, self.tools)

    def next_setup(self, line: int, name: str, offset: str) -> None:
        if name not in self.setups:
            raise BadInput(
                f"line {line}: setup {shown(name)} is not in the plan; it has {', '.join(self.setups)}"
            )
        if self.setups[name].work_offset != offset.upper():
            raise BadInput(
                f"line {line}: {shown(offset)} is not the work offset of setup {name}, {self.setups[name].work_offset}"
            )
        if self.named:
            self.close()
        if any(p.setup.name == name for p in self.programs):
            raise BadInput(f"line {line}: setup {name} comes twice; put its operations together")
        self.setup, self.named, self.tool = self.setups[name], True, None
        self.sections = Sections(TiltedPoses(self.setup.clearance))

    def units(self, line: int, rest: str) -> None:
        if rest not in ("MM", "INCHES"):
            raise BadInput(f"line {line}: UNITS/{shown(rest)} is not understood; use MM or INCHES")
        unit = MM_PER_INCH if rest == "INCHES" else 1.0
        if self.unit not in (0.0, unit):
            raise BadInput(f"line {line}: the units change in the middle of the text; keep one")
        self.unit = unit

    def multax(self, line: int, rest: str) -> None:
        if rest not in ("ON", "OFF", ""):
            raise BadInput(f"line {line}: MULTAX/{shown(rest)} is not understood; use ON or OFF")
        self.leans = rest != "OFF"

    def load(self, line: int, rest: str) -> None:
        number, *more = rest.split(",")
        tool = next((t for n, t in self.tools.items() if str(n) == number), None)
        if tool is None:
            known = ", ".join(str(n) for n in sorted(self.tools))
            raise BadInput(
                f"line {line}: tool {shown(number)} is not in the tool list; it has {known}"
            )
        if more and (len(more) != 2 or more[0] != "LENGTH"):
            raise BadInput(
                f"line {line}: LOADTL/{shown(rest)} is not understood; write LOADTL/number,LENGTH,length"
            )
        if more and not self.same(line, more[1], tool.gauge_length):
            raise BadInput(
                f"line {line}: length {shown(more[1])} is not that of tool {number}, {tool.gauge_length:g} mm"
            )
        self.sections.change_tool()
        self.tool, self.spindle, self.turning, self.surface_speed = tool, 0.0, False, 0.0

    def cutter(self, line: int, rest: str) -> None:
        sizes = rest.split(",")
        tool = self.tool
        if tool is None:
            raise BadInput(f"line {line}: CUTTER before LOADTL; load the tool first")
        if (
            len(sizes) != 2
            or not self.same(line, sizes[0], tool.cutter_sizes[0])
            or not self.same(line, sizes[1], tool.cutter_sizes[1])
        ):
            raise BadInput(
                f"line {line}: CUTTER/{shown(rest)} is not tool {tool.number}, "
                f"CUTTER/{tool.cutter_sizes[0]:g},{tool.cutter_sizes[1]:g} in mm"
            )

    def same(self, line: int, word: str, length: float) -> bool:
        return abs(self.numbers(line, word, 1)[0] * self.scale(line) - length) <= tolerance.WRITTEN

    def spindl(self, line: int, rest: str) -> None:
        if rest == "OFF":
            self.spindle, self.surface_speed, self.turning = 0.0, 0.0, False
            return
        given = rest.split(",")
        if any(w in given for w in SURFACE_WORDS):
            self.keep_surface_speed(line, rest)
            return
        words = [w for w in given if w not in ("RPM", "CLW")]
        if len(words) != 1:
            raise BadInput(
                f"line {line}: SPINDL/{shown(rest)} is not understood; write SPINDL/RPM,speed,CLW or SPINDL/OFF"
            )
        speed = self.numbers(line, words[0], 1)[0]
        SPINDLE.check(line, "SPINDL ", speed)
        self.spindle, self.surface_speed, self.turning = speed, 0.0, True

    def keep_surface_speed(self, line: int, rest: str) -> None:
        """Take over a constant surface speed with the highest spindle speed."""
        unit_word = "SMM" if self.scale(line) == 1.0 else "SFM"
        words = [w for w in rest.split(",") if w != "CLW"]
        if len(words) != 4 or words[0] != unit_word or words[2] != "MAXRPM":
            raise BadInput(
                f"line {line}: SPINDL/{shown(rest)} is not understood; write SPINDL/{unit_word},speed,CLW,MAXRPM,speed"
            )
        speed, highest = self.numbers(line, f"{words[1]},{words[3]}", 2)
        for value in (speed, highest):
            SPINDLE.check(line, "SPINDL ", value)
            if value <= 0.0:
                raise BadInput(
                    f"line {line}: a constant surface speed and its MAXRPM are above zero"
                )
        self.spindle, self.turning = highest, True
        self.surface_speed = speed * SURFACE_WORDS[unit_word]

    def coolnt(self, line: int, rest: str) -> None:
        if rest not in ("FLOOD", "MIST", "OFF", "ON"):
            raise BadInput(
                f"line {line}: COOLNT/{shown(rest)} is not understood; use FLOOD, MIST or OFF"
            )
        self.coolant = "flood" if rest == "ON" else rest.lower()

    def go_rapid(self, line: int, rest: str) -> None:
        if rest:
            raise BadInput(f"line {line}: RAPID takes nothing after it")
        self.rapid = True

    def fedrat(self, line: int, rest: str) -> None:
        words = [w for w in rest.split(",") if w not in FEED_WORDS]
        unit_word = [w for w in rest.split(",") if w in FEED_WORDS]
        known = [w for w, (unit, _) in FEED_WORDS.items() if unit == self.scale(line)]
        if len(words) != 1 or len(unit_word) > 1 or not set(unit_word) <= set(known):
            raise BadInput(
                f"line {line}: FEDRAT/{shown(rest)} is not understood; write FEDRAT/feed,{known[0]}"
            )
        feed = self.numbers(line, words[0], 1)[0]
        if feed <= 0.0:
            raise BadInput(f"line {line}: the feed must be above zero")
        self.feed_mode = FEED_WORDS[unit_word[0]][1] if unit_word else FeedMode.MINUTE
        by_revolution = self.feed_mode is FeedMode.REVOLUTION
        (FEED_PER_REVOLUTION if by_revolution else FEED).check(line, "FEDRAT ", feed)
        self.feed, self.rapid = feed * self.unit, False

    def pace(self, line: int, x: float) -> Pace:
        """Return how fast a block is fed that ends at an X in mm."""
        if self.feed_mode is not FeedMode.REVOLUTION:
            return Pace(self.feed)
        turns = self.spindle
        if self.surface_speed > 0.0:
            turns = float(limited_turns(self.surface_speed, 2.0 * abs(x), self.spindle))
        if turns <= 0.0:
            raise BadInput(
                f"line {line}: a feed by the revolution while the spindle stands; give its speed"
            )
        feed = per_minute(self.feed, turns)
        FEED.check(line, f"at {turns:g} 1/min a feed a minute of ", feed / self.unit)
        return Pace(feed, mode=FeedMode.REVOLUTION)

    def cutting(self) -> CuttingState:
        """Return what a move runs with."""
        return CuttingState(self.spindle, self.coolant, self.surface_speed)

    def goto(self, line: int, rest: str) -> None:
        x, y, z, *axis = self.numbers(line, rest, 3, 6)
        for value in (x, y, z):
            LENGTH.check(line, "GOTO ", value)
        tool, scale = self.tool, self.scale(line)
        if self.setup is None:
            raise BadInput(
                f"line {line}: a move before its setup; put PPRINT/SETUP name WORK OFFSET word first"
            )
        if tool is None:
            raise BadInput(f"line {line}: a move before a tool is loaded; put LOADTL first")
        point = (x * scale, y * scale, z * scale, *self.axis(line, axis))
        if not tool.rotates and point[1:2] + point[3:] != (0.0, *_UP):
            raise BadInput(
                f"line {line}: tool {tool.number} turns work in the plane of X and Z; Y must be 0, and no axis given"
            )
        if self.rapid and self.circle is None:
            self.sections.rapid(line, point, tool, self.cutting())
            self.rapid = False
            return
        self.rapid = False
        if not self.turning:
            raise BadInput(f"line {line}: a feed move while the spindle stands; put SPINDL first")
        if self.feed <= 0.0:
            raise BadInput(f"line {line}: a feed move without a feed; put FEDRAT first")
        if self.surface_speed > 0.0 and tool.rotates:
            raise BadInput(
                f"line {line}: a constant surface speed with tool {tool.number}, which rotates; give the spindle speed"
            )
        motion, centre = self.motion(line, point)
        self.sections.feed(
            line, motion, point, centre, self.pace(line, point[0]), tool, self.cutting()
        )

    def axis(self, line: int, numbers: list[float]) -> tuple[float, ...]:
        """Return the unit tool axis that a GOTO says: z where it says none or three axes are on; raise `BadInput` for what can't be."""
        if not numbers:
            return _UP
        length = math.hypot(*numbers)
        if abs(length - 1.0) > _UNIT:
            raise BadInput(
                f"line {line}: the tool axis has the length {length:.4f}; it must be a unit vector"
            )
        axis = tuple(v / length for v in numbers)
        if math.hypot(*axis[:2]) <= tolerance.PARAMETRIC and axis[2] > 0.0:
            return _UP
        if not self.leans:
            if math.dist(axis, _UP) > tolerance.ANGLE:
                raise BadInput(
                    f"line {line}: a tilted tool axis after MULTAX/OFF; put MULTAX/ON first"
                )
            return _UP
        return axis

    def motion(self, line: int, end: Point) -> tuple[Motion, Point]:
        """Return how the move goes, and the centre of the arc when a CIRCLE came before it."""
        start = self.sections.at
        if self.circle is None or start is None:
            self.circle = None
            return Motion.LINE, NOWHERE
        (x, y, z, _, _, sense, radius), self.circle = self.circle, None
        if self.tool is not None and not self.tool.rotates:
            raise BadInput(
                f"line {line}: an arc of a tool that turns work is not understood; write lines"
            )
        if start[3:] != _UP or end[3:] != _UP:
            raise BadInput(
                f"line {line}: an arc of a tool that leans is not understood; write lines"
            )
        first, last = math.dist((x, y), start[:2]), math.dist((x, y), end[:2])
        refuse_no_radius(line, radius)
        if (
            max(abs(first - radius), abs(last - radius)) > tolerance.ARC_RADIUS
            or abs(z - start[2]) > tolerance.WRITTEN
        ):
            raise BadInput(
                f"line {line}: the arc of radius {radius:.4f} starts at radius {first:.4f} and ends at {last:.4f} mm; "
                "check CIRCLE"
            )
        refuse_no_radius(line, min(first, last))
        refuse_nearly_closed(line, start, end)
        return (Motion.ARC_CCW if sense > 0.0 else Motion.ARC_CW), (x, y, start[2])

    def arc(self, line: int, rest: str) -> None:
        numbers, scale = self.numbers(line, rest, 7), self.scale(line)
        for value in (*numbers[:3], numbers[6]):
            LENGTH.check(line, "CIRCLE ", value)
        if self.rapid:
            raise BadInput(f"line {line}: RAPID before an arc; put FEDRAT instead")
        if numbers[3:6] not in ([0.0, 0.0, 1.0], [0.0, 0.0, -1.0]):
            raise BadInput(f"line {line}: an arc about another axis than Z is not understood")
        self.circle = [v * scale for v in numbers[:3]] + numbers[3:6] + [numbers[6] * scale]

    def delay(self, line: int, rest: str) -> None:
        seconds = self.numbers(line, rest, 1)[0]
        DWELL.check(line, "DELAY ", seconds)
        self.sections.dwell(seconds)

    def pause(self, line: int, rest: str) -> None:
        if rest:
            raise BadInput(f"line {line}: END takes nothing after it")

    def fini(self, line: int, rest: str) -> None:
        self.pause(line, rest)
        self.ended = True

    def scale(self, line: int) -> float:
        if self.unit == 0.0:
            raise BadInput(
                f"line {line}: a length before its unit is said; put UNITS/MM or UNITS/INCHES first"
            )
        return self.unit

    def numbers(self, line: int, rest: str, *counts: int) -> list[float]:
        """Return the numbers after a word, zero without a sign; raise `BadInput` unless they are of an allowed count and finite."""
        words = rest.split(",")
        if not all(_NUMBER.fullmatch(w) for w in words):
            raise BadInput(f"line {line}: {shown(rest)} is not a list of numbers")
        values = [float(w) + 0.0 for w in words]
        if len(values) not in counts or not all(math.isfinite(v) for v in values):
            raise BadInput(
                f"line {line}: {shown(rest)} must be {' or '.join(str(c) for c in counts)} numbers"
            )
        return values
