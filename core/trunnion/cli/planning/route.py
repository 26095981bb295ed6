"""`trunnion route`: operations, tools and the rule behind each choice."""

from __future__ import annotations

import argparse
from typing import Any

from trunnion.cli.common import exit_code, open_session, part_command, show_findings, show_json
from trunnion.cli.planning.operations import operation_dict, operation_table


def add(commands: Any) -> None:
    """Add the command to the command line."""
    made = part_command(commands, "route", "operations with tools, and the rule behind each choice")
    made.add_argument("--rules", action="store_true", help="print the rules as well")
    made.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Print the process tree."""
    _, session = open_session(options, "route")
    process = session.process
    assert process is not None
    if options.json:
        show_json(
            {
                "plan": process.plan,
                "material": process.material,
                "operations": [operation_dict(o) for o in process.operations],
                "tools": [t.as_dict() for t in process.tools()],
                "findings": [f.as_dict() for f in session.findings()],
            }
        )
    else:
        print(operation_table(process.operations))
        if options.rules:
            for o in process.operations:
                print(f"{o.id}: " + "; ".join(o.rules))
    show_findings(options, session.findings())
    return exit_code(session.findings())
