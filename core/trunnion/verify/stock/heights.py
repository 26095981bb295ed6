"""Moves run through the height field: upright cuts, each column cut exactly."""

from __future__ import annotations

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Floats
from trunnion.geometry.frame import Frame
from trunnion.progress import Progress
from trunnion.verify.finish.sweep import Sweep
from trunnion.verify.kernels.contact import strips as columns
from trunnion.verify.kernels.stock import zmap as kernel
from trunnion.verify.motion import Moves
from trunnion.verify.profile import cones_of, profiles_of
from trunnion.verify.stock.engagement import Probes
from trunnion.verify.stock.graze_check import recheck
from trunnion.verify.stock.rays import Passed
from trunnion.verify.stock.stock import Stock

CHUNK_CELLS = 10_000_000
"""Columns touched between two looks at cancel, about 0.1 s."""
RIMS = 200_000
"""Grazed cells looked at together."""
_RIMS_FULL, _UNCUT = 1, 2


def run_heights(
    stock: Stock,
    moves: Moves,
    frame: Frame,
    sweep: Sweep | None,
    probes: Probes,
    found: Passed,
    progress: Progress,
) -> tuple[int, bool]:
    """Run moves given in the blank's frame through the stock's height field, up to the first that it can't follow, and note what happens.

    Returns that move's row, and whether its probes have been looked at: it has then been cut as far as heights can show.
    """
    field, n = stock.field, int(np.argmin(np.append(moves.upright, False)))
    if field is None:
        return 0, False
    depth, cell, body, removed = (
        np.full(n, -np.inf),
        np.full(n, -1),
        np.full(n, -np.inf),
        np.zeros(n),
    )
    profiles, (cones, cone_start) = profiles_of(moves.tools, moves.bodies), cones_of(moves.tools)
    work = np.cumsum(_cell_counts(moves, field.pitch))
    rims, rim_start = np.zeros(RIMS, np.int64), np.zeros(n + 1, np.int64)
    first, why = 0, 0
    while first < n and why != _UNCUT:
        progress.at(first / n, "Cutting the stock")
        done = work[first - 1] if first else 0.0
        last = max(first + 1, int(np.searchsorted(work, done + CHUNK_CELLS)))
        rim_start[first] = 0
        stop, why = kernel.zmap_cut_loop(
            first,
            min(last, n),
            field.top,
            field.low[:2],
            field.pitch,
            field.low[2],
            field.high[2],
            moves.row,
            moves.rapid,
            moves.tool,
            profiles,
            moves.bodies.arc,
            moves.bodies.piece,
            cones,
            cone_start,
            tolerance.STOCK_CHORD,
            tolerance.RAPID_DEPTH,
            removed,
            depth,
            cell,
            body,
            rims,
            rim_start,
            probes.start,
            probes.circle,
            probes.rings,
            found.tally.counted,
            found.tally.spans,
        )
        for row in range(first, stop):
            if sweep is not None and rim_start[row + 1] > rim_start[row]:
                progress.check()
                recheck(
                    stock,
                    field,
                    moves,
                    frame,
                    sweep,
                    row,
                    rims[rim_start[row] : rim_start[row + 1]],
                    depth,
                    found.position,
                )
        if why == _RIMS_FULL and stop == first:
            rims = np.zeros(2 * len(rims), np.int64)
        first = stop
    for row in map(
        int,
        np.flatnonzero(
            (depth > tolerance.RAPID_DEPTH) & (cell >= 0) & np.isnan(found.position[:n, 0])
        ),
    ):
        at = field.centre(int(cell[row]))
        found.position[row] = *at, moves.row[row, [columns.Z_START, columns.Z_END]].min()
    found.removed[:n] += removed * (field.pitch**2 / len(stock.bundles))
    found.depth[:n], found.body[:n] = np.maximum(depth, 0.0), np.maximum(body, 0.0)
    return first, why == _UNCUT


def _cell_counts(moves: Moves, pitch: float) -> Floats:
    radius = moves.cutters[:, 0]
    return (2 * radius * moves.length + np.pi * radius**2) / pitch**2 + 1000.0
