"""Passes of an upright tool without what its neck, shank or holder would meet stock on.

Roughing can't come everywhere: beside what it left a slender cutter may still touch the faces, with its flutes deep below the top of it.
The planner's field of heights is higher than the stock: round every cut by a part of a cell, and by more beside walls, where cells are
never cut whole. Positions where that is in the way are looked at again, in finer cells and more closely (`body_stock.py`).
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from scipy.ndimage import maximum_filter

from trunnion.findings import Finding, warning
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.kernels import heightfield
from trunnion.model.tool import Tool
from trunnion.plan.freeform.cutters.cutter import level_disc
from trunnion.plan.freeform.drive import SurfaceDrive
from trunnion.progress import Progress
from trunnion.toolpath.contact_passes.choices import IN_STOCK
from trunnion.toolpath.contact_passes.linking.parameters import PassStock
from trunnion.toolpath.contact_passes.passes import Pass
from trunnion.toolpath.contact_passes.upright.body_stock import BodyStock, CutStock
from trunnion.toolpath.contact_passes.upright.pass_samples import PassSamples, RefinedPass
from trunnion.toolpath.contact_passes.upright.uncut_area import uncut_area
from trunnion.toolpath.stock.heightfield import PlanningStock

FINE = 0.25
"""mm: the side of the finer cells."""
RIM = 1.0
"""Of a cell: how far beside a wall its middle may be that counts as the wall's."""
THIN = 0.5
"""mm over the part about a cell up to which its height is the part's, or of what lies on it everywhere."""
LEAD = 2.0
"""mm past a pass's ends that a tool may be asked for: leads are no longer."""
SHORTEST = 0.05
"""mm: a shorter piece of a pass between two interruptions is left out."""
SMALLEST_LEFTOVER = 0.5
"""mm2: less than this is the rim of an area."""


@dataclass(frozen=True, slots=True, eq=False)
class _PassStock:
    """Stock beside passes of an upright tool that are cut in their order (`linking.parameters.PassStock`)."""

    stock: CutStock
    passes: Sequence[Pass]
    tool: Tool
    progress: Progress

    def is_free(self, tips: Floats, axes: Floats, cut: Ints) -> Bools:
        found = np.ones(len(tips), dtype=bool)
        for stock, rows in self._moments(cut):
            found[rows] = stock.is_free(tips[rows])
        return found

    def tops(self, tips: Floats, cut: Ints) -> Floats:
        found = np.full(len(tips), -np.inf)
        # A disc smaller by half a diagonal touches no cell with its middle beyond the radius: such cells are never cut.
        radius = max(self.tool.radius - heightfield.HALF_DIAGONAL * self.stock.centred.cell, 0.0)
        for stock, rows in self._moments(cut):
            found[rows] = [stock.centred.height(tip, tip, radius) for tip in tips[rows]]
        return found

    def _moments(self, cut: Ints) -> Iterator[tuple[BodyStock, Ints]]:
        """Yield the stock when so many passes (k,) are cut, with the rows that ask for it, moment by moment."""
        stock, done = self.stock.beside(self.passes, self.tool), 0
        for moment in np.unique(cut).tolist():
            self.progress.check()
            for k in range(done, moment):
                stock.cut(k, slice(None))
            done = moment
            yield stock, np.flatnonzero(cut == moment)


def without_stock_contact(
    passes: Sequence[Pass],
    drive: SurfaceDrive,
    tool: Tool,
    stock: PlanningStock,
    stepover: float,
    progress: Progress,
) -> tuple[list[Pass], PassStock | None, tuple[Finding, ...]]:
    """Return what of passes in the order they are cut, a stepover (mm) apart, an upright tool cuts without meeting stock above its flutes;
    what stands beside them meanwhile, None where nothing does; and a finding of the area that is left.

    What passes before have cut is gone, and what lies thinly on the part.
    """
    rows = np.array(tool.profile()).reshape(-1, 4)
    if not len(passes) or not len(rows) or not all(p.upright for p in passes):
        return list(passes), None, ()
    places = PassSamples.on(passes, FINE)
    low, high = _around(stock, places.tips, rows, tool)
    coarse = stock.cropped(low, high)
    doubtful = ~_is_free(coarse, places.tips, rows)
    if not doubtful.any():
        return list(passes), None, ()
    before = progress.aside(
        lambda own: _cut_stock(stock, low, high, own), "Cutting the stock in finer cells"
    )
    progress.aside(partial(_take_part_off, before.centred, drive, places.tips[doubtful], tool))
    found = _free_moves(passes, places, doubtful, before.beside(passes, tool), progress)
    # Moves along a straight wall are as long as the wall: of one only what is near stock is left out. With moves in steps more is cut than
    # without them, and more cuts only lower the stock: what was free is free again, and only steps are left out.
    stepped = [RefinedPass.of(p, m, FINE) for p, m in zip(passes, found.blocked, strict=True)]
    steps = [one.path for one in stepped]
    if any(one.new.any() for one in stepped):
        places = PassSamples.on(steps, FINE)
        doubtful = ~_is_free(coarse, places.tips, rows)
        found = _free_moves(steps, places, doubtful, before.beside(steps, tool), progress)
    kept = list[Pass]()
    for one, step, runs in zip(passes, stepped, found.runs, strict=True):
        # What is cut whole may be closed.
        kept += [one] if runs == [slice(None)] else [step.piece(moves) for moves in runs]
    is_cut = [_is_in(runs, len(p) - 1) for p, runs in zip(steps, found.runs, strict=True)]
    area = uncut_area(steps, places, is_cut, drive, tool, stepover, progress)
    return kept, _PassStock(before, kept, tool, progress), _findings(area, found.over, drive, tool)


@dataclass(frozen=True, slots=True, eq=False)
class _FreeMoves:
    """What of passes a tool cuts without meeting stock: which moves (m,) of each pass are `blocked`, the `runs` of moves of each that are
    cut, and how far `over` (mm) the lowest place that is met anything stands."""

    blocked: list[Ints]
    runs: list[list[slice]]
    over: float


def _free_moves(
    passes: Sequence[Pass],
    places: PassSamples,
    doubtful: Bools,
    beside: BodyStock,
    progress: Progress,
) -> _FreeMoves:
    """Cut passes in their order as far as nothing is met at positions on them, (n,) of which are doubtful."""
    blocked, runs, over = list[Ints](), list[list[slice]](), 0.0
    starts = np.searchsorted(places.owner, np.arange(len(passes) + 1))
    for k, one in enumerate(passes):
        progress.check()
        of = slice(starts[k], starts[k + 1])
        tips, met = places.tips[of], np.zeros(starts[k + 1] - starts[k], dtype=bool)
        some = np.flatnonzero(doubtful[of])
        if len(some):
            met[some] = ~beside.is_free(tips[some])
        moves, free = np.zeros(0, np.int64), [slice(None)]
        if met.any():
            moves = _moves_with(met, places.move[of])
            free = _runs(one, moves)
            over = max(over, float(beside.centred.field.max() - tips[met, 2].min()))
        for run in free:
            beside.cut(k, run)
        blocked.append(moves)
        runs.append(free)
    return _FreeMoves(blocked, runs, over)


def _cut_stock(stock: PlanningStock, low: Floats, high: Floats, progress: Progress) -> CutStock:
    """Return the stock in a box from `low` to `high` (2,)."""
    return CutStock(
        planned=stock,
        centred=stock.finely(low, high, FINE, progress.part(0.0, 0.5), centred=True),
        upper=stock.finely(low, high, FINE, progress.part(0.5, 1.0)),
    )


def _around(stock: PlanningStock, tips: Floats, rows: Floats, tool: Tool) -> tuple[Floats, Floats]:
    """Return the corners (2,) of the box of what a tool at tips (n, 3) may come near to."""
    reach = max(float(rows[:, [1, 3]].max()), tool.radius) + 4.0 * stock.cell
    # A tip beside the field counts at the nearest cell of it.
    low, high = stock.box()
    plan = np.clip(tips[:, :2], low, high)
    return plan.min(axis=0) - reach, plan.max(axis=0) + reach


def _is_free(stock: PlanningStock, tips: Floats, rows: Floats) -> Bools:
    """Return at which tips (n, 3) nothing in the square about each cone of a body is higher than the cone's lower end."""
    field = stock.field
    cell = np.floor((tips[:, :2] - stock.corner) / stock.cell).astype(np.int64)
    at = tuple(np.clip(cell, 0, np.array(field.shape) - 1).T)
    # A tip beside the field counts at the nearest cell of it, which is no farther from any other one.
    clear = np.ones(len(tips), dtype=bool)
    for z0, r0, _, r1 in rows.tolist():
        size = 2 * (math.ceil(max(r0, r1) / stock.cell) + 1) + 1
        clear &= maximum_filter(field, size, mode="nearest")[at] <= tips[:, 2] + z0
    return clear


def _take_part_off(
    stock: PlanningStock, drive: SurfaceDrive, tips: Floats, tool: Tool, progress: Progress
) -> None:
    """Take off a working copy, where the body of a tool at tips (k, 3) may come, heights that are the part's, or of what lies on it no
    thicker than operations leave."""
    field = stock.field
    widest = max(max(r0, r1) for _, r0, _, r1 in tool.profile())
    near = np.zeros(field.shape, dtype=bool)
    cell = np.floor((tips[:, :2] - stock.corner) / stock.cell).astype(np.int64)
    near[tuple(np.clip(cell, 0, np.array(field.shape) - 1).T)] = True
    reach = widest + LEAD
    near = maximum_filter(near, 2 * (math.ceil(reach / stock.cell) + 1) + 1, mode="nearest")
    rows = np.argwhere(near & (field > float(tips[:, 2].min()) + tool.flute_length))
    if not len(rows):
        return
    centres = stock.corner + (rows + 0.5) * stock.cell
    lowest = float(drive.low[2]) - tool.flute_length
    part = drive.skin.drop.drop(centres, level_disc(RIM * stock.cell), lowest, progress)
    some = tuple(rows[field[tuple(rows.T)] <= part + THIN].T)
    field[some] = -np.inf


def _moves_with(met: Bools, segment: Ints) -> Ints:
    """Return the moves (m,) that some of the positions (n,) of a pass are on: at its start a move shares one with the move before."""
    begins = np.diff(segment, prepend=-1) > 0
    return np.union1d(segment[met], np.maximum(segment[met & begins] - 1, 0))


def _runs(one: Pass, blocked: Ints) -> list[slice]:
    """Return the moves of each piece of a pass without some moves of it."""
    free = np.ones(len(one) - 1, dtype=bool)
    free[blocked] = False
    edges = np.flatnonzero(np.diff(free.astype(np.int8), prepend=0, append=0)).reshape(-1, 2)
    return [slice(a, b) for a, b in edges.tolist() if one.of(slice(a, b + 1)).length >= SHORTEST]


def _is_in(runs: Sequence[slice], count: int) -> Bools:
    """Return which of so many moves are in some runs of them."""
    found = np.zeros(count, dtype=bool)
    for moves in runs:
        found[moves] = True
    return found


def _findings(area: float, over: float, drive: SurfaceDrive, tool: Tool) -> tuple[Finding, ...]:
    if area < SMALLEST_LEFTOVER:
        return ()
    return (
        warning(
            IN_STOCK,
            f"{drive.feature}: about {area:.1f} mm2 are left: stock that no roughing took stands up to {over:.0f} mm over them, in the "
            f"way of the neck or shank of {tool.name}",
            drive.feature,
            remedy="rough it from another direction or with a more slender cutter, or finish it with one with a longer neck",
        ),
    )
