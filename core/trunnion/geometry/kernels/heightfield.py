"""Height fields (z-maps) for planning: lowered under a cutter's moves, the greatest height under a
straight move, and whether a body meets any of them; and columns at any points, lowered the same way.

A field is (nx, ny) float64 heights of square cells of side `cell`; cell (i, j) spans x from `x0 + i
cell` and y from `y0 + j cell`. Both kernels err on the side of material: a cell is lowered only as
far as the cutter covers all of it, and counts as touched when any of it may be. mm, the setup
frame, tool axis +z.
`zmap_meets` looks at the cells' centres alone.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from trunnion.geometry.arrays import Bools, Floats, Ints

HALF_DIAGONAL = math.sqrt(0.5)


@njit(cache=True, nogil=True)
def zmap_cut(
    heights: Floats,
    x0: float,
    y0: float,
    cell: float,
    starts: Floats,
    ends: Floats,
    radius: float,
    corner: float,
    flutes: float,
    gone: Floats,
) -> None:
    """Lower a field in place under straight moves of the tip from `starts` to `ends` (n, 3) of a flat,
    bull or ball end cutter.

    A cell gets the height of the cutter's lower side at its furthest corner from the path, at most
    half a diagonal beyond its centre, for the move's higher end: never lower than the true cut
    anywhere in the cell. What reaches higher than `flutes` mm over its lower end stays: they went by
    underneath. gone (n, 2) gets the heights that each move takes off, summed over cells, and the sum
    of their squares.
    """
    nx, ny = heights.shape
    slack = cell * HALF_DIAGONAL
    reach = radius - slack
    # A cutter within half a diagonal never covers a whole cell.
    gone[:] = 0.0
    if reach <= 0.0:
        return
    # Squares of a centre's plan distance: within which the cutter covers all of a cell, and within which its level part does.
    flat = reach - corner
    covered, level = reach * reach, flat * flat if flat > 0.0 else -1.0
    for n in range(len(starts)):
        ax, ay, bx, by = starts[n, 0], starts[n, 1], ends[n, 0], ends[n, 1]
        # Slopes count at their higher end.
        z = max(starts[n, 2], ends[n, 2])
        top = min(starts[n, 2], ends[n, 2]) + flutes
        dx, dy = bx - ax, by - ay
        square = dx * dx + dy * dy
        share = 1.0 / square if square > 0.0 else 0.0
        i0 = max(int(math.floor((min(ax, bx) - reach - x0) / cell - 0.5)), 0)
        i1 = min(int(math.ceil((max(ax, bx) + reach - x0) / cell - 0.5)) + 1, nx)
        j0 = max(int(math.floor((min(ay, by) - reach - y0) / cell - 0.5)), 0)
        j1 = min(int(math.ceil((max(ay, by) + reach - y0) / cell - 0.5)) + 1, ny)
        for i in range(i0, i1):
            px = x0 + (i + 0.5) * cell - ax
            for j in range(j0, j1):
                if heights[i, j] <= z or heights[i, j] > top:
                    continue
                py = y0 + (j + 0.5) * cell - ay
                t = min(max((px * dx + py * dy) * share, 0.0), 1.0)
                ox, oy = px - t * dx, py - t * dy
                away = ox * ox + oy * oy
                if away > covered:
                    continue
                # Quarter circle of the corner, met at the furthest point of the cell: corner - sqrt(corner^2 - inner^2).
                lift = z
                if away > level:
                    inner = math.sqrt(away) - flat
                    lift = z + corner - math.sqrt(max(corner * corner - inner * inner, 0.0))
                if lift < heights[i, j]:
                    gone[n, 0] += heights[i, j] - lift
                    gone[n, 1] += (heights[i, j] - lift) ** 2
                    heights[i, j] = lift


@njit(cache=True, nogil=True)
def zmap_highest(
    heights: Floats, x0: float, y0: float, cell: float, start: Floats, end: Floats, radius: float
) -> float:
    """Return the greatest height of the cells that a disc may touch on its straight path from `start`
    to `end` (2,), or -inf.

    The disc is widened by half a cell's diagonal, so no cell with a point under it is left out.
    """
    nx, ny = heights.shape
    reach = radius + cell * HALF_DIAGONAL
    ax, ay, bx, by = start[0], start[1], end[0], end[1]
    dx, dy = bx - ax, by - ay
    square = dx * dx + dy * dy
    i0 = max(int(math.floor((min(ax, bx) - reach - x0) / cell - 0.5)), 0)
    i1 = min(int(math.ceil((max(ax, bx) + reach - x0) / cell - 0.5)) + 1, nx)
    j0 = max(int(math.floor((min(ay, by) - reach - y0) / cell - 0.5)), 0)
    j1 = min(int(math.ceil((max(ay, by) + reach - y0) / cell - 0.5)) + 1, ny)
    top = -np.inf
    for i in range(i0, i1):
        px = x0 + (i + 0.5) * cell - ax
        for j in range(j0, j1):
            if heights[i, j] <= top:
                continue
            py = y0 + (j + 0.5) * cell - ay
            # Plan distance of the cell's centre to the path, against the widened disc.
            t = 0.0
            if square > 0.0:
                t = min(max((px * dx + py * dy) / square, 0.0), 1.0)
            if math.hypot(px - t * dx, py - t * dy) < reach:
                top = heights[i, j]
    return top


@njit(cache=True, nogil=True)
def zmap_meets(
    heights: Floats,
    top: float,
    x0: float,
    y0: float,
    cell: float,
    tips: Floats,
    rows: Floats,
    met: Bools,
) -> None:
    """Fill `met` (k,) with whether a body of cones [z0, r0, z1, r1] (r, 4) over upright tips (k, 3) comes lower than a field, which is
    nowhere higher than `top`, at the centre of any cell."""
    for k in range(len(tips)):
        met[k] = False
        for r in range(len(rows)):
            if top - tips[k, 2] > rows[r, 0] and _cone_meets(
                heights, x0, y0, cell, tips[k], rows[r]
            ):
                met[k] = True
                break


@njit(cache=True, nogil=True)
def _cone_meets(
    heights: Floats, x0: float, y0: float, cell: float, tip: Floats, row: Floats
) -> bool:
    """Return whether a cone [z0, r0, z1, r1] over a tip (3,) comes lower than a field at the centre of any cell."""
    nx, ny = heights.shape
    x, y = tip[0], tip[1]
    low, near, high, far = row[0], row[1], row[2], row[3]
    widest = max(near, far)
    i0 = max(int(math.ceil((x - widest - x0) / cell - 0.5)), 0)
    i1 = min(int(math.floor((x + widest - x0) / cell - 0.5)) + 1, nx)
    j0 = max(int(math.ceil((y - widest - y0) / cell - 0.5)), 0)
    j1 = min(int(math.floor((y + widest - y0) / cell - 0.5)) + 1, ny)
    for i in range(i0, i1):
        px = x0 + (i + 0.5) * cell - x
        for j in range(j0, j1):
            above = heights[i, j] - tip[2]
            if above <= low:
                continue
            away = math.hypot(px, y0 + (j + 0.5) * cell - y)
            if away < near:
                return True
            # The lowest place of the cone that far off its axis.
            if away < far and above > low + (high - low) * (away - near) / (far - near):
                return True
    return False


@njit(cache=True, nogil=True)
def columns_cut(
    heights: Floats,
    points: Floats,
    starts: Floats,
    ends: Floats,
    radius: float,
    corner: float,
    flutes: float,
) -> None:
    """Lower the heights (k,) of columns at points (k, 2) in place under straight moves of the tip from `starts` to `ends` (n, 3), in their
    order, of a flat, bull or ball end cutter.

    A column gets the height of the cutter's lower side over it, for the move's higher end, where the flutes, of this length from the tip,
    reach over its top at the lower end; under a higher one they pass.
    """
    for k in range(len(heights)):
        top = heights[k]
        for n in range(len(starts)):
            top = _top_under(top, points[k], starts[n], ends[n], radius, corner, flutes)
        heights[k] = top


@njit(cache=True, nogil=True)
def columns_cut_by_squares(
    heights: Floats,
    points: Floats,
    low: Floats,
    side: float,
    shape: Ints,
    rows: Ints,
    first: Ints,
    done: Bools,
    starts: Floats,
    ends: Floats,
    radius: float,
    corner: float,
    flutes: float,
) -> None:
    """Do as `columns_cut` does under those moves (n,) alone that are `done`, each looked for only where it comes to: in squares of a side
    from `low` (2,) on, the moves of square k are `rows` from first[k] to first[k + 1], in their order."""
    for k in range(len(heights)):
        i = min(max(int(math.floor((points[k, 0] - low[0]) / side)), 0), shape[0] - 1)
        j = min(max(int(math.floor((points[k, 1] - low[1]) / side)), 0), shape[1] - 1)
        top, square = heights[k], i * shape[1] + j
        for e in range(first[square], first[square + 1]):
            n = rows[e]
            if done[n]:
                top = _top_under(top, points[k], starts[n], ends[n], radius, corner, flutes)
        heights[k] = top


@njit(cache=True, nogil=True, inline="always")
def _top_under(
    top: float,
    point: Floats,
    start: Floats,
    end: Floats,
    radius: float,
    corner: float,
    flutes: float,
) -> float:
    """Return how high a move leaves a column at a point (2,) that is `top` high."""
    z = max(start[2], end[2])
    if top <= z or top > min(start[2], end[2]) + flutes:
        return top
    px, py = point[0] - start[0], point[1] - start[1]
    dx, dy = end[0] - start[0], end[1] - start[1]
    square = dx * dx + dy * dy
    t = min(max((px * dx + py * dy) / square, 0.0), 1.0) if square > 0.0 else 0.0
    away = math.hypot(px - t * dx, py - t * dy)
    if away > radius:
        return top
    if away > radius - corner:
        # Quarter circle of the corner: corner - sqrt(corner^2 - inner^2).
        inner = away - (radius - corner)
        z += corner - math.sqrt(max(corner * corner - inner * inner, 0.0))
    return min(top, z)


def zmap_cut_reference(
    heights: Floats,
    x0: float,
    y0: float,
    cell: float,
    starts: Floats,
    ends: Floats,
    radius: float,
    corner: float,
    flutes: float,
    gone: Floats,
) -> None:
    """Plain numpy form of `zmap_cut`: every cell for every move."""
    centres = _centres(heights, x0, y0, cell)
    for n, (a, b) in enumerate(zip(starts, ends, strict=True)):
        before = heights.copy()
        far = _distance(centres, a[:2], b[:2]) + cell * HALF_DIAGONAL
        inner = np.maximum(far - (radius - corner), 0.0)
        lift = max(a[2], b[2]) + corner - np.sqrt(np.maximum(corner**2 - inner**2, 0.0))
        cut = (far <= radius) & (heights <= min(a[2], b[2]) + flutes)
        heights[...] = np.where(cut, np.minimum(heights, lift), heights)
        gone[n] = (before - heights).sum(), ((before - heights) ** 2).sum()


def zmap_highest_reference(
    heights: Floats, x0: float, y0: float, cell: float, start: Floats, end: Floats, radius: float
) -> float:
    """Plain numpy form of `zmap_highest`."""
    is_covered = (
        _distance(_centres(heights, x0, y0, cell), start, end) < radius + cell * HALF_DIAGONAL
    )
    return float(heights[is_covered].max(initial=-np.inf))


def zmap_meets_reference(
    heights: Floats,
    top: float,
    x0: float,
    y0: float,
    cell: float,
    tips: Floats,
    rows: Floats,
    met: Bools,
) -> None:
    """Plain numpy form of `zmap_meets`: every cell for every pose and cone, whatever `top` is."""
    centres = _centres(heights, x0, y0, cell)
    for k in range(len(tips)):
        away, above = np.linalg.norm(centres - tips[k, :2], axis=-1), heights - tips[k, 2]
        met[k] = False
        for low, near, high, far in rows.tolist():
            share = np.clip((away - near) / (far - near), 0.0, 1.0) if far > near else 0.0
            met[k] |= bool(
                ((away < max(near, far)) & (above > low + share * (high - low))).any()
                if far >= near
                else ((away < near) & (above > low)).any()
            )


def columns_cut_reference(
    heights: Floats,
    points: Floats,
    starts: Floats,
    ends: Floats,
    radius: float,
    corner: float,
    flutes: float,
) -> None:
    """Plain numpy form of `columns_cut`: all columns for every move."""
    for a, b in zip(starts, ends, strict=True):
        away = _distance(points, a[:2], b[:2])
        inner = np.maximum(away - (radius - corner), 0.0)
        lift = max(a[2], b[2]) + corner - np.sqrt(np.maximum(corner**2 - inner**2, 0.0))
        reached = (away <= radius) & (heights <= min(a[2], b[2]) + flutes)
        heights[...] = np.where(reached, np.minimum(heights, lift), heights)


def _centres(heights: Floats, x0: float, y0: float, cell: float) -> Floats:
    """Return the plan centres (nx, ny, 2) of a field's cells."""
    i, j = np.meshgrid(np.arange(heights.shape[0]), np.arange(heights.shape[1]), indexing="ij")
    return np.stack([x0 + (i + 0.5) * cell, y0 + (j + 0.5) * cell], axis=-1)


def _distance(points: Floats, start: Floats, end: Floats) -> Floats:
    """Return the plan distances of points (..., 2) to a segment."""
    direction = end - start
    square = float(direction @ direction)
    t = (
        np.clip(((points - start) @ direction) / square, 0.0, 1.0)
        if square > 0.0
        else np.zeros(points.shape[:-1])
    )
    return np.linalg.norm(points - start - t[..., None] * direction, axis=-1)
