"""`make bench`: how fast the program is, each figure beside a reference measured in the same run, written to bench.json.

A single absolute time says little on a shared machine; the ratio to a reference that ran just before does. Figures of one core are CPU
seconds. `--only CASE` runs one case alone, `--quick` smaller sizes.
"""

from __future__ import annotations

import argparse
import json
import statistics
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from functools import partial
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


def noted(
    name: str, seconds: float, ratio_to: str, ratio: float, goal: str, part: str = "block"
) -> Figure:
    """Return a figure, and show it."""
    figure = Figure(
        name=name,
        part=part,
        seconds=round(seconds, 4),
        ratio_to=ratio_to,
        ratio=float(f"{ratio:.4g}"),
        goal=goal,
    )
    print(
        f"{name:28s} {seconds:9.4f} s   {figure.ratio:9.4g} x {ratio_to}   goal {goal}", flush=True
    )
    return figure


def compared(
    name: str,
    part: str,
    work: Callable[[], Any],
    reference: Callable[[], Any],
    ratio_to: str,
    goal: str,
) -> Figure:
    """Return the figure of some work beside a reference."""
    base = median_seconds(reference)
    seconds = median_seconds(work)
    return noted(name, seconds, ratio_to, seconds / base, goal, part)


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


def reading(path: Path, folder: Path, compared: Callable[..., Figure]) -> Iterator[Figure]:
    """Reading the file with all checks, beside the CAD kernel's own reader."""
    from trunnion.part.read.part_file import read_part

    yield compared(
        "import",
        "B1",
        lambda: read_part(path),
        bare_reader(path),
        "the CAD kernel's own reader, no checks, no second process",
        "< 12",
    )


def figures(folder: Path, only: str, quick: bool) -> Iterator[Figure]:
    """Yield the figures of the case asked for, or of all."""
    for name, case in cases(folder, quick).items():
        if only in ("", name):
            yield from case()


def cases(folder: Path, quick: bool) -> dict[str, Callable[[], Iterator[Figure]]]:
    """Return what can be measured, by name."""
    from cases import contact, graph, recognition, roughing, whole_line
    from drive_geometry import drive_geometry
    from drop import drop
    from proof import PROOF
    from released import released

    path = unpacked(folder)
    panel = {
        "import": reading,
        "graph": graph,
        "recognition": recognition,
        "roughing": roughing,
        "contact": contact,
        "whole-line": whole_line,
    }
    return {
        **{name: partial(case, path, folder, compared) for name, case in panel.items()},
        **{
            name: partial(_rows, case, quick)
            for name, case in {
                **PROOF,
                "drop": drop,
                "drive-geometry": drive_geometry,
                "released": released,
            }.items()
        },
    }


def _rows(case: Callable[[bool], Iterator[dict[str, Any]]], quick: bool) -> Iterator[Figure]:
    for row in case(quick):
        yield noted(**row)


def main() -> int:
    """Measure everything, or what was asked for, and write the figures."""
    wanted = argparse.ArgumentParser(description=__doc__)
    wanted.add_argument("--output", type=Path, default=Path("bench.json"))
    wanted.add_argument("--only", default="", help="one case alone, by its name")
    wanted.add_argument("--quick", action="store_true", help="smaller sizes")
    chosen = wanted.parse_args()
    np.seterr(all="raise", under="ignore")
    with tempfile.TemporaryDirectory() as folder:
        names = cases(Path(folder), chosen.quick)
        if chosen.only and chosen.only not in names:
            wanted.error(f"--only knows {', '.join(names)}")
        found = list(figures(Path(folder), chosen.only, chosen.quick))
    chosen.output.write_text(
        json.dumps([asdict(f) for f in found], indent=1) + "\n", encoding="utf-8"
    )
    print(f"{len(found)} figures in {chosen.output}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
