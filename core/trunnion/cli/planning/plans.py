"""`trunnion plans`: the plan library: finished processes added, listed, shown, removed, and matched with a part."""

from __future__ import annotations

import argparse
import datetime
from typing import TYPE_CHECKING, Any

from trunnion.cli.common import (
    add_options,
    exit_code,
    folder_named,
    open_session,
    show_findings,
    show_json,
    table,
)
from trunnion.units import percent

if TYPE_CHECKING:
    from trunnion.shop.library import PlanLibrary, PlanMatch, TaughtPlan


def add(commands: Any) -> None:
    """Add the command to the command line."""
    made = commands.add_parser(
        "plans",
        help="the plan library: add a finished process, list, show, remove, match",
        description="The plan library keeps what finished processes teach; `trunnion route` follows the plan of a similar part.",
    )
    kinds = made.add_subparsers(dest="what", metavar="WHAT", required=True)
    on_part = kinds.add_parser("add", help="add the process of a part or project under a name")
    _add_part(on_part)
    on_part.add_argument("--name", required=True, metavar="NAME", help="the plan's name")
    on_part.add_argument(
        "--date",
        default="",
        metavar="DATE",
        help="date of the plan (YYYY-MM-DD; default: today)",
    )
    on_part.set_defaults(run=run_add)
    on_part = kinds.add_parser("match", help="which plans are similar to a part, and why")
    _add_part(on_part)
    on_part.set_defaults(run=run_match)
    on_library = kinds.add_parser("list", help="all plans of the library")
    _add_library(on_library)
    on_library.set_defaults(run=run_list)
    for name, help, run in (
        ("show", "one plan: its part, stages, cutters and settings", run_show),
        ("remove", "remove one plan", run_remove),
    ):
        on_library = kinds.add_parser(name, help=help)
        on_library.add_argument("name", metavar="NAME", help="the plan's name")
        _add_library(on_library)
        on_library.set_defaults(run=run)


def _add_part(made: argparse.ArgumentParser) -> None:
    made.add_argument(
        "part",
        metavar="PART",
        help="part file (.step, .stp, .stpz, .igs, .iges) or project (.trunnion)",
    )
    add_options(made)


def _add_library(made: argparse.ArgumentParser) -> None:
    made.add_argument(
        "--user-folder",
        type=folder_named,
        default=None,
        metavar="DIR",
        help="the shop's folder with the library (default: the user's own)",
    )
    made.add_argument("--json", action="store_true", help="print the result as JSON")


def run_add(options: argparse.Namespace) -> int:
    """Route the part where that is stale, add its process to the library and print what was added."""
    from trunnion.pipeline.planning.library import add_to_library
    from trunnion.shop.library.plan_text import plan_dict

    engine, session = open_session(options, "route")
    date = options.date or datetime.date.today().isoformat()
    result = add_to_library(session, engine.context_of(session), name=options.name, date=date)
    findings = (*session.findings(), *result.findings)
    if options.json:
        show_json(
            {
                "file": str(engine.library.path),
                "plan": plan_dict(result.plan),
                "findings": [f.as_dict() for f in findings],
            }
        )
    else:
        print(f"added to {engine.library.path}")
        print(plan_words(result.plan))
    show_findings(options, findings)
    return exit_code(findings)


def run_match(options: argparse.Namespace) -> int:
    """Print the plans for the part's family, the most similar first, with the reasons."""
    from trunnion.pipeline.planning.library import library_choice, matches, signature_of

    # Sizes and blank are both compared.
    engine, session = open_session(options, "blank")
    context = engine.context_of(session)
    found = matches(session, context)
    followed = library_choice(session, context).plan
    if options.json:
        signature = signature_of(session, context)
        show_json(
            {
                "file": str(engine.library.path),
                "signature": signature.as_dict() if signature is not None else None,
                "matches": [m.as_dict() for m in found],
                "followed": followed.name if followed is not None else None,
                "findings": [f.as_dict() for f in session.findings()],
            }
        )
    else:
        print(match_table(found))
        print(f"a route follows {followed.name}" if followed else "a route follows none of them")
    show_findings(options, session.findings())
    return exit_code(session.findings())


def run_list(options: argparse.Namespace) -> int:
    """Print the plans of the library by name."""
    from trunnion.shop.library.plan_text import plan_dict

    library = _library(options)
    plans = library.plans()
    if options.json:
        show_json({"file": str(library.path), "plans": [plan_dict(p) for p in plans]})
    elif not plans:
        print(f"{library.path}: no plans")
    else:
        rows = [("plan", "family", "part", "date", "stages", "operations")]
        rows += [
            (p.name, p.family, p.part, p.date, str(len(p.stages)), str(_count(p))) for p in plans
        ]
        print(table(rows, right=(4, 5)))
    return 0


def run_show(options: argparse.Namespace) -> int:
    """Print one plan."""
    from trunnion.shop.library.plan_text import plan_dict

    plan = _library(options).plan(options.name)
    if options.json:
        show_json(plan_dict(plan))
    else:
        print(plan_words(plan))
    return 0


def run_remove(options: argparse.Namespace) -> int:
    """Remove one plan."""
    library = _library(options)
    library.remove(options.name)
    if options.json:
        show_json({"file": str(library.path), "removed": options.name})
    else:
        print(f"removed {options.name} from {library.path}")
    return 0


def _library(options: argparse.Namespace) -> PlanLibrary:
    from trunnion.shop.library import PlanLibrary, library_file

    return PlanLibrary(library_file(options.user_folder))


def _count(plan: TaughtPlan) -> int:
    return sum(o.count for o in plan.operations)


def match_table(found: tuple[PlanMatch, ...]) -> str:
    """Return matches as aligned text."""
    rows = [("plan", "similarity", "why")]
    rows += [(m.plan.name, percent(m.similarity.value), m.similarity.words) for m in found]
    return table(rows, right=(1,))


def plan_words(plan: TaughtPlan) -> str:
    """Return a plan as text: where it comes from, its stages with their cutters, and its settings."""
    rows = [("stage", "on", "operations", "cutters")]
    for stage in plan.stages:
        mine = [o for o in plan.operations if o.stage == stage.name]
        rows.append(
            (
                stage.name,
                ", ".join(stage.on),
                str(sum(o.count for o in mine)),
                ", ".join(dict.fromkeys(o.tool for o in mine)),
            )
        )
    settings = [f"{key} = {value}" for key, value in plan.settings.items()]
    return "\n".join(
        [
            f"{plan.name}: taught by {plan.part} on {plan.date}, from the plan {plan.base}",
            table(rows, right=(2,)),
            *settings,
        ]
    )
