"""NC text from outside, such as a program edited by hand at the machine, proven against the part."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from trunnion.findings import BadCall, BadInput, Finding, info
from trunnion.model.material import Machine
from trunnion.model.motion.program import Program
from trunnion.model.session import PostedFile, Session, StepRecord
from trunnion.pipeline.engine import Engine, setup_file
from trunnion.pipeline.proof.posted_programs import (
    dialect_of,
    errors_of_part,
    held_back,
    post_texts,
    prove_programs,
    read_back,
)
from trunnion.post.header import Header
from trunnion.post.settings import PostSettings
from trunnion.progress import Progress
from trunnion.settings import checked, choose

MOST_BYTES = 200_000_000
"""Size of an NC file that is read: about ten million blocks; more is a file of another kind, or a stream without an end."""


def verify_texts(
    engine: Engine, session: Session, words: Sequence[str | Path], progress: Progress
) -> Session:
    """Return the session with the verdict on the texts of files, `FILE` for the setups in their order or `SETUP=FILE` for one of them.

    A setup before the last one of these that no file is given for is cut as the plan has it: so a text is proven on the stock that it
    finds. What the plan could not make is no matter here, a part that is not closed is.
    """
    if session.process is None:
        raise BadCall("no operations yet: generate the route first")
    files = _by_setup(words, [s.name for s in session.process.setups])
    machines = engine.context_of(session).shop.machines
    posted = progress.aside(lambda own: _texts(session, files, machines, own))

    def read(own: Progress) -> tuple[Program, ...]:
        return tuple(
            p for t in posted for p in _read(session, files.get(t.setup), t, machines, own)
        )

    programs = progress.aside(read, "reading the text")
    proven = prove_programs(session, engine.context_of(session), programs, progress)
    started = _started([t.setup for t in posted], files)
    verdict = held_back(
        replace(proven, findings=(*proven.findings, *started)), errors_of_part(session)
    )
    record = StepRecord(key="texts from outside", seconds=0.0, findings=verdict.findings)
    return replace(
        session,
        verdict=verdict,
        posted=tuple(posted),
        records={**session.records, "verify": record},
    )


def _by_setup(words: Sequence[str | Path], setups: Sequence[str]) -> dict[str, Path]:
    """Return the file of each setup that words name; raise `BadCall` for a setup that is not there, or named twice."""
    found: dict[str, Path] = {}
    for n, word in enumerate(words):
        named, file = setup_file(str(word))
        if not named and n >= len(setups):
            raise BadCall(f"{len(words)} programs given, but the part has {len(setups)} setups")
        setup = named or setups[n]
        if setup not in setups:
            raise BadCall(f"{word}: there is no setup {setup}; the part has {', '.join(setups)}")
        if setup in found:
            raise BadCall(f"{word}: setup {setup} has a program already, {found[setup]}; give one")
        found[setup] = file
    return found


def _texts(
    session: Session, files: Mapping[str, Path], machines: Mapping[str, Machine], progress: Progress
) -> list[PostedFile]:
    """Return the texts of all setups up to the last one that a file is given for, the plan's where there is none."""
    settings = checked(choose(PostSettings, session.choices))
    setups = session.process.setups if session.process else ()
    last = max(n for n, s in enumerate(setups) if s.name in files) if files else -1
    wanted = setups[: last + 1]
    planned = (
        {t.setup: t for t in post_texts(session, Header.of(session), machines, progress)}
        if any(s.name not in files for s in wanted)
        else {}
    )
    found = []
    for setup in wanted:
        if setup.name in files:
            file = files[setup.name]
            dialect = dialect_of(setup, settings, machines)
            text = text_of(file)
            found.append(PostedFile(suffix=file.name, dialect=dialect, setup=setup.name, text=text))
        elif setup.name in planned:
            found.append(planned[setup.name])
    return found


def _started(setups: Sequence[str], files: Mapping[str, Path]) -> tuple[Finding, ...]:
    """Return what each text from outside was told to start from, where that is what the plan cuts before."""
    found = []
    for n, setup in enumerate(setups):
        before = [s for s in setups[:n] if s not in files]
        if setup in files and before:
            found.append(
                info(
                    "verify.started-from",
                    f"{files[setup].name} is proven on the blank without what the plan's own program of {', '.join(before)} takes off",
                    setup,
                )
            )
    return tuple(found)


def _read(
    session: Session,
    file: Path | None,
    text: PostedFile,
    machines: Mapping[str, Machine],
    progress: Progress,
) -> tuple[Program, ...]:
    """Return what a text says; a refusal names the file before the line."""
    try:
        return read_back(session, (text,), machines, progress)
    except BadInput as reason:
        raise BadInput(f"{file or text.suffix}: {reason}") from None


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
