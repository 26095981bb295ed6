"""The text of one setup's program: header, safe start, one restart point an operation, end."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from trunnion.findings import Refused
from trunnion.geometry.arrays import Floats
from trunnion.model.motion.program import Program, ProgramSection
from trunnion.model.motion.toolpath import Motion
from trunnion.model.spindle import FeedMode
from trunnion.post.header import Header, work_position_lines
from trunnion.post.iso_words import IsoWords, code_of
from trunnion.post.linearize import PathTolerance
from trunnion.post.settings import PostSettings
from trunnion.post.ticks import TickScale, WrittenPath
from trunnion.post.words import plain, refuse_unwritable
from trunnion.post.writer.approach import approach, coolant, tool_change
from trunnion.post.writer.cycle_calls import CycleCallWriter
from trunnion.post.writer.cycles import CycleWriter
from trunnion.post.writer.feed import FeedFormat, dwell_text, feed_word, surface_text
from trunnion.post.writer.helix import block_of, last_of_helix
from trunnion.post.writer.modal import WrittenState, degrees_of
from trunnion.post.writer.plane import MILLING, TURNING
from trunnion.post.writer.rotary import AxisForm, JointForm, ThreeAxes
from trunnion.post.writer.runs import runs
from trunnion.post.writer.turning import TurningForm
from trunnion.shop.kinematics import WorkPosition
from trunnion.units import trimmed

_MOST_LISTED = 12
"""Work offsets that a message lists."""


def comment(words: IsoWords, text: str) -> str:
    """Return a text as a comment of the control."""
    opened, closed = words.comment
    return f"{opened}{plain(text, words.line_length - len(opened) - len(closed))}{closed}"


class ProgramWriter:
    """Writes one setup's program line by line. `work_position` says where the work stands on a machine with rotary axes."""

    def __init__(
        self,
        words: IsoWords,
        program: Program,
        settings: PostSettings,
        work_position: WorkPosition | None,
    ) -> None:
        self.words, self.program, self.settings = words, program, settings
        self.work_position = (
            work_position if work_position is not None and work_position.machine.rotary else None
        )
        self.axes = self.axis_form()
        self.modal = self.written_state()
        self.number = 0
        self.turns = any(s.path.work_turns for s in program.sections)

    def axis_form(self) -> AxisForm:
        """Return how motions become positions that this control takes; raise `Refused` where it can't."""
        return _axis_form(self.words, self.settings, self.work_position)

    def written_state(self) -> WrittenState:
        """Return the modal state at the beginning of the text."""
        return WrittenState(self.words, self.settings, self.axes.letters)

    def left(self) -> Iterator[str]:
        """Yield the lines without numbers that must come before the tool leaves the work for the top of the machine."""
        yield from ()

    def lines(self, header: Header) -> Iterator[str]:
        """Yield the lines of the text; raise `Refused` for what the control can't do."""
        words, setup = self.words, self.program.setup
        if setup.work_offset not in words.work_offsets:
            raise Refused(
                f"setup {setup.name}: {words.title} has no work offset {setup.work_offset}; "
                f"it has {_range(words.work_offsets)}"
            )
        yield from self.opened(header)
        limit = trimmed(
            self.settings.path_tolerance / self.modal.scale.unit, self.modal.scale.decimals
        )
        filled = {
            "units": words.units[self.settings.units],
            "tolerance": limit,
            "offset": self.offset(),
        }
        yield from (self.numbered(line.format(**filled)) for line in words.start)
        for section in self.program.sections:
            yield from self.section(section)
        yield from map(self.numbered, self.left())
        yield from (self.numbered(line) for line in words.end)
        yield from self.closed()

    def opened(self, header: Header) -> Iterator[str]:
        """Yield the header and what opens the program below it."""
        words = self.words
        yield from map(self.remark, self.header(header))
        name = plain(f"{header.name}.{self.program.setup.name}", words.line_length)
        yield from (line.format(program=name) for line in words.opening)

    def closed(self) -> Iterator[str]:
        """Yield the lines without numbers at the end."""
        yield from self.words.closing

    def remark(self, text: str) -> str:
        """Return the line of a comment."""
        return comment(self.words, text)

    def offset(self) -> str:
        """Return what names the setup's work offset."""
        return self.program.setup.work_offset

    def header(self, header: Header) -> Iterator[str]:
        """Yield the lines of the header in words, the stamp first."""
        yield from header.stamp(f"{header.name}.{self.program.setup.name}")
        yield from header.about([self.program], self.settings.units)
        if self.turns:
            yield "X IS A DIAMETER WHILE THE WORK TURNS"
        if self.work_position is not None:
            yield from self.work_position_lines(self.work_position)

    def work_position_lines(self, work_position: WorkPosition) -> Iterator[str]:
        """Yield the lines of the header that say where the work stands, and what follows for the words."""
        yield from work_position_lines(self.program.setup, work_position, self.settings.units)

    def numbered(self, line: str) -> str:
        """Return a line with the next number."""
        self.number += self.settings.number_step
        return f"N{self.number} {line}"

    def section(self, section: ProgramSection) -> Iterator[str]:
        """Yield one operation: its comment, the state it needs in full (so that a run may start here), its motions."""
        section = self.with_known_feeds(section)
        words, modal, tool = self.words, self.modal, section.tool
        refuse_unwritable(section, words.title, words.coolant)
        yield self.remark(f"OPERATION {section.operation}")
        yield self.remark(
            f"RESTART POINT {self.restart_point()} TOOL {tool.number} {tool.name}",
        )
        changes = tool.number != modal.tool
        if changes:
            spindle = trimmed(section.spindle, 0)
            yield from map(self.numbered, self.left())
            yield from map(self.numbered, tool_change(modal, tool, spindle))
        if words.restart:
            yield self.numbered(words.restart.format(offset=self.offset()))
        yield from map(self.numbered, self.plane(section))
        yield from map(self.numbered, self.spindle(section, changes))
        yield from map(self.numbered, coolant(modal, section.coolant))
        modal.feed_mode = FeedMode.MINUTE
        modal.feeds = FeedFormat(
            mode=section.feed_mode, spindle=section.spindle, surface_speed=section.surface_speed
        )
        yield from self.motions(section, changes)

    def restart_point(self) -> str:
        """Return how the line after the next one is called."""
        return f"N{self.number + self.settings.number_step}"

    def plane(self, section: ProgramSection) -> Iterator[str]:
        """Yield the words of a section's plane where the program turns work; raise `Refused` where the control can't."""
        self.modal.plane = TURNING if section.path.work_turns else MILLING
        if not self.turns:
            return
        if not self.words.turning or self.work_position is not None:
            raise Refused(
                f"operation {section.operation}: {self.words.title} has no words for work that turns"
                + (" on a machine with rotary axes" if self.work_position is not None else "")
            )
        yield self.words.turning if section.path.work_turns else self.words.milling

    def with_known_feeds(self, section: ProgramSection) -> ProgramSection:
        """Return a section with feeds by the minute where the control has no word for another way: they say the same."""
        known = feed_word(self.words, section.feed_mode)
        return section if known else replace(section, feed_mode=FeedMode.MINUTE)

    def spindle(self, section: ProgramSection, changed: bool) -> Iterator[str]:
        """Yield the words that turn the spindle; once a program has constant surface speeds, each section says what its S is.

        `changed` says that the tool has just come into it.
        """
        words, turns = self.words, trimmed(section.spindle, 0)
        if section.tool.locked:
            yield locked_spindle(words, section)
            return
        if section.surface_speed > 0.0:
            if not words.surface_speed:
                raise Refused(
                    f"operation {section.operation}: {words.title} has no words for a constant surface speed; "
                    "give a spindle speed or choose another control"
                )
            speed = surface_text(section.surface_speed, self.settings.units)
            yield words.surface_speed.format(highest=turns, speed=speed)
            return
        surfaces = any(s.surface_speed > 0.0 for s in self.program.sections)
        yield (words.spindle_speed if surfaces else words.spindle).format(spindle=turns)

    def motions(self, section: ProgramSection, changed: bool) -> Iterator[str]:
        """Yield the approach and the blocks of a section."""
        modal = self.modal
        axes = TurningForm(scale=modal.scale) if section.path.work_turns else self.axes
        path, minutes = axes.blocks(section, modal.angle, not changed)
        first, angle = path.point[0].tolist(), path.more[0].tolist()
        yield from map(self.numbered, approach(modal, section.tool, first, angle, changed))
        yield from self.blocks(section, path, minutes)

    def blocks(self, section: ProgramSection, path: WrittenPath, minutes: Floats) -> Iterator[str]:
        """Yield the blocks of a section after its first, which the tool has reached already."""
        numbered = self.numbered
        yield from map(numbered, self.waited(float(path.dwell[0]), section))
        cycles = self.cycles()
        for first, after, alike in runs(path, minutes):
            if alike and self.modal.writes_many():
                yield from map(numbered, cycles.ended())
                yield from map(numbered, self.modal.straight(path, first, after))
            else:
                yield from self.one_by_one(section, path, minutes, range(first, after), cycles)
        yield from map(numbered, cycles.ended())

    def one_by_one(
        self,
        section: ProgramSection,
        path: WrittenPath,
        minutes: Floats,
        rows: range,
        cycles: CycleCallWriter | CycleWriter,
    ) -> Iterator[str]:
        """Yield the blocks of some rows of a section, with all the cycles and helices that begin among them."""
        numbered, lines_of = self.numbered, self.modal.lines
        begins, after = {c.first: c for c in path.cycles if c.first in rows}, rows.start
        part = slice(rows.start, rows.stop)
        blocks = zip(
            rows,
            path.blocks(part),
            path.more[part].tolist(),
            minutes[part].tolist(),
            path.dwell[part].tolist(),
            strict=True,
        )
        for row, block, turned, time, dwell in blocks:
            if row < after:
                continue
            if row in begins and (lines := cycles.lines(path, begins[row])):
                yield from map(numbered, lines)
                after = begins[row].last + 1
                continue
            yield from map(numbered, cycles.ended())
            if self.words.whole_turns and block[2] >= Motion.ARC_CW and time == 0.0:
                last = self.last_of_arc(path, row)
                yield from map(numbered, self.arc(path, row, last))
                after, dwell = last + 1, float(path.dwell[last])
            else:
                yield from map(numbered, lines_of(block, turned, time))
            if dwell > 0.0:
                yield from map(numbered, self.waited(dwell, section))

    def cycles(self) -> CycleCallWriter | CycleWriter:
        """Return what writes the drilling cycles of a section."""
        return CycleCallWriter(self.modal) if self.words.cycle_calls else CycleWriter(self.modal)

    def last_of_arc(self, path: WrittenPath, row: int) -> int:
        """Return the last of the rows that are written with an arc."""
        return last_of_helix(path, row)

    def arc(self, path: WrittenPath, row: int, last: int) -> Iterator[str]:
        """Yield the line of an arc, or of a helix that ends at a later row."""
        turns = f" {self.words.whole_turns}{last - row}" if last > row else ""
        yield self.modal.block(block_of(path, last), path.more[last].tolist(), 0.0) + turns

    def waited(self, seconds: float, section: ProgramSection) -> Iterator[str]:
        """Yield the line that makes the tool stand; raise `Refused` where the control has no words for it."""
        if seconds <= 0.0:
            return
        code, letter = code_of(self.words, "dwell"), self.words.letters.get("dwell", "")
        if not code or not letter:
            raise Refused(
                f"operation {section.operation}: {self.words.title} has no words for a dwell"
            )
        yield f"{code} {letter}{dwell_text(seconds, self.words.dwell_parts)}"


def locked_spindle(words: IsoWords, section: ProgramSection) -> str:
    """Return the word that locks the spindle; raise `Refused` where the control has none."""
    code = code_of(words, "locked spindle")
    if not code:
        raise Refused(
            f"operation {section.operation}: {words.title} has no word for a locked spindle; mill the gaps (casing.interrupted = no) or "
            "choose another control"
        )
    return code


def _range(codes: tuple[str, ...]) -> str:
    """Return codes as a message lists them: many by the first and the last ones."""
    few = codes if len(codes) <= _MOST_LISTED else (*codes[: _MOST_LISTED - 2], "...", codes[-1])
    return ", ".join(few)


def _axis_form(
    words: IsoWords, settings: PostSettings, work_position: WorkPosition | None
) -> AxisForm:
    scale = TickScale.of(settings, words.extra_decimals_inch, words.feed_decimals)
    if work_position is None:
        return ThreeAxes(scale=scale)
    if not words.inverse_time:
        raise Refused(
            f"{words.title} has no words for the rotary axes of {work_position.machine.title}; choose another control or machine"
        )
    path_tolerance = PathTolerance(feed=settings.straying, rapid=settings.rapid_straying)
    return JointForm(
        work_position=work_position,
        scale=scale,
        degrees=degrees_of(words),
        path_tolerance=path_tolerance,
    )
