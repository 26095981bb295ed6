"""The table of a batch as the command line shows it: a line a part as it comes, progress on a terminal, JSON at the end."""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Sequence
from shutil import get_terminal_size
from typing import Any

from trunnion.batch.workers import PartProgress
from trunnion.cli.common import show_json, table
from trunnion.model.part_result import WITHOUT_VERDICT, PartResult
from trunnion.report.html import duration, share
from trunnion.store.ledger import LEDGER_FILE, PAGE_FILE
from trunnion.units import timed

COLUMNS = (
    ("part", 0),
    ("family", 8),
    ("verdict", 19),
    ("coverage", 9),
    ("reachable", 9),
    ("gouge mm", 8),
    ("machine time", 16),
    ("seconds", 8),
    ("MB", 6),
    ("note", 0),
)
"""Heads of the columns and their widths: that of the parts is the longest name's, that of the notes is not known before they come."""
RIGHT = (3, 4, 5, 6, 7, 8)
"""Columns of figures."""
TAKEN_OVER = "as before"
"""What the note of a result of an earlier run begins with."""


class BatchTable:
    """The table on standard output, a line as each part comes, with how far the others are in the last line of a terminal."""

    def __init__(self, files: Sequence[str], options: argparse.Namespace) -> None:
        self._options, self._n_parts = options, len(files)
        self._widths = [
            max((width, len(name), *(len(f) for f in files if n == 0)))
            for n, (name, width) in enumerate(COLUMNS)
        ]
        self._prints = not (options.quiet or options.json)
        self._terminal = not options.quiet and sys.stderr.isatty()
        self._at_work: dict[str, PartProgress] = {}
        self._began, self._taken_over = time.monotonic(), dict[str, PartResult]()
        self.n_done = 0

    def add(self, result: PartResult, taken_over: bool) -> None:
        """Print a part's line."""
        if not self.n_done and self._prints:
            self._print([name for name, _ in COLUMNS])
        self.n_done += 1
        self._at_work.pop(result.folder, None)
        if taken_over:
            self._taken_over[result.folder] = result
        self.clear()
        if self._prints:
            self._print(self._row(result))
        elif not self._options.quiet and result.verdict in WITHOUT_VERDICT:
            print(f"trunnion: {result.part}: {result.verdict}: {result.note}", file=sys.stderr)

    def progress(self, at: PartProgress) -> None:
        """Show how far the parts at work are, in one line."""
        self._at_work[at.folder] = at
        if not self._terminal:
            return
        shown = ", ".join(f"{p.folder} {p.fraction:.0%} {p.text}" for p in self._at_work.values())
        elapsed = timed(float(round(time.monotonic() - self._began)))
        line = f"{self.n_done} of {self._n_parts} parts, {elapsed}: {shown}"
        # A line that is longer than the terminal is wide could not be rewritten.
        width = get_terminal_size().columns - 1
        print(f"\r\x1b[K{line[:width]}", end="", file=sys.stderr, flush=True)

    def clear(self) -> None:
        """Remove the line of progress."""
        if self._terminal:
            print("\r\x1b[K", end="", file=sys.stderr, flush=True)

    def end(self, results: Sequence[PartResult]) -> None:
        """Print what is known once all parts are done."""
        released = sum(r.is_released for r in results)
        page = str(self._options.output / PAGE_FILE)
        if self._options.json:
            show_json(
                {
                    "parts": [self._as_dict(r) for r in results],
                    "released": released,
                    "page": page,
                    "ledger": str(self._options.output / LEDGER_FILE),
                }
            )
            return
        if self._options.quiet:
            rows = [tuple(name for name, _ in COLUMNS), *(self._row(r) for r in results)]
            print(table(rows, right=RIGHT))
        print(f"{released} of {len(results)} parts released; {page}")

    def _as_dict(self, result: PartResult) -> dict[str, Any]:
        data = result.as_dict()
        return {
            "part": data.pop("part"),
            "verdict": data.pop("verdict"),
            "coverage": data.pop("coverage"),
            "gouge_mm": data.pop("gouge"),
            "memory_mb": data.pop("memory"),
            "taken_over": result.folder in self._taken_over,
            **data,
        }

    def _row(self, result: PartResult) -> tuple[str, ...]:
        before = TAKEN_OVER if result.folder in self._taken_over else ""
        time_s, gouge = result.machining_time_s, result.gouge
        return (
            result.part,
            result.family,
            result.verdict,
            *("" if v is None else share(v) for v in (result.coverage, result.reachable)),
            "" if gouge is None else f"{gouge:.4f}",
            "" if time_s is None else duration(time_s),
            f"{result.seconds:.1f}",
            f"{result.memory:.0f}",
            "; ".join(filter(None, (before, result.note))),
        )

    def _print(self, cells: Sequence[str]) -> None:
        print(
            "  ".join(
                c.rjust(w) if n in RIGHT else c.ljust(w)
                for n, (c, w) in enumerate(zip(cells, self._widths, strict=True))
            ).rstrip(),
            flush=True,
        )
