"""Compiled residual material: the least signed distance from points of the part to the swept volume of
the cutting edges.

The distance of a point to what a tool cuts along a move is the least over time of its signed
distance f to the tool (negative inside: a gouge). Seen from the tool, the point moves along a
straight chord while the tool moves straight with a still axis, and leaves that chord by a known sag
of second order where the tip follows an arc or the axis turns. The signed distance to a convex body
is convex along a chord, so tangents at both ends bound it from below; a span whose sag is too large
is halved (branch and bound). A value that is returned is attained somewhere on the move, so
residual material is never reported too small; the true value is at most the stated bound smaller.

Level and upright moves of plain cutters have a closed form in plan and are listed by the cells of a
plan grid. All others are spans in a bounding volume hierarchy of poses: each node represents poses
within a distance and an angle of its own, and since a signed distance changes no faster than the
point moves, the distance at the node's pose less that bounds all of them from below.

mm, rad, the frame of the moves.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.kernels.kernel_arrays import BORROWED
from trunnion.verify.kernels.body import depth_in_body
from trunnion.verify.kernels.contact.strips import Z_END, Z_START, move_box, point_distance

# Columns of a way: how a tool moves in space, as the chord of a point seen from it needs it.
PX, PY, PZ, DX, DY, DZ, AX, AY, AZ, EX, EY, EZ, TURN, CENTRE_E, CENTRE_N, RADIUS, PHASE, SWEEP = (
    range(18)
)
"""P the tip at the start and D from there to its end; A the axis at the start, E the unit direction across it in which the axis turns by
the angle TURN. Of arcs (RADIUS above 0): centre along E and along A x E, radius, angle at the start and the signed angle turned."""
MOTION_COLUMNS = 18
BUCKET = 4
"""Spans in a node without children: as many as cost about what two nodes do."""
_LEVEL = 1e-9
_ROUNDS = 60
NO_END = 2**62
"""A row that no move has: all count."""

_depth = njit(nogil=True, inline="always")(depth_in_body.py_func)
"""Written into its callers: the call would cost ten times its arithmetic (measured)."""


class Flutes(NamedTuple):
    """The cutting bodies of tools, closed at the flutes' top.

    arc (a, 7) as `kernels/body.py` names its columns; first, last (b,) the arcs of each body,
    endless (b,) its last without the top of the flutes (of plain cutters); start (t + 1,) the
    bodies of each tool; middle (t,) mm, height of the position on the axis by which its poses are
    compared.
    """

    arc: Floats
    first: Ints
    last: Ints
    endless: Ints
    start: Ints
    middle: Floats


class SpanTree(NamedTuple):
    """Spans of ways in a bounding volume hierarchy of poses, one for each tool.

    motion (w, 18), move (w,) their rows among the moves, tool (w,). Spans: of (k,) the row of the way,
    low and high (k,) shares of it, reach (k,) mm how far its tip moves from its middle. Nodes: pose
    (m, 8) a position on the axis, the unit axis, and how far (mm) and by what chord of angle (|a - a'|
    of two axes) poses below it differ; link (m, 6) children or -1, first and last span, tool, earliest
    move. root (r,) nodes.
    """

    motion: Floats
    move: Ints
    tool: Ints
    of: Ints
    low: Floats
    high: Floats
    reach: Floats
    pose: Floats
    link: Ints
    root: Ints


@njit(**BORROWED)
def bull_signed_distance(radius: float, corner: float, top: float, rho: float, h: float) -> float:
    """Return the signed distance (mm) of a point (rho, h) to a plain cutter whose flutes end at `top`
    (mm, at least its corner radius); negative inside.

    Rounded rectangle by its offset core: with q the point relative to the corner's centre, |max(q,
    0)| + min(max(q), 0) - corner (Quilez, 2D distance functions).
    """
    over = h - top
    if over > 0.0:
        out = max(rho - radius, 0.0)
        return math.sqrt(out * out + over * over)
    qx, qy = rho - (radius - corner), corner - h
    out = math.sqrt(max(qx, 0.0) * max(qx, 0.0) + max(qy, 0.0) * max(qy, 0.0))
    return max(out + min(max(qx, qy), 0.0) - corner, over)


@njit(**BORROWED)
def move_signed_distance(
    x: float,
    y: float,
    z: float,
    move: Floats,
    radius: float,
    corner: float,
    top: float,
    best: float,
) -> float:
    """Return the smaller of `best` and the signed distance (mm) of a point to a plain cutter along a
    level or upright move (15,).

    The flutes are at least twice as long as the corner is high: where the cutter passes up and
    down, no height is then nearer than one clear of both ends of the flank. Exact.
    """
    low, high = min(move[Z_START], move[Z_END]), max(move[Z_START], move[Z_END])
    # The distance is at least that below the lowest tip, and that beside the cutter.
    if low - z >= best:
        return best
    rho = point_distance(x, y, move)
    if rho - radius >= best:
        return best
    # Of the heights h at which the point is passed, from z - high to z - low, the one where the
    # flank is nearest: above the corner, and above the end face by more than the flank is away.
    deep = min(max(radius - rho, 0.0), 0.5 * top)
    h = min(max(z - high, max(corner, deep)), z - low)
    return min(best, bull_signed_distance(radius, corner, top, rho, h))


@njit(**BORROWED, inline="always")
def point_in_tool_frame(
    w: Floats, x: float, y: float, z: float, t: float
) -> tuple[float, float, float]:
    """Return a point as seen from the tool at a share t of its way: across the axis along E and along
    A x E, and above the tip (mm)."""
    # N = A x E completes the frame.
    nx, ny, nz = (
        w[AY] * w[EZ] - w[AZ] * w[EY],
        w[AZ] * w[EX] - w[AX] * w[EZ],
        w[AX] * w[EY] - w[AY] * w[EX],
    )
    if w[RADIUS] > 0.0:
        angle = w[PHASE] + t * w[SWEEP]
        climb = w[DX] * w[AX] + w[DY] * w[AY] + w[DZ] * w[AZ]
        return (
            x * w[EX] + y * w[EY] + z * w[EZ] - w[CENTRE_E] - w[RADIUS] * math.cos(angle),
            x * nx + y * ny + z * nz - w[CENTRE_N] - w[RADIUS] * math.sin(angle),
            (x - w[PX]) * w[AX] + (y - w[PY]) * w[AY] + (z - w[PZ]) * w[AZ] - t * climb,
        )
    # On a line the frame turns by t TURN in the plane of E and A, about N.
    vx, vy, vz = x - w[PX] - t * w[DX], y - w[PY] - t * w[DY], z - w[PZ] - t * w[DZ]
    e, n, a = (
        vx * w[EX] + vy * w[EY] + vz * w[EZ],
        vx * nx + vy * ny + vz * nz,
        vx * w[AX] + vy * w[AY] + vz * w[AZ],
    )
    if w[TURN] > 0.0:
        c, s = math.cos(t * w[TURN]), math.sin(t * w[TURN])
        return c * e - s * a, n, c * a + s * e
    return e, n, a


@njit(**BORROWED, inline="always")
def flute_signed_distance(flutes: Flutes, tool: int, rho: float, h: float, endless: bool) -> float:
    """Return the signed distance (mm) of a point (rho, h) to the union of a tool's cutting bodies,
    negative inside.

    Exact outside. Inside, the depth is that in the deepest single body: where two of them join, the
    union may be deeper, which is why closed bodies overlap.
    """
    best = np.inf
    for b in range(flutes.start[tool], flutes.start[tool + 1]):
        depth, _r, _h = _depth(
            flutes.arc, flutes.first[b], flutes.endless[b] if endless else flutes.last[b], rho, h
        )
        best = min(best, -depth)
    return best


@njit(**BORROWED, inline="always")
def _distance_slope(
    arcs: Floats,
    first: int,
    last: int,
    x: float,
    y: float,
    z: float,
    dx: float,
    dy: float,
    dz: float,
) -> tuple[float, float]:
    """Return the signed distance (mm) to a convex body at a point seen from the tool, and its
    derivative in the direction (dx, dy, dz)."""
    rho = math.sqrt(x * x + y * y)
    depth, nr, nz = _depth(arcs, first, last, rho, z)
    return -depth, nz * dz + (nr * (x * dx + y * dy) / rho if rho > 0.0 else 0.0)


@njit(**BORROWED)
def chord_distance_bound(
    arcs: Floats,
    first: int,
    last: int,
    x0: float,
    y0: float,
    z0: float,
    x1: float,
    y1: float,
    z1: float,
    stop: float,
    close: float,
) -> tuple[float, float, float, float]:
    """Return a lower bound (mm) of the signed distance to a convex body along a chord, the share where
    it is nearly attained, and two shares that bracket the minimum.

    The bound is at most `close` below what the share attains, or it is above `stop`. Cutting planes
    in one variable (Kelley, 1960): f is convex along the chord, so the tangents at both ends of the
    bracket cross below it.
    """
    dx, dy, dz = x1 - x0, y1 - y0, z1 - z0
    a, b = 0.0, 1.0
    fa, ma = _distance_slope(arcs, first, last, x0, y0, z0, dx, dy, dz)
    # A minimum at an end: the tangent there already rises (or still falls) along the chord.
    if ma >= 0.0:
        return fa, 0.0, 0.0, 0.0
    fb, mb = _distance_slope(arcs, first, last, x1, y1, z1, dx, dy, dz)
    if mb <= 0.0:
        return fb, 1.0, 1.0, 1.0
    lower = -np.inf
    for _round in range(_ROUNDS):
        # Invariant: f falls at a and rises at b. The crossing of both tangents is the least that f
        # can be.
        t = min(max((fb - fa + ma * a - mb * b) / (ma - mb), a), b)
        lower = min(fa + ma * (t - a), fb + mb * (t - b))
        if lower >= stop or min(fa, fb) - lower <= close:
            break
        f, m = _distance_slope(arcs, first, last, x0 + t * dx, y0 + t * dy, z0 + t * dz, dx, dy, dz)
        if m == 0.0:
            return f, t, t, t
        if f - lower <= close:
            return lower, t, a, b
        if m > 0.0:
            b, fb, mb = t, f, m
        else:
            a, fa, ma = t, f, m
    return lower, (a if fa <= fb else b), a, b


@njit(**BORROWED)
def _level_rho(
    w: Floats, x: float, y: float, z: float, t0: float, t1: float
) -> tuple[float, float, float]:
    """Return the least distance (mm) of a point from the axis along a path across the axis, its height
    above the tip, and the share where.

    At a constant height f never falls with rho, so the least rho gives the least distance.
    """
    ax, ay, h = point_in_tool_frame(w, x, y, z, t0)
    bx, by, _h = point_in_tool_frame(w, x, y, z, t1)
    if w[RADIUS] > 0.0:
        # Seen from the arc's centre the point stands still, and the tip turns past it.
        angle = w[PHASE] + t0 * w[SWEEP]
        px, py = ax + w[RADIUS] * math.cos(angle), ay + w[RADIUS] * math.sin(angle)
        # The angle of the point from the middle of the arc, to -pi ... pi: opposite to it where the
        # arc reaches there, else an end is nearest.
        off = math.atan2(py, px) - (w[PHASE] + 0.5 * (t0 + t1) * w[SWEEP])
        off -= 2.0 * math.pi * math.floor(off / (2.0 * math.pi) + 0.5)
        if abs(off) <= 0.5 * abs(w[SWEEP]) * (t1 - t0):
            return (
                abs(math.sqrt(px * px + py * py) - w[RADIUS]),
                h,
                0.5 * (t0 + t1) + off / w[SWEEP],
            )
        square, other = ax * ax + ay * ay, bx * bx + by * by
        return math.sqrt(min(square, other)), h, (t0 if square <= other else t1)
    # Nearest point of the chord to the axis.
    dx, dy = bx - ax, by - ay
    square = dx * dx + dy * dy
    t = min(max(-(ax * dx + ay * dy) / square, 0.0), 1.0) if square > 0.0 else 0.0
    px, py = ax + t * dx, ay + t * dy
    return math.sqrt(px * px + py * py), h, t0 + t * (t1 - t0)


@njit(**BORROWED)
def _chord_sag(w: Floats, span: float, far: float) -> float:
    """Return how far (mm) a point at most `far` from the tip leaves its chord, seen from the tool,
    over a share of the path.

    Arc: radius (1 - cos(turn / 2)) <= radius turn^2 / 8. Turning axis: turn (turn far / 8 + length
    / 4), as in `kernels/tool_motion.py`.
    """
    if w[RADIUS] > 0.0:
        turn = w[SWEEP] * span
        return min(0.125 * turn * turn, 2.0) * w[RADIUS]
    if w[TURN] > 0.0:
        turn = w[TURN] * span
        return turn * (
            0.125 * turn * far
            + 0.25 * span * math.sqrt(w[DX] * w[DX] + w[DY] * w[DY] + w[DZ] * w[DZ])
        )
    return 0.0


@njit(**BORROWED)
def span_signed_distance(
    w: Floats,
    flutes: Flutes,
    tool: int,
    x: float,
    y: float,
    z: float,
    t0: float,
    t1: float,
    best: float,
    bound: float,
    endless: bool,
    spans: Floats,
) -> tuple[float, float]:
    """Return the smaller of `best` and the signed distance (mm) of a point to what cuts of a tool
    along a path between two shares, and the share where.

    What is returned is attained; the true one is at most `bound` smaller. spans (k, 2): workspace;
    where it is full a span is not divided further. With `endless` the flutes have no top.
    """
    # Across a still axis: closed form.
    if w[TURN] == 0.0 and abs(w[DX] * w[AX] + w[DY] * w[AY] + w[DZ] * w[AZ]) <= _LEVEL:
        rho, h, at = _level_rho(w, x, y, z, t0, t1)
        return min(best, flute_signed_distance(flutes, tool, rho, h, endless)), at
    # Invariant: every time at which the distance may be below best - bound lies in a span on the
    # stack.
    spans[0, 0], spans[0, 1] = t0, t1
    top, at = 1, t0
    while top > 0:
        top -= 1
        a, b = spans[top, 0], spans[top, 1]
        x0, y0, z0 = point_in_tool_frame(w, x, y, z, a)
        x1, y1, z1 = point_in_tool_frame(w, x, y, z, b)
        # The true path lies within the sag of its chord and f has slope 1: its minimum is at least
        # the chord's less the sag.
        sag = _chord_sag(
            w, b - a, math.sqrt(max(x0 * x0 + y0 * y0 + z0 * z0, x1 * x1 + y1 * y1 + z1 * z1))
        )
        least, share = np.inf, 0.0
        for k in range(flutes.start[tool], flutes.start[tool + 1]):
            lower, s, _a, _b = chord_distance_bound(
                flutes.arc,
                flutes.first[k],
                flutes.endless[k] if endless else flutes.last[k],
                x0,
                y0,
                z0,
                x1,
                y1,
                z1,
                min(best, least + sag) - bound + sag,
                0.25 * bound,
            )
            if lower < least:
                least, share = lower, s
        if least - sag >= best - bound:
            continue
        # Evaluate on the true motion where the chord's minimum is: attained.
        t = a + share * (b - a)
        xt, yt, zt = point_in_tool_frame(w, x, y, z, t)
        value = flute_signed_distance(flutes, tool, math.sqrt(xt * xt + yt * yt), zt, endless)
        if value < best:
            best, at = value, t
        if least - sag >= best - bound or top + 2 > len(spans):
            continue
        middle = t if 0.1 <= share <= 0.9 else 0.5 * (a + b)
        spans[top, 0], spans[top, 1] = a, middle
        spans[top + 1, 0], spans[top + 1, 1] = middle, b
        top += 2
    return best, at


@njit(**BORROWED)
def node_distance_bound(
    tree: SpanTree, flutes: Flutes, n: int, x: float, y: float, z: float, above: bool
) -> float:
    """Return a lower bound (mm) of the signed distance of a point to any pose below a node.

    f(node's pose) - translation - chord of angle x distance from the pose's position: a turn of the
    axis moves the point by at most that chord times its distance.
    """
    pose, tool = tree.pose, tree.link[n, 4]
    vx, vy, vz = x - pose[n, 0], y - pose[n, 1], z - pose[n, 2]
    square = vx * vx + vy * vy + vz * vz
    h = vx * pose[n, 3] + vy * pose[n, 4] + vz * pose[n, 5]
    rho = math.sqrt(max(square - h * h, 0.0))
    return (
        flute_signed_distance(flutes, tool, rho, h + flutes.middle[tool], above)
        - pose[n, 6]
        - pose[n, 7] * math.sqrt(square)
    )


@njit(**BORROWED)
def nearest_span(
    x: float,
    y: float,
    z: float,
    tree: SpanTree,
    flutes: Flutes,
    best: float,
    by: int,
    bound: float,
    before: int,
    above: bool,
    enough: float,
    nodes: Ints,
    least: Floats,
    spans: Floats,
) -> tuple[float, int, int, float]:
    """Return the smaller of `best` and the signed distance (mm) of a point to what cuts along the
    spans of a tree, the move (else `by`), the row of its way (else -1), and the share of it where.

    Moves from row `before` on don't count. `above`: an upright plain cutter has also removed what
    is above it. The search ends at the first value not above `enough`. nodes and least (k,), spans
    (k, 2) are workspace, k above the number of roots by more than a tree is deep.
    """
    top, row_at, share_at = 0, -1, 0.0
    for r in range(len(tree.root)):
        nodes[top], least[top] = (
            tree.root[r],
            node_distance_bound(tree, flutes, tree.root[r], x, y, z, above),
        )
        top += 1
    # Depth first, the nearer child first; a node that can no longer undercut `best` is dropped when
    # it comes off the stack.
    while top > 0 and best > enough:
        top -= 1
        n = nodes[top]
        if least[top] >= best - bound or tree.link[n, 5] >= before:
            continue
        left, right = tree.link[n, 0], tree.link[n, 1]
        if left >= 0:
            a, b = (
                node_distance_bound(tree, flutes, left, x, y, z, above),
                node_distance_bound(tree, flutes, right, x, y, z, above),
            )
            # The nearer child goes on top of the stack.
            if a < b:
                left, right, a, b = right, left, b, a
            nodes[top], least[top], nodes[top + 1], least[top + 1] = left, a, right, b
            top += 2
            continue
        tool = tree.link[n, 4]
        for k in range(tree.link[n, 2], tree.link[n, 3]):
            row = tree.of[k]
            if tree.move[row] >= before:
                continue
            w = tree.motion[row]
            endless = above and w[AZ] > 1.0 - _LEVEL and w[TURN] == 0.0
            # A span is bounded as a node is: by its middle pose.
            mx, my, mz = point_in_tool_frame(w, x, y, z, 0.5 * (tree.low[k] + tree.high[k]))
            turn = w[TURN] * (tree.high[k] - tree.low[k])
            most = tree.reach[k] + 0.5 * turn * math.sqrt(mx * mx + my * my + mz * mz)
            if (
                flute_signed_distance(flutes, tool, math.sqrt(mx * mx + my * my), mz, endless)
                - most
                >= best - bound
            ):
                continue
            value, at = span_signed_distance(
                w, flutes, tool, x, y, z, tree.low[k], tree.high[k], best, bound, endless, spans
            )
            if value < best:
                best, by, row_at, share_at = value, tree.move[row], row, at
    return best, by, row_at, share_at


@njit(cache=True, nogil=True)
def span_poses(
    motion: Floats, of: Ints, low: Floats, high: Floats, middle: Floats
) -> tuple[Floats, Floats]:
    """Return the middle pose of spans (k, 6), a position on the axis and the unit axis, and how far (mm)
    and by what chord of angle (k, 2) the others of the span differ.

    middle (k,) mm is the height of that position above the tip: in the middle of the flutes the turn
    moves points of the tool least. Half the angle is taken for its chord, which is shorter.
    """
    pose, reach = np.empty((len(of), 6)), np.empty((len(of), 2))
    for k in range(len(of)):
        w, t, share = motion[of[k]], 0.5 * (low[k] + high[k]), high[k] - low[k]
        ax, ay, az = w[AX], w[AY], w[AZ]
        px, py, pz = w[PX] + t * w[DX], w[PY] + t * w[DY], w[PZ] + t * w[DZ]
        length = math.sqrt(w[DX] * w[DX] + w[DY] * w[DY] + w[DZ] * w[DZ]) * share
        if w[RADIUS] > 0.0:
            # Seen from its own tip the origin is at minus the tip's position.
            ox, oy, oz = point_in_tool_frame(w, 0.0, 0.0, 0.0, t)
            nx, ny, nz = ay * w[EZ] - az * w[EY], az * w[EX] - ax * w[EZ], ax * w[EY] - ay * w[EX]
            px, py, pz = (
                -ox * w[EX] - oy * nx - oz * ax,
                -ox * w[EY] - oy * ny - oz * ay,
                -ox * w[EZ] - oy * nz - oz * az,
            )
            climb = (w[DX] * ax + w[DY] * ay + w[DZ] * az) * share
            length = math.sqrt(climb * climb + (w[RADIUS] * w[SWEEP] * share) ** 2)
        elif w[TURN] > 0.0:
            c, s = math.cos(t * w[TURN]), math.sin(t * w[TURN])
            ax, ay, az = c * ax + s * w[EX], c * ay + s * w[EY], c * az + s * w[EZ]
        half = 0.5 * w[TURN] * share
        pose[k] = px + middle[k] * ax, py + middle[k] * ay, pz + middle[k] * az, ax, ay, az
        reach[k, 0], reach[k, 1] = 0.5 * length + middle[k] * half, half
    return pose, reach


@njit(cache=True, nogil=True)
def build_pose_bvh(
    pose: Floats,
    reach: Floats,
    move: Ints,
    start: Ints,
    tools: Ints,
    nodes: Floats,
    links: Ints,
    root: Ints,
) -> int:
    """Fill the nodes (m, 8) and links (m, 6) of trees over spans in their order; return how many nodes
    there are.

    move (k,) of each span; start (r + 1,): where the spans of each tree begin; tools (r,) theirs; root (r,) gets the first
    node of each. Spans are halved by count: consecutive spans of a program are neighbours in space.
    """
    count = 0
    work = np.zeros((128, 3), np.int64)
    for r in range(len(tools)):
        root[r] = count
        work[0, 0], work[0, 1], work[0, 2] = start[r], start[r + 1], count
        count += 1
        top = 1
        while top > 0:
            top -= 1
            first, last, n = work[top, 0], work[top, 1], work[top, 2]
            _bounding_pose(pose, reach, first, last, nodes[n])
            links[n, 0], links[n, 1], links[n, 2], links[n, 3], links[n, 4] = (
                -1,
                -1,
                first,
                last,
                tools[r],
            )
            links[n, 5] = move[first:last].min()
            if last - first > BUCKET:
                middle = (first + last) // 2
                links[n, 0], links[n, 1] = count, count + 1
                work[top, 0], work[top, 1], work[top, 2] = first, middle, count
                work[top + 1, 0], work[top + 1, 1], work[top + 1, 2] = middle, last, count + 1
                count += 2
                top += 2
    return count


@njit(cache=True, nogil=True)
def _bounding_pose(pose: Floats, reach: Floats, first: int, last: int, out: Floats) -> None:
    """Fill a node's row (8,): the middle of its positions' box and of their axes, and the radius and
    chord of angle that hold all its spans.

    Both are greatest sums over the spans: how far a span's pose is from the node's, plus how far
    the span's own poses differ from that (triangle inequality).
    """
    low, high, axis = pose[first, :3].copy(), pose[first, :3].copy(), np.zeros(3)
    for k in range(first, last):
        for c in range(3):
            low[c], high[c] = min(low[c], pose[k, c]), max(high[c], pose[k, c])
            axis[c] += pose[k, 3 + c]
    size = math.sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2])
    for c in range(3):
        out[c] = 0.5 * (low[c] + high[c])
        # Axes that cancel have no middle: any of them will do.
        out[3 + c] = axis[c] / size if size > 1e-6 else pose[first, 3 + c]
    out[6] = out[7] = 0.0
    for k in range(first, last):
        far, turn = 0.0, 0.0
        for c in range(3):
            far += (pose[k, c] - out[c]) ** 2
            turn += (pose[k, 3 + c] - out[3 + c]) ** 2
        out[6], out[7] = (
            max(out[6], math.sqrt(far) + reach[k, 0]),
            max(out[7], math.sqrt(turn) + reach[k, 1]),
        )


@njit(cache=True, nogil=True)
def move_boxes(moves: Floats, margin: Floats) -> Floats:
    """Return the plan box of every move (n, 4), wider by a margin (n,) mm on every side."""
    out = np.empty((len(moves), 4))
    for n in range(len(moves)):
        x0, y0, x1, y1 = move_box(moves[n])
        out[n, 0], out[n, 1], out[n, 2], out[n, 3] = (
            x0 - margin[n],
            y0 - margin[n],
            x1 + margin[n],
            y1 + margin[n],
        )
    return out


@njit(cache=True, nogil=True)
def residual_loop(
    first: int,
    last: int,
    points: Floats,
    order: Ints,
    moves: Floats,
    cutter: Floats,
    low: Floats,
    cell_start: Ints,
    cell_move: Ints,
    grid: Floats,
    shape: Ints,
    tree: SpanTree,
    flutes: Flutes,
    bound: float,
    residual: Floats,
    nearest: Ints,
) -> None:
    """Lower residual (s,) mm to the smallest signed distance of each point to what cuts along the moves of
    its cell and of the tree.

    points (s, 3); order (s,) in which they are visited. cutter (n, 3) is radius, corner radius and
    flute length of each move, low (n,) its lowest tip, by which the lists of a cell are sorted:
    what comes later is higher and can't be nearer. nearest (s,) gets the move.
    """
    nodes, least, spans = (
        np.zeros(len(tree.root) + 128, np.int64),
        np.zeros(len(tree.root) + 128),
        np.zeros((96, 2)),
    )
    for k in range(first, last):
        n = order[k]
        x, y, z = points[n, 0], points[n, 1], points[n, 2]
        best, by = residual[n], nearest[n]
        i, j = int(math.floor((x - grid[0]) / grid[2])), int(math.floor((y - grid[1]) / grid[2]))
        if 0 <= i < shape[0] and 0 <= j < shape[1]:
            cell = j * shape[0] + i
            for c in range(cell_start[cell], cell_start[cell + 1]):
                m = cell_move[c]
                if low[m] - z >= best:
                    break
                d = move_signed_distance(
                    x, y, z, moves[m], cutter[m, 0], cutter[m, 1], cutter[m, 2], best
                )
                if d < best:
                    best, by = d, m
        residual[n], nearest[n], _row, _share = nearest_span(
            x, y, z, tree, flutes, best, by, bound, NO_END, False, -np.inf, nodes, least, spans
        )


@njit(cache=True, nogil=True)
def residual_bvh_loop(
    first: int,
    last: int,
    points: Floats,
    order: Ints,
    tree: SpanTree,
    flutes: Flutes,
    bound: float,
    residual: Floats,
    nearest: Ints,
) -> None:
    """Lower residual (s,) as `residual_loop` does, by the moves of a tree alone."""
    nodes, least, spans = (
        np.zeros(len(tree.root) + 128, np.int64),
        np.zeros(len(tree.root) + 128),
        np.zeros((96, 2)),
    )
    for k in range(first, last):
        n = order[k]
        residual[n], nearest[n], _row, _share = nearest_span(
            points[n, 0],
            points[n, 1],
            points[n, 2],
            tree,
            flutes,
            residual[n],
            nearest[n],
            bound,
            NO_END,
            False,
            -np.inf,
            nodes,
            least,
            spans,
        )


@njit(**BORROWED)
def _removed_from_above(
    x: float,
    y: float,
    z: float,
    before: int,
    thinner: float,
    most: float,
    moves: Floats,
    cutter: Floats,
    low: Floats,
    cell_start: Ints,
    cell_move: Ints,
    grid: Floats,
    shape: Ints,
) -> bool:
    """Return whether a listed move with a row below `before`, of a cutter `thinner` by some mm of
    radius, comes as near as `most` (mm) to a point or to one above it.

    The flutes are taken as endless: an upright cutter has removed all above its lower side. Moves
    are listed by their lowest tip, so the search ends at the first one that stays above the point.
    """
    i, j = int(math.floor((x - grid[0]) / grid[2])), int(math.floor((y - grid[1]) / grid[2]))
    if i < 0 or j < 0 or i >= shape[0] or j >= shape[1]:
        return False
    cell = j * shape[0] + i
    for c in range(cell_start[cell], cell_start[cell + 1]):
        m = cell_move[c]
        if low[m] > z:
            return False
        if (
            m < before
            and move_signed_distance(
                x, y, z, moves[m], cutter[m, 0] - thinner, cutter[m, 1], np.inf, 1.0
            )
            <= most
        ):
            return True
    return False


@njit(cache=True, nogil=True)
def removed_loop(
    first: int,
    last: int,
    points: Floats,
    before: Ints,
    moves: Floats,
    cutter: Floats,
    low: Floats,
    cell_start: Ints,
    cell_move: Ints,
    grid: Floats,
    shape: Ints,
    tree: SpanTree,
    flutes: Flutes,
    bound: float,
    out: Bools,
) -> None:
    """Fill out[first:last] with whether a move with a row below a point's own `before` (s,) has
    removed it (s, 3); upright plain cutters also all above.

    Points within `bound` (mm) outside of what is cut count as removed.
    """
    nodes, least, spans = (
        np.zeros(len(tree.root) + 128, np.int64),
        np.zeros(len(tree.root) + 128),
        np.zeros((96, 2)),
    )
    for n in range(first, last):
        x, y, z = points[n, 0], points[n, 1], points[n, 2]
        out[n] = _removed_from_above(
            x, y, z, before[n], 0.0, bound, moves, cutter, low, cell_start, cell_move, grid, shape
        )
        if not out[n]:
            out[n] = (
                nearest_span(
                    x,
                    y,
                    z,
                    tree,
                    flutes,
                    2.0 * bound,
                    -1,
                    bound,
                    before[n],
                    True,
                    bound,
                    nodes,
                    least,
                    spans,
                )[1]
                >= 0
            )


@njit(**BORROWED)
def surroundings_removed_loop(
    first: int,
    last: int,
    points: Floats,
    margin: float,
    before: int,
    moves: Floats,
    cutter: Floats,
    low: Floats,
    cell_start: Ints,
    cell_move: Ints,
    grid: Floats,
    shape: Ints,
    out: Bools,
) -> None:
    """Fill out[first:last] with whether one listed move with a row below `before` has removed all
    within a margin (mm) in plan of each point (s, 3), and all above that.

    Only single moves are tested, so it errs towards material that stands.
    """
    for n in range(first, last):
        # A cutter thinner by the margin that holds the middle: the cutter itself holds all around.
        out[n] = _removed_from_above(
            points[n, 0],
            points[n, 1],
            points[n, 2],
            before,
            margin,
            0.0,
            moves,
            cutter,
            low,
            cell_start,
            cell_move,
            grid,
            shape,
        )
