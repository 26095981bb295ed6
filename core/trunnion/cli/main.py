"""`trunnion …`: arguments to pipeline calls, findings to exit codes. Heavy imports happen inside the commands, so `--help` is quick.

Exit codes: 0 done; 1 done, but the verdict failed or there are findings of severity error; 2 bad input or bad call, one line on
standard error; 130 cancelled.
"""

from __future__ import annotations

import argparse
import sys
from importlib import import_module
from typing import NoReturn

from trunnion import registry
from trunnion.findings import Cancelled, TrunnionError
from trunnion.version import __version__

DONE, PROBLEMS, BAD, CANCELLED = 0, 1, 2, 130

GENERAL = (
    "info",
    "planning.recognize",
    "planning.edit",
    "planning.size",
    "planning.blank",
    "planning.route",
    "planning.optimize",
    "planning.change",
    "planning.revise",
    "planning.plans",
    "planning.estimate",
    "planning.optimum",
    "programs.program",
    "programs.verify",
    "programs.post",
    "programs.batch",
    "cut",
    "export",
    "tools",
    "settings",
    "compile",
    "gui",
)
"""Modules of the commands for parts of every family; families and packages add theirs by entry points (`registry.COMMANDS`)."""


class OneLineParser(argparse.ArgumentParser):
    """A parser whose complaint is one line on standard error."""

    def error(self, message: str) -> NoReturn:
        """Return what is wrong with the call and leave with the exit code of a bad call."""
        self.exit(BAD, f"{self.prog}: {message}; see '{self.prog} --help'\n")


def parser() -> argparse.ArgumentParser:
    """Return the parser of the whole command line."""
    top = OneLineParser(
        prog="trunnion", description="Writes proven NC programs for aerospace parts."
    )
    top.add_argument("--version", action="version", version=f"trunnion {__version__}")
    commands = top.add_subparsers(dest="command", metavar="COMMAND", parser_class=OneLineParser)
    for name in GENERAL:
        import_module(f"trunnion.cli.{name}").add(commands)
    for name in registry.names(registry.COMMANDS):
        registry.get(registry.COMMANDS, name)(commands)
    return top


def main(arguments: list[str] | None = None) -> int:
    """Run one command and return its exit code."""
    top = parser()
    options = top.parse_args(arguments)
    if options.command is None:
        top.print_help()
        return BAD
    try:
        return int(options.run(options))
    except TrunnionError as reason:
        print(f"trunnion: {reason}", file=sys.stderr)
        return BAD
    except (Cancelled, KeyboardInterrupt):
        print("trunnion: cancelled", file=sys.stderr)
        return CANCELLED
    except BrokenPipeError:
        sys.stderr.close()
        return DONE


def run() -> NoReturn:
    """Run the command line of this process."""
    sys.exit(main())
