"""Which places lie within closed outlines of many short pieces, and which lie so near to one that it can't be told from the pieces."""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from trunnion.geometry.arrays import Floats, Ints

OUT, IN, NEAR = 0, 1, 2


def within(places: Floats, pieces: Floats, near: float) -> Ints:
    """Return OUT, IN or NEAR (k,) for places (k, 2) and pieces (s, 4) from x, y to x, y that close.

    Inside, a line to the right crosses an odd number of pieces.
    """
    out = np.empty(len(places), np.int64)
    for k, (x, y) in enumerate(places):
        ax, ay, bx, by = pieces.T
        square = (bx - ax) ** 2 + (by - ay) ** 2
        share = np.divide((x - ax) * (bx - ax) + (y - ay) * (by - ay), square, out=np.zeros(len(pieces)), where=square > 0.0).clip(0.0, 1.0)
        if (np.hypot(ax + share * (bx - ax) - x, ay + share * (by - ay) - y) <= near).any():
            out[k] = NEAR
            continue
        beside = (ay > y) != (by > y)
        at = ax[beside] + (y - ay[beside]) / (by - ay)[beside] * (bx - ax)[beside]
        out[k] = IN if (at > x).sum() % 2 else OUT
    return out


@njit(cache=True, nogil=True)
def within_loop(places: Floats, pieces: Floats, near: float, low: float, pitch: float, start: Ints, rows: Ints, out: Ints) -> None:
    """Fill `out` with what `within` returns.

    Strip i, from `low + i pitch` in y, lists the pieces that come within `near` of it from start[i] on.
    """
    for n in range(len(places)):
        x, y = places[n, 0], places[n, 1]
        out[n] = OUT
        strip = int(math.floor((y - low) / pitch))
        if strip < 0 or strip >= len(start) - 1:
            continue
        for c in range(start[strip], start[strip + 1]):
            ax, ay, bx, by = pieces[rows[c], 0], pieces[rows[c], 1], pieces[rows[c], 2], pieces[rows[c], 3]
            if (ay > y) != (by > y) and ax + (y - ay) / (by - ay) * (bx - ax) > x:
                out[n] = IN - out[n]
            if min(ax, bx) - near > x or max(ax, bx) + near < x or min(ay, by) - near > y or max(ay, by) + near < y:
                continue
            square = (bx - ax) * (bx - ax) + (by - ay) * (by - ay)
            share = 0.0
            if square > 0.0:
                share = min(max(((x - ax) * (bx - ax) + (y - ay) * (by - ay)) / square, 0.0), 1.0)
            if math.hypot(ax + share * (bx - ax) - x, ay + share * (by - ay) - y) <= near:
                out[n] = NEAR
                break
