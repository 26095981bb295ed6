"""A closer look at what rapids graze between rays, judged exactly against every cut made before.

A wall or edge that a rapid enters by more than `tolerance.RAPID_DEPTH` is seen when it is entered over a strip wider than the rays looked
at are apart: `FINE`, or a tenth of a cell.
"""

from __future__ import annotations

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.frame import Frame
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.verify.cutter import lowest_height
from trunnion.verify.finish.sweep import Sweep
from trunnion.verify.kernels.contact import strips as columns
from trunnion.verify.motion import Moves
from trunnion.verify.stock.field import Field
from trunnion.verify.stock.rays import Passed
from trunnion.verify.stock.stock import Stock

FINE = 0.05
"""mm, distance of the rays in a cell that a rapid grazes."""
BLOCKS = (2.0, 0.5)
"""mm, about: widths of the blocks of cells that are asked about before single cells."""
MOST_FINE = 10
"""Most of them along a side of a cell."""
SHARES = 17
"""Positions of a sloped rapid at which it is held against a column."""


def rays_in_cell(pitch: float) -> int:
    """Return how many rays stand along each side of a cell that is looked at closely."""
    return int(np.clip(round(pitch / FINE), 1, MOST_FINE))


def confirm_grazed(
    stock: Stock,
    found: Passed,
    frame: Frame,
    sweep: Sweep,
    progress: Progress = NO_PROGRESS,
    threads: int = 0,
) -> None:
    """Note the rapids that are in material at a position between rays, where no cut before has been: the deepest of each."""
    if not found.grazed:
        return
    rows = np.concatenate([m for m, _ in found.grazed])
    positions = np.vstack([p for _, p in found.grazed])
    # All positions are asked for at once: thousands of rapids go by a few places each.
    deeper = np.flatnonzero(positions[:, 3] > found.depth[rows])
    uncut = deeper[
        _in_material(stock, positions[deeper, :3], frame, sweep, rows[deeper], progress, threads)
    ]
    order = uncut[np.lexsort((-positions[uncut, 3], rows[uncut]))]
    rapids, first = np.unique(rows[order], return_index=True)
    found.depth[rapids] = positions[order[first], 3]
    found.position[rapids] = positions[order[first], :3]


def _in_material(
    stock: Stock,
    positions: Floats,
    frame: Frame,
    sweep: Sweep,
    row: int | Ints,
    progress: Progress = NO_PROGRESS,
    threads: int = 0,
) -> Bools:
    """Return which positions (k, 3) in the blank's frame neither a setup before nor a move before `row` (one for all, or (k,)) has cut."""
    in_material = stock.was_solid(positions)
    world = stock.frame.to_world(positions)
    row = np.broadcast_to(row, len(positions))
    sweeps = [(sweep, frame, row)]
    sweeps += [(s, f, np.full(len(positions), len(s.moves))) for s, f in stock.cut_by]
    for k, (before, own, last) in enumerate(sweeps):
        doubtful = np.flatnonzero(in_material)
        in_material[doubtful] = ~before.cut_before(
            own.to_local(world[doubtful]),
            last[doubtful],
            progress.part(k / len(sweeps), (k + 1) / len(sweeps)),
            threads,
        )
    return in_material


def recheck(
    stock: Stock,
    field: Field,
    moves: Moves,
    frame: Frame,
    sweep: Sweep,
    row: int,
    cells: Ints,
    depth: Floats,
    position: Floats,
) -> None:
    """Judge the cells of a height field that an upright rapid grazes by fine columns; those below zero encode -1 - cell, where the
    columns around are gone too and only a fin between them can stand."""
    fins = cells < 0
    cells = np.where(fins, -1 - cells, cells)
    index = np.column_stack(np.divmod(cells, field.top.shape[1])[::-1])
    open_ = np.zeros(len(cells), dtype=bool)
    # Most of what a rapid passes is open far around: blocks of cells are asked about first.
    for size in sorted({max(round(b / field.pitch), 1) for b in BLOCKS} | {1}, reverse=True):
        doubtful = np.flatnonzero(~open_)
        blocks, of = np.unique(index[doubtful] // size, axis=0, return_inverse=True)
        width = size * field.pitch
        low = _positions(moves, row, field.low[:2] + (blocks + 0.5) * width, width * np.sqrt(0.5))[
            0
        ]
        open_[doubtful] = _cut_around(stock, low, width * np.sqrt(0.5), frame, sweep, row)[of]
    middle = field.low[:2] + (index + 0.5) * field.pitch
    count = rays_in_cell(field.pitch)
    offsets = ((np.arange(count) + 0.5) / count - 0.5) * field.pitch
    grid = np.stack(np.meshgrid(offsets, offsets), axis=-1).reshape(-1, 2)
    # A fin that goes through a cell crosses one of its middle lines, or one of its neighbour's.
    cross = np.vstack(
        [np.column_stack([offsets, 0.0 * offsets]), np.column_stack([0.0 * offsets, offsets])]
    )
    points = np.vstack(
        [
            (middle[~open_ & ~fins][:, None] + grid).reshape(-1, 2),
            (middle[~open_ & fins][:, None] + cross).reshape(-1, 2),
        ]
    )
    positions, rho = _positions(moves, row, points, 0.0)
    inside = np.isfinite(positions[:, 2])
    if not inside.any():
        return
    positions, rho = positions[inside], rho[inside]
    in_material = _in_material(stock, positions, frame, sweep, row)
    if in_material.any():
        k = int(np.flatnonzero(in_material)[np.argmin(rho[in_material])])
        depth[row] = max(depth[row], float(moves.tools[moves.tool[row]].core_radius - rho[k]))
        position[row] = positions[k]


def _positions(moves: Moves, row: int, points: Floats, around: float) -> tuple[Floats, Floats]:
    """Return the lowest position over each plan point (k, 2) that an upright rapid enters by more than is allowed, or at most as high as
    any such position within `around` mm of it, and the point's distance from its path; infinite where it enters nothing."""
    allowed, move, tool = tolerance.RAPID_DEPTH, moves.row[row], moves.tools[moves.tool[row]]
    start, end = (
        move[[getattr(columns, name) for name in names]]
        for names in (("X0", "Y0", "Z_START"), ("X1", "Y1", "Z_END"))
    )
    along = end[:2] - start[:2]
    length = float(np.linalg.norm(along))
    nearest = np.clip((points - start[:2]) @ along / max(length**2, tolerance.PARAMETRIC), 0.0, 1.0)
    least = np.linalg.norm(points - start[:2] - nearest[:, None] * along, axis=1)
    lowest = np.full(len(points), np.inf)
    sloped = length > 0.0 and start[2] != end[2]
    # On a slope the point is met all the while it is under the cutter, lowest nearly at the end of that.
    reach = np.sqrt(np.maximum((tool.core_radius + around) ** 2 - least**2, 0.0)) / max(
        length, tolerance.PARAMETRIC
    )
    for step in np.linspace(-1.0, 1.0, SHARES) if sloped else [0.0]:
        share = np.clip(nearest + step * reach, 0.0, 1.0)
        rho = np.maximum(
            np.linalg.norm(points - start[:2] - share[:, None] * along, axis=1) - around, 0.0
        )
        tip = start[2] + share * (end[2] - start[2]) if length > 0.0 else min(start[2], end[2])
        # The cutter made smaller by what is allowed: what it still meets, the rapid enters deeper than that.
        height = tip + lowest_height(tool, rho + allowed) + allowed
        lowest = np.minimum(lowest, np.where(rho < tool.core_radius - allowed, height, np.inf))
    if sloped and around > 0.0:
        lowest = lowest - abs(end[2] - start[2]) * np.minimum(
            (around + tool.core_radius / (SHARES - 1)) / length, 1.0
        )
    return np.column_stack([points, lowest]), least


def _cut_around(
    stock: Stock, positions: Floats, margin: float, frame: Frame, sweep: Sweep, row: int
) -> Bools:
    """Say around which positions (k, 3) in the blank's frame all within a margin in plan is gone, as far as single moves show that."""
    gone = ~np.isfinite(positions[:, 2])
    for before, own, last in [
        (sweep, frame, row),
        *((s, f, len(s.moves)) for s, f in stock.cut_by),
    ]:
        # What a setup calls plan must be the blank's.
        if own.z @ stock.frame.z > 1.0 - tolerance.PARAMETRIC:
            doubtful = np.flatnonzero(~gone)
            gone[doubtful] = before.cut_around(
                own.to_local(stock.frame.to_world(positions[doubtful])), margin, last
            )
    return gone
