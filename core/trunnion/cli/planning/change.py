"""`trunnion change`: one operation's tool, spindle speed or feed set by hand, kept in a project that other commands go on with."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from trunnion.cli.common import (
    check_output,
    exit_code,
    open_session,
    part_command,
    progress_of,
    show_findings,
    show_json,
)
from trunnion.cli.planning.operations import operation_dict, operation_table
from trunnion.findings import BadCall
from trunnion.settings import choose


def add(commands: Any) -> None:
    """Add the command to the command line."""
    made = part_command(
        commands,
        "change",
        "set one operation's tool, spindle speed or feed by hand",
        "Sets one operation's tool, spindle speed or feed by hand and saves the project; planning leaves what was set alone, "
        "and `trunnion program PROJECT` cuts and proves it like any plan.",
    )
    made.add_argument(
        "--operation", required=True, metavar="ID", help="as `trunnion route` names it"
    )
    made.add_argument("--tool", default="", metavar="NAME", help="a cutter of the catalogue")
    made.add_argument("--spindle", type=float, default=0.0, metavar="N", help="1/min")
    made.add_argument("--feed", type=float, default=0.0, metavar="VF", help="mm/min")
    made.add_argument(
        "--out", type=Path, required=True, metavar="FILE", help="project to write (.trunnion)"
    )
    made.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Change the operation, save the project and print the operation."""
    from trunnion.plan.operation_change import OperationChange
    from trunnion.store.project_file import PROJECT_SUFFIX

    given = {"tool": options.tool, "spindle": options.spindle, "feed": options.feed}
    change = choose(OperationChange, {f"operation.{name}": v for name, v in given.items()})
    if not any(given.values()):
        raise BadCall("nothing to change: give --tool, --spindle or --feed")
    if options.out.suffix.lower() != PROJECT_SUFFIX:
        raise BadCall(f"--out wants a file that ends in {PROJECT_SUFFIX}, not {options.out}")
    check_output(options.out.parent)
    engine, session = open_session(options, "optimize")
    session = engine.with_operation_change(session, options.operation, change)
    # The peak of the load follows the new data.
    session = engine.run(session, "optimize", progress_of(options))
    engine.save(session, options.out)
    assert session.process is not None
    changed = session.process.operation(options.operation)
    if options.json:
        show_json({"file": str(options.out), "operation": operation_dict(changed)})
    else:
        print(operation_table([changed]))
        print("; ".join((*changed.rules, *changed.data.rules)))
    show_findings(options, session.findings())
    return exit_code(session.findings())
