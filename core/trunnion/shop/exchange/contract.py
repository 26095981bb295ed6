"""What a format of tool libraries is, and what is lost between it and the catalogue.

A user's own package adds a format by an entry point `trunnion.tool_formats`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from pathlib import Path
from typing import Protocol

from trunnion import registry
from trunnion.findings import BadCall, BadInput, Finding, info, remark, warning
from trunnion.model.tool import Holder
from trunnion.shop.cutters import Cutter
from trunnion.units import MM_PER_INCH

UNITS: Mapping[str, float] = {"mm": 1.0, "inch": MM_PER_INCH}
"""Units of length that a library may be in, in mm."""
WHOLE_TOOL = "tool"
"""The field of a loss that is about a whole tool."""
Plain = float | int | bool | str
"""A value of a loss; rows and lists stand there as text."""


class LossKind(StrEnum):
    """What happened to a field between two libraries."""

    LOST = "lost"
    """A field of ours that the file can't hold."""
    IGNORED = "ignored"
    """A field of theirs that there is no place for here."""
    ASSUMED = "assumed"
    """A value that neither side gives, and what was taken for it."""
    OMITTED = "left out"
    """A whole tool that was not taken, or not written."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Loss:
    """One thing that did not come through.

    `tool` is the tool's name; `field` one of ours (`fields.fields_of`) where a field of ours is lost or assumed, else the other
    program's word; `value` what was lost or assumed; `why` a clause that says the reason.
    """

    kind: LossKind
    tool: str
    field: str
    value: Plain
    why: str

    def as_dict(self) -> dict[str, object]:
        """Return the loss as JSON has it."""
        return {
            "kind": self.kind.value,
            "tool": self.tool,
            "field": self.field,
            "value": self.value,
            "why": self.why,
        }


@dataclass(frozen=True, slots=True, kw_only=True)
class ExchangeContext:
    """What a file leaves open.

    `unit` is that of formats which name none, and the one that is written; `holder` names the holder of tools that come without one
    (empty: that of the catalogue's cutter whose shank is nearest); `holders` and `cutters` are the catalogue's.
    """

    holders: Mapping[str, Holder]
    cutters: Sequence[Cutter] = ()
    unit: str = "mm"
    holder: str = ""

    def __post_init__(self) -> None:
        if self.unit not in UNITS:
            raise BadCall(f"unknown unit {self.unit}; known: {', '.join(UNITS)}")
        if self.holder and self.holder not in self.holders:
            raise BadInput(
                f"unknown holder {self.holder}; known: {', '.join(sorted(self.holders))}"
            )

    @property
    def scale(self) -> float:
        """Length in mm of one unit."""
        return UNITS[self.unit]


@dataclass(frozen=True, slots=True, kw_only=True)
class ReadTools:
    """The tools of a file in its order, with the numbers that it gives them (0: none), and what was lost."""

    cutters: tuple[Cutter, ...]
    losses: tuple[Loss, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class WrittenTools:
    """The files of a library, not on the disk yet, and what was lost; several where a format has a file for each tool."""

    files: Mapping[Path, bytes] = field(default_factory=dict)
    losses: tuple[Loss, ...] = ()


class ToolFormat(Protocol):
    """Reads and writes the tool libraries of one program. Same tools, same bytes.

    `suffixes` are the ends of its files' names, the first one the usual one; `title` names it to a person.
    """

    name: str
    title: str
    suffixes: tuple[str, ...]

    def read(self, path: Path, context: ExchangeContext) -> ReadTools:
        """Return the tools of a file and what was lost; raise `BadInput` for what is no such file or holds no tool that can be taken."""
        ...

    def write(
        self, cutters: Sequence[Cutter], path: Path, context: ExchangeContext
    ) -> WrittenTools:
        """Return the files that hold the tools, and what was lost: of our fields exactly those that the files don't give back."""
        ...


def format_of(path: Path, named: str = "") -> ToolFormat:
    """Return the format with a name, or (empty) the one whose files end as a path does; raise `BadCall` with the known ones."""
    formats: list[ToolFormat] = [
        registry.get(registry.TOOL_FORMATS, name)()
        for name in ([named] if named else registry.names(registry.TOOL_FORMATS))
    ]
    for one in formats:
        if named or path.suffix.lower() in one.suffixes:
            return one
    known = ", ".join(f"{one.name} ({' '.join(one.suffixes)})" for one in formats)
    raise BadCall(f"{path}: no format has files with this ending; name one of {known}")


_FINDINGS: Mapping[LossKind, tuple[str, Callable[..., Finding], str, str]] = {
    LossKind.LOST: ("tools.lost", remark, "not kept: ", ""),
    LossKind.IGNORED: ("tools.ignored", info, "not taken over: ", ""),
    LossKind.ASSUMED: ("tools.assumed", warning, "assumed: ", "check it before cutting"),
    LossKind.OMITTED: ("tools.left-out", warning, "left out", ""),
}
"""Code, severity, words before the fields, and remedy of the finding about each kind of loss."""
_LONGEST_VALUE = 32
"""Characters of a value that a finding shows; all of it stands in the list of losses."""


def findings_of(losses: Iterable[Loss]) -> tuple[Finding, ...]:
    """Return losses as findings: those of a kind and reason on the same tools are one, which names the fields with their values."""
    by_field: dict[tuple[LossKind, str, str], list[Loss]] = {}
    for loss in losses:
        by_field.setdefault((loss.kind, loss.why, loss.field), []).append(loss)
    groups: dict[tuple[LossKind, str, tuple[str, ...]], list[str]] = {}
    for (kind, why, name), alike in by_field.items():
        tools = tuple(dict.fromkeys(loss.tool for loss in alike))
        groups.setdefault((kind, why, tools), []).append(_with_value(name, alike))
    found = []
    for (kind, why, tools), names in groups.items():
        code, make, words, remedy = _FINDINGS[kind]
        subject = "" if kind is LossKind.OMITTED else ", ".join(names)
        found.append(make(code, f"{words}{subject}; {why}", *tools, remedy=remedy))
    return tuple(found)


def _with_value(name: str, alike: Sequence[Loss]) -> str:
    """Return a field's name, with its value where all tools have the same short one."""
    values = {str(loss.value) for loss in alike}
    value = values.pop() if len(values) == 1 else ""
    shown = value and name != WHOLE_TOOL and len(value) <= _LONGEST_VALUE
    return f"{name} = {value}" if shown else name
