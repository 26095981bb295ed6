"""Guide curves: between which rims of an area the flow lines run.

By default an area like a tube, or a ring, is guided by its two rims, and any other by the two longest of its sides that don't meet: a
side is a run of the outer rim between corners. A person may name the faces beyond a rim instead.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from trunnion import tolerance
from trunnion.findings import BadInput
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.sheet.fields import Metric, distances
from trunnion.geometry.sheet.sheet import Sheet
from trunnion.geometry.sheet.skin import Skin

CORNER = math.radians(30.0)
"""A rim that turns by more at a point has a corner there."""
EVEN = 0.5
"""Two rims make a ring if it is at its narrowest at least this share of its widest."""

STRAIGHT = 1.02
"""Length over chord up to which a run of a rim is about straight: an arc of 40 degrees."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Guides:
    """The points (k,) of a sheet on the first and on the second guide; `rings` when both are whole rims."""

    first: Ints
    second: Ints
    rings: bool


def tags_named(text: str) -> tuple[int, ...]:
    """Return the face tags that a text names, as in `face 12, face 13` or `12 13`; raise `BadInput` for anything else."""
    words = [w for w in re.split(r"[,;\s]+", text.strip()) if w not in ("", "face", "faces")]
    if not all(w.isdigit() and int(w) > 0 for w in words):
        raise BadInput(f"{text!r}: name faces by their tags, as in: face 12, face 13")
    return tuple(int(w) for w in words)


def holes_of(metric: Metric) -> list[Ints]:
    """Return the rims of a connected sheet that flow lines had better pass as if they were not there: all but the outer one of an area
    that is no ring."""
    rims = metric.sheet.rims()
    if len(rims) == 2:
        gaps = np.concatenate([distances(metric, rims[k])[0][rims[1 - k]] for k in (0, 1)])
        if gaps.min() >= EVEN * gaps.max():
            return []
    return rims[1:]


def guides_of(sheet: Sheet) -> Guides:
    """Return the guides that a connected sheet with its holes filled suggests; raise `BadInput` for one without a rim."""
    rims = sheet.rims()
    if not rims:
        raise BadInput(
            "the area is closed all round: leave one of its faces out, or choose another strategy"
        )
    if len(rims) == 2:
        return Guides(first=rims[0], second=rims[1], rings=True)
    sides = _sides(sheet, rims[0])
    lengths = np.array([_run(sheet, side) for side in sides])
    n = len(sides)
    if n < 4:
        i, j = np.sort(np.argsort(-lengths, kind="stable")[:2]).tolist()
        return Guides(**_apart(sides[i], sides[j]), rings=False)
    pairs = [(i, j) for i in range(n) for j in range(i + 2, n) if (j + 1) % n != i]
    i, j = max(
        pairs, key=lambda p: min(lengths[p[0]], lengths[p[1]]) + lengths[p[0]] + lengths[p[1]]
    )
    return Guides(first=sides[i], second=sides[j], rings=False)


def adjacent_guides(
    sheet: Sheet, skin: Skin, first: tuple[int, ...], second: tuple[int, ...]
) -> Guides:
    """Return the guides along which a sheet meets faces (tags) of the skin; raise `BadInput` where it does not."""
    rims = sheet.rims()
    found = []
    for tags in (first, second):
        rim_rows = [
            rim[_on_triangles(sheet.points[rim], skin, skin.triangles[skin.of(tags)])]
            for rim in rims
        ]
        rows = np.concatenate([np.zeros(0, np.int64), *rim_rows])
        if len(rows) < 2:
            raise BadInput(
                f"no rim of the area lies along {', '.join(f'face {t}' for t in tags)}: name faces next to it as guides"
            )
        found.append(rows)
    rings = len(rims) == 2 and all(any(set(rows) == set(rim) for rim in rims) for rows in found)
    return Guides(**_apart(found[0], found[1]), rings=rings)


def _on_triangles(rim: Floats, skin: Skin, triangles: Ints) -> Bools:
    """Return which points (k,) of a rim lie on triangles (t, 3) of a skin: on a point of these, or between two that one of their sides
    joins."""
    used = np.unique(triangles)
    if not len(used):
        return np.zeros(len(rim), bool)
    gap, position = cKDTree(skin.points[used]).query(rim)
    # Each face may have points of its own on the rim: off the other's by as much as its triangles may be.
    on = np.asarray(gap <= 2.0 * tolerance.CHORD)
    sides = {
        frozenset(side)
        for k in range(3)
        for side in zip(triangles[:, k].tolist(), triangles[:, (k + 1) % 3].tolist(), strict=True)
    }
    corners = skin.points[triangles]
    longest = float(np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max())
    rows, number, n = np.flatnonzero(on), used[np.asarray(position)].tolist(), len(rim)
    for row, after in zip(rows.tolist(), np.roll(rows, -1).tolist(), strict=True):
        width = (after - row) % n
        run = rim[np.arange(row, row + width + 1) % n]
        if 2 * width <= n and (
            frozenset((number[row], number[after])) in sides or _is_short(run, longest)
        ):
            on[np.arange(row, row + width) % n] = True
    return on


def _is_short(run: Floats, longest: float) -> bool:
    """Return whether a run of a rim (k, 3) is about straight and no longer than the longest side of triangles: faces that meet along a rim
    may have some of their points on it each for themselves."""
    chord = float(np.linalg.norm(run[-1] - run[0]))
    length = float(np.linalg.norm(np.diff(run, axis=0), axis=1).sum())
    return chord <= longest and length <= STRAIGHT * chord


def _sides(sheet: Sheet, rim: Ints) -> list[Ints]:
    """Return the sides of a rim, each with both of its ends; a rim with fewer than two corners is parted where it is widest."""
    points, normals = sheet.points[rim], sheet.normals[rim]
    before, after = points - np.roll(points, 1, axis=0), np.roll(points, -1, axis=0) - points
    flat = [v - (v * normals).sum(axis=1, keepdims=True) * normals for v in (before, after)]
    turn = np.arctan2(np.linalg.norm(np.cross(*flat), axis=1), (flat[0] * flat[1]).sum(axis=1))
    corners = np.flatnonzero(np.abs(turn) > CORNER)
    if len(corners) < 2:
        far = int(np.argmax(np.linalg.norm(points - points.mean(axis=0), axis=1)))
        corners = np.unique([far, int(np.argmax(np.linalg.norm(points - points[far], axis=1)))])
    return [
        np.take(rim, np.arange(a, b + 1 if b > a else b + len(rim) + 1), mode="wrap")
        for a, b in zip(corners.tolist(), np.roll(corners, -1).tolist(), strict=True)
    ]


def _apart(first: Ints, second: Ints) -> dict[str, Ints]:
    """Return guides without the points that both have."""
    return {"first": first[~np.isin(first, second)], "second": second[~np.isin(second, first)]}


def _run(sheet: Sheet, side: Ints) -> float:
    return float(np.linalg.norm(np.diff(sheet.points[side], axis=0), axis=1).sum())
