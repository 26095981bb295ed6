"""`trunnion program`: the whole line, from the part file to proven NC text in a folder."""

from __future__ import annotations

import argparse
import time
from typing import Any

from trunnion.cli.common import (
    add_output,
    check_output,
    open_session,
    part_command,
    progress_of,
    show_findings,
    show_json,
)
from trunnion.cli.programs.proof import proof_dict, proof_text, verdict_code


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
    made.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Run the whole line and write its files."""
    from trunnion.pipeline.writing import checked_name
    from trunnion.report.picture_process import PictureProcess

    began = time.perf_counter()
    check_output(options.output)
    if options.name:
        checked_name(options.name)
    with PictureProcess() as pictures:
        engine, session = open_session(options, "repair", pictures.ahead)
        files = engine.write(
            session,
            options.output,
            name=options.name,
            date=options.date,
            drawing=pictures.begin,
            progress=progress_of(options),
        )
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
