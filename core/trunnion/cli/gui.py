"""`trunnion gui`: the window."""

from __future__ import annotations

import argparse
from importlib import import_module
from typing import Any


def add(commands: Any) -> None:
    """Add the command to the command line."""
    made = commands.add_parser("gui", help="open the window")
    made.add_argument("part", nargs="?", metavar="PART", help="part or project to open")
    made.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Open the window and stay in it until it is closed."""
    # The core imports nothing of the window; the name is looked up only here, when a person asks for it.
    app = import_module("trunnion_gui.app")
    return int(app.main([options.part] if options.part else []))
