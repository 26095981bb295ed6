"""Which faces of a part are which of its revision: by what they are alike in, then by the surface they are on, then by what is beside them.

Both parts lie in the same coordinates. A face has one counterpart at most.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from itertools import product

import numpy as np
from scipy.spatial import cKDTree

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.facegraph import FaceGraph

SAME_AREA = 1e-4
"""Share by which the areas of one face of two files differ at most: what other kernels and formats make of it."""
LEAST_SHARED = 0.5
"""Share of its neighbours that a face whose surface has moved has in common with its counterpart."""
TURNED = np.radians(30.0)
"""How far the normal of a face that has moved may have turned."""


@dataclass(frozen=True, slots=True, eq=False)
class FaceMatch:
    """The counterparts of the faces of a part: `tags` (n,) in its revision, 0 where a face is gone; `same` (n,) whether it is as it was."""

    tags: Ints
    same: Bools

    def of(self, tag: int) -> int:
        """Return the counterpart of a face by its tag, 0 where it is gone."""
        return int(self.tags[tag - 1]) if 1 <= tag <= len(self.tags) else 0

    def all_of(self, tags: Iterable[int]) -> tuple[int, ...]:
        """Return the counterparts of faces that are not gone, in their order."""
        return tuple(found for found in map(self.of, tags) if found)


def matched_faces(before: FaceGraph, after: FaceGraph) -> FaceMatch:
    """Return the counterparts of the faces of one part in another."""
    pairs = _Pairs(before, after)
    pairs.take(_alike(before, after))
    same = pairs.forward > 0
    pairs.take(_on_one_surface(pairs))
    while pairs.take(_with_same_neighbours(pairs)):
        pass
    return FaceMatch(pairs.forward, same)


class _Pairs:
    """Counterparts that are found: `forward` has the tag after of each face before, `back` the other way round; 0 where there is none."""

    def __init__(self, before: FaceGraph, after: FaceGraph) -> None:
        self.before, self.after = before, after
        self.forward = np.zeros(len(before), dtype=np.int64)
        self.back = np.zeros(len(after), dtype=np.int64)

    def take(self, candidates: Iterable[tuple[float, int, int]]) -> bool:
        """Take pairs of rows, those of the highest score first, each face once; return whether there was any."""
        taken = False
        for _, a, b in sorted(candidates, key=lambda c: (-c[0], c[1], c[2])):
            if not self.forward[a] and not self.back[b]:
                self.forward[a], self.back[b] = b + 1, a + 1
                taken = True
        return taken

    def open(self) -> Iterator[tuple[int, int]]:
        """Yield the pairs of rows without a counterpart whose surfaces are of one kind and bend the same way."""
        rows = (np.flatnonzero(side == 0).tolist() for side in (self.forward, self.back))
        for a, b in product(*rows):
            alike = self.before.surface[a] == self.after.surface[b]
            if alike and self.before.bend[a] == self.after.bend[b]:
                yield a, b


def _alike(before: FaceGraph, after: FaceGraph) -> Iterator[tuple[float, int, int]]:
    """Yield the pairs of faces of one kind, one area and one box, those that are nearest to each other with the highest score."""
    if not len(before) or not len(after):
        return
    old, new = (np.hstack([g.box_low, g.box_high]) for g in (before, after))
    tree, close = cKDTree(new), 2.0 * tolerance.SEW
    for a, box in enumerate(old):
        rows: list[int] = tree.query_ball_point(box, close)
        for b in rows:
            if before.surface[a] != after.surface[b]:
                continue
            if abs(before.area[a] - after.area[b]) <= SAME_AREA * before.area[a] + tolerance.SEW:
                yield -float(np.abs(old[a] - new[b]).max()), a, b


def _on_one_surface(pairs: _Pairs) -> Iterator[tuple[float, int, int]]:
    """Yield the pairs of faces on one surface whose boxes share space, with the share that they have in common."""
    for a, b in pairs.open():
        rule = _SURFACES.get(pairs.before.surface[a])
        if rule is None or not rule(pairs.before, a, pairs.after, b):
            continue
        shared = _shared_box(pairs.before, a, pairs.after, b)
        if shared > 0.0:
            yield shared, a, b


def _with_same_neighbours(pairs: _Pairs) -> Iterator[tuple[float, int, int]]:
    """Yield the pairs of faces that look the same way and have most of their neighbours in common, as far as these have counterparts; of
    equal ones those that are nearer to each other score higher."""
    size = float(np.linalg.norm(np.ptp(pairs.before.sample_point, axis=0))) or 1.0
    for a, b in pairs.open():
        there = {int(pairs.forward[n]) for n in pairs.before.neighbours(a)} - {0}
        here = {n + 1 for n in pairs.after.neighbours(b) if pairs.back[n]}
        if not there or len(there & here) < LEAST_SHARED * len(there | here):
            continue
        if pairs.before.surface[a] == "plane" and not _look_alike(pairs, a, b):
            continue
        apart = np.abs(_box(pairs.before, a) - _box(pairs.after, b)).max() / size
        yield len(there & here) / len(there | here) - float(apart), a, b


def _look_alike(pairs: _Pairs, a: int, b: int) -> bool:
    return bool(pairs.before.normal[a] @ pairs.after.normal[b] >= np.cos(TURNED))


def _box(graph: FaceGraph, row: int) -> Floats:
    return np.concatenate([graph.box_low[row], graph.box_high[row]])


def _shared_box(before: FaceGraph, a: int, after: FaceGraph, b: int) -> float:
    """Return the share of the box around two faces' boxes that both have in common; a flat box is as thick as points are told apart."""
    low = np.maximum(before.box_low[a], after.box_low[b])
    high = np.minimum(before.box_high[a], after.box_high[b])
    out_low = np.minimum(before.box_low[a], after.box_low[b])
    out_high = np.maximum(before.box_high[a], after.box_high[b])
    thick = tolerance.SEW
    if (high - low < -thick).any():
        return 0.0
    return float(np.prod(np.maximum(high - low, 0.0) + thick) / np.prod(out_high - out_low + thick))


def _in_one_plane(before: FaceGraph, a: int, after: FaceGraph, b: int) -> bool:
    normal = before.normal[a]
    off = (after.centre[b] - before.centre[a]) @ normal
    aligned = normal @ after.normal[b] >= np.cos(tolerance.ANGLE)
    return bool(aligned and abs(off) <= tolerance.SEW)


def _about_one_axis(before: FaceGraph, a: int, after: FaceGraph, b: int) -> bool:
    """Return whether two faces of revolution have one axis and one radius, at one place where the surface tells places apart."""
    axis, across = before.axis[a], after.axis_point[b] - before.axis_point[a]
    if not _is_near(before.radius[a], after.radius[b]) or not _is_near(
        before.minor[a], after.minor[b]
    ):
        return False
    if abs(axis @ after.axis[b]) < np.cos(tolerance.ANGLE):
        return False
    if before.surface[a] == "cylinder":
        across = across - (across @ axis) * axis
    return bool(np.linalg.norm(across) <= tolerance.SEW)


def _about_one_point(before: FaceGraph, a: int, after: FaceGraph, b: int) -> bool:
    across = after.axis_point[b] - before.axis_point[a]
    near = _is_near(before.radius[a], after.radius[b])
    return near and bool(np.linalg.norm(across) <= tolerance.SEW)


def _is_near(a: float, b: float) -> bool:
    return bool((np.isnan(a) and np.isnan(b)) or abs(a - b) <= tolerance.SEW)


_SURFACES: dict[str, Callable[[FaceGraph, int, FaceGraph, int], bool]] = {
    "plane": _in_one_plane,
    "cylinder": _about_one_axis,
    "torus": _about_one_axis,
    "sphere": _about_one_point,
}
"""Whether two faces of a kind are on one surface. Others are told by what is beside them: their surfaces have no few numbers."""
