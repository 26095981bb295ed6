"""`make bench`: how fast the program is, each figure beside a reference measured in the same run, written to bench.json.

A single absolute time says little on a shared machine; the ratio to a reference that ran just before does.
"""

from __future__ import annotations

import argparse
import json
import statistics
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

ROUNDS = 3


@dataclass(frozen=True, kw_only=True)
class Figure:
    """One measured figure: seconds (median), and its ratio to the seconds of a reference of the same run."""

    name: str
    part: str
    seconds: float
    ratio_to: str
    ratio: float
    goal: str


def median_seconds(work: Callable[[], Any], rounds: int = ROUNDS) -> float:
    """Return the median wall time of some runs after one that is not counted."""
    work()
    taken = []
    for _ in range(rounds):
        began = time.perf_counter()
        work()
        taken.append(time.perf_counter() - began)
    return statistics.median(taken)


def compared(name: str, part: str, work: Callable[[], Any], reference: Callable[[], Any], ratio_to: str, goal: str) -> Figure:
    """Return the figure of some work beside a reference."""
    base = median_seconds(reference)
    seconds = median_seconds(work)
    figure = Figure(name=name, part=part, seconds=round(seconds, 4), ratio_to=ratio_to, ratio=round(seconds / base, 3), goal=goal)
    print(f"{name:28s} {seconds:9.4f} s   {figure.ratio:9.3f} x {ratio_to}   goal {goal}", flush=True)
    return figure


def bare_reader(path: Path) -> Callable[[], Any]:
    """Return the reading of a STEP file by the CAD kernel alone."""
    from OCP.STEPControl import STEPControl_Reader

    def read() -> Any:
        reader = STEPControl_Reader()
        reader.ReadFile(str(path))
        reader.TransferRoots()
        return reader.OneShape()

    return read


def unpacked(folder: Path) -> Path:
    """Return the sample panel as a plain STEP file."""
    import gzip

    from trunnion_resources import sample
    path = folder / "B1.step"
    path.write_bytes(gzip.decompress(sample("B1").read_bytes()))
    return path


def figures(folder: Path) -> list[Figure]:
    """Return all figures on the sample panel."""
    from cases import contact, graph, recognition, roughing, stock, whole_line
    path = unpacked(folder)
    from trunnion.part.read import read_part
    read = bare_reader(path)
    found = [compared("import", "B1", lambda: read_part(path), read, "the CAD kernel's own reader, no checks, no second process", "< 12")]
    for case in (graph, recognition, roughing, contact, stock, whole_line):
        found.extend(case(path, folder, compared))
    return found


def main() -> int:
    """Measure everything and write the figures."""
    wanted = argparse.ArgumentParser(description=__doc__)
    wanted.add_argument("--output", type=Path, default=Path("bench.json"))
    chosen = wanted.parse_args()
    np.seterr(all="raise", under="ignore")
    with tempfile.TemporaryDirectory() as folder:
        found = figures(Path(folder))
    chosen.output.write_text(json.dumps([asdict(f) for f in found], indent=1) + "\n", encoding="utf-8")
    print(f"{len(found)} figures in {chosen.output}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
