"""`trunnion change`: one operation set, copied, moved or taken out by hand, kept in a project that other commands go on with."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from trunnion import registry
from trunnion.cli.common import (
    check_output,
    exit_code,
    face_tags_of,
    open_session,
    pairs_of,
    part_command,
    progress_of,
    show_findings,
    show_json,
)
from trunnion.cli.planning.operations import operation_dict, operation_table
from trunnion.findings import BadCall
from trunnion.registry import STRATEGIES
from trunnion.settings import choose

if TYPE_CHECKING:
    from trunnion.model.process import ProcessTree
    from trunnion.model.session import Session
    from trunnion.pipeline import Engine


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
    engine, session = open_session(options, "optimize")
    session, id = _changed(options, own, engine, session)
    # The peak of the load follows the new data.
    session = engine.run(session, "optimize", progress_of(options))
    engine.save(session, options.out)
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


def _changed(
    options: argparse.Namespace, own: Mapping[str, str], engine: Engine, session: Session
) -> tuple[Session, str]:
    """Return the session with all that the options say of an operation, and the id of the one that they say it of."""
    from trunnion.pipeline.planning.guide_faces import with_guide_faces
    from trunnion.plan.manual.operation_change import OperationChange, check_known
    from trunnion.plan.manual.operation_copy import with_copy, with_copy_on
    from trunnion.plan.manual.operation_order import with_operation_before
    from trunnion.plan.manual.operation_state import with_own_choices, with_suppressed

    process, id = _process(session), options.operation
    check_known(process, id)
    if options.delete:
        return replace(session, process=process.without(id)), id
    if options.on:
        assert session.recognition is not None
        process, id = with_copy_on(process, id, options.on, session.recognition)
    elif options.copy:
        process, id = with_copy(process, id)
    if own:
        group = registry.get(STRATEGIES, process.operation(id).strategy).settings
        process = with_own_choices(process, id, own, group)
    if options.suppress or options.resume:
        process = with_suppressed(process, id, options.suppress)
    if options.before:
        check_known(process, options.before)
    if options.before or options.last:
        process = with_operation_before(process, id, options.before or None)
    session = replace(session, process=process)
    given = {"tool": options.tool, "spindle": options.spindle, "feed": options.feed}
    if any(given.values()):
        change = choose(OperationChange, {f"operation.{name}": v for name, v in given.items()})
        session = engine.with_operation_change(session, id, change)
    if options.add_faces or options.leave_out:
        session = with_guide_faces(
            engine,
            session,
            id,
            add=face_tags_of(options.add_faces, "--add-faces"),
            leave_out=face_tags_of(options.leave_out, "--leave-out"),
            progress=progress_of(options),
        )
    return session, id


def _process(session: Session) -> ProcessTree:
    assert session.process is not None
    return session.process
