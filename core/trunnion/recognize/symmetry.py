"""Faces that are repeated evenly about an axis, by what doesn't turn with the part: area, position and normals in cylindrical
coordinates."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trunnion.geometry.arrays import Floats, Ints
from trunnion.geometry.facegraph import FaceGraph
from trunnion.recognize.revolution import RevolutionAxis, reach
from trunnion.tolerance import ANGLE
from trunnion.units import radians

LEAST = 5
"""Copies from which on a pattern counts: three or four equal faces stand on many a part that is no wheel."""
SAME_AREA = 0.03
"""Share by which the areas of copies may differ: trimming tolerances of imported blades stay below a hundredth."""
SAME_POSITION = 0.01
"""Distance of the copies' middles in radius and height, over the part's size."""
SAME_NORMAL = 0.05
"""Difference of the copies' mean normals in the directions away from, around and along the axis (unit vectors)."""
SAME_ANGLE = radians(1.5)
"""How far a copy may be from its position around the axis, in radians."""
PRESENT = 0.7
"""Share of the positions around the axis that must be taken: a few copies may be cut into several faces."""
MOST = 120
"""Copies that are looked for at most."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CircularPattern:
    """Equal faces evenly about an axis: the number of positions around it, and the rows (k,) of the faces."""

    count: int
    rows: Ints


def patterns(graph: FaceGraph, axis: RevolutionAxis) -> tuple[CircularPattern, ...]:
    """Return the faces that are repeated evenly about an axis, the largest copies first. Faces without samples are in none."""
    rows, position, angle = _signatures(graph, axis)
    near = SAME_POSITION * reach(graph)
    found = []
    remaining = np.ones(len(rows), dtype=bool)
    for k in np.argsort(-position[:, 0], kind="stable"):
        if remaining[k]:
            allowed = np.array(
                [SAME_AREA * position[k, 0], near, near, SAME_NORMAL, SAME_NORMAL, SAME_NORMAL]
            )
            alike = remaining & (np.abs(position - position[k]) <= allowed).all(axis=1)
            remaining &= ~alike
            count = fold(angle[alike])
            if count:
                found.append(CircularPattern(count=count, rows=rows[alike]))
    return tuple(found)


def fold(angle: Floats) -> int:
    """Return into how many equal turns faces at angles (k,), radians, share a circle, 0 when that is no pattern.

    A turn maps at least `PRESENT` of the faces onto others. Of several numbers that do, the one with the least misfit counts, of equal
    ones the largest.
    """
    best, least = 0, np.inf
    for count in range(min(MOST, int(len(angle) / PRESENT)), LEAST - 1, -1):
        turn = 2.0 * np.pi / count
        apart = np.abs((angle[:, None] + turn - angle + np.pi) % (2.0 * np.pi) - np.pi).min(axis=1)
        near = apart <= min(SAME_ANGLE, 0.1 * turn)
        if len(angle) >= LEAST and near.mean() >= PRESENT and apart[near].mean() < least - ANGLE:
            best, least = count, float(apart[near].mean())
    return best


def _signatures(graph: FaceGraph, axis: RevolutionAxis) -> tuple[Ints, Floats, Floats]:
    """Return the rows (k,) of the faces with samples, what copies have in common (k, 6), and their angles about the axis (k,).

    In common: area; radius and height of the middle; the mean normal away from, around and along the axis.
    """
    of = graph.sample_face
    number = np.bincount(of, minlength=len(graph)).astype(np.float64)
    rows = np.flatnonzero(number > 0.0)
    out = axis.away(graph.sample_point)
    out /= np.maximum(np.linalg.norm(out, axis=1), 1e-12)[:, None]
    around = np.cross(axis.direction, out)
    normal = [
        np.einsum("ij,ij->i", graph.sample_normal, direction) for direction in (out, around)
    ] + [graph.sample_normal @ axis.direction]
    middle = (
        np.column_stack([np.bincount(of, graph.sample_point[:, k], len(graph)) for k in range(3)])[
            rows
        ]
        / number[rows, None]
    )
    means = [np.bincount(of, n, len(graph))[rows] / number[rows] for n in normal]
    away = axis.away(middle)
    position = np.column_stack(
        [graph.area[rows], np.linalg.norm(away, axis=1), axis.height(middle), *means]
    )
    x = np.eye(3)[int(np.argmin(np.abs(axis.direction)))]
    x = x - (x @ axis.direction) * axis.direction
    x = x / np.linalg.norm(x)
    return rows, position, np.arctan2(away @ np.cross(axis.direction, x), away @ x)
