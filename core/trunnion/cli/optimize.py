"""`trunnion optimize`: speeds and feeds under the machine's limits, and the power check."""

from __future__ import annotations

import argparse
from dataclasses import asdict
from typing import Any

from trunnion.cli.common import exit_code, open_session, part_command, show_findings, show_json, table


def add(commands: Any) -> None:
    """Add the command to the command line."""
    part_command(commands, "optimize", "speeds, feeds and the power check").set_defaults(run=run)


def run(chosen: argparse.Namespace) -> int:
    """Print each operation's cutting data beside the spindle's power."""
    _, session = open_session(chosen, "optimize")
    process = session.process
    assert process is not None
    if chosen.json:
        show_json({"operations": [{"id": o.id, "tool": o.tool.number, "data": asdict(o.data)} for o in process.operations],
                   "findings": [f.as_dict() for f in session.findings()]})
    else:
        rows = [("operation", "tool", "vc m/min", "n 1/min", "fz mm", "vf mm/min", "Q cm3/min", "P kW", "limit kW", "M Nm")]
        for o in process.operations:
            d = o.data
            rows.append((o.id, f"T{o.tool.number}", f"{d.speed:.0f}", f"{d.spindle:.0f}", f"{d.feed_per_tooth:.3f}", f"{d.feed:.0f}",
                         f"{d.removal_rate:.1f}", f"{d.power:.2f}", f"{d.power_limit:.2f}", f"{d.torque:.2f}"))
        print(table(rows, right=tuple(range(2, 10))))
    show_findings(chosen, session.findings())
    return exit_code(session.findings())
