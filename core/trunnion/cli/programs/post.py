"""`trunnion post`: write the NC text of a project again, in a dialect of choice."""

from __future__ import annotations

import argparse
from typing import Any

from trunnion import registry
from trunnion.cli.common import (
    add_output,
    add_record,
    check_output,
    given,
    open_program,
    part_command,
    show_findings,
    show_json,
)
from trunnion.cli.programs.proof import verdict_code


def add(commands: Any) -> None:
    """Add the command to the command line."""
    made = part_command(
        commands,
        "post",
        "write the NC text of a project (choose the dialect with --set post.dialect=NAME: "
        f"{', '.join(registry.names('dialects'))})",
    )
    add_output(made)
    made.add_argument(
        "--name", default="", help="name of the program and its files (default: the part's)"
    )
    made.add_argument("--date", default="", help="date for the programs' headers")
    add_record(made)
    made.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Write the programs; a failed proof writes them as REJECTED."""
    from trunnion.pipeline.writing import checked_name

    check_output(options.output)
    if options.name:
        checked_name(options.name)
    program = open_program(options)
    files = program.post(options.output, **given(name=options.name, date=options.date))
    session = program.session
    if options.json:
        show_json(
            {
                "files": list(files),
                "verdict": str(session.verdict.outcome) if session.verdict else "none",
            }
        )
    else:
        print("\n".join(files))
    show_findings(options, session.findings())
    return verdict_code(session)
