"""What came of one part among many: a row of the batch's table, of its ledger and of its page."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from typing import Any

from trunnion.findings import BadInput
from trunnion.model.verdict import Outcome

REFUSED, CRASHED, OUT_OF_MEMORY, OVER_TIME = "refused", "crashed", "out of memory", "over time"
"""What is in the place of a verdict where there is none: the part can't be programmed, its process ended by itself, or was ended at one of
its limits."""
WITHOUT_VERDICT = (REFUSED, CRASHED, OUT_OF_MEMORY, OVER_TIME)
_KINDS = {
    "float": (int, float),
    "float | None": (int, float, type(None)),
    "int | None": (int, type(None)),
    "str": (str,),
    "tuple[str, ...]": (list, tuple),
    "Mapping[str, int]": (dict,),
}
"""Types that JSON has for the types of fields."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PartResult:
    """One part's result: `part` as it was named, `folder` where its files are, below the batch's.

    `verdict` is the proof's outcome or one of `WITHOUT_VERDICT`; figures are None where there is no proof. `gouge` mm, `machining_time_s`
    and `seconds` (of programming) s, `memory` the most that its processes held at once, MB. `note` says in one line why it is not
    released; `reasons` counts the findings of severity error by their codes. `files` are those written, `host` the computer of a
    cluster that did it. `memory_limit` (MB) and `time_limit` (s) are what it was allowed, 0 where nothing limited it.
    """

    part: str
    folder: str
    verdict: str
    family: str = ""
    coverage: float | None = None
    reachable: float | None = None
    gouge: float | None = None
    collisions: int | None = None
    rapids_in_stock: int | None = None
    machining_time_s: float | None = None
    seconds: float = 0.0
    memory: float = 0.0
    memory_limit: float = 0.0
    time_limit: float = 0.0
    note: str = ""
    reasons: Mapping[str, int] = field(default_factory=dict)
    files: tuple[str, ...] = ()
    host: str = ""

    @property
    def is_released(self) -> bool:
        """Whether the proof lets the part's programs be released."""
        return self.verdict in (Outcome.PASSED, Outcome.REMARKS)

    @property
    def has_problem(self) -> bool:
        """Whether there is no verdict, the proof failed, or a finding is an error."""
        return not self.is_released or bool(self.reasons)

    @property
    def report(self) -> str:
        """The file of its report, empty where there is none."""
        return next((f for f in self.files if f.endswith(".report.html")), "")

    @property
    def pictures(self) -> tuple[str, ...]:
        """The files of its pictures, in the order of the work."""
        return tuple(f for f in self.files if f.endswith(".png"))

    def as_dict(self) -> dict[str, Any]:
        """Return all fields as JSON data; `of_dict` reads it."""
        made = {f.name: getattr(self, f.name) for f in fields(self)}
        return made | {"files": list(self.files), "reasons": dict(self.reasons)}

    @classmethod
    def of_dict(cls, data: Mapping[str, Any]) -> PartResult:
        """Return the result that JSON data stand for; keys that it doesn't know are passed over.

        Raises `BadInput` where a field is missing or of another type.
        """
        values: dict[str, Any] = {}
        for f in fields(cls):
            if f.name not in data:
                continue
            value = data[f.name]
            if not isinstance(value, _KINDS[str(f.type)]):
                raise BadInput(f"{f.name} of a part's result can't be {value!r}")
            values[f.name] = tuple(value) if isinstance(value, list) else value
        try:
            return cls(**values)
        except TypeError:
            raise BadInput("a part's result lacks its part, its folder or its verdict") from None
