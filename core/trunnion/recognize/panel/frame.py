"""The frame of a panel: where a programmer would put it, whatever position and unit the file came in.

z is the normal with the largest floor area seen from outside (floors lie at the foot of walls, so the flat back doesn't count), of those
that the part has an outermost plane for; where no floor tells, holes do. x is the longer side of the smallest rectangle around the outline,
the origin the lowest corner of the box.
Everything is decided by lengths and areas of the part itself, so that the frame moves with the part.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from trunnion.findings import BadInput
from trunnion.geometry.arrays import Floats
from trunnion.geometry.facegraph import CONCAVE, SMOOTH, FaceGraph
from trunnion.geometry.frame import Frame
from trunnion.recognize.extent import box, outline_points
from trunnion.recognize.grow import samples
from trunnion.recognize.holes.hole import SIDE, Hole
from trunnion.recognize.holes.recognize import find_holes
from trunnion.recognize.panel.settings import PanelSettings
from trunnion.settings import choose
from trunnion.tolerance import ANGLE, COINCIDENT, SLIVER

DECIMALS = 9
"""A frame keeps its numbers to a millionth of a micrometre, so that a part that lies straight has a straight frame."""

BACK = 0.1
"""A face looks back at a direction when the cosine between its normal and the direction is below minus this."""

BALANCE = 1e-4
"""Moments of the part that differ by less than this share of their largest value are equal: the part is symmetric that way."""

FIRM = 0.25
"""Share of the largest plan that a part still stands on when its holes decide: one that is drilled into its thin edge stays lying."""


def choose_frame(graph: FaceGraph, settings: PanelSettings | None = None) -> Frame:
    """Return the frame of recognition for a graph in the part's coordinates; raise `BadInput` when it has no plane face."""
    flat = height_frame(graph, settings)
    local = graph.in_frame(flat)
    angle = _smallest_rectangle(outline_points(local))
    x = flat.world_direction(_long_axis(local, angle, flat.world_direction))
    turned = Frame(np.zeros(3), x, flat.z)
    low, _ = box(graph.in_frame(turned))
    return Frame(
        turned.to_world(low).round(DECIMALS) + 0.0,
        turned.x.round(DECIMALS) + 0.0,
        turned.z.round(DECIMALS) + 0.0,
    )


def height_frame(graph: FaceGraph, settings: PanelSettings | None = None) -> Frame:
    """Return a frame in the part's origin with the z of recognition and any x; raise `BadInput` when the part has no plane face."""
    z = _height_axis(graph, (settings or choose(PanelSettings, {})).hole_diameter)
    return Frame(np.zeros(3), _any_across(graph, z), z)


def flipped(frame: Frame, width: float, height: float) -> Frame:
    """Return the frame that looks from below: z reversed, x kept, its origin at the corner that is the lowest then."""
    return Frame(frame.to_world(np.array([0.0, width, height])), frame.x, -frame.z)


def foot_share(graph: FaceGraph, face: int) -> float:
    """Return the share of a plane face's border that lies at the foot of something: concave edges, hollow blends that rise from it."""
    edges = graph.edges_of[face]
    foot = [
        e
        for e in edges
        if graph.convexity[e] == CONCAVE
        or (
            graph.convexity[e] == SMOOTH
            and graph.surface[graph.across(e, face)] != "plane"
            and _rises(graph, e, face)
        )
    ]
    whole = float(graph.length[list(edges)].sum())
    return float(graph.length[foot].sum()) / whole if whole > 0.0 else 0.0


def _rises(graph: FaceGraph, edge: int, face: int) -> bool:
    return bool(
        (graph.centre[graph.across(edge, face)] - graph.middle[edge]) @ graph.normal[face] > SLIVER
    )


def _height_axis(graph: FaceGraph, hole_diameter: float) -> Floats:
    """Return the direction that floors look to: the plane family with the largest floors times plan, then the sense with more floor.

    The plan keeps the sides of a boss on a thin plate, which stand on a floor as well, from being taken for floors; bottoms of holes are
    none. Where floors don't decide, holes up to a diameter (mm) do: the axis that the larger area of them lies along, then the largest
    plan, then the sense that more of them open to. A part that looks the same from either side keeps the sense of its file.
    """
    planes = [r for r, s in enumerate(graph.surface) if s == "plane" and graph.area[r] > 0.0]
    if not planes:
        raise BadInput("the part has no plane face, so it isn't a panel: choose another family")
    families: list[list[int]] = []
    for r in planes:
        near = next(
            (f for f in families if graph.normal[f[0]] @ graph.normal[r] > np.cos(ANGLE)), None
        )
        if near is None:
            families.append([r])
        else:
            near.append(r)
    directions = [graph.normal[f[0]] for f in families]
    holes = find_holes(graph, hole_diameter, np.zeros(3))
    drilled = {row for hole in holes for row in hole.faces}
    shares = [
        np.array([0.0 if r in drilled else foot_share(graph, r) for r in f]) for f in families
    ]
    alike = [
        [k, *(n for n, other in enumerate(directions) if other @ direction < -np.cos(ANGLE))]
        for k, direction in enumerate(directions)
    ]
    bound = [
        sum(float(graph.area[families[n]] @ shares[n]) for n in same)
        * sum(float(graph.area[families[n]].sum()) for n in same)
        for same in alike
    ]
    resting = _resting(graph, families, alike)
    # What is hidden only takes away: once a family's bound is below the best score, neither it nor any after it can win.
    seen: dict[int, Floats] = {}
    both: dict[int, float] = {}
    for k in sorted(resting, key=lambda k: -bound[k]):
        if both and bound[k] < max(both.values()) * (1.0 - BALANCE):
            break
        for n in alike[k]:
            if n not in seen:
                seen[n] = _seen_area(graph, families[n])
        both[k] = sum(float(seen[n] @ shares[n]) for n in alike[k]) * sum(
            float(seen[n].sum()) for n in alike[k]
        )
    plan = {k: sum(float(seen[n].sum()) for n in alike[k]) for k in both}
    floors = {k: float(seen[k] @ shares[k]) for k in both}
    remaining = _best(sorted(both), both)
    remaining = _along_holes(graph, holes, directions, remaining, plan)
    remaining = _best(_best(remaining, plan), floors)
    ended = [h for h in holes if not h.through or set(h.roles) != {SIDE}]
    mouths = {k: _hole_area(graph, ended, directions[k]) for k in remaining}
    remaining = _best(remaining, mouths)
    return max(
        (directions[k] for k in remaining),
        key=lambda direction: tuple(direction[::-1].round(DECIMALS)),
    )


def _resting(
    graph: FaceGraph, families: Sequence[Sequence[int]], alike: Sequence[Sequence[int]]
) -> list[int]:
    """Return the families of parallel planes that the part can lie on: one of them, or of those that look the other way, is outermost;
    all where none is."""
    points = np.vstack([graph.start, graph.middle, graph.end, graph.sample_point])
    found = []
    for k, same in enumerate(alike):
        direction = graph.normal[families[k][0]]
        along = points @ direction
        ends = (float(along.min()), float(along.max()))
        at = [float(graph.centre[r] @ direction) for n in same for r in families[n]]
        if any(abs(a - end) < SLIVER for a in at for end in ends):
            found.append(k)
    return found or list(range(len(families)))


def _best(rows: Sequence[int], scores: Mapping[int, float]) -> list[int]:
    """Return the rows whose score is the largest, or as good as that."""
    most = max(scores[k] for k in rows)
    return [k for k in rows if scores[k] >= most * (1.0 - BALANCE)]


def _along_holes(
    graph: FaceGraph,
    holes: Sequence[Hole],
    directions: Sequence[Floats],
    rows: Sequence[int],
    plan: Mapping[int, float],
) -> list[int]:
    """Return the rows of equally good directions that the largest area of holes lies along, from either sense, and the part stands on."""
    most = max(plan[k] for k in rows)
    firm = [k for k in rows if plan[k] >= FIRM * most]
    area = {
        k: _hole_area(graph, holes, directions[k]) + _hole_area(graph, holes, -directions[k])
        for k in firm
    }
    return _best(firm, area) if max(area.values()) > 0.0 else list(rows)


def _hole_area(graph: FaceGraph, holes: Sequence[Hole], direction: Floats) -> float:
    """Return the area (mm2) of the faces of the holes that are drilled from a direction (3,)."""
    return sum(
        float(graph.area[list(h.faces)].sum())
        for h in holes
        if h.direction @ direction > np.cos(ANGLE)
    )


def _seen_area(graph: FaceGraph, faces: list[int]) -> Floats:
    """Return the area of each of some parallel faces that is seen from outside: nothing that looks back stands before it."""
    direction = graph.normal[faces[0]]
    local = graph.in_frame(Frame(np.zeros(3), _any_across(graph, direction), direction))
    back = np.flatnonzero((local.normal[:, 2] < -BACK) & (graph.area > 0.0))
    seen = []
    for r in faces:
        points = np.vstack([local.centre[r], samples(local, r)[0]])[:, None, :]
        over = (
            (points[..., :2] > local.box_low[back, :2])
            & (points[..., :2] < local.box_high[back, :2])
        ).all(axis=2)
        hidden = (over & (local.box_low[back, 2] > points[..., 2] + SLIVER)).any(axis=1)
        seen.append(float(graph.area[r] * (1.0 - hidden.mean())))
    return np.array(seen)


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


def _long_axis(graph: FaceGraph, angle: float, world: Callable[[Floats], Floats]) -> Floats:
    """Return the direction (3,) of x: along the longer side, away from the end where the part has more edges.

    Of a square all four directions are tried. A part that looks the same from either end keeps the sense of its file (`world` turns
    a direction into the file's).
    """
    points = outline_points(graph)
    directions = [
        np.array([np.cos(angle + q * np.pi / 2), np.sin(angle + q * np.pi / 2), 0.0])
        for q in range(4)
    ]
    spans = [float(np.ptp(points @ w[:2])) for w in directions]
    long = [
        w for w, span in zip(directions, spans, strict=True) if span > max(spans) * (1.0 - BALANCE)
    ]
    for measure in (_balance, _skewness):
        for across in (False, True):
            scores = [
                measure(graph, points, np.array([-w[1], w[0], 0.0]) if across else w) for w in long
            ]
            long = [w for w, s in zip(long, scores, strict=True) if s <= min(scores) + BALANCE]
    return max(long, key=lambda w: tuple(world(w).round(DECIMALS)))


def _along(graph: FaceGraph, points: Floats, direction: Floats) -> Floats:
    """Return where the middles of the edges lie along a direction, from -1 to 1 over the part."""
    extent = points @ direction[:2]
    return (graph.middle @ direction - 0.5 * (extent.max() + extent.min())) / (0.5 * np.ptp(extent))


def _balance(graph: FaceGraph, points: Floats, direction: Floats) -> float:
    return float(graph.length @ _along(graph, points, direction) / graph.length.sum())


def _skewness(graph: FaceGraph, points: Floats, direction: Floats) -> float:
    return float(graph.length @ _along(graph, points, direction) ** 3 / graph.length.sum())
