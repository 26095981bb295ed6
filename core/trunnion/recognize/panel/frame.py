"""The frame of a panel: where a programmer would put it, whatever position and unit the file came in.

z is the normal with the largest floor area that looks that way (floors lie at the foot of walls, so the flat back doesn't count),
x the longer side of the smallest rectangle around the outline, the origin the lowest corner of the box. Everything is decided by
lengths and areas of the part itself, so that the frame moves with the part.
"""

from __future__ import annotations

import numpy as np

from trunnion.findings import BadInput
from trunnion.geometry.arrays import Floats
from trunnion.geometry.facegraph import CONCAVE, SMOOTH, FaceGraph
from trunnion.geometry.frame import Frame
from trunnion.tolerance import ANGLE, COINCIDENT, SLIVER

ARC_PIECES = 16
"""Chords an arc is opened into while the smallest rectangle is looked for; the box itself is exact on arcs."""

DECIMALS = 9
"""A frame keeps its numbers to a millionth of a micrometre, so that a part that lies straight has a straight frame."""

BALANCE = 1e-4
"""Moments of the part that differ by less than this share of their largest value are equal: the part is symmetric that way."""


def choose_frame(graph: FaceGraph) -> Frame:
    """Return the frame of recognition for a graph in the part's coordinates; raise `BadInput` when it has no plane face."""
    z = _height_axis(graph)
    flat = Frame(np.zeros(3), _any_across(graph, z), z)
    local = graph.in_frame(flat)
    angle = _smallest_rectangle(outline_points(local))
    x = flat.world_direction(_long_axis(local, angle))
    turned = Frame(np.zeros(3), x, z)
    low, _ = box(graph.in_frame(turned))
    return Frame(turned.to_world(low).round(DECIMALS) + 0.0, turned.x.round(DECIMALS) + 0.0, turned.z.round(DECIMALS) + 0.0)


def box(graph: FaceGraph) -> tuple[Floats, Floats]:
    """Return the lowest and highest corner (3,) of the faces of a graph along its own axes, exact on lines and arcs."""
    present = graph.area > 0.0
    low, high = graph.box_low[present].min(axis=0), graph.box_high[present].max(axis=0)
    arcs = np.isfinite(graph.curve_radius)
    for e in np.flatnonzero(arcs).tolist():
        for axis in range(3):
            along = np.eye(3)[axis] - graph.curve_axis[e][axis] * graph.curve_axis[e]
            length = np.linalg.norm(along)
            if length < ANGLE:
                continue
            for sign in (-1.0, 1.0):
                tip = graph.curve_centre[e] + sign * graph.curve_radius[e] * along / length
                if _on_arc(graph, e, tip):
                    low[axis], high[axis] = min(low[axis], tip[axis]), max(high[axis], tip[axis])
    return low, high


def outline_points(graph: FaceGraph) -> Floats:
    """Return points (k, 2) whose convex hull is that of the part seen along z: ends of edges, points of arcs, samples."""
    near = [graph.start, graph.end, graph.middle, graph.sample_point]
    for e in np.flatnonzero(np.isfinite(graph.curve_radius)):
        near.append(_arc_points(graph, int(e), ARC_PIECES))
    return np.concatenate(near)[:, :2]


def flipped(frame: Frame, width: float, height: float) -> Frame:
    """Return the frame that looks from below: z reversed, x kept, its origin at the corner that is the lowest then."""
    return Frame(frame.to_world(np.array([0.0, width, height])), frame.x, -frame.z)


def floor_like(graph: FaceGraph, face: int) -> bool:
    """Say whether a plane face lies at the foot of something: a concave edge, or a hollow blend that rises from it."""
    return any(
        graph.convexity[e] == CONCAVE
        or (graph.convexity[e] == SMOOTH and graph.surface[other] != "plane" and _rises(graph, e, face, other))
        for e in graph.edges_of[face] for other in (graph.across(e, face),)
    )


def _rises(graph: FaceGraph, edge: int, face: int, other: int) -> bool:
    up = graph.normal[face]
    return bool((graph.centre[other] - graph.middle[edge]) @ up > SLIVER)


def _height_axis(graph: FaceGraph) -> Floats:
    planes = [r for r, s in enumerate(graph.surface) if s == "plane" and graph.area[r] > 0.0]
    if not planes:
        raise BadInput("the part has no plane face, so it isn't a panel: choose another family")
    ways: list[tuple[Floats, float, float]] = []
    for r in planes:
        floor = graph.area[r] if floor_like(graph, r) else 0.0
        for i, (way, floors, total) in enumerate(ways):
            if way @ graph.normal[r] > np.cos(ANGLE):
                ways[i] = (way, floors + floor, total + graph.area[r])
                break
        else:
            ways.append((graph.normal[r], floor, graph.area[r]))
    both = [(floors + _opposite(ways, way), floors, total, way) for way, floors, total in ways]
    best = max(b[0] for b in both)
    if best > 0.0:
        family = [b for b in both if b[0] > best * (1.0 - BALANCE)]
        most = max(b[1] for b in family)
        return next(b[3] for b in family if b[1] > most * (1.0 - BALANCE))
    widest = max(b[2] for b in both)
    return next(b[3] for b in both if b[2] > widest * (1.0 - BALANCE))


def _opposite(ways: list[tuple[Floats, float, float]], way: Floats) -> float:
    return sum(floors for other, floors, _ in ways if other @ way < -np.cos(ANGLE))


def _any_across(graph: FaceGraph, z: Floats) -> Floats:
    spans = graph.end - graph.start
    across = spans - np.outer(spans @ z, z)
    length = np.linalg.norm(across, axis=1)
    if length.size and length.max() > COINCIDENT:
        return across[int(np.argmax(length > 0.5 * length.max()))]
    return np.eye(3)[int(np.argmin(np.abs(z)))]


def _hull(points: Floats) -> Floats:
    """Return the convex hull (k, 2), anticlockwise (Andrew's monotone chain)."""
    ordered = sorted({(round(x, 9), round(y, 9)) for x, y in points.tolist()})
    chains = []
    for run in (ordered, ordered[::-1]):
        chain: list[tuple[float, float]] = []
        for p in run:
            while len(chain) > 1 and _turn(chain[-2], chain[-1], p) <= 0.0:
                chain.pop()
            chain.append(p)
        chains.append(chain[:-1])
    return np.array(chains[0] + chains[1])


def _turn(a: tuple[float, float], b: tuple[float, float], c: tuple[float, float]) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _smallest_rectangle(points: Floats) -> float:
    """Return the angle in radians of a side of the smallest rectangle around points; the longest hull edge decides a tie."""
    hull = _hull(points)
    edges = np.roll(hull, -1, axis=0) - hull
    lengths = np.linalg.norm(edges, axis=1)
    angles = np.arctan2(edges[:, 1], edges[:, 0])
    areas = np.array([_rectangle_area(hull, a) for a in angles])
    tied = np.flatnonzero(areas <= areas.min() * (1.0 + BALANCE))
    return float(angles[tied[int(np.argmax(lengths[tied]))]])


def _rectangle_area(hull: Floats, angle: float) -> float:
    c, s = np.cos(angle), np.sin(angle)
    u, v = hull @ (c, s), hull @ (-s, c)
    return float((u.max() - u.min()) * (v.max() - v.min()))


def _long_axis(graph: FaceGraph, angle: float) -> Floats:
    """Return the direction (3,) of x: along the longer side, away from the end where the part has more edges.

    Of a square all four directions are tried. A part that is symmetric that way looks the same from either end: the first edge that
    is off its middle decides.
    """
    points = outline_points(graph)
    ways = [np.array([np.cos(angle + q * np.pi / 2), np.sin(angle + q * np.pi / 2), 0.0]) for q in range(4)]
    spans = [float(np.ptp(points @ w[:2])) for w in ways]
    long = [w for w, span in zip(ways, spans, strict=True) if span > max(spans) * (1.0 - BALANCE)]
    for measure in (_balance, _skewness):
        for across in (False, True):
            scores = [measure(graph, points, np.array([-w[1], w[0], 0.0]) if across else w) for w in long]
            long = [w for w, s in zip(long, scores, strict=True) if s <= min(scores) + BALANCE]
    return min(long, key=lambda w: float(next((d for d in (graph.middle - graph.middle.mean(axis=0)) @ w if abs(d) > SLIVER), 0.0)))


def _along(graph: FaceGraph, points: Floats, way: Floats) -> Floats:
    """Return where the middles of the edges lie along a direction, from -1 to 1 over the part."""
    extent = points @ way[:2]
    return (graph.middle @ way - 0.5 * (extent.max() + extent.min())) / (0.5 * np.ptp(extent))


def _balance(graph: FaceGraph, points: Floats, way: Floats) -> float:
    return float(graph.length @ _along(graph, points, way) / graph.length.sum())


def _skewness(graph: FaceGraph, points: Floats, way: Floats) -> float:
    return float(graph.length @ _along(graph, points, way) ** 3 / graph.length.sum())


def _arc_points(graph: FaceGraph, edge: int, pieces: int) -> Floats:
    """Return points (pieces + 1, 3) along a circular edge, its ends with them."""
    centre, axis = graph.curve_centre[edge], graph.curve_axis[edge]
    u = graph.start[edge] - centre
    sweep = _sweep(graph, edge)
    t = np.linspace(0.0, sweep, pieces + 1)[:, None]
    return centre + np.cos(t) * u + np.sin(t) * np.cross(axis, u)


def _sweep(graph: FaceGraph, edge: int) -> float:
    """Return the turn (radians, signed about `curve_axis`) from an arc's start to its end over its middle."""
    to_end, to_middle = _angle(graph, edge, graph.end[edge]), _angle(graph, edge, graph.middle[edge])
    if np.linalg.norm(graph.end[edge] - graph.start[edge]) < COINCIDENT:
        return 2.0 * np.pi
    return to_end if to_middle <= to_end else to_end - 2.0 * np.pi


def _angle(graph: FaceGraph, edge: int, point: Floats) -> float:
    centre, axis = graph.curve_centre[edge], graph.curve_axis[edge]
    u, p = graph.start[edge] - centre, point - centre
    return float(np.arctan2(axis @ np.cross(u, p), u @ p) % (2.0 * np.pi))


def _on_arc(graph: FaceGraph, edge: int, point: Floats) -> bool:
    sweep, there = _sweep(graph, edge), _angle(graph, edge, point)
    return there <= sweep if sweep > 0.0 else there >= sweep + 2.0 * np.pi
