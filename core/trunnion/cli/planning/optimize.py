"""`trunnion optimize`: speeds and feeds of the tables and of the optimiser, the power check, and what stops a quicker choice."""

from __future__ import annotations

import argparse
from collections.abc import Iterable, Sequence
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
    from trunnion.pipeline.planning.optimization import OperationComparison
    from trunnion.plan.freeform.estimate.finishing_time import Estimate


def add(commands: Any) -> None:
    """Add the command to the command line."""
    part_command(commands, "optimize", "speeds, feeds and the power check").set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Print each operation's cutting data beside the spindle's power."""
    from trunnion.pipeline.planning.finishing_estimate import estimate
    from trunnion.pipeline.planning.optimization import comparisons, is_optimised

    engine, session = open_session(options, "optimize")
    context = engine.context_of(session)
    process, areas = session.process, estimate(session, context)
    assert process is not None
    compared, optimised = comparisons(session, context), is_optimised(session)
    if options.json:
        show_json(
            {
                "operations": [
                    {"id": o.id, "tool": o.tool.number, "data": o.data.as_dict()}
                    for o in process.operations
                ],
                "optimised": optimised,
                "comparison": [c.as_dict() for c in compared],
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
        print()
        print(comparison_table(compared))
        print(comparison_words(compared, optimised))
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


def comparison_table(compared: Sequence[OperationComparison]) -> str:
    """Return the tables' data beside the optimiser's as aligned text: per metre of way, with the share of the tightest limit."""
    rows = [
        (
            "tables, optimised",
            "n 1/min",
            "",
            "vf mm/min",
            "",
            "s/m",
            "",
            "cost/m",
            "",
            "time %",
            "limit",
            "bound by",
            "Q of bound",
        )
    ]
    for c in compared:
        if c.handbook is None:
            rows.append((c.operation, *10 * ("",), "keeps its tables", ""))
            continue
        best = c.optimised or c.handbook
        name, share = max(best.shares.items(), key=lambda item: item[1])
        rows.append(
            (
                c.operation,
                f"{c.handbook.spindle:.0f}",
                f"{best.spindle:.0f}",
                f"{c.handbook.feed:.0f}",
                f"{best.feed:.0f}",
                f"{c.handbook.seconds:.2f}",
                f"{best.seconds:.2f}",
                f"{c.handbook.cost:.4f}",
                f"{best.cost:.4f}",
                f"{-100.0 * c.gain:+.1f}",
                f"{name} {100.0 * share:.0f} %",
                c.bound_by if c.optimised else "keeps its tables",
                f"{best.removal_rate:.0f} of {c.removal_bound:.0f}",
            )
        )
    return table(rows, right=tuple(range(1, 10)))


def comparison_words(compared: Sequence[OperationComparison], optimised: bool) -> str:
    """Return in words what the optimiser saves, whether its data are in use, and how far the proven time is from its bound."""
    changed = [c for c in compared if c.optimised is not None]
    if not changed:
        return "the optimiser changes nothing"
    mean = sum(c.gain for c in changed) / len(changed)
    words = (
        f"optimised: {len(changed)} of {len(compared)} operations, {100.0 * mean:.1f} % less time for the same way on the mean; "
        + ("these data are in use" if optimised else "the tables' data are in use (optimize.data)")
    )
    rough = [c for c in compared if c.bound_s > 0.0]
    if rough:
        taken, least = sum(c.proven_s for c in rough), sum(c.bound_s for c in rough)
        words += f"\nas last proven: {taken:.0f} s for what takes {least:.0f} s at the bound, {taken / least:.1f} times"
    return words


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
