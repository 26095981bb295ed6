"""`trunnion uncut`: what a cutter leaves on a casing inside and between its bosses and beside the sides of its pockets."""

from __future__ import annotations

import argparse
from typing import Any

from trunnion.cli.casing.regions import casing_session
from trunnion.cli.common import (
    exit_code,
    part_command,
    progress_of,
    show_findings,
    show_json,
    table,
)
from trunnion.findings import BadCall

WHERE = {1: "inside the outline", 2: "between bosses", 3: "beside the pocket's side"}


def add(commands: Any) -> None:
    """Add the command to the command line."""
    made = part_command(
        commands,
        "uncut",
        "what a cutter leaves on a casing around its bosses",
        "The uncut pieces of a cutter that goes round all bosses and along the sides of pockets: class 1 inside a boss's outline, class 2 "
        "between two bosses, class 3 between a boss and a side of its pocket.",
    )
    made.add_argument("--cutter", type=float, required=True, metavar="D", help="its diameter, mm")
    made.add_argument(
        "--allowance", type=float, default=0.0, metavar="A", help="material left on sides, mm"
    )
    made.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Print the uncut pieces of a casing."""
    from trunnion.plan.casing.uncut.plan import uncut_pieces

    if not 0.0 < options.cutter <= 1000.0 or not 0.0 <= options.allowance <= 100.0:
        raise BadCall("--cutter wants a diameter up to 1000 mm, --allowance up to 100 mm")
    engine, session, found = casing_session(options)
    graph = engine.context_of(session).part.graph()
    pieces = uncut_pieces(found, graph, options.cutter, options.allowance, progress_of(options))
    if options.json:
        show_json(
            {
                "pieces": [p.as_dict() for p in pieces],
                "findings": [f.as_dict() for f in session.findings()],
            }
        )
    else:
        rows = [("class", "where", "of", "area mm2", "volume mm3", "largest cutter mm")]
        rows += [
            (
                str(p.number),
                WHERE[p.number],
                " and ".join(p.owners),
                f"{p.area:.2f}",
                f"{p.volume:.1f}",
                f"{p.clears:.2f}" if p.clears else "none",
            )
            for p in pieces
        ]
        print(table(rows, right=(3, 4, 5)))
    show_findings(options, session.findings())
    return exit_code(session.findings())
