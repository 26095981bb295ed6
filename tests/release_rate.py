"""How many of the random parts are released, at once and after repairs, and how much of their feed time is air.

    python tests/release_rate.py panel leaning edged demanded kept pitted plate casing recessed impeller --seeds 0-19 [--jobs 2]
                                 [--set KEY=VALUE] [--json FILE] [--keep FOLDER]

Every part goes through the command line as a shop's part would. One line a part: verdict, coverage of what can be reached, share of air in
the feed time, minutes at the machine, seconds it took, and the first line that says why it was rejected.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parent))

COMMAND = "from trunnion.cli.main import run; run()"
LONGEST_S = 1800.0
"""A part that takes longer is given up."""
RELEASED = ("passed", "passed with remarks")
WORDS = {
    "impeller": ("post.dialect=sinumerik",),
    "casing": (),
    "recessed": (),
}
"""Settings that a kind of parts needs; those of the caller come after them."""


@dataclass(frozen=True, slots=True)
class Outcome:
    """What came of one part."""

    name: str
    verdict: str
    reachable: float
    air: float
    machine_s: float
    seconds: float
    repairs: int
    errors: tuple[str, ...]

    @property
    def is_released(self) -> bool:
        """Whether a shop gets its program."""
        return self.verdict in RELEASED

    def line(self) -> str:
        """Return the outcome in one line."""
        first = "" if self.is_released else f"   {self.errors[0] if self.errors else ''}"
        return (
            f"{self.name:10s} {self.verdict:20s} reach {100.0 * self.reachable:6.2f} %  air {100.0 * self.air:5.1f} %"
            f"  {self.machine_s / 60.0:6.1f} min  {self.seconds:6.1f} s  {self.repairs} repairs{first[:220]}"
        )


def programmed(name: str, part: Path, folder: Path, words: Sequence[str]) -> Outcome:
    """Return what the command line makes of a part."""
    settings = [w for word in words for w in ("--set", word)]
    command = [sys.executable, "-c", COMMAND, "program", str(part), "-o", str(folder), "--json"]
    began = time.perf_counter()
    try:
        done = subprocess.run(
            [*command, *settings], capture_output=True, text=True, timeout=LONGEST_S, check=False
        )
    except subprocess.TimeoutExpired:
        return _without(name, "given up", LONGEST_S, f"not done after {LONGEST_S:.0f} s")
    seconds = time.perf_counter() - began
    if done.returncode not in (0, 1) or not done.stdout.strip():
        return _without(
            name, "refused", seconds, (done.stderr.strip().splitlines() or ["no output"])[-1]
        )
    return _outcome(name, json.loads(done.stdout), seconds)


def _without(name: str, verdict: str, seconds: float, why: str) -> Outcome:
    return Outcome(name, verdict, 0.0, 0.0, 0.0, seconds, 0, (why,))


def _outcome(name: str, told: dict[str, Any], seconds: float) -> Outcome:
    operations = told.get("operations", ())
    feed = sum(o.get("time_s", 0.0) for o in operations)
    air = sum(o.get("time_s", 0.0) * o.get("air_share", 0.0) for o in operations)
    return Outcome(
        name=name,
        verdict=told.get("verdict") or "no verdict",
        reachable=told.get("reachable") or 0.0,
        air=air / feed if feed else 0.0,
        machine_s=told.get("machining_time_s") or 0.0,
        seconds=seconds,
        repairs=sum(bool(r.get("kept")) for r in told.get("repairs", ())),
        errors=tuple(
            f"{f['code']}: {f['text']}" for f in told["findings"] if f["severity"] == "error"
        ),
    )


def outcomes(
    kinds: Iterable[str], seeds: Iterable[int], folder: Path, words: Sequence[str], jobs: int
) -> list[Outcome]:
    """Return what came of the parts of some kinds and seeds, each shown when it is done."""
    from seeded.casings import casing
    from seeded.demanded_plates import demanded_plate
    from seeded.edged_panels import edged_panel
    from seeded.impellers import impeller
    from seeded.kept_panels import kept_panel
    from seeded.leaning_panels import leaning_panel
    from seeded.panels import panel
    from seeded.pitted_panels import pitted_panel
    from seeded.plates import plate
    from seeded.recesses import recessed_casing

    makers = {
        "panel": panel,
        "leaning": leaning_panel,
        "edged": edged_panel,
        "demanded": demanded_plate,
        "kept": kept_panel,
        "pitted": pitted_panel,
        "plate": plate,
        "casing": casing,
        "recessed": recessed_casing,
        "impeller": partial(impeller, rounded=True),
    }
    parts = [(makers[kind](seed), WORDS.get(kind, ())) for kind in kinds for seed in seeds]
    files = [(p.name, p.written(folder), own) for p, own in parts]

    def one(named: tuple[str, Path, Sequence[str]]) -> Outcome:
        name, file, own = named
        outcome = programmed(name, file, folder / name, [*own, *words])
        print(outcome.line(), flush=True)
        return outcome

    with ThreadPoolExecutor(jobs) as pool:
        return list(pool.map(one, files))


def summary(kind: str, found: Sequence[Outcome]) -> str:
    """Return the figures of a kind of parts in one line."""
    released = [o for o in found if o.is_released]
    first = [o for o in released if not o.repairs]
    air = sum(o.air for o in released) / max(len(released), 1)
    return (
        f"{kind}: {len(released)} of {len(found)} released ({100.0 * len(released) / len(found):.1f} %), "
        f"{len(first)} without repairs, mean air {100.0 * air:.1f} %"
    )


def main() -> None:
    """Measure, print, and write."""
    asked = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    asked.add_argument(
        "kinds",
        nargs="+",
        choices=(
            "panel",
            "leaning",
            "edged",
            "demanded",
            "kept",
            "pitted",
            "plate",
            "casing",
            "recessed",
            "impeller",
        ),
    )
    asked.add_argument("--seeds", default="0-19")
    asked.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    asked.add_argument("--set", action="append", default=[], dest="words")
    asked.add_argument("--json", type=Path)
    asked.add_argument("--keep", type=Path)
    told = asked.parse_args()
    low, _, high = told.seeds.partition("-")
    seeds = range(int(low), int(high or low) + 1)
    with tempfile.TemporaryDirectory() as made:
        folder = told.keep or Path(made)
        folder.mkdir(parents=True, exist_ok=True)
        found = outcomes(told.kinds, seeds, folder, told.words, told.jobs)
    for kind in told.kinds:
        print(summary(kind, [o for o in found if o.name.startswith(kind)]))
    if told.json:
        told.json.write_text(json.dumps([asdict(o) for o in found], indent=1))


if __name__ == "__main__":
    main()
