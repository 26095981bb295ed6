"""Faces that may belong to a hole: of revolution, with the material outside, and the flat shoulders and bottoms between them."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from trunnion.geometry.arrays import Floats
from trunnion.geometry.facegraph import CONCAVE, SMOOTH, FaceGraph
from trunnion.geometry.frame import Frame
from trunnion.recognize.grow import grown, same_surface
from trunnion.recognize.holes.sweep import arcs, axis_frame, swept
from trunnion.tolerance import ANGLE, SLIVER, TANGENT

HALF = np.pi + TANGENT
"""What is left of a circle must be more than half of it: the ends of a slot have just half, the corners of a pocket less."""


def bore_faces(graph: FaceGraph, largest: float) -> frozenset[int]:
    """Return the rows of the round faces that a hole up to a diameter (mm) may be made of.

    Hollow cylinders up to the diameter, hollow cones that are as narrow somewhere, hollow spheres, and tori: those that bulge round an edge
    off, hollow ones are passed over where they run into a level floor. A recess with such a floor fillet is milled, not drilled.
    """
    return frozenset(
        r for r in range(len(graph)) if graph.area[r] > 0.0 and _may(graph, r, largest)
    )


def radii(graph: FaceGraph, edges: Iterable[int], frame: Frame) -> Floats:
    """Return how far start, middle and end (k, 3) of edges are from a frame's z, in mm."""
    rows = np.array(list(edges), dtype=np.int64)
    points = np.stack([graph.start[rows], graph.middle[rows], graph.end[rows]], axis=1)
    return np.asarray(np.linalg.norm(frame.to_local(points)[..., :2], axis=2))


def is_coaxial(graph: FaceGraph, face: int, frame: Frame) -> bool:
    """Return whether a round face turns about a frame's z."""
    if graph.surface[face] != "sphere" and abs(graph.axis[face] @ frame.z) < np.cos(ANGLE):
        return False
    return bool(np.linalg.norm(frame.to_local(graph.axis_point[face])[:2]) < SLIVER)


def level_floor(
    graph: FaceGraph, face: int, frame: Frame, bores: frozenset[int]
) -> tuple[int, ...]:
    """Return the faces of the flat shoulder or bottom of a hole that a face is of, none when it is no such face.

    It lies across the axis, coaxial hollow faces stand on it around more than half a turn, and nothing else does: neither a wall of
    something wider nor an island.
    """
    if graph.surface[face] != "plane" or abs(graph.normal[face] @ frame.z) < np.cos(ANGLE):
        return ()
    whole = grown(
        graph,
        [face],
        lambda edge, a, b: (
            graph.convexity[edge] == SMOOTH and same_surface(graph, a, b, SLIVER, ANGLE)
        ),
    )
    foot: list[int] = []
    for part in whole:
        for edge in graph.edges_of[part]:
            other = graph.across(edge, part)
            if other in whole or graph.convexity[edge] not in (CONCAVE, SMOOTH):
                continue
            if other not in bores or not is_coaxial(graph, other, frame):
                return ()
            if graph.convexity[edge] == CONCAVE:
                foot.append(edge)
    return whole if foot and swept(arcs(graph, foot, frame)) > HALF else ()


def _may(graph: FaceGraph, face: int, largest: float) -> bool:
    surface, is_hollow = graph.surface[face], bool(graph.bend[face] < 0)
    if surface == "cylinder":
        return bool(is_hollow and 2.0 * graph.radius[face] <= largest + SLIVER)
    if surface == "cone":
        return bool(is_hollow and 2.0 * _narrowest(graph, face) <= largest + SLIVER)
    if surface == "sphere":
        return is_hollow
    return surface == "torus" and not (is_hollow and _runs_into_a_plane(graph, face))


def _narrowest(graph: FaceGraph, face: int) -> float:
    """Return the smallest distance (mm) of a cone's boundary from its axis, infinite without a boundary."""
    frame = axis_frame(graph.axis_point[face], graph.axis[face])
    return float(radii(graph, graph.edges_of[face], frame).min(initial=np.inf))


def _runs_into_a_plane(graph: FaceGraph, face: int) -> bool:
    return any(graph.surface[n] == "plane" for n in graph.neighbours(face, SMOOTH))
