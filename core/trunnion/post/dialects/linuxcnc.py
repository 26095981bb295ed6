"""LinuxCNC: modal words, arcs by centre, one restart point an operation; with rotary axes in joint form.

Joint form means that the words are the positions of the machine's own axes: the control needs no kinematics of its own. A block in which a
rotary axis turns is fed in inverse time (G93), so that the tip goes at its feed.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from trunnion.findings import BadCall, Refused
from trunnion.geometry.arrays import Floats, Ints
from trunnion.model.program import Program, ProgramSection
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.model.toolpath import Motion, Toolpath
from trunnion.post.header import Header, place_lines
from trunnion.post.linearize import Straying, joint_path
from trunnion.post.settings import PostSettings
from trunnion.post.ticks import Scale, WrittenPath, upright, written
from trunnion.post.words import dialect_words, plain, refuse_unwritable
from trunnion.shop.kinematics import NO_PLACES, UPRIGHT, Place, Places, axes_of, poses_of
from trunnion.units import trimmed

_DIGITS = 6
"""Digits of an inverse-time feed."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LinuxCncWords:
    """The words of `dialects/linuxcnc.toml`."""

    title: str
    suffix: str
    comment: tuple[str, str]
    line_length: int
    safe_start: str
    restart: str
    path_tolerance: str
    tool_change: tuple[str, ...]
    tool_length: str
    spindle: str
    end: tuple[str, ...]
    work_offsets: tuple[str, ...]
    motions: tuple[str, str, str, str]
    feed_decimals: int
    extra_decimals_inch: int
    units: dict[str, str]
    coolant: dict[str, str]
    angle_decimals: int
    per_minute: str
    inverse_time: str
    top: str


class LinuxCncDialect:
    """Writes one setup as a LinuxCNC program and reads it back."""

    name = "linuxcnc"

    def __init__(self) -> None:
        self.words = dialect_words(LinuxCncWords, self.name)
        self.suffix = self.words.suffix

    def write(self, programs: Sequence[Program], header: Header, settings: PostSettings, places: Places = NO_PLACES) -> str:
        """Return the text of one setup's program."""
        if len(programs) != 1:
            raise BadCall(f"a LinuxCNC program holds one setup; got {len(programs)}")
        return "\n".join(_Writer(self.words, programs[0], settings, places.get(programs[0].setup.name)).lines(header)) + "\n"

    def stamp(self, program: str, header: Header) -> tuple[str, ...]:
        """Return the stamp's lines as comments."""
        return tuple(_comment(self.words, line) for line in header.stamp(program))

    def read(self, text: str, tools: Sequence[Tool], setups: Sequence[Setup], places: Places = NO_PLACES) -> tuple[Program, ...]:
        """Return the program of the one setup."""
        from trunnion.post.readers.linuxcnc import read_linuxcnc
        if len(setups) != 1:
            raise BadCall(f"a LinuxCNC program holds one setup; got {len(setups)}")
        return (read_linuxcnc(text, tools, setups[0], places.get(setups[0].name)),)


def _comment(words: LinuxCncWords, text: str) -> str:
    opened, closed = words.comment
    return f"{opened}{plain(text, words.line_length - len(opened) - len(closed))}{closed}"


class _Writer:
    """The modal state of one text while it is written. Positions, centres and angles are in ticks of their last decimal."""

    def __init__(self, words: LinuxCncWords, program: Program, settings: PostSettings, place: Place | None) -> None:
        self.words, self.program, self.settings = words, program, settings
        self.place = place if place is not None and place.machine.rotary else None
        self.letters = self.place.names if self.place else ""
        self.scale = Scale.of(settings, words.extra_decimals_inch, words.feed_decimals)
        self.degrees = Scale(unit=1.0, decimals=words.angle_decimals, feed_decimals=words.feed_decimals)
        self.number = 0
        self.tool: int | None = None
        self.at: tuple[int, int, int] | None = None
        self.angle: list[int] | None = None
        self.motion, self.feed, self.coolant = -1, "", "off"
        self.inverse = False

    def lines(self, header: Header) -> Iterator[str]:
        words, setup = self.words, self.program.setup
        if setup.work_offset not in words.work_offsets:
            raise Refused(f"setup {setup.name}: {words.title} has no work offset {setup.work_offset}; "
                          f"it has {', '.join(words.work_offsets)}")
        yield from (_comment(words, line) for line in header.stamp(f"{header.name}.{setup.name}"))
        yield from (_comment(words, line) for line in header.about([self.program], self.settings.units))
        if self.place is not None:
            yield from (_comment(words, line) for line in place_lines(setup, self.place, self.settings.units))
        limit = trimmed(self.settings.path_tolerance / self.scale.unit, self.scale.decimals)
        for line in (words.units[self.settings.units], words.safe_start, words.path_tolerance.format(tolerance=limit), setup.work_offset):
            yield self.numbered(line)
        for section in self.program.sections:
            yield from self.section(section)
        yield from (self.numbered(line) for line in words.end)

    def numbered(self, line: str) -> str:
        self.number += self.settings.number_step
        return f"N{self.number} {line}"

    def section(self, section: ProgramSection) -> Iterator[str]:
        """Yield one operation: its comment, the state it needs in full (so that a run may start here), its motions."""
        words, tool = self.words, section.tool
        refuse_unwritable(section, words.title, words.coolant)
        yield _comment(words, f"OPERATION {section.operation}")
        changes = tool.number != self.tool
        yield _comment(words, f"RESTART POINT N{self.number + self.settings.number_step} TOOL {tool.number} {tool.name}")
        if changes:
            yield from (self.numbered(line.format(tool=tool.number)) for line in words.tool_change)
            self.tool, self.at, self.coolant = tool.number, None, "off"
        yield self.numbered(f"{words.restart} {self.program.setup.work_offset}")
        yield self.numbered(words.spindle.format(spindle=trimmed(section.spindle, 0)))
        if self.coolant not in ("off", section.coolant):
            yield self.numbered(words.coolant["off"])
        yield self.numbered(words.coolant[section.coolant])
        self.coolant, self.inverse = section.coolant, False
        yield from self.approach(section, changes)

    def approach(self, section: ProgramSection, changes: bool) -> Iterator[str]:
        """Yield the first rapid and the blocks after it.

        After a tool change, and where the rotary axes must unwind, they turn at the top of the machine; then XY on top, then down with the
        tool's length.
        """
        path, minutes = self.written(section, changes)
        blocks = zip(path.blocks(), path.more.tolist(), minutes.tolist(), strict=True)
        ((first, _, _, _), angle, _), rapid = next(blocks), self.words.motions[Motion.RAPID]
        x, y, z = (self.scale.text(v) for v in first)
        turn = "".join(f" {letter}{self.degrees.text(v)}" for letter, v in zip(self.letters, angle, strict=True))
        length = self.words.tool_length.format(tool=section.tool.number)
        unwinds = not changes and angle != (self.angle or [])
        if unwinds:
            yield self.numbered(self.words.top)
        if changes or unwinds:
            if turn:
                yield self.numbered(f"{rapid}{turn}")
            yield self.numbered(f"{rapid} X{x} Y{y}")
            yield self.numbered(f"{rapid} {length} Z{z}")
        else:
            yield self.numbered(length)
            yield self.numbered(f"{rapid} X{x} Y{y} Z{z}{turn}")
        self.at, self.angle, self.motion, self.feed = (first[0], first[1], first[2]), angle, Motion.RAPID, ""
        yield from (self.block(block, turned, time) for block, turned, time in blocks)

    def written(self, section: ProgramSection, changes: bool) -> tuple[WrittenPath, Floats]:
        """Return the blocks of a section as they are written, and the minutes (m,) of those that are fed in inverse time, else 0."""
        if self.place is None:
            path = written(upright(section.path, section.operation), self.scale, section.operation)
            return path, np.zeros(len(path.motion))
        stand = None if self.angle is None else self.radians(np.array(self.angle))
        straying = Straying(feed=self.settings.straying, rapid=self.settings.rapid_straying)
        joints = joint_path(section.path, section.tool, self.place, stand, straying, section.operation)
        moved = Toolpath(position=joints.words, axis=np.tile([0.0, 0.0, 1.0], (len(joints.words), 1)), motion=joints.motion,
                         centre=joints.centre, feed=joints.feed, mark=np.zeros(len(joints.words), np.int64))
        path = written(moved, self.scale, section.operation, self.degrees.ticks(np.degrees(joints.angle)))
        if not changes and path.more[0].tolist() != self.angle:
            self.check_axis(path.more[0], section)
        return path, self.minutes(path, section.tool)

    def check_axis(self, angle: Ints, section: ProgramSection) -> None:
        """Refuse an operation that begins in another direction than the tool has: only its own path knows a safe way there."""
        assert self.place is not None
        before, after = axes_of(self.place, self.radians(np.array([self.angle, angle])))
        if np.linalg.norm(after - before) > 1e3 * UPRIGHT:
            raise Refused(f"operation {section.operation} begins with the tool in another direction than the one before it ends with: "
                          "lead it there over the work first")

    def minutes(self, path: WrittenPath, tool: Tool) -> Floats:
        """Return how long (m,) the blocks in which a rotary axis turns last, from what is written: the tip at its feed, unless an axis of
        the machine needs longer."""
        assert self.place is not None
        angle = self.radians(path.more)
        words = np.asarray(path.point * (self.scale.unit / 10.0**self.scale.decimals), dtype=np.float64)
        tip, _ = poses_of(self.place, words, angle, tool.gauge_length)
        rates = np.array([self.place.machine.axis(name).rapid for name in (*"XYZ", *self.letters)])
        way = np.abs(np.diff(np.column_stack([words, np.degrees(angle)]), axis=0)) / rates
        time = np.maximum(np.linalg.norm(np.diff(tip, axis=0), axis=1) / np.maximum(path.feed[1:], 1e-9), way.max(axis=1))
        turns = (path.more[1:] != path.more[:-1]).any(axis=1) & (path.motion[1:] != Motion.RAPID)
        return np.concatenate([[0.0], np.where(turns, time, 0.0)])

    def radians(self, ticks: Ints) -> Floats:
        return np.asarray(np.radians(ticks / 10.0**self.degrees.decimals))

    def block(self, block: tuple[list[int], list[int], int, float], angle: list[int], minutes: float) -> str:
        """Return the line of one block: only words that change, but both ends of an arc's plane."""
        point, centre, motion, feed = block
        text, (x, y, z) = self.scale.text, self.at or (0, 0, 0)
        arc, fed = motion >= Motion.ARC_CW, motion != Motion.RAPID
        self.number += self.settings.number_step
        parts = [f"N{self.number}"]
        if fed and (minutes > 0.0) != self.inverse:
            self.inverse = minutes > 0.0
            self.feed = ""
            parts.append(self.words.inverse_time if self.inverse else self.words.per_minute)
        if motion != self.motion:
            parts.append(self.words.motions[motion])
        if arc or point[0] != x:
            parts.append("X" + text(point[0]))
        if arc or point[1] != y:
            parts.append("Y" + text(point[1]))
        if point[2] != z:
            parts.append("Z" + text(point[2]))
        if angle != self.angle:
            parts += [letter + self.degrees.text(v) for letter, v, old in zip(self.letters, angle, self.angle or angle, strict=True)
                      if v != old]
        if arc:
            parts += ["I" + text(centre[0] - x), "J" + text(centre[1] - y)]
        if minutes > 0.0:
            parts.append("F" + _inverse(minutes))
        elif fed and (said := self.scale.feed(feed)) != self.feed:
            parts.append("F" + said)
            self.feed = said
        self.at, self.angle, self.motion = (point[0], point[1], point[2]), angle, motion
        return " ".join(parts)


def _inverse(minutes: float) -> str:
    """Return an inverse-time feed, rounded down so that no block is faster than it was meant.

    >>> _inverse(0.003)
    '333.333'
    """
    decimals = max(0, _DIGITS - 1 - math.floor(math.log10(1.0 / minutes)))
    text = f"{math.floor(10.0**decimals / minutes) / 10.0**decimals:.{decimals}f}"
    return text.rstrip("0").rstrip(".") if "." in text else text
