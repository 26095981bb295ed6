"""Directions spread evenly over the sphere, and which of them are near each other: what a tool axis may be chosen from."""

from __future__ import annotations

import numpy as np

from trunnion.geometry.arrays import Floats, Ints
from trunnion.tolerance import ANGLE

_GOLDEN = 0.5 * (1.0 + 5.0**0.5)


def directions(halvings: int) -> tuple[Floats, Ints]:
    """Return unit directions (m, 3) and the two parents (m, 2) of each, rows of earlier ones.

    The corners of an icosahedron (their own parents), and the middles of all edges after each halving: 12, 42, 162, 642 directions, about
    63, 34, 18, 9 degrees apart.
    """
    g = _GOLDEN
    point = np.array(
        [
            [0, 1, g],
            [0, -1, g],
            [0, 1, -g],
            [0, -1, -g],
            [1, g, 0],
            [-1, g, 0],
            [1, -g, 0],
            [-1, -g, 0],
            [g, 0, 1],
            [g, 0, -1],
            [-g, 0, 1],
            [-g, 0, -1],
        ],
        dtype=np.float64,
    ) / np.sqrt(1.0 + g * g)
    parents = np.repeat(np.arange(12)[:, None], 2, axis=1)
    away = np.linalg.norm(point[:, None] - point[None], axis=2)
    near = (away > 0.0) & (away < 1.1)
    faces = np.array(
        [
            (a, b, c)
            for a in range(12)
            for b in range(a + 1, 12)
            for c in range(b + 1, 12)
            if near[a, b] and near[b, c] and near[a, c]
        ]
    )
    for _ in range(halvings):
        edges = np.sort(
            np.stack([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]], axis=1), axis=2
        )
        unique, row = np.unique(edges.reshape(-1, 2), axis=0, return_inverse=True)
        middle = point[unique].sum(axis=1)
        new = row.reshape(-1, 3) + len(point)
        point = np.vstack([point, middle / np.linalg.norm(middle, axis=1, keepdims=True)])
        parents = np.vstack([parents, unique])
        faces = np.vstack(
            [
                np.column_stack([faces[:, 0], new[:, 0], new[:, 2]]),
                np.column_stack([faces[:, 1], new[:, 1], new[:, 0]]),
                np.column_stack([faces[:, 2], new[:, 2], new[:, 1]]),
                new,
            ]
        )
    return point, parents


def neighbours(point: Floats, reach: float) -> tuple[Ints, Floats]:
    """Return which directions (m, 3) are within an angle (rad) of each, and how far: rows (m, q), filled up with -1, and angles (m, q)."""
    angle = np.arccos(np.clip(point @ point.T, -1.0, 1.0))
    np.fill_diagonal(angle, 0.0)
    count = (angle <= reach).sum(axis=1)
    rows = np.argsort(angle, axis=1, kind="stable")[:, : count.max(initial=1)]
    near = np.take_along_axis(angle, rows, axis=1)
    inside = np.arange(rows.shape[1]) < count[:, None]
    return np.where(inside, rows, -1), np.where(inside, near, 0.0)


def angle_between(a: Floats, b: Floats) -> Floats:
    """Return the angle (k,) rad between unit directions (k, 3); exact for small ones too."""
    return np.asarray(
        2.0 * np.arctan2(np.linalg.norm(a - b, axis=-1), np.linalg.norm(a + b, axis=-1))
    )


def on_axis(direction: Floats) -> Floats:
    """Return a unit direction (3,), just that of a coordinate axis where it is along one within the tolerance of angles."""
    along = int(np.argmax(np.abs(direction)))
    if abs(float(direction[along])) > np.cos(ANGLE):
        return np.asarray(np.sign(direction[along]) * np.eye(3)[along])
    return direction
