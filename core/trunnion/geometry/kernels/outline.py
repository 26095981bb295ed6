"""Point in polygon by ray crossing, with a third result for points too near to the boundary; compiled
with a strip index.

Outlines are closed chains of short chords that represent curves; within `near` of them the chords
can't distinguish inside from outside. Plain reference `points_in_polygon`. mm.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from trunnion.geometry.arrays import Floats, Ints

OUT, IN, NEAR = 0, 1, 2


def points_in_polygon(positions: Floats, pieces: Floats, near: float) -> Ints:
    """Return OUT, IN or NEAR (k,) for positions (k, 2) and chords (s, 4), from x, y to x, y, that close.

    Inside, a ray towards +x crosses an odd number of chords.
    """
    out = np.empty(len(positions), np.int64)
    for k, (x, y) in enumerate(positions):
        ax, ay, bx, by = pieces.T
        square = (bx - ax) ** 2 + (by - ay) ** 2
        share = np.divide(
            (x - ax) * (bx - ax) + (y - ay) * (by - ay),
            square,
            out=np.zeros(len(pieces)),
            where=square > 0.0,
        ).clip(0.0, 1.0)
        # Nearest point of any chord within `near`.
        if (np.hypot(ax + share * (bx - ax) - x, ay + share * (by - ay) - y) <= near).any():
            out[k] = NEAR
            continue
        # Chords whose ends lie on different sides of the ray, and those of them that cross it to
        # the right.
        straddles = (ay > y) != (by > y)
        at = ax[straddles] + (y - ay[straddles]) / (by - ay)[straddles] * (bx - ax)[straddles]
        out[k] = IN if (at > x).sum() % 2 else OUT
    return out


@njit(cache=True, nogil=True)
def points_in_polygon_loop(
    positions: Floats,
    pieces: Floats,
    near: float,
    low: float,
    pitch: float,
    start: Ints,
    rows: Ints,
    out: Ints,
) -> None:
    """Fill out (k,) with what `points_in_polygon` returns.

    Strip i, from `low + i pitch` in y, lists in rows, from start[i] on, the chords that come within
    `near` of it; positions beyond all strips are OUT.
    """
    for n in range(len(positions)):
        x, y = positions[n, 0], positions[n, 1]
        out[n] = OUT
        strip = int(math.floor((y - low) / pitch))
        if strip < 0 or strip >= len(start) - 1:
            continue
        for c in range(start[strip], start[strip + 1]):
            ax, ay, bx, by = (
                pieces[rows[c], 0],
                pieces[rows[c], 1],
                pieces[rows[c], 2],
                pieces[rows[c], 3],
            )
            # Parity of crossings towards +x; a chord is listed in every strip it passes, and this
            # position reads one.
            if (ay > y) != (by > y) and ax + (y - ay) / (by - ay) * (bx - ax) > x:
                out[n] = IN - out[n]
            # Only chords whose box is within `near` can be too near.
            if (
                min(ax, bx) - near > x
                or max(ax, bx) + near < x
                or min(ay, by) - near > y
                or max(ay, by) + near < y
            ):
                continue
            square = (bx - ax) * (bx - ax) + (by - ay) * (by - ay)
            share = 0.0
            if square > 0.0:
                share = min(max(((x - ax) * (bx - ax) + (y - ay) * (by - ay)) / square, 0.0), 1.0)
            if math.hypot(ax + share * (bx - ax) - x, ay + share * (by - ay) - y) <= near:
                out[n] = NEAR
                break
