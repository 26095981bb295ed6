"""A closer look at what rapids graze between rays, judged exactly against every cut made before.

A wall or edge that a rapid enters by more than `tolerance.RAPID_DEPTH` is seen when it is entered over a strip wider than the rays looked
at are apart: `FINE`, or a tenth of a cell.
"""

from __future__ import annotations

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.frame import Frame
from trunnion.progress import Progress
from trunnion.verify.cutter import lowest_height
from trunnion.verify.finish.sweep import Sweep
from trunnion.verify.kernels import strips as columns
from trunnion.verify.motion import Moves
from trunnion.verify.stock.field import Field
from trunnion.verify.stock.rays import Passed
from trunnion.verify.stock.stock import Stock

FINE = 0.05
"""mm, distance of the rays in a cell that a rapid grazes."""
MOST_FINE = 10
"""Most of them along a side of a cell."""


def rays_in_cell(pitch: float) -> int:
    """Return how many rays stand along each side of a cell that is looked at closely."""
    return int(np.clip(round(pitch / FINE), 1, MOST_FINE))


def confirm_grazed(stock: Stock, found: Passed, frame: Frame, sweep: Sweep, progress: Progress) -> None:
    """Note the rapids that are in material at a place between rays, where no cut before has been."""
    if not found.grazed:
        return
    moves, places = np.concatenate([m for m, _ in found.grazed]), np.vstack([p for _, p in found.grazed])
    for row in np.unique(moves):
        progress.check()
        own = places[moves == row]
        standing = _standing(stock, own[:, :3], frame, sweep, int(row))
        if standing.any():
            k = int(np.argmax(np.where(standing, own[:, 3], -np.inf)))
            if own[k, 3] > found.depth[row]:
                found.depth[row], found.place[row] = own[k, 3], own[k, :3]


def _standing(stock: Stock, places: Floats, frame: Frame, sweep: Sweep, row: int) -> Bools:
    """Say which places (k, 3) in the blank's frame neither a setup before nor a move before `row` has cut."""
    world = stock.frame.to_world(places)
    standing = np.asarray(((places > stock.blank.low) & (places < stock.blank.high)).all(axis=1))
    standing &= ~sweep.cut_before(frame.to_local(world), row)
    for before, own in stock.cut_by:
        standing &= ~before.cut_before(own.to_local(world), len(before.moves))
    return standing


def look_closer(stock: Stock, field: Field, moves: Moves, frame: Frame, sweep: Sweep, row: int, cells: Ints, depth: Floats,
                place: Floats) -> None:
    """Judge the cells of a height field that an upright rapid grazes by fine columns."""
    allowed, move, tool = tolerance.RAPID_DEPTH, moves.row[row], moves.tools[moves.tool[row]]
    radius = tool.radius
    count = rays_in_cell(field.pitch)
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
    tip = np.minimum(start[2], end[2]) if not along.any() else start[2] + share * (end[2] - start[2])
    # The cutter made smaller by what is allowed: what it still meets, the rapid enters deeper than that.
    places = np.column_stack([points, tip + lowest_height(tool, rho + allowed) + allowed])
    standing = _standing(stock, places, frame, sweep, row)
    if standing.any():
        k = int(np.flatnonzero(standing)[np.argmin(rho[standing])])
        depth[row] = max(depth[row], float(radius - rho[k]))
        place[row] = places[k]
