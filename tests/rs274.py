"""LinuxCNC's own interpreter as an independent reader.

`TRUNNION_RS274` is the path of its `rs274`; without it, `.rs274/rs274` in the project or one on the PATH is used.
"""

from __future__ import annotations

import math
import os
import re
import shutil
import subprocess
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest

from parts import ROOT
from trunnion.model.motion.toolpath import Motion
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.post.readers.linuxcnc import read_linuxcnc
from trunnion.post.readers.sections import SectionBlocks

Call = tuple[str, str, list[float]]


def interpreter() -> str | None:
    """Return the path of rs274, or None."""
    beside = ROOT / ".rs274" / "rs274"
    return os.environ.get("TRUNNION_RS274") or (
        str(beside) if beside.is_file() else shutil.which("rs274")
    )


RS274 = interpreter()
needs_rs274 = pytest.mark.skipif(
    RS274 is None,
    reason="LinuxCNC's rs274 is not here: run installer/rs274.sh or set TRUNNION_RS274",
)


def run(text: str, tools: Sequence[Tool], folder: Path) -> list[Call]:
    """Return N word, canonical call and numbers of each line that rs274 prints; its exit code must be 0."""
    assert RS274 is not None
    table = folder / "tools.tbl"
    table.write_text(
        "".join(
            f"T{t.number} P{t.number} Z{t.gauge_length / 25.4:.8f} D{t.cutter_sizes[0] / 25.4:.8f} ;{t.name}\n"
            for t in tools
        )
    )
    (folder / "program.ngc").write_text(text)
    done = subprocess.run(
        [RS274, "-g", "-t", str(table), str(folder / "program.ngc")],
        capture_output=True,
        text=True,
        timeout=60,
        cwd=folder,
        env={**os.environ, "LD_LIBRARY_PATH": str(Path(RS274).resolve().parent)},
    )
    assert done.returncode == 0, done.stderr
    found = [
        re.match(r"\s*\d+ N(\d+|\.+)\s*([A-Z_]+)\((.*)\)", line)
        for line in done.stdout.splitlines()
    ]
    return [
        (m[1], m[2], [float(v) for v in re.findall(r"-?\d+\.\d+|-?\d+", m[3])]) for m in found if m
    ]


def motions_of(text: str, tools: Sequence[Tool], setup: Setup) -> list[Call]:
    """Return the canonical calls that our own reading of a text amounts to, with the N word of each block."""
    lines, calls = text.split("\n"), []
    for part in read_linuxcnc(text, tools, setup).sections:
        path, starts = part.path, part.path.starts()
        for row, line in enumerate(part.block_lines):
            number, (x, y, z), centre = (
                lines[line - 1].split()[0][1:],
                path.position[row],
                path.centre[row],
            )
            if path.motion[row] >= Motion.ARC_CW:
                calls.append(
                    (
                        number,
                        "ARC_FEED",
                        [
                            x,
                            y,
                            centre[0],
                            centre[1],
                            1 if path.motion[row] == Motion.ARC_CCW else -1,
                            z,
                        ],
                    )
                )
                assert math.dist(starts[row][:2], centre[:2]) > 0.0
            else:
                calls.append(
                    (
                        number,
                        "STRAIGHT_TRAVERSE"
                        if path.motion[row] == Motion.RAPID
                        else "STRAIGHT_FEED",
                        [x, y, z],
                    )
                )
    return calls


def compare_joints(
    text: str, rows: Sequence[SectionBlocks], letters: str, tools: Sequence[Tool], folder: Path
) -> int:
    """Return the number of moves after seeing that rs274's positions of all axes equal our reading of a text with rotary axes to 1e-4."""
    lines = text.split("\n")
    lifts = {line.split()[0][1:] for line in lines if "G53" in line}
    ours = [
        (lines[line - 1].split()[0][1:], point, motion)
        for part in rows
        for line, point, motion in zip(part.line, part.point, part.motion, strict=True)
    ]
    theirs: dict[str, tuple[str, list[float]]] = {}
    for number, name, numbers in run(text, tools, folder):
        if name in ("STRAIGHT_TRAVERSE", "STRAIGHT_FEED", "ARC_FEED"):
            theirs[number] = (name, numbers)
    names = {Motion.RAPID: "STRAIGHT_TRAVERSE", Motion.LINE: "STRAIGHT_FEED"}
    compared = 0
    for k, (number, point, motion) in enumerate(ours):
        if (k + 1 < len(ours) and ours[k + 1][0] == number) or number in lifts:
            continue
        name, numbers = theirs[number]
        assert name == names.get(Motion(motion), "ARC_FEED")
        linear = [*numbers[:2], numbers[5]] if name == "ARC_FEED" else numbers[:3]
        found = np.array([*linear, *(numbers[-3:]["ABC".index(letter)] for letter in letters)])
        assert np.abs(found - np.array(point)).max() <= 1e-4
        compared += 1
    return compared


def _going(calls: Sequence[Call]) -> list[Call]:
    """Return moves without rapids that end where the move before them has ended: cycles have some."""
    kept: list[Call] = []
    at: list[float] = []
    for call in calls:
        end = call[2][:3] if call[1] != "ARC_FEED" else [*call[2][:2], call[2][5]]
        if not (
            at and call[1] == "STRAIGHT_TRAVERSE" and np.abs(np.subtract(end, at)).max() < 1e-9
        ):
            kept.append(call)
        at = end
    return kept


def compare(
    text: str, tools: Sequence[Tool], setup: Setup, folder: Path, scale: float = 1.0
) -> int:
    """Return the number of moves after seeing that rs274's canonical moves equal our reading to 1e-4 (`scale`: 25.4 for inches)."""
    ours = motions_of(text, tools, setup)
    numbers = {number for number, _, _ in ours}
    moves = ("STRAIGHT_TRAVERSE", "STRAIGHT_FEED", "ARC_FEED")
    theirs = _going(
        [call for call in run(text, tools, folder) if call[0] in numbers and call[1] in moves]
    )
    read, ours = len(ours), _going(ours)
    assert [call[:2] for call in ours] == [call[:2] for call in theirs]
    for (_, name, mine), (_, _, other) in zip(ours, theirs, strict=True):
        lengths = [0, 1, 2, 3, 5] if name == "ARC_FEED" else [0, 1, 2]
        assert np.abs(np.array([mine[n] - other[n] * scale for n in lengths])).max() <= 1e-4 * scale
        assert name != "ARC_FEED" or mine[4] == other[4]
    return read
