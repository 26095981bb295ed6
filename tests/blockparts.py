"""Parts of blocks without CAD: a grid of full and empty cells gives a face graph and sections, to test rules by hand-made shapes."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely

from trunnion.geometry.facegraph import FaceGraph
from trunnion.geometry.frame import WORLD, Frame
from trunnion.geometry.plane.curve import Curve
from trunnion.geometry.plane.region import Region

Quad = tuple[int, int, int, int, int]
"""A unit face: axis, side (0 looks down the axis, 1 up), and the cell (i, j, k) that it belongs to."""
Key = tuple[int, int, int, int]
"""A unit edge: axis, and the grid vertex (i, j, k) where it begins."""


@dataclass(frozen=True)
class BlockPart:
    """Cells between the breaks of three axes, full where `full` is set; `placed` is the blocks' frame in the part's coordinates."""

    breaks: tuple[tuple[float, ...], tuple[float, ...], tuple[float, ...]]
    full: np.ndarray
    placed: Frame = WORLD

    def graph(self) -> FaceGraph:
        """Return the face graph in the part's coordinates; every cell edge is an edge of its own."""
        return _graph(self).in_frame(_inverse(self.placed))

    def section(self, frame: Frame, z: float) -> Region:
        """Return the material that a plane cuts; the frame's z must run along an axis of the blocks."""
        along = self.placed.local_direction(frame.z)
        axis = int(np.argmax(np.abs(along)))
        assert abs(abs(float(along[axis])) - 1.0) < 1e-6, "blocks are cut across an axis of theirs"
        level = float(self.placed.to_local(frame.to_world(np.array([0.0, 0.0, z])))[axis])
        layer = int(np.searchsorted(self.breaks[axis], level)) - 1
        if not 0 <= layer < self.full.shape[axis]:
            return Region()
        u, v = [a for a in range(3) if a != axis]
        us, vs = self.breaks[u], self.breaks[v]
        cells = [
            shapely.box(us[i], vs[j], us[i + 1], vs[j + 1])
            for i, j in np.argwhere(self.full.take(layer, axis))
        ]
        rings = [
            r
            for p in shapely.get_parts(shapely.union_all(cells))
            for r in (p.exterior, *p.interiors)
        ]
        return Region.of(
            [Curve.polygon(self._moved(np.asarray(r.coords)[:-1], (u, v), frame)) for r in rings]
        )

    def _moved(self, points: np.ndarray, axes: tuple[int, int], frame: Frame) -> np.ndarray:
        there = np.zeros((len(points), 3))
        there[:, list(axes)] = points
        return frame.to_local(self.placed.to_world(there))[:, :2]


def terrace(
    xs: Sequence[float],
    ys: Sequence[float],
    heights: Sequence[Sequence[float]],
    placed: Frame = WORLD,
) -> BlockPart:
    """Return the part whose cell (i, j) is full from 0 up to `heights[j][i]`: the rows of the list run along y."""
    tops = np.array(heights, dtype=float).T
    zs = (0.0, *sorted(set(tops.ravel().tolist()) - {0.0}))
    full = np.array(zs[1:])[None, None, :] <= tops[:, :, None] + 1e-9
    return BlockPart((tuple(xs), tuple(ys), zs), full, placed)


def _inverse(frame: Frame) -> Frame:
    axes = frame.axes
    return Frame(-axes @ frame.origin, axes[:, 0], axes[:, 2])


def _quads(full: np.ndarray) -> list[Quad]:
    padded = np.pad(full, 1)
    found = []
    for i, j, k in np.argwhere(full).tolist():
        for axis, side in itertools.product(range(3), (0, 1)):
            step = [1, 1, 1]
            step[axis] += 2 * side - 1
            if not padded[i + step[0], j + step[1], k + step[2]]:
                found.append((axis, side, i, j, k))
    return found


def _borders(quad: Quad) -> list[Key]:
    """Return the four unit edges of a unit face."""
    axis, side, *cell = quad
    cell[axis] += side
    u, v = [a for a in range(3) if a != axis]
    edges = []
    for along, across in ((u, v), (v, u)):
        for shift in (0, 1):
            start = list(cell)
            start[across] += shift
            edges.append((along, *start))
    return edges  # type: ignore[return-value]


def _merged(full: np.ndarray) -> tuple[list[list[Quad]], dict[Key, list[int]]]:
    """Return the faces (unit faces in one plane that touch) and the faces at every unit edge."""
    quads = _quads(full)
    at: dict[Key, list[Quad]] = {}
    for q in quads:
        for e in _borders(q):
            at.setdefault(e, []).append(q)
    face_of: dict[Quad, int] = {}
    faces: list[list[Quad]] = []
    for seed in quads:
        if seed in face_of:
            continue
        face_of[seed] = len(faces)
        group = [seed]
        for q in group:
            for e in _borders(q):
                for other in at[e]:
                    if (
                        other not in face_of
                        and other[:2] == q[:2]
                        and other[2 + q[0]] == q[2 + q[0]]
                    ):
                        face_of[other] = len(faces)
                        group.append(other)
        faces.append(group)
    return faces, {e: [face_of[q] for q in found] for e, found in at.items()}


def _loops(edges: list[Key]) -> dict[Key, int]:
    """Return the loop of every unit edge of one face: 0 is the one with the widest box."""
    ends = {e: (e[1:], tuple(c + (a == e[0]) for a, c in enumerate(e[1:]))) for e in edges}
    left, groups = set(edges), []
    for seed in edges:
        if seed not in left:
            continue
        left.discard(seed)
        group = [seed]
        for e in group:
            touching = [f for f in edges if f in left and set(ends[e]) & set(ends[f])]
            left.difference_update(touching)
            group.extend(touching)
        groups.append(group)
    groups.sort(
        key=lambda g: -float(np.ptp(np.array([p for e in g for p in ends[e]]), axis=0).sum())
    )
    return {e: n for n, g in enumerate(groups) for e in g}


def _graph(part: BlockPart) -> FaceGraph:
    breaks = [np.array(b, dtype=float) for b in part.breaks]
    faces, at = _merged(part.full)
    padded = np.pad(part.full, 1)

    def place(vertex: Sequence[int]) -> np.ndarray:
        return np.array([breaks[a][c] for a, c in enumerate(vertex)])

    low, high, centre, normal, area, samples, owner = [], [], [], [], [], [], []
    for row, quads in enumerate(faces):
        axis, side = quads[0][:2]
        corners = [
            (
                place([c + (side if a == axis else 0) for a, c in enumerate(q[2:])]),
                place([c + (side if a == axis else 1) for a, c in enumerate(q[2:])]),
            )
            for q in quads
        ]
        middles = np.array([(a + b) / 2 for a, b in corners])
        low.append(np.min([a for a, _ in corners], axis=0))
        high.append(np.max([b for _, b in corners], axis=0))
        area.append(
            sum(np.prod([d for a, d in enumerate(b - a0) if a != axis]) for a0, b in corners)
        )
        centre.append(middles[0])
        normal.append(np.eye(3)[axis] * (2 * side - 1))
        samples.extend(middles)
        owner.extend([row] * len(quads))
    borders = {e: f for e, f in at.items() if len(f) == 2 and f[0] != f[1]}
    loops: list[dict[Key, int]] = [
        _loops([e for e, f in borders.items() if row in f]) for row in range(len(faces))
    ]
    start = np.array([place(e[1:]) for e in borders])
    end = np.array([place([c + (a == e[0]) for a, c in enumerate(e[1:])]) for e in borders])
    convexity = np.array([_convexity(padded, e) for e in borders])
    nothing, n, m = np.full((len(borders), 3), np.nan), len(faces), len(borders)
    return FaceGraph(
        surface=("plane",) * n,
        area=np.array(area),
        centre=np.array(centre),
        normal=np.array(normal),
        axis_point=np.full((n, 3), np.nan),
        axis=np.full((n, 3), np.nan),
        radius=np.full(n, np.nan),
        minor=np.full(n, np.nan),
        bend=np.zeros(n),
        box_low=np.array(low),
        box_high=np.array(high),
        sample_face=np.array(owner),
        sample_point=np.array(samples),
        sample_normal=np.array(normal)[owner],
        edge_face=np.array(list(borders.values())),
        convexity=convexity,
        dihedral=np.pi - convexity * np.pi / 2,
        length=np.linalg.norm(end - start, axis=1),
        edge_loop=np.array([[loops[f][e] for f in pair] for e, pair in borders.items()]),
        curve=("line",) * m,
        start=start,
        middle=(start + end) / 2,
        end=end,
        curve_centre=nothing,
        curve_axis=nothing,
        curve_radius=np.full(m, np.nan),
    )


def _convexity(padded: np.ndarray, edge: Key) -> int:
    """Return +1 where one of the four cells round an edge is full, -1 where three are."""
    axis, *vertex = edge
    around = 0
    u, v = [a for a in range(3) if a != axis]
    for du, dv in itertools.product((0, 1), repeat=2):
        cell = [c + 1 for c in vertex]
        cell[u] -= du
        cell[v] -= dv
        around += int(padded[tuple(cell)])
    return {1: 1, 3: -1}[around]
