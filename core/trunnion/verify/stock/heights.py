"""Moves run through the height field: upright cuts, each column cut exactly.

Where a rapid grazes a cell beside standing material, the cell is looked at again in columns `FINE` apart, each judged exactly against every
cut made before: a wall that a rapid enters by more than `tolerance.RAPID_DEPTH` is seen when it is entered over a strip wider than `FINE`.
"""

from __future__ import annotations

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Floats, Ints
from trunnion.geometry.frame import Frame
from trunnion.progress import Progress
from trunnion.verify.engagement import Probes
from trunnion.verify.kernels import field as kernel
from trunnion.verify.kernels import strips as columns
from trunnion.verify.motion import Moves
from trunnion.verify.profile import cones_of, profiles_of
from trunnion.verify.stock.field import Field
from trunnion.verify.stock.rays import Passed
from trunnion.verify.stock.stock import Stock
from trunnion.verify.sweep import Sweep

CHUNK_CELLS = 10_000_000
"""Columns touched between two looks at cancel, about 0.1 s."""
FINE = 0.05
"""mm, distance of the columns in a cell that a rapid grazes."""
RIMS = 200_000
"""Grazed cells looked at together."""
_RIMS_FULL, _STANDING = 1, 2


def run_heights(stock: Stock, moves: Moves, frame: Frame, sweep: Sweep | None, probes: Probes, found: Passed, share: float,
                progress: Progress) -> tuple[int, bool]:
    """Run moves given in the blank's frame through the stock's height field, up to the first that it can't follow, and note what happens.

    Returns that move's row, and whether its probes have been looked at: it has then been cut as far as heights can show.
    """
    field, n = stock.field, int(np.argmin(np.append(moves.upright, False)))
    if field is None:
        return 0, False
    depth, cell, body, removed = np.full(n, -np.inf), np.full(n, -1), np.full(n, -np.inf), np.zeros(n)
    profiles, (cones, cone_start) = profiles_of(moves.tools, moves.bodies), cones_of(moves.tools)
    work = np.cumsum(_cells_touched(moves, field.pitch))
    rims, rim_start = np.zeros(RIMS, np.int64), np.zeros(n + 1, np.int64)
    first, why = 0, 0
    while first < n and why != _STANDING:
        progress.at(first / n, "Cutting the stock")
        done = work[first - 1] if first else 0.0
        last = max(first + 1, int(np.searchsorted(work, done + CHUNK_CELLS)))
        rim_start[first] = 0
        stop, why = kernel.stock_loop(first, min(last, n), field.top, field.low[:2], field.pitch, field.low[2], field.high[2], moves.row,
                                      moves.rapid, moves.tool, profiles, moves.bodies.arc, moves.bodies.piece, cones, cone_start,
                                      tolerance.STOCK_CHORD, tolerance.RAPID_DEPTH, removed, depth, cell, body, rims, rim_start,
                                      probes.start, probes.circle, probes.rings, found.tally.counted, found.tally.spans)
        for row in range(first, stop):
            if sweep is not None and rim_start[row + 1] > rim_start[row]:
                progress.check()
                _look_closer(field, moves, stock.frame, frame, sweep, row, rims[rim_start[row]:rim_start[row + 1]], depth, found.place)
        if why == _RIMS_FULL and stop == first:
            rims = np.zeros(2 * len(rims), np.int64)
        first = stop
    for row in map(int, np.flatnonzero((depth > tolerance.RAPID_DEPTH) & (cell >= 0) & np.isnan(found.place[:n, 0]))):
        at = field.centre(int(cell[row]))
        found.place[row] = *at, moves.row[row, [columns.Z_START, columns.Z_END]].min()
    found.removed[:n] += removed * (field.pitch**2 * share)
    found.depth[:n], found.body[:n] = np.maximum(depth, 0.0), np.maximum(body, 0.0)
    return first, why == _STANDING


def _cells_touched(moves: Moves, pitch: float) -> Floats:
    radius = moves.cutters[:, 0]
    return (2 * radius * moves.length + np.pi * radius**2) / pitch**2 + 1000.0


def _look_closer(field: Field, moves: Moves, own: Frame, frame: Frame, sweep: Sweep, row: int, cells: Ints, depth: Floats,
                 place: Floats) -> None:
    """Judge the grazed cells of a rapid by fine columns, each exactly against every cut before it."""
    allowed, move = tolerance.RAPID_DEPTH, moves.row[row]
    radius, corner, _ = moves.cutters[row]
    count = max(1, round(field.pitch / FINE))
    offsets = ((np.arange(count) + 0.5) / count - 0.5) * field.pitch
    grid = np.stack(np.meshgrid(offsets, offsets), axis=-1).reshape(-1, 2)
    down, across = np.divmod(cells, field.top.shape[1])
    points = (field.low[:2] + (np.column_stack([across, down]) + 0.5) * field.pitch)[:, None] + grid
    points = points.reshape(-1, 2)
    start, end = (move[[getattr(columns, name) for name in names]] for names in (("X0", "Y0", "Z_START"), ("X1", "Y1", "Z_END")))
    along = end[:2] - start[:2]
    share = np.clip((points - start[:2]) @ along / max(along @ along, tolerance.PARAMETRIC), 0.0, 1.0)
    rho = np.linalg.norm(points - start[:2] - share[:, None] * along, axis=1)
    inside = rho < radius - allowed
    if not inside.any():
        return
    points, rho, share = points[inside], rho[inside], share[inside]
    # The cutter made smaller by what is allowed: what it still meets, the rapid enters deeper than that.
    out = np.clip(rho - (radius - corner), 0.0, None)
    small = max(corner - allowed, 0.0)
    upright = not along.any()
    tip = np.minimum(start[2], end[2]) if upright else start[2] + share * (end[2] - start[2])
    z = tip + allowed + small - np.sqrt(np.clip(small**2 - out**2, 0.0, None))
    places = np.column_stack([points, z])
    material = ((places < field.high) & (places >= field.low)).all(axis=1)
    standing = material & ~sweep.cut_before(frame.to_local(own.to_world(places)), row)
    if standing.any():
        k = int(np.flatnonzero(standing)[np.argmin(rho[standing])])
        depth[row] = max(depth[row], float(radius - rho[k]))
        place[row] = places[k]
