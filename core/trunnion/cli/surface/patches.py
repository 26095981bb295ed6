"""`trunnion patches`: how exact feature sizes are by the number of points on the boundary, and what they cost."""

from __future__ import annotations

import argparse
from typing import Any

from trunnion.cli.common import (
    exit_code,
    open_session,
    part_command,
    progress_of,
    show_findings,
    show_json,
    table,
)
from trunnion.findings import BadCall


def add(commands: Any) -> None:
    """Add the command to the command line."""
    made = part_command(
        commands,
        "patches",
        "how exact the patches' feature sizes are, and what they cost",
        "The error of the feature sizes and the time for them, by the number of points on each edge, and how far "
        "the boundary curves of the file are from its surfaces.",
    )
    made.add_argument(
        "--points",
        metavar="N,N,...",
        default="",
        help="points between the ends of each edge (default: 0 to 500)",
    )
    made.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Print the table of errors and the boundary's own error."""
    from trunnion.recognize.surface.accuracy import COUNTS, EXACT, REPAIR, size_errors

    counts = _counts(options.points) or COUNTS
    engine, session = open_session(options, None)
    assert session.part is not None
    part = engine.context_of(session).part
    rows = size_errors(part, part.tags, counts, progress_of(options))
    errors = part.boundary_error()
    worst = max(errors, key=lambda tag: errors[tag])
    if options.json:
        show_json(
            {
                "part": session.part.name,
                "size_errors": [r.as_dict() for r in rows],
                "boundary_error": {"mm": errors[worst], "face": worst},
                "findings": [f.as_dict() for f in session.part.findings],
            }
        )
    else:
        names = {REPAIR: "paper's repair", EXACT: "exact"}
        lines = [("points on an edge", "points", "largest error", "mean error", "seconds")]
        lines += [
            (
                names.get(r.on_edge, str(r.on_edge)),
                str(r.points),
                f"{100.0 * r.largest:.4f} %",
                f"{100.0 * r.mean:.4f} %",
                f"{r.seconds:.3f}",
            )
            for r in rows
        ]
        print(table(lines, right=(0, 1, 2, 3, 4)))
        print(f"boundary curves are within {errors[worst]:.2g} mm of their surfaces (face {worst})")
    show_findings(options, session.part.findings)
    return exit_code(session.part.findings)


def _counts(words: str) -> tuple[int, ...]:
    try:
        return tuple(int(w) for w in words.split(",") if w.strip())
    except ValueError:
        raise BadCall(
            f"--points wants whole numbers with commas between them, not {words}"
        ) from None
