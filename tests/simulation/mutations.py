"""Faults planted in the text of a program: what a slip in a post, a wrong number at the machine, or a bad plan would look like."""

from __future__ import annotations

import math
import re

import numpy as np

from simulation.reader import COMMENT, travel

OTHER_WAY = {"G2": "G3", "G3": "G2"}


def deepened(text: str, operation: str, by: float) -> str:
    """Return a text in which the last Z word of an operation that goes to its lowest place goes lower by so many mm."""
    lines = text.split("\n")
    words = [
        (float(match[1]), row)
        for row in rows_of(lines, operation)
        if (match := re.search(r"\bZ(-?\d*\.?\d+)", lines[row])) and "G53" not in lines[row]
    ]
    z, row = min(words, key=lambda word: (word[0], -word[1]))
    lines[row] = re.sub(r"\bZ-?\d*\.?\d+", f"Z{z - by:.4f}", lines[row])
    return "\n".join(lines)


def dived(text: str, operation: str, by: float) -> str:
    """Return a text in which the rapid that comes down to an operation's first cut comes lower by so many mm."""
    lines = text.split("\n")
    row = next(
        row
        for row in rows_of(lines, operation)
        if re.fullmatch(r"N\d+ (G0 )?Z-?[\d.]+", lines[row])
    )
    z = float(lines[row].rpartition("Z")[2])
    lines[row] = lines[row].rpartition("Z")[0] + f"Z{z - by:.4f}"
    return "\n".join(lines)


def swapped(text: str, operation: str, tool: int) -> str:
    """Return a text in which an operation takes another tool, and its length."""
    lines = text.split("\n")
    for row in rows_of(lines, operation):
        lines[row] = re.sub(r"\bT\d+", f"T{tool}", lines[row])
        lines[row] = re.sub(r"\bH\d+", f"H{tool}", lines[row])
    return "\n".join(lines)


def turned_back(text: str, operation: str) -> str:
    """Return a text in which the arc of an operation that runs farthest when it is turned runs the other way."""
    lines = text.split("\n")
    arcs = arc_directions(lines)
    moves = travel(text, {})
    way = np.linalg.norm(moves.end - moves.start, axis=1)
    rest = {
        row: 2.0 * math.pi * _radius(lines[row]) - way[moves.line == row + 1].sum()
        for row in rows_of(lines, operation)
        if arcs[row]
    }
    row = max(rest, key=lambda r: rest[r])
    number, _, words = re.sub(r"\bG[23] ", "", lines[row]).partition(" ")
    lines[row] = f"{number} {OTHER_WAY[arcs[row]]} {words}"
    if row + 1 < len(lines) and re.fullmatch(r"N\d+ [XYZ].*", lines[row + 1]):
        number, _, words = lines[row + 1].partition(" ")
        lines[row + 1] = f"{number} {arcs[row]} {words}"
    return "\n".join(lines)


def _radius(line: str) -> float:
    """Return the radius that the centre words of a line say."""
    return math.hypot(*(float(word) for word in re.findall(r"\b[IJ](-?[\d.]+)", line)))


def arc_directions(lines: list[str]) -> list[str]:
    """Return by row the word of the arc that it runs, empty where it is none."""
    found, motion = [], ""
    for line in lines:
        for code in re.findall(r"\bG([0123])\b", line):
            motion = f"G{code}"
        found.append(motion if motion in OTHER_WAY and re.search(r"\b[IJ]-?[\d.]", line) else "")
    return found


def rows_of(lines: list[str], operation: str) -> list[int]:
    """Return the rows of an operation's section."""
    found, inside = [], False
    for row, line in enumerate(lines):
        comments = COMMENT.findall(line)
        if any(comment.startswith("OPERATION ") for comment in comments):
            inside = f"OPERATION {operation}" in comments
        if inside:
            found.append(row)
    return found
