"""Triangles of a sheet split until a field over them is fine enough: edges halved, short ones collapsed, obtuse ones flipped."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from trunnion.findings import Refused
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.sheet.edge_collapses import collapsed
from trunnion.geometry.sheet.edge_flips import flipped
from trunnion.geometry.sheet.sheet import Measure, Sheet, between, edges_of
from trunnion.progress import NO_PROGRESS, Progress

MOST_TRIANGLES = 2_000_000
"""Triangles of a sheet at most: half a gigabyte of working room."""
ROUNDS = 400
"""Rounds of splitting at most; each one halves the longest edges of all triangles."""
COLLAPSED = 6
"""Of the falling limits the last ones, at which short edges are collapsed: what slivers of the faces' own triangles leave."""
LONG = 1.4
"""Of such a limit: how long edges become by collapses; the diagonals of a row of points would else keep all of them. What is too
long is split after."""


def split_finely(
    sheet: Sheet,
    measure: Measure,
    longest: float,
    progress: Progress = NO_PROGRESS,
    *,
    evenly: bool = False,
) -> Sheet:
    """Return the sheet with triangles split until hardly an edge measures more than `longest`.

    The limit falls by halves; at each one edges are flipped in their pairs of triangles where that makes these less obtuse, since a
    field is as good as its triangles. Long slivers leave rows of points much closer than the limit: `evenly` collapses short edges, for
    sheets that only carry a field; where the triangles go on to stand for the faces, all points stay. Raises `Refused` when too many
    triangles would be needed.
    """
    points, normals, triangles, face = sheet.points, sheet.normals, sheet.triangles, sheet.face
    ends = edges_of(triangles, len(points))[0] if len(triangles) else np.zeros((0, 2), np.int64)
    size = measure(points[ends[:, 0]], normals[ends[:, 0]], points[ends[:, 1]], normals[ends[:, 1]])
    stages = max(math.ceil(math.log2(size.max(initial=longest) / longest)), 0)
    for stage in range(stages, -1, -1):
        limit = longest * 2.0**stage
        points, normals, triangles, face = _split(
            points, normals, triangles, face, measure, limit, progress
        )
        if evenly and stage < COLLAPSED:
            triangles, face = collapsed(
                points, normals, triangles, face, measure, limit, LONG * limit, progress
            )
        triangles = flipped(points, normals, triangles, face, measure, progress)
    if evenly:
        points, normals, triangles, face = _split(
            points, normals, triangles, face, measure, longest, progress
        )
    whole = Sheet(points=points, normals=normals, triangles=triangles, face=face)
    return whole.of(np.ones(len(triangles), dtype=bool))


def split_where(
    sheet: Sheet,
    wanted: Callable[[Floats, Floats], Bools],
    longest: float,
    progress: Progress = NO_PROGRESS,
) -> Sheet:
    """Return the sheet with edges halved until hardly one that is `wanted` is longer than `longest`, and others that have to be for it.

    `wanted` says of edges, given by their middles (k, 3) and lengths (k,), which are meant (k,). As with `split_finely` the limit falls by
    halves, and edges are flipped at each one. Raises `Refused` when too many triangles would be needed.
    """
    a, b = sheet.points[sheet.edges()[0]].transpose(1, 0, 2)
    most = float(np.linalg.norm(b - a, axis=1).max(initial=longest))
    for stage in range(math.ceil(math.log2(most / longest)), -1, -1):
        sheet = _split_where(sheet, wanted, longest * 2.0**stage, progress)
        flips = flipped(sheet.points, sheet.normals, sheet.triangles, sheet.face, in_mm, progress)
        sheet = replace(sheet, triangles=flips)
    return sheet


def in_mm(a: Floats, _a_normal: Floats, b: Floats, _b_normal: Floats) -> Floats:
    """Return the lengths (k,) in mm of edges from points a to b (k, 3): the plain measure."""
    return np.asarray(np.linalg.norm(b - a, axis=1))


def _split_where(
    sheet: Sheet,
    wanted: Callable[[Floats, Floats], Bools],
    longest: float,
    progress: Progress,
) -> Sheet:
    """Return the sheet with wanted edges halved until none is longer than that, round after round.

    Triangles are halved across their longest side, and neighbours go on to share theirs: before a side that isn't a triangle's longest the
    longest is halved, and so on from triangle to triangle (Rivara's longest-edge propagation path).
    """
    points, normals, triangles, face = sheet.points, sheet.normals, sheet.triangles, sheet.face
    for _ in range(ROUNDS):
        progress.check()
        ends, side = edges_of(triangles, len(points))
        a, b = ends.T
        size = in_mm(points[a], normals[a], points[b], normals[b])
        long = np.flatnonzero(size > longest)
        halved = np.zeros(len(ends), dtype=bool)
        halved[long] = wanted(0.5 * (points[a[long]] + points[b[long]]), size[long])
        if not halved.any():
            break
        corner = _longest(size, side)
        widest = side[np.arange(len(side)), corner]
        while not halved[needed := widest[halved[side].any(axis=1)]].all():
            halved[needed] = True
        # A side that is the longest of all its triangles is halved now, others in a later round.
        halved &= np.bincount(widest, minlength=len(ends)) == np.bincount(
            side.ravel(), minlength=len(ends)
        )
        rows = np.flatnonzero(halved)
        number = np.full(len(ends), -1)
        number[rows] = len(points) + np.arange(len(rows))
        a, b = a[rows], b[rows]
        more = between(points[a], normals[a], points[b], normals[b], np.full(len(rows), 0.5))
        points, normals = np.vstack([points, more[0]]), np.vstack([normals, more[1]])
        triangles, face = _halved(triangles, face, corner, number[widest])
        _refuse_too_many(len(triangles))
    return Sheet(points=points, normals=normals, triangles=triangles, face=face)


def _longest(size: Floats, side: Ints) -> Ints:
    """Return which sides (t,) of triangles with edges (t, 3) are their longest by the edges' sizes (e,), of equal ones the last edge."""
    of = size[side]
    return np.asarray(np.argmax(np.where(of == of.max(axis=1)[:, None], side, -1), axis=1))


def _refuse_too_many(count: int) -> None:
    if count > MOST_TRIANGLES:
        raise Refused(
            f"passes this narrow over so large an area need over {MOST_TRIANGLES} triangles: allow a higher scallop, or cut "
            "the area in pieces"
        )


def _split(
    points: Floats,
    normals: Floats,
    triangles: Ints,
    face: Ints,
    measure: Measure,
    longest: float,
    progress: Progress,
) -> tuple[Floats, Floats, Ints, Ints]:
    """Return points, normals, triangles and faces with edges halved that are too long and the longest of all their triangles, round after
    round (Rivara): no triangle gets much thinner than those it was made of."""
    whole, tags = [], []
    for _ in range(ROUNDS):
        progress.check()
        ends, side = edges_of(triangles, len(points))
        size = measure(
            points[ends[:, 0]], normals[ends[:, 0]], points[ends[:, 1]], normals[ends[:, 1]]
        )
        corner = _longest(size, side)
        widest = side[np.arange(len(side)), corner]
        done = size[widest] <= longest
        whole.append(triangles[done])
        tags.append(face[done])
        triangles, face, corner, widest, side = (
            triangles[~done],
            face[~done],
            corner[~done],
            widest[~done],
            side[~done],
        )
        if not len(triangles):
            break
        agreed = np.bincount(widest, minlength=len(ends)) == np.bincount(
            side.ravel(), minlength=len(ends)
        )
        halved = np.flatnonzero(agreed & (size > longest))
        number = np.full(len(ends), -1)
        number[halved] = len(points) + np.arange(len(halved))
        a, b = ends[halved].T
        more = between(points[a], normals[a], points[b], normals[b], np.full(len(halved), 0.5))
        points, normals = np.vstack([points, more[0]]), np.vstack([normals, more[1]])
        triangles, face = _halved(triangles, face, corner, number[widest])
        _refuse_too_many(len(triangles) + sum(len(w) for w in whole))
    return points, normals, np.vstack([*whole, triangles]), np.concatenate([*tags, face])


def _halved(triangles: Ints, face: Ints, corner: Ints, middle: Ints) -> tuple[Ints, Ints]:
    """Return triangles with those halved whose side that begins at `corner` (t,) gets a middle (t,), -1: none."""
    rows = np.flatnonzero(middle >= 0)
    a, b, c = (triangles[rows, (corner[rows] + k) % 3] for k in range(3))
    kept = middle < 0
    first, second = np.column_stack([a, middle[rows], c]), np.column_stack([middle[rows], b, c])
    return np.vstack([triangles[kept], first, second]), np.concatenate(
        [face[kept], face[rows], face[rows]]
    )
