"""A sheet cut in pieces no larger than a limit: along the borders of its faces, or straight across one that is too large by itself.

A field over a sheet needs triangles by its area; in pieces there is room for any area.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from scipy.sparse import coo_matrix, csr_matrix
from scipy.sparse.csgraph import dijkstra

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.sheet.sheet import Sheet

CLOSE = 0.1
"""Share of an edge: how near to its end a plane is laid through the end itself."""
DIRECTIONS = 12
"""Planes that are tried, at even angles."""
AreaOf = Callable[[Sheet], Floats]
"""The area (t,) of each triangle of a sheet, in any unit."""


def in_pieces(sheet: Sheet, area_of: AreaOf, most: float) -> list[Sheet]:
    """Return connected pieces of a connected sheet, each of at most so large an area as far as it can be cut; the sheet itself where it is
    no larger."""
    pending, found = [sheet], list[Sheet]()
    while pending:
        piece = pending.pop()
        if float(area_of(piece).sum()) <= most:
            found.append(piece)
            continue
        halves = _between_faces(piece) or _across(piece)
        if len(halves) < 2:
            found.append(piece)
        else:
            pending += halves[::-1]
    return found


def _between_faces(sheet: Sheet) -> list[Sheet]:
    """Return the connected parts of the halves of a sheet: faces nearer to either of two that are far apart. None for a single face.

    Far apart is the face farthest from any, and the one farthest from that (a double sweep), from middle to middle of neighbours.
    """
    tags, face = np.unique(sheet.face, return_inverse=True)
    if len(tags) < 2:
        return []
    area = sheet.area()
    middles = sheet.points[sheet.triangles].mean(axis=1)
    weight = np.maximum(np.bincount(face, area), tolerance.AREA)
    centre = np.column_stack([np.bincount(face, area * m) for m in middles.T]) / weight[:, None]
    side = sheet.edges()[1]
    edge = np.argsort(side.ravel(), kind="stable")
    twice = np.flatnonzero(np.diff(side.ravel()[edge]) == 0)
    a, b = face[edge[twice] // 3], face[edge[twice + 1] // 3]
    beside = np.unique(np.sort(np.column_stack([a, b])[a != b], axis=1), axis=0)
    # Faces about one middle are neighbours still: a link needs a length.
    away = np.linalg.norm(centre[beside[:, 0]] - centre[beside[:, 1]], axis=1) + tolerance.SEW
    links = coo_matrix((away, beside.T), shape=(len(tags),) * 2).tocsr()
    first = int(np.argmax(_reached(links, 0)))
    from_first = _reached(links, first)
    from_second = _reached(links, int(np.argmax(from_first)))
    return _parted(sheet, (from_second < from_first)[face])


def _reached(links: csr_matrix, start: int) -> Floats:
    """Return how far (k,) each face is from one, by links of neighbours; those that share a corner alone are farther than any."""
    found = np.asarray(dijkstra(links, directed=False, indices=[start]))[0]
    return np.where(np.isfinite(found), found, found[np.isfinite(found)].max() + tolerance.SEW)


def _across(sheet: Sheet) -> list[Sheet]:
    """Return the connected parts of the halves of a sheet on both sides of a plane through its middle: of some planes, the one with the
    shortest cut. A cut aslant would leave sharp corners."""
    area = sheet.area()
    middle = (sheet.points[sheet.triangles].mean(axis=1) * area[:, None]).sum(axis=0) / area.sum()
    off = sheet.points - middle
    # The principal axes: the eigenvectors of the two largest eigenvalues.
    axes = np.linalg.eigh(off.T @ off)[1][:, [2, 1]]
    turn = np.arange(DIRECTIONS) * math.pi / DIRECTIONS
    directions = axes @ np.stack([np.cos(turn), np.sin(turn)])
    height = min((off @ d for d in directions.T), key=lambda h: _cut_length(sheet, h))
    ends, side = sheet.edges()
    # Points that the plane passes by so close to an end of an edge that a sliver would be left count as on it.
    rows, share = _crossings(height, ends)
    height[ends[rows[share < CLOSE], 0]] = 0.0
    height[ends[rows[share > 1.0 - CLOSE], 1]] = 0.0
    rows, share = _crossings(height, ends)
    cut, _ = sheet.parted(ends, side, rows, share)
    height = np.concatenate([height, np.zeros(len(rows))])
    return _parted(cut, height[cut.triangles].sum(axis=1) > 0.0)


def _crossings(height: Floats, ends: Ints) -> tuple[Ints, Floats]:
    """Return the edges (k,) with ends on both sides of a plane that points (v,) are so high over, and the share of their way (k,) there."""
    a, b = height[ends].T
    rows = np.flatnonzero(a * b < 0.0)
    return rows, a[rows] / (a[rows] - b[rows])


def _cut_length(sheet: Sheet, height: Floats) -> float:
    """Return how long in mm the cut through a sheet is along a plane that its points (v,) are so high over."""
    ends, side = sheet.edges()
    # What lies on the plane counts as over it: then a cut leaves each triangle where it has come in, through another side.
    rows, share = _crossings(
        np.where(np.abs(height) < tolerance.PARAMETRIC, tolerance.PARAMETRIC, height), ends
    )
    number = np.full(len(ends), -1)
    number[rows] = np.arange(len(rows))
    pairs = np.sort(number[side], axis=1)[:, 1:]
    pairs = pairs[pairs[:, 0] >= 0]
    a, b = sheet.points[ends[rows]].transpose(1, 0, 2)
    at = (a + share[:, None] * (b - a))[pairs]
    return float(np.linalg.norm(at[:, 1] - at[:, 0], axis=1).sum())


def _parted(sheet: Sheet, second: Bools) -> list[Sheet]:
    """Return the connected parts of a sheet without its second half (t,), and of that."""
    return [*sheet.of(~second).components(), *sheet.of(second).components()]
