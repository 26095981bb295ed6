"""Where fronts meet: the lines over a sheet on which a distance has its ridges.

A distance rises along the paths that its fronts took. Across a ridge these paths run towards each other, so the distance's level lines have
corners there: between the corners of neighbouring lines it is farther than between the lines. Triangles that a ridge crosses are parted
along it, for inside of them the distance is not even.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.sheet.fields import Metric
from trunnion.geometry.sheet.sheet import Sheet

LEAST_ANGLE = math.cos(math.radians(36.0))
"""Cosine of the least angle between two paths that meet: level lines less sharp than 144 degrees are five hundredths farther apart at
their corners than between."""


NEAR_END, SLACK = 0.01, 0.25
"""Shares of an edge: how near its ends it is parted at most, and how far past them fronts may seem to meet, for a ridge often runs
through points."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RidgedSheet:
    """A sheet whose triangles are parted along the ridges of a distance, that distance (v,), and the ridges: rows of points (k,) each,
    without branches; the last of a closed one is its first again."""

    sheet: Sheet
    time: Floats
    ridges: list[Ints]


def ridged(metric: Metric, time: Floats, foot: Floats, gap: float) -> RidgedSheet:
    """Return the sheet parted along the ridges of distances (v,) that came from positions (v, 3), as `geometry.fields.distances` gives
    them.

    Ridges whose ends lie within `gap` mm of each other are one.
    """
    sheet = metric.sheet
    ends, side = sheet.edges()
    share, top, meets = _joined(metric, ends, side, time, foot)
    crossed = np.flatnonzero(meets)
    parted, number = sheet.parted(ends, side, crossed, share[crossed])
    time = np.concatenate([time, top[crossed]])
    split = number[side] >= 0
    pairs = [number[side][split.sum(axis=1) == 2][split[split.sum(axis=1) == 2]].reshape(-1, 2)]
    # In a triangle where three ridges meet, both lower points are joined to the highest one.
    stars = number[side][split.all(axis=1)]
    high = np.argmax(time[stars], axis=1) if len(stars) else np.zeros(0, np.int64)
    pairs += [
        np.column_stack(
            [stars[np.arange(len(stars)), high], stars[np.arange(len(stars)), (high + k) % 3]]
        )
        for k in (1, 2)
    ]
    return RidgedSheet(
        sheet=parted, time=time, ridges=_chained(parted.points, _lines(np.concatenate(pairs)), gap)
    )


def opened(sheet: Sheet) -> Sheet:
    """Return the sheet with those edges halved that run through it from rim to rim: a distance from its rims would be nothing all over a
    triangle in a corner."""
    ends, side = sheet.edges()
    lone = np.bincount(side.ravel(), minlength=len(ends)) == 1
    on_rim = np.zeros(len(sheet.points), bool)
    on_rim[ends[lone]] = True
    halved = np.flatnonzero(on_rim[ends].all(axis=1) & ~lone)
    return sheet.parted(ends, side, halved, np.full(len(halved), 0.5))[0]


def _chained(points: Floats, lines: list[Ints], gap: float) -> list[Ints]:
    """Return lines of which those whose ends lie within a gap (mm) of each other are one; nearest ends are joined first, and where a third
    line ends beside two that were joined it goes on to the nearest end of these."""
    open_lines = [line for line in lines if line[0] != line[-1]]
    if len(open_lines) < 2:
        return lines
    tips = points[np.concatenate([line[[0, -1]] for line in open_lines])]
    pairs = cKDTree(tips).query_pairs(gap, output_type="ndarray")
    pairs = pairs[
        np.lexsort(
            (
                pairs[:, 1],
                pairs[:, 0],
                np.linalg.norm(tips[pairs[:, 0]] - tips[pairs[:, 1]], axis=1),
            )
        )
    ]
    partner = np.full(len(tips), -1)
    for a, b in pairs.tolist():
        if partner[a] < 0 and partner[b] < 0 and a // 2 != b // 2:
            partner[a], partner[b] = b, a
    ends = np.concatenate([line[[0, -1]] for line in open_lines])
    for tip in np.flatnonzero(partner < 0).tolist():
        adjacent = [a + b - tip for a, b in pairs.tolist() if tip in (a, b) and a // 2 != b // 2]
        if adjacent and ends[adjacent[0]] != ends[tip]:
            line, node = open_lines[tip // 2], ends[adjacent[0]]
            open_lines[tip // 2] = np.append(line, node) if tip % 2 else np.insert(line, 0, node)
    made, used = [], np.zeros(len(open_lines), bool)
    for tip in [*np.flatnonzero(partner < 0).tolist(), *range(len(tips))]:
        parts = []
        while tip >= 0 and not used[tip // 2]:
            used[tip // 2] = True
            parts.append(open_lines[tip // 2][:: 1 if tip % 2 == 0 else -1])
            tip = int(partner[tip ^ 1])
        if parts:
            made.append(np.concatenate(parts))
    return [line for line in lines if line[0] == line[-1]] + made


def _joined(
    metric: Metric, ends: Ints, side: Ints, time: Floats, foot: Floats
) -> tuple[Floats, Floats, Bools]:
    """Return where on each edge (e,) fronts from both ends meet, as a share of its path, when, and whether they do."""
    sheet = metric.sheet
    length = np.empty(len(ends))
    length[side] = metric.lengths
    a, b = ends.T
    edge, came = _unit(sheet.points[b] - sheet.points[a]), _unit(sheet.points - foot)
    forth, back = (came[a] * edge).sum(axis=1), -(came[b] * edge).sum(axis=1)
    meets = (
        ((came[a] * came[b]).sum(axis=1) < LEAST_ANGLE)
        & (forth + back > 0.0)
        & np.isfinite(time[ends]).all(axis=1)
    )
    meets &= (np.linalg.norm(came[ends], axis=2) > 0.5).all(axis=1)
    closing = np.maximum((forth + back) * length, tolerance.PARAMETRIC)
    share = (time[b] - time[a] + back * length) / closing
    meets &= np.abs(share - 0.5) < 0.5 + SLACK
    share = np.clip(share, NEAR_END, 1.0 - NEAR_END)
    return share, time[a] + share * forth * length, meets


def _lines(pairs: Ints) -> list[Ints]:
    """Return the lines of nodes that pairs (p, 2) of them make, each up to where it ends or branches."""
    adjacent: dict[int, list[int]] = {}
    for a, b in pairs.tolist():
        if b not in adjacent.setdefault(a, []):
            adjacent[a].append(b)
            adjacent.setdefault(b, []).append(a)
    used: set[tuple[int, int]] = set()
    lines = []
    knots = [n for n in sorted(adjacent) if len(adjacent[n]) != 2]
    for first in [*knots, *sorted(adjacent)]:
        for second in adjacent[first]:
            line = [first]
            node = second
            while (line[-1], node) not in used:
                used |= {(line[-1], node), (node, line[-1])}
                line.append(node)
                if len(adjacent[node]) != 2 or node == first:
                    break
                node = next(n for n in adjacent[node] if n != line[-2])
            if len(line) > 1:
                lines.append(np.array(line))
    return lines


def _unit(vectors: Floats) -> Floats:
    size = np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.divide(vectors, size, out=np.zeros_like(vectors), where=size > tolerance.PARAMETRIC)
