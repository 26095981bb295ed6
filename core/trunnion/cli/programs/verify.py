"""`trunnion verify`: prove a project's own programs, or NC text that was edited by hand, against the part."""

from __future__ import annotations

import argparse
from typing import Any

from trunnion.cli.common import open_session, part_command, progress_of, show_findings, show_json
from trunnion.cli.programs.proof import proof_dict, proof_text, verdict_code
from trunnion.findings import BadCall


def add(commands: Any) -> None:
    """Add the command to the command line."""
    made = part_command(
        commands,
        "verify",
        "prove a program against the part",
        "Proves what a project (or part) is programmed to do; with --nc, NC text that may have been edited by hand.",
    )
    made.add_argument(
        "--nc",
        action="append",
        default=[],
        metavar="[SETUP=]FILE",
        help="NC text of a setup, in the order of the setups or for the one that is named (S2=FILE), on the stock that those before it "
        "leave; may be repeated",
    )
    made.add_argument(
        "--fine",
        metavar="FACES",
        help="also measure scallops, gouges and steps on faces to 0.2 um, as in: face 12, face 13",
    )
    made.add_argument(
        "--fine-spacing",
        type=float,
        default=0.2,
        metavar="MM",
        help="how far apart --fine begins to look; default 0.2 mm",
    )
    made.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Print the verdict."""
    from trunnion.pipeline.engine import setup_file
    from trunnion.pipeline.proof import fine_faces

    faces = fine_faces.faces_named(options.fine) if options.fine else ()
    if not 0.001 <= options.fine_spacing <= 10.0:
        raise BadCall(f"--fine-spacing {options.fine_spacing:g}: it must be from 0.001 to 10 mm")
    if options.nc:
        from trunnion.pipeline.proof.external_nc import text_of

        for word in options.nc:
            text_of(setup_file(word)[1])
    engine, session = open_session(options, "toolpath" if options.nc else "verify")
    if options.nc:
        from trunnion.pipeline.proof.external_nc import verify_texts

        session = verify_texts(engine, session, options.nc, progress_of(options))
    figures = (
        fine_faces.measure_fine(engine, session, faces, options.fine_spacing, progress_of(options))
        if faces
        else None
    )
    if options.json:
        verdict = proof_dict(
            session,
            tuple(str(setup_file(w)[1]) for w in options.nc),
            {n: r.seconds for n, r in session.records.items()},
        )
        show_json(verdict | ({"fine": fine_faces.fine_dict(figures)} if figures else {}))
    else:
        print(proof_text(session))
        if figures:
            print(fine_faces.fine_text(figures))
    show_findings(options, session.findings())
    return verdict_code(session)
