"""LinuxCNC, three axes: modal words, arcs by centre, one restart point an operation."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from trunnion.findings import BadCall, Refused
from trunnion.model.program import Program, ProgramSection
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.model.toolpath import Motion
from trunnion.post.header import Header
from trunnion.post.settings import PostSettings
from trunnion.post.ticks import Scale, written
from trunnion.post.words import dialect_words, plain, refuse_unwritable
from trunnion.units import trimmed


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


class LinuxCncDialect:
    """Writes one setup as a LinuxCNC program and reads it back."""

    name = "linuxcnc"

    def __init__(self) -> None:
        self.words = dialect_words(LinuxCncWords, self.name)
        self.suffix = self.words.suffix

    def write(self, programs: Sequence[Program], header: Header, settings: PostSettings) -> str:
        """Return the text of one setup's program."""
        if len(programs) != 1:
            raise BadCall(f"a LinuxCNC program holds one setup; got {len(programs)}")
        return "\n".join(_Writer(self.words, programs[0], settings).lines(header)) + "\n"

    def stamp(self, program: str, header: Header) -> tuple[str, ...]:
        """Return the stamp's lines as comments."""
        return tuple(_comment(self.words, line) for line in header.stamp(program))

    def read(self, text: str, tools: Sequence[Tool], setups: Sequence[Setup]) -> tuple[Program, ...]:
        """Return the program of the one setup."""
        from trunnion.post.readers.linuxcnc import read_linuxcnc
        if len(setups) != 1:
            raise BadCall(f"a LinuxCNC program holds one setup; got {len(setups)}")
        return (read_linuxcnc(text, tools, setups[0]),)


def _comment(words: LinuxCncWords, text: str) -> str:
    opened, closed = words.comment
    return f"{opened}{plain(text, words.line_length - len(opened) - len(closed))}{closed}"


class _Writer:
    """The modal state of one text while it is written. Positions and centres are in ticks of the last decimal."""

    def __init__(self, words: LinuxCncWords, program: Program, settings: PostSettings) -> None:
        self.words, self.program, self.settings = words, program, settings
        self.scale = Scale.of(settings, words.extra_decimals_inch, words.feed_decimals)
        self.number = 0
        self.tool: int | None = None
        self.at: tuple[int, int, int] | None = None
        self.motion, self.feed, self.coolant = -1, "", "off"

    def lines(self, header: Header) -> Iterator[str]:
        words, setup = self.words, self.program.setup
        if setup.work_offset not in words.work_offsets:
            raise Refused(f"setup {setup.name}: {words.title} has no work offset {setup.work_offset}; "
                          f"it has {', '.join(words.work_offsets)}")
        yield from (_comment(words, line) for line in header.stamp(f"{header.name}.{setup.name}"))
        yield from (_comment(words, line) for line in header.about([self.program], self.settings.units))
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
        self.coolant = section.coolant
        yield from self.approach(section, changes)

    def approach(self, section: ProgramSection, changes: bool) -> Iterator[str]:
        """Yield the first rapid (after a tool change XY on top, then down with the tool's length) and the blocks after it."""
        blocks = written(section.path, self.scale, section.operation).blocks()
        first, rapid = next(blocks)[0], self.words.motions[Motion.RAPID]
        x, y, z = (self.scale.text(v) for v in first)
        length = self.words.tool_length.format(tool=section.tool.number)
        if changes:
            yield self.numbered(f"{rapid} X{x} Y{y}")
            yield self.numbered(f"{rapid} {length} Z{z}")
        else:
            yield self.numbered(length)
            yield self.numbered(f"{rapid} X{x} Y{y} Z{z}")
        self.at, self.motion, self.feed = (first[0], first[1], first[2]), Motion.RAPID, ""
        yield from (self.block(*block) for block in blocks)

    def block(self, point: list[int], centre: list[int], motion: int, feed: float) -> str:
        """Return the line of one block: only words that change, but both ends of an arc's plane."""
        text, (x, y, z) = self.scale.text, self.at or (0, 0, 0)
        arc = motion >= Motion.ARC_CW
        self.number += self.settings.number_step
        parts = [f"N{self.number}"]
        if motion != self.motion:
            parts.append(self.words.motions[motion])
        if arc or point[0] != x:
            parts.append("X" + text(point[0]))
        if arc or point[1] != y:
            parts.append("Y" + text(point[1]))
        if point[2] != z:
            parts.append("Z" + text(point[2]))
        if arc:
            parts += ["I" + text(centre[0] - x), "J" + text(centre[1] - y)]
        if motion != Motion.RAPID and (said := self.scale.feed(feed)) != self.feed:
            parts.append("F" + said)
            self.feed = said
        self.at, self.motion = (point[0], point[1], point[2]), motion
        return " ".join(parts)
