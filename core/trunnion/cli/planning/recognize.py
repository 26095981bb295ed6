"""`trunnion recognize`: the features of a part."""

from __future__ import annotations

import argparse
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from trunnion.cli.common import (
    add_manual_edits,
    add_record,
    do_manual_edits,
    dropped_words,
    exit_code,
    open_program,
    part_command,
    show_findings,
    show_json,
    table,
)
from trunnion.findings import Finding, Severity
from trunnion.units import several

if TYPE_CHECKING:
    from trunnion.model.feature import Recognition

TAKEN_FOR = "recognize.family"
"""Code of the finding that says what a part was taken for."""
MOST_NUMBERS = 10
"""Numbers of faces that a row of the table shows."""


def add(commands: Any) -> None:
    """Add the command to the command line."""
    made = part_command(commands, "recognize", "recognise the machining features of a part")
    made.add_argument("--xml", metavar="FILE", help="write the features as XML as well")
    made.add_argument(
        "--save",
        metavar="FILE",
        help="write a project with the features, those changed by hand among them, as well",
    )
    add_manual_edits(made)
    add_record(made)
    made.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Print the features and what nothing explains."""
    from trunnion.pipeline.planning.patches import dropped

    program = open_program(options)
    program.recognize()
    do_manual_edits(options, program)
    session = program.session
    part, found = session.part, session.recognition
    assert part is not None and found is not None
    apart, reasons = dropped(found), _reasons(found)
    if options.xml:
        from trunnion.store.features import write_features

        write_features(session, options.xml)
    if options.save:
        program.save(options.save)
    if options.json:
        show_json(
            {
                "part": part.name,
                "digest": part.digest,
                "family": found.family,
                "taken_for": found.taken_for.as_dict() if found.taken_for else None,
                "frame": found.frame.as_dict(),
                "features": [f.as_dict() for f in found.features],
                "unexplained": {
                    "faces": list(found.unexplained),
                    "area_share": found.unexplained_share,
                },
                "dropped": list(apart),
                "findings": [f.as_dict() for f in session.findings()],
            }
        )
    else:
        if found.taken_for:
            print(f"taken for {found.taken_for}")
        if found.features:
            print(_feature_table(found))
        print(
            f"unexplained: {len(found.unexplained)} faces, {100 * found.unexplained_share:.2f} % of the area"
        )
        if apart:
            print(f"{dropped_words(apart)}: in no group, cut with the area around")
        for reason in reasons:
            print(reason.text)
    show_findings(options, [f for f in session.findings() if f not in reasons])
    return exit_code(session.findings())


def _reasons(found: Recognition) -> tuple[Finding, ...]:
    """Return the notes that say why features are what they are; what the part was taken for stands over the table."""
    return tuple(f for f in found.findings if f.severity is Severity.INFO and f.code != TAKEN_FOR)


def _feature_table(found: Recognition) -> str:
    """Return a row a feature, and a line with the number of each kind."""
    rows = [("feature", "kind", "n", "faces", "sizes")]
    for f in found.features:
        sizes = "  ".join(
            f"{k} {v:g}"
            for k, v in f.sizes.items()
            if isinstance(v, (int, float)) and not isinstance(v, bool)
        )
        rows.append(
            (
                f.id,
                f"{f.kind}, local" if f.attributes.get("local") else f.kind,
                str(len(f.faces)),
                _numbers(f.tags),
                sizes,
            )
        )
    return (
        table(rows, right=(2,))
        + "\n"
        + "  ".join(f"{n} {several(kind) if n > 1 else kind}" for kind, n in found.counts().items())
    )


def _numbers(tags: Iterable[int]) -> str:
    """Return the numbers of faces as `--move` takes them, cut short where they are many."""
    listed = sorted(set(tags))
    return ",".join(map(str, listed[:MOST_NUMBERS])) + (
        ",..." if len(listed) > MOST_NUMBERS else ""
    )
