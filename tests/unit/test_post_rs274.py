"""LinuxCNC's own interpreter reads what we write, and moves as we mean.

`TRUNNION_RS274` is the path of its `rs274`; without it, `.rs274/rs274` in the project or one on the PATH is used.
"""

from __future__ import annotations

import math
import os
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from conftest import ROOT
from programs import BULL_10, CCW, CW, FLAT_16, LINE, RAPID, S1, path_of, program_1, section
from trunnion.model.program import Program
from trunnion.model.toolpath import Motion
from trunnion.post.dialects.linuxcnc import LinuxCncDialect
from trunnion.post.header import Header
from trunnion.post.readers.linuxcnc import read_linuxcnc
from trunnion.post.settings import PostSettings

HEADER = Header(name="B1", part="B1", part_digest="ab12", plan_digest="cd34")
TOOLS = (FLAT_16, BULL_10)


def interpreter() -> str | None:
    beside = ROOT / ".rs274" / "rs274"
    return os.environ.get("TRUNNION_RS274") or (str(beside) if beside.is_file() else shutil.which("rs274"))


RS274 = interpreter()
pytestmark = pytest.mark.skipif(RS274 is None, reason="LinuxCNC's rs274 is not here: run installer/rs274.sh or set TRUNNION_RS274")


def run(text: str, folder: Path) -> list[tuple[str, str, list[float]]]:
    """Return N word, canonical call and numbers of each line that rs274 prints; its exit code must be 0."""
    table = folder / "tools.tbl"
    table.write_text("".join(f"T{t.number} P{t.number} Z{t.gauge_length / 25.4:.8f} D{t.diameter / 25.4:.8f} ;{t.name}\n" for t in TOOLS))
    (folder / "program.ngc").write_text(text)
    done = subprocess.run([RS274, "-g", "-t", str(table), str(folder / "program.ngc")], capture_output=True, text=True, timeout=60,
                          cwd=folder, env={**os.environ, "LD_LIBRARY_PATH": str(Path(RS274).resolve().parent)})
    assert done.returncode == 0, done.stderr
    found = [re.match(r"\s*\d+ N(\S+)\s+(\w+)\((.*)\)", line) for line in done.stdout.splitlines()]
    return [(m[1], m[2], [float(v) for v in re.findall(r"-?\d+\.\d+|-?\d+", m[3])]) for m in found if m]


def motions_of(program: Program, text: str) -> list[tuple[str, str, list[float]]]:
    """Return the canonical calls that our own reading of a text amounts to, with the N word of each block."""
    lines, calls = text.split("\n"), []
    for part in read_linuxcnc(text, TOOLS, S1).sections:
        path, starts = part.path, part.path.starts()
        for row, line in enumerate(part.block_lines):
            number, (x, y, z), centre = lines[line - 1].split()[0][1:], path.position[row], path.centre[row]
            if path.motion[row] >= Motion.ARC_CW:
                calls.append((number, "ARC_FEED", [x, y, centre[0], centre[1], 1 if path.motion[row] == CCW else -1, z]))
                assert math.dist(starts[row][:2], centre[:2]) > 0.0
            else:
                calls.append((number, "STRAIGHT_TRAVERSE" if path.motion[row] == RAPID else "STRAIGHT_FEED", [x, y, z]))
    return calls


def compare(program: Program, folder: Path, **settings) -> int:
    text = LinuxCncDialect().write([program], HEADER, PostSettings(**settings))
    scale = 25.4 if settings.get("units") == "inch" else 1.0
    ours = motions_of(program, text)
    numbers = {number for number, _, _ in ours}
    theirs = [call for call in run(text, folder) if call[0] in numbers and call[1] in ("STRAIGHT_TRAVERSE", "STRAIGHT_FEED", "ARC_FEED")]
    assert [call[:2] for call in ours] == [call[:2] for call in theirs]
    for (_, name, mine), (_, _, other) in zip(ours, theirs, strict=True):
        lengths = [0, 1, 2, 3, 5] if name == "ARC_FEED" else [0, 1, 2]
        assert np.abs(np.array([mine[n] - other[n] * scale for n in lengths])).max() <= 1e-4 * scale
        assert name != "ARC_FEED" or mine[4] == other[4]
    return len(ours)


def test_rs274_moves_as_we_mean(tmp_path):
    assert compare(program_1(), tmp_path) == 18


def test_rs274_moves_as_we_mean_in_inches(tmp_path):
    assert compare(program_1(), tmp_path, units="inch") == 18


def test_rs274_takes_each_tool_with_its_length(tmp_path):
    calls = run(LinuxCncDialect().write([program_1()], HEADER, PostSettings()), tmp_path)
    changes = [int(numbers[0]) for _, name, numbers in calls if name == "SELECT_TOOL"]
    lengths = [numbers[2] for _, name, numbers in calls if name == "USE_TOOL_LENGTH_OFFSET" and any(numbers)]
    assert changes == [1, 7]
    assert lengths == [140.5, 140.5, 120.25]


def test_rs274_turns_the_spindle_as_we_mean(tmp_path):
    calls = run(LinuxCncDialect().write([program_1()], HEADER, PostSettings()), tmp_path)
    assert [numbers[-1] for _, name, numbers in calls if name == "SET_SPINDLE_SPEED"] == [12000.0, 14000.0, 18000.0]
    assert sum(name == "START_SPINDLE_CLOCKWISE" for _, name, _ in calls) == 3


def test_rs274_feeds_as_we_mean(tmp_path):
    calls = run(LinuxCncDialect().write([program_1()], HEADER, PostSettings()), tmp_path)
    feeds = [numbers[-1] for _, name, numbers in calls if name == "SET_FEED_RATE" and numbers[-1] > 0.0]
    assert feeds == [300.0, 600.0, 1200.0, 900.5, 800.0, 800.0]


def test_rs274_takes_random_arcs_lines_and_helices(tmp_path):
    rng, at, blocks = np.random.default_rng(11), np.array([0.0, 0.0, 0.0]), [(RAPID, 0, 0, 50), (LINE, 0, 0, 0, 500)]
    for _ in range(3000):
        kind = rng.integers(0, 4)
        if kind < 2:
            at = at + rng.normal(size=3) * 10.0 ** rng.uniform(-4, 2)
            blocks.append(((RAPID, LINE)[kind], *at) + (() if kind == 0 else (rng.uniform(1, 9000),)))
            continue
        radius, first, turn = 10.0 ** rng.uniform(-1, 3), rng.uniform(0, 2 * np.pi), rng.choice([1e-7, 1e-3, 1.0, 3.0, 6.0, 2 * np.pi])
        sign = 1.0 if kind == 3 else -1.0
        centre = at[:2] - radius * np.array([math.cos(first), math.sin(first)])
        end = centre + radius * np.array([math.cos(first + sign * turn), math.sin(first + sign * turn)])
        at = np.array([*(at[:2] if turn == 2 * np.pi else end), at[2] + rng.choice([0.0, -1.0])])
        blocks.append((CCW if kind == 3 else CW, *at, *centre, rng.uniform(1, 9000)))
    program = Program(name="B1.S1", setup=S1, sections=(section("random", FLAT_16, path_of(*blocks, (RAPID, *at[:2], 50.0))),))
    assert compare(program, tmp_path) > 2800
