"""`trunnion blank`: the blank that the part is cut from."""

from __future__ import annotations

import argparse
from typing import Any

from trunnion.cli.common import exit_code, open_session, part_command, show_findings, show_json


def add(commands: Any) -> None:
    """Add the command to the command line."""
    made = part_command(commands, "blank", "the blank that the part is cut from")
    made.add_argument("--step", metavar="FILE", help="write the blank as STEP as well")
    made.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Print the blank's size, volume and mass, and its volume over the part's (buy-to-fly)."""
    _, session = open_session(options, "blank")
    blank = session.blank
    assert blank is not None
    part = session.part
    ratio = blank.volume / part.volume if part is not None and part.volume > 0.0 else None
    if options.step:
        from trunnion.part.build import ShapeBuilder
        from trunnion.part.write import write_step

        write_step(blank.built(ShapeBuilder()), options.step)
    if options.json:
        show_json(
            {
                "kind": blank.kind,
                "material": blank.material,
                "frame": blank.frame.as_dict(),
                "min": list(map(float, blank.low)),
                "max": list(map(float, blank.high)),
                "volume": blank.volume,
                "mass_kg": blank.mass,
                "buy_to_fly": ratio,
                "findings": [f.as_dict() for f in session.findings()],
            }
        )
    else:
        sizes = " x ".join(f"{sign}{v:.3f}" for sign, v in blank.measures())
        print(
            f"{blank.kind} {sizes} mm of {blank.material}, {blank.volume / 1e3:.1f} cm3, {blank.mass:.2f} kg"
            + (f", {ratio:.2f} times the part" if ratio else "")
        )
    show_findings(options, session.findings())
    return exit_code(session.findings())
