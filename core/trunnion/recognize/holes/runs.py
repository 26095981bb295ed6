"""Runs of coaxial hollow faces that hang together: what one hole, or one side of a hole that another crosses, is made of."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np

from trunnion.geometry.facegraph import CONCAVE, SMOOTH, FaceGraph
from trunnion.geometry.frame import Frame
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.recognize.holes.bores import HALF, bore_faces, is_coaxial, level_floor
from trunnion.recognize.holes.segments import Segment, segments_of
from trunnion.recognize.holes.sweep import TURN, arcs, axis_frame, swept
from trunnion.tolerance import SLIVER, TANGENT

SIDES = ("cylinder", "cone")
"""Surfaces that a run is grown from, in this order: without one of them there is no hole."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CoaxialFaces:
    """Faces (rows) of revolution about one axis, with the level faces across it; `frame` has z along the axis."""

    frame: Frame
    faces: tuple[int, ...]

    def outward(self, graph: FaceGraph) -> list[tuple[int, int, int]]:
        """Return the edges to faces beyond: edge, face, face beyond (rows)."""
        own = set(self.faces)
        return [
            (edge, face, other)
            for face in self.faces
            for edge in graph.edges_of[face]
            if (other := graph.across(edge, face)) not in own
        ]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CoaxialRun(CoaxialFaces):
    """Coaxial faces by their surfaces: the segments from low to high along the axis."""

    segments: tuple[Segment, ...]

    @staticmethod
    def of(graph: FaceGraph, frame: Frame, faces: tuple[int, ...]) -> CoaxialRun:
        """Return the run that coaxial faces form."""
        return CoaxialRun(frame=frame, faces=faces, segments=segments_of(graph, faces, frame))

    @property
    def narrowest(self) -> tuple[Segment, ...]:
        """The cylinders of the smallest diameter; where there is none, the cone that comes nearest to the axis."""
        sides = [s for s in self.segments if s.surface == "cylinder"]
        if not sides:
            cones = [s for s in self.segments if s.surface == "cone"]
            return (min(cones, key=lambda s: (s.narrow, s.low)),)
        least = min(s.narrow for s in sides)
        return tuple(s for s in sides if s.narrow < least + SLIVER)

    def sweep(self, graph: FaceGraph) -> float:
        """Return how much of a turn (radians) the narrowest side sweeps."""
        edges = {e for s in self.narrowest for f in s.faces for e in graph.edges_of[f]}
        return swept(arcs(graph, edges, self.frame))


def coaxial_runs(
    graph: FaceGraph, largest: float, progress: Progress = NO_PROGRESS
) -> tuple[CoaxialRun, ...]:
    """Return the runs of holes up to a diameter (mm), in the order of their first faces; raise `Cancelled` when asked to stop.

    Cutting a hole only takes away, so all its edges to faces beyond are outer ones. A face with another edge is of something wider (a
    pocket's wall, a fillet, a ring around an island): the runs are grown again without it, until none is left.
    """
    bores = bore_faces(graph, largest)
    while True:
        found = _grown(graph, bores, progress)
        wrong = {
            face
            for run in found
            for edge, face, other in run.outward(graph)
            if not _is_rim(graph, edge, face, other, run.frame)
        }
        if not wrong & bores:
            break
        bores -= wrong
    clean = [CoaxialRun.of(graph, r.frame, r.faces) for r in found if not wrong & {*r.faces}]
    return tuple(
        r for r in _joined(graph, clean) if r.sweep(graph) > HALF and not _is_conical_pocket(r)
    )


def runs_along(graph: FaceGraph, edge: int, frame: Frame) -> bool:
    """Return whether an edge is a straight line along a frame's z: where a hole is cut open on a side."""
    chord = graph.end[edge] - graph.start[edge]
    length = float(np.linalg.norm(chord))
    return length > SLIVER and abs(float(chord @ frame.z)) > np.cos(TANGENT) * length


def _grown(graph: FaceGraph, bores: frozenset[int], progress: Progress) -> list[CoaxialFaces]:
    found: list[CoaxialFaces] = []
    taken: set[int] = set()
    for surface in SIDES:
        for seed in progress.each(sorted(bores)):
            if seed not in taken and graph.surface[seed] == surface:
                frame = axis_frame(graph.axis_point[seed], graph.axis[seed])
                faces = _coaxial_faces(graph, seed, frame, bores)
                taken.update(faces)
                found.append(CoaxialFaces(frame=frame, faces=faces))
    return sorted(found, key=lambda r: r.faces)


def _coaxial_faces(
    graph: FaceGraph, seed: int, frame: Frame, bores: frozenset[int]
) -> tuple[int, ...]:
    found, waiting = {seed}, [seed]
    while waiting:
        for other in graph.neighbours(waiting.pop()):
            if other in found:
                continue
            added: tuple[int, ...] = ()
            if other not in bores:
                added = level_floor(graph, other, frame, bores)
            elif is_coaxial(graph, other, frame):
                added = (other,)
            found.update(added)
            waiting.extend(added)
    return tuple(sorted(found))


def _is_rim(graph: FaceGraph, edge: int, face: int, other: int, frame: Frame) -> bool:
    """Return whether an edge may bound a hole: an outer one, or one across which the hole's rim is rounded off."""
    if graph.convexity[edge] != SMOOTH or graph.bend[face] >= 0:
        return bool(graph.convexity[edge] != CONCAVE)
    rounded_off = graph.surface[other] != "plane" and graph.bend[other] >= 0
    return bool(rounded_off and not runs_along(graph, edge, frame))


def _is_conical_pocket(run: CoaxialRun) -> bool:
    """Return whether a run is a recess with a level floor and leaning walls: no drill leaves one without a cylinder."""
    surfaces = {s.surface for s in run.segments}
    return "cylinder" not in surfaces and any(
        s.surface == "plane" and s.closes for s in run.segments
    )


def _joined(graph: FaceGraph, found: list[CoaxialRun]) -> list[CoaxialRun]:
    """Return the runs, those joined that slots have cut one cylinder into."""
    whole = {k: {k} for k in range(len(found))}
    cut = [k for k, run in enumerate(found) if run.sweep(graph) < TURN - TANGENT]
    for a, b in combinations(cut, 2):
        if whole[a] is not whole[b] and _share_a_cylinder(graph, found[a], found[b]):
            whole[a] |= whole[b]
            for k in whole[a]:
                whole[k] = whole[a]
    return [
        run
        if len(whole[k]) == 1
        else CoaxialRun.of(
            graph, run.frame, tuple(sorted(f for n in whole[k] for f in found[n].faces))
        )
        for k, run in enumerate(found)
        if k == min(whole[k])
    ]


def _share_a_cylinder(graph: FaceGraph, a: CoaxialRun, b: CoaxialRun) -> bool:
    if not is_coaxial(graph, b.narrowest[0].faces[0], a.frame):
        return False
    return any(
        s.surface == t.surface == "cylinder"
        and abs(s.narrow - t.narrow) < SLIVER
        and min(s.high, t.high) > max(s.low, t.low) + SLIVER
        for s in a.segments
        for t in segments_of(graph, b.faces, a.frame)
    )
