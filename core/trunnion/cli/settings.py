"""`trunnion settings`: every setting with its value range, made from the declarations."""

from __future__ import annotations

import argparse
from typing import Any

from trunnion.cli.common import show_json, table


def add(commands: Any) -> None:
    """Add the command to the command line."""
    made = commands.add_parser("settings", help="list the settings that --set can change")
    made.add_argument("--json", action="store_true", help="print the result as JSON")
    made.add_argument(
        "--markdown", action="store_true", help="print the reference page of the documentation"
    )
    made.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Print the settings of every step."""
    from trunnion.pipeline import Engine
    from trunnion.settings import declared

    groups = [
        (step, d)
        for step, all_groups in Engine().settings().items()
        for group in all_groups
        for d in declared(group)
    ]
    if options.json:
        show_json(
            [
                {
                    "key": d.key,
                    "step": step,
                    "label": d.label,
                    "default": d.default,
                    "unit": d.unit,
                    "low": d.low,
                    "high": d.high,
                    "choices": list(d.choices),
                    "help": d.help,
                }
                for step, d in groups
            ]
        )
    elif options.markdown:
        print(
            "# Settings\n\nEverything that `--set KEY=VALUE` and the panels can change; made by `make docs` from the declarations.\n"
        )
        print("| key | default | allowed | what it does |\n|---|---|---|---|")
        for _, d in groups:
            default = f"{d.default} {d.unit}".strip()
            print(f"| `{d.key}` | {default} | {d.allowed()} | **{d.label}.** {d.help} |")
    else:
        rows = [("key", "default", "allowed", "what it does")]
        rows += [(d.key, str(d.default), d.allowed(), f"{d.label}: {d.help}") for _, d in groups]
        print(table(rows, right=(1,)))
    return 0
