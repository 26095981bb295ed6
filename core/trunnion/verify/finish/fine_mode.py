"""The fine mode: scallop height, deepest gouge and steps at seams on a chosen patch, against the exact surface.

The patch is cut into cells of the faces' own parameters. Over a cell, what is left is bounded from both sides
(`kernels/residual_bounds.py`) on the parallelogram of its tangents, and the surface leaves that by at most half its second derivatives
times the squares of the cell's half sides. A cell that may still hold more than the most found, or less than the least, by over the bound
is quartered: what is reported is attained on the surface, and nothing on the patch is beyond it by more than the bound. A piece of a face
smaller than the spacing, and so between the samples of its cells, may be missed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
from scipy.spatial import cKDTree

from trunnion.findings import BadInput, OutOfMemory
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.part.shape.exact import ExactPoints
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.threads import in_parallel
from trunnion.verify.finish.sweep import flutes_of, tree_of
from trunnion.verify.kernels import residual as residual_kernel
from trunnion.verify.kernels import residual_bounds as kernel
from trunnion.verify.kernels.residual import Flutes, SpanTree
from trunnion.verify.motion import Moves

FINE_BOUND = 2e-4
"""mm: how far the fine mode's figures may be from the truth."""
FAR = 2.0
"""mm: what is left beyond this is not a scallop; it is only reported to be so much."""
MOST_CELLS = 1_000_000
"""Cells looked at in one round, about 300 MB."""
CHUNK = 50
"""Cells between two looks at cancel."""
ROUNDS = 40
"""Times that cells are quartered at most: to nothing."""
ARRAYS = tuple(ExactPoints.__slots__)
CLIMB, CLIMBS = 7, 12
"""Positions along each side of a grid that closes in on a ridge, and how often: a cell's side is then known to a hundred-thousandth."""
LIFTS = 3
"""Times a surface is lifted to the height of its ridges: the second one changes nothing but the bound."""


class FineFace(Protocol):
    """What the fine mode needs of a face: `part.exact.ExactFace`, or a surface in closed form."""

    tag: int

    def bounds(self) -> tuple[float, float, float, float]:
        """Return the least and greatest u and v."""

    def inside(self, uv: Floats) -> Bools:
        """Return which uv (k, 2) lie inside the trim."""

    def at(self, uv: Floats) -> ExactPoints:
        """Return the surface at uv (k, 2)."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ExtremeFigure:
    """A figure in mm and where it is attained (3,), by which move (-1: none)."""

    value: float
    position: Floats
    move: int


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FineMap:
    """What the fine mode measured on a patch.

    scallop: how high the highest ridge stands along the normals, or the most left where that is `FAR`; gouge: how deep the deepest cut is,
    0 when none; both within `bound` mm. step: the largest difference in height where two operations or faces meet, with the move of the
    lower side. m samples about `spacing` apart for a map: face tags (m,), point and outward normal (m, 3), residual (m,) mm, negative below
    the surface, nearest (m,) move rows or -1, area (m,) mm2.
    """

    scallop: ExtremeFigure
    gouge: ExtremeFigure
    step: ExtremeFigure
    bound: float
    face: Ints
    point: Floats
    normal: Floats
    residual: Floats
    nearest: Ints
    area: Floats


@dataclass(slots=True, eq=False)
class _Cells:
    """Cells: face (c,) rows, middle in the parameters uv (c, 2), half sides (c, 2), whether what is above them is wanted (c,)."""

    face: Ints
    uv: Floats
    half: Floats
    above: Bools

    def __len__(self) -> int:
        return len(self.face)

    def some(self, rows: Ints | Bools) -> _Cells:
        return _Cells(*(getattr(self, name)[rows] for name in _Cells.__slots__))

    def quartered(self) -> _Cells:
        signs = np.array([[-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0], [1.0, 1.0]])
        half = 0.5 * self.half
        return _Cells(
            np.repeat(self.face, 4),
            (self.uv[:, None] + signs * half[:, None]).reshape(-1, 2),
            np.repeat(half, 4, axis=0),
            np.repeat(self.above, 4),
        )


def fine_measure(
    faces: Sequence[FineFace],
    moves: Moves,
    spacing: float = 0.2,
    *,
    low: Floats | None = None,
    high: Floats | None = None,
    window: float = 1.0,
    bound: float = FINE_BOUND,
    progress: Progress = NO_PROGRESS,
    threads: int = 0,
) -> FineMap:
    """Return scallop, gouge and steps on faces (within the box from `low` to `high` (3,) when given), all in the frame of the moves.

    Cells begin about `spacing` mm wide. `window` mm is how far beside a seam the lowest positions of both sides are compared: as far as two
    passes are apart at least. Raises `BadInput` when there is nothing to measure, `OutOfMemory` when the patch is too large.
    """
    flutes = flutes_of(moves)
    tree = tree_of(moves, np.flatnonzero(~moves.rapid), flutes)
    patch = _Patch(faces, tree, flutes, low, high, bound, progress, threads)
    cells = patch.inside(patch.begin(spacing))
    if not len(cells.cells):
        raise BadInput(
            "the fine mode has nothing to measure: no place of the chosen faces is inside the box"
        )
    first = patch.look(cells, 0.0, progress.part(0.0, 0.3))
    held = np.flatnonzero(cells.holds)
    most, least = _Best(1.0), _Best(-1.0)
    patch.search(cells, first, 0.0, (most, least), progress.part(0.3, 0.6))
    scallop = patch.ridge(cells, most, progress.part(0.6, 1.0))
    move_of = np.append(moves.section, -1)
    row, at = cells.cells.face[held], cells.at
    labels = np.column_stack([row, move_of[first.nearest[held]]])
    return FineMap(
        scallop=scallop,
        gouge=ExtremeFigure(value=max(-least.value, 0.0), position=least.position, move=least.move),
        step=_step(
            at.point[held], labels, first.residual[held], first.nearest[held], spacing, window
        ),
        bound=bound,
        face=np.array([f.tag for f in faces])[row],
        point=at.point[held],
        normal=at.normal[held],
        residual=first.residual[held],
        nearest=first.nearest[held],
        area=cells.area[held],
    )


@dataclass(slots=True, eq=False)
class _LocatedCells:
    """Cells with the surface at their middles, and whether those are on the patch (c,)."""

    cells: _Cells
    at: ExactPoints
    holds: Bools

    @property
    def area(self) -> Floats:
        """The areas of the cells (c,) mm2."""
        return np.asarray(
            4.0
            * self.cells.half.prod(axis=1)
            * np.linalg.norm(np.cross(self.at.du, self.at.dv), axis=1)
        )


@dataclass(slots=True, eq=False)
class _Looked:
    """What is left at the middles of cells, by which move, and bounds over each cell (c,)."""

    residual: Floats
    nearest: Ints
    upper: Floats
    lower: Floats


@dataclass(slots=True, eq=False)
class _Patch:
    """The faces of a patch, and what cuts near it."""

    faces: Sequence[FineFace]
    tree: SpanTree
    flutes: Flutes
    low: Floats | None
    high: Floats | None
    bound: float
    progress: Progress
    threads: int

    def begin(self, spacing: float) -> _Cells:
        """Return cells about `spacing` mm wide over all faces."""
        made: list[_Cells] = []
        for row, face in enumerate(self.faces):
            u0, u1, v0, v1 = face.bounds()
            if not np.isfinite([u0, u1, v0, v1]).all():
                raise BadInput(
                    f"face {face.tag} has no end in its own parameters and can't be measured"
                )
            share = (np.arange(9) + 0.5) / 9
            grid = np.stack(
                np.meshgrid(u0 + share * (u1 - u0), v0 + share * (v1 - v0)), axis=-1
            ).reshape(-1, 2)
            at = face.at(grid)
            count = [
                max(1, int(np.ceil(span * np.linalg.norm(d, axis=1).max() / spacing)))
                for span, d in ((u1 - u0, at.du), (v1 - v0, at.dv))
            ]
            if sum(len(m) for m in made) + count[0] * count[1] > MOST_CELLS:
                raise OutOfMemory(
                    f"the fine mode would need over {MOST_CELLS} cells at {spacing:g} mm: choose fewer faces or a larger "
                    "spacing"
                )
            half = np.array([(u1 - u0) / count[0], (v1 - v0) / count[1]]) / 2
            i, j = (
                a.ravel()
                for a in np.meshgrid(np.arange(count[0]), np.arange(count[1]), indexing="ij")
            )
            uv = np.column_stack([u0 + (2 * i + 1) * half[0], v0 + (2 * j + 1) * half[1]])
            made.append(
                _Cells(
                    np.full(len(uv), row), uv, np.tile(half, (len(uv), 1)), np.ones(len(uv), bool)
                )
            )
        return _Cells(
            *(np.concatenate([getattr(m, name) for m in made]) for name in _Cells.__slots__)
        )

    def inside(self, cells: _Cells) -> _LocatedCells:
        """Return the cells that touch the patch."""
        if len(cells) > MOST_CELLS:
            raise OutOfMemory(
                "the fine mode needs too many cells: choose fewer faces or a smaller box"
            )
        parts, points, holds = [], [], []
        signs = np.array(
            [[0, 0], [-1, -1], [1, -1], [-1, 1], [1, 1], [0, -1], [0, 1], [-1, 0], [1, 0]],
            dtype=np.float64,
        )
        for row, face in enumerate(self.faces):
            self.progress.check()
            mine = cells.some(cells.face == row)
            at = face.at(mine.uv)
            near = self._in_box(
                at.point, mine.half[:, :1] * np.abs(at.du) + mine.half[:, 1:] * np.abs(at.dv)
            )
            mine, at = mine.some(near), _some(at, near)
            within = _within(face, mine, signs)
            overlaps = np.asarray(within.any(axis=1))
            parts.append(mine.some(overlaps))
            points.append(_some(at, overlaps))
            holds.append(
                (within[:, 0] & self._in_box(at.point, np.zeros((len(mine), 3))))[overlaps]
            )
        joined = ExactPoints(
            **{name: np.concatenate([getattr(p, name) for p in points]) for name in ARRAYS}
        )
        whole = _Cells(
            *(np.concatenate([getattr(m, name) for m in parts]) for name in _Cells.__slots__)
        )
        return _LocatedCells(whole, joined, np.concatenate(holds))

    def _in_box(self, points: Floats, margin: Floats) -> Bools:
        low = -np.inf if self.low is None else np.asarray(self.low)
        high = np.inf if self.high is None else np.asarray(self.high)
        return np.asarray(((points >= low - margin) & (points <= high + margin)).all(axis=1))

    def look(
        self, located: _LocatedCells, lift: float, progress: Progress, least: float = -np.inf
    ) -> _Looked:
        """Return what is left over cells of the surface, lifted along its normals; by how much a cell falls below `least` is not
        reported."""
        n, at, (u, v) = len(located.cells), located.at, located.cells.half.T
        a, b = (
            u[:, None] * (at.du + lift * at.normal_du),
            v[:, None] * (at.dv + lift * at.normal_dv),
        )
        slack = 0.5 * (at.bend[:, 0] * u * u + 2.0 * at.bend[:, 1] * u * v + at.bend[:, 2] * v * v)
        if lift:
            # A lifted surface bends more by what its normals turn, and half as much again for what that changes over a cell.
            slack *= 1.0 + 1.5 * lift * sum(
                np.divide(
                    np.linalg.norm(t, axis=1),
                    np.linalg.norm(d, axis=1),
                    out=np.zeros(n),
                    where=(d != 0.0).any(axis=1),
                )
                for t, d in ((at.normal_du, at.du), (at.normal_dv, at.dv))
            )
        residual, nearest, upper, lower = (
            np.full(n, FAR),
            np.full(n, -1),
            np.full(n, FAR),
            np.full(n, -np.inf),
        )
        points = at.point + lift * at.normal

        def some(first: int, last: int) -> None:
            kernel.cell_residual_loop(
                first,
                last,
                points,
                a,
                b,
                slack,
                self.tree,
                self.flutes,
                FAR,
                least,
                self.bound,
                located.cells.above,
                residual,
                nearest,
                upper,
                lower,
            )

        in_parallel(some, n, CHUNK, progress, "Measuring scallops", self.threads)
        return _Looked(residual, nearest, upper, lower)

    def search(
        self,
        located: _LocatedCells,
        looked: _Looked,
        lift: float,
        wanted: Sequence[_Best],
        progress: Progress,
    ) -> None:
        """Quarter cells until none may beat what is wanted by more than the bound."""
        lowest = -np.inf
        for k in range(ROUNDS):
            above, below = np.zeros((2, len(located.cells)), bool)
            for best in wanted:
                if best.raised(located, looked):
                    self.climb(best, lift)
                lowest = best.value if best.sign < 0.0 else lowest
            for best in wanted:
                limit = best.value + best.sign * self.bound
                if best.sign > 0.0:
                    above |= looked.upper > limit
                else:
                    below |= looked.lower < limit
            if not (above | below).any():
                return
            share = progress.part(1.0 - 0.8**k, 1.0 - 0.8 ** (k + 1))
            located = self.inside(
                replace(located.cells, above=above).some(above | below).quartered()
            )
            looked = self.look(located, lift, share, lowest if lowest > -np.inf else np.inf)

    def climb(self, best: _Best, lift: float) -> None:
        """Raise what was found last to the ridge or dip beside it: no middle of a cell lies on one, and what is found decides which cells
        have to be quartered."""
        face, half = self.faces[best.face], best.half
        share = np.linspace(-1.0, 1.0, CLIMB)
        grid = np.stack(np.meshgrid(share, share), axis=-1).reshape(-1, 2)
        for _ in range(CLIMBS):
            uv = best.uv + grid * half
            uv = uv[face.inside(uv)]
            at = face.at(uv)
            inside = self._in_box(at.point, np.zeros((len(uv), 3)))
            points = (at.point + lift * at.normal)[inside]
            residual, nearest = np.full(len(points), FAR), np.full(len(points), -1)
            residual_kernel.residual_bvh_loop(
                0,
                len(points),
                points,
                np.arange(len(points)),
                self.tree,
                self.flutes,
                kernel.CLOSE * self.bound,
                residual,
                nearest,
            )
            best.take(residual, nearest, uv[inside], at.point[inside])
            half = 0.4 * half

    def ridge(self, located: _LocatedCells, most: _Best, progress: Progress) -> ExtremeFigure:
        """Return how high the highest ridge stands along the normals: where the lifted surface just leaves all material behind.

        The distance to a cutter beside is shorter than the way up along the normal, by the more the steeper the ridge.
        """
        height, best = most.value, most
        if not self.bound < height < FAR:
            return most.extreme()
        for k in range(LIFTS):
            share = progress.part(k / LIFTS, (k + 1) / LIFTS)
            over = _Best(1.0)
            self.search(
                located,
                self.look(located, height, share.part(0.0, 0.5), np.inf),
                height,
                (over,),
                share.part(0.5, 1.0),
            )
            if over.value > 0.0:
                height, best = height + over.value, over
            if over.value <= self.bound:
                break
        return ExtremeFigure(value=height, position=best.position, move=best.move)


def _within(face: FineFace, cells: _Cells, signs: Floats) -> Bools:
    """Return which uv (c, s), at signs (s, 2) times the half sides from the middle, lie inside the trim of the face that cells are on.

    All cells of a face are of one size, and neighbours share corners: each position is evaluated once.
    """
    if not len(cells):
        return np.zeros((0, len(signs)), bool)
    u0, _, v0, _ = face.bounds()
    start, half = np.array([u0, v0]), cells.half[0]
    steps = np.rint((cells.uv[:, None] - start) / half + signs)
    position, row = np.unique(steps[..., 0] + 1j * steps[..., 1], return_inverse=True)
    inside = face.inside(start + np.column_stack([position.real, position.imag]) * half)
    return np.asarray(inside[row.reshape(len(cells), len(signs))])


def _some(at: ExactPoints, rows: Bools) -> ExactPoints:
    return ExactPoints(**{name: getattr(at, name)[rows] for name in ARRAYS})


class _Best:
    """The most (sign 1) or least (sign -1) found, with its position on its face, and the half sides of its cell."""

    def __init__(self, sign: float) -> None:
        self.value, self.position, self.move, self.sign = (
            -sign * np.inf,
            np.full(3, np.nan),
            -1,
            sign,
        )
        self.face, self.uv, self.half = -1, np.full(2, np.nan), np.zeros(2)

    def raised(self, located: _LocatedCells, looked: _Looked) -> bool:
        """Take what is left at the cells' middles into account; return whether that changed anything."""
        rows = np.flatnonzero(located.holds)
        if not len(rows) or not self.take(
            looked.residual[rows],
            looked.nearest[rows],
            located.cells.uv[rows],
            located.at.point[rows],
        ):
            return False
        row = rows[np.argmax(self.sign * looked.residual[rows])]
        self.face, self.half = int(located.cells.face[row]), located.cells.half[row]
        return True

    def take(self, residual: Floats, nearest: Ints, uv: Floats, point: Floats) -> bool:
        """Take what is residual (k,) at positions uv (k, 2) of one face into account."""
        if not len(residual):
            return False
        row = int(np.argmax(self.sign * residual))
        if self.sign * residual[row] <= self.sign * self.value:
            return False
        self.value, self.position, self.move, self.uv = (
            float(residual[row]),
            point[row],
            int(nearest[row]),
            uv[row],
        )
        return True

    def extreme(self) -> ExtremeFigure:
        """Return it as a figure."""
        return ExtremeFigure(value=self.value, position=self.position, move=self.move)


def _step(
    point: Floats, label: Ints, residual: Floats, nearest: Ints, spacing: float, window: float
) -> ExtremeFigure:
    """Return the largest difference between the lowest positions on both sides of a seam, where neighbours have other labels (m, 2)."""
    none = ExtremeFigure(value=0.0, position=np.full(3, np.nan), move=-1)
    if len(point) < 2:
        return none
    tree = cKDTree(point)
    pairs = tree.query_pairs(1.5 * spacing, output_type="ndarray")
    pairs = pairs[
        (label[pairs[:, 0]] != label[pairs[:, 1]]).any(axis=1) & (nearest[pairs] >= 0).all(axis=1)
    ]
    if not len(pairs):
        return none
    middle = point[pairs].mean(axis=1)
    # One look in each cube of half a window is enough: neighbours see nearly the same.
    _, rows = np.unique(
        np.floor(middle / (0.5 * window)).astype(np.int64), axis=0, return_index=True
    )
    best = none
    for row in np.sort(rows):
        around = np.array(tree.query_ball_point(middle[row], window))
        sides = [around[(label[around] == label[k]).all(axis=1)] for k in pairs[row]]
        lows = [side[np.argmin(residual[side])] for side in sides]
        jump = abs(float(residual[lows[0]] - residual[lows[1]]))
        if jump > best.value:
            lower = lows[int(residual[lows[0]] > residual[lows[1]])]
            best = ExtremeFigure(value=jump, position=middle[row], move=int(nearest[lower]))
    return best
