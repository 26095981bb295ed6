"""The walls of recesses in a casing's bottoms: from which directions they stand upright, and the fillets at their feet.

A recess is cut along one direction, or its walls go along the bottom's normals: over a bent bottom no single direction is upright to all
walls of the second kind, and the walls of the first kind lean over the bottom away from its middle.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from trunnion.geometry.arrays import Floats
from trunnion.geometry.facegraph import SMOOTH
from trunnion.plan.casing.bottoms import CasingBottom
from trunnion.recognize.casing.boss_sizes import fillet_radius
from trunnion.recognize.casing.bosses import BossFaces
from trunnion.recognize.casing.faces import CasingFaces
from trunnion.recognize.casing.kinds import BOTTOM, SIDE
from trunnion.recognize.grow import samples

UPRIGHT = math.sin(math.radians(0.1))
"""Sine of the angle up to which a wall is upright to a direction: 0.02 mm on a wall of 10 mm."""
SHALLOWEST = math.cos(math.radians(30.0))
"""Sine of the most that a wall leans outwards from a direction it is still cut along by levels."""
BENT = 1e-3
"""Share of a face's normals across their mean from which on it is bent, and upright to one direction alone."""
LEANING = math.sin(math.radians(0.5))
"""Sine of the angle by which a wall leans in over the bottom from which on it does: a disc of 4 mm stays 0.03 mm off its foot."""
LESS = math.radians(3.0)
"""How much less a direction must lean from a bottom's normals beside a wall for the wall to go along it and not with its neighbours."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class WallGroup:
    """Walls of a recess and the fillets at their feet that are cut along one direction (3,), in the casing's frame; rows of the face graph.

    `acute`: the sine of the most by which a wall leans in over the bottom beside it, `tilt` that by which the direction leans from the
    bottom's normals along walls. `height`: of the highest wall over the bottom, mm.
    `hollow`: the least radius of the corners between walls, mm.
    """

    direction: Floats
    walls: tuple[int, ...]
    fillets: tuple[int, ...]
    fillet: float
    acute: float
    tilt: float
    height: float
    hollow: float


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RecessWalls:
    """The walls of a recess in groups, and the rows of those that hang over from every direction."""

    groups: tuple[WallGroup, ...]
    hidden: tuple[int, ...]


def recess_walls(faces: CasingFaces, bottom: CasingBottom) -> RecessWalls:
    """Return the walls of a recess by few directions that make them upright; what is upright to none goes along one it leans out from."""
    own = {t - 1 for t in bottom.pocket.with_role(BOTTOM)}
    sides = [t - 1 for t in bottom.pocket.with_role(SIDE) if not faces.runs_round(t - 1)]
    fillets = [r for r in sides if own.intersection(faces.graph.neighbours(r, SMOOTH))]
    walls = [r for r in sides if r not in fillets]
    if not sides:
        return RecessWalls(groups=(), hidden=())
    middle = _middle(faces, bottom, sides)
    candidates = [*(_own_direction(faces, bottom, r) for r in walls), middle]
    groups: list[tuple[Floats, list[int]]] = []
    open_walls = list(walls)
    for upright in (True, False):
        while open_walls:
            fitting = [
                (d, [r for r in open_walls if _fits(faces, r, d, upright)]) for d in candidates
            ]
            # Of directions that serve as much area the one nearest to the middle's normal.
            direction, served = max(
                fitting,
                key=lambda f: (
                    round(sum(float(faces.graph.area[r]) for r in f[1]), 3),
                    round(float(f[0] @ middle), 6),
                ),
            )
            if not served:
                break
            groups.append((direction, served))
            open_walls = [r for r in open_walls if r not in served]
    groups = _nearest(faces, bottom, groups, middle)
    left = list(fillets)
    made = []
    for direction, served in groups or [(middle, [])]:
        mine = [r for r in left if _meets(faces, r, served) and _fits(faces, r, direction, False)]
        left = [r for r in left if r not in mine]
        made.append((direction, served, mine))
    rest = [r for r in left if _fits(faces, r, middle, False)]
    if rest:
        made.append((middle, [], rest))
    parted = [part for g in made for part in _parted(faces, bottom, *g)]
    return RecessWalls(
        groups=tuple(_group(faces, bottom, *g) for g in parted if g[1] or g[2]),
        hidden=(*open_walls, *(r for r in left if r not in rest)),
    )


def _parted(
    faces: CasingFaces,
    bottom: CasingBottom,
    direction: Floats,
    walls: Sequence[int],
    fillets: Sequence[int],
) -> list[tuple[Floats, list[int], list[int]]]:
    """Return a group's walls that stand upright on the bottom, and apart from them those that lean in over it, to whose feet no level
    disc comes. Fillets go with the walls that they meet, upright ones first."""
    leaning = [r for r in walls if _acute(faces, bottom, r) > LEANING]
    upright = [r for r in walls if r not in leaning]
    if not leaning or not upright:
        return [(direction, list(walls), list(fillets))]
    first = [r for r in fillets if _meets(faces, r, upright)]
    return [
        (direction, upright, first),
        (direction, leaning, [r for r in fillets if r not in first]),
    ]


def _nearest(
    faces: CasingFaces,
    bottom: CasingBottom,
    groups: Sequence[tuple[Floats, list[int]]],
    middle: Floats,
) -> list[tuple[Floats, list[int]]]:
    """Return groups of walls in which those that several directions are upright to, the normal in the middle among them, go along the one
    that leans least from the bottom's normals beside them: the less it leans, the nearer to their feet a level disc comes."""
    found = [(direction, list[int]()) for direction, _ in groups] + [(middle, list[int]())]
    for n, (direction, served) in enumerate(groups):
        for row in served:
            best, least = n, _lean(faces, bottom, row, direction) - LESS
            for k, (other, _) in enumerate(found):
                lean = _lean(faces, bottom, row, other)
                if lean < least and _fits(faces, row, other, True):
                    best, least = k, lean
            found[best][1].append(row)
    return [(direction, served) for direction, served in found if served]


def _lean(faces: CasingFaces, bottom: CasingBottom, row: int, direction: Floats) -> float:
    """Return the largest angle (rad) between a direction and the bottom's normals along a wall."""
    ups = np.array([_up(bottom, p) for p in _rim(faces, [row])])
    return float(np.arccos(np.clip(ups @ direction, -1.0, 1.0)).max())


def _group(
    faces: CasingFaces,
    bottom: CasingBottom,
    direction: Floats,
    walls: Sequence[int],
    fillets: Sequence[int],
) -> WallGroup:
    graph = faces.graph
    foot = BossFaces(
        top=(),
        sides=tuple(walls),
        fillets=tuple(fillets),
        ground=tuple(t - 1 for t in bottom.pocket.with_role(BOTTOM)),
    )
    radii = [r for r in _fillet_radii(faces, foot, bottom) if r > 0.0]
    hollow = [
        float(graph.radius[r])
        for r in walls
        if graph.surface[r] == "cylinder" and graph.bend[r] < 0
    ]
    return WallGroup(
        direction=direction,
        walls=tuple(walls),
        fillets=tuple(fillets),
        fillet=min(radii, default=0.0),
        acute=max((_acute(faces, bottom, r) for r in walls), default=0.0),
        tilt=max((math.sin(_lean(faces, bottom, r, direction)) for r in walls), default=0.0),
        height=max((_height(faces, bottom, r) for r in (*walls, *fillets)), default=0.0),
        hollow=min(hollow, default=math.inf),
    )


def _fillet_radii(faces: CasingFaces, foot: BossFaces, bottom: CasingBottom) -> Iterator[float]:
    """Yield the radii of fillets: those that their surfaces say, else what fits wall and bottom."""
    graph = faces.graph
    for row in foot.fillets:
        if graph.surface[row] == "cylinder":
            yield float(graph.radius[row])
        elif graph.surface[row] == "torus":
            yield float(graph.minor[row])
    for wall in foot.sides:
        yield fillet_radius(faces, foot, wall, bottom.meridian)


def _up(bottom: CasingBottom, point: Floats) -> Floats:
    """Return the unit normal (3,) of the bottom at the angle and height of a point, in the casing's frame."""
    away, along = bottom.meridian.normal(np.asarray(point[2:3]))[0]
    flat = point[:2] / np.linalg.norm(point[:2])
    return np.array([away * flat[0], away * flat[1], along])


def _own_direction(faces: CasingFaces, bottom: CasingBottom, row: int) -> Floats:
    """Return the direction (3,) out of the recess that a wall is upright to, or nearest to it."""
    graph = faces.graph
    up = _up(bottom, graph.centre[row])
    normal = samples(graph, row)[1]
    values, vectors = np.linalg.eigh(normal.T @ normal / len(normal))
    if graph.surface[row] == "cylinder":
        found = np.asarray(graph.axis[row])
    elif values[1] > BENT:
        found = vectors[:, 0]
    else:
        across = vectors[:, 2]
        found = up - (up @ across) * across
    return _unit(found * math.copysign(1.0, float(found @ up)))


def _fits(faces: CasingFaces, row: int, direction: Floats, upright: bool) -> bool:
    """Return whether a wall is upright to a direction, or leans out from it."""
    lean = samples(faces.graph, row)[1] @ direction
    if upright:
        return bool(np.abs(lean).max() <= UPRIGHT)
    return bool(lean.min() >= -UPRIGHT and lean.min() <= SHALLOWEST)


def _meets(faces: CasingFaces, row: int, walls: Sequence[int]) -> bool:
    return bool(set(walls).intersection(faces.graph.neighbours(row)))


def _acute(faces: CasingFaces, bottom: CasingBottom, row: int) -> float:
    """Return the sine by which a wall leans in over the bottom, at most."""
    at, normal = samples(faces.graph, row)
    return max((-float(_up(bottom, p) @ n) for p, n in zip(at, normal, strict=True)), default=0.0)


def _middle(faces: CasingFaces, bottom: CasingBottom, rows: Sequence[int]) -> Floats:
    """Return the bottom's unit normal (3,) in the middle of the angle that walls span about the axis, and of the bottom's height."""
    points = _rim(faces, rows)[:, :2]
    mean = points.mean(axis=0)
    turn = np.arctan2(mean[0] * points[:, 1] - mean[1] * points[:, 0], points @ mean)
    at = math.atan2(float(mean[1]), float(mean[0])) + 0.5 * float(turn.min() + turn.max())
    height = 0.5 * sum(bottom.meridian.ends)
    return _up(bottom, np.array([math.cos(at), math.sin(at), height]))


def _height(faces: CasingFaces, bottom: CasingBottom, row: int) -> float:
    """Return how high (mm) a wall goes over the bottom, along the bottom's normals."""
    line, points = bottom.meridian, _rim(faces, [row])
    over = np.linalg.norm(points[:, :2], axis=1) - line.radius(points[:, 2])
    return float((over * line.normal(points[:, 2])[:, 0]).max())


def _rim(faces: CasingFaces, rows: Sequence[int]) -> Floats:
    """Return points (k, 3) on the edges of faces: their ends and middles."""
    graph = faces.graph
    edges = sorted({e for r in rows for e in graph.edges_of[r]})
    return np.concatenate([graph.start[edges], graph.middle[edges], graph.end[edges]])


def _unit(vector: Floats) -> Floats:
    return np.asarray(vector / np.linalg.norm(vector))
