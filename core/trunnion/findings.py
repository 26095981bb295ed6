"""What a person should know (`Finding`) and what stops the work (`TrunnionError` and its tree).

TrunnionError            one clear line; the command line exits with 2
├── BadInput             a file or value that can't be used
├── BadCall              the program was called in a way it doesn't understand
├── OutOfMemory          the work would need more memory than allowed; the remedy is in the line
└── Refused              a release or a step that the program won't do, and why
Cancelled                not an error: a person asked to stop; the session stays as it was
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from enum import StrEnum


class TrunnionError(Exception):
    """Something that stops the work, in one line that says what, where and what to do."""


class BadInput(TrunnionError):
    """A file or a value that can't be used."""


class BadCall(TrunnionError):
    """A call that the program doesn't understand."""


class OutOfMemory(TrunnionError):
    """The work would need more memory than allowed."""


class Refused(TrunnionError):
    """Something the program won't do, such as releasing a program that failed its proof."""


class Cancelled(Exception):
    """A person asked to stop."""


ADDED_UNWRITTEN = {"added": True, "written": False}
"""What `settings.added(written=False)` says of a field, for this floor below it: no part of digests and files at its default."""
MOST_SHOWN = 8
"""Names that a line about a finding shows."""


class Severity(StrEnum):
    """How much a finding matters: `error` makes the exit code 1, `remark` lets a program be released with remarks."""

    INFO = "info"
    REMARK = "remark"
    WARNING = "warning"
    ERROR = "error"


@dataclass(frozen=True, slots=True, kw_only=True)
class Fix:
    """A change of the plan that a finding asks for: an input of the planner, never an edit of motions.

    `kind` is a registered name (`registry.FIXES`), `operation` the id of the operation to be changed (empty where `faces` say what is to be
    finished), `reason` the code of the finding; `amount` what was measured: how deep something enters, mm, or for `feed` the share of the
    feed that a limit leaves. `boxes` say where, as the lowest and the highest corner (x, y, z, x, y, z) in mm in the setup's frame of what
    the tip runs through; none where that isn't known, of a tool that leans.
    """

    kind: str
    operation: str = ""
    reason: str = ""
    amount: float = 0.0
    faces: tuple[int, ...] = ()
    boxes: tuple[tuple[float, ...], ...] = field(default=(), metadata=ADDED_UNWRITTEN)

    def as_dict(self) -> dict[str, object]:
        """Return the fix as the JSON that other programs rely on."""
        entry: dict[str, object] = {
            "kind": self.kind,
            "operation": self.operation,
            "reason": self.reason,
            "amount": self.amount,
            "faces": list(self.faces),
        }
        return {**entry, "boxes": [list(b) for b in self.boxes]} if self.boxes else entry


@dataclass(frozen=True, slots=True, kw_only=True)
class Finding:
    """One thing a person should know.

    `code` is stable and dotted (`panel.leaning-wall`), `where` names faces, features, operations or blocks in words
    that the window and the report can show (`face 12`, `pocket-03`, `block 118`), `remedy` says what to do, and `fix` the
    same for the planner where it can be said so.
    """

    severity: Severity
    code: str
    text: str
    where: tuple[str, ...] = ()
    remedy: str = ""
    fix: Fix | None = field(default=None, metadata=ADDED_UNWRITTEN)

    @property
    def location(self) -> str:
        """The first `MOST_SHOWN` names of `where` and how many more there are, as a line on a screen has room for; JSON has all."""
        shown, more = ", ".join(self.where[:MOST_SHOWN]), len(self.where) - MOST_SHOWN
        return f"{shown} and {more} more" if more > 0 else shown

    def as_dict(self) -> dict[str, object]:
        """Return the finding as the JSON that other programs rely on."""
        entry: dict[str, object] = {
            "severity": self.severity.value,
            "code": self.code,
            "text": self.text,
            "where": list(self.where),
            "remedy": self.remedy,
        }
        return entry if self.fix is None else {**entry, "fix": self.fix.as_dict()}

    def __str__(self) -> str:
        where = f" ({self.location})" if self.where else ""
        remedy = f": {self.remedy}" if self.remedy else ""
        return f"{self.severity.value} {self.code}: {self.text}{where}{remedy}"


def info(code: str, text: str, *where: str, remedy: str = "") -> Finding:
    """Return a finding that only informs."""
    return Finding(severity=Severity.INFO, code=code, text=text, where=where, remedy=remedy)


def remark(code: str, text: str, *where: str, remedy: str = "", fix: Fix | None = None) -> Finding:
    """Return a finding about time, surface quality or a chosen omission; a program with it may be released."""
    return Finding(
        severity=Severity.REMARK, code=code, text=text, where=where, remedy=remedy, fix=fix
    )


def warning(code: str, text: str, *where: str, remedy: str = "", fix: Fix | None = None) -> Finding:
    """Return a finding that a person should look at before cutting."""
    return Finding(
        severity=Severity.WARNING, code=code, text=text, where=where, remedy=remedy, fix=fix
    )


def error(code: str, text: str, *where: str, remedy: str = "", fix: Fix | None = None) -> Finding:
    """Return a finding that keeps a program from being released."""
    return Finding(
        severity=Severity.ERROR, code=code, text=text, where=where, remedy=remedy, fix=fix
    )


def has_errors(findings: Iterable[Finding]) -> bool:
    """Return whether any finding is an error."""
    return any(f.severity is Severity.ERROR for f in findings)


def face_tags(faces: Iterable[int]) -> tuple[str, ...]:
    """Return the words that name faces in a finding, each once, in the order of their tags.

    >>> face_tags([3, 1, 3])
    ('face 1', 'face 3')
    """
    return tuple(f"face {n}" for n in sorted(set(faces)))
