"""The planner's stock as a height field (z-map): an upper bound of the material, for safe rapids.

The field errs on the side of material everywhere: it begins as the blank's top and is lowered only where a cutter covered a whole cell.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from hashlib import sha256

import numpy as np
from numpy.typing import ArrayLike

from trunnion import tolerance
from trunnion.findings import OutOfMemory
from trunnion.geometry.arrays import Bools, Floats, Ints, items_of
from trunnion.geometry.frame import Frame
from trunnion.geometry.kernels import heightfield
from trunnion.geometry.plane.curve import turn
from trunnion.geometry.plane.region import Region
from trunnion.model.blank import Blank
from trunnion.model.motion.toolpath import Motion, Toolpath
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.settings import digest
from trunnion.toolpath.stock.stock_reads import EVERYWHERE, StockBox, StockReads

CELL = 0.5
"""Side of a cell in mm where the blank is small; a larger blank has larger cells."""

MOST_CELLS = 1_000_000
"""Most cells of a field: 8 MB, beyond which cells grow."""

MOVES = 500
"""Moves that a field is lowered under between two looks at cancel: some hundredths of a second with the largest cutters."""

LARGEST_CELL = 10.0
"""A cell wider than this would hide every pocket from the field."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PlanningStock:
    """A `field` of heights (nx, ny) mm in the setup frame of square cells of side `cell`; cell (0, 0) begins at `corner` (2,).

    `digest` is a short stable digest of the uncut field and everything that was cut from it. A `centred` field errs to neither side:
    a cell is lowered where the cutter covers its middle. Loads are taken from it, and what is in a neck's way (`finely`); safe
    heights never. `widths` is the share of a cutter's radius that it clears up to the top of the stock: less than 1 over ground laid
    flat, where a straight body gets narrower upwards. `cuts` are the paths that were taken off it with their tools, in the order they
    were. `reads` takes down where it is looked at (`recorded`), which for one who takes the `heights` is everywhere; `field` alone is for
    places that were looked at before.
    """

    field: Floats
    corner: Floats
    cell: float
    digest: str
    centred: bool = False
    widths: float = 1.0
    cuts: tuple[tuple[Toolpath, Tool], ...] = ()
    reads: StockReads | None = None

    @staticmethod
    def of(blank: Blank, setup: Setup, cell: float = CELL) -> PlanningStock:
        """Return the stock of an uncut blank, each column as high as the blank is in it, or as low as it gets where there is none of it."""
        low, high = blank.box_in(setup.frame)
        size = high[:2] - low[:2]
        cell = max(cell, float(np.sqrt(size[0] * size[1] / MOST_CELLS)))
        if cell > LARGEST_CELL:
            raise OutOfMemory(
                f"the blank of {size[0]:.0f} x {size[1]:.0f} mm is too large to plan safe moves over: split the part"
            )
        # Whole cells that stand out past the blank's edge by a part of one, the same at both edges.
        count = np.maximum(np.ceil(size / cell - tolerance.COINCIDENT), 1).astype(int)
        corner = _fixed(low[:2] - 0.5 * (count * cell - size))
        shape = (int(count[0]), int(count[1]))
        heights = blank.tops(setup.frame, corner, cell, shape, float(low[2]))
        key = digest(shape, high[2].item(), corner, cell)
        if (heights < high[2]).any():
            key = digest(key, heights)
        return PlanningStock(field=_fixed(heights), corner=corner, cell=cell, digest=key)

    @staticmethod
    def centred_in(blank: Blank, frame: Frame, cell: float = CELL) -> PlanningStock:
        """Return a centred stock of an uncut blank in a frame, itself a working copy: as the lines through its cells' middles meet the
        blank."""
        low, high = blank.box_in(frame)
        cell = max(cell, float(np.sqrt(np.prod(high[:2] - low[:2]) / MOST_CELLS)))
        shape = tuple(np.ceil((high[:2] - low[:2]) / cell).astype(int))
        middles = low[:2] + (np.argwhere(np.ones(shape, dtype=bool)) + 0.5) * cell
        met = blank.intervals(
            blank.own(np.column_stack([middles, np.full(len(middles), low[2])]), frame),
            blank.frame.local_direction(frame.z),
        )
        return PlanningStock(
            field=(low[2] + met.tops(0.0)).reshape(shape),
            corner=_fixed(low[:2]),
            cell=cell,
            digest="",
            centred=True,
        )

    def after(self, path: Toolpath, tool: Tool, progress: Progress = NO_PROGRESS) -> PlanningStock:
        """Return the stock after the feed moves of a path."""
        if (path.motion == Motion.RAPID).all():
            return self
        made = self.working()
        made.lower(path, tool, progress)
        cut = digest(
            self.digest,
            path.position,
            path.motion,
            path.centre,
            tool.column_radius,
            tool.corner_radius,
        )
        if tool.full_width_height > 0.0:
            cut = digest(cut, tool.full_width_height)
        return replace(made, field=_fixed(made.field), digest=cut, cuts=(*self.cuts, (path, tool)))

    def recorded(self) -> PlanningStock:
        """Return the same stock, which takes down from now on where it is looked at; so do working copies of it."""
        return replace(self, reads=StockReads())

    def box_read(self) -> StockBox:
        """Return the box in which a recorded stock was looked at."""
        return EVERYWHERE if self.reads is None else self.reads.box(self.corner)

    @property
    def heights(self) -> Floats:
        """The heights (nx, ny) mm of all cells, to be looked at anywhere."""
        if self.reads is not None:
            self.reads.add_everything()
        return self.field

    @property
    def exact_cuts(self) -> tuple[tuple[Toolpath, Tool], ...]:
        """The `cuts`, for who looks closer than at cells: others may leave the same heights there."""
        if self.reads is not None:
            self.reads.add_everything()
        return self.cuts

    def digest_in(self, box: StockBox) -> str:
        """Return a short digest of the heights within a box, and of where the cells are."""
        if box == EVERYWHERE:
            return self.digest
        first, last = self._cells(np.array(box[:2]), np.array(box[2:]))
        some = self.field[first[0] : last[0], first[1] : last[1]]
        return digest(
            self.corner,
            self.cell,
            self.field.shape,
            self.widths,
            box,
            sha256(some.tobytes()).hexdigest(),
        )

    def cropped(self, low: Floats, high: Floats) -> PlanningStock:
        """Return the part of the stock with all cells that a box from `low` to `high` (2,) touches, at least one; it may be looked at
        anywhere."""
        first, last = self._cells(low, high)
        first = np.clip(first, 0, np.array(self.field.shape) - 1)
        last = np.maximum(last, first + 1)
        corner = self.corner + first * self.cell
        self._look(corner, self.corner + last * self.cell)
        return replace(
            self,
            field=self.field[first[0] : last[0], first[1] : last[1]],
            corner=_fixed(corner),
            digest="",
            reads=None,
        )

    def finely(
        self,
        low: Floats,
        high: Floats,
        cell: float,
        progress: Progress = NO_PROGRESS,
        *,
        centred: bool = False,
    ) -> PlanningStock:
        """Return a working copy of the part of the stock that a box from `low` to `high` (2,) touches, in cells of about a side (mm): all
        that was cut is cut again. What was cut from elsewhere is known as well as the stock knows it."""
        cuts = self.exact_cuts
        near = self.cropped(low, high)
        side = max(cell, float(np.sqrt(near.field.size * near.cell**2 / MOST_CELLS)))
        parts = max(1, math.floor(near.cell / side + tolerance.PARAMETRIC))
        field = np.repeat(np.repeat(near.field, parts, axis=0), parts, axis=1)
        made = replace(near, field=field, cell=near.cell / parts, centred=centred, cuts=())
        corners = np.array(made.box())
        for path, tool in progress.each(cuts):
            around = tool.core_radius + made.cell
            meets = (path.position[:, :2].max(axis=0) > corners[0] - around) & (
                path.position[:, :2].min(axis=0) < corners[1] + around
            )
            if meets.all():
                made.lower(path, tool, progress)
        return made

    def _cells(self, low: Floats, high: Floats) -> tuple[Ints, Ints]:
        """Return the first cell (2,) that a box touches, and the first (2,) behind it."""
        first = np.clip(np.floor((low - self.corner) / self.cell), 0, self.field.shape)
        last = np.clip(np.floor((high - self.corner) / self.cell) + 1, 0, self.field.shape)
        return first.astype(np.int64), last.astype(np.int64)

    def _look(self, low: Floats, high: Floats) -> None:
        if self.reads is not None:
            self.reads.add(low, high)

    def working(self) -> PlanningStock:
        """Return a copy that `zmap_cut` may change; its digest stays that of the stock it was taken from."""
        return replace(self, field=self.field.copy())

    def lower(self, path: Toolpath, tool: Tool, progress: Progress = NO_PROGRESS) -> Floats:
        """Take the feed moves of a path off this very field, which must be a `working` copy; return the volume (n,) in mm3 that each
        block takes off."""
        return self.taken(path, tool, progress)[0]

    def taken(
        self, path: Toolpath, tool: Tool, progress: Progress = NO_PROGRESS
    ) -> tuple[Floats, Floats]:
        """Do as `lower`, and return also the height that each block takes off, squared and summed over the area in plan: (n,) mm4."""
        starts, ends, rows, error = cutting_chords(path, tool)
        radius, gone = self.widths * (tool.column_radius - error), np.empty((len(starts), 2))
        if len(starts):
            ends_in_plan = np.vstack([starts, ends])[:, :2]
            around = tool.core_radius + 2.0 * self.cell
            self._look(ends_in_plan.min(axis=0) - around, ends_in_plan.max(axis=0) + around)
        # A cell's furthest corner counts: with a cutter as much wider its middle does.
        wider = heightfield.HALF_DIAGONAL * self.cell if self.centred else 0.0
        for first in progress.each(range(0, len(starts), MOVES)):
            some = slice(first, first + MOVES)
            heightfield.zmap_cut(
                self.field,
                self.corner[0],
                self.corner[1],
                self.cell,
                starts[some],
                ends[some],
                radius + wider,
                min(tool.corner_radius, radius),
                math.inf,
                gone[some],
            )
        volume, squares = (
            np.bincount(rows, gone[:, k], len(path)).astype(np.float64) * self.cell**2
            for k in (0, 1)
        )
        return volume, squares

    def height(self, start: ArrayLike, end: ArrayLike, radius: float) -> float:
        """Return the greatest height that a disc may touch on its path from `start` to `end` (2,), or -inf over nothing."""
        a, b = (np.ascontiguousarray(p, dtype=np.float64)[:2] for p in (start, end))
        around = radius + 2.0 * self.cell
        self._look(np.minimum(a, b) - around, np.maximum(a, b) + around)
        return float(
            heightfield.zmap_highest(
                self.field, self.corner[0], self.corner[1], self.cell, a, b, radius
            )
        )

    def heights_at(self, points: Floats) -> Floats:
        """Return the heights (k,) of the cells that points (k, 2) lie in, -inf beside the field."""
        self._look(points.min(axis=0), points.max(axis=0))
        cell = np.floor((points - self.corner) / self.cell).astype(np.int64)
        inside = ((cell >= 0) & (cell < self.field.shape)).all(axis=1)
        heights = np.full(len(points), -np.inf)
        heights[inside] = self.field[tuple(cell[inside].T)]
        return heights

    def is_clear(self, z: float, area: Region) -> bool:
        """Return whether no cell in an area is higher than `z`: none with its middle in it, or where it is too narrow to hold a middle,
        none that it touches. Beside the field nothing stands."""
        if not area:
            return True
        if _holds_any(area, self._above(z, area)):
            return False
        if _holds_any(area, self._above(-math.inf, area)):
            return True
        wider = area.offset(heightfield.HALF_DIAGONAL * self.cell)
        return not _holds_any(wider, self._above(z, wider))

    def positions_above(self, z: float, area: Region) -> Floats:
        """Return the centres (k, 2) of the cells in an area that are higher than `z`."""
        centres = self._above(z, area)
        return centres[area.contains(centres)] if len(centres) else centres

    def cells_above(self, z: float, area: Region) -> Bools:
        """Return which cells (nx, ny) are higher than `z` and have their centre in an area."""
        found = np.zeros(self.field.shape, dtype=np.bool_)
        cells = np.floor((self.positions_above(z, area) - self.corner) / self.cell).astype(np.int64)
        found[cells[:, 0], cells[:, 1]] = True
        return found

    def _above(self, z: float, area: Region) -> Floats:
        if not area:
            return np.zeros((0, 2))
        low, high = area.box()
        self._look(low - self.cell, high + self.cell)
        first = np.maximum(np.floor((low - self.corner) / self.cell), 0).astype(int)
        last = np.minimum(np.ceil((high - self.corner) / self.cell), self.field.shape).astype(int)
        if (last <= first).any():
            return np.zeros((0, 2))
        rows = np.argwhere(self.field[first[0] : last[0], first[1] : last[1]] > z)
        return self.corner + (rows + first + 0.5) * self.cell

    def box(self) -> tuple[Floats, Floats]:
        """Return the lowest and highest corner (2,) of the field."""
        return self.corner, self.corner + self.cell * np.array(self.field.shape)


def _holds_any(area: Region, points: Floats) -> bool:
    """Return whether some of points (k, 2) are in an area. Most areas that hold any show it at a few; only then are all looked at."""
    few = points[:: max(1, len(points) // 64)]
    return any(len(some) and bool(area.contains(some).any()) for some in (few, points))


ARC_CHORD = 0.02
"""mm: chord error at which arcs are opened before they lower a field; the cutter is taken smaller by as much."""


def chords(path: Toolpath) -> tuple[Floats, Floats, Ints, float]:
    """Return starts and ends (m, 3) of the straight pieces of a path's feed moves, the block (m,) each is of, and how far an arc may be
    from its chords in mm."""
    start, sweep = path.starts(), path.sweeps()
    arcs = path.motion >= Motion.ARC_CW
    radius = np.where(arcs, np.linalg.norm(start[:, :2] - path.centre[:, :2], axis=1), 0.0)
    count = np.ones(len(path), dtype=np.int64)
    with np.errstate(divide="ignore"):
        step = 2.0 * np.arccos(np.clip(1.0 - ARC_CHORD / radius[arcs], 0.0, 1.0))
    count[arcs] = np.maximum(np.ceil(np.abs(sweep[arcs]) / step), 1).astype(np.int64)
    count[path.motion == Motion.RAPID] = 0
    rows, step_index = items_of(count)
    share = np.stack([step_index, step_index + 1], axis=1) / count[rows][:, None]
    ends = [_positions(path, start, sweep, rows, share[:, k]) for k in (0, 1)]
    return ends[0], ends[1], rows, ARC_CHORD if arcs.any() else 0.0


def cutting_chords(path: Toolpath, tool: Tool) -> tuple[Floats, Floats, Ints, float]:
    """Return the `chords` of a path as a flat, bull or ball end cutter of the tool's radius that cuts no more goes along them: a pointed
    tool counts from where it has its whole width."""
    starts, ends, rows, error = chords(path)
    if tool.full_width_height > 0.0:
        starts, ends = _as_flat(starts, ends, tool.full_width_height)
    return starts, ends, rows, error


def positions_on(path: Toolpath, rows: Ints, share: Floats) -> Floats:
    """Return positions (m, 3) on blocks (m,) of a path, at shares (m,) of their length."""
    return _positions(path, path.starts(), path.sweeps(), rows, share)


def _positions(path: Toolpath, start: Floats, sweep: Floats, rows: Ints, share: Floats) -> Floats:
    points = start[rows] + share[:, None] * (path.position[rows] - start[rows])
    arcs = np.flatnonzero(path.motion[rows] >= Motion.ARC_CW)
    at = rows[arcs]
    angle = share[arcs] * sweep[at]
    ray = start[at, :2] - path.centre[at, :2]
    points[arcs, :2] = path.centre[at, :2] + turn(ray, angle)
    return points


def _as_flat(starts: Floats, ends: Floats, point: float) -> tuple[Floats, Floats]:
    """Return straight moves (m, 3) of a tool with a point of a height (mm) as those of a flat one that leaves no less material.

    What the point takes off below the full width stays. A move straight down takes all above its lower end, and not only, as slopes are
    taken, what is above its higher one: drilling is nothing else.
    """
    lift = np.array([0.0, 0.0, point])
    starts, ends = starts + lift, ends + lift
    plumb = (starts[:, :2] == ends[:, :2]).all(axis=1)
    low = np.minimum(starts[plumb, 2], ends[plumb, 2])
    starts[plumb, 2], ends[plumb, 2] = low, low
    return starts, ends


def _fixed(array: Floats) -> Floats:
    array.setflags(write=False)
    return array
