"""A programming session: an immutable tree. Every step gives a new one; undo keeps the earlier one."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from trunnion.findings import Finding
from trunnion.geometry.arrays import Floats
from trunnion.geometry.cut import Cut
from trunnion.model.blank import Blank
from trunnion.model.feature import Recognition
from trunnion.model.fixture import Fixture
from trunnion.model.operation import OperationPath
from trunnion.model.process import ProcessTree
from trunnion.model.repair import RepairRound
from trunnion.model.setup import Setup
from trunnion.model.verdict import Verdict
from trunnion.settings import Value, added


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PartInfo:
    """What a session keeps of its part: enough to find it again and to notice that it changed.

    `digest` is of the file's bytes; `unit` the file's own ("mm", "inch", ...); `low`, `high` the box (3,) mm.
    """

    path: str
    name: str
    digest: str
    unit: str
    n_faces: int
    n_solids: int
    solid: int
    area: float
    volume: float
    low: Floats
    high: Floats
    findings: tuple[Finding, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class SizeEntry:
    """One line of the size table. `at` is a point of the part (x, y, z) or empty; a distance is measured from there to the point `to`.

    A line of the part that is as long as the value has the points of its `curve`, radius and height in turn.
    """

    name: str
    value: float
    unit: str
    feature: str
    faces: tuple[int, ...] = ()
    at: tuple[float, ...] = ()
    to: tuple[float, ...] = added((), written=False)
    curve: tuple[float, ...] = added((), written=False)

    def as_dict(self) -> dict[str, object]:
        """Return the entry as the JSON that other programs rely on."""
        entry: dict[str, object] = {
            "name": self.name,
            "value": self.value,
            "unit": self.unit,
            "feature": self.feature,
            "faces": list(self.faces),
            "at": list(self.at),
        }
        if self.to:
            entry["to"] = list(self.to)
        if self.curve:
            pairs = zip(self.curve[::2], self.curve[1::2], strict=True)
            entry["curve"] = [list(pair) for pair in pairs]
        return entry


@dataclass(frozen=True, slots=True, kw_only=True)
class StepRecord:
    """When a step is done: the digest of what it read, how long it took, what it found."""

    key: str
    seconds: float
    findings: tuple[Finding, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class PostedFile:
    """One written NC or CL text: `suffix` of its file name (`S1.nc`, `cl`), dialect, setup name (empty for all) and text."""

    suffix: str
    dialect: str
    setup: str
    text: str


@dataclass(frozen=True, eq=False, kw_only=True)
class Session:
    """Everything known about one part's programming. What is `None` or empty has not been computed.

    `cuts` divide faces of the part as read, in their order; `part` and every tag are those of the part after them.
    """

    part: PartInfo | None = None
    cuts: tuple[Cut, ...] = ()
    choices: Mapping[str, Value] = field(default_factory=dict)
    recognition: Recognition | None = None
    sizes: tuple[SizeEntry, ...] = ()
    blank: Blank | None = None
    setups: tuple[Setup, ...] = ()
    fixtures: tuple[Fixture, ...] = ()
    process: ProcessTree | None = None
    paths: tuple[OperationPath, ...] = ()
    posted: tuple[PostedFile, ...] = ()
    verdict: Verdict | None = None
    repairs: tuple[RepairRound, ...] = added((), written=False)
    records: Mapping[str, StepRecord] = field(default_factory=dict)

    def path_of(self, operation: str) -> OperationPath | None:
        """Return the toolpath of an operation, or None when it has not been made."""
        return next((p for p in self.paths if p.operation == operation), None)

    def fixtures_of(self, setup: str) -> tuple[Fixture, ...]:
        """Return the fixtures that are there in a setup."""
        return tuple(f for f in self.fixtures if f.setup in ("", setup))

    def findings(self) -> tuple[Finding, ...]:
        """Return the findings of the part and of every step that is done, in the order of the work."""
        own = self.part.findings if self.part else ()
        return own + tuple(f for record in self.records.values() for f in record.findings)
