"""Compiled loops that measure how near the cutting part of a tool comes to points of the part, along moves."""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.verify.kernels.strips import MOVE_COLUMNS, Z_END, Z_START, is_sloped, move_box, part_of_move, point_distance


@njit(cache=True, nogil=True)
def signed_distance(radius: float, corner: float, rho: float, h: float) -> float:
    """Return the signed distance of a point to a cutter that is endless upwards; negative inside."""
    qx, qy = rho - (radius - corner), corner - h
    out = math.sqrt(max(qx, 0.0) * max(qx, 0.0) + max(qy, 0.0) * max(qy, 0.0))
    return out + min(max(qx, qy), 0.0) - corner


@njit(cache=True, nogil=True)
def left_by_move(x: float, y: float, z: float, move: Floats, radius: float, corner: float, flute: float, best: float, bound: float,
                 path: Floats, spans: Floats) -> float:
    """Return the smaller of `best` and the signed distance of a point to the fluted cutter along a move (ramps within `bound`)."""
    if not is_sloped(move):
        low, high = min(move[Z_START], move[Z_END]), max(move[Z_START], move[Z_END])
        reach = max(low - z, z - high - flute)
        if reach >= best:
            return best
        return min(best, max(signed_distance(radius, corner, point_distance(x, y, move), z - low), reach))
    spans[0, 0], spans[0, 1] = 0.0, 1.0
    top = 1
    while top > 0:
        top -= 1
        t0, t1 = spans[top, 0], spans[top, 1]
        low, high = part_of_move(move, t0, t1, path)
        least = max(signed_distance(radius, corner, point_distance(x, y, path), z - low), z - high - flute)
        if least >= best - bound:
            continue
        if high - low <= bound or top + 2 > len(spans):
            best = least
            continue
        middle = 0.5 * (t0 + t1)
        tip, _z = part_of_move(move, middle, middle, path)
        best = min(best, max(signed_distance(radius, corner, point_distance(x, y, path), z - tip), z - tip - flute))
        spans[top, 0], spans[top, 1] = t0, middle
        spans[top + 1, 0], spans[top + 1, 1] = middle, t1
        top += 2
    return best


@njit(cache=True, nogil=True)
def move_boxes(moves: Floats, margin: Floats) -> Floats:
    """Return the plan box of every move (n, 4), wider by a margin (n,) on every side."""
    out = np.empty((len(moves), 4))
    for n in range(len(moves)):
        x0, y0, x1, y1 = move_box(moves[n])
        out[n, 0], out[n, 1], out[n, 2], out[n, 3] = x0 - margin[n], y0 - margin[n], x1 + margin[n], y1 + margin[n]
    return out


@njit(cache=True, nogil=True)
def left_loop(first: int, last: int, points: Floats, order: Ints, moves: Floats, cutter: Floats, low: Floats, cell_start: Ints,
              cell_move: Ints, grid: Floats, shape: Ints, bound: float, left: Floats, nearest: Ints) -> None:
    """Lower `left` (s,) to the smallest signed distance of each point to the fluted cutter of the moves listed in its cell.

    order (s,) says in which order points are visited. cutter (n, 3) is radius, corner radius and flute length of each move, low (n,) its
    lowest tip, by which the lists of a cell are sorted: what comes later is higher and can't be nearer. nearest (s,) gets the move.
    """
    path, spans = np.zeros(MOVE_COLUMNS), np.zeros((96, 2))
    for k in range(first, last):
        n = order[k]
        x, y, z = points[n, 0], points[n, 1], points[n, 2]
        i, j = int(math.floor((x - grid[0]) / grid[2])), int(math.floor((y - grid[1]) / grid[2]))
        if i < 0 or j < 0 or i >= shape[0] or j >= shape[1]:
            continue
        cell = j * shape[0] + i
        best, by = left[n], -1
        for c in range(cell_start[cell], cell_start[cell + 1]):
            m = cell_move[c]
            if low[m] - z >= best:
                break
            d = left_by_move(x, y, z, moves[m], cutter[m, 0], cutter[m, 1], cutter[m, 2], best, bound, path, spans)
            if d < best:
                best, by = d, m
        left[n], nearest[n] = best, by


@njit(cache=True, nogil=True)
def is_cut(points: Floats, before: int, moves: Floats, cutter: Floats, low: Floats, cell_start: Ints, cell_move: Ints, grid: Floats,
           shape: Ints, bound: float, out: Bools) -> None:
    """Say for each point (s, 3) whether one of the moves listed in its cell with a row below `before` has removed all above it."""
    path, spans = np.zeros(MOVE_COLUMNS), np.zeros((96, 2))
    for n in range(len(points)):
        x, y, z = points[n, 0], points[n, 1], points[n, 2]
        out[n] = False
        i, j = int(math.floor((x - grid[0]) / grid[2])), int(math.floor((y - grid[1]) / grid[2]))
        if i < 0 or j < 0 or i >= shape[0] or j >= shape[1]:
            continue
        cell = j * shape[0] + i
        for c in range(cell_start[cell], cell_start[cell + 1]):
            m = cell_move[c]
            if low[m] > z:
                break
            if m < before and left_by_move(x, y, z, moves[m], cutter[m, 0], cutter[m, 1], np.inf, 1.0, bound, path, spans) <= bound:
                out[n] = True
                break
