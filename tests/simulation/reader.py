"""A small reader of G code (RS274/NGC) for upright cutters: what it doesn't know it refuses.

Arcs and helices come as chords, so that everything later is a straight move.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

SAGITTA = 1e-3
"""mm: how far a chord may be from its arc."""
TOP = 1000.0
"""mm: how high the tip stands where the spindle is at its highest place."""
INCH = 25.4
PLAIN = {17.0, 40.0, 49.0, 54.0, 64.0, 80.0, 90.0, 91.1, 94.0}
"""Codes that ask for what is assumed here: the plane XY, no radius compensation, absolute positions, centres from an arc's start."""
MOTIONS = {0.0, 1.0, 2.0, 3.0}
OFFS = {3.0, 5.0, 6.0, 8.0, 9.0, 30.0}
"""M codes that don't move a cutter."""
COMMENT = re.compile(r"\(([^)]*)\)")
WORD = re.compile(r"([A-Z])\s*([-+]?\d*\.?\d*)")


@dataclass(frozen=True, slots=True, eq=False)
class Travel:
    """Straight moves n of the tip in the setup frame, mm.

    start, end (n, 3); rapid (n,); tool (n,) the number of the tool in the spindle; line (n,) of the text, from 1; operation (n,) names.
    """

    start: np.ndarray
    end: np.ndarray
    rapid: np.ndarray
    tool: np.ndarray
    line: np.ndarray
    operation: Sequence[str]


@dataclass(slots=True)
class _Control:
    """What a control remembers from line to line."""

    lengths: Mapping[int, float]
    at: tuple[float, float, float] = (0.0, 0.0, TOP)
    motion: float = 0.0
    scale: float = 1.0
    tool: int = 0
    offset: int = 0
    operation: str = ""
    rows: list[tuple[float, ...]] = field(default_factory=list)
    names: list[str] = field(default_factory=list)

    def lift(self) -> float:
        """Return how much higher the tip is than the control believes: the length it counts with less that of the tool in the spindle."""
        return self.lengths.get(self.offset, 0.0) - self.lengths.get(self.tool, 0.0)


def travel(text: str, lengths: Mapping[int, float]) -> Travel:
    """Return the moves of a program; `lengths` are the tools' gauge lengths (mm) by number. Raises ValueError at what isn't understood."""
    control = _Control(lengths)
    for number, line in enumerate(text.splitlines(), 1):
        for comment in COMMENT.findall(line):
            if comment.startswith("OPERATION "):
                control.operation = comment.removeprefix("OPERATION ")
        try:
            _run(control, _words(COMMENT.sub("", line)), number)
        except ValueError as reason:
            raise ValueError(f"line {number}: {line}: {reason}") from None
    rows = np.array(control.rows).reshape(-1, 9)
    return Travel(
        rows[:, 0:3],
        rows[:, 3:6],
        rows[:, 6] > 0.0,
        rows[:, 7].astype(np.int64),
        rows[:, 8].astype(np.int64),
        control.names,
    )


def _words(line: str) -> dict[str, list[float]]:
    found: dict[str, list[float]] = {}
    for piece in line.split():
        match = WORD.fullmatch(piece)
        if match is None or not match[2]:
            raise ValueError(f"{piece} is no word")
        found.setdefault(match[1], []).append(float(match[2]))
    return found


def _run(control: _Control, words: dict[str, list[float]], number: int) -> None:
    if unknown := set(words) - set("NGMTHSFPXYZIJ"):
        raise ValueError(f"{''.join(sorted(unknown))} isn't known")
    machine = _modes(control, words)
    if any(letter in words for letter in "XYZ") or "I" in words:
        end = _end(control, words)
        if machine:
            if words.get("Z") != [0.0] or "X" in words or "Y" in words:
                raise ValueError("only G53 Z0 is known")
            end = (control.at[0], control.at[1], TOP)
        _move(control, end, words, number, machine)


def _modes(control: _Control, words: dict[str, list[float]]) -> bool:
    """Take up the codes of a line and return whether its positions are the machine's."""
    codes = words.get("G", [])
    if unknown := set(codes) - PLAIN - MOTIONS - {20.0, 21.0, 43.0, 53.0}:
        raise ValueError(f"G{unknown} isn't known")
    if unknown := set(words.get("M", [])) - OFFS:
        raise ValueError(f"M{unknown} isn't known")
    for code in codes:
        control.motion = code if code in MOTIONS else control.motion
        control.scale = {20.0: INCH, 21.0: 1.0}.get(code, control.scale)
    if "T" in words:
        control.tool = int(words["T"][0])
    if 49.0 in codes:
        control.offset = 0
    if 43.0 in codes:
        control.offset = int(words["H"][0])
    return 53.0 in codes


def _end(control: _Control, words: dict[str, list[float]]) -> tuple[float, float, float]:
    lift = control.lift()
    shifts = (0.0, 0.0, lift)
    x, y, z = (
        words[letter][0] * control.scale + shift if letter in words else at
        for letter, at, shift in zip("XYZ", control.at, shifts, strict=True)
    )
    return x, y, z


def _move(
    control: _Control,
    end: tuple[float, float, float],
    words: dict[str, list[float]],
    number: int,
    machine: bool,
) -> None:
    motion = 0.0 if machine else control.motion
    points = [end]
    if motion >= 2.0:
        centre = tuple(
            at + words.get(letter, [0.0])[0] * control.scale
            for at, letter in zip(control.at, "IJ", strict=False)
        )
        points = list(chords(control.at, end, (centre[0], centre[1]), motion == 3.0))
    for point in points:
        control.rows.append(
            (*control.at, *point, float(motion == 0.0), float(control.tool), float(number))
        )
        control.names.append(control.operation)
        control.at = point


def chords(
    start: tuple[float, float, float],
    end: tuple[float, float, float],
    centre: tuple[float, float],
    anticlockwise: bool,
) -> Iterator[tuple[float, float, float]]:
    """Give the ends of an arc's or helix's chords; one that ends where it begins is a whole turn. Raises ValueError at unlike radii."""
    radius = math.hypot(start[0] - centre[0], start[1] - centre[1])
    last = math.hypot(end[0] - centre[0], end[1] - centre[1])
    if radius <= 0.0 or abs(radius - last) > 0.01:
        raise ValueError(f"radii of an arc are {radius} and {last}")
    begins = math.atan2(start[1] - centre[1], start[0] - centre[0])
    ends = math.atan2(end[1] - centre[1], end[0] - centre[0])
    sweep = (
        (ends - begins) % (2.0 * math.pi) if anticlockwise else (begins - ends) % (2.0 * math.pi)
    )
    if math.dist(start[:2], end[:2]) < 1e-6:
        sweep = 2.0 * math.pi
    count = max(math.ceil(sweep / (2.0 * math.acos(max(1.0 - SAGITTA / radius, 0.0)))), 1)
    for k in range(1, count):
        share = k / count
        angle = begins + (share if anticlockwise else -share) * sweep
        r = radius + share * (last - radius)
        yield (
            centre[0] + r * math.cos(angle),
            centre[1] + r * math.sin(angle),
            start[2] + share * (end[2] - start[2]),
        )
    yield end
