"""Lines of a wheel's faces in its frame: meridians of what is turned, and the lines along which blades begin and end."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
import shapely

from trunnion.geometry.arrays import Floats
from trunnion.geometry.facegraph import FaceGraph
from trunnion.geometry.frame import Frame
from trunnion.progress import Progress
from trunnion.tolerance import COINCIDENT

if TYPE_CHECKING:
    from trunnion.part.part import Part
    from trunnion.part.shape.exact import ExactFace

FINE, COARSE = 161, 25
"""Positions along and across a face at which meridians are read."""
SPREAD = 41
"""Positions along either parameter at which edges of blades are looked for, and along each edge of a face."""
RADII = 17
"""Lines across a root fillet that its radius is read from."""
LEAST_TURN = 0.3
"""Distance of the unit normals at a line's two ends from which on it says something of a radius: some 17 degrees."""
ONE_BALL = 0.998
"""Cosine between the step from end to end and the change of the normals from which on one ball touches both ends: lines that run askew
across a fillet touch two balls a little apart, and the radius comes out larger by the inverse of it, 2 per mille at most."""
ALONG = 65
"""Positions along a line at which its ends in the trim are looked for."""
HALVINGS = 16
"""How often the end of a line at the face's trim is halved: to a hundred-thousandth of the line."""
BENT = 2
"""Degree of the curve that an edge of a blade is followed by down to the hub: it is a line on ruled blades, an arc on bowed ones."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SurfacePoints:
    """Points (k, 3) of faces and their outward normals (k, 3), in the frame of the wheel."""

    point: Floats
    normal: Floats

    @property
    def meridian(self) -> Floats:
        """Radius and height (k, 2) mm."""
        return meridian_of(self.point)

    @property
    def parts(self) -> Floats:
        """The normals (k, 3) away from the axis, round it and along it."""
        out = (
            self.point[:, :2]
            / np.maximum(np.linalg.norm(self.point[:, :2], axis=1), COINCIDENT)[:, None]
        )
        return np.column_stack(
            [
                (self.normal[:, :2] * out).sum(axis=1),
                self.normal[:, 1] * out[:, 0] - self.normal[:, 0] * out[:, 1],
                self.normal[:, 2],
            ]
        )


def meridian_of(points: Floats) -> Floats:
    """Return radius and height (k, 2) mm of points (k, 3) in the frame of the wheel."""
    return np.column_stack([np.linalg.norm(points[:, :2], axis=1), points[:, 2]])


def exact_faces(part: Part, frame: Frame, tags: Iterable[int]) -> list[ExactFace]:
    """Return faces of a part to be evaluated in the frame of the wheel."""
    from trunnion.part.shape.exact import ExactFace

    return [ExactFace(part, tag, frame) for tag in tags]


def grid_of(face: ExactFace, counts: tuple[int, int]) -> Floats:
    """Return positions (n, m, 2) in the middles of cells over a face's bounds."""
    u0, u1, v0, v1 = face.bounds()
    u, v = (
        low + (np.arange(n) + 0.5) / n * (high - low)
        for low, high, n in zip((u0, v0), (u1, v1), counts, strict=True)
    )
    return np.stack(np.meshgrid(u, v, indexing="ij"), axis=-1)


def spread_over(faces: Iterable[ExactFace], progress: Progress) -> SurfacePoints:
    """Return points spread over faces, inside their trims."""
    points, normals = [np.zeros((0, 3))], [np.zeros((0, 3))]
    for face in faces:
        progress.check()
        uv = grid_of(face, (SPREAD, SPREAD)).reshape(-1, 2)
        at = face.at(uv[face.inside(uv)])
        points.append(at.point)
        normals.append(at.normal)
    return SurfacePoints(point=np.vstack(points), normal=np.vstack(normals))


@dataclass(frozen=True, eq=False, kw_only=True)
class MeridianCurve:
    """Points (k, 2) of a meridian, radius and height in mm, from inlet to outlet; densely enough to be joined by lines."""

    point: Floats

    @staticmethod
    def of(faces: Iterable[ExactFace], progress: Progress) -> MeridianCurve:
        """Return the meridian of turned faces: points inside their trims, and on their edges."""
        found = [np.zeros((0, 2))]
        for face in faces:
            progress.check()
            found.append(meridian_of(face.rim(SPREAD)))
            for counts in ((FINE, COARSE), (COARSE, FINE)):
                uv = grid_of(face, counts).reshape(-1, 2)
                found.append(meridian_of(face.at(uv[face.inside(uv)]).point))
        cloud = np.vstack(found)
        cloud = cloud[np.argsort(cloud[:, 0] - cloud[:, 1], kind="stable")]
        apart = np.linalg.norm(np.diff(cloud, axis=0), axis=1) > 1e-4
        return MeridianCurve(point=cloud[np.concatenate([[True], apart])] if len(cloud) else cloud)

    @cached_property
    def along(self) -> Floats:
        """How far along the curve each point lies (k,) mm."""
        step = np.linalg.norm(np.diff(self.point, axis=0), axis=1)
        return np.concatenate([[0.0], np.cumsum(step)])

    @property
    def length(self) -> float:
        """Its length in mm."""
        return float(self.along[-1]) if len(self.point) else 0.0

    @cached_property
    def flow(self) -> Floats:
        """Unit directions (k, 2) along the curve."""
        step = np.gradient(self.point, self.along, axis=0)
        return np.asarray(step / np.maximum(np.linalg.norm(step, axis=1), 1e-12)[:, None])

    def foot(self, points: Floats) -> tuple[Floats, Floats]:
        """Return the nearest points of the curve (k, 2) to points (k, 2) of the meridian, and how far along it these lie (k,) mm."""
        best = self._pieces.query_nearest(shapely.points(points), all_matches=False)[1]
        start, step = self.point[best], self.point[best + 1] - self.point[best]
        square = np.maximum((step * step).sum(axis=1), 1e-24)
        share = np.clip(((points - start) * step).sum(axis=1) / square, 0.0, 1.0)
        return start + share[:, None] * step, self.along[best] + share * np.sqrt(square)

    @cached_property
    def _pieces(self) -> shapely.STRtree:
        """The straight pieces between neighbouring points, to be searched by place."""
        ends = np.stack([self.point[:-1], self.point[1:]], axis=1)
        return shapely.STRtree(list(shapely.get_parts(shapely.multilinestrings(ends))))

    def directions(self, points: Floats) -> tuple[Floats, Floats]:
        """Return the directions (k, 2) of the flow, and square to it to the side where blades stand, beside points (k, 2)."""
        along = self.foot(points)[1]
        flow = np.column_stack([np.interp(along, self.along, self.flow[:, c]) for c in (0, 1)])
        flow /= np.maximum(np.linalg.norm(flow, axis=1), 1e-12)[:, None]
        return flow, np.column_stack([-flow[:, 1], flow[:, 0]])

    def thinned(self, count: int) -> Floats:
        """Return `count` of its points (count, 2), evenly along it, the ends among them."""
        wanted = np.linspace(0.0, self.length, count)
        rows = np.abs(self.along[None] - wanted[:, None]).argmin(axis=1)
        return self.point[np.unique(rows)]

    def from_point(self, point: Floats) -> MeridianCurve:
        """Return what of the curve lies behind the foot of a point (2,), downstream."""
        foot, along = self.foot(point[None])
        return MeridianCurve(point=np.vstack([foot, self.point[self.along > along[0] + 1e-4]]))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class BladeEnd:
    """One end of a blade, its inlet or outlet: the rows of the faces that round or cut it off, and of the walls of either side."""

    edge: tuple[int, ...]
    sides: tuple[tuple[int, ...], tuple[int, ...]]


def camber_end(
    graph: FaceGraph, frame: Frame, end: BladeEnd, faces: Sequence[ExactFace], hub: MeridianCurve
) -> tuple[Floats, Floats] | None:
    """Return where the camber of a blade ends at the hub, below its root fillet, and at its tip: two points (2,) of the meridian. None
    where the blade's end does not show both sides.

    The camber ends where the middle plane between the two walls' edges passes the faces of the end (`faces`, exact); without such faces
    the walls meet there. The line is straight on ruled blades and an arc on bowed ones: a curve of the second degree in the height over
    the hub follows it down to the root.
    """
    rims = [_side_edge(graph, frame, end, k) for k in (0, 1)]
    if any(len(rim) < 2 for rim in rims):
        return None
    fits = [_fitted(rim, hub) for rim in rims]
    line = 0.5 * (rims[0][-1:] + rims[1][-1:])
    if faces:
        found = [_crossings(face, fits, hub) for face in faces]
        line = np.vstack([line[:0], *found])
    else:
        line = np.vstack(rims)
    if len(line) < 2:
        return None
    high = _height(line, hub)
    fit = _fitted(line, hub)
    root = hub.foot(meridian_of(_along(fit, np.zeros(1))))[0][0]
    return root, meridian_of(line[[int(high.argmax())]])[0]


def _side_edge(graph: FaceGraph, frame: Frame, end: BladeEnd, side: int) -> Floats:
    """Return points (k, 3) of the edges at which a wall ends, in the frame of the wheel."""
    beyond = set(end.edge or end.sides[1 - side])
    rows = sorted(
        {e for r in end.sides[side] for e in graph.edges_of[r] if graph.across(e, r) in beyond}
    )
    points = np.concatenate([graph.start[rows], graph.middle[rows], graph.end[rows]])
    return frame.to_local(points)


def _height(points: Floats, hub: MeridianCurve) -> Floats:
    position = meridian_of(points)
    return np.asarray(np.linalg.norm(position - hub.foot(position)[0], axis=1))


def _fitted(points: Floats, hub: MeridianCurve) -> Floats:
    """Return the polynomials (d, 3) in the height over the hub that follow points (k, 3)."""
    high = _height(points, hub)
    bent = min(BENT, len(np.unique(np.round(high, 3))) - 1)
    return np.polyfit(high, points, max(0, bent))


def _along(fit: Floats, high: Floats) -> Floats:
    return np.column_stack([np.polyval(fit[:, c], high) for c in range(3)])


def _crossings(face: ExactFace, sides: Sequence[Floats], hub: MeridianCurve) -> Floats:
    """Return the points (k, 3) of a face, spread over it and on its edges, that lie midway between two lines given by their height."""
    uv = grid_of(face, (SPREAD, SPREAD))
    inside = face.inside(uv.reshape(-1, 2)).reshape(SPREAD, SPREAD)
    point = face.at(uv.reshape(-1, 2)).point.reshape(SPREAD, SPREAD, 3)
    edges = face.rim(SPREAD).reshape(-1, SPREAD, 3)
    found = [np.zeros((0, 3))]
    for points, held in (
        (point, inside),
        (point.swapaxes(0, 1), inside.T),
        (edges, np.ones(edges.shape[:2], dtype=bool)),
    ):
        flat = points.reshape(-1, 3)
        a, b = (_along(fit, _height(flat, hub)) for fit in sides)
        off = ((flat - 0.5 * (a + b)) * (a - b)).sum(axis=1).reshape(points.shape[:2])
        turns = (off[:, 1:] * off[:, :-1] < 0.0) & held[:, 1:] & held[:, :-1]
        share = (off[:, :-1] / np.where(turns, off[:, :-1] - off[:, 1:], 1.0))[..., None]
        found.append((points[:, :-1] + share * np.diff(points, axis=1))[turns])
    return np.vstack(found)


def trimmed_lines(face: ExactFace, way: int, count: int) -> Iterator[tuple[Floats, Floats]]:
    """Yield the two ends (uv) of lines along a face's parameter `way` (0: v along a line of one u), each inside the trim."""
    counts = (count, ALONG) if way == 0 else (ALONG, count)
    grid = grid_of(face, counts)
    grid = grid if way == 0 else grid.swapaxes(0, 1)
    inside = face.inside(grid.reshape(-1, 2)).reshape(grid.shape[:2])
    step = grid[0, 1] - grid[0, 0]
    for positions, held in zip(grid, inside, strict=True):
        rows = np.flatnonzero(held)
        if len(rows) > 1:
            yield _last(face, positions[rows[0]], -step), _last(face, positions[rows[-1]], step)


def _last(face: ExactFace, at: Floats, step: Floats) -> Floats:
    """Return the last position inside a face's trim on the way from one inside it over a step that ends outside or at its bounds."""
    low, high = 0.0, 1.0
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        held = bool(face.inside((at + middle * step)[None])[0])
        low, high = (middle, high) if held else (low, middle)
    return at + low * step


def fillet_radii(face: ExactFace) -> Floats:
    """Return the radii (k,) mm of a root fillet along it, from the two ends of its lines across.

    A ball that rolls in a corner touches both surfaces: its middle is one radius off either along their normals there, so the radius is
    the distance of the two points over that of the unit normals, which lie along one line. What the modeller's surface does in between
    does not count, nor lines whose ends are touched by two balls.
    """
    best = np.zeros(0)
    steepest = -1.0
    for way in (0, 1):
        ends = list(trimmed_lines(face, way, RADII))
        if not ends:
            continue
        first, last = (face.at(np.array([e[k] for e in ends])) for k in (0, 1))
        step, change = last.point - first.point, last.normal - first.normal
        away, turn = np.linalg.norm(step, axis=1), np.linalg.norm(change, axis=1)
        sharp = float(np.median(turn / np.maximum(away, COINCIDENT)))
        if sharp > steepest:
            aligned = -(step * change).sum(axis=1) > ONE_BALL * away * turn
            steepest, best = (
                sharp,
                (away / np.maximum(turn, COINCIDENT))[aligned & (turn > LEAST_TURN)],
            )
    return best
