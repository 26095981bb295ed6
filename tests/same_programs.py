"""Shows that two states of the code program the same: posted text, tool list, features, process and verdict, byte for byte.

    python tests/same_programs.py BEFORE AFTER [--parts ../shared/parts] [--seeds 10] [--only NAME ...] [--renamed old=new ...]
        [--without PATTERN]

BEFORE and AFTER are checkouts (`git worktree add`); both run in this environment, each with its own sources in front. Programmed are B1, B4
(panels) and D1, D2 (curved parts, by their plan; D1 with named cutters too) where the parts are there, and random small parts of both
families. What differs is named with its first line; the exit code is 1 then. Settings whose keys were renamed are told by `--renamed`;
what a pattern matches, such as the digest of the plan, is left out by `--without`.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

SOURCES = ("core", "gui", "resources")
NAMED = ("surface.cutter=AL2-ball D8 R4", "surface.local_cutter=AL2-ball D5 R2.5")
"""Two ball mills of the catalogue, other ones than the plan of D1 would take."""
COARSE = ("surface.scallop=0.05", "surface.semi_scallop=0.3")
"""Random curved plates are programmed with coarse passes: sameness needs no fineness, and twenty parts take long."""
COMMAND = "from trunnion.cli.main import run; run()"
UNTIMED = ("seconds", "files")
"""Keys of the verdict's JSON that are not of the plan: how long it took, where it was written."""


@dataclass(frozen=True, slots=True)
class Case:
    """One part to be programmed, with settings."""

    name: str
    part: Path
    words: tuple[str, ...] = ()


def cases(parts: Path, seeds: int, folder: Path) -> Iterator[Case]:
    """Give the parts with truth that are there, and the random ones, which are written into a folder."""
    known = [
        Case("B1", parts / "panel/B1.step"),
        Case("B4", parts / "panel/B4.step"),
        Case("D1", parts / "surface/D1.step"),
        Case("D2", parts / "surface/D2.igs"),
        Case("D1-named", parts / "surface/D1.step", NAMED),
    ]
    yield from (c for c in known if c.part.is_file())
    from seeded.panels import panel
    from seeded.plates import plate

    for make, words in ((panel, ()), (plate, COARSE)):
        for made in map(make, range(seeds)):
            yield Case(made.name, made.written(folder), words)


def programmed(
    checkout: Path, case: Case, renamed: Mapping[str, str], folder: Path
) -> dict[str, bytes]:
    """Return what a checkout writes for a part, by file name, and what it prints; a refusal is its one line."""
    folder.mkdir(parents=True)
    words = [w for word in case.words for w in ("--set", _renamed(word, renamed))]
    environment = os.environ | {
        "PYTHONPATH": os.pathsep.join(str(checkout / s) for s in SOURCES),
        "PYTHONHASHSEED": "0",
    }
    done = subprocess.run(
        [
            sys.executable,
            "-c",
            COMMAND,
            "program",
            str(case.part),
            "-o",
            str(folder),
            "--name",
            case.name,
            "--json",
            *words,
        ],
        capture_output=True,
        env=environment,
        check=False,
    )
    if not done.stdout.strip():
        return {"refused": done.stderr.strip().splitlines()[-1] if done.stderr.strip() else b""}
    verdict = {k: v for k, v in json.loads(done.stdout).items() if k not in UNTIMED}
    texts = {
        p.name: p.read_bytes()
        for p in sorted(folder.iterdir())
        if p.suffix in (".nc", ".cl", ".xml", ".json")
    }
    return texts | {"verdict": json.dumps(verdict, indent=1, sort_keys=True).encode()}


def _renamed(word: str, renamed: Mapping[str, str]) -> str:
    key, _, value = word.partition("=")
    return f"{renamed.get(key, key)}={value}"


def differences(
    before: Mapping[str, bytes],
    after: Mapping[str, bytes],
    renamed: Mapping[str, str],
    without: str = "",
) -> list[str]:
    """Return a line for each file that is not the same, with the first line in which it differs; renamed keys count as the same."""
    found = [
        f"{name}: only {'before' if name in before else 'after'}"
        for name in sorted(before.keys() ^ after.keys())
    ]
    for name in sorted(before.keys() & after.keys()):
        text = before[name].decode()
        for old, new in renamed.items():
            text = text.replace(old, new)
        now = after[name].decode()
        if without:
            text, now = re.sub(without, "", text), re.sub(without, "", now)
        rows = zip(text.splitlines(), now.splitlines(), strict=False)
        if text != now:
            number, (old, new) = next(
                ((n, pair) for n, pair in enumerate(rows, 1) if pair[0] != pair[1]), (0, ("", ""))
            )
            found.append(
                f"{name}, line {number}: {old.strip()[:120]!r} became {new.strip()[:120]!r}"
            )
    return found


def main() -> int:
    """Compare, print a line a part, and return the exit code."""
    made = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    made.add_argument("before", type=Path)
    made.add_argument("after", type=Path)
    made.add_argument(
        "--parts",
        type=Path,
        default=Path(__file__).resolve().parent.parent.parent / "shared" / "parts",
    )
    made.add_argument("--seeds", type=int, default=10, help="random parts of each family")
    made.add_argument(
        "--renamed",
        action="append",
        default=[],
        metavar="OLD=NEW",
        help="a key that has another name after",
    )
    made.add_argument(
        "--without", default="", metavar="PATTERN", help="what is left out of the comparison"
    )
    made.add_argument("--only", nargs="+", metavar="NAME", help="parts, such as B1 or panel-03")
    made.add_argument("--jobs", type=int, default=2)
    chosen = made.parse_args()
    renamed = dict(word.split("=", 1) for word in chosen.renamed)
    with (
        tempfile.TemporaryDirectory(prefix="same-") as folder,
        ThreadPoolExecutor(chosen.jobs) as pool,
    ):

        def compared(case: Case) -> tuple[Case, list[str], int]:
            own = Path(folder) / "out" / case.name
            before = programmed(chosen.before.resolve(), case, {}, own / "before")
            after = programmed(chosen.after.resolve(), case, renamed, own / "after")
            found = differences(before, after, renamed, chosen.without)
            return case, found, len(before)

        different = 0
        wanted = [
            case
            for case in cases(chosen.parts, chosen.seeds, Path(folder))
            if not chosen.only or case.name in chosen.only
        ]
        for case, found, count in pool.map(compared, wanted):
            different += bool(found)
            print(
                f"{case.name:12s} {count} files {'the same' if not found else 'DIFFERENT'}",
                *found,
                sep="\n    ",
                flush=True,
            )
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
