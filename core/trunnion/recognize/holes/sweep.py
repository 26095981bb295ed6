"""How far edges sweep around an axis: the share of a full turn that is there of a circle which other faces have cut."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from trunnion.geometry.arrays import Floats
from trunnion.geometry.facegraph import FaceGraph
from trunnion.geometry.frame import Frame
from trunnion.tolerance import SLIVER

TURN = 2.0 * np.pi


def axis_frame(point: Floats, direction: Floats) -> Frame:
    """Return a frame with its origin on an axis and z along it; angles about the axis are measured in it."""
    return Frame(point, np.eye(3)[int(np.argmin(np.abs(direction)))], direction)


def arcs(graph: FaceGraph, edges: Iterable[int], frame: Frame) -> Floats:
    """Return the arcs (k, 2) that edges sweep about a frame's z: start from 0 to a whole turn, and sweep, both in radians.

    An edge is known by its start, middle and end, and each half sweeps less than half a turn. Of a closed edge the middle lies across the
    axis when it goes around it, for circles, ellipses and the saddle curves of crossing cylinders are symmetric.
    """
    rows = np.array(sorted(set(edges)), dtype=np.int64)
    points = frame.to_local(
        np.stack([graph.start[rows], graph.middle[rows], graph.end[rows]], axis=1)
    )
    off_axis = np.linalg.norm(points[..., :2], axis=2).min(axis=1, initial=np.inf) > SLIVER
    points, rows = points[off_axis], rows[off_axis]
    angle = np.arctan2(points[..., 1], points[..., 0])
    step = (np.diff(angle, axis=1) + np.pi) % TURN - np.pi
    closed = np.linalg.norm(points[:, 2] - points[:, 0], axis=1) < SLIVER
    around = closed & (np.abs(step[:, 0]) > 0.5 * np.pi) & (graph.length[rows] > SLIVER)
    begin = np.where(step < 0.0, angle[:, 1:], angle[:, :-1]) % TURN
    halves = np.stack([begin, np.abs(step)], axis=2)[~around].reshape(-1, 2)
    whole = np.column_stack([angle[around, 0] % TURN, np.full(int(around.sum()), TURN)])
    return np.concatenate([whole, halves])


def swept(around: Floats) -> float:
    """Return how much of a turn (radians) some arcs (k, 2) cover together.

    >>> round(swept(np.array([[0.0, 1.0], [0.5, 1.0], [6.0, 1.0]])), 3)
    1.783
    """
    begin, end = around[:, 0], around[:, 0] + around[:, 1]
    past = end > TURN
    pieces = np.concatenate(
        [
            np.column_stack([begin, np.minimum(end, TURN)]),
            np.column_stack([np.zeros(int(past.sum())), end[past] - TURN]),
        ]
    )
    total, reached = 0.0, 0.0
    for low, high in pieces[np.argsort(pieces[:, 0], kind="stable")]:
        total += max(0.0, float(high) - max(float(low), reached))
        reached = max(reached, float(high))
    return min(total, TURN)


def holds(around: Floats, angle: float) -> bool:
    """Return whether one of some arcs (k, 2) holds an angle (radians)."""
    return bool((((angle - around[:, 0]) % TURN) <= around[:, 1]).any())
