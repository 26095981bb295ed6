"""Passes of contacts as far apart as the wanted scallop height allows, everywhere, from the rim of an area inwards.

A distance that counts stepovers (`stepovers.py`) spreads over the joined faces; its level lines are the passes, the first one so near the
rim that a square corner of it is reached. Where fronts meet, level lines have corners or end: one more pass along such a ridge takes what
they leave between them, wherever that is more than the wanted height.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.spatial import cKDTree

from trunnion.geometry.arrays import Floats
from trunnion.geometry.contours import SheetLine, whole_levels
from trunnion.geometry.fields import Metric, distances
from trunnion.geometry.ridges import Ridged, opened, ridged
from trunnion.geometry.sheet import Sheet, sheet_of, split_finely
from trunnion.model.tool import Tool
from trunnion.plan.surface.drive import SurfaceDrive
from trunnion.plan.surface.scallop import stepover_on_plane
from trunnion.progress import QUIET, Progress
from trunnion.toolpath.surface.contacts import Contacts
from trunnion.toolpath.surface.stepovers import metric_of, spread, stepover_measure

FINENESS = 0.5
"""Stepovers: the longest edge of the triangles that distances are measured over."""
AIM = 0.93
"""Of the scallop height: what passes are laid for. Distances over triangles are a few hundredths off, and level lines are farther apart
where they bend; so the highest ridge stays within a tenth of what is wanted."""
FIRST = 0.3
"""Stepovers from the rim to the first pass: less than half a stepover from a square corner, which triangles round a little."""
FARTHEST = 0.48
"""Stepovers from the nearest pass beyond which a place on a ridge needs another one: where ridges branch, distances are a few hundredths
longer than they are measured."""
REACH = 1.5
"""Stepovers that a pass along a ridge goes on past such a place: the next one between corners is not farther."""
SMOOTHINGS = 3
"""Times that a ridge's points are put halfway between their neighbours: it was found triangle by triangle."""


def scallop_passes(drive: SurfaceDrive, tool: Tool, chord: float, progress: Progress = QUIET) -> list[Contacts]:
    """Return the passes of contacts from the rim of the drive's faces inwards, what is inside on their left, each connected part and each
    branch of it by itself; then those along ridges. Raises `Refused` for a flat end and for too large an area."""
    measure = stepover_measure(tool, AIM * drive.height)
    longest = stepover_on_plane(tool.corner_radius, drive.height)
    parts = sheet_of(drive.skin, drive.faces).components()
    made = []
    for k, part in enumerate(parts):
        share = progress.part(k / len(parts), (k + 1) / len(parts))
        share.at(0.0, "Measuring distances in stepovers")
        sheet = opened(split_finely(part, measure, FINENESS, share))
        metric = metric_of(sheet, measure)
        rims = sheet.rims()
        # An area that is closed all round begins at its highest place.
        rim = np.concatenate(rims) if rims else np.array([np.argmax(sheet.points[:, 2])])
        found = ridged(metric, *distances(metric, rim), FINENESS * longest)
        lines = _nested(found.sheet, whole_levels(found.sheet, found.time + 1.0 - FIRST))
        contacts = [found.sheet.on_edges(line.ends, line.share) for line in lines]
        contacts += _along_ridges(found, metric_of(found.sheet, measure), lines, longest)
        closed = [line.closed for line in lines] + [False] * (len(contacts) - len(lines))
        made += [Contacts(point=p, normal=n, closed=c)
                 for (p, n), c in ((spread(*pn, c, tool.radius, chord, longest), c) for pn, c in zip(contacts, closed, strict=True))]
    return made


def _nested(sheet: Sheet, lines: Sequence[SheetLine]) -> list[SheetLine]:
    """Return lines of ascending levels so that each is followed by those inside of it, branch by branch."""
    if not lines:
        return []
    middles = [sheet.on_edges(line.ends, line.share)[0] for line in lines]
    levels = np.array([line.level for line in lines])
    inside: dict[int, list[int]] = {-1: []}
    for k, line in enumerate(lines):
        outer = np.flatnonzero(levels == line.level - 1)
        inside[k] = []
        if len(outer):
            owner = np.repeat(outer, [len(middles[j]) for j in outer])
            inside[int(owner[cKDTree(np.concatenate([middles[j] for j in outer])).query(middles[k][0])[1]])].append(k)
        else:
            inside[-1].append(k)
    order, todo = [], inside[-1][::-1]
    while todo:
        k = todo.pop()
        order.append(lines[k])
        todo += inside[k][::-1]
    return order


def _along_ridges(found: Ridged, metric: Metric, lines: Sequence[SheetLine], stepover: float) -> list[tuple[Floats, Floats]]:
    """Return points and normals (k, 3) of passes along the ridges where places are too far from all lines."""
    if not lines or not found.ridges:
        return []
    rows = np.concatenate([line.ends.ravel() for line in lines])
    level = np.repeat([line.level - 1.0 + FIRST for line in lines], [2 * len(line.share) for line in lines])
    away, _ = distances(metric, rows, np.abs(found.time[rows] - level))
    ways = []
    for ridge in found.ridges:
        point, normal = _smoothed(found.sheet.points[ridge], found.sheet.normals[ridge], bool(ridge[0] == ridge[-1]))
        run = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(point, axis=0), axis=1))])
        lacking = run[away[ridge] > FARTHEST]
        if len(lacking):
            first = np.searchsorted(lacking, run - REACH * stepover)
            wanted = (first < len(lacking)) & (lacking[np.minimum(first, len(lacking) - 1)] <= run + REACH * stepover)
            edges = np.flatnonzero(np.diff(wanted.astype(np.int8), prepend=0, append=0)).reshape(-1, 2)
            ways += [(point[a:b], normal[a:b]) for a, b in edges.tolist() if b - a > 1]
    return _in_turn(ways)


def _in_turn(ways: list[tuple[Floats, Floats]]) -> list[tuple[Floats, Floats]]:
    """Return ways in an order in which each begins near the end of the one before, some of them the other way round."""
    ways, order = list(ways), list[tuple[Floats, Floats]]()
    while ways:
        here = order[-1][0][-1] if order else ways[0][0][0]
        gaps = np.array([[np.linalg.norm(point[k] - here) for k in (0, -1)] for point, _ in ways])
        row, end = divmod(int(np.argmin(gaps)), 2)
        point, normal = ways.pop(row)
        order.append((point[::-1], normal[::-1]) if end else (point, normal))
    return order


def _smoothed(point: Floats, normal: Floats, closed: bool) -> tuple[Floats, Floats]:
    """Return a ridge's points and normals (k, 3), smoother; its ends stay."""
    for _ in range(0 if closed else SMOOTHINGS):
        point, normal = (np.vstack([x[:1], 0.25 * (x[:-2] + 2.0 * x[1:-1] + x[2:]), x[-1:]]) for x in (point, normal))
    return point, normal / np.linalg.norm(normal, axis=1, keepdims=True)
