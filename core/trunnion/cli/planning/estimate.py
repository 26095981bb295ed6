"""`trunnion estimate`: what cutters of their own gain, from areas and measured times."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from trunnion.cli.common import show_json, table

if TYPE_CHECKING:
    from trunnion.plan.freeform.estimate.efficiency import EfficiencyEstimate


def add(commands: Any) -> None:
    """Add the command to the command line."""
    made = commands.add_parser(
        "estimate",
        help="what a larger cutter for some areas gains, from areas and measured times",
        description="The gain of a large cutter for some areas and a small one for the others, over the small one for all of them: "
        "areas (mm2) over the rates that were measured for either.",
    )
    made.add_argument(
        "file",
        nargs="?",
        type=Path,
        metavar="FILE",
        help="areas and measured times (.toml); without it the surface paper's figures are shown",
    )
    made.add_argument("--json", action="store_true", help="print the result as JSON")
    made.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Print the gain of every estimate in the file."""
    from trunnion.plan.freeform.estimate.efficiency_file import (
        example_estimates,
        example_file,
        read_estimates,
    )

    file = options.file or example_file()
    found = read_estimates(options.file) if options.file else example_estimates()
    if options.json:
        show_json({"file": str(file), "estimates": [e.as_dict() for e in found]})
    else:
        print("\n\n".join(map(estimate_text, found)))
        if not options.file:
            print(f"\nthese stand in {file}; copy it for areas and times of your own")
    return 0


def estimate_text(estimate: EfficiencyEstimate) -> str:
    """Return one estimate as aligned text, and its gain in words."""
    from trunnion.report.html import duration

    rows = [("cutter", "areas mm2", "mm2/s", "time")]
    rows += [
        (
            c.cutter,
            " + ".join(f"{a:g}" for a in c.areas) or "none",
            f"{c.rate.area / c.rate.time:.4f}",
            duration(c.seconds),
        )
        for c in (estimate.large, estimate.small)
    ]
    heading = f"{estimate.name}: {estimate.title}" if estimate.title else estimate.name
    source = f"({estimate.source})\n" if estimate.source else ""
    return (
        f"{heading}\n{source}{table(rows, right=(2, 3))}\n"
        f"{estimate.small.cutter} alone {duration(estimate.seconds_alone)}, both cutters {duration(estimate.seconds)}: "
        f"{100.0 * estimate.gain:.2f} % more efficient, {100.0 * estimate.saving:.2f} % of the time saved"
    )
