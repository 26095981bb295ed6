"""Pockets and profiles: ground that bosses stand on with what rises around it, and everything else that is turned.

Bottom: connected faces of revolution that bosses stand on. Restrict: sides of those bosses. Side: other faces that rise from the bottom
in a concave edge or a fillet. Profile: the remaining faces of revolution, grouped by common edges.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from trunnion.geometry.facegraph import CONCAVE, CONVEX, SMOOTH
from trunnion.recognize.casing.bosses import BossFaces
from trunnion.recognize.casing.faces import CasingFaces
from trunnion.recognize.grow import grown, same_surface
from trunnion.tolerance import ANGLE, SLIVER


@dataclass(frozen=True, slots=True, kw_only=True)
class PocketFaces:
    """A pocket by face rows, and the numbers of the bosses that stand on its bottom."""

    bottom: tuple[int, ...]
    side: tuple[int, ...]
    restrict: tuple[int, ...]
    bosses: tuple[int, ...]

    @property
    def rows(self) -> tuple[int, ...]:
        """All face rows."""
        return (*self.bottom, *self.side, *self.restrict)


def find_pockets(faces: CasingFaces, bosses: Sequence[BossFaces]) -> tuple[PocketFaces, ...]:
    """Return the pockets of a casing, in the order of their bottoms' rows: those with bosses, then recesses without one."""
    ground = {g for boss in bosses for g in boss.ground}
    of_bosses = {r for boss in bosses for r in boss.rows}
    found: list[PocketFaces] = []
    waiting = set(ground)
    while waiting:
        bottom = _bottom(faces, min(waiting), ground, of_bosses)
        waiting -= set(bottom)
        found.append(_pocket(faces, bottom, bosses, of_bosses))
    taken = of_bosses | {r for p in found for r in p.rows}
    before = -1
    while before < len(found):
        # A recess that others are sunk into is one once these are found.
        before, sunk = len(found), {r for p in found for r in p.side}
        for row in faces.present:
            if row not in taken and _is_recess(faces, row, sunk):
                recess = _pocket(faces, (row,), bosses, of_bosses)
                found.append(recess)
                taken |= set(recess.rows)
    return tuple(found)


def _bottom(
    faces: CasingFaces, seed: int, ground: set[int], of_bosses: set[int]
) -> tuple[int, ...]:
    """Return the connected ground around a seed, with the pieces of its surfaces that no boss stands on."""
    graph = faces.graph

    def goes_on(edge: int, a: int, b: int) -> bool:
        if b in of_bosses or b in faces.holes or not faces.turned[b]:
            return False
        return b in ground or bool(
            graph.convexity[edge] == SMOOTH
            and (
                same_surface(graph, a, b, SLIVER, ANGLE)
                or (graph.surface[a] == graph.surface[b] == "cone" and not faces.is_blend(b))
            )
        )

    return tuple(sorted(grown(graph, [seed], goes_on)))


def _pocket(
    faces: CasingFaces, bottom: tuple[int, ...], bosses: Sequence[BossFaces], of_bosses: set[int]
) -> PocketFaces:
    own = set(bottom)
    numbers = tuple(n for n, boss in enumerate(bosses) if own & set(boss.ground))
    restrict = {s for n in numbers for s in bosses[n].sides if own & faces.ground_of[s]}
    side = set(_rising(faces, bottom, of_bosses))
    return PocketFaces(
        bottom=bottom,
        side=tuple(sorted(side - own)),
        restrict=tuple(sorted(restrict)),
        bosses=numbers,
    )


def _rising(faces: CasingFaces, bottom: Sequence[int], of_bosses: set[int]) -> Iterator[int]:
    """Yield what rises from a bottom beside its bosses: over concave edges, or over a hollow fillet, which counts too."""
    graph = faces.graph
    for row in bottom:
        for edge in graph.edges_of[row]:
            other = graph.across(edge, row)
            if other in of_bosses or other in faces.holes:
                continue
            if graph.convexity[edge] == CONCAVE:
                yield other
            elif graph.convexity[edge] == SMOOTH and _is_foot(faces, other, set(bottom)):
                yield other
                for beyond in graph.neighbours(other, SMOOTH):
                    if beyond not in bottom and beyond not in of_bosses | faces.holes:
                        yield beyond


def _is_foot(faces: CasingFaces, row: int, bottom: set[int]) -> bool:
    """Return whether a face is a fillet between a bottom and what rises from it: hollow, and a face beyond looks elsewhere."""
    graph = faces.graph
    if row in bottom or graph.surface[row] in ("plane", "cone") or graph.bend[row] >= 0:
        return False
    if graph.surface[row] == "cylinder" and faces.turned[row]:
        return False
    ground = [n for n in graph.neighbours(row, SMOOTH) if n in bottom]
    return any(
        n not in bottom and all(_turns(faces, n, g) for g in ground)
        for n in graph.neighbours(row, SMOOTH)
    )


def _turns(faces: CasingFaces, row: int, ground: int) -> bool:
    """Return whether a face rises from ground by a good part of a right angle."""
    return faces.alignment(row, ground) < RISES


RISES = 0.7
"""Cosine between the normals of a bottom and of what rises from it: 45 degrees and more."""


def _is_recess(faces: CasingFaces, row: int, sunk: set[int]) -> bool:
    """Return whether a turned face is the floor of a milled recess: it does not run round, and milled walls rise all around it. Another
    recess may be sunk into it, whose walls are in `sunk`."""
    graph = faces.graph
    if row in faces.holes or not faces.turned[row] or faces.runs_round(row):
        return False
    rim = [
        (graph.convexity[e], graph.across(e, row))
        for e in graph.edges_of[row]
        if graph.across(e, row) not in faces.holes
        and not (graph.convexity[e] == CONVEX and graph.across(e, row) in sunk)
    ]
    walls = [n for c, n in rim if c != CONVEX]
    return (
        len(walls) == len(rim) > 0
        and any(not faces.turned[n] for n in walls)
        and all(c == CONCAVE or faces.is_blend(n) for c, n in rim)
    )


def find_profiles(faces: CasingFaces, taken: set[int]) -> tuple[tuple[int, ...], ...]:
    """Return the turned faces that are in nothing else yet, in groups that hang together by common edges.

    What ends in an inner corner with a wall that is not turned is the end of an opening, not turned itself.
    """
    graph = faces.graph
    free = {r for r in faces.present if faces.turned[r] and r not in taken and r not in faces.holes}
    walls = set(faces.present) - taken - faces.holes - set(np.flatnonzero(faces.turned).tolist())
    free = {
        r
        for r in free
        if faces.runs_round(r) or not walls.intersection(graph.neighbours(r, CONCAVE))
    }
    found = []
    allowed = frozenset(free)
    while free:
        group = grown(graph, [min(free)], lambda _edge, _a, b: b in allowed)
        free -= set(group)
        found.append(tuple(sorted(group)))
    return tuple(found)
