"""`trunnion post`: write the NC text of a project again, in a dialect of choice."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from trunnion.cli.common import open_session, part_command, progress_of, show_findings, show_json
from trunnion.cli.proof import verdict_code


def add(commands: Any) -> None:
    """Add the command to the command line."""
    made = part_command(commands, "post", "write the NC text of a project (choose the dialect with --set post.dialect=NAME)")
    made.add_argument("-o", "--output", type=Path, required=True, metavar="DIR", help="folder to write to (made when missing)")
    made.add_argument("--name", default="", help="name of the program and its files (default: the part's)")
    made.add_argument("--date", default="", help="date for the programs' headers")
    made.set_defaults(run=run)


def run(chosen: argparse.Namespace) -> int:
    """Write the programs; a failed proof writes them as REJECTED."""
    from trunnion.pipeline.writing import write_programs
    _, session = open_session(chosen, "verify")
    files = write_programs(session, chosen.output, name=chosen.name, date=chosen.date, progress=progress_of(chosen))
    if chosen.json:
        show_json({"files": list(files), "verdict": str(session.verdict.outcome) if session.verdict else "none"})
    else:
        print("\n".join(files))
    show_findings(chosen, session.findings())
    return verdict_code(session)
