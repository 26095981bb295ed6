"""`trunnion size`: the sizes that a programmer wants to know of a part."""

from __future__ import annotations

import argparse
from typing import Any

from trunnion.cli.common import (
    exit_code,
    open_session,
    part_command,
    show_findings,
    show_json,
    table,
)


def add(commands: Any) -> None:
    """Add the command to the command line."""
    part_command(commands, "size", "the table of sizes").set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Print the size table."""
    _, session = open_session(options, "size")
    if options.json:
        show_json(
            {
                "sizes": [s.as_dict() for s in session.sizes],
                "findings": [f.as_dict() for f in session.findings()],
            }
        )
    else:
        rows = [
            ("size", "value", "unit", "feature"),
            *((s.name, f"{s.value:.3f}", s.unit, s.feature) for s in session.sizes),
        ]
        print(table(rows, right=(1,)))
    show_findings(options, session.findings())
    return exit_code(session.findings())
