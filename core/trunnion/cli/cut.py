"""`trunnion cut`: one face of a part cut in two, kept in a project that every other command takes in place of the part."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from trunnion.cli.common import add_record, check_output, open_program, part_command, show_json
from trunnion.findings import BadCall, BadInput


def add(commands: Any) -> None:
    """Add the command to the command line."""
    made = part_command(commands, "cut", "cut one face in two, by a plane or by a drawn way")
    made.add_argument(
        "--face",
        type=int,
        required=True,
        metavar="N",
        help="which face (1-based, in the shape as read)",
    )
    made.add_argument(
        "--plane",
        type=float,
        nargs=6,
        metavar=("X", "Y", "Z", "NX", "NY", "NZ"),
        default=None,
        help="a point of the plane and its normal; what lies behind it keeps the face's number",
    )
    made.add_argument(
        "--place",
        type=float,
        nargs=3,
        metavar=("X", "Y", "Z"),
        action="append",
        default=[],
        help="a place of the way, near the face; repeat it in order. The first once more at the end closes the way",
    )
    made.add_argument(
        "--out", type=Path, required=True, metavar="FILE", help="project to write (.trunnion)"
    )
    add_record(made)
    made.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Make the cut, write the project and report which faces there are now."""
    from trunnion.store.project_file import PROJECT_SUFFIX

    if (options.plane is None) == (not options.place):
        raise BadCall("a cut wants --plane, or --place twice or more; not both")
    if options.out.suffix.lower() != PROJECT_SUFFIX:
        raise BadInput(
            f"{options.out}: a cut is kept in a project; name it {options.out.stem}{PROJECT_SUFFIX}"
        )
    check_output(options.out.parent)
    program = open_program(options)
    before = program.session.part
    if options.plane:
        program.cut_by_plane(options.face, options.plane[:3], options.plane[3:])
    else:
        program.cut_by_curve(options.face, options.place)
    after = program.session.part
    assert before is not None and after is not None
    made = [options.face, *range(before.n_faces + 1, after.n_faces + 1)]
    program.save(options.out)
    if options.json:
        show_json({"file": str(options.out), "faces": made})
    else:
        print(
            f"face {options.face} is now {' and '.join(f'face {n}' for n in made)}; kept in {options.out}"
        )
    return 0
