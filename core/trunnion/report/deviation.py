"""The deviation map: how far every position of the finished part is from the part as drawn, as triangles with a value at each corner.

The proof measures at samples. Faces on which they differ are divided until no edge is longer than the samples there are apart, all of them
less finely where that would take too many triangles. A corner has the value of its nearest sample, and a sample outside the tolerance
passes its value to the corners around it, so that no gouge falls between.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.mesh import Mesh
from trunnion.model.verdict import Deviation
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.tolerance import COINCIDENT

RANGE = 2.5
"""Where the colours end, in tolerances."""
EVEN = 1e-3
"""mm: a face whose samples differ by less has one colour anyway."""
MOST_POINTS = 60
MOST_TRIANGLES = 1_000_000
"""Of a map, about: more than a picture can show, or a window turn smoothly."""
_ROUNDS = 14
_APART = 1e5
"""mm added between two faces in a search for neighbours, so that none is found on another face."""


@dataclass(frozen=True, slots=True, kw_only=True)
class WorstPoint:
    """Where a face deviates most: its tag, the point in the part's coordinates, mm (+ material left, - gouge)."""

    face: int
    point: tuple[float, float, float]
    deviation: float


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class DeviationMap:
    """A map to be drawn: points (v, 3), triangles (t, 3) with the tag of their face (t,), and the deviation at each point (v,) mm.

    Between `low` and `high` mm the part is finished; colours end at `-limit` and `limit`. worst: gouges first, the deepest first, then what
    is left, the most first.
    """

    points: Floats
    triangles: Ints
    face: Ints
    value: Floats
    low: float
    high: float
    limit: float
    worst: tuple[WorstPoint, ...] = ()


def deviation_map(
    mesh: Mesh,
    deviation: Deviation,
    tolerance: float,
    allowance: float = 0.0,
    progress: Progress = NO_PROGRESS,
) -> DeviationMap:
    """Return the map of a part's mesh; faces without a sample count as finished."""
    low, high, limit = -tolerance, tolerance + allowance, RANGE * tolerance + allowance
    return progress.aside(
        lambda own: _deviation_map(mesh, deviation, low, high, limit, own),
        "spreading the deviation over the faces",
    )


def _deviation_map(
    mesh: Mesh, deviation: Deviation, low: float, high: float, limit: float, progress: Progress
) -> DeviationMap:
    uneven, nearest = uneven_faces(deviation, int(mesh.face.max(initial=0)))
    apart = np.maximum(nearest, spacing_by_area(mesh, deviation, len(uneven)))
    points, triangles, face = divided(mesh, uneven, apart, progress)
    progress.check()
    value = values_at(points, triangles, face, deviation, low, high)
    progress.check()
    return DeviationMap(
        points=points,
        triangles=triangles,
        face=face,
        value=value,
        low=low,
        high=high,
        limit=limit,
        worst=worst_points(deviation, low, high),
    )


def uneven_faces(deviation: Deviation, last: int) -> tuple[Bools, float]:
    """Return by tag whether a face's samples differ (last + 1,), and about how far apart samples are in mm."""
    n = last + 1
    least, most = np.full(n, np.inf), np.full(n, -np.inf)
    np.minimum.at(least, deviation.face, deviation.deviation)
    np.maximum.at(most, deviation.face, deviation.deviation)
    count = np.bincount(deviation.face, minlength=n)
    uneven = np.zeros(n, bool)
    uneven[count > 0] = (most - least)[count > 0] > EVEN
    return uneven, _spacing(deviation)


def _spacing(deviation: Deviation) -> float:
    if len(deviation.face) < 2:
        return np.inf
    from scipy.spatial import cKDTree

    some = deviation.point[:: max(1, len(deviation.point) // 2000)]
    near, _ = cKDTree(deviation.point).query(some, k=2)
    return float(np.quantile(np.asarray(near)[:, 1], 0.9))


def spacing_by_area(mesh: Mesh, deviation: Deviation, n: int) -> Floats:
    """Return by tag (n,) how far apart a face's samples are in mm if they are spread evenly over it: those on the facets of a round face
    lie in rows of slivers, where the nearest one says nothing. 0 without samples."""
    corners = np.asarray(mesh.points)[np.asarray(mesh.triangles)]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = np.bincount(mesh.face, 0.5 * np.linalg.norm(normal, axis=1), n)
    count = np.bincount(deviation.face, minlength=n)[:n]
    return np.sqrt(np.divide(area[:n], count, out=np.zeros(n), where=count > 0))


def divided(
    mesh: Mesh, uneven: Bools, apart: Floats | float, progress: Progress = NO_PROGRESS
) -> tuple[Floats, Ints, Ints]:
    """Return points, triangles and faces of a mesh whose chosen faces have no edge longer than `apart` mm; both are by tag."""
    apart = np.broadcast_to(apart, uneven.shape)
    points, triangles, face = (
        np.asarray(mesh.points),
        np.asarray(mesh.triangles),
        np.asarray(mesh.face),
    )
    fine = uneven[face]
    kept, kept_face = triangles[~fine], face[~fine]
    triangles, face = triangles[fine], face[fine]
    apart = apart * _coarser(points[triangles], apart[face])
    for _ in progress.each(range(_ROUNDS)):
        points, triangles, face, is_done = _halved(points, triangles, face, apart[face])
        if is_done:
            break
    return points, np.concatenate([kept, triangles]), np.concatenate([kept_face, face])


def _coarser(corners: Floats, apart: Floats) -> float:
    """Return how many times longer edges must be allowed than wanted (t,), that triangles with corners (t, 3, 3) become at most about
    `MOST_TRIANGLES`: long slivers along a round face become hundreds each."""
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1, initial=0.0)
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    height = np.linalg.norm(normal, axis=1) / np.maximum(longest, COINCIDENT)
    # Halving all of its sides makes four of a triangle; of a sliver the two long ones, which makes three.
    times = 1.0
    while (longest > times * apart).any():
        along, across = (_halvings(size, times * apart) for size in (longest, height))
        if float((3.0 ** (along - across) * 4.0**across).sum()) <= MOST_TRIANGLES:
            break
        times *= 2.0
    return times


def _halvings(size: Floats, apart: Floats) -> Floats:
    """Return how often lengths (t,) are halved until none is longer than `apart` (t,)."""
    return np.asarray(np.ceil(np.log2(np.maximum(size, apart) / np.maximum(apart, COINCIDENT))))


def _halved(
    points: Floats, triangles: Ints, face: Ints, apart: Floats
) -> tuple[Floats, Ints, Ints, bool]:
    """Split every edge that is too long for a triangle (t,) beside it at its middle, once; both triangles split it alike."""
    sides = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]], axis=2)
    keys, inverse = np.unique(
        sides.reshape(-1, 2)[:, 0] * len(points) + sides.reshape(-1, 2)[:, 1], return_inverse=True
    )
    a, b = np.divmod(keys, len(points))
    allowed = np.full(len(keys), np.inf)
    np.minimum.at(allowed, inverse.ravel(), np.repeat(apart, 3))
    long = np.linalg.norm(points[a] - points[b], axis=1) > allowed
    if not long.any():
        return points, triangles, face, True
    middle = np.full(len(keys), -1)
    middle[long] = len(points) + np.arange(int(long.sum()))
    points = np.vstack([points, 0.5 * (points[a[long]] + points[b[long]])])
    m = middle[inverse].reshape(-1, 3)
    made, faces = [triangles[(m < 0).all(axis=1)]], [face[(m < 0).all(axis=1)]]
    for turn in range(3):
        t, n = np.roll(triangles, -turn, axis=1), np.roll(m, -turn, axis=1)
        split = n >= 0
        one = split[:, 0] & ~split[:, 1] & ~split[:, 2]
        two = split[:, 0] & split[:, 1] & ~split[:, 2]
        made += [
            np.column_stack([t[one, 0], n[one, 0], t[one, 2]]),
            np.column_stack([n[one, 0], t[one, 1], t[one, 2]]),
            np.column_stack([n[two, 0], t[two, 1], n[two, 1]]),
            np.column_stack([t[two, 0], n[two, 0], n[two, 1]]),
            np.column_stack([t[two, 0], n[two, 1], t[two, 2]]),
        ]
        faces += [face[one]] * 2 + [face[two]] * 3
    three = (m >= 0).all(axis=1)
    t, n = triangles[three], m[three]
    made += [np.column_stack([t[:, k], n[:, k], n[:, k - 1]]) for k in range(3)] + [n]
    faces += [face[three]] * 4
    return points, np.concatenate(made), np.concatenate(faces), False


def values_at(
    points: Floats, triangles: Ints, face: Ints, deviation: Deviation, low: float, high: float
) -> Floats:
    """Return the deviation at every point (v,) of a divided mesh."""
    value = np.zeros(len(points))
    if not len(deviation.face):
        return value
    from scipy.spatial import cKDTree

    owner = np.zeros(len(points), np.int64)
    owner[triangles.ravel()] = np.repeat(face, 3)
    known = np.isin(owner, deviation.face)
    samples, positions = (
        np.column_stack([p, tags * _APART])
        for p, tags in ((deviation.point, deviation.face), (points, owner))
    )
    _, nearest = cKDTree(samples).query(positions[known])
    value[known] = deviation.deviation[nearest]
    bad = np.flatnonzero((deviation.deviation < low) | (deviation.deviation > high))
    if len(bad):
        around = np.flatnonzero(known)
        _, rows = cKDTree(positions[known]).query(samples[bad], k=min(3, len(around)))
        rows = around[np.asarray(rows).reshape(len(bad), -1)]
        spread = np.repeat(deviation.deviation[bad], rows.shape[1])
        # The gravest last: a gouge is never painted over by what is left beside it.
        order = np.argsort(np.where(spread < 0.0, -spread, 1e-6 * spread), kind="stable")
        target = rows.ravel()[order]
        worse = (np.abs(spread[order]) > np.abs(value[target])) | (spread[order] < low)
        value[target[worse]] = spread[order][worse]
    return value


def worst_points(deviation: Deviation, low: float, high: float) -> tuple[WorstPoint, ...]:
    """Return where each face is gouged deepest and where most is left on it, as far as they are outside `low` to `high`."""
    found: list[WorstPoint] = []
    for sign, bad in ((1.0, deviation.deviation < low), (-1.0, deviation.deviation > high)):
        rows = np.flatnonzero(bad)
        rows = rows[np.lexsort((rows, sign * deviation.deviation[rows]))]
        _, first = np.unique(deviation.face[rows], return_index=True)
        for row in rows[np.sort(first)]:
            x, y, z = (float(v) for v in deviation.point[row])
            found.append(
                WorstPoint(
                    face=int(deviation.face[row]),
                    point=(x, y, z),
                    deviation=float(deviation.deviation[row]),
                )
            )
    return tuple(found[:MOST_POINTS])
