"""Running one step: its work, the record of what it read and found, and refusals that name the part."""

from __future__ import annotations

import time
from dataclasses import replace
from pathlib import Path

from trunnion.findings import Severity, TrunnionError
from trunnion.geometry.kernels.compiling import compiling
from trunnion.model.session import Session, StepRecord
from trunnion.pipeline.context import Context
from trunnion.pipeline.step import Step
from trunnion.progress import Progress


def run_step(
    session: Session, step: Step, context: Context, progress: Progress, order: tuple[str, ...]
) -> Session:
    """Return the session after a step, with the step's record; `order` are the names of all steps, in which records stand.

    Raises what the step raises, with the part's file and the errors found before in the line.
    """
    began = time.perf_counter()
    try:
        with compiling(progress), context.part.watched(progress):
            result = step.work(session, context, progress)
    except TrunnionError as reason:
        raise type(reason)(_whole_line(session, str(reason))) from None
    for begin in step.foresees:
        begin(result.session, context)
    # What a step uses may depend on its own result: the settings of the family that was recognised.
    key = progress.aside(lambda _: step.key(result.session, context))
    record = StepRecord(key=key, seconds=time.perf_counter() - began, findings=result.findings)
    records = {**result.session.records, step.name: record}
    return replace(
        result.session, records={name: records[name] for name in order if name in records}
    )


def _whole_line(session: Session, reason: str) -> str:
    """Return why a step stopped, with the part's file named and the errors found before it, which are the likely cause."""
    file = Path(session.part.path).name if session.part else ""
    line = reason if not file or file in reason else f"{file}: {reason}"
    before = [
        f.text for f in session.findings() if f.severity is Severity.ERROR and f.text not in line
    ]
    return f"{line}; found before: {'; '.join(before)}" if before else line
