"""`trunnion edit`: features given other faces and allowances, and holes their fits and threads, kept in a project that other commands go on
with."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from trunnion.cli.common import (
    add_record,
    check_output,
    exit_code,
    listed,
    open_program,
    part_command,
    show_findings,
    show_json,
    table,
    tags_in,
)
from trunnion.findings import BadCall, BadInput

if TYPE_CHECKING:
    from trunnion.model.feature import Feature
    from trunnion.plan.holes.settings import HoleDemand


def add(commands: Any) -> None:
    """Add the command to the command line."""
    made = part_command(
        commands,
        "edit",
        "give features other faces by hand: add, take, merge, make; allowances; holes fits and threads",
        "Gives features other faces by hand, in the order add, take, merge, make, then allowances, then holes their fits and threads, "
        "and saves the project. Roles and sizes follow from the faces; recognition keeps what was changed.",
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
    for option, where in (("--keep-on-walls", "walls"), ("--keep-on-floors", "floors or tops")):
        made.add_argument(
            option,
            action="append",
            default=[],
            metavar="ID,...=MM",
            help=f"leave so much on the {where} of features on purpose; 0 takes it away; may be repeated",
        )
    made.add_argument(
        "--fit",
        action="append",
        default=[],
        metavar="ID,...=FIT",
        help="demand a fit of holes, as in hole-01,hole-02=H7 or hole-03=+0.021/0; nothing after = takes it away; may be repeated",
    )
    made.add_argument(
        "--thread",
        action="append",
        default=[],
        metavar="ID,...=THREAD",
        help="demand a thread in holes, as in hole-01=M6, or hole-01=M6:12 where it is 12 mm deep; may be repeated",
    )
    made.add_argument(
        "--out", type=Path, required=True, metavar="FILE", help="project to write (.trunnion)"
    )
    add_record(made)
    made.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Change the features, save the project and print those that a person changed."""
    from trunnion.store.project_file import PROJECT_SUFFIX

    demands, amounts = _demands(options), _amounts(options)
    changes_faces = options.add or options.take or options.merge or options.make
    if not changes_faces and not demands and not amounts:
        raise BadCall(
            "nothing to change: give --add, --take, --merge, --make, --keep-on-walls, --keep-on-floors, --fit or --thread"
        )
    if options.out.suffix.lower() != PROJECT_SUFFIX:
        raise BadCall(f"--out wants a file that ends in {PROJECT_SUFFIX}, not {options.out}")
    check_output(options.out.parent)
    program = open_program(options)
    program.run("recognize")
    for given in options.add:
        program.add_faces(*_named(given))
    for given in options.take:
        program.take_faces(*_named(given))
    for given in options.merge:
        program.merge(listed(given))
    for given in options.make:
        program.make_feature(*_named(given))
    for where, ids, amount in amounts:
        program.keep(ids, **{where: amount})
    for ids, demand in demands:
        if demand.thread:
            program.demand_thread(ids, demand.thread, demand.thread_depth)
        else:
            program.demand_fit(ids, demand.fit)
    program.save(options.out)
    session = program.session
    assert session.recognition is not None
    named = {id for ids, _ in demands for id in ids} | {id for _, ids, _ in amounts for id in ids}
    changed = [f for f in session.recognition if f.by_hand or f.id in named]
    if options.json:
        show_json({"file": str(options.out), "features": [f.as_dict() for f in changed]})
    else:
        print(
            table(
                [
                    ("feature", "faces", "demand"),
                    *(
                        (f.id, " ".join(f"{x.role} {x.face}" for x in f.faces), _words(f))
                        for f in changed
                    ),
                ]
            )
        )
    show_findings(options, session.findings())
    return exit_code(session.findings())


def _words(feature: Feature) -> str:
    """Return what is demanded of a hole, or kept on another feature."""
    words = [
        str(feature.attributes[name]) for name in ("thread", "fit") if name in feature.attributes
    ]
    kept = (("wall_allowance", "walls"), ("floor_allowance", "floors"))
    words += [
        f"{where} {feature.attributes[name]} mm"
        for name, where in kept
        if name in feature.attributes
    ]
    return ", ".join(words)


def _amounts(options: argparse.Namespace) -> list[tuple[str, tuple[str, ...], float]]:
    """Return what is to stay on features: where, as `PartProgram.keep` calls it, the features and mm."""
    found = []
    for where, option, given in (
        *(("walls", "--keep-on-walls", g) for g in options.keep_on_walls),
        *(("floors", "--keep-on-floors", g) for g in options.keep_on_floors),
    ):
        ids, words = _features(given, "pocket-01=0.3")
        try:
            amount = float(words)
        except ValueError:
            raise BadInput(f"{option} {given}: {words or 'nothing'} is no amount in mm") from None
        found.append((where, ids, amount))
    return found


def _demands(options: argparse.Namespace) -> list[tuple[tuple[str, ...], HoleDemand]]:
    """Return the holes that options name, each with what is demanded of them."""
    from trunnion.plan.holes.demand import fit_demand, thread_demand

    found = []
    for given in options.fit:
        ids, words = _features(given, "hole-01=H7")
        found.append((ids, fit_demand(words)))
    for given in options.thread:
        ids, words = _features(given, "hole-01=M6:12")
        thread, colon, depth = words.partition(":")
        try:
            deep = float(depth) if colon else 0.0
        except ValueError:
            raise BadInput(f"{given}: {depth} is no depth in mm") from None
        found.append((ids, thread_demand(thread.strip(), deep)))
    return found


def _features(given: str, example: str) -> tuple[tuple[str, ...], str]:
    """Return the features before the equals sign of an option's value and the words after it."""
    names, equals, words = given.partition("=")
    ids = listed(names)
    if not equals or not ids:
        raise BadInput(
            f"{given}: give features with commas, = and what is demanded, as in {example}"
        )
    return ids, words.strip()


def _named(given: str) -> tuple[str, list[int]]:
    """Return what stands before and after the equals sign of an option's value."""
    name, equals, faces = given.partition("=")
    tags = tags_in(faces)
    if not equals or not name or not tags:
        raise BadInput(
            f"{given}: give a name, = and face numbers with commas, as in pocket-01=12,13"
        )
    return name, tags
