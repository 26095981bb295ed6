"""What repair did to a plan: rounds of fixes, each with what the proof said before and after, and whether it was kept."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from trunnion.findings import Fix


@dataclass(frozen=True, slots=True, kw_only=True, order=True)
class PlanScore:
    """How good a plan is, the smaller the better, compared in this order.

    `errors` findings that keep it from being released; `is_short` whether the finished share of the area is one of them: what mends a
    harm by leaving faces uncut mends nothing; `harms` collisions, rapids in stock and operations that gouge; `unfinished` share of the
    area that can be reached and is not finished; `remarks`; `time` s at the machine.
    """

    errors: int
    is_short: bool
    harms: int
    unfinished: float
    remarks: int
    time: float

    @property
    def words(self) -> str:
        """The score as a person reads it."""
        return (
            f"{self.errors} errors, {self.harms} harms, {100.0 * (1.0 - self.unfinished):.2f} % finished, "
            f"{self.time:.0f} s"
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class RepairRound:
    """One round: the fixes that were tried together, the finding's text that each was for, the plan's score before and after.

    `after` is None where the changed plan could not be made; `refusal` says why then.
    """

    number: int
    fixes: tuple[Fix, ...]
    findings: tuple[str, ...]
    before: PlanScore
    after: PlanScore | None
    kept: bool
    refusal: str = ""

    def as_dicts(self) -> list[dict[str, Any]]:
        """Return one entry a fix, as the JSON that other programs rely on."""
        return [
            {
                "round": self.number,
                "finding": text,
                "fix": fix.as_dict(),
                "before": self.before.words,
                "after": self.after.words if self.after else self.refusal,
                "kept": self.kept,
            }
            for fix, text in zip(self.fixes, self.findings, strict=True)
        ]


WORDS = {
    "add_operation": "finished once more by smaller cutters",
    "add_slim": "finished once more by slim cutters",
    "allowance": "roughed farther off the faces",
    "approach": "finished by a tool that leans",
    "clear_first": "what stands in the way roughed before",
    "drop": "left out",
    "exclude": "kept out of where its tool collides",
    "feed": "fed more slowly",
    "lift": "linked higher",
    "smaller_tool": "given a smaller cutter",
    "tolerance": "laid with finer passes",
    "tool": "given a cutter that reaches farther",
    "trim": "cut only where a cutter before left something",
}
"""Kinds of fixes as a person reads them; kinds of other packages by their name."""


def words_of(fix: Fix) -> str:
    """Return a fix in words.

    >>> words_of(Fix(kind="drop", operation="wall-3"))
    'wall-3 left out'
    """
    what = fix.operation or f"{len(fix.faces)} faces"
    return f"{what} {WORDS.get(fix.kind, fix.kind)}"
