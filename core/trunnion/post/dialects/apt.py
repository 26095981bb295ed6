"""APT cutter location text with the words of ISO 4343, all setups in one; positions in each setup's frame.

Where any tool leans, every GOTO has the tool axis too (MULTAX/ON): between two of them the tip goes straight and the axis turns evenly.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from trunnion import tolerance
from trunnion.findings import BadCall
from trunnion.model.guides import GuideChain
from trunnion.model.motion.program import Program, ProgramSection
from trunnion.model.motion.toolpath import Motion, Toolpath
from trunnion.model.setup import Setup
from trunnion.model.spindle import FeedMode, per_revolution
from trunnion.model.tool import AnyTool
from trunnion.post.header import Header
from trunnion.post.linearize import lines_for_arcs
from trunnion.post.settings import PostSettings
from trunnion.post.ticks import TickScale, WrittenPath, upright, written
from trunnion.post.words import dialect_words, plain, refuse_unwritable
from trunnion.post.writer.feed import FeedFormat, dwell_text, revolution_text, surface_text
from trunnion.shop.kinematics import NO_WORK_POSITIONS, WorkPositions
from trunnion.units import trimmed


@dataclass(frozen=True, slots=True, kw_only=True)
class AptWords:
    """The words of `dialects/apt.toml`."""

    title: str
    suffix: str
    line_length: int
    feed_decimals: int
    extra_decimals_inch: int
    end: tuple[str, ...]
    units: dict[str, str]
    feed: dict[str, str]
    feed_per_revolution: dict[str, str]
    revolution_decimals: int
    surface: dict[str, str]
    coolant: dict[str, str]
    axis_decimals: int


class AptDialect:
    """Writes all setups as one CL text and reads it back."""

    name = "apt"

    def __init__(self) -> None:
        self.words = dialect_words(AptWords, self.name)
        self.suffix = self.words.suffix

    def write(
        self,
        programs: Sequence[Program],
        header: Header,
        settings: PostSettings,
        work_positions: WorkPositions = NO_WORK_POSITIONS,
    ) -> str:
        """Return the text of all setups' programs."""
        if not programs:
            raise BadCall("no program to write")
        lines = (*self.stamp(header.name, header), *_lines(self.words, programs, header, settings))
        return "\n".join(lines) + "\n"

    def stamp(self, program: str, header: Header) -> tuple[str, ...]:
        """Return the stamp's lines: PARTNO with the name, the others printed."""
        first, *others = header.stamp(program)
        return (
            f"PARTNO/{plain(first, self.words.line_length)}",
            *(_print(self.words, line) for line in others),
        )

    def read(
        self,
        text: str,
        tools: Sequence[AnyTool],
        setups: Sequence[Setup],
        work_positions: WorkPositions = NO_WORK_POSITIONS,
    ) -> tuple[Program, ...]:
        """Return the programs of the setups that the text names."""
        from trunnion.post.readers.apt.interpreter import read_apt

        return read_apt(text, tools, setups)


def _print(words: AptWords, text: str) -> str:
    return f"PPRINT/{plain(text, words.line_length)}"


def _lines(
    words: AptWords, programs: Sequence[Program], header: Header, settings: PostSettings
) -> Iterator[str]:
    yield from (_print(words, line) for line in header.about(programs, settings.units))
    yield words.units[settings.units]
    leans = any(leaning(section.path) for program in programs for section in program.sections)
    yield "MULTAX/ON" if leans else "MULTAX/OFF"
    scale = TickScale.of(settings, words.extra_decimals_inch, words.feed_decimals)
    axes = (
        TickScale(unit=1.0, decimals=words.axis_decimals, feed_decimals=words.feed_decimals)
        if leans
        else None
    )
    for program in programs:
        yield _print(words, f"SETUP {program.setup.name} WORK OFFSET {program.setup.work_offset}")
        tool = None
        for section in program.sections:
            yield from _section(words, section, scale, section.tool.number != tool, settings.units)
            yield from _motions(
                _blocks(section, scale, axes, settings.path_tolerance),
                scale,
                axes,
                _feed_words(words, section, scale, settings.units),
            )
            tool = section.tool.number
    yield from words.end


def leaning(path: Toolpath) -> bool:
    """Return whether the tool leans anywhere on a path."""
    return not path.work_turns and bool(
        (np.abs(path.axis[:, :2]).max(axis=1, initial=0.0) > tolerance.PARAMETRIC).any()
    )


def _section(
    words: AptWords, section: ProgramSection, scale: TickScale, changes: bool, units: str
) -> Iterator[str]:
    """Yield the head of one operation: its name, the tool when it changes, spindle, coolant."""
    tool = section.tool
    refuse_unwritable(section, words.title, words.coolant)
    yield _print(words, f"OPERATION {section.operation}")
    if changes:
        sizes = scale.ticks(np.array([*tool.cutter_sizes, tool.gauge_length]))
        diameter, radius, length = (scale.text(v) for v in sizes.tolist())
        yield f"LOADTL/{tool.number},LENGTH,{length}"
        yield f"CUTTER/{diameter},{radius}"
    turns = trimmed(section.spindle, 0)
    if tool.locked:
        yield "SPINDL/LOCK"
    elif section.surface_speed > 0.0:
        speed = f"{words.surface[units]},{surface_text(section.surface_speed, units)}"
        yield f"SPINDL/{speed},CLW,MAXRPM,{turns}"
    else:
        yield f"SPINDL/RPM,{turns},CLW"
    yield words.coolant[section.coolant]
    for chain in section.guides:
        yield from guide_lines(chain)


def guide_lines(chain: GuideChain) -> Iterator[str]:
    """Yield a guide line as remarks, in the words of a part program (ISO 4342): its faces are the drive and the check surfaces of the
    motions that follow, which already are what an APT processor would make of it."""
    state = "CLOSED" if chain.closed else "OPEN"
    if not chain.on:
        for tag in chain.faces:
            yield f"$$ GUIDE/{chain.kind.upper()},{state},{_surface(tag)}"
        return
    yield f"$$ GUIDE/{chain.kind.upper()},{state}"
    for word, face, link, following in chain.elements():
        check = f",{link},{_surface(following)}" if link is not None else ""
        yield f"$$ TLLFT,{word}/{_surface(face)}{check}"


def _surface(tag: int) -> str:
    """Return the name of a face's surface in a part program."""
    return f"FACE{tag}" if tag else "NOFACE"


def _blocks(
    section: ProgramSection, scale: TickScale, axes: TickScale | None, within: float
) -> WrittenPath:
    """Return the blocks of a section; arcs about another axis than z are lines within a distance of them."""
    path = section.path
    if path.work_turns:
        arcs = np.flatnonzero(path.motion >= Motion.ARC_CW)
        path, _ = lines_for_arcs(path, arcs, within)
        up = np.tile([0.0, 0.0, 1.0], (len(path), 1))
        path = replace(path, axis=up, work_turns=False)
    if axes is None:
        return written(upright(path, section.operation), scale, section.operation)
    leans = np.abs(path.axis[:, :2]).max(axis=1) > tolerance.PARAMETRIC
    path, _ = lines_for_arcs(path, np.flatnonzero((path.motion >= Motion.ARC_CW) & leans), within)
    return written(path, scale, section.operation, axes.ticks(path.axis))


FeedText = Callable[[float, int], str]
"""Returns the FEDRAT statement of a feed in mm/min for a block that ends at an X in ticks."""


def _feed_words(words: AptWords, section: ProgramSection, scale: TickScale, units: str) -> FeedText:
    if section.feed_mode is not FeedMode.REVOLUTION:
        by_feed = lru_cache(maxsize=1)(lambda v: words.feed[units].format(feed=scale.feed(v)))
        return lambda feed, _: by_feed(feed)
    feeds = FeedFormat(
        mode=section.feed_mode, spindle=section.spindle, surface_speed=section.surface_speed
    )
    mm = scale.unit / 10.0**scale.decimals

    def by_revolution(feed: float, x: int) -> str:
        share = per_revolution(feed, feeds.turns(x * mm))
        return words.feed_per_revolution[units].format(feed=revolution_text(share, scale, words))

    return by_revolution


def _motions(
    path: WrittenPath, scale: TickScale, axes: TickScale | None, feed_text: FeedText
) -> Iterator[str]:
    last_feed = ""
    numbers = [scale.texts(v) for v in path.point.T]
    if axes is not None:
        numbers += [axes.texts(v) for v in path.more.T]
    rows = zip(
        map(",".join, zip(*numbers, strict=True)),
        path.motion.tolist(),
        path.feed.tolist(),
        path.point[:, 0].tolist(),
        path.dwell.tolist(),
        strict=True,
    )
    for row, (end, motion, feed, x, dwell) in enumerate(rows):
        if motion == Motion.RAPID:
            yield "RAPID"
        elif (now := feed_text(feed, x)) != last_feed:
            last_feed = now
            yield last_feed
        if motion >= Motion.ARC_CW:
            yield _circle(path, row, scale.text)
        yield f"GOTO/{end}"
        if dwell > 0.0:
            yield f"DELAY/{dwell_text(dwell)}"


def _circle(path: WrittenPath, row: int, text: Callable[[int], str]) -> str:
    """Return the statement of an arc's circle, at the height that it starts at."""
    start = path.point[row - 1].tolist() if row else [0, 0, 0]
    centre = path.centre[row].tolist()
    radius = int(round(((start[0] - centre[0]) ** 2 + (start[1] - centre[1]) ** 2) ** 0.5))
    sense = 1 if path.motion[row] == Motion.ARC_CCW else -1
    return f"CIRCLE/{text(centre[0])},{text(centre[1])},{text(start[2])},0,0,{sense},{text(radius)}"
