"""Compiled search for a pose that is clear: tools that stand still, against triangles and against places that were in their way before.

Most poses of a place that is hard to reach are stopped by the same few obstacles. What stopped a tool there is remembered, and looked up
before the triangles are: a point of the part that is deep in the tool needs no search.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.verify.kernels.body import CLOSED_FIRST, CLOSED_LAST, KIND, R_MAX, Z_HIGH, Z_LOW, depth_in_body
from trunnion.verify.kernels.facets import TASK_COLUMNS, TASKS, box_depth, enter_triangle
from trunnion.verify.kernels.way import END_COLUMNS, S_FROM, S_TO, SPAN_COLUMNS, WAY_COLUMNS, fill_span, fill_way


@njit(cache=True, nogil=True)
def stopped_before(tip: Floats, axis: Floats, arcs: Floats, pieces: Floats, places: Floats, count: int, deeper: float) -> bool:
    """Say whether one of the first `count` places (w, 3) is deeper than that in a tool that stands, and put it first of them.

    A place counts for a piece (p, 8) between its ends alone, where all engines of contact agree on its depth at least.
    """
    for i in range(count):
        x, y, z = places[i, 0] - tip[0], places[i, 1] - tip[1], places[i, 2] - tip[2]
        h = x * axis[0] + y * axis[1] + z * axis[2]
        rho = math.sqrt(max(x * x + y * y + z * z - h * h, 0.0))
        for p in range(len(pieces)):
            if h < pieces[p, Z_LOW] or h > pieces[p, Z_HIGH] or rho >= pieces[p, R_MAX] - deeper:
                continue
            depth, _r, _h = depth_in_body(arcs, int(pieces[p, CLOSED_FIRST]), int(pieces[p, CLOSED_LAST]), rho, h)
            if depth > deeper:
                _put_first(places, i, places[i, 0], places[i, 1], places[i, 2])
                return True
    return False


@njit(cache=True, nogil=True)
def remember(places: Floats, count: int, x: float, y: float, z: float) -> int:
    """Put a place first of the `count` that are known (w, 3), where all are known in place of the last; return how many are known then."""
    count = min(count + 1, len(places))
    _put_first(places, count - 1, x, y, z)
    return count


@njit(cache=True, nogil=True)
def _put_first(places: Floats, at: int, x: float, y: float, z: float) -> None:
    for i in range(at, 0, -1):
        for k in range(3):
            places[i, k] = places[i - 1, k]
    places[0, 0], places[0, 1], places[0, 2] = x, y, z


@njit(cache=True, nogil=True)
def known_loop(tips: Floats, axes: Floats, rows: Ints, arcs: Floats, pieces: Floats, places: Floats, count: Ints, deeper: float,
               stopped: Bools) -> None:
    """Say for poses (n, 3) of one tool, each of a row of places (k, w, 3), whether what is known there stops them: `stopped` (n,)."""
    for n in range(len(tips)):
        stopped[n] = stopped_before(tips[n], axes[n], arcs, pieces, places[rows[n]], count[rows[n]], deeper)


@njit(cache=True, nogil=True)
def remember_loop(found: Floats, rows: Ints, places: Floats, count: Ints) -> None:
    """Remember what stopped poses: found (n, 3), NaN where nothing did, each for a row of places (k, w, 3) with their number (k,)."""
    for n in range(len(found)):
        if not math.isnan(found[n, 0]):
            count[rows[n]] = remember(places[rows[n]], count[rows[n]], found[n, 0], found[n, 1], found[n, 2])


@njit(cache=True, nogil=True)
def clear_loop(first: int, last: int, tips: Floats, axes: Floats, wanted: Bools, arcs: Floats, pieces: Floats, boxes: Floats, skip: Ints,
               leaves: Ints, corners: Floats, normals: Floats, face: Ints, n_faces: int, allowed: float, bound: float, places: Floats,
               count: Ints, found: Bools) -> None:
    """Say for places `first` to `last` whether one of their poses is clear: found (k,).

    tips, axes (k, a, 3): the poses of one tool, of which those `wanted` (k, a) are tried in turn. The tree is as `kernels/facets.py` has
    it. A pose is clear when nothing of the tool enters a triangle deeper than allowed, within `bound`: just when `contact_loop` of
    `kernels/facets.py` says so, which looks at the triangles in the same order. places (k, w, 3), count (k,): what
    is known to stop tools at each place; more is remembered there.
    """
    way, ends, span = np.zeros(WAY_COLUMNS), np.zeros((2, END_COLUMNS)), np.zeros(SPAN_COLUMNS)
    near_ends, near = np.zeros((2, END_COLUMNS)), np.zeros(SPAN_COLUMNS)
    tasks, task, deepest = np.zeros((TASKS, TASK_COLUMNS)), np.zeros(TASK_COLUMNS), np.zeros(4)
    six, cuts, flat, nowhere = np.zeros((6, 3)), np.zeros((3, 6)), np.zeros((3, 3)), np.full(3, np.nan)
    best, stamp, pose = np.full((n_faces, 2), -np.inf), np.full(n_faces, -1), 0
    for k in range(first, last):
        if count[k] == 0 and k > first:
            # What stops tools at one place often stops them at the next.
            places[k], count[k] = places[k - 1], count[k - 1]
        for n in range(tips.shape[1]):
            if not wanted[k, n] or stopped_before(tips[k, n], axes[k, n], arcs, pieces, places[k], count[k], allowed + bound):
                continue
            fill_way(tips[k, n], tips[k, n], axes[k, n], axes[k, n], nowhere, 0.0, way)
            fill_span(way, 0.0, 1.0, ends, span)
            near[S_FROM] = near[S_TO] = -1.0
            clear, pose = True, pose + 1
            for p in range(len(pieces)):
                column = 0 if pieces[p, KIND] == 0.0 else 1
                a, b = int(pieces[p, CLOSED_FIRST]), int(pieces[p, CLOSED_LAST])
                node = 0
                while node < len(boxes) and clear:
                    if box_depth(boxes[node], ends, span, arcs, a, b) <= allowed:
                        node = skip[node]
                        continue
                    for m in range(leaves[node, 0], leaves[node, 0] + leaves[node, 1]):
                        f = face[m]
                        if stamp[f] != pose:
                            stamp[f], best[f, 0], best[f, 1] = pose, -np.inf, -np.inf
                        deepest[0] = best[f, column]
                        enter_triangle(corners[m], normals[m], way, 0.0, 1.0, arcs, a, b, allowed, bound, allowed, deepest, tasks, task,
                                       near_ends, near, six, cuts, flat)
                        if deepest[0] > allowed:
                            clear = False
                            count[k] = remember(places[k], count[k], deepest[1], deepest[2], deepest[3])
                            break
                        best[f, column] = deepest[0]
                    node += 1
                if not clear:
                    break
            if clear:
                found[k] = True
                break
