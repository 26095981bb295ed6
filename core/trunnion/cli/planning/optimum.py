"""`trunnion optimum`: spindle speed and feed of least time and cost for one cut that is given by its numbers."""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

from trunnion.cli.common import show_json, table, words_of

if TYPE_CHECKING:
    from trunnion.plan.cutting.optimization.example import CutExample, PrintedPoint
    from trunnion.plan.cutting.optimization.genetic import FrontPoint
    from trunnion.plan.cutting.optimization.operation import OptimizationSettings


def add(commands: Any) -> None:
    """Add the command to the command line."""
    made = commands.add_parser(
        "optimum",
        help="spindle speed and feed of least time and cost for a cut that is given by its numbers",
        description="Spindle speed and feed per tooth of least time and cost, by the exact search and by the genetic algorithm, beside the "
        "points that the file prints.",
    )
    made.add_argument(
        "file",
        nargs="?",
        type=Path,
        metavar="FILE",
        help="cuts (.toml); without it the impeller paper's example is shown",
    )
    made.add_argument(
        "--reading",
        choices=("mm/s", "m/s"),
        default=None,
        help="unit of the cutting speed in the force's power law, when another than the file's",
    )
    made.add_argument(
        "--set",
        action="append",
        default=[],
        metavar="KEY=VALUE",
        dest="words",
        help="change a setting of optimize or optimize.genetic; may be repeated",
    )
    made.add_argument("--json", action="store_true", help="print the result as JSON")
    made.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Print the optimum of every cut in the file."""
    from trunnion.plan.cutting.optimization.example import (
        example_cuts,
        example_file,
        read_cuts,
    )
    from trunnion.plan.cutting.optimization.operation import OptimizationSettings

    settings = OptimizationSettings.of(words_of(options))
    cuts = read_cuts(options.file) if options.file else example_cuts()
    if options.reading:
        cuts = tuple(cut.reading(options.reading) for cut in cuts)
    found = [optimised(cut, settings) for cut in cuts]
    if options.json:
        show_json({"file": str(options.file or example_file()), "cuts": found})
        return 0
    print("\n\n".join(map(text_of, found)))
    if not options.file:
        print(f"\nthis stands in {example_file()}; copy it for a cut of your own")
    return 0


def optimised(cut: CutExample, settings: OptimizationSettings) -> dict[str, Any]:
    """Return a cut's optimum by both methods, the points that its file prints with what the equations give there, and the front."""
    from trunnion.plan.cutting.optimization.exact import solve_exactly
    from trunnion.plan.cutting.optimization.genetic import pareto_front, solve_genetically
    from trunnion.plan.cutting.optimization.problem import optimum_at

    problem, weight = cut.problem(), settings.optimize.time_weight
    exact = solve_exactly(problem, weight)
    genetic = solve_genetically(problem, weight, settings.genetic)
    points: list[tuple[str, float, float, PrintedPoint | None]] = [
        (p.name, p.spindle, p.feed, p) for p in cut.printed
    ]
    points += [
        (name, o.spindle, o.feed, None)
        for name, o in (("exact", exact), ("genetic", genetic.optimum if genetic else None))
        if o is not None
    ]
    rows = []
    for name, spindle, feed, printed in points:
        shares = problem.shares(spindle, feed)[:, 0]
        row: dict[str, Any] = {"name": name, "spindle": spindle, "feed_per_tooth": feed}
        if exact is not None:
            here = optimum_at(problem, spindle, feed, exact.least_time, exact.least_cost, weight)
            row |= {"time": here.time, "cost": here.cost, "objective": here.objective}
        row["feasible"] = bool(problem.is_feasible(spindle, feed)[0])
        row["shares"] = {c.name: float(s) for c, s in zip(problem.constraints, shares, strict=True)}
        if printed is not None:
            values = {"time": printed.time, "cost": printed.cost, "objective": printed.objective}
            row["printed"] = {k: v for k, v in values.items() if not math.isnan(v)}
        rows.append(row)
    return {
        "name": cut.name,
        "title": cut.title,
        "source": cut.source,
        "speed_unit": cut.force.speed_unit,
        "points": rows,
        "convergence": list(genetic.convergence) if genetic else [],
        "front": [front_row(p) for p in pareto_front(problem, settings.genetic)],
    }


def front_row(point: FrontPoint) -> dict[str, float]:
    """Return a point of a front as JSON has it."""
    return {
        "spindle": point.spindle,
        "feed_per_tooth": point.feed,
        "time": point.time,
        "cost": point.cost,
        "load": point.load,
    }


def text_of(found: dict[str, Any]) -> str:
    """Return one cut's optimum as aligned text."""
    names = list(found["points"][0]["shares"]) if found["points"] else []
    rows = [
        (
            "data",
            "n 1/min",
            "fz mm",
            "t min",
            "C",
            "M",
            *(f"{name} of limit" for name in names),
            "printed t, C, M",
        )
    ]
    for p in found["points"]:
        printed = ", ".join(f"{v:g}" for v in p.get("printed", {}).values())
        rows.append(
            (
                p["name"],
                f"{p['spindle']:.1f}",
                f"{p['feed_per_tooth']:.4f}",
                *(f"{p[k]:.3f}" if k in p else "" for k in ("time", "cost", "objective")),
                *(f"{s:.3f}" for s in p["shares"].values()),
                printed,
            )
        )
    heading = f"{found['name']}: {found['title']}" if found["title"] else found["name"]
    source = f"({found['source']})\n" if found["source"] else ""
    return (
        f"{heading}\n{source}cutting speed in the force's power law in {found['speed_unit']}\n"
        f"{table(rows, right=tuple(range(1, len(rows[0]) - 1)))}"
    )
