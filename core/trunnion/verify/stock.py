"""What is left, and what does the cutter do on the way? One bundle of z columns over the blank.

Columns stand at cell centres and are cut exactly there. Where a rapid grazes a cell beside standing material, the cell is looked at again
in columns `FINE` apart, each judged exactly against every cut made before: a wall that a rapid enters by more than
`tolerance.RAPID_DEPTH` is seen when it is entered over a strip wider than `FINE`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trunnion import tolerance
from trunnion.findings import OutOfMemory
from trunnion.geometry.arrays import Floats, Ints
from trunnion.geometry.frame import Frame
from trunnion.model.blank import Blank
from trunnion.progress import QUIET, Progress
from trunnion.verify.kernels import strips as contact_kernel
from trunnion.verify.kernels import field as kernel
from trunnion.verify.motion import Moves
from trunnion.verify.sweep import Sweep

CHUNK_CELLS = 10_000_000
"""Columns touched between two looks at cancel, about 0.1 s."""
CHORD = 2e-3
"""Chord error of helices in the field, mm; levels and arcs have none."""
FINE = 0.05
"""mm, distance of the columns in a cell that a rapid grazes."""
MOST_CELLS = 100_000_000
"""Most columns of a field: 800 MB."""
RIMS = 200_000
"""Grazed cells looked at together."""


@dataclass(frozen=True, slots=True, eq=False)
class Field:
    """Heights of columns in a setup frame: top (rows, columns) mm, cells of `pitch` from the blank's corner `low` (3,)
    up to `high` (3,)."""

    top: Floats
    pitch: float
    low: Floats
    high: Floats

    @staticmethod
    def of(blank: Blank, frame: Frame, pitch: float) -> Field:
        """Return the blank as a field in a setup frame; raise `OutOfMemory` when it would need too many columns."""
        low, high = blank_box(blank, frame)
        columns, rows = (int(max(1, np.ceil(s / pitch - tolerance.PARAMETRIC))) for s in (high - low)[:2])
        if rows * columns > MOST_CELLS:
            least = float(np.sqrt(np.prod((high - low)[:2]) / MOST_CELLS))
            raise OutOfMemory(f"stock at cells of {pitch:g} mm would need {rows * columns / 1e6:.0f} million columns "
                              f"({rows * columns * 8 / 1e6:.0f} MB): choose verify.cell of at least {least:.2f} mm")
        return Field(np.full((rows, columns), high[2]), pitch, low, high)

    @property
    def volume(self) -> float:
        """Volume in mm3, by the columns."""
        return float((self.top - self.low[2]).sum()) * self.pitch**2

    def centre(self, cell: int) -> Floats:
        """Return the plan centre (2,) of a cell by its flat index."""
        row, column = divmod(cell, self.top.shape[1])
        return self.low[:2] + (np.array([column, row]) + 0.5) * self.pitch


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class StockRun:
    """What happened on the way, a row a move.

    removed (n,) mm3; rapid_depth (n,) how deep a rapid goes into stock, 0 when clear; rapid_place (n, 3), NaN when clear; body_depth (n,)
    how deep shank or holder enter stock. field: what is left.
    """

    removed: Floats
    rapid_depth: Floats
    rapid_place: Floats
    body_depth: Floats
    field: Field


def blank_box(blank: Blank, frame: Frame) -> tuple[Floats, Floats]:
    """Return the lowest and highest corner of a blank's box in a frame (of a frame turned by other than right angles: of its hull)."""
    corners = np.array([[x, y, z] for x in (blank.low[0], blank.high[0]) for y in (blank.low[1], blank.high[1])
                        for z in (blank.low[2], blank.high[2])])
    local = frame.to_local(blank.frame.to_world(corners))
    return local.min(axis=0), local.max(axis=0)


def run_stock(field: Field, moves: Moves, sweep: Sweep, progress: Progress = QUIET) -> StockRun:
    """Cut a setup's moves out of a field (changed in place) and say what each did."""
    n = len(moves)
    removed, depth, cell, body = np.zeros(n), np.full(n, -np.inf), np.full(n, -1), np.full(n, -np.inf)
    place = np.full((n, 3), np.nan)
    bodies, body_start = _bodies(moves)
    work = np.cumsum(_cells_touched(moves, field.pitch))
    rims, rim_start = np.zeros(RIMS, np.int64), np.zeros(n + 1, np.int64)
    first = 0
    while first < n:
        progress.at(first / n, "Cutting the stock")
        done = work[first - 1] if first else 0.0
        last = max(first + 1, int(np.searchsorted(work, done + CHUNK_CELLS)))
        rim_start[first] = 0
        stop = kernel.stock_loop(first, min(last, n), field.top, field.low[:2], field.pitch, field.low[2], field.high[2], moves.row,
                                 moves.rapid, moves.cutters, bodies, body_start, moves.tool, CHORD, tolerance.RAPID_DEPTH, removed,
                                 depth, cell, body, rims, rim_start)
        for row in range(first, stop):
            if rim_start[row + 1] > rim_start[row]:
                progress.check()
                _look_closer(field, moves, sweep, row, rims[rim_start[row]:rim_start[row + 1]], depth, place)
        if stop == first:
            rims = np.zeros(2 * len(rims), np.int64)
        first = stop
    for row in map(int, np.flatnonzero((depth > tolerance.RAPID_DEPTH) & (cell >= 0) & np.isnan(place[:, 0]))):
        at = field.centre(int(cell[row]))
        place[row] = *at, moves.row[row, [contact_kernel.Z_START, contact_kernel.Z_END]].min()
    return StockRun(removed=removed * field.pitch**2, rapid_depth=np.where(depth > tolerance.RAPID_DEPTH, depth, 0.0), rapid_place=place,
                    body_depth=np.maximum(body, 0.0), field=field)


def _bodies(moves: Moves) -> tuple[Floats, Ints]:
    """Return what is above the flutes of every tool, and where each tool's begins."""
    parts = [moves.pieces[a + 1:b] for a, b in zip(moves.piece_start[:-1], moves.piece_start[1:], strict=True)]
    return np.vstack([np.zeros((0, moves.pieces.shape[1])), *parts]), np.cumsum([0, *(len(p) for p in parts)])


def _cells_touched(moves: Moves, pitch: float) -> Floats:
    radius = moves.cutters[:, 0]
    return (2 * radius * moves.length + np.pi * radius**2) / pitch**2 + 1000.0


def _look_closer(field: Field, moves: Moves, sweep: Sweep, row: int, cells: Ints, depth: Floats, place: Floats) -> None:
    """Judge the grazed cells of a rapid by fine columns, each exactly against every cut before it."""
    allowed, move = tolerance.RAPID_DEPTH, moves.row[row]
    radius, corner, _ = moves.cutters[row]
    count = max(1, round(field.pitch / FINE))
    offsets = ((np.arange(count) + 0.5) / count - 0.5) * field.pitch
    grid = np.stack(np.meshgrid(offsets, offsets), axis=-1).reshape(-1, 2)
    rows, columns = np.divmod(cells, field.top.shape[1])
    points = (field.low[:2] + (np.column_stack([columns, rows]) + 0.5) * field.pitch)[:, None] + grid
    points = points.reshape(-1, 2)
    start, end = move[[contact_kernel.X0, contact_kernel.Y0, contact_kernel.Z_START]], move[[contact_kernel.X1, contact_kernel.Y1,
                                                                                            contact_kernel.Z_END]]
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
    standing = material & ~sweep.cut_before(places, row)
    if standing.any():
        k = int(np.flatnonzero(standing)[np.argmin(rho[standing])])
        depth[row] = max(depth[row], float(radius - rho[k]))
        place[row] = places[k]
