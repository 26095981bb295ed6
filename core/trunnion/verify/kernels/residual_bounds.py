"""Compiled two-sided bounds of residual material over cells of an exact surface: scallop height from
above, gouge from below.

A cell is a parallelogram, middle +- a +- b, and `slack`, how far the surface may be from it.

* Above: the signed distance f to a static convex cutter is convex in the point, so over a cell it
  is largest at a corner; material left is at most that, for every pose. So it is for every mean of
  two poses', since the least of two is at most any mean: where two passes meet in a ridge, the mean
  that is level there bounds it to second order.
* Below: seen from the tool, the cell moves along a chord, and f is convex in place and time
  together; the mean of two tangents that is level along the chord bounds it from below, less its
  slope across the cell, the chord's sag and what the tool turns meanwhile.

f has slope 1 at most, so the slack is added above and taken off below: both bounds are safe. mm,
rad, the frame of the moves; ways, flutes and trees as in `kernels/residual.py`.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.kernels.kernel_arrays import BORROWED
from trunnion.verify.kernels.body import depth_in_body
from trunnion.verify.kernels.residual import (
    AX,
    AY,
    AZ,
    DX,
    DY,
    DZ,
    EX,
    EY,
    EZ,
    NO_END,
    RADIUS,
    SWEEP,
    TURN,
    Flutes,
    SpanTree,
    chord_distance_bound,
    flute_signed_distance,
    nearest_span,
    node_distance_bound,
    point_in_tool_frame,
)

POSES = 5
"""Of a cell's middle and its corners."""
CLOSE = 0.05
"""Share of the bound that single distances may be off."""


@njit(**BORROWED)
def _direction_in_tool_frame(
    w: Floats, x: float, y: float, z: float, t: float
) -> tuple[float, float, float]:
    """Return a direction (vector, mm) as it is seen from the tool at a share t of its way."""
    nx, ny, nz = (
        w[AY] * w[EZ] - w[AZ] * w[EY],
        w[AZ] * w[EX] - w[AX] * w[EZ],
        w[AX] * w[EY] - w[AY] * w[EX],
    )
    e, n, a = (
        x * w[EX] + y * w[EY] + z * w[EZ],
        x * nx + y * ny + z * nz,
        x * w[AX] + y * w[AY] + z * w[AZ],
    )
    if w[TURN] > 0.0:
        c, s = math.cos(t * w[TURN]), math.sin(t * w[TURN])
        return c * e - s * a, n, c * a + s * e
    return e, n, a


@njit(**BORROWED)
def _distance_and_gradient(
    arcs: Floats, first: int, last: int, x: float, y: float, z: float
) -> tuple[float, float, float, float]:
    """Return the signed distance (mm) to a body at a position seen from the tool, and its gradient there."""
    rho = math.sqrt(x * x + y * y)
    depth, nr, nz = depth_in_body(arcs, first, last, rho, z)
    return (-depth, nr * x / rho, nr * y / rho, nz) if rho > 0.0 else (-depth, 0.0, 0.0, nz)


@njit(**BORROWED)
def _cell_chord_bound(
    arcs: Floats,
    first: int,
    last: int,
    x0: float,
    y0: float,
    z0: float,
    x1: float,
    y1: float,
    z1: float,
    s: float,
    t: float,
    ax: float,
    ay: float,
    az: float,
    bx: float,
    by: float,
    bz: float,
) -> float:
    """Return a lower bound (mm) of the signed distance of a cell, half sides a and b, that moves along
    a chord, by the tangents at the shares s <= t.

    The distance of the cell's middle is smallest between the shares. Mixed with p = rise / (rise -
    fall) the two tangents are level along the chord, so the mixture bounds f everywhere on it;
    across the cell it falls by |g . a| + |g . b| at most. Equal shares are a minimum at an end, or
    a level tangent.
    """
    dx, dy, dz = x1 - x0, y1 - y0, z1 - z0
    f, gx, gy, gz = _distance_and_gradient(arcs, first, last, x0 + s * dx, y0 + s * dy, z0 + s * dz)
    # Level along the chord: p fall + (1 - p) rise = 0; f is the mixture's value where the chord
    # begins, so everywhere on it.
    if t > s:
        e, hx, hy, hz = _distance_and_gradient(
            arcs, first, last, x0 + t * dx, y0 + t * dy, z0 + t * dz
        )
        fall, rise = gx * dx + gy * dy + gz * dz, hx * dx + hy * dy + hz * dz
        p = rise / (rise - fall)
        f = p * (f - fall * s) + (1.0 - p) * (e - rise * t)
        gx, gy, gz = p * gx + (1.0 - p) * hx, p * gy + (1.0 - p) * hy, p * gz + (1.0 - p) * hz
    return f - abs(gx * ax + gy * ay + gz * az) - abs(gx * bx + gy * by + gz * bz)


@njit(**BORROWED)
def _cell_span_bound(
    w: Floats,
    flutes: Flutes,
    tool: int,
    x: float,
    y: float,
    z: float,
    t0: float,
    t1: float,
    a: Floats,
    b: Floats,
    size: float,
    slack: float,
    least: float,
    close: float,
    spans: Floats,
) -> float:
    """Return the smaller of `least` and a lower bound (mm) of the signed distances of a cell along a
    way between two shares.

    a, b (3,) half sides, size |a| + |b|. A span whose sag is above `close` is halved; where the
    workspace spans (k, 2) is full it counts with its sag, which is still a bound.
    """
    spans[0, 0], spans[0, 1] = t0, t1
    top = 1
    length = math.sqrt(w[DX] * w[DX] + w[DY] * w[DY] + w[DZ] * w[DZ])
    while top > 0:
        top -= 1
        s0, s1 = spans[top, 0], spans[top, 1]
        share = s1 - s0
        x0, y0, z0 = point_in_tool_frame(w, x, y, z, s0)
        x1, y1, z1 = point_in_tool_frame(w, x, y, z, s1)
        # Sag of the middle's chord, as in `kernels/residual.py`; a turning axis also turns the cell's
        # sides, by `turn` x size at most.
        sag = 0.0
        if w[RADIUS] > 0.0:
            turn = w[SWEEP] * share
            sag = min(0.125 * turn * turn, 2.0) * w[RADIUS]
        elif w[TURN] > 0.0:
            turn, far = (
                w[TURN] * share,
                math.sqrt(max(x0 * x0 + y0 * y0 + z0 * z0, x1 * x1 + y1 * y1 + z1 * z1)),
            )
            sag = turn * (0.125 * turn * far + 0.25 * share * length + size)
        ax, ay, az = _direction_in_tool_frame(w, a[0], a[1], a[2], s0)
        bx, by, bz = _direction_in_tool_frame(w, b[0], b[1], b[2], s0)
        lowest = np.inf
        for k in range(flutes.start[tool], flutes.start[tool + 1]):
            low, _at, s, t = chord_distance_bound(
                flutes.arc, flutes.first[k], flutes.last[k], x0, y0, z0, x1, y1, z1, np.inf, close
            )
            # Every point of the cell is within size + slack of its middle.
            if low - size - sag - slack < least:
                lowest = min(
                    lowest,
                    _cell_chord_bound(
                        flutes.arc,
                        flutes.first[k],
                        flutes.last[k],
                        x0,
                        y0,
                        z0,
                        x1,
                        y1,
                        z1,
                        s,
                        t,
                        ax,
                        ay,
                        az,
                        bx,
                        by,
                        bz,
                    ),
                )
        if lowest - sag - slack >= least:
            continue
        if sag > close and top + 2 <= len(spans):
            middle = 0.5 * (s0 + s1)
            spans[top, 0], spans[top, 1] = s0, middle
            spans[top + 1, 0], spans[top + 1, 1] = middle, s1
            top += 2
            continue
        least = min(least, lowest - sag - slack)
    return least


@njit(**BORROWED)
def cell_residual_bound(
    x: float,
    y: float,
    z: float,
    a: Floats,
    b: Floats,
    slack: float,
    tree: SpanTree,
    flutes: Flutes,
    least: float,
    stop: float,
    close: float,
    nodes: Ints,
    lower: Floats,
    spans: Floats,
) -> float:
    """Return a lower bound (mm) of the material left on a cell, or something below `stop` when that is
    found first.

    a, b (3,) run from its middle to the middles of its sides; slack is how far the surface may be
    from it. `least` is what is left at the middle. nodes, lower (k,), spans (k, 2): workspace.
    """
    size = math.sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]) + math.sqrt(
        b[0] * b[0] + b[1] * b[1] + b[2] * b[2]
    )
    top = 0
    for r in range(len(tree.root)):
        nodes[top], lower[top] = (
            tree.root[r],
            node_distance_bound(tree, flutes, tree.root[r], x, y, z, False) - size - slack,
        )
        top += 1
    # As `nearest_span`, every bound lowered by the cell's size and slack.
    while top > 0 and least >= stop:
        top -= 1
        n = nodes[top]
        # Branch and bound: nothing below this node is nearer than the least so far.
        if lower[top] >= least:
            continue
        left, right = tree.link[n, 0], tree.link[n, 1]
        if left >= 0:
            nodes[top], lower[top] = (
                left,
                node_distance_bound(tree, flutes, left, x, y, z, False) - size - slack,
            )
            nodes[top + 1], lower[top + 1] = (
                right,
                node_distance_bound(tree, flutes, right, x, y, z, False) - size - slack,
            )
            top += 2
            continue
        for k in range(tree.link[n, 2], tree.link[n, 3]):
            w = tree.motion[tree.of[k]]
            mx, my, mz = point_in_tool_frame(w, x, y, z, 0.5 * (tree.low[k] + tree.high[k]))
            turn = w[TURN] * (tree.high[k] - tree.low[k])
            # A turn moves a point by at most the turn times its distance from the tip, here from the middle.
            reach = tree.reach[k] + 0.5 * turn * math.sqrt(mx * mx + my * my + mz * mz)
            if (
                flute_signed_distance(
                    flutes, tree.link[n, 4], math.sqrt(mx * mx + my * my), mz, False
                )
                - reach
                - size
                - slack
                >= least
            ):
                continue
            least = _cell_span_bound(
                w,
                flutes,
                tree.link[n, 4],
                x,
                y,
                z,
                tree.low[k],
                tree.high[k],
                a,
                b,
                size,
                slack,
                least,
                close,
                spans,
            )
    return least


@njit(cache=True, nogil=True)
def _mean_of_two(p: Floats, q: Floats) -> float:
    """Return the least over all means of two poses of the largest of their distances (4,) at a cell's
    corners (mm).

    The largest of four lines in the share is convex and piecewise linear: its minimum is at an end
    or where two of the lines cross.
    """
    best = min(p.max(), q.max())
    for i in range(4):
        for j in range(4):
            # The share at which corners i and j have equal distances: share p_i + (1 - share) q_i =
            # share p_j + (1 - share) q_j.
            fall = (p[i] - q[i]) - (p[j] - q[j])
            if fall == 0.0:
                continue
            share = (q[j] - q[i]) / fall
            if 0.0 < share < 1.0:
                best = min(best, (share * p + (1.0 - share) * q).max())
    return best


@njit(**BORROWED)
def _nearest_body(flutes: Flutes, tool: int, w: Floats, position: Floats, share: float) -> int:
    """Return which of a tool's convex bodies a position lies deepest in, or is nearest to, in a pose.

    The convexity that the bound from above needs holds for one body; its distance is at least the
    union's.
    """
    x, y, z = point_in_tool_frame(w, position[0], position[1], position[2], share)
    best, deepest = flutes.start[tool], -np.inf
    # The depth is the greatest over the bodies: that of a union inside of it.
    for k in range(flutes.start[tool], flutes.start[tool + 1]):
        depth, _r, _h = depth_in_body(
            flutes.arc, flutes.first[k], flutes.last[k], math.sqrt(x * x + y * y), z
        )
        if depth > deepest:
            best, deepest = k, depth
    return best


@njit(cache=True, nogil=True)
def cell_residual_loop(
    first: int,
    last: int,
    middle: Floats,
    a: Floats,
    b: Floats,
    slack: Floats,
    tree: SpanTree,
    flutes: Flutes,
    far: float,
    lowest: float,
    bound: float,
    above: Bools,
    residual: Floats,
    nearest: Ints,
    upper: Floats,
    lower: Floats,
) -> None:
    """Fill for cells `first` to `last` what is left at their middle, by which move, and bounds from
    above and below over the whole cell.

    middle, a, b (c, 3), slack (c,) as in `cell_residual_bound`; far: no distance above it is reported. Fills
    residual (c,) mm, nearest (c,) rows or -1, upper and lower (c,) mm. Where a cell may fall by `bound`
    below both `lowest` and its middle, its `lower` only says so; with an infinite `lowest` it isn't
    searched for. Where `above` (c,) is false, no bound from above is searched for.
    """
    close = CLOSE * bound
    nodes, least, spans = (
        np.zeros(len(tree.root) + 128, np.int64),
        np.zeros(len(tree.root) + 128),
        np.zeros((96, 2)),
    )
    rows, shares, distance, positions = (
        np.zeros(POSES, np.int64),
        np.zeros(POSES),
        np.zeros((POSES, 4)),
        np.zeros((POSES, 3)),
    )
    for n in range(first, last):
        # The nearest poses of the middle and the four corners: candidates for the bound from above.
        for k in range(POSES if above[n] else 1):
            i = 0.0 if k == 0 else (1.0 if k % 2 else -1.0)
            j = 0.0 if k == 0 else (1.0 if k > 2 else -1.0)
            positions[k] = middle[n] + i * a[n] + j * b[n]
            value, move, rows[k], shares[k] = nearest_span(
                positions[k, 0],
                positions[k, 1],
                positions[k, 2],
                tree,
                flutes,
                far,
                -1,
                close,
                NO_END,
                False,
                -np.inf,
                nodes,
                least,
                spans,
            )
            if k == 0:
                residual[n], nearest[n] = value, move
        upper[n] = far if above[n] else -np.inf
        for k in range(POSES if above[n] else 0):
            if rows[k] < 0:
                continue
            w, tool = tree.motion[rows[k]], tree.tool[rows[k]]
            body = _nearest_body(flutes, tool, w, positions[k], shares[k])
            # Distances of this pose at the four corners: their largest is a bound; so is each mean
            # with an earlier pose.
            for c in range(4):
                x, y, z = point_in_tool_frame(
                    w, positions[c + 1, 0], positions[c + 1, 1], positions[c + 1, 2], shares[k]
                )
                depth, _r, _h = depth_in_body(
                    flutes.arc, flutes.first[body], flutes.last[body], math.sqrt(x * x + y * y), z
                )
                distance[k, c] = -depth
            upper[n] = min(upper[n], distance[k].max() + slack[n])
            for m in range(k):
                if rows[m] >= 0:
                    upper[n] = min(upper[n], _mean_of_two(distance[k], distance[m]) + slack[n])
        if lowest < np.inf:
            lower[n] = cell_residual_bound(
                middle[n, 0],
                middle[n, 1],
                middle[n, 2],
                a[n],
                b[n],
                slack[n],
                tree,
                flutes,
                residual[n],
                min(lowest, residual[n]) - bound,
                close,
                nodes,
                least,
                spans,
            )
