"""`trunnion verify`: prove a project's own programs, or NC text that was edited by hand, against the part."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from trunnion.cli.common import open_session, part_command, progress_of, show_findings, show_json
from trunnion.cli.proof import proof_dict, proof_text, verdict_code


def add(commands: Any) -> None:
    """Add the command to the command line."""
    made = part_command(commands, "verify", "prove a program against the part",
                        "Proves what a project (or part) is programmed to do; with --nc, NC text that may have been edited by hand.")
    made.add_argument("--nc", action="append", default=[], type=Path, metavar="FILE",
                      help="NC text of a setup, in the order of the setups; may be repeated")
    made.set_defaults(run=run)


def run(chosen: argparse.Namespace) -> int:
    """Print the verdict."""
    engine, session = open_session(chosen, "toolpath" if chosen.nc else "verify")
    if chosen.nc:
        from trunnion.pipeline.checking import verify_texts
        session = verify_texts(engine, session, chosen.nc, progress_of(chosen))
    if chosen.json:
        show_json(proof_dict(session, tuple(str(f) for f in chosen.nc), {n: r.seconds for n, r in session.records.items()}))
    else:
        print(proof_text(session))
    show_findings(chosen, session.findings())
    return verdict_code(session)
