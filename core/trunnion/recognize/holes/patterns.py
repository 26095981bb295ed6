"""Patterns of equal holes: evenly around a circle (a bolt circle), along a row with one pitch, or on a rectangular grid."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from trunnion.geometry.arrays import Floats
from trunnion.geometry.facegraph import FaceGraph
from trunnion.geometry.frame import Frame
from trunnion.recognize.holes.bores import HALF
from trunnion.recognize.holes.hole import Hole
from trunnion.recognize.holes.sizes import hole_sizes
from trunnion.recognize.holes.sweep import TURN, arcs, axis_frame, swept
from trunnion.tolerance import ANGLE
from trunnion.units import rounded

CIRCLE, GRID, ROW = "circle", "grid", "row"
OFF = 0.01
"""mm: how far a hole may be from its position in a pattern, and sizes of equal holes from each other: drawings go to a hundredth."""
LEAST = 3
"""Holes from which on a pattern counts: two are always a row."""
INCOMPLETE = 5
"""Holes from which on a circle may have positions without a hole: four may lie on the corners of many a polygon."""
PRESENT = 0.7
"""Share of the positions of a circle that must have a hole."""
NEIGHBOURS = 4
"""Nearest equal holes of a hole that directions and centres of patterns are tried with: a grid has no more at its pitches."""
SPREAD = 4.0
"""A grid's pitches differ by less than this factor: beyond, it is rows on two sides of a part, each a pattern of its own."""
DECIMALS = 2
"""Positions are ordered by to a hundredth of a mm, so that the noise of a file does not change the order."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class HolePattern:
    """Equal holes in a regular order; `kind` is `circle`, `grid` or `row`, `members` are the numbers of its holes.

    A circle has a `diameter` (mm), that of its pitch circle, and its `counts` are holes and positions, more of these where some have no
    hole. Rows and grids have the `pitch` (mm) along each direction and the `counts` along it.
    """

    kind: str
    members: tuple[int, ...]
    counts: tuple[int, ...]
    diameter: float = 0.0
    pitch: tuple[float, ...] = ()


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Candidate:
    """A pattern of some positions, by their numbers; `centred` when something round stands in the centre of a circle."""

    kind: str
    members: frozenset[int]
    counts: tuple[int, ...]
    diameter: float = 0.0
    pitch: tuple[float, ...] = ()
    centred: bool = False

    @property
    def rank(self) -> tuple[object, ...]:
        """What the better of two patterns has more of: holes, a centre, directions, and less of: distance, and numbers."""
        span = self.diameter or sum(self.pitch)
        return (
            len(self.members),
            self.centred,
            self.kind == GRID,
            -round(span, DECIMALS),
            [-m for m in sorted(self.members)],
        )


def hole_patterns(graph: FaceGraph, holes: Sequence[Hole], frame: Frame) -> tuple[HolePattern, ...]:
    """Return the patterns of holes, each hole in one at most, in the order of their first members.

    Equal holes have the same sizes, look the same way and open at one height. Of all patterns that they make the one with most holes is
    taken first. Four holes at the corners of a square are a circle where something round stands in its centre, else a grid. The first
    pitch of a grid is the one along the direction nearer to a frame's x.
    """
    found: list[HolePattern] = []
    for members in _equal(holes):
        first = holes[members[0]]
        x = frame.x if abs(float(frame.x @ first.direction)) < np.sqrt(0.5) else frame.y
        plane = Frame(first.mouth, x, first.direction)
        at = plane.to_local(np.array([holes[m].mouth for m in members]))[:, :2]
        order = np.lexsort(at.round(DECIMALS).T)
        for best in _patterns(at[order], _round_centres(graph, plane)):
            found.append(
                HolePattern(
                    kind=best.kind,
                    members=tuple(sorted(members[order[k]] for k in best.members)),
                    counts=best.counts,
                    diameter=rounded(best.diameter),
                    pitch=tuple(rounded(p) for p in best.pitch),
                )
            )
    return tuple(sorted(found, key=lambda p: p.members))


def _equal(holes: Sequence[Hole]) -> list[list[int]]:
    """Return the numbers of holes by what is equal, in groups that are large enough for a pattern."""
    groups: list[list[int]] = []
    sizes = [hole_sizes(h) for h in holes]
    for n in range(len(holes)):
        near = next((g for g in groups if _is_equal(holes, sizes, g[0], n)), None)
        if near is None:
            groups.append([n])
        else:
            near.append(n)
    return [g for g in groups if len(g) >= LEAST]


def _is_equal(holes: Sequence[Hole], sizes: Sequence[dict], a: int, b: int) -> bool:
    return bool(
        sizes[a].keys() == sizes[b].keys()
        and all(np.allclose(sizes[a][k], sizes[b][k], rtol=0.0, atol=OFF) for k in sizes[a])
        and float(holes[a].direction @ holes[b].direction) > np.cos(ANGLE)
        and abs(float((holes[b].mouth - holes[a].mouth) @ holes[a].direction)) < OFF
    )


def _round_centres(graph: FaceGraph, plane: Frame) -> Floats:
    """Return where the axes of round faces that stand along a plane's z go through it (k, 2); less than half a circle is no round face."""
    rows = np.flatnonzero(np.isin(graph.surface, ("cylinder", "cone")) & (graph.area > 0.0))
    rows = rows[np.abs(graph.axis[rows] @ plane.z) > np.cos(ANGLE)]
    whole = [
        r
        for r in rows
        if swept(arcs(graph, graph.edges_of[r], axis_frame(graph.axis_point[r], graph.axis[r])))
        > HALF
    ]
    return plane.to_local(graph.axis_point[whole])[:, :2]


def _patterns(at: Floats, centres: Floats) -> Iterator[_Candidate]:
    """Yield the patterns of positions (n, 2), the best of those that remain first."""
    remaining = np.arange(len(at))
    while len(remaining) >= LEAST:
        tried = _circles(at[remaining], centres)
        if not any(len(t.members) == len(remaining) and t.centred for t in tried):
            tried += _grids(at[remaining])
        if not tried:
            return
        best = max(tried, key=lambda t: t.rank)
        own = sorted(best.members)
        yield _Candidate(
            kind=best.kind,
            members=frozenset(remaining[own].tolist()),
            counts=best.counts,
            diameter=best.diameter,
            pitch=best.pitch,
        )
        remaining = np.delete(remaining, own)


# Circles


def _circles(at: Floats, centres: Floats) -> list[_Candidate]:
    """Return the circles that positions (n, 2) lie on evenly.

    Centres that are tried: those of round faces, the middle of all, and of each position the centre of the circle through it and its two
    nearest neighbours, which on an even circle are those beside it.
    """
    apart = np.linalg.norm(at[:, None] - at[None], axis=2)
    near = np.argsort(apart.round(DECIMALS), axis=1, kind="stable")[:, :LEAST]
    through = [c for three in near if (c := _centre_through(at[three])) is not None]
    found: dict[frozenset[int], _Candidate] = {}
    for k, centre in enumerate([*centres, at.mean(axis=0), *through]):
        away = at - centre
        radius = np.hypot(away[:, 0], away[:, 1])
        order = np.argsort(radius, kind="stable")
        for group in np.split(order, np.flatnonzero(np.diff(radius[order]) > OFF) + 1):
            if len(group) >= LEAST and frozenset(group.tolist()) not in found:
                mean = float(radius[group].mean())
                angle = np.arctan2(away[group, 1], away[group, 0])
                positions = _positions(angle, OFF / mean) if mean > OFF else 0
                if positions:
                    own = frozenset(group.tolist())
                    found[own] = _Candidate(
                        kind=CIRCLE,
                        members=own,
                        counts=(len(own), positions),
                        diameter=2.0 * mean,
                        centred=k < len(centres),
                    )
    return list(found.values())


def _centre_through(three: Floats) -> Floats | None:
    """Return the centre (2,) of the circle through three points (3, 2), None when they lie in a line."""
    (b, c) = three[1:] - three[0]
    cross = float(b[0] * c[1] - b[1] * c[0])
    if abs(cross) < OFF * float(np.linalg.norm(c - b)):
        return None
    bb, cc = float(b @ b), float(c @ c)
    return three[0] + np.array([c[1] * bb - b[1] * cc, b[0] * cc - c[0] * bb]) / (2.0 * cross)


def _positions(angle: Floats, near: float) -> int:
    """Return the number of even positions on a circle that holes at angles (n,) stand on, 0 when they don't; `near` is in radians."""
    most = int(len(angle) / PRESENT) if len(angle) >= INCOMPLETE else len(angle)
    for count in range(len(angle), most + 1):
        turn = TURN / count
        number = (angle - angle[0]) / turn
        if np.abs(number - np.round(number)).max() * turn < 2.0 * near:
            numbers = np.round(number).astype(np.int64) % count
            return count if len(np.unique(numbers)) == len(angle) else 0
    return 0


# Rows and grids


def _grids(at: Floats) -> list[_Candidate]:
    """Return the rows and rectangular grids among positions (n, 2), along the directions from each to its nearest neighbours."""
    found: list[_Candidate] = []
    for angle in _directions(at):
        along = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
        found.extend(_along(at @ along.T))
    return found


def _directions(at: Floats) -> list[float]:
    """Return the directions from positions to their nearest neighbours as angles from -45 to 45 degrees, each once: rows run along them or
    across."""
    apart = np.linalg.norm(at[:, None] - at[None], axis=2)
    near = np.argsort(apart.round(DECIMALS), axis=1, kind="stable")[:, 1 : NEIGHBOURS + 1]
    step = (at[near] - at[:, None]).reshape(-1, 2)
    angle = np.arctan2(step[:, 1], step[:, 0])
    folded = (angle + np.pi / 4.0 + ANGLE) % (np.pi / 2.0) - np.pi / 4.0 - ANGLE
    folded = np.sort(folded)
    return folded[np.concatenate([[True], np.diff(folded) > ANGLE])].tolist()


def _along(at: Floats) -> Iterator[_Candidate]:
    """Yield the rows along x and along y and the largest grid from each position on."""
    levels = [_levels(at[:, k]) for k in (0, 1)]
    cells = {
        (int(i), int(j)): n for n, (i, j) in enumerate(zip(levels[0][1], levels[1][1], strict=True))
    }
    rows = {j: sorted(i for i, k in cells if k == j) for _, j in cells}
    columns = {i: sorted(j for k, j in cells if k == i) for i, _ in cells}
    following = {
        **{("x", a, j): b for j, row in rows.items() for a, b in pairwise(row)},
        **{("y", i, a): b for i, column in columns.items() for a, b in pairwise(column)},
    }
    for i, j in cells:
        xs = _steps(levels[0][0], i, following.get(("x", i, j)))
        ys = _steps(levels[1][0], j, following.get(("y", i, j)))
        pitch = (_pitch(levels[0][0], xs), _pitch(levels[1][0], ys))
        width = next((k for k, x in enumerate(xs) if (x, j) not in cells), len(xs))
        height = next((k for k, y in enumerate(ys) if (i, y) not in cells), len(ys))
        for counts in ((width, 1), (1, height), _largest(cells, xs, ys)):
            used = [k for k in (0, 1) if counts[k] > 1]
            wide = len(used) > 1 and max(pitch) > SPREAD * min(pitch)
            if counts[0] * counts[1] >= LEAST and not wide:
                yield _Candidate(
                    kind=GRID if len(used) > 1 else ROW,
                    members=frozenset(
                        cells[x, y] for x in xs[: counts[0]] for y in ys[: counts[1]]
                    ),
                    counts=tuple(counts[k] for k in used),
                    pitch=tuple(pitch[k] for k in used),
                )


def _levels(values: Floats) -> tuple[Floats, np.ndarray]:
    """Return the levels that values (n,) lie on, rising, and the number of each value's level."""
    order = np.argsort(values, kind="stable")
    new = np.concatenate([[0], np.cumsum(np.diff(values[order]) > OFF)])
    numbers = np.empty(len(values), dtype=np.int64)
    numbers[order] = new
    return np.bincount(numbers, values) / np.bincount(numbers), numbers


def _steps(levels: Floats, first: int, second: int | None) -> list[int]:
    """Return the numbers of the levels that follow each other at the pitch of the first two."""
    found = [first]
    if second is None:
        return found
    pitch = float(levels[second] - levels[first])
    while True:
        wanted = float(levels[first]) + len(found) * pitch
        nearest = int(np.abs(levels - wanted).argmin())
        if abs(float(levels[nearest]) - wanted) > OFF:
            return found
        found.append(nearest)


def _pitch(levels: Floats, steps: Sequence[int]) -> float:
    """Return the mean distance of levels that follow each other at one pitch, infinite of one alone."""
    if len(steps) < 2:
        return np.inf
    return float(levels[steps[-1]] - levels[steps[0]]) / (len(steps) - 1)


def _largest(
    cells: dict[tuple[int, int], int], xs: Sequence[int], ys: Sequence[int]
) -> tuple[int, int]:
    """Return how many columns and rows the largest full grid has from the first cell on."""
    best, width = (1, 1), len(xs)
    for height, y in enumerate(ys, start=1):
        width = next((k for k, x in enumerate(xs[:width]) if (x, y) not in cells), width)
        if width * height > best[0] * best[1]:
            best = (width, height)
    return best
