"""`trunnion verify`: prove a project's own programs, or NC text that was edited by hand, against the part."""

from __future__ import annotations

import argparse
from pathlib import Path
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
        type=Path,
        metavar="FILE",
        help="NC text of a setup, in the order of the setups; may be repeated",
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


def run(chosen: argparse.Namespace) -> int:
    """Print the verdict."""
    from trunnion.pipeline.proof import fine_faces

    faces = fine_faces.faces_named(chosen.fine) if chosen.fine else ()
    if not 0.001 <= chosen.fine_spacing <= 10.0:
        raise BadCall(f"--fine-spacing {chosen.fine_spacing:g}: it must be from 0.001 to 10 mm")
    if chosen.nc:
        from trunnion.pipeline.proof.external_nc import text_of

        for file in chosen.nc:
            text_of(file)
    engine, session = open_session(chosen, "toolpath" if chosen.nc else "verify")
    if chosen.nc:
        from trunnion.pipeline.proof.external_nc import verify_texts

        session = verify_texts(engine, session, chosen.nc, progress_of(chosen))
    figures = (
        fine_faces.measure_fine(engine, session, faces, chosen.fine_spacing, progress_of(chosen))
        if faces
        else None
    )
    if chosen.json:
        told = proof_dict(
            session,
            tuple(str(f) for f in chosen.nc),
            {n: r.seconds for n, r in session.records.items()},
        )
        show_json(told | ({"fine": fine_faces.fine_dict(figures)} if figures else {}))
    else:
        print(proof_text(session))
        if figures:
            print(fine_faces.fine_text(figures))
    show_findings(chosen, session.findings())
    return verdict_code(session)
