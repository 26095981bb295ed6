"""Blends: floor fillets and corner fillets, found first, passed over by the rules and put back with their roles (rule 6)."""

from __future__ import annotations

from trunnion.geometry.facegraph import CONVEX, SMOOTH, FaceGraph
from trunnion.recognize.grow import bend_radius, grown
from trunnion.recognize.panel.classes import FaceClass, FaceClasses
from trunnion.tolerance import SLIVER

SAME_RADIUS = 0.999
"""A neighbour is the wider one when its radius is larger by more than a thousandth: two halves of one arc don't blend each other."""


def floor_fillets(graph: FaceGraph, classes: FaceClasses) -> frozenset[int]:
    """Return the rows of the blends between floors and walls: smooth to a floor, rising from it, and the patches between them."""
    seeds = [
        r
        for r in classes.rows(FaceClass.BLEND)
        if any(
            rises_from(graph, e, r) and _floor_side(graph, classes, e, r) for e in graph.edges_of[r]
        )
    ]
    seeds += [r for r in classes.rows(FaceClass.CROSS) if _cut_off(graph, classes, r, seeds)]
    found = set(seeds)
    return frozenset(
        grown(
            graph,
            seeds,
            lambda edge, _, to: bool(
                graph.convexity[edge] == SMOOTH
                and classes.kind[to] is FaceClass.BLEND
                and (to in found or _patch(graph, classes, to))
            ),
        )
    )


def rises_from(graph: FaceGraph, edge: int, face: int) -> bool:
    """Return whether a face goes up from one of its edges."""
    highest = max(graph.start[edge][2], graph.middle[edge][2], graph.end[edge][2])
    return bool(graph.box_high[face][2] > highest + SLIVER)


def is_corner(graph: FaceGraph, classes: FaceClasses, face: int) -> bool:
    """Return whether a rising face is a blend of two walls: curved, smooth to rising faces at two sides, each of a wider bend."""
    if not classes.rising[face] or graph.surface[face] == "plane":
        return False
    adjacent = {
        graph.across(e, face) for e in graph.edges_of[face] if graph.convexity[e] == SMOOTH
    } - {face}
    walls = [n for n in adjacent if classes.rising[n] and not _stacked(graph, face, n)]
    if len(walls) < 2:
        return False
    own = bend_radius(graph, face)
    return all(
        graph.surface[n] == "plane" or own < SAME_RADIUS * bend_radius(graph, n) for n in walls
    )


def is_rounding(graph: FaceGraph, classes: FaceClasses, face: int) -> bool:
    """Return whether a face of the outer profile rounds a corner off: it bulges, and a wall of a wider bend runs smoothly into it."""
    adjacent = [graph.across(e, face) for e in graph.edges_of[face] if graph.convexity[e] == SMOOTH]
    own = bend_radius(graph, face)
    return bool(
        graph.bend[face] > 0
        and any(classes.rising[n] and own < SAME_RADIUS * bend_radius(graph, n) for n in adjacent)
    )


def _floor_side(graph: FaceGraph, classes: FaceClasses, edge: int, face: int) -> bool:
    other = graph.across(edge, face)
    if graph.convexity[edge] != SMOOTH:
        return False
    return classes.kind[other] is FaceClass.UP or (
        classes.kind[other] is FaceClass.CROSS and graph.surface[other] != "plane"
    )


def _cut_off(graph: FaceGraph, classes: FaceClasses, face: int, whole: list[int]) -> bool:
    """Return whether a hollow round is the foot of a wall that is gone: it rises from a floor, rounded like a whole fillet there."""
    if graph.bend[face] >= 0:
        return False
    floors = [
        graph.across(e, face)
        for e in graph.edges_of[face]
        if rises_from(graph, e, face) and _floor_side(graph, classes, e, face)
    ]
    own = bend_radius(graph, face)
    return any(
        abs(bend_radius(graph, other) - own) <= (1.0 - SAME_RADIUS) * own
        for floor in floors
        for other in graph.neighbours(floor, SMOOTH)
        if other in whole
    )


def _patch(graph: FaceGraph, classes: FaceClasses, face: int) -> bool:
    """Return whether a blend touches no floor and no top of its own: the ball in a corner between two fillets. A dome over them bulges."""
    level = (FaceClass.UP, FaceClass.DOWN)
    return bool(graph.bend[face] <= 0) and not any(
        classes.kind[graph.across(e, face)] in level
        for e in graph.edges_of[face]
        if graph.convexity[e] != CONVEX
    )


def _stacked(graph: FaceGraph, face: int, other: int) -> bool:
    """Return whether two faces only meet above each other (the same wall, split at a height)."""
    return bool(
        graph.box_low[other][2] >= graph.box_high[face][2] - SLIVER
        or graph.box_high[other][2] <= graph.box_low[face][2] + SLIVER
    )
