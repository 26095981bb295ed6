"""Finishing steep faces and upright walls level by level, the tip at one height all round.

At a height the cutter is blocked where a drop would be higher: the rim of that area is the pass. It is found on a grid of drops, put
exactly on the grid's lines and then between them by halving, always on the free side, and cut where the cutter touches the area.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise

import numpy as np
from scipy.spatial import cKDTree

from trunnion import tolerance
from trunnion.findings import Finding, Refused, warning
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.sheet.contours import SheetLine, whole_levels
from trunnion.model.operation import CuttingData
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.plan.freeform.cutters.cutter import lower_side
from trunnion.plan.freeform.drive import SurfaceDrive
from trunnion.plan.freeform.reach import AreaSamples, leans, samples_on
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.settings import setting, settings
from trunnion.threads import in_parallel
from trunnion.toolpath.contact_passes.choices import TOO_SHALLOW, TOO_STEEP
from trunnion.toolpath.contact_passes.linking.parameters import LinkParameters
from trunnion.toolpath.contact_passes.passes import UPRIGHT, Pass
from trunnion.toolpath.contact_passes.stepover.spacing import (
    FacetSlopes,
    slopes_of,
)
from trunnion.toolpath.contact_passes.upright.foot_heights import UPWARD, lowest_tips
from trunnion.toolpath.contact_passes.upright.stock_trimming import sample_count, trimmed_to_stock
from trunnion.toolpath.contact_passes.upright.tip_grid import grid_around, spread
from trunnion.toolpath.contact_passes.upright.tracing import thinned
from trunnion.toolpath.contact_passes.upright.upright_path import linked_without_contact
from trunnion.toolpath.contact_passes.upright.wall_foot import foot_passes
from trunnion.toolpath.contact_passes.upright.wall_levels import with_levels
from trunnion.toolpath.contract import Planned, strategy
from trunnion.toolpath.motion.load.engagement import surface_leftovers
from trunnion.toolpath.stock.heightfield import PlanningStock

CELL, FINEST, COARSEST = 0.2, 0.1, 1.5
"""Of the cutter's radius, and mm at least and at most: side of the grid's cells. What is blocked is as wide as the cutter and more."""
MARGIN = 6
"""Cells round the area's tips that are looked at: as far as the cutter goes away from both sides of an edge that it rolls round."""
CLOSE = 2e-5
"""mm: how near to the rim of what is blocked a tip is put."""
HALVINGS = 16
SEEN, THINNED = 0.25, 0.4
"""Shares of the chord error: how far the rim may be from the middle of a chord, and a position that is taken out from its chord."""
INSIDE = (0.25, 8.0, 0.75, 2.0)
"""How far inside of where the rim is expected beside a chord its search begins: near first, in what a chord's middle is expected off it;
then in chord errors and in the chord's length, as a corner needs."""
NEARBY, ROUGHLY = 1.0, 2.5
"""Cells: a tip this near to one on the area touches it; and one that is only known to be somewhere on a cell's side may."""
CHUNK = 5000
"""Tips that are looked for by one thread at once."""
ROLLS = 0.15
"""Of an arc: by how much the way round an edge may differ from it."""
SMALLEST_LEFTOVER = 0.5
"""mm2: less than this is the rim of an area."""


@settings("surface.waterline")
class WaterlineSettings:
    """How steep faces are finished level by level."""

    step: float = setting(
        0.0,
        unit="mm",
        low=0.0,
        high=200.0,
        label="Step",
        help="Height from level to level; 0: by the wanted scallop height and how the faces lean.",
    )
    shallowest: float = setting(
        20.0,
        unit="deg",
        low=0.0,
        high=89.0,
        label="Shallowest",
        help="Faces that lean by less from level are left to parallel passes.",
    )
    way: str = setting(
        "climb",
        choices=("climb", "both"),
        label="Way",
        help="climb: the face on the right of the feed; both: to and fro.",
    )
    trim: bool = setting(
        False,
        label="Only where stock stands",
        help="What earlier passes have left no higher than the scallop height is left out.",
    )
    overlap: float = setting(
        0.5,
        unit="mm",
        low=0.0,
        high=20.0,
        label="Overlap",
        help="How far passes go on past the rim of the area, and closed ones over their start.",
    )
    chord: float = setting(
        0.0005,
        unit="mm",
        low=0.00005,
        high=0.1,
        label="Chord error",
        help="How far straight moves may leave the cutter's way round the faces.",
    )
    lead_radius: float = setting(
        1.0,
        unit="mm",
        low=0.05,
        high=50.0,
        label="Lead radius",
        help="Of the quarter circles onto and off passes.",
    )
    safety: float = setting(
        2.0,
        unit="mm",
        low=0.2,
        high=50.0,
        label="Safety distance",
        help="Where a rapid ends above what may still be there.",
    )


@strategy(
    settings=WaterlineSettings,
    drive=SurfaceDrive,
    leaves=(TOO_SHALLOW,),
    settles=(TOO_STEEP,),
    meets=surface_leftovers,
    goes_past=lambda settings: settings.overlap + 2.0 * settings.lead_radius,
    own_faces=True,
)
def waterline(
    drive: SurfaceDrive,
    tool: Tool,
    data: CuttingData,
    stock: PlanningStock,
    setup: Setup,
    settings: WaterlineSettings,
    progress: Progress,
) -> Planned:
    """Return the motions that finish the drive's faces level by level, and the area that is too shallow for it or hangs over."""
    if drive.height <= 0.0 and settings.step <= 0.0:
        raise Refused(f"{drive.feature}: waterlines need a scallop height or a step above zero")
    slopes = progress.aside(lambda _: slopes_of(drive, tool, UPWARD), "Looking at steep faces")
    slopes = slopes.some(slopes.normal[:, 2] <= math.cos(math.radians(settings.shallowest)))
    found = _unreached_findings(drive, slopes)
    if not len(slopes.row):
        return Planned(findings=found)
    feet = lowest_tips(slopes, drive, tool, progress.part(0.0, 0.1))
    walls = progress.aside(
        lambda _: with_levels(slopes, feet, tool, drive.height, settings.step), "Laying levels"
    )
    passes: list[Pass] = []
    for n, wall in enumerate(walls):
        share = progress.part(0.1 + 0.7 * n / len(walls), 0.1 + 0.7 * (n + 1) / len(walls))
        area = share.aside(partial(_AreaTips.of, wall.slopes, tool))
        loops = _loops(wall.levels, area, drive, tool, settings, share.part(0.0, 0.9))
        made = _in_order(loops, tool, both=settings.way == "both")
        passes += made
        if (wall.slopes.normal[:, 2] <= -UPWARD).any():
            passes += foot_passes(
                made, wall.levels, area.has, drive, tool, settings.chord, share.part(0.9, 1.0)
            )
    if not passes:
        nothing = warning(
            "surface.out-of-reach",
            f"{tool.name} touches nothing of the steep faces of {drive.feature}",
            drive.feature,
            remedy="finish them with a smaller or longer cutter",
        )
        return Planned(findings=(*found, nothing))
    step = max(float(np.diff(wall.levels).max(initial=tool.radius)) for wall in walls)
    if settings.trim:
        steep = _samples(drive, math.radians(settings.shallowest))
        passes = trimmed_to_stock(passes, steep, drive, tool, stock, data.feed, progress)
    parameters = LinkParameters(
        stepover=max(step, tool.radius),
        safety=settings.safety,
        lead_radius=settings.lead_radius,
        chord=settings.chord,
        arcs=True,
        overlap=settings.overlap,
    )
    path, blocked = linked_without_contact(
        passes, step, drive, tool, data, stock, setup, parameters, progress.part(0.8, 1.0)
    )
    return Planned(path=path, findings=(*found, *blocked))


def _samples(drive: SurfaceDrive, shallowest: float) -> AreaSamples:
    """Return samples of the drive's faces where they lean by no less than an angle (rad) from level."""
    area = float(drive.skin.areas(drive.skin.of(drive.faces)).sum())
    samples = samples_on(drive.skin, tuple(drive.faces), sample_count(area))
    return samples.of(leans(samples) >= shallowest)


def _unreached_findings(drive: SurfaceDrive, steep: FacetSlopes) -> tuple[Finding, ...]:
    """Return a finding of the area that no steep position stands for."""
    area = float(drive.skin.areas(drive.skin.of(drive.faces)).sum() - steep.area.sum())
    if area < SMALLEST_LEFTOVER:
        return ()
    return (
        warning(
            TOO_SHALLOW,
            f"{area:.1f} mm2 of {drive.feature} are too shallow for waterlines, or hang over",
            drive.feature,
            remedy="finish them by parallel passes or from another direction",
        ),
    )


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Blocked:
    """Where the cutter, its lower side given by pieces, is blocked at a height."""

    drive: SurfaceDrive
    pieces: Floats
    lowest: float
    progress: Progress

    def heights(self, plan: Floats) -> Floats:
        """Return how high the tip is over plan points (n, 2)."""
        return self.drive.skin.drop.drop(plan, self.pieces, self.lowest, self.progress)

    def rim(
        self, start: Floats, direction: Floats, z: Floats, most: Floats
    ) -> tuple[Floats, Bools]:
        """Return how far (n,) the rim of what is blocked is from blocked plan points (n, 2) along unit directions (n, 2): as far as the
        free side, no more than `CLOSE` from it. Also return whether it is there, no farther than `most` (n,); from a free place it
        isn't."""
        return self.drive.skin.drop.free_run(
            start, direction, z + tolerance.COINCIDENT, most, self.pieces, CLOSE, self.progress
        )


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Loop:
    """A polyline (k, 2) in plan at a height, the number of its level counted upwards; what is closed ends where it begins."""

    plan: Floats
    z: float
    level: int
    closed: bool


@dataclass(frozen=True, slots=True, eq=False)
class _AreaTips:
    """Tips (k, 3) that touch the area, as dense as the cells (mm) of the grid that level lines are marched on."""

    tips: Floats
    tree: cKDTree
    cell: float

    @staticmethod
    def of(slopes: FacetSlopes, tool: Tool, _: Progress) -> _AreaTips:
        """Return the tips of a tool that touches triangles."""
        cell = float(np.clip(CELL * tool.radius, FINEST, COARSEST))
        tips = spread(slopes.tips, cell)
        return _AreaTips(tips, cKDTree(tips), cell)

    def has(
        self, tips: Floats, distance: float = NEARBY, progress: Progress = NO_PROGRESS
    ) -> Bools:
        """Return which tips (n, 3) are no farther than a distance in cells from those that touch the area."""
        # With a bound the tree looks at what is near alone: far positions would be the slow ones.
        most, found = distance * self.cell, np.empty(len(tips), dtype=bool)
        bound = float(np.nextafter(most, np.inf))

        def work(first: int, last: int) -> None:
            away = self.tree.query(tips[first:last], distance_upper_bound=bound)[0]
            found[first:last] = away <= most

        in_parallel(work, len(tips), CHUNK, progress, "Looking at steep faces")
        return found


def _loops(
    levels: Floats,
    area: _AreaTips,
    drive: SurfaceDrive,
    tool: Tool,
    settings: WaterlineSettings,
    progress: Progress,
) -> list[_Loop]:
    """Return the passes where the cutter touches the area, lowest first, the material on their right."""
    # Drop cutter on a grid: the level lines of its heights are the waterlines, to a cell.
    cell = area.cell
    blocked = _Blocked(
        drive=drive,
        pieces=lower_side(tool, drive.allowance),
        lowest=float(drive.low[2]) - tool.flute_length,
        progress=progress,
    )
    # Heights are compared as drops put them, without the allowance that lifts the tool.
    levels = levels - drive.allowance
    grid = grid_around(area.tips, cell, MARGIN)
    heights = blocked.heights(grid.points[:, :2])
    knots = np.concatenate([levels[:1] - 1.0, levels + tolerance.COINCIDENT, levels[-1:] + 1.0])
    numbers = np.concatenate([[-0.5], np.arange(len(levels)), [len(levels) - 0.5]])
    radius = tool.radius + drive.allowance

    def near(plans: Sequence[Floats], over: Floats, distance: float) -> list[Bools]:
        """Return which places of paths (k, 2) at heights (n,) are near the area."""
        sizes = [len(plan) for plan in plans]
        z = np.repeat(over + drive.allowance, sizes)
        found = area.has(np.column_stack([np.concatenate(plans), z]), distance, progress)
        return np.split(found, np.cumsum(sizes)[:-1])

    # March the level lines; `numbers` maps heights so that all levels are whole numbers of one field.
    marched = [
        replace(line, ends=line.ends[::-1], share=line.share[::-1])
        for line in whole_levels(grid, np.interp(heights, knots, numbers))
    ]
    if not marched:
        return []
    plans = [line.value(grid.points)[:, :2] for line in marched]
    over = np.array([levels[line.level] for line in marched])
    # So far only roughly, and over gaps in which an edge may be rolled round.
    gap = 2.0 * settings.overlap + math.pi * radius
    found: list[tuple[SheetLine, Ints, bool]] = []
    for line, plan, near_area in zip(marched, plans, near(plans, over, ROUGHLY), strict=True):
        progress.check()
        found += [
            (line, rows, closed)
            for rows, closed in _pieces(
                plan, near_area, line.closed, settings.overlap + cell, radius, gap
            )
        ]
    if not found:
        return []
    ends = np.concatenate([line.ends[rows] for line, rows, _ in found])
    level = np.array([levels[line.level] for line, *_ in found])
    over = np.repeat(level, [len(rows) for _, rows, _ in found])
    # Exact crossings: along each cut edge of the grid, from the blocked end to the rim (`_Blocked.rim`).
    ends = np.take_along_axis(ends, np.argsort(-heights[ends], axis=1, kind="stable"), axis=1)
    high, low = grid.points[ends[:, 0], :2], grid.points[ends[:, 1], :2]
    side = np.hypot(*(low - high).T)
    direction = (low - high) / side[:, None]
    run, has_rim = blocked.rim(high, direction, over, side)
    plan = np.where(has_rim[:, None], high + run[:, None] * direction, low)
    split = np.split(plan, np.cumsum([len(rows) for _, rows, _ in found])[:-1])
    lines = []
    for loop, (line, _, closed), isnear in zip(
        split, found, near(split, level, NEARBY), strict=True
    ):
        progress.check()
        z = float(levels[line.level])
        for rows, whole in _pieces(loop, isnear, closed, settings.overlap, radius):
            rows = rows[np.append(True, np.hypot(*np.diff(loop[rows], axis=0).T) > CLOSE)]
            if len(rows) > 1:
                lines.append(_Loop(plan=loop[rows], z=z, level=line.level, closed=whole))
    refined = _refined(lines, blocked, settings.chord)
    return [
        replace(line, plan=loop, z=line.z + drive.allowance)
        for line, loop in zip(lines, refined, strict=True)
    ]


def _pieces(
    plan: Floats, near: Bools, closed: bool, overlap: float, radius: float, gap: float = 0.0
) -> list[tuple[Ints, bool]]:
    """Return the rows of the pieces of a path (k, 2) that are near the area, roll round an edge of it, are no farther along the path than
    an overlap from such, or between two of them with no more than a `gap` between, and whether each is closed."""
    rows = np.arange(len(plan))
    if not near.any():
        return []
    if closed:
        first = int(np.flatnonzero(near[:-1])[0]) if near[:-1].any() else 0
        rows = np.append(np.roll(rows[:-1], -first), first)
    plan, near = plan[rows], near[rows] | _rolls(plan[rows], near[rows], radius)
    if near.all():
        return [(rows, closed)] if len(rows) > 1 else []
    run = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(plan, axis=0).T))])
    limits = np.concatenate([[-np.inf], run[near], [np.inf]])
    after = np.clip(np.searchsorted(limits, run), 1, len(limits) - 1)
    wanted = np.minimum(limits[after] - run, run - limits[after - 1]) <= overlap
    wanted |= limits[after] - limits[after - 1] <= gap
    if wanted.all():
        return [(rows, closed)]
    if closed:
        first = int(np.flatnonzero(~wanted)[0])
        turn = np.append(np.roll(np.arange(len(rows) - 1), -first), first)
        rows, wanted = rows[turn], wanted[turn]
    edges = np.flatnonzero(np.diff(wanted.astype(np.int8), prepend=0, append=0)).reshape(-1, 2)
    return [(rows[a:b], False) for a, b in edges.tolist() if b - a > 1]


def _rolls(plan: Floats, near: Bools, radius: float) -> Bools:
    """Return for positions (k, 2) between two that are near the area whether the cutter rolls round an edge there: the path is as long as
    the arc of its radius between both."""
    out = np.zeros(len(plan), dtype=bool)
    rows = np.flatnonzero(near)
    run = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(plan, axis=0).T))])
    for a, b in pairwise(rows.tolist()):
        across = math.dist(plan[a], plan[b])
        if b > a + 1 and across < 2.0 * radius:
            arc = 2.0 * radius * math.asin(across / (2.0 * radius))
            out[a:b] = abs(float(run[b] - run[a]) - arc) <= ROLLS * arc
    return out


def _refined(loops: list[_Loop], blocked: _Blocked, chord: float) -> list[Floats]:
    """Return the paths with positions put in until no chord leaves the rim of what is blocked by more than a chord error."""
    if not loops:
        return []
    plan, z = (
        np.concatenate([loop.plan for loop in loops]),
        np.repeat([loop.z for loop in loops], [len(loop.plan) for loop in loops]),
    )
    line = np.repeat(np.arange(len(loops)), [len(loop.plan) for loop in loops])
    # Halve: off is where a smooth rim would be, from the turns at both ends; a chord is closed when its middle is found there.
    off = _bulges(plan, line)
    is_open = np.append(line[1:] == line[:-1], False)
    for _ in range(HALVINGS):
        rows = np.flatnonzero(is_open)
        if not len(rows):
            break
        left, found, has_rim = _middles(
            plan[rows], plan[rows + 1], off[rows], z[rows], blocked, chord
        )
        # What is where a smooth rim would have it is the middle of two chords that are four times nearer to it.
        seen = 0.25 * np.abs(found) + np.abs(found - off[rows]) <= SEEN * chord
        is_open[rows], off[rows] = ~seen & has_rim, 0.25 * found
        middle = 0.5 * (plan[rows] + plan[rows + 1]) + found[:, None] * left
        rows, middle = rows[has_rim], middle[has_rim]
        plan, z, line, off = (
            np.insert(old, rows + 1, new, axis=0)
            for old, new in ((plan, middle), (z, z[rows]), (line, line[rows]), (off, off[rows]))
        )
        is_open = np.insert(is_open, rows + 1, is_open[rows])
        # Beside a corner a chord that was never looked at may leave the path.
        is_open |= np.abs(_bulges(plan, line)) > SEEN * chord
        is_open[:-1] &= (line[1:] == line[:-1]) & (np.hypot(*np.diff(plan, axis=0).T) > chord)
    kept = thinned(plan, line, THINNED * chord)
    return np.split(plan[kept], np.flatnonzero(np.diff(line[kept])) + 1)


def _bulges(plan: Floats, line: Ints) -> Floats:
    """Return how far to the left (n,) of the middle of the chord from each position (n, 2) of lines to the next a smooth way would be, as
    the lines turn at both ends."""
    chord = np.diff(plan, axis=0)
    length = np.hypot(chord[:, 0], chord[:, 1])
    turn = chord[:-1, 0] * chord[1:, 1] - chord[:-1, 1] * chord[1:, 0]
    size = length[:-1] * length[1:] * np.hypot(*(chord[:-1] + chord[1:]).T)
    bend = np.divide(
        2.0 * turn, size, out=np.zeros(len(turn)), where=(size > 0.0) & (line[2:] == line[:-2])
    )
    bend = np.concatenate([[0.0], bend, [0.0]])
    return np.append(-0.0625 * (bend[:-1] + bend[1:]) * length * length, 0.0)


def _middles(
    start: Floats, end: Floats, off: Floats, z: Floats, blocked: _Blocked, chord: float
) -> tuple[Floats, Floats, Bools]:
    """Return the directions (n, 2) to the left of chords, which have what is blocked on their right, how far the rim is from their middles
    that way (n,), expected `off` (n,), and whether one is found."""
    along, middle = end - start, 0.5 * (start + end)
    length = np.maximum(np.hypot(along[:, 0], along[:, 1]), CLOSE)
    left = np.column_stack([-along[:, 1], along[:, 0]]) / length[:, None]
    off, found, rows = (
        np.clip(off, -0.5 * length, 0.5 * length),
        np.zeros(len(z)),
        np.arange(len(z)),
    )
    near, errors, *lengths = INSIDE
    for inside in (
        near * np.abs(off) + 2.0 * CLOSE,
        np.abs(off) + errors * chord,
        *(share * length for share in lengths),
    ):
        begin = (off - inside)[rows]
        run, has_rim = blocked.rim(
            middle[rows] + begin[:, None] * left[rows],
            left[rows],
            z[rows],
            2.0 * inside[rows] + errors * chord,
        )
        found[rows[has_rim]] = (begin + run)[has_rim]
        rows = rows[~has_rim]
        if not len(rows):
            break
    # Where no rim is found beside a chord it stays as it is.
    return left, found, np.isin(np.arange(len(z)), rows, invert=True)


def _in_order(loops: list[_Loop], tool: Tool, *, both: bool) -> list[Pass]:
    """Return the passes of each wall from the top down, one wall after the other; with `both` every other open pass is turned round."""
    walls: list[list[_Loop]] = []
    for loop in sorted(loops, key=lambda loop: -loop.level):
        open_walls = [w for w in walls if w[-1].level == loop.level + 1]
        apart = [float(np.min(cKDTree(w[-1].plan).query(loop.plan)[0])) for w in open_walls]
        if apart and min(apart) <= 2.0 * tool.radius:
            open_walls[int(np.argmin(apart))].append(loop)
        else:
            walls.append([loop])
    return [
        _pass(loop, turned=both and not loop.closed and k % 2 == 1)
        for wall in walls
        for k, loop in enumerate(wall)
    ]


def _pass(loop: _Loop, *, turned: bool) -> Pass:
    direction = np.diff(loop.plan, axis=0)
    direction /= np.maximum(np.hypot(direction[:, 0], direction[:, 1]), CLOSE)[:, None]
    before, after = (
        np.vstack([direction[-1:] if loop.closed else direction[:1], direction]),
        np.vstack([direction, direction[:1] if loop.closed else direction[-1:]]),
    )
    ahead = before + after
    ahead[np.hypot(ahead[:, 0], ahead[:, 1]) < CLOSE] = after[
        np.hypot(ahead[:, 0], ahead[:, 1]) < CLOSE
    ]
    ahead /= np.hypot(ahead[:, 0], ahead[:, 1])[:, None]
    made = Pass(
        tip=np.column_stack([loop.plan, np.full(len(loop.plan), loop.z)]),
        axis=np.broadcast_to(UPRIGHT, (len(loop.plan), 3)),
        normal=np.column_stack([-ahead[:, 1], ahead[:, 0], np.zeros(len(ahead))]),
        closed=loop.closed,
    )
    return made.reversed() if turned else made
