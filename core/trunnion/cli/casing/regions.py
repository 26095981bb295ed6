"""`trunnion regions`: which regions of a casing's bottoms are turned, turned with interruptions, or milled."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any

from trunnion.cli.common import (
    exit_code,
    open_session,
    part_command,
    progress_of,
    show_findings,
    show_json,
    table,
    words_of,
)
from trunnion.findings import BadInput

if TYPE_CHECKING:
    from trunnion.model.feature import Recognition
    from trunnion.model.session import Session
    from trunnion.pipeline import Engine

CASING, POCKET = "casing", "pocket"


def add(commands: Any) -> None:
    """Add the command to the command line."""
    part_command(
        commands,
        "regions",
        "which regions of a casing are turned and which are milled",
        "For each pocket's bottom, unrolled about the main axis: the bands between the bounds of its bosses, and the regions gap by gap. "
        "Settings: threshold (0: by speed and machine), widening, fillets, surface_speed, and more in docs/casing.md.",
    ).set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Print the regions of a casing."""
    from trunnion.plan.casing.regions.plan import casing_regions, region_findings
    from trunnion.plan.casing.regions.settings import RegionSettings
    from trunnion.settings import checked, choose, declared

    own = {name: d.key for d in declared(RegionSettings) for name in (d.name, d.key)}
    words = words_of(options)
    own_choices = {own[key]: value for key, value in words.items() if key in own}
    settings = checked(choose(RegionSettings, own_choices))
    options.words = [f"{key}={value}" for key, value in words.items() if key not in own]
    engine, session, found = casing_session(options)
    graph = engine.context_of(session).part.graph()
    plans = casing_regions(found, graph, settings, progress_of(options))
    findings = (*session.findings(), *region_findings(plans))
    if options.json:
        show_json(
            {
                "widening": settings.boss_widening,
                "threshold": settings.threshold,
                "pockets": [p.as_dict() for p in plans],
                "findings": [f.as_dict() for f in findings],
            }
        )
    else:
        rows = [("pocket", "from z", "to z", "kind", "from angle", "to angle", "between", "speed")]
        for plan in plans:
            shown = plan.as_dict()
            for r in shown.get("regions", ()):
                rows.append(
                    (
                        shown["id"],
                        *(f"{z:.3f}" for z in r["z"]),
                        r["kind"],
                        *(f"{t:.3f}" for t in r["theta"]),
                        f"{r['after']} and {r['before']}" if "after" in r else "all round",
                        f"turn at {r['lower_speed']} m/min" if "lower_speed" in r else "",
                    )
                )
        print(table(rows, right=(1, 2, 4, 5)))
    show_findings(options, findings)
    return exit_code(findings)


def casing_session(options: argparse.Namespace) -> tuple[Engine, Session, Recognition]:
    """Return engine, session and features of a casing; raise `BadInput` for a part that is none, or has no pockets."""
    engine, session = open_session(options, "recognize")
    found = session.recognition
    if found is None or found.doubt:
        raise BadInput(found.doubt if found else "nothing was recognised: recognise the part first")
    if found.family != CASING or not found.of_kind(POCKET):
        name = session.part.name if session.part else "the part"
        raise BadInput(
            f"{name} is no casing with pockets that bosses stand on; for others there is nothing to choose between turning and milling"
        )
    return engine, session, found
