"""Passes of contacts as far apart as the wanted scallop height allows, everywhere, from the rim of an area inwards.

A distance that counts stepovers (`stepovers.py`) spreads over the joined faces; its level lines are the passes, the first one so near the
rim that a square corner of it is reached. Where fronts meet, level lines have corners or end: one more pass along such a ridge takes what
they leave between them, wherever that is more than the wanted height.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from trunnion.geometry.arrays import Floats
from trunnion.geometry.sheet.contours import SheetLine, whole_levels
from trunnion.geometry.sheet.fields import Metric, distances
from trunnion.geometry.sheet.pieces import in_pieces
from trunnion.geometry.sheet.refine_sheet import split_finely
from trunnion.geometry.sheet.ridges import RidgedSheet, opened, ridged
from trunnion.geometry.sheet.sheet import Measure, Sheet, sheet_of
from trunnion.model.tool import Tool
from trunnion.plan.freeform.drive import SurfaceDrive
from trunnion.plan.freeform.estimate.scallop import stepover_on_plane
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.toolpath.contact_passes.contacts import Contacts
from trunnion.toolpath.contact_passes.stepover.metric import (
    metric_of,
    spread,
    stepover_area,
    stepover_measure,
)

FINENESS = 0.5
"""Stepovers: the longest edge of the triangles that distances are measured over."""
AIM = 0.93
"""Of the scallop height: what passes are laid for. Distances over triangles are a few hundredths off, and level lines are farther apart
where they bend; so the highest ridge stays within a tenth of what is wanted."""
LARGEST = 80_000.0
"""Square stepovers of a piece at most: a million and a half triangles."""
FIRST = 0.3
"""Stepovers from the rim to the first pass: less than half a stepover from a square corner, which triangles round a little."""
FARTHEST = 0.48
"""Stepovers from the nearest pass beyond which a position on a ridge needs another one: where ridges branch, distances are a few hundredths
longer than they are measured."""
SAMPLES = 4
"""Positions that are queried on each piece of a ridge: between two of its points it can be farther from all passes than at either."""
CLOSE, DENSE = 0.2, 0.1
"""Stepovers: nearer than this to a pass a point doesn't tell how wide a stepover is there; and how dense passes are for such distances."""
SLIM = 0.05
"""Stepovers: a pass round less than this is left to the ridge inside of it. It would go there and back on nearly one line."""
REACH = 1.5
"""Stepovers that a pass along a ridge goes on past such a position: the next one between corners is not farther."""
SMOOTHINGS = 3
"""Times that a ridge's points are put halfway between their neighbours: it was found triangle by triangle."""


def scallop_passes(
    drive: SurfaceDrive, tool: Tool, chord: float, progress: Progress = NO_PROGRESS
) -> list[Contacts]:
    """Return the passes of contacts from the rim of the drive's faces inwards, what is inside on their left, each connected part and each
    branch of it by itself, a part that is too large for one field in pieces; then those along ridges. Raises `Refused` for a flat end."""
    measure = stepover_measure(tool, AIM * drive.height)
    longest = stepover_on_plane(tool.corner_radius, drive.height)
    parts = [
        piece
        for part in sheet_of(drive.skin, drive.faces).components()
        for piece in in_pieces(part, partial(stepover_area, measure=measure), LARGEST)
    ]
    made = []
    for k, part in enumerate(parts):
        progress.at(k / len(parts), "Measuring distances in stepovers")
        made += progress.aside(partial(_passes_over, part, measure, longest, tool.radius, chord))
    return made


def _passes_over(
    part: Sheet, measure: Measure, longest: float, radius: float, chord: float, progress: Progress
) -> list[Contacts]:
    """Return the passes over one connected part; `longest` mm is the stepover on a plane."""
    sheet = opened(split_finely(part, measure, FINENESS, progress, evenly=True))
    metric = metric_of(sheet, measure)
    progress.check()
    rims = sheet.rims()
    # An area that is closed all round begins at its highest position.
    rim = np.concatenate(rims) if rims else np.array([np.argmax(sheet.points[:, 2])])
    progress.check()
    found = ridged(metric, *distances(metric, rim), FINENESS * longest)
    field = found.time + 1.0 - FIRST
    progress.check()
    lines = _nested(
        found.sheet, _without_slim(found.sheet, field, whole_levels(found.sheet, field))
    )
    contacts = [found.sheet.on_edges(line.ends, line.share) for line in progress.each(lines)]
    contacts += _along_ridges(found, metric_of(found.sheet, measure), lines, longest)
    closed = [line.closed for line in lines] + [False] * (len(contacts) - len(lines))
    spreads = (
        (spread(*pn, c, radius, chord, longest), c)
        for pn, c in progress.each(zip(contacts, closed, strict=True))
    )
    return [Contacts(point=p, normal=n, closed=c) for (p, n), c in spreads]


def _without_slim(sheet: Sheet, field: Floats, lines: Sequence[SheetLine]) -> list[SheetLine]:
    """Return the lines but those inside of which a field (v,) rises or falls by less than `SLIM`."""
    ends = sheet.edges()[0]
    for sign in (1.0, -1.0):
        value = sign * field
        doubtful = {
            line.level for line in lines if value[line.ends].max() < sign * line.level + SLIM
        }
        slim = set()
        for level in sorted(doubtful):
            a, b = ends[(value[ends] > sign * level).all(axis=1)].T
            part = connected_components(
                coo_matrix((np.ones(len(a)), (a, b)), shape=(len(value),) * 2), directed=False
            )[1]
            top = np.full(len(value), -np.inf)
            np.maximum.at(top, part, value)
            slim |= {
                k
                for k, line in enumerate(lines)
                if line.level == level
                and top[part[line.ends.ravel()[np.argmax(value[line.ends])]]] < sign * level + SLIM
            }
        lines = [line for k, line in enumerate(lines) if k not in slim]
    return list(lines)


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
            inside[
                int(
                    owner[
                        cKDTree(np.concatenate([middles[j] for j in outer])).query(middles[k][0])[1]
                    ]
                )
            ].append(k)
        else:
            inside[-1].append(k)
    order, todo = [], inside[-1][::-1]
    while todo:
        k = todo.pop()
        order.append(lines[k])
        todo += inside[k][::-1]
    return order


def _along_ridges(
    found: RidgedSheet, metric: Metric, lines: Sequence[SheetLine], stepover: float
) -> list[tuple[Floats, Floats]]:
    """Return points and normals (k, 3) of passes along the ridges where positions are too far from all lines."""
    if not lines or not found.ridges:
        return []
    rows = np.concatenate([line.ends.ravel() for line in lines])
    level = np.repeat(
        [line.level - 1.0 + FIRST for line in lines], [2 * len(line.share) for line in lines]
    )
    away, _ = distances(metric, rows, np.abs(found.time[rows] - level))
    passes = cKDTree(
        np.concatenate(
            [
                _dense(found.sheet.on_edges(line.ends, line.share)[0], DENSE * stepover)
                for line in lines
            ]
        )
    )
    stretches = []
    for ridge in found.ridges:
        point, normal = _smoothed(
            found.sheet.points[ridge], found.sheet.normals[ridge], bool(ridge[0] == ridge[-1])
        )
        run = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(point, axis=0), axis=1))])
        at, far = _away(found.sheet.points[ridge], away[ridge], passes, stepover)
        lacking = np.interp(at[far > FARTHEST], np.arange(len(run)), run)
        if len(lacking):
            first = np.searchsorted(lacking, run - REACH * stepover)
            wanted = (first < len(lacking)) & (
                lacking[np.minimum(first, len(lacking) - 1)] <= run + REACH * stepover
            )
            edges = np.flatnonzero(np.diff(wanted.astype(np.int8), prepend=0, append=0)).reshape(
                -1, 2
            )
            stretches += [(point[a:b], normal[a:b]) for a, b in edges.tolist() if b - a > 1]
    return _in_turn(stretches)


def _away(point: Floats, away: Floats, passes: cKDTree, stepover: float) -> tuple[Floats, Floats]:
    """Return positions on a ridge, as fractional rows (m,) of its points (k, 3), and how many stepovers (m,) they are away from all passes:
    at its points as was measured (k,), between them by the distance in space and how wide stepovers are at the points beside."""
    at = np.arange(SAMPLES * (len(point) - 1) + 1) / SAMPLES
    row = np.minimum(at.astype(np.int64), len(point) - 2)
    share = (at - row)[:, None]
    space = np.asarray(passes.query((1.0 - share) * point[row] + share * point[row + 1])[0])
    scale = np.full(len(point), 1.0 / stepover)
    np.divide(away, space[::SAMPLES], out=scale, where=space[::SAMPLES] > CLOSE * stepover)
    found = space * np.maximum(scale[row], scale[row + 1])
    found[::SAMPLES] = away
    return at, found


def _dense(point: Floats, step: float) -> Floats:
    """Return points at most a step (mm) apart on the straight path through points (k, 3)."""
    size = np.linalg.norm(np.diff(point, axis=0), axis=1)
    run = np.concatenate([[0.0], np.cumsum(size)])
    at = np.unique(np.concatenate([run, np.linspace(0.0, run[-1], int(run[-1] / step) + 2)]))
    return np.column_stack([np.interp(at, run, point[:, k]) for k in range(3)])


def _in_turn(stretches: list[tuple[Floats, Floats]]) -> list[tuple[Floats, Floats]]:
    """Return paths in an order in which each begins near the end of the one before, some of them the other way round."""
    stretches, order = list(stretches), list[tuple[Floats, Floats]]()
    while stretches:
        here = order[-1][0][-1] if order else stretches[0][0][0]
        gaps = np.array(
            [[np.linalg.norm(point[k] - here) for k in (0, -1)] for point, _ in stretches]
        )
        row, end = divmod(int(np.argmin(gaps)), 2)
        point, normal = stretches.pop(row)
        order.append((point[::-1], normal[::-1]) if end else (point, normal))
    return order


def _smoothed(point: Floats, normal: Floats, closed: bool) -> tuple[Floats, Floats]:
    """Return a ridge's points and normals (k, 3), smoother; its ends stay."""
    for _ in range(0 if closed else SMOOTHINGS):
        point, normal = (
            np.vstack([x[:1], 0.25 * (x[:-2] + 2.0 * x[1:-1] + x[2:]), x[-1:]])
            for x in (point, normal)
        )
    return point, normal / np.linalg.norm(normal, axis=1, keepdims=True)
