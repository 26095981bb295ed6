"""Programs in Klartext, Heidenhain's conversational format: numbered blocks, each with the word of what it does, numbers with signs.

What is written of a program, and in which order, is `ProgramWriter`'s and `TipWriter`'s; here is how it is said.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import replace
from itertools import repeat
from typing import ClassVar

import numpy as np

from trunnion.geometry.arrays import Floats, Ints
from trunnion.model.motion.program import ProgramSection
from trunnion.model.motion.toolpath import Motion
from trunnion.post.header import STAMP_LINES, Header
from trunnion.post.klartext_words import KlartextWords
from trunnion.post.ticks import TickScale, WrittenCycle, WrittenPath, shortened
from trunnion.post.words import plain
from trunnion.post.writer.cycle_calls import CycleCallWriter
from trunnion.post.writer.feed import dwell_text
from trunnion.post.writer.helix import block_of, last_of_winding, sweep_of
from trunnion.post.writer.modal import Block, WrittenState
from trunnion.post.writer.program import ProgramWriter
from trunnion.post.writer.tilted_plane import TiltedPlane
from trunnion.post.writer.tip_control import TipState, TipWriter
from trunnion.units import trimmed

FEEDS_AN_INCH = 10.0
"""In a program in inches feeds are counted in tenths of an inch a minute."""

SLACK = 1e-9
"""Radians that whole turns add up to more than they are."""
MOST_OFF = 2.0
"""Ticks: a helix that ends farther beside is followed by a line to its end."""


class KlartextScale(TickScale):
    """Lengths and angles with their sign, plus too."""

    sign: ClassVar[str] = "+"

    def text(self, ticks: int) -> str:
        """Return the number that some ticks stand for.

        >>> KlartextScale(unit=1.0, decimals=4, feed_decimals=1, point=".0").text(125000)
        '+12.5'
        """
        written = super().text(ticks)
        return written if ticks < 0 else f"+{written}"

    def feed(self, feed: float) -> str:
        """Return a feed in mm/min as it is written, without a sign; never zero."""
        unit = 1.0 if self.unit == 1.0 else self.unit / FEEDS_AN_INCH
        return shortened(feed / unit, self.feed_decimals)


class KlartextBlockState(WrittenState):
    """The modal state of a Klartext.

    `off` is by how much (x, y), in ticks, the tool is beside where it was to be: an angle of a helix leads it from where it is, with the
    radius that it has there. None where it is on the last decimal: it is brought back there by the next block that says where it ends.
    `pole` is the centre of the last arc, None after a rapid, before which the plane may have been another.
    """

    scale_class = KlartextScale
    off: tuple[float, float] | None = None
    pole: list[int] | None = None

    def rapid(self, words: Iterable[str]) -> str:
        """Return a rapid block of some words: one with a tool axis is `LN`."""
        given = [w for w in words if w]
        word = "LN" if any(w.startswith("TX") for w in given) else "L"
        self.off = self.pole = None
        return " ".join([word, *given, "R0 FMAX"])

    def lines(self, block: Block, angle: list[int], minutes: float) -> list[str]:
        """Return the blocks of a line or an arc across Z: coordinates that change, both ends of an arc's plane, all of a tool axis."""
        point, centre, motion, feed = block
        text, at = self.scale.text, self.at
        arc, vectors = motion >= Motion.ARC_CW, bool(angle)
        kept = [
            vectors or at is None or point[n] != at[n] or ((arc or self.off is not None) and n < 2)
            for n in range(3)
        ]
        parts = [
            letter + text(v) for letter, v, keep in zip("XYZ", point, kept, strict=True) if keep
        ]
        parts += self.turned(angle) if vectors else []
        self.reached(point, angle, motion)
        if motion == Motion.RAPID:
            return [self.rapid(parts)]
        self.off = None
        if not arc:
            return [" ".join(["LN" if vectors else "L", *parts, "R0", *self.fed(feed, point)])]
        return [
            *self.about(centre),
            " ".join(["C", *parts, _turn(motion), "R0", *self.fed(feed, point)]),
        ]

    def straight(self, path: WrittenPath, first: int, after: int) -> Iterator[str]:
        """Yield the lines of the rows from `first` to before `after`, all straight as the one before them, as `lines` returns them."""
        rows = slice(first - 1, after)
        point, more, motion = path.point[rows], path.more[rows], path.motion[rows]
        vectors, is_rapid = more.shape[1] > 0, (motion[1:] == Motion.RAPID).tolist()
        feeds = self.fed_words(motion[1:], path.feed[first:after])
        columns = [
            *self.point_words(point, always=vectors),
            *self.axis_words(more),
            [
                " R0 FMAX" if rapid else f" R0{feed}"
                for rapid, feed in zip(is_rapid, feeds, strict=True)
            ],
        ]
        self.reached(point[-1].tolist(), more[-1].tolist(), int(motion[-1]))
        self.pole = None if any(is_rapid) else self.pole
        yield from map("".join, zip(repeat("LN" if vectors else "L"), *columns))

    def helix(self, block: Block, sweep: float) -> list[str]:
        """Return the blocks of an arc by how far it turns, rad, from where the tool is to a block's end: a helix, or a whole circle."""
        point, centre, motion, feed = block
        assert self.at is not None
        sign = 1.0 if motion == Motion.ARC_CCW else -1.0
        ticks = int(self.degrees.ticks(np.array(sign * math.degrees(sweep))))
        climb = point[2] - self.at[2]
        parts = [f"IPA{self.degrees.text(ticks)}"]
        parts += [f"IZ{self.scale.text(climb)}"] if climb else []
        self.off = self.led_off(block, ticks)
        self.reached(point, self.angle or [], motion)
        fed = self.fed(feed, point)
        lines = [*self.about(centre), " ".join(["CP", *parts, _turn(motion), "R0", *fed])]
        if self.off is not None and math.hypot(*self.off) > MOST_OFF:
            lines += self.lines((point, centre, Motion.LINE, feed), [], 0.0)
        return lines

    def led_off(self, block: Block, ticks: int) -> tuple[float, float] | None:
        """Return how far beside a block's end an angle in ticks leads the tool, None where it turns wholly from where it was to be."""
        point, centre, _, _ = block
        assert self.at is not None
        if self.off is None and point[:2] == list(self.at[:2]):
            return None
        turn = math.radians(ticks / 10.0**self.degrees.decimals)
        c, s = math.cos(turn), math.sin(turn)
        x, y = (a + b - m for a, b, m in zip(self.at, self.off or (0.0, 0.0), centre, strict=False))
        return (centre[0] + c * x - s * y - point[0], centre[1] + s * x + c * y - point[1])

    def about(self, centre: list[int]) -> list[str]:
        """Return the block of an arc's centre, none where it is that of the arc before."""
        before, self.pole = self.pole, centre[:2]
        text = self.scale.text
        return [] if before == centre[:2] else [f"CC X{text(centre[0])} Y{text(centre[1])}"]

    def fed(self, feed: float, point: list[int]) -> list[str]:
        """Return the word of a feed in mm/min where it changes; rapids leave it as it was."""
        text = self.feed_text(feed, point[0])
        before, self.feed = self.feed, text
        return [] if text == before else ["F" + text]


class KlartextTipState(KlartextBlockState, TipState):
    """The same while the control follows the tip."""

    def axis_words(self, angle: Ints) -> list[list[str]]:
        """Return by number the words of all tool axes (k, 3) after the first."""
        return [
            self.vectors.texts(v[1:], f" {word}")
            for word, v in zip(self.words.directions, angle.T, strict=False)
        ]


class KlartextCycles(CycleCallWriter):
    """Defines a cycle once and calls it at each hole."""

    def defined(self, call: str, feed: str) -> list[str]:
        """Return the block that defines a cycle, its feed in it."""
        return [call]

    def position(self, x: int, y: int) -> str:
        """Return the block of a hole."""
        return f"{super().position(x, y)} M99"

    def values(self, block: WrittenCycle, feed: str) -> dict[str, str]:
        """Return what stands in the braces of a cycle."""
        text = self.modal.scale.text
        return super().values(block, feed) | {
            "depth": text(block.bottom - block.retract),
            "whole": text(block.retract - block.bottom),
            "lift": text(block.end - block.retract),
            "pecks": str(block.cycle.pecks),
        }


def klartext_stamp(words: KlartextWords, program: str, header: Header) -> tuple[str, ...]:
    """Return the stamp's lines: the first block of the program, named after the setup, and comments."""
    _, *others = header.stamp(program)
    begin = f"0 BEGIN PGM {_name(program)} {words.units[header.units]}"
    remarks = (f"{n} {_comment(words, line)}" for n, line in enumerate(others, 1))
    return (begin, *remarks)


class KlartextWriter(ProgramWriter):
    """Writes one setup's program for three axes. `speed` is that of the spindle, as it was said."""

    words: KlartextWords
    speed: str = ""
    state_class: ClassVar[type[KlartextBlockState]] = KlartextBlockState

    def written_state(self) -> WrittenState:
        """Return the modal state at the beginning of the text."""
        return self.state_class(self.words, self.settings, "")

    def opened(self, header: Header) -> Iterator[str]:
        """Yield the stamp, which opens the program, and the rest of the header."""
        header = replace(header, units=self.settings.units)
        lines = list(self.header(header))
        yield from klartext_stamp(self.words, self.name(header), header)
        self.number = STAMP_LINES - 1
        yield from map(self.remark, lines[STAMP_LINES:])
        self.last = f"END PGM {_name(self.name(header))} {self.words.units[header.units]}"

    def closed(self) -> Iterator[str]:
        """Yield the last block."""
        yield self.numbered(self.last)

    def name(self, header: Header) -> str:
        """Return the program's name."""
        return f"{header.name}.{self.program.setup.name}"

    def numbered(self, line: str) -> str:
        """Return a block with its number; the control counts them by itself, one by one."""
        self.number += 1
        return f"{self.number} {line}"

    def remark(self, text: str) -> str:
        """Return the block of a comment."""
        return self.numbered(_comment(self.words, text))

    def restart_point(self) -> str:
        """Return how the block after the next one is called."""
        return f"BLOCK {self.number + 2}"

    def offset(self) -> str:
        """Return the number of the setup's preset."""
        return str(self.words.work_offsets.index(self.program.setup.work_offset) + 1)

    def spindle(self, section: ProgramSection, changed: bool) -> Iterator[str]:
        """Yield the blocks that turn the spindle; a tool change has said its speed."""
        if section.surface_speed > 0.0 or section.tool.locked:
            yield from super().spindle(section, changed)
        speed = trimmed(section.spindle, 0)
        if not changed and speed != self.speed:
            yield from self.before_call()
            yield self.words.speed.format(spindle=speed)
        self.speed = speed
        yield self.words.spindle

    def before_call(self) -> Iterator[str]:
        """Yield what must be said before `TOOL CALL`."""
        yield from ()

    def cycles(self) -> CycleCallWriter:
        """Return what writes the drilling cycles of a section."""
        return KlartextCycles(self.modal)

    def last_of_arc(self, path: WrittenPath, row: int) -> int:
        """Return the last of the arcs that are one helix, of as many turns as a block takes."""
        return last_of_winding(path, row, self.words.turns_a_block * math.tau + SLACK)

    def arc(self, path: WrittenPath, row: int, last: int) -> Iterator[str]:
        """Yield the blocks of an arc; of a helix and of a whole circle by the angle, which is never in doubt."""
        modal, block = self.modal, block_of(path, last)
        assert isinstance(modal, KlartextBlockState)
        start = path.point[row - 1].tolist()
        if start[2] == block[0][2] and start[:2] != block[0][:2]:
            yield from modal.lines(block, path.more[last].tolist(), 0.0)
        else:
            turn = sum(sweep_of(path, k) for k in range(row, last + 1))
            yield from modal.helix(block, turn)

    def waited(self, seconds: float, section: ProgramSection) -> Iterator[str]:
        """Yield the blocks that make the tool stand."""
        if seconds > 0.0:
            text = dwell_text(seconds)
            yield from (line.format(seconds=text) for line in self.words.dwell)


class KlartextTipWriter(KlartextWriter, TipWriter):
    """Writes one setup's program for a machine with rotary axes."""

    state_class = KlartextTipState
    arcs_in_space = False

    def opened(self, header: Header) -> Iterator[str]:
        """Yield the header, and what takes back a plane and a tip control that the program before has left."""
        yield from super().opened(header)
        yield from map(self.numbered, [self.words.no_tip_control, self.words.no_plane])

    def before_call(self) -> Iterator[str]:
        """Yield the end of tip control; where that goes on it is said anew."""
        if self.follows:
            yield self.words.no_tip_control
        self.follows = False

    def joined_length(self, tool: object) -> str:
        """Return nothing: the tool's length counts from its call on."""
        return ""

    def side(self, plane: TiltedPlane, angle: Floats) -> str:
        """Return which of two ways to stand is meant; upright there is one."""
        return "" if plane.upright else self.words.sides[self.first_lean(angle) > 0.0]


def _turn(motion: int) -> str:
    return "DR+" if motion == Motion.ARC_CCW else "DR-"


def _comment(words: KlartextWords, text: str) -> str:
    """Return a text as a comment; at the end of a line `~` would join the next one to it."""
    opened, closed = words.comment
    return f"{opened}{plain(text, words.line_length - len(opened) - len(closed)).replace('~', '-')}{closed}"


def _name(program: str) -> str:
    """Return the name that begins and ends a program: of the setup alone, for a program may be renamed after its proof."""
    setup = program.rsplit(".", 1)[-1] or "PROGRAM"
    return "".join(c if c.isascii() and (c.isalnum() or c in "_-") else "_" for c in setup)
