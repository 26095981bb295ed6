"""The outline of a boss across its sides: lines and arcs in the plane that the sides are square to, read from the rim of its top.

The rim is where sides meet what is above them: the top, or the chamfers and roundings around it. Each piece of it has the shape of its
side seen along the boss (a plane is a line, a cylinder an arc); a piece of another side is followed by the points of its edge.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from trunnion.geometry.arrays import Floats
from trunnion.geometry.facegraph import CONCAVE, FaceGraph
from trunnion.geometry.frame import Frame
from trunnion.recognize.casing.bosses import BossFaces
from trunnion.recognize.casing.faces import CasingFaces
from trunnion.recognize.grow import samples
from trunnion.tolerance import ANGLE, COINCIDENT, SLIVER

UPRIGHT = np.sin(0.02)
"""Sine of the draft up to which a side counts as parallel to the boss: castings have a degree, machined bosses none."""
LEVEL = 0.7
"""Cosine to the top's normal above which a face of a boss is a top or a chamfer of it, not a side."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class OutlinePiece:
    """A line or an arc of an outline, in the (u, v) of its plane, mm: from `start` to `end` (2,), about `centre` (2,) with `radius` and
    `turn` (radians, signed) where it is an arc. `side` is the row of the face that it lies on, -1 where the boss goes on into something
    higher; `hollow` when the boss's material is outside of the arc; `fillet` the radius of the fillet at its foot, 0 without one.
    """

    start: Floats
    end: Floats
    side: int
    centre: Floats | None = None
    radius: float = 0.0
    turn: float = 0.0
    hollow: bool = False
    fillet: float = 0.0

    @property
    def length(self) -> float:
        """Length in mm."""
        return (
            float(np.linalg.norm(self.end - self.start))
            if self.centre is None
            else abs(self.turn) * self.radius
        )

    @property
    def is_whole(self) -> bool:
        """Whether it is a whole circle."""
        return abs(self.turn) > 2.0 * np.pi - ANGLE

    def at(self, share: Floats) -> Floats:
        """Return the points (k, 2) at shares (k,) of its length."""
        share = np.asarray(share, dtype=float)
        if self.centre is None:
            return self.start + share[:, None] * (self.end - self.start)
        first = self.start - self.centre
        angle = np.arctan2(first[1], first[0]) + share * self.turn
        return np.asarray(
            self.centre + self.radius * np.column_stack([np.cos(angle), np.sin(angle)])
        )

    def outward(self, share: Floats) -> Floats:
        """Return the unit normals (k, 2) away from the boss at shares (k,) of its length."""
        share = np.asarray(share, dtype=float)
        if self.centre is None:
            along = (self.end - self.start) / max(
                float(np.linalg.norm(self.end - self.start)), COINCIDENT
            )
            return np.tile(np.array([along[1], -along[0]]), (len(share), 1))
        away = (self.at(share) - self.centre) / self.radius
        return np.asarray(-away if self.hollow else away)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class BossOutline:
    """The outline of a boss: `frame` has its origin in the middle of the top and z out of it along the sides, in the coordinates of the
    casing's graph; `pieces` run round it with the boss on their left. `height_of_top` is how far the top leans: its normal's angle to z.
    """

    frame: Frame
    pieces: tuple[OutlinePiece, ...]
    lean: float

    @property
    def is_closed(self) -> bool:
        """Whether the pieces make one loop, end to start."""
        return all(
            np.linalg.norm(a.end - b.start) < SLIVER
            for a, b in zip(self.pieces, (*self.pieces[1:], self.pieces[0]), strict=True)
        )

    def space(self, points: Floats) -> Floats:
        """Return points (k, 2) of the outline's plane as points (k, 3) of the casing's frame."""
        return self.frame.to_world(np.column_stack([points, np.zeros(len(points))]))


def boss_outline(faces: CasingFaces, boss: BossFaces) -> BossOutline:
    """Return the outline of a boss, u across the main axis and v along it as far as the boss lets them."""
    graph = faces.graph
    normal = graph.normal[boss.top[0]]
    z = _direction(graph, boss, normal)
    around = np.cross([0.0, 0.0, 1.0], z)
    u = around if np.linalg.norm(around) > ANGLE else np.array([1.0, 0.0, 0.0])
    plane = Frame(graph.centre[boss.top[0]], u, z)
    rim = _rim(faces, boss, z)
    pieces = [p for e, side, sense in rim for p in _piece(graph, plane, e, side, sense)]
    ordered = _chained(pieces)
    return _centred(
        BossOutline(
            frame=plane,
            pieces=tuple(ordered),
            lean=float(np.arccos(np.clip(normal @ z, -1.0, 1.0))),
        )
    )


def _direction(graph: FaceGraph, boss: BossFaces, normal: Floats) -> Floats:
    """Return the direction that the sides are parallel to: the one that is most nearly square to all their normals; a boss whose sides
    leave it open (a single wall) goes along its top's normal."""
    rows = [s for s in boss.sides if np.abs(samples(graph, s)[1] @ normal).max() < LEVEL]
    if not rows:
        return normal
    normals = np.vstack([samples(graph, s)[1] for s in rows])
    value, vector = np.linalg.eigh(normals.T @ normals / len(normals))
    along = vector[:, 0] * (1.0 if vector[:, 0] @ normal > 0.0 else -1.0)
    if value[1] < ANGLE or along @ normal < LEVEL:
        return normal
    return np.asarray(normal if along @ normal > np.cos(ANGLE) else along)


def _rim(faces: CasingFaces, boss: BossFaces, z: Floats) -> list[tuple[int, int, float]]:
    """Return the edges of the rim with the rows of the sides below them, each with the sense in which it runs counter-clockwise round the
    boss: +1 as its points do. Where a higher boss rises flush, its side counts; where a ring rib cuts the boss, the row is -1."""
    graph = faces.graph
    caps = set(boss.top) | {
        s for s in boss.sides if not faces.ground_of[s] and _is_cap(graph, s, z)
    }
    found = []
    for cap in sorted(caps):
        for edge in graph.edges_of[cap]:
            other = graph.across(edge, cap)
            if other in caps or other in faces.holes:
                continue
            cut = bool(graph.convexity[edge] == CONCAVE) or other not in boss.sides
            row = -1 if cut and faces.runs_round(other) else other
            found.append((edge, row, _sense(graph, edge, other, cut, z)))
    return found


def _is_cap(graph: FaceGraph, row: int, z: Floats) -> bool:
    """Return whether a face of a boss looks up enough all over to be a chamfer or a rounding of its rim."""
    return bool((samples(graph, row)[1] @ z).min() > UPRIGHT)


def _sense(graph: FaceGraph, edge: int, other: int, cut: bool, z: Floats) -> float:
    """Return +1 where an edge runs round its boss counter-clockwise seen against z, -1 where it runs the other way.

    The boss lies to the left of the way round: opposite to the normal of the side below the edge, along that of what cuts the boss.
    """
    start, middle, end = graph.start[edge], graph.middle[edge], graph.end[edge]
    if np.linalg.norm(end - start) < SLIVER:
        return 1.0
    point, normals = samples(graph, other)
    normal = normals[int(np.argmin(np.linalg.norm(point - middle, axis=1)))]
    if graph.surface[other] == "cylinder":
        away = middle - graph.axis_point[other]
        away = away - (away @ graph.axis[other]) * graph.axis[other]
        normal = away if graph.bend[other] > 0 else -away
    inside = normal if cut else -normal
    return 1.0 if float(np.cross(end - start, inside) @ z) > 0.0 else -1.0


def _piece(
    graph: FaceGraph, plane: Frame, edge: int, side: int, sense: float
) -> list[OutlinePiece]:
    points = plane.to_local(np.stack([graph.start[edge], graph.middle[edge], graph.end[edge]]))[
        :, :2
    ]
    if sense < 0.0:
        points = points[::-1]
    start, middle, end = points
    is_round = (
        side >= 0
        and graph.surface[side] == "cylinder"
        and abs(graph.axis[side] @ plane.z) > np.cos(UPRIGHT)
    )
    if is_round:
        centre = plane.to_local(graph.axis_point[side])[:2]
        return [_arc(start, middle, end, centre, float(graph.radius[side]), side, graph)]
    if side < 0 or graph.surface[side] == "plane":
        return [OutlinePiece(start=start, end=end, side=side)] if _apart(start, end) else []
    if np.isfinite(graph.curve_radius[edge]):
        centre = plane.to_local(graph.curve_centre[edge])[:2]
        return [_arc(start, middle, end, centre, float(graph.curve_radius[edge]), side, graph)]
    found = _through(start, middle, end)
    return [OutlinePiece(start=a, end=b, side=side) for a, b in found]


def _apart(a: Floats, b: Floats) -> bool:
    return bool(np.linalg.norm(b - a) > COINCIDENT)


def _arc(
    start: Floats,
    middle: Floats,
    end: Floats,
    centre: Floats,
    radius: float,
    side: int,
    graph: FaceGraph,
) -> OutlinePiece:
    """Return the arc about a centre from start to end over the middle; a closed one turns counter-clockwise."""
    hollow = bool(graph.bend[side] < 0)
    if not _apart(start, end) or np.linalg.norm(end - start) < SLIVER:
        turn = -2.0 * np.pi if hollow else 2.0 * np.pi
    else:
        a, m, b = (np.arctan2(*(p - centre)[::-1]) for p in (start, middle, end))
        to_end, to_middle = (b - a) % (2.0 * np.pi), (m - a) % (2.0 * np.pi)
        turn = to_end if to_middle <= to_end else to_end - 2.0 * np.pi
    return OutlinePiece(
        start=start,
        end=end,
        side=side,
        centre=centre,
        radius=radius,
        turn=float(turn),
        hollow=hollow,
    )


def _through(start: Floats, middle: Floats, end: Floats) -> list[tuple[Floats, Floats]]:
    """Return the lines through three points of an edge that is neither a line nor an arc seen along the boss."""
    return [(a, b) for a, b in ((start, middle), (middle, end)) if _apart(a, b)]


def _chained(pieces: Sequence[OutlinePiece]) -> list[OutlinePiece]:
    """Return pieces in their order round the boss, from the longest; where it is open, the nearest next start goes on."""
    remaining = sorted(pieces, key=lambda p: (-round(p.length, 6), p.side))
    if not remaining:
        return []
    found = [remaining.pop(0)]
    while remaining:
        at = found[-1].end
        nearest = min(
            range(len(remaining)), key=lambda k: float(np.linalg.norm(remaining[k].start - at))
        )
        found.append(remaining.pop(nearest))
    return found


def _centred(outline: BossOutline) -> BossOutline:
    """Return an outline with its frame in the middle of its box across u and v."""
    if not outline.pieces:
        return outline
    share = np.linspace(0.0, 1.0, 33)
    points = np.vstack([p.at(share) for p in outline.pieces])
    whole = [p for p in outline.pieces if p.is_whole]
    middle = (
        whole[0].centre
        if len(outline.pieces) == 1 and whole
        else 0.5 * (points.min(axis=0) + points.max(axis=0))
    )
    assert middle is not None
    moved = tuple(
        OutlinePiece(
            start=p.start - middle,
            end=p.end - middle,
            side=p.side,
            centre=None if p.centre is None else p.centre - middle,
            radius=p.radius,
            turn=p.turn,
            hollow=p.hollow,
            fillet=p.fillet,
        )
        for p in outline.pieces
    )
    return BossOutline(
        frame=outline.frame.moved(np.array([middle[0], middle[1], 0.0])),
        pieces=moved,
        lean=outline.lean,
    )
