"""The compiled loop: each move cuts every column down to the lowest place of the cutter's bottom form over its whole way.

Over a straight way the height of a form of revolution above a column is a convex function of the way: its least is found in closed form
for a flat end and a ball, and by halving its slope for a rounded corner. Nothing is sampled along a line.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

HALVINGS = 40


@njit(cache=True)
def bottom(distance, radius, corner):
    """Return how high the form is over its tip at a distance from its axis."""
    flat = radius - corner
    if distance <= flat:
        return 0.0
    return corner - math.sqrt(max(corner**2 - (distance - flat) ** 2, 0.0))


@njit(cache=True)
def slope_at(s, along, beside, slope, radius, corner):
    """Return the derivative by the way of the form's height over a column, at the way s."""
    distance = math.hypot(s - along, beside)
    flat = radius - corner
    if distance <= flat or distance <= 0.0:
        return slope
    rise = (distance - flat) / math.sqrt(max(corner**2 - (distance - flat) ** 2, 1e-18))
    return slope + rise * (s - along) / distance


@njit(cache=True)
def lowest(along, beside, length, height, slope, radius, corner):
    """Return how low a form comes over a column that lies `along` a way of `length` and `beside` it; inf where it doesn't come over it.

    height: of the tip at the way's start; slope: of the tip per mm of the way in plan.
    """
    half = radius**2 - beside**2
    if half < 0.0:
        return np.inf
    half = math.sqrt(half)
    low, high = max(along - half, 0.0), min(along + half, length)
    if low > high:
        return np.inf
    if slope == 0.0:
        s = min(max(along, low), high)
    elif corner == 0.0:
        s = low if slope > 0.0 else high
    elif corner == radius:
        rest = math.sqrt(max(radius**2 - beside**2, 0.0))
        s = min(max(along - slope * rest / math.sqrt(1.0 + slope**2), low), high)
    else:
        for _ in range(HALVINGS):
            s = 0.5 * (low + high)
            if slope_at(s, along, beside, slope, radius, corner) > 0.0:
                high = s
            else:
                low = s
    return height + slope * s + bottom(math.hypot(s - along, beside), radius, corner)


@njit(cache=True)
def simulate(heights, corner_xy, cell, start, end, rapid, form, bodies, body_start, slack):
    """Cut columns (ny, nx) by moves n and return what each move ran into.

    heights are lowered in place. form (n, 2): radius and corner's radius of each move's cutter; bodies (b, 2): radius and height over
    the tip of discs above the flutes, those of move n from body_start[n, 0] to body_start[n, 1]; slack mm: what a rapid or a disc may
    touch. Returns by (ny, nx) the move that cut a column last, or -1; rapid_depth, body_depth (n,) mm in standing stock.
    """
    by = np.full(heights.shape, -1)
    rapid_depth, body_depth = np.zeros(len(start)), np.zeros(len(start))
    top = heights.max()
    for n in range(len(start)):
        if rapid[n]:
            rapid_depth[n] = _over(
                heights,
                by,
                corner_xy,
                cell,
                start[n],
                end[n],
                form[n, 0] - slack,
                form[n, 1],
                -1,
                slack,
            )
        else:
            _over(heights, by, corner_xy, cell, start[n], end[n], form[n, 0], form[n, 1], n, 0.0)
        for b in range(body_start[n, 0], body_start[n, 1]):
            lift = bodies[b, 1] + slack
            if min(start[n, 2], end[n, 2]) + lift < top:
                depth = _over(
                    heights,
                    by,
                    corner_xy,
                    cell,
                    start[n],
                    end[n],
                    bodies[b, 0] - slack,
                    0.0,
                    -1,
                    lift,
                )
                body_depth[n] = max(body_depth[n], depth)
    return by, rapid_depth, body_depth


@njit(cache=True)
def _over(heights, by, corner_xy, cell, start, end, radius, corner, move, lift):
    """Cut the columns under a form's way (move 0 and up) or return how deep at most it stands in them (move -1)."""
    corner = min(corner, radius)
    rows, columns = heights.shape
    dx, dy = end[0] - start[0], end[1] - start[1]
    length = math.hypot(dx, dy)
    height = start[2] + lift
    slope = 0.0
    if length < 1e-9:
        length, dx, dy = 0.0, 1.0, 0.0
        height = min(start[2], end[2]) + lift
    else:
        dx, dy, slope = dx / length, dy / length, (end[2] - start[2]) / length
    deep = 0.0
    low = max(int(math.ceil((min(start[1], end[1]) - radius - corner_xy[1]) / cell)), 0)
    high = min(int(math.floor((max(start[1], end[1]) + radius - corner_xy[1]) / cell)), rows - 1)
    for j in range(low, high + 1):
        y = corner_xy[1] + j * cell - start[1]
        # The columns of this row that the way's stadium can hold: those within the radius of the way's line, and of its box.
        left = min(start[0], end[0]) - radius
        right = max(start[0], end[0]) + radius
        if abs(dy) > 1e-9 and length > 0.0:
            a = start[0] + (dx * y - radius) / dy
            b = start[0] + (dx * y + radius) / dy
            left, right = max(left, min(a, b)), min(right, max(a, b))
        first = max(int(math.ceil((left - corner_xy[0]) / cell)), 0)
        last = min(int(math.floor((right - corner_xy[0]) / cell)), columns - 1)
        for i in range(first, last + 1):
            x = corner_xy[0] + i * cell - start[0]
            least = lowest(x * dx + y * dy, x * dy - y * dx, length, height, slope, radius, corner)
            if least < heights[j, i]:
                deep = max(deep, heights[j, i] - least)
                if move >= 0:
                    heights[j, i] = least
                    by[j, i] = move
    return deep
