"""The neutral text of motions: what goldens compare and docks show. Four decimals, modal words written out, no date, no version."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from trunnion import tolerance
from trunnion.model.program import Program, ProgramSection
from trunnion.model.toolpath import Mark, Motion
from trunnion.units import trimmed

_MOTIONS = {
    Motion.RAPID: "rapid",
    Motion.LINE: "line",
    Motion.ARC_CW: "arc-cw",
    Motion.ARC_CCW: "arc-ccw",
}
_MARKS = {mark.value: mark.name.lower() for mark in Mark}


def listing(program: Program, *, marks: bool = True) -> str:
    """Return the motions of a program as text, a line a block; `marks=False` leaves out what each block is for (NC text doesn't say)."""
    setup = program.setup
    lines = [f"setup {setup.name} {setup.work_offset}"]
    for section in program.sections:
        lines.append(
            f"operation {section.operation} tool {section.tool.number} spindle {trimmed(section.spindle, 0)} "
            f"coolant {section.coolant}"
        )
        lines += _blocks(section, marks)
    return "\n".join(lines) + "\n"


def _blocks(section: ProgramSection, marks: bool) -> Iterator[str]:
    path = section.path
    tilted = path.axis[:, 2] < np.cos(tolerance.ANGLE)
    rows = zip(
        path.motion.tolist(),
        path.position.tolist(),
        path.axis.tolist(),
        path.centre.tolist(),
        path.feed.tolist(),
        path.mark.tolist(),
        tilted.tolist(),
        strict=True,
    )
    for motion, position, axis, centre, feed, mark, leans in rows:
        words = [f"{_MOTIONS[Motion(motion)]:7}", *_numbers("xyz", position)]
        if leans:
            words += _numbers("ijk", axis)
        if motion >= Motion.ARC_CW:
            words += ["centre", *_numbers("xy", centre[:2])]
        if motion != Motion.RAPID:
            words.append(f"feed {feed:.1f}")
        if marks:
            words.append(_MARKS[mark])
        yield " ".join(words)


def _numbers(letters: str, values: list[float]) -> list[str]:
    """Return numbers with four decimals and their letters, without negative zeros."""
    return [
        f"{letter} {round(value, 4) + 0.0:.4f}"
        for letter, value in zip(letters, values, strict=True)
    ]
