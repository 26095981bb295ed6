"""The neutral text of motions: what goldens compare and docks show. Four decimals, modal words written out, no date, no version."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np

from trunnion import tolerance
from trunnion.model.motion.program import Program, ProgramSection
from trunnion.model.motion.toolpath import Mark, Motion
from trunnion.model.spindle import FeedMode, per_revolution
from trunnion.units import trimmed

_MOTIONS = {
    Motion.RAPID: "rapid",
    Motion.LINE: "line",
    Motion.ARC_CW: "arc-cw",
    Motion.ARC_CCW: "arc-ccw",
}
_FEED_MODES = {
    FeedMode.MINUTE: "",
    FeedMode.REVOLUTION: " feeds by revolution",
    FeedMode.INVERSE: " feeds in inverse time",
}
_MARKS = {mark.value: mark.name.lower() for mark in Mark}


def listing(program: Program, *, marks: bool = True) -> str:
    """Return the motions of a program as text, a line a block; `marks=False` leaves out what each block is for (NC text doesn't say)."""
    setup = program.setup
    lines = [f"setup {setup.name} {setup.work_offset}"]
    for section in program.sections:
        lines.append(
            f"operation {section.operation} tool {section.tool.number} spindle {_spindle(section)} "
            f"coolant {section.coolant}{_FEED_MODES[section.feed_mode]}{' turning' * section.path.work_turns}"
        )
        lines += _blocks(section, marks)
    return "\n".join(lines) + "\n"


def _spindle(section: ProgramSection) -> str:
    """Return the spindle's speed in words: in 1/min, or what it keeps at the surface in m/min and the highest."""
    turns = trimmed(section.spindle, 0)
    if section.surface_speed <= 0.0:
        return turns
    return f"surface {trimmed(section.surface_speed, 1)} highest {turns}"


def _feeds(section: ProgramSection) -> list[str]:
    """Return the feed of each block in words."""
    if section.feed_mode is not FeedMode.REVOLUTION:
        return [f"feed {feed:.1f}" for feed in section.path.feed.tolist()]
    feeds = per_revolution(section.path.feed, section.turns())
    return [f"feed {feed:.4f} a revolution" for feed in feeds.tolist()]


def _blocks(section: ProgramSection, marks: bool) -> Iterator[str]:
    path = section.path
    tilted = (path.axis[:, 2] < np.cos(tolerance.ANGLE)) & (not path.work_turns)
    plane = [0, 2] if path.work_turns else [0, 1]
    rows = zip(
        path.motion.tolist(),
        path.position.tolist(),
        path.axis.tolist(),
        path.centre.tolist(),
        _feeds(section),
        path.mark.tolist(),
        tilted.tolist(),
        path.dwells().tolist(),
        strict=True,
    )
    for motion, position, axis, centre, feed, mark, leans, dwell in rows:
        words = [f"{_MOTIONS[Motion(motion)]:7}", *_numbers("xyz", position)]
        if leans:
            words += _numbers("ijk", axis)
        if motion >= Motion.ARC_CW:
            words += ["centre", *_numbers(["xyz"[k] for k in plane], [centre[k] for k in plane])]
        if motion != Motion.RAPID:
            words.append(feed)
        if dwell > 0.0:
            words.append(f"dwell {trimmed(dwell, 3)}")
        if marks:
            words.append(_MARKS[mark])
        yield " ".join(words)


def _numbers(letters: Iterable[str], values: list[float]) -> list[str]:
    """Return numbers with four decimals and their letters, without negative zeros."""
    return [
        f"{letter} {round(value, 4) + 0.0:.4f}"
        for letter, value in zip(letters, values, strict=True)
    ]
