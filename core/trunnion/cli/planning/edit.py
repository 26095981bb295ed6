"""`trunnion edit`: features given other faces by hand, kept in a project that other commands go on with."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from trunnion.cli.common import (
    check_output,
    exit_code,
    listed,
    open_session,
    part_command,
    show_findings,
    show_json,
    table,
    tags_in,
)
from trunnion.findings import BadCall, BadInput


def add(commands: Any) -> None:
    """Add the command to the command line."""
    made = part_command(
        commands,
        "edit",
        "give features other faces by hand: add, take, merge, make",
        "Gives features other faces by hand, in the order add, take, merge, make, and saves the project. Roles and sizes follow from the "
        "faces; recognition keeps what was changed.",
    )
    made.add_argument(
        "--add",
        action="append",
        default=[],
        metavar="ID=FACE,...",
        help="add faces to a feature, taken from the ones that have them; may be repeated",
    )
    made.add_argument(
        "--take",
        action="append",
        default=[],
        metavar="ID=FACE,...",
        help="take faces from a feature; may be repeated",
    )
    made.add_argument(
        "--merge",
        action="append",
        default=[],
        metavar="ID,ID,...",
        help="make one feature of several, with the first one's name; may be repeated",
    )
    made.add_argument(
        "--make",
        action="append",
        default=[],
        metavar="KIND=FACE,...",
        help="make a feature of faces, taken from the ones that have them; may be repeated",
    )
    made.add_argument(
        "--out", type=Path, required=True, metavar="FILE", help="project to write (.trunnion)"
    )
    made.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Change the features, save the project and print those that a person changed."""
    from trunnion.pipeline.planning import face_edits
    from trunnion.store.project_file import PROJECT_SUFFIX

    if not (options.add or options.take or options.merge or options.make):
        raise BadCall("nothing to change: give --add, --take, --merge or --make")
    if options.out.suffix.lower() != PROJECT_SUFFIX:
        raise BadCall(f"--out wants a file that ends in {PROJECT_SUFFIX}, not {options.out}")
    check_output(options.out.parent)
    engine, session = open_session(options, "recognize")
    for given in options.add:
        session = face_edits.with_faces(engine, session, *_named(given))
    for given in options.take:
        session = face_edits.with_faces_taken(engine, session, *_named(given))
    for given in options.merge:
        session = face_edits.with_merged(engine, session, listed(given))
    for given in options.make:
        session = face_edits.with_feature(engine, session, *_named(given))
    engine.save(session, options.out)
    assert session.recognition is not None
    changed = [f for f in session.recognition if f.by_hand]
    if options.json:
        show_json({"file": str(options.out), "features": [f.as_dict() for f in changed]})
    else:
        print(
            table(
                [
                    ("feature", "faces"),
                    *((f.id, " ".join(f"{x.role} {x.face}" for x in f.faces)) for f in changed),
                ]
            )
        )
    show_findings(options, session.findings())
    return exit_code(session.findings())


def _named(given: str) -> tuple[str, list[int]]:
    """Return what stands before and after the equals sign of an option's value."""
    name, equals, faces = given.partition("=")
    tags = tags_in(faces)
    if not equals or not name or not tags:
        raise BadInput(
            f"{given}: give a name, = and face numbers with commas, as in pocket-01=12,13"
        )
    return name, tags
