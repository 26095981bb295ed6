"""`trunnion optimize`: speeds and feeds under the machine's limits, and the power check."""

from __future__ import annotations

import argparse
from collections.abc import Iterable
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from trunnion.cli.common import (
    exit_code,
    open_session,
    part_command,
    show_findings,
    show_json,
    table,
)

if TYPE_CHECKING:
    from trunnion.model.operation import Operation
    from trunnion.plan.freeform.estimate.finishing_time import Estimate


def add(commands: Any) -> None:
    """Add the command to the command line."""
    part_command(commands, "optimize", "speeds, feeds and the power check").set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Print each operation's cutting data beside the spindle's power."""
    from trunnion.pipeline.planning.finishing_estimate import estimate

    engine, session = open_session(options, "optimize")
    process, areas = session.process, estimate(session, engine.context_of(session))
    assert process is not None
    if options.json:
        show_json(
            {
                "operations": [
                    {"id": o.id, "tool": o.tool.number, "data": o.data.as_dict()}
                    for o in process.operations
                ],
                "estimate": asdict(areas) if areas else None,
                "findings": [f.as_dict() for f in session.findings()],
            }
        )
    else:
        rows = [
            (
                "operation",
                "tool",
                "vc m/min",
                "n 1/min",
                "fz mm",
                "vf mm/min",
                "Q cm3/min",
                "P kW",
                "peak kW",
                "limit kW",
                "M Nm",
            )
        ]
        for o in process.operations:
            d = o.data
            rows.append(
                (
                    o.id,
                    f"T{o.tool.number}",
                    f"{d.speed:.0f}",
                    f"{d.spindle:.0f}",
                    f"{d.feed_per_tooth:.3f}",
                    f"{d.feed:.0f}",
                    f"{d.removal_rate:.1f}",
                    f"{d.power:.2f}",
                    f"{d.highest_power:.2f}",
                    f"{d.power_limit:.2f}",
                    f"{d.torque:.2f}",
                )
            )
        print(table(rows, right=tuple(range(2, 11))))
        print(highest_load(process.operations))
        if areas is not None:
            print()
            print(estimate_table(areas))
    show_findings(options, session.findings())
    return exit_code(session.findings())


def highest_load(operations: Iterable[Operation]) -> str:
    """Return in words the operation that takes most of the spindle's power, and where."""
    from trunnion.model.load import spindle_loads

    most = max(spindle_loads(operations), key=lambda load: load.share, default=None)
    if most is None:
        return "no load"
    where = f" where {most.at} ({most.steady:.1f} kW steady)" if most.at else ""
    return f"highest load: {most.operation}, {most.highest:.1f} of {most.limit:.1f} kW{where}"


def estimate_table(areas: Estimate) -> str:
    """Return the times of areas by their rates and by feature as aligned text, and what cutters of their own gain."""
    rows = [("area finished by", "tool", "mm2", "mm2/s", "s", "alone s")]
    rows += [
        (
            a.operation,
            a.tool,
            f"{a.area:.1f}" if a.area else "rest",
            f"{a.rate:.2f}" if a.rate else "",
            f"{a.seconds:.0f}",
            f"{a.seconds_alone:.0f}",
        )
        for a in areas.areas
    ]
    rows += [
        (
            f"{t.feature} in all",
            "",
            f"{t.area:.1f}",
            "",
            f"{t.seconds:.0f}",
            f"{t.seconds_alone:.0f}",
        )
        for t in areas.totals
    ]
    return (
        f"{table(rows, right=(2, 3, 4, 5))}\n{areas.alone} alone, each area at its own rate for such places: "
        f"{areas.seconds_alone:.0f} s; with cutters of their own {areas.seconds:.0f} s: {100.0 * areas.gain:.2f} % more efficient, "
        f"{100.0 * areas.saving:.2f} % of the time saved"
    )
