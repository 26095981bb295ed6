"""Where fronts meet: the lines over a sheet on which a distance has its ridges.

A distance rises along the ways that its fronts took. Across a ridge these ways run towards each other, so the distance's level lines have
corners there: between the corners of neighbouring lines it is farther than between the lines.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.spatial import cKDTree

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.contours import SheetLine
from trunnion.geometry.fields import Metric
from trunnion.geometry.sheet import Sheet

MEETING = math.cos(math.radians(36.0))
"""Cosine of the least angle between two ways that meet: level lines less sharp than 144 degrees are five hundredths farther apart at
their corners than between."""


def ridges(metric: Metric, time: Floats, foot: Floats) -> list[SheetLine]:
    """Return the ridge lines of distances (v,) that came from places (v, 3), as `geometry.fields.distances` gives them.

    A line ends where ridges branch, so each is without branches; they come in the order of their lowest edges.
    """
    sheet = metric.sheet
    ends, side = sheet.edges()
    share, meets = _meeting(metric, ends, side, time, foot)
    here = meets[side]
    pairs = [side[here.sum(axis=1) == 2][here[here.sum(axis=1) == 2]].reshape(-1, 2)]
    # In a triangle where three ridges meet, both lower edges are joined to the highest one.
    stars = side[here.all(axis=1)]
    top = np.argmax(time[ends[stars]].mean(axis=2), axis=1) if len(stars) else np.zeros(0, np.int64)
    for k in (1, 2):
        pairs.append(np.column_stack([stars[np.arange(len(stars)), top], stars[np.arange(len(stars)), (top + k) % 3]]))
    return [SheetLine(ends=ends[line], share=share[line], closed=bool(line[0] == line[-1]), level=0)
            for line in _lines(np.concatenate(pairs))]


def chained(sheet: Sheet, lines: list[SheetLine], gap: float) -> list[SheetLine]:
    """Return lines of which those whose ends lie within a gap (mm) of each other are one; nearest ends are joined first."""
    open_lines = [line for line in lines if not line.closed]
    if len(open_lines) < 2:
        return lines
    tips = np.concatenate([sheet.on_edges(line.ends[[0, -1]], line.share[[0, -1]])[0] for line in open_lines])
    pairs = cKDTree(tips).query_pairs(gap, output_type="ndarray")
    pairs = pairs[np.lexsort((pairs[:, 1], pairs[:, 0], np.linalg.norm(tips[pairs[:, 0]] - tips[pairs[:, 1]], axis=1)))]
    partner = np.full(len(tips), -1)
    for a, b in pairs.tolist():
        if partner[a] < 0 and partner[b] < 0 and a // 2 != b // 2:
            partner[a], partner[b] = b, a
    made, used = [], np.zeros(len(open_lines), bool)
    for tip in [*np.flatnonzero(partner < 0).tolist(), *range(len(tips))]:
        parts = []
        while tip >= 0 and not used[tip // 2]:
            used[tip // 2] = True
            line = open_lines[tip // 2]
            step = 1 if tip % 2 == 0 else -1
            parts.append((line.ends[::step], line.share[::step]))
            tip = int(partner[tip ^ 1])
        if parts:
            ends, share = (np.concatenate([p[k] for p in parts]) for k in (0, 1))
            made.append(SheetLine(ends=ends, share=share, closed=False, level=0))
    return [line for line in lines if line.closed] + made


def _meeting(metric: Metric, ends: Ints, side: Ints, time: Floats, foot: Floats) -> tuple[Floats, Bools]:
    """Return where on each edge (e,) fronts from both ends meet, as a share of its way, and whether they do."""
    sheet = metric.sheet
    length = np.empty(len(ends))
    length[side] = metric.lengths
    a, b = ends.T
    edge, came = _unit(sheet.points[b] - sheet.points[a]), _unit(sheet.points - foot)
    forth, back = (came[a] * edge).sum(axis=1), -(came[b] * edge).sum(axis=1)
    meets = ((came[a] * came[b]).sum(axis=1) < MEETING) & (forth + back > 0.0) & np.isfinite(time[ends]).all(axis=1)
    meets &= (np.linalg.norm(came[ends], axis=2) > 0.5).all(axis=1)
    closing = np.maximum((forth + back) * length, tolerance.PARAMETRIC)
    return np.clip((time[b] - time[a] + back * length) / closing, 0.0, 1.0), meets


def _lines(pairs: Ints) -> list[Ints]:
    """Return the lines of nodes that pairs (p, 2) of them make, each up to where it ends or branches."""
    beside: dict[int, list[int]] = {}
    for a, b in pairs.tolist():
        if b not in beside.setdefault(a, []):
            beside[a].append(b)
            beside.setdefault(b, []).append(a)
    used: set[tuple[int, int]] = set()
    lines = []
    knots = [n for n in sorted(beside) if len(beside[n]) != 2]
    for first in [*knots, *sorted(beside)]:
        for second in beside[first]:
            line = [first]
            node = second
            while (line[-1], node) not in used:
                used |= {(line[-1], node), (node, line[-1])}
                line.append(node)
                if len(beside[node]) != 2 or node == first:
                    break
                node = next(n for n in beside[node] if n != line[-2])
            if len(line) > 1:
                lines.append(np.array(line))
    return lines


def _unit(vectors: Floats) -> Floats:
    size = np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.divide(vectors, size, out=np.zeros_like(vectors), where=size > tolerance.PARAMETRIC)
