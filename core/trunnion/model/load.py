"""The highest load of operations on the spindle: as foreseen, and as the proof measured it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from trunnion.model.operation import Operation, OperationPath
from trunnion.model.verdict import Verdict

LAID = "its path takes off most"
"""Where the highest load of a path is met as it was laid."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SpindleLoad:
    """The load of an operation in kW: `highest` and `steady`, and the `limit` that planning keeps.

    `at` says in words where the highest is met, empty in steady cutting; `measured`: the proof has seen it.
    """

    operation: str
    highest: float
    steady: float
    limit: float
    at: str = ""
    measured: bool = False

    @property
    def share(self) -> float:
        """The highest load over the limit."""
        return self.highest / self.limit


def spindle_loads(
    operations: Iterable[Operation],
    verdict: Verdict | None = None,
    paths: Iterable[OperationPath] = (),
) -> tuple[SpindleLoad, ...]:
    """Return the load of every operation that is not suppressed.

    What a verdict has measured stands in place of what was foreseen, but for steady cutting, which it is never below. Without a verdict it
    is never below what the operations' `paths` come to as they were laid.
    """
    laid = {p.operation: p.power for p in paths}
    proofs = {p.operation: p for p in verdict.operations} if verdict is not None else {}
    found = []
    for o in operations:
        if o.suppressed:
            continue
        proof = proofs.get(o.id)
        peak, at = (proof.power, "") if proof is not None else (o.data.peak_power, o.data.peak_at)
        if proof is None and laid.get(o.id, 0.0) > peak:
            peak, at = laid[o.id], LAID
        is_peak = peak > o.data.power
        found.append(
            SpindleLoad(
                operation=o.id,
                highest=max(peak, o.data.power),
                steady=o.data.power,
                limit=o.data.power_limit,
                at=at if is_peak else "",
                measured=proof is not None and is_peak,
            )
        )
    return tuple(found)
