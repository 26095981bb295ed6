"""`trunnion export`: some faces of a part, such as its local features, as a file of their own."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from trunnion.cli.common import (
    add_manual_edits,
    add_record,
    check_output,
    do_manual_edits,
    dropped_words,
    exit_code,
    listed,
    open_program,
    part_command,
    show_findings,
    show_json,
)
from trunnion.findings import BadInput


def add(commands: Any) -> None:
    """Add the command to the command line."""
    made = part_command(
        commands,
        "export",
        "write groups of patches, local features or the remaining area as IGES or STEP",
    )
    made.add_argument(
        "--groups",
        metavar="WORD,...",
        default="local",
        help="local, remaining, dropped (slivers and what is below the smallest feature size, which no other word "
        "writes), or ids such as group-03 (default: local)",
    )
    made.add_argument(
        "--out",
        type=Path,
        required=True,
        metavar="FILE",
        help="file to write (.igs, .iges, .step, .stp)",
    )
    add_manual_edits(made)
    add_record(made)
    made.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Write the faces and report how many they are."""
    from trunnion.pipeline.planning.patches import dropped

    if not options.out.parent.is_dir():
        raise BadInput(f"{options.out}: there is no folder {options.out.parent}")
    check_output(options.out.parent)
    program = open_program(options)
    program.run("recognize")
    do_manual_edits(options, program)
    what = listed(options.groups)
    tags = program.export(what, options.out)
    session = program.session
    assert session.recognition is not None
    apart = [t for t in dropped(session.recognition) if t not in tags]
    if options.json:
        show_json(
            {
                "file": str(options.out),
                "groups": list(what),
                "faces": list(tags),
                "dropped": apart,
            }
        )
    else:
        print(f"{len(tags)} faces written to {options.out}")
        if apart:
            print(f"{dropped_words(apart)}: not written")
    show_findings(options, session.findings())
    return exit_code(session.findings())
