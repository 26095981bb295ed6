"""Toolpaths as lines to be drawn: chords with the kind of their motion, and short strokes that show how the tool stands."""

from __future__ import annotations

import numpy as np

from trunnion.geometry.arrays import Floats, Ints, items_of
from trunnion.model.motion.toolpath import Mark, Motion, Toolpath
from trunnion.model.playback import CHORD_ANGLE, turned_axes

RAPID = "rapid"
MOTIONS = ("cut", "entry", "lead", "link", "retract", RAPID)
"""Kinds of motion by the palette's words: those of the marks in their order, and rapids."""
AXIS = "tool_axis"
"""The palette's word for the strokes that show how the tool stands."""
STROKE_EVERY, STROKE_LENGTH, MOST_STROKES = 0.02, 0.06, 400
"""Distance and length of the strokes as shares of the part's longest side, and how many an operation has at most."""
_UPRIGHT = 1e-6
"""An axis whose x and y are smaller than this stands upright."""


def kinds_of(path: Toolpath) -> Ints:
    """Return for each block (n,) the row of its kind in `MOTIONS`."""
    return np.asarray(
        np.where(path.motion == Motion.RAPID, MOTIONS.index(RAPID), path.mark), dtype=np.int64
    )


def opened(path: Toolpath) -> tuple[Floats, Ints]:
    """Return the points of a path with its arcs opened into chords (k + 1, 3), and the block of each chord (k,); both empty without blocks.

    An arc turns about the tool axis of its block, wherever that points.
    """
    if not len(path):
        return np.zeros((0, 3)), np.zeros(0, np.int64)
    start, sweep = path.starts(), path.sweeps()
    pieces = np.maximum(1, np.ceil(np.abs(sweep) / CHORD_ANGLE)).astype(np.int64)
    pieces[0] = 0
    row, number = items_of(pieces)
    step = number + 1
    share = step / pieces[row]
    points = start[row] + (path.position[row] - start[row]) * share[:, None]
    turned = np.flatnonzero(sweep[row] != 0.0)
    if len(turned):
        rows = row[turned]
        about, angle = path.axis[rows], (sweep[rows] * share[turned])[:, None]
        arm = start[rows] - path.centre[rows]
        arm -= (arm * about).sum(axis=1, keepdims=True) * about
        rise = ((path.position[rows] - start[rows]) * about).sum(axis=1, keepdims=True) * about
        points[turned] = (
            start[rows]
            - arm
            + np.cos(angle) * arm
            + np.sin(angle) * np.cross(about, arm)
            + share[turned, None] * rise
        )
    return np.vstack([path.position[:1], points]), row


def leans(path: Toolpath) -> bool:
    """Return whether a tool that rotates stands other than upright anywhere on a path."""
    return not path.work_turns and bool((np.abs(path.axis[:, :2]) > _UPRIGHT).any())


def strokes(path: Toolpath, every: float, length: float, most: int) -> Floats:
    """Return strokes (k, 2, 3) from the tip along the tool axis at equal distances on the moves at the work of a path that leans anywhere.

    `every` mm between two of them, or more where that would give above `most`; `length` mm. Between two blocks the axis turns evenly.
    """
    if not len(path) or not leans(path):
        return np.zeros((0, 2, 3))
    away = (path.motion == Motion.RAPID) | (path.mark == Mark.RETRACT)
    run = np.where(away, 0.0, np.linalg.norm(path.position - path.starts(), axis=1))
    reached = np.cumsum(run)
    if reached[-1] <= 0.0:
        return np.zeros((0, 2, 3))
    count = int(min(reached[-1] // every + 1, most))
    at = np.linspace(0.0, reached[-1], count + 1)[:-1] + 0.5 * reached[-1] / count
    row = np.searchsorted(reached, at)
    before = np.maximum(row - 1, 0)
    share = 1.0 - (reached[row] - at) / run[row]
    tip = path.position[before] + share[:, None] * (path.position[row] - path.position[before])
    axis = turned_axes(path.axis[before], path.axis[row], share)
    return np.stack([tip, tip + length * axis], axis=1)
