"""Growing over the face graph: what recognisers of every family share."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import numpy as np

from trunnion.geometry.facegraph import FaceGraph

Rule = Callable[[int, int, int], bool]
"""May the growth go over an edge, from a face, to a face (rows)?"""


def grown(graph: FaceGraph, seeds: Iterable[int], rule: Rule) -> tuple[int, ...]:
    """Return the seeds and every face row reached from them over edges that the rule allows, in order of discovery."""
    found = dict.fromkeys(seeds)
    waiting = list(found)
    while waiting:
        face = waiting.pop(0)
        for edge in graph.edges_of[face]:
            other = graph.across(edge, face)
            if other not in found and rule(edge, face, other):
                found[other] = None
                waiting.append(other)
    return tuple(found)


def loops(graph: FaceGraph, face: int) -> dict[int, tuple[int, ...]]:
    """Return the edges of a face by loop: 0 is the outer one."""
    found: dict[int, list[int]] = {}
    for edge in graph.edges_of[face]:
        a, b = graph.edge_face[edge]
        for side, owner in enumerate((a, b)):
            if owner == face:
                found.setdefault(int(graph.edge_loop[edge, side]), []).append(edge)
    return {number: tuple(dict.fromkeys(found[number])) for number in sorted(found)}


def samples(graph: FaceGraph, face: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the sample points and outward normals (k, 3) of a face."""
    first, last = np.searchsorted(graph.sample_face, (face, face + 1))
    if not (graph.sample_face[first:last] == face).all() or last == first:
        mine = graph.sample_face == face
        return graph.sample_point[mine], graph.sample_normal[mine]
    return graph.sample_point[first:last], graph.sample_normal[first:last]


def bend_radius(graph: FaceGraph, face: int) -> float:
    """Return the radius in mm of the tighter bend of a curved face, infinite for a plane.

    Cylinders, spheres and tori carry theirs; on other surfaces it is measured between the samples whose normals differ most
    for their distance: chord over twice the sine of half the turn.
    """
    if graph.surface[face] == "plane":
        return float("inf")
    if graph.surface[face] in ("cylinder", "sphere"):
        return float(graph.radius[face])
    if graph.surface[face] == "torus":
        return float(graph.minor[face])
    point, normal = samples(graph, face)
    chord = np.linalg.norm(point[:, None] - point[None], axis=2)
    turn = np.linalg.norm(normal[:, None] - normal[None], axis=2)
    wide = turn > 0.5 * turn.max() if turn.size else np.zeros((0, 0), dtype=bool)
    if turn.size == 0 or turn.max() <= 0.0:
        return float("inf")
    return float(np.median(np.sort(chord[wide] / turn[wide])[: max(1, int(wide.sum()) // 4)]))


def same_surface(graph: FaceGraph, a: int, b: int, distance: float, angle: float) -> bool:
    """Return whether two faces lie on one plane or one cylinder, to a distance in mm and an angle in radians."""
    if graph.surface[a] != graph.surface[b] or graph.surface[a] not in ("plane", "cylinder"):
        return False
    away = graph.axis_point[b] - graph.axis_point[a]
    if graph.surface[a] == "plane":
        return bool(
            graph.normal[a] @ graph.normal[b] > np.cos(angle)
            and abs((graph.centre[b] - graph.centre[a]) @ graph.normal[a]) < distance
        )
    return bool(
        abs(graph.axis[a] @ graph.axis[b]) > np.cos(angle)
        and abs(graph.radius[a] - graph.radius[b]) < distance
        and np.linalg.norm(away - (away @ graph.axis[a]) * graph.axis[a]) < distance
        and graph.bend[a] == graph.bend[b]
    )
