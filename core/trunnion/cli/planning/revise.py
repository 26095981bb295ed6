"""`trunnion revise`: a project taken over to a revised part file, what a person did kept by matching faces."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from trunnion.cli.common import (
    add_record,
    check_output,
    exit_code,
    open_program,
    part_command,
    show_findings,
    show_json,
)
from trunnion.findings import BadCall

CODES = "revision."
"""How the codes of findings on a revision begin."""


def add(commands: Any) -> None:
    """Add the command to the command line."""
    made = part_command(
        commands,
        "revise",
        "take a project over to a revised part file",
        "Keeps settings, fixtures, cuts, features and operations that a person made or changed, by matching the faces of both parts; "
        "what can't be matched is named. All else is computed anew, and `trunnion program PROJECT` cuts and proves it like any plan.",
    )
    made.add_argument(
        "--by", required=True, metavar="PART", help="the revised part file, in the same coordinates"
    )
    made.add_argument(
        "--out", type=Path, required=True, metavar="FILE", help="project to write (.trunnion)"
    )
    add_record(made)
    made.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Take up the revised part, plan as far as the project was planned, save, and print what came of it."""
    from trunnion.store.project_file import PROJECT_SUFFIX

    if options.out.suffix.lower() != PROJECT_SUFFIX:
        raise BadCall(f"--out wants a file that ends in {PROJECT_SUFFIX}, not {options.out}")
    check_output(options.out.parent)
    program = open_program(options)
    program.revise(options.by)
    program.save(options.out)
    session = program.session
    findings = session.findings()
    changes = [f for f in findings if f.code.startswith(CODES)]
    if options.json:
        operations = session.process.operations if session.process is not None else ()
        by_hand = [o.id for o in operations if o.is_manual]
        show_json(
            {
                "file": str(options.out),
                "revision": [f.as_dict() for f in changes],
                "operations_by_hand": by_hand,
            }
        )
    else:
        for finding in changes:
            print(finding.text)
    show_findings(options, [f for f in findings if f not in changes])
    return exit_code(findings)
