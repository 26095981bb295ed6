"""`trunnion change`: one operation set, copied, moved or taken out by hand, kept in a project that other commands go on with."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from trunnion.cli.common import (
    add_record,
    check_output,
    exit_code,
    face_tags_of,
    open_program,
    pairs_of,
    part_command,
    show_findings,
    show_json,
)
from trunnion.cli.planning.operations import operation_dict, operation_table
from trunnion.findings import BadCall

if TYPE_CHECKING:
    from trunnion.script.program import PartProgram


def add(commands: Any) -> None:
    """Add the command to the command line."""
    made = part_command(
        commands,
        "change",
        "set, copy, move or take out one operation by hand",
        "Sets one operation's tool, speed, feed or own settings by hand, copies it, moves it or takes it out, and saves the project; "
        "planning leaves what was done alone, and `trunnion program PROJECT` cuts and proves it like any plan.",
    )
    made.add_argument(
        "--operation", required=True, metavar="ID", help="as `trunnion route` names it"
    )
    made.add_argument(
        "--copy",
        action="store_true",
        help="copy it: the same work once more behind it; all else that is given is for the copy",
    )
    made.add_argument(
        "--on",
        default="",
        metavar="FEATURE",
        help="with --copy: put the copy on another feature of the same kind",
    )
    made.add_argument("--tool", default="", metavar="NAME", help="a cutter of the catalogue")
    made.add_argument("--spindle", type=float, default=0.0, metavar="N", help="1/min")
    made.add_argument("--feed", type=float, default=0.0, metavar="VF", help="mm/min")
    made.add_argument(
        "--own",
        action="append",
        default=[],
        metavar="KEY=VALUE",
        help="a setting of its strategy for this operation alone; may be repeated",
    )
    made.add_argument(
        "--add-faces", default="", metavar="FACE,...", help="lead it along these faces too"
    )
    made.add_argument(
        "--leave-out",
        default="",
        metavar="FACE,...",
        help="lead it along its other faces only; fillets at the foot of a wall go with it",
    )
    position = made.add_mutually_exclusive_group()
    position.add_argument(
        "--before", default="", metavar="ID", help="move it in front of another one of its setup"
    )
    position.add_argument("--last", action="store_true", help="move it to its setup's end")
    state = made.add_mutually_exclusive_group()
    state.add_argument(
        "--suppress", action="store_true", help="keep it in the plan without cutting it"
    )
    state.add_argument("--resume", action="store_true", help="cut a suppressed one again")
    state.add_argument("--delete", action="store_true", help="take it out of the plan")
    made.add_argument(
        "--out", type=Path, required=True, metavar="FILE", help="project to write (.trunnion)"
    )
    add_record(made)
    made.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Change the operation, save the project and print the operation."""
    from trunnion.store.project_file import PROJECT_SUFFIX

    own = pairs_of(options.own, "--own")
    faces = (options.add_faces, options.leave_out)
    data = (options.tool, options.spindle, options.feed, own, *faces, options.before, options.last)
    if options.on and not options.copy:
        raise BadCall("--on is for a copy: give --copy too")
    if not any((*data, options.copy, options.suppress, options.resume, options.delete)):
        raise BadCall(
            "nothing to change: give --tool, --spindle, --feed, --own, --add-faces, --leave-out, --copy, --before, --last, --suppress, "
            "--resume or --delete"
        )
    if options.delete and any((*data, options.copy)):
        raise BadCall("--delete takes the operation out: nothing else can be changed of it")
    if options.out.suffix.lower() != PROJECT_SUFFIX:
        raise BadCall(f"--out wants a file that ends in {PROJECT_SUFFIX}, not {options.out}")
    check_output(options.out.parent)
    program = open_program(options)
    id = _change(options, own, program)
    # The peak of the load follows the new data.
    session = program.run("optimize")
    program.save(options.out)
    assert session.process is not None
    changed = next((o for o in session.process.operations if o.id == id), None)
    if options.json:
        shown = operation_dict(changed) if changed else None
        show_json({"file": str(options.out), "operation": shown})
    elif changed is None:
        print(f"{id} is taken out")
    else:
        print(operation_table([changed]))
        print("; ".join((*changed.rules, *changed.data.rules)))
    show_findings(options, session.findings())
    return exit_code(session.findings())


def _change(options: argparse.Namespace, own: Mapping[str, str], program: PartProgram) -> str:
    """Do all that the options say to an operation and return the id of the one that it was done to."""
    id: str = options.operation
    if options.delete:
        program.delete(id)
        return id
    if options.copy:
        id = program.copy(id, options.on)
    changes = {
        "tool": options.tool,
        "spindle": options.spindle,
        "feed": options.feed,
        "own": own,
        "add_faces": face_tags_of(options.add_faces, "--add-faces"),
        "leave_out": face_tags_of(options.leave_out, "--leave-out"),
        "before": options.before,
        "last": options.last,
    }
    given = {name: value for name, value in changes.items() if value}
    if options.suppress or options.resume:
        given["suppressed"] = options.suppress
    if given:
        program.change(id, **given)
    return id
