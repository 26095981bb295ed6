"""The row of a proven part: what the table, the ledger and the page say of it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import TYPE_CHECKING

from trunnion.findings import Finding, Severity
from trunnion.model.part_result import PartResult

if TYPE_CHECKING:
    from trunnion.model.session import Session


def part_result(part: str, folder: str, session: Session, files: Sequence[str]) -> PartResult:
    """Return the result of a part whose session is proven and whose files are written."""
    verdict = session.verdict
    assert verdict is not None
    errors = [f for f in session.findings() if f.severity is Severity.ERROR]
    return PartResult(
        part=part,
        folder=folder,
        verdict=str(verdict.outcome),
        family=session.recognition.family if session.recognition else "",
        coverage=float(verdict.coverage),
        reachable=float(verdict.reachable),
        gouge=float(verdict.gouge),
        collisions=int(verdict.collisions),
        rapids_in_stock=int(verdict.rapids_in_stock),
        machining_time_s=float(verdict.machining_time_s),
        note=first_error(errors),
        reasons=dict(sorted(Counter(f.code for f in errors).items())),
        files=tuple(files),
    )


def first_error(errors: Sequence[Finding]) -> str:
    """Return the first of some findings in a line, and how many more there are."""
    if not errors:
        return ""
    more = len(errors) - 1
    return f"{errors[0].code}: {errors[0].text}" + (f"; and {more} more" if more else "")
