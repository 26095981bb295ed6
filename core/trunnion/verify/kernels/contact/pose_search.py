"""Compiled search for a collision-free pose among many: static tools against triangles, with a
move-to-front cache of obstacles.

Whether any pose of a list is clear is decided by exclusion: one point of the part that lies deeper
in the tool than allowed rules a pose out, and finding that point is the whole cost. Most poses at a
position that is hard to access are ruled out by the same few points, so each position keeps a short
list of the obstacles that stopped a tool there, most recent first (a self-organising list with the
move-to-front rule: Sleator and Tarjan, Amortized efficiency of list update and paging rules, 1985).
The list is tried before the tree of triangles. It can only rule a pose out; that a pose is clear is
always decided by the full search of `kernels/contact/facets.py`.

Tips and axes (unit) in the frame of the triangles, mm. Obstacles (k, w, 3) mm in the same frame.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.kernels.kernel_arrays import BORROWED
from trunnion.verify.kernels.body import (
    CLOSED_FIRST,
    CLOSED_LAST,
    KIND,
    R_MAX,
    Z_HIGH,
    Z_LOW,
    depth_in_body,
)
from trunnion.verify.kernels.contact.facets import (
    TASK_COLUMNS,
    TASKS,
    box_depth_bound,
    triangle_contact,
)
from trunnion.verify.kernels.tool_motion import (
    END_COLUMNS,
    MOTION_COLUMNS,
    S_FROM,
    S_TO,
    SPAN_COLUMNS,
    fill_swept_segment,
    fill_tool_motion,
)


@njit(**BORROWED)
def blocked_by_known(
    tip: Floats,
    axis: Floats,
    arcs: Floats,
    pieces: Floats,
    positions: Floats,
    count: int,
    deeper: float,
) -> bool:
    """Return whether one of the first `count` obstacles (w, 3) lies deeper (mm) than `deeper` in a
    static tool; that one is moved to the front.

    tip (3,), axis (3,) unit; arcs, pieces (p, 8) as in `kernels/body.py`. An obstacle counts for a
    piece only between Z_LOW and Z_HIGH: there every contact engine reports at least the depth that
    is found here, so no pose is ruled out that the full search would pass, provided `deeper`
    includes its bound.
    """
    for i in range(count):
        # The point in the tool's meridian: height along the axis and distance from it.
        x, y, z = positions[i, 0] - tip[0], positions[i, 1] - tip[1], positions[i, 2] - tip[2]
        h = x * axis[0] + y * axis[1] + z * axis[2]
        rho = math.sqrt(max(x * x + y * y + z * z - h * h, 0.0))
        for p in range(len(pieces)):
            # Depth in the closed body is at most R_MAX - rho.
            if h < pieces[p, Z_LOW] or h > pieces[p, Z_HIGH] or rho >= pieces[p, R_MAX] - deeper:
                continue
            depth, _r, _h = depth_in_body(
                arcs, int(pieces[p, CLOSED_FIRST]), int(pieces[p, CLOSED_LAST]), rho, h
            )
            if depth > deeper:
                _move_to_front(positions, i, positions[i, 0], positions[i, 1], positions[i, 2])
                return True
    return False


@njit(**BORROWED)
def insert_obstacle(positions: Floats, count: int, x: float, y: float, z: float) -> int:
    """Insert an obstacle (mm) at the front of the `count` known ones in positions (w, 3), dropping the
    last when all rows are in use; return the new count."""
    count = min(count + 1, len(positions))
    _move_to_front(positions, count - 1, x, y, z)
    return count


@njit(**BORROWED)
def _move_to_front(positions: Floats, at: int, x: float, y: float, z: float) -> None:
    """Shift rows 0 to at - 1 of positions (w, 3) down by one and write (x, y, z) into row 0; the old row
    `at` is overwritten."""
    for i in range(at, 0, -1):
        for k in range(3):
            positions[i, k] = positions[i - 1, k]
    positions[0, 0], positions[0, 1], positions[0, 2] = x, y, z


@njit(**BORROWED)
def blocked_by_known_loop(
    tips: Floats,
    axes: Floats,
    rows: Ints,
    arcs: Floats,
    pieces: Floats,
    positions: Floats,
    count: Ints,
    deeper: float,
    stopped: Bools,
) -> None:
    """Fill stopped (n,) with whether a known obstacle rules out each of n poses of one tool.

    tips, axes (n, 3); rows (n,) the position of each pose among positions (k, w, 3) with count (k,)
    known ones. `deeper` (mm) as in `blocked_by_known`.
    """
    for n in range(len(tips)):
        stopped[n] = blocked_by_known(
            tips[n], axes[n], arcs, pieces, positions[rows[n]], count[rows[n]], deeper
        )


@njit(**BORROWED)
def insert_obstacle_loop(found: Floats, rows: Ints, positions: Floats, count: Ints) -> None:
    """Add the points found (n, 3) that stopped poses, NaN where none did, to the lists positions (k, w,
    3), count (k,) of the positions rows (n,)."""
    for n in range(len(found)):
        if not math.isnan(found[n, 0]):
            count[rows[n]] = insert_obstacle(
                positions[rows[n]], count[rows[n]], found[n, 0], found[n, 1], found[n, 2]
            )


@njit(cache=True, nogil=True)
def pose_search_loop(
    first: int,
    last: int,
    tips: Floats,
    axes: Floats,
    wanted: Bools,
    arcs: Floats,
    pieces: Floats,
    boxes: Floats,
    skip: Ints,
    leaves: Ints,
    corners: Floats,
    normals: Floats,
    face: Ints,
    n_faces: int,
    allowed: float,
    bound: float,
    positions: Floats,
    count: Ints,
    found: Bools,
) -> None:
    """Fill found[first:last] with whether at least one pose at each position is free of contact deeper
    than `allowed` (mm).

    tips, axes (k, a, 3): a candidate poses of one tool at each of k positions; only those `wanted`
    (k, a) are tried, in order, up to the first clear one. boxes, skip, leaves, corners, normals,
    face: the tree of triangles as in `kernels/contact/facets.py`. positions (k, w, 3), count (k,): known
    obstacles, extended here.

    A pose counts as clear exactly when `contact_loop` of `kernels/contact/facets.py` with the same
    `allowed` and `bound` finds nothing deeper, since both visit the triangles in the same order
    with the same pruning: the deepest contact of a clear pose is at most allowed + bound.
    """
    motion, ends, span = (
        np.zeros(MOTION_COLUMNS),
        np.zeros((2, END_COLUMNS)),
        np.zeros(SPAN_COLUMNS),
    )
    near_ends, near = np.zeros((2, END_COLUMNS)), np.zeros(SPAN_COLUMNS)
    tasks, task, deepest = np.zeros((TASKS, TASK_COLUMNS)), np.zeros(TASK_COLUMNS), np.zeros(4)
    six, cuts, flat, nowhere = (
        np.zeros((6, 3)),
        np.zeros((3, 6)),
        np.zeros((3, 3)),
        np.full(3, np.nan),
    )
    best, stamp, pose = np.full((n_faces, 2), -np.inf), np.full(n_faces, -1), 0
    for k in range(first, last):
        if count[k] == 0 and k > first:
            # Neighbouring positions share obstacles: an empty list starts as a copy of the previous
            # one. The first of a chunk starts empty, so that the result doesn't depend on how the
            # work is divided.
            positions[k], count[k] = positions[k - 1], count[k - 1]
        for n in range(tips.shape[1]):
            if not wanted[k, n] or blocked_by_known(
                tips[k, n], axes[k, n], arcs, pieces, positions[k], count[k], allowed + bound
            ):
                continue
            # A static pose is a motion of no length: one span over its whole path.
            fill_tool_motion(tips[k, n], tips[k, n], axes[k, n], axes[k, n], nowhere, 0.0, motion)
            fill_swept_segment(motion, 0.0, 1.0, ends, span)
            # A share no span has: the cached span of the previous pose must not be taken for this
            # one's.
            near[S_FROM] = near[S_TO] = -1.0
            clear, pose = True, pose + 1
            for p in range(len(pieces)):
                column = 0 if pieces[p, KIND] == 0.0 else 1
                a, b = int(pieces[p, CLOSED_FIRST]), int(pieces[p, CLOSED_LAST])
                # Preorder traversal: a box that the body cannot enter deeper than allowed skips its
                # subtree.
                node = 0
                while node < len(boxes) and clear:
                    if box_depth_bound(boxes[node], ends, span, arcs, a, b) <= allowed:
                        node = skip[node]
                        continue
                    for m in range(leaves[node, 0], leaves[node, 0] + leaves[node, 1]):
                        f = face[m]
                        if stamp[f] != pose:
                            # `stamp` marks which faces have a depth of this very pose; older
                            # entries are stale.
                            stamp[f], best[f, 0], best[f, 1] = pose, -np.inf, -np.inf
                        deepest[0] = best[f, column]
                        triangle_contact(
                            corners[m],
                            normals[m],
                            motion,
                            0.0,
                            1.0,
                            arcs,
                            a,
                            b,
                            allowed,
                            bound,
                            allowed,
                            deepest,
                            tasks,
                            task,
                            near_ends,
                            near,
                            six,
                            cuts,
                            flat,
                        )
                        if deepest[0] > allowed:
                            clear = False
                            count[k] = insert_obstacle(
                                positions[k], count[k], deepest[1], deepest[2], deepest[3]
                            )
                            break
                        best[f, column] = deepest[0]
                    node += 1
                if not clear:
                    break
            if clear:
                found[k] = True
                break
