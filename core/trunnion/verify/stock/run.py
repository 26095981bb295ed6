"""What is left, and what does the cutter do on the way? One bundle of z columns over the blank.

Columns stand at cell centres and are cut exactly there. Where a rapid grazes a cell beside standing material, the cell is looked at again
in columns `FINE` apart, each judged exactly against every cut made before: a wall that a rapid enters by more than
`tolerance.RAPID_DEPTH` is seen when it is entered over a strip wider than `FINE`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trunnion import tolerance
from trunnion.findings import BadInput
from trunnion.geometry.arrays import Floats, Ints
from trunnion.geometry.frame import Frame
from trunnion.progress import QUIET, Progress
from trunnion.verify.engagement import Tally, engagement_of, probes_of
from trunnion.verify.kernels import field as kernel
from trunnion.verify.kernels import strips as columns
from trunnion.verify.motion import Moves, seen_from
from trunnion.verify.profile import cones_of, profiles_of
from trunnion.verify.stock.stock import Stock
from trunnion.verify.sweep import Sweep

CHUNK_CELLS = 10_000_000
"""Columns touched between two looks at cancel, about 0.1 s."""
CHORD = 2e-3
"""Chord error of helices in the field, mm; levels and arcs have none."""
FINE = 0.05
"""mm, distance of the columns in a cell that a rapid grazes."""
RIMS = 200_000
"""Grazed cells looked at together."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class StockRun:
    """What happened on the way, a row a move.

    removed (n,) mm3; rapid_depth (n,) how deep a rapid goes into stock, 0 when clear; rapid_place (n, 3) in the setup frame, NaN when
    clear; body_depth (n,) how deep shank or holder enter stock; engagement (n,) rad, the largest angle of the cutter's circumference in
    material along a feed move, and depth_of_cut (n,) mm along the axis, both 0 for rapids.
    """

    removed: Floats
    rapid_depth: Floats
    rapid_place: Floats
    body_depth: Floats
    engagement: Floats
    depth_of_cut: Floats


def run_stock(stock: Stock, moves: Moves, frame: Frame, sweep: Sweep | None = None, progress: Progress = QUIET,
              threads: int = 0) -> StockRun:
    """Cut moves given in a setup frame out of the stock (changed in place) and say what each did.

    `sweep` of the same moves answers for rapids that graze material between rays; without it they are judged by the rays alone.
    `threads` 0: one a core; the result is the same for any number.
    """
    local = seen_from(moves, frame, stock.frame)
    if not local.upright.all():
        raise BadInput("the stock is cut along the blank's z axis only")
    field = stock.field
    n = len(moves)
    removed, depth, cell, body = np.zeros(n), np.full(n, -np.inf), np.full(n, -1), np.full(n, -np.inf)
    place = np.full((n, 3), np.nan)
    profiles, (cones, cone_start), probes = profiles_of(moves.tools, moves.bodies), cones_of(moves.tools), probes_of(moves)
    profiles[:, kernel.OPEN] = np.inf
    tally = Tally.empty(int(probes.start[-1]))
    work = np.cumsum(_cells_touched(moves, field.pitch))
    rims, rim_start = np.zeros(RIMS, np.int64), np.zeros(n + 1, np.int64)
    first = 0
    while first < n:
        progress.at(first / n, "Cutting the stock")
        done = work[first - 1] if first else 0.0
        last = max(first + 1, int(np.searchsorted(work, done + CHUNK_CELLS)))
        rim_start[first] = 0
        stop, _ = kernel.stock_loop(first, min(last, n), field.top, field.low[:2], field.pitch, field.low[2], field.high[2], local.row,
                                    moves.rapid, moves.tool, profiles, moves.bodies.arc, moves.bodies.piece, cones, cone_start, CHORD,
                                    tolerance.RAPID_DEPTH, removed, depth, cell, body, rims, rim_start, probes.start, probes.circle,
                                    probes.rings, tally.counted, tally.spans)
        for row in range(first, stop):
            if sweep is not None and rim_start[row + 1] > rim_start[row]:
                progress.check()
                _look_closer(stock, local, frame, sweep, row, rims[rim_start[row]:rim_start[row + 1]], depth, place)
        if stop == first:
            rims = np.zeros(2 * len(rims), np.int64)
        first = stop
    for row in map(int, np.flatnonzero((depth > tolerance.RAPID_DEPTH) & (cell >= 0) & np.isnan(place[:, 0]))):
        at = field.centre(int(cell[row]))
        place[row] = *at, local.row[row, [columns.Z_START, columns.Z_END]].min()
    engaged = engagement_of(probes, tally, moves)
    return StockRun(removed=removed * field.pitch**2, rapid_depth=np.where(depth > tolerance.RAPID_DEPTH, depth, 0.0),
                    rapid_place=frame.to_local(stock.frame.to_world(place)), body_depth=np.maximum(body, 0.0), engagement=engaged.largest,
                    depth_of_cut=engaged.depth)


def _cells_touched(moves: Moves, pitch: float) -> Floats:
    radius = moves.cutters[:, 0]
    return (2 * radius * moves.length + np.pi * radius**2) / pitch**2 + 1000.0


def _look_closer(stock: Stock, moves: Moves, frame: Frame, sweep: Sweep, row: int, cells: Ints, depth: Floats, place: Floats) -> None:
    """Judge the grazed cells of a rapid by fine columns, each exactly against every cut before it."""
    allowed, move, field = tolerance.RAPID_DEPTH, moves.row[row], stock.field
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
    standing = material & ~sweep.cut_before(frame.to_local(stock.frame.to_world(places)), row)
    if standing.any():
        k = int(np.flatnonzero(standing)[np.argmin(rho[standing])])
        depth[row] = max(depth[row], float(radius - rho[k]))
        place[row] = places[k]
