"""What stands at the top of every program: what it is for, and whether it may run.

The first lines are the stamp: always the same number, so that a text keeps its line numbers when it is stamped anew after its proof.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from trunnion.findings import BadCall, Severity
from trunnion.model.motion.program import Program
from trunnion.model.session import Session
from trunnion.model.setup import Setup
from trunnion.model.tool import AnyTool
from trunnion.model.verdict import Verdict
from trunnion.settings import digest
from trunnion.shop.kinematics import WorkPosition
from trunnion.units import MM_PER_INCH, trimmed

REJECTED = "REJECTED"
STAMP_LINES = 5
_MOST_REASONS = 6
_UNITS = re.compile(r"[\d\W]*(?:PPRINT/)?UNITS (MM|INCH)\W*")


@dataclass(frozen=True, slots=True, kw_only=True)
class Header:
    """What a program says of itself.

    `name` is the NAME of its files, `part_digest` of the part's file, `plan_digest` of blank, process tree and toolpaths; `date` is given
    by the caller, never the clock's. Without a `verdict` the text is stamped as rejected: nothing has proven it. `units` are those of the
    text's lengths: a stamp may have to name them.
    """

    name: str
    part: str
    part_digest: str
    plan_digest: str
    material: str = ""
    date: str = ""
    verdict: Verdict | None = None
    units: str = "mm"

    @classmethod
    def of(cls, session: Session, *, name: str = "", date: str = "") -> Header:
        """Return the header of a session's texts before their proof; raise `BadCall` while there is no plan."""
        if session.part is None or session.process is None:
            raise BadCall("no operations yet: generate the route first")
        return cls(
            name=name or session.part.name,
            part=session.part.name,
            part_digest=session.part.digest,
            plan_digest=plan_digest(session),
            material=session.process.material,
            date=date,
        )

    @property
    def rejected(self) -> bool:
        """Whether the text must be stamped as rejected: unproven, failed, or proven with an error."""
        return (
            self.verdict is None
            or not self.verdict.releases
            or any(f.severity is Severity.ERROR for f in self.verdict.findings)
        )

    def reasons(self) -> tuple[str, ...]:
        """Return why the program is rejected, or the remarks it is released with, the most important first."""
        if self.verdict is None:
            return ("not proven",)
        v = self.verdict
        measured = [
            (v.gouge > 0.0, f"gouge {trimmed(v.gouge, 4)} mm"),
            (v.collisions > 0, f"{v.collisions} collisions"),
            (v.rapids_in_stock > 0, f"{v.rapids_in_stock} rapids in stock"),
        ]
        figures = tuple(text for holds, text in measured if holds) if self.rejected else ()
        heavy = (
            (Severity.ERROR, Severity.WARNING)
            if self.rejected
            else (Severity.WARNING, Severity.REMARK)
        )
        found = tuple(
            f"{f.text} {' '.join(f.where[:2])}".strip()
            for s in heavy
            for f in v.findings
            if f.severity is s
        )
        reasons = figures + found or (
            (f"coverage {100 * v.coverage:.2f} %",) if self.rejected else ()
        )
        more = len(reasons) - _MOST_REASONS
        return reasons if more <= 0 else (*reasons[:_MOST_REASONS], f"and {more} more")

    def stamp(self, program: str) -> tuple[str, ...]:
        """Return the first lines of a text in words: name, whether it may run, verdict, reasons, date. Always `STAMP_LINES` of them."""
        v = self.verdict
        verdict = (
            "NONE"
            if v is None
            else f"{v.outcome.value.upper()}, coverage {100 * v.coverage:.2f} %, gouge {trimmed(v.gouge, 4)} mm"
        )
        if v is not None and v.accepted_by:
            verdict += f", shortfall accepted by {v.accepted_by}"
        may = f"{REJECTED}: DO NOT RUN" if self.rejected else "RELEASED"
        why = ("REASON: " if self.rejected else "REMARKS: ") + (", ".join(self.reasons()) or "none")
        return (
            f"TRUNNION PROGRAM {program}",
            may,
            f"VERDICT: {verdict}",
            why,
            f"DATE: {self.date or 'not given'}",
        )

    def about(self, programs: Sequence[Program], units: str) -> tuple[str, ...]:
        """Return the lines below the stamp in words: part, plan, setups, units and the tools in use."""
        lines = [f"PART {self.part} SHA256 {self.part_digest}", f"PLAN {self.plan_digest}"]
        if self.material:
            lines.append(f"MATERIAL {self.material}")
        lines += [
            f"SETUP {p.setup.name} {p.setup.work_offset} MACHINE {p.setup.machine} CLEARANCE {_length(p.setup.clearance, units)}"
            for p in programs
        ]
        lines += [f"FRAME {p.setup.name} {_frame(p, units)}" for p in programs]
        lines.append(f"UNITS {units.upper()}")
        return (*lines, *(tool_line(t, units) for t in tools_of(programs)))


def work_position_lines(setup: Setup, work_position: WorkPosition, units: str) -> tuple[str, ...]:
    """Return the lines of a header that say where the work stands and what the words of rotary axes mean; a reader compares the first."""
    rotary = work_position.machine.rotary
    coordinates = " ".join(
        f"{letter}{_length(-v, units)}"
        for letter, v in zip("XYZ", work_position.foot.tolist(), strict=True)
    )
    zero = " ".join(f"{a.name}0" for a in rotary)
    lines = [
        f"STANDS {setup.name} {coordinates} FROM THE MIDDLE OF THE TABLE OF {work_position.machine.name}",
        f"WORDS ARE POSITIONS OF THE MACHINE'S AXES, {setup.work_offset} IS THE ORIGIN OF {setup.name} WHERE IT STANDS WITH {zero}",
    ]
    if any(a.carries == "tool" for a in rotary):
        lines.append("TOOL LENGTHS ARE IN THE WORDS: TOOLS MUST HAVE THE LENGTHS LISTED")
    if any(a.carries == "work" for a in rotary):
        lines.append("THE PLACE ON THE TABLE IS IN THE WORDS: THE WORK MUST STAND THERE")
    return tuple(lines)


def units_of(lines: Sequence[str]) -> str:
    """Return the units that a text's header says its lengths are in.

    >>> units_of(["0 BEGIN PGM S1 INCH", "9 ; UNITS INCH"]), units_of(["(UNITS MM)"])
    ('inch', 'mm')
    """
    found = next((m for line in lines if (m := _UNITS.fullmatch(line))), None)
    return found.group(1).lower() if found else "mm"


def plan_digest(session: Session) -> str:
    """Return the digest of a session's blank, process tree and toolpaths."""
    return digest(
        session.blank, session.process, tuple((p.operation, p.key) for p in session.paths)
    )


def tools_of(programs: Sequence[Program]) -> tuple[AnyTool, ...]:
    """Return the tools of some programs, each once, by number."""
    by_number = {(s.tool.number, s.tool.name): s.tool for p in programs for s in p.sections}
    return tuple(by_number[key] for key in sorted(by_number))


def _length(value: float, units: str) -> str:
    return trimmed(value / MM_PER_INCH, 5) if units == "inch" else trimmed(value, 4)


def _frame(program: Program, units: str) -> str:
    frame = program.setup.frame
    numbers: list[tuple[str, list[Any]]] = [
        ("ORIGIN", [_length(v, units) for v in frame.origin]),
        ("X", [trimmed(v, 6) for v in frame.x]),
        ("Z", [trimmed(v, 6) for v in frame.z]),
    ]
    return " ".join(f"{word} {' '.join(values)}" for word, values in numbers)


def tool_line(tool: AnyTool, units: str) -> str:
    """Return the line of the header that describes a tool; a reader compares it with the tool list."""
    sizes = " ".join(f"{word}{_length(value, units)}" for word, value in tool.header_sizes())
    return f"TOOL {tool.number} {tool.name} {sizes} HOLDER {tool.holder_name}"
