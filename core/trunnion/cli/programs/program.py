"""`trunnion program`: the whole line, from the part file to proven NC text in a folder."""

from __future__ import annotations

import argparse
import sys
import time
from contextlib import ExitStack
from typing import TYPE_CHECKING, Any

from trunnion.cli.common import (
    add_output,
    add_record,
    check_output,
    given,
    open_program,
    part_command,
    progress_of,
    show_findings,
    show_json,
)
from trunnion.cli.programs.proof import proof_dict, proof_text, verdict_code
from trunnion.findings import TrunnionError
from trunnion.store.project_file import PROJECT_SUFFIX

if TYPE_CHECKING:
    from trunnion.model.session import Session
    from trunnion.pipeline import Engine
    from trunnion.progress import Progress


LAID, PROVEN = "toolpath", "repair"
"""The steps that toolpaths are there after, and that a program is proven after."""
LAYING = (0.1, 0.6)
"""Shares of the whole work at which the part is read, and at which toolpaths are there."""


def add(commands: Any) -> None:
    """Add the command to the command line."""
    made = part_command(
        commands, "program", "program a part: features, route, toolpaths, proof, NC text, report"
    )
    add_output(made)
    made.add_argument(
        "--name", default="", help="name of the program and its files (default: the part's)"
    )
    made.add_argument(
        "--date",
        default="",
        help="date for the programs' headers; without it same input gives same bytes",
    )
    add_record(made)
    made.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Run the whole line and write its files."""
    from trunnion.pipeline.writing import checked_name
    from trunnion.report.picture_process import PictureProcess

    began = time.perf_counter()
    check_output(options.output)
    if options.name:
        checked_name(options.name)
    with PictureProcess() as pictures, ExitStack() as running:
        program = open_program(options, running)
        engine, session = program.engine, program.session
        progress = progress_of(options)
        session = engine.run(session, LAID, progress.part(*LAYING), pictures.ahead)
        session = _proven(options, engine, session, progress.part(LAYING[1], 1.0))
        files = engine.write(
            session,
            options.output,
            name=options.name,
            date=options.date,
            drawing=pictures.begin,
            progress=progress_of(options),
        )
    words = given(name=options.name, date=options.date)
    program.recording.act("write", (options.output,), words)
    seconds = {name: record.seconds for name, record in session.records.items()} | {
        "all": time.perf_counter() - began
    }
    if options.json:
        show_json(proof_dict(session, files, seconds))
    else:
        print(proof_text(session))
        print(f"{len(files)} files in {options.output}, {seconds['all']:.1f} s")
    show_findings(options, session.findings())
    return verdict_code(session)


def _proven(
    options: argparse.Namespace, engine: Engine, session: Session, progress: Progress
) -> Session:
    """Return a session with its proof; where that can't be made, or a person stops it, the plan with its toolpaths is kept as a project."""
    try:
        return engine.run(session, PROVEN, progress)
    except (TrunnionError, KeyboardInterrupt) as reason:
        where = _kept(options, engine, session)
        if isinstance(reason, TrunnionError):
            raise type(reason)(f"{reason}; {where}") from None
        print(f"trunnion: {where}", file=sys.stderr)
        raise


def _kept(options: argparse.Namespace, engine: Engine, session: Session) -> str:
    """Keep a plan with its toolpaths as a project; return where, or why that can't be: it is no reason to lose the one for keeping it."""
    from trunnion.pipeline.writing import name_of

    kept = options.output / f"{name_of(session, options.name)}{PROJECT_SUFFIX}"
    try:
        options.output.mkdir(parents=True, exist_ok=True)
        engine.save(session, kept)
    except (TrunnionError, OSError) as reason:
        return f"plan and toolpaths can't be kept in {kept}: {reason}"
    return f"plan and toolpaths are kept in {kept}"
