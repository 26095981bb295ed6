"""`trunnion batch`: program many parts, each into a folder of its own; one bad part does not stop the others."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from trunnion.cli.common import (
    add_options,
    add_output,
    check_output,
    open_session,
    progress_of,
    show_json,
    table,
)
from trunnion.cli.programs.proof import verdict_code
from trunnion.findings import TrunnionError

if TYPE_CHECKING:
    from trunnion.report.picture_process import PictureProcess


def add(commands: Any) -> None:
    """Add the command to the command line."""
    made = commands.add_parser(
        "batch",
        help="program many parts",
        description="Programs many parts, each into a folder named after it.",
    )
    made.add_argument("parts", nargs="+", metavar="PART", help="part files")
    add_output(made)
    add_options(made)
    made.set_defaults(run=run, name="", date="")


def run(options: argparse.Namespace) -> int:
    """Program every part and print a line for each."""
    from trunnion.report.picture_process import PictureProcess

    check_output(options.output)
    results, worst = [], 0
    with PictureProcess() as pictures:
        for part in options.parts:
            code, words = _one(options, part, pictures)
            worst = max(worst, code)
            results.append((part, *words))
    if options.json:
        show_json(
            {
                "parts": [
                    {"part": p, "verdict": v, "coverage": c, "gouge_mm": g}
                    for p, v, c, g in results
                ]
            }
        )
    else:
        print(table([("part", "verdict", "coverage", "gouge mm"), *results], right=(2, 3)))
    return worst


def _one(
    options: argparse.Namespace, part: str, pictures: PictureProcess
) -> tuple[int, tuple[str, str, str]]:
    options.part = part
    try:
        engine, session = open_session(options, "repair", pictures.ahead)
        engine.write(
            session,
            options.output / Path(part).stem,
            drawing=pictures.begin,
            progress=progress_of(options),
        )
    except TrunnionError as reason:
        print(f"trunnion: {reason}", file=sys.stderr)
        return 2, ("refused", "", "")
    verdict = session.verdict
    assert verdict is not None
    return verdict_code(session), (
        str(verdict.outcome),
        f"{verdict.coverage:.4f}",
        f"{verdict.gouge:.4f}",
    )
