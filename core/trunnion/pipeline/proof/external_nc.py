"""NC text from outside, such as a program edited by hand at the machine, proven against the part."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from trunnion.findings import BadCall, BadInput
from trunnion.model.material import Machine
from trunnion.model.motion.program import Program
from trunnion.model.session import PostedFile, Session, StepRecord
from trunnion.pipeline.engine import Engine
from trunnion.pipeline.proof.posted_programs import (
    dialect_of,
    errors_of_part,
    held_back,
    prove_programs,
    read_back,
)
from trunnion.post.settings import PostSettings
from trunnion.progress import Progress
from trunnion.settings import checked, choose

MOST_BYTES = 200_000_000
"""Size of an NC file that is read: about ten million blocks; more is a file of another kind, or a stream without an end."""


def verify_texts(
    engine: Engine, session: Session, files: Sequence[Path], progress: Progress
) -> Session:
    """Return the session with the verdict on the texts of the files, one for each setup in order.

    What the plan could not make is no matter here, a part that is not closed is.
    """
    if session.process is None:
        raise BadCall("no operations yet: generate the route first")
    if len(files) > len(session.process.setups):
        raise BadCall(
            f"{len(files)} programs given, but the part has {len(session.process.setups)} setups"
        )
    settings = checked(choose(PostSettings, session.choices))
    machines = engine.context_of(session).shop.machines
    posted = [
        PostedFile(
            suffix=file.name,
            dialect=dialect_of(setup, settings, machines),
            setup=setup.name,
            text=text_of(file),
        )
        for file, setup in zip(files, session.process.setups, strict=False)
    ]

    def read(own: Progress) -> tuple[Program, ...]:
        return tuple(
            p
            for file, text in zip(files, posted, strict=True)
            for p in _read(session, file, text, machines, own)
        )

    programs = progress.aside(read, "reading the text")
    verdict = held_back(
        prove_programs(session, engine.context_of(session), programs, progress),
        errors_of_part(session),
    )
    record = StepRecord(key="texts from outside", seconds=0.0, findings=verdict.findings)
    return replace(
        session,
        verdict=verdict,
        posted=tuple(posted),
        records={**session.records, "verify": record},
    )


def _read(
    session: Session,
    file: Path,
    text: PostedFile,
    machines: Mapping[str, Machine],
    progress: Progress,
) -> tuple[Program, ...]:
    """Return what a file's text says; a refusal names the file before the line."""
    try:
        return read_back(session, (text,), machines, progress)
    except BadInput as reason:
        raise BadInput(f"{file}: {reason}") from None


def text_of(file: Path) -> str:
    """Return the NC text of a file; raise `BadInput` when there is none to read."""
    try:
        with file.open("rb") as stream:
            data = stream.read(MOST_BYTES + 1)
        if len(data) > MOST_BYTES:
            raise BadInput(
                f"{file}: is larger than {MOST_BYTES // 1_000_000} MB; give the NC file to be proven"
            )
        return data.decode("utf-8").replace("\r\n", "\n").replace("\r", "\n")
    except OSError as reason:
        why = (reason.strerror or "the system refuses").lower()
        raise BadInput(f"{file}: can't be read: {why}; give the NC file to be proven") from None
    except UnicodeDecodeError:
        raise BadInput(f"{file}: is not a text; give the NC file to be proven") from None
