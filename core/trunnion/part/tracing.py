"""Follows the curve in which a plane meets a free surface, step by step in the surface's own parameters."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from OCP.BRep import BRep_Tool
from OCP.gp import gp_Pnt, gp_Vec
from OCP.ShapeAnalysis import ShapeAnalysis_Surface

from trunnion import tolerance
from trunnion.findings import BadInput
from trunnion.geometry.arrays import Floats
from trunnion.part.faces import FaceView

_TURN = 0.08
_SHARE, _FEWEST = 24.0, 1e4
_MOST_STEPS = 20000
_SEEDS = 21
Node = tuple[int, int]
Piece = tuple[Node | None, Node | None, Floats]


@dataclass(slots=True, eq=False)
class Tracer:
    """One face cut by one plane."""

    view: FaceView
    plane: Any
    size: float
    places: Any = field(init=False)
    wrap: tuple[float, float] = field(init=False)

    def __post_init__(self) -> None:
        self.places = ShapeAnalysis_Surface(BRep_Tool.Surface_s(self.view.face))
        u0, u1, v0, v1 = self.view.bounds()
        a = self.view.adaptor
        self.wrap = (u1 - u0 if a.IsUClosed() and not a.IsUPeriodic() else 0.0, v1 - v0 if a.IsVClosed() and not a.IsVPeriodic() else 0.0)

    def place(self, point: Floats) -> Floats:
        """Return the (u, v) under a point on the surface."""
        found = self.places.ValueOfUV(gp_Pnt(*point.tolist()), tolerance.COINCIDENT)
        return np.array([found.X(), found.Y()])

    def at(self, place: Floats) -> tuple[Floats, Floats, Floats]:
        """Return the point and the two first derivatives at (u, v)."""
        point, du, dv = gp_Pnt(), gp_Vec(), gp_Vec()
        self.view.adaptor.D1(float(place[0]), float(place[1]), point, du, dv)
        return np.array(point.Coord()), np.array(du.Coord()), np.array(dv.Coord())

    def direction(self, place: Floats) -> Floats:
        """Return the unit direction (3,) of the curve at (u, v)."""
        _, du, dv = self.at(place)
        along = np.cross(np.cross(du, dv), self.plane.normal)
        size = float(np.linalg.norm(along))
        return along / size if size > 0.0 else along

    def stepped(self, place: Floats, along: Floats) -> tuple[Floats, Floats]:
        """Return the place and the point on the plane after a step (3,) in space."""
        _, du, dv = self.at(place)
        move = np.linalg.lstsq(np.stack([du, dv], axis=1), along, rcond=None)[0]
        return self.onto_plane(place + move)

    def onto_plane(self, place: Floats) -> tuple[Floats, Floats]:
        """Return the place and the point pulled onto the plane along the surface."""
        for _ in range(12):
            place = self._wrapped(place)
            point, du, dv = self.at(place)
            miss = float(point @ self.plane.normal) - self.plane.offset
            if abs(miss) < tolerance.PARAMETRIC:
                break
            pull = self.plane.normal - _unit(np.cross(du, dv)) * float(self.plane.normal @ _unit(np.cross(du, dv)))
            strength = float(pull @ self.plane.normal)
            if strength < tolerance.PARAMETRIC:
                break
            place = place + np.linalg.lstsq(np.stack([du, dv], axis=1), -miss / strength * pull, rcond=None)[0]
        return place, point

    def _wrapped(self, place: Floats) -> Floats:
        u0, u1, v0, v1 = self.view.bounds()
        for k, (low, high) in enumerate(((u0, u1), (v0, v1))):
            if self.wrap[k] and not low <= place[k] <= high:
                place = place.copy()
                place[k] = low + math.fmod(place[k] - low + self.wrap[k], self.wrap[k])
        return place

    def follow(self, place: Floats, point: Floats, way: float, targets: list[tuple[Node, Floats]]) -> tuple[Node | None, Floats]:
        """Return the node where the curve ends (None: where it began) and the points to it."""
        points, step = [point], self.size / _SHARE
        start, heading = point, way * self.direction(place)
        travelled = 0.0
        for _ in range(_MOST_STEPS):
            ahead = [(float(np.linalg.norm(p - point)), n) for n, (_, p) in enumerate(targets)]
            reached = [(d, n) for d, n in ahead if d <= 1.2 * step and float((targets[n][1] - point) @ heading) > -tolerance.COINCIDENT]
            home = float(np.linalg.norm(start - point))
            if not targets and travelled > 2.5 * step and home <= 1.2 * step and float((start - point) @ heading) > 0.0:
                return None, np.array([*points, start])
            after, there = self.stepped(place, step * heading)
            towards = way * self.direction(after)
            turn = math.acos(max(-1.0, min(1.0, float(towards @ heading))))
            if turn > _TURN and step > self.size / _FEWEST:
                step *= 0.5
                continue
            if reached:
                distance, n = min(reached)
                if distance <= step:
                    return targets[n][0], np.array([*points, targets[n][1]])
            travelled += float(np.linalg.norm(there - point))
            place, point, heading = after, there, towards
            points.append(point)
            if turn < 0.4 * _TURN:
                step = min(1.5 * step, self.size / _SHARE)
        raise BadInput("a section curve could not be followed over a free-form face; heal the part in the CAD system")


def trace(view: FaceView, plane: Any, own: list[tuple[Node, Floats]], seams: set[int], low: Floats, high: Floats) -> Iterator[Piece]:
    """Yield the pieces of the curve in which a plane meets a trimmed face: nodes at both ends and points (k, 3) between, or a closed loop.

    `own` are the points where the plane meets the face's edges, `seams` the edges that are no boundary.
    """
    tracer = Tracer(view, plane, max(float(np.linalg.norm(high - low)), tolerance.COINCIDENT))
    left = [(node, point) for node, point in own if node[0] not in seams]
    if not left:
        yield from _loops(tracer)
        return
    while left:
        node, point = left.pop(0)
        place = tracer.place(point)
        nudge = min(tracer.size / _SHARE, min((float(np.linalg.norm(p - point)) for _, p in left), default=tracer.size)) * 0.02
        ways = [w for w in (1.0, -1.0) if view.holds(*tracer.stepped(place, w * nudge * tracer.direction(place))[0])]
        if not left:
            raise BadInput("a section curve ends inside a face; heal the part in the CAD system")
        end, points = tracer.follow(place, point, ways[0] if ways else 1.0, left)
        left = [item for item in left if item[0] != end]
        yield node, end, points


def _loops(tracer: Tracer) -> Iterator[Piece]:
    """Yield the closed curve of a plane that meets a face but none of its edges, from the first place where samples change side."""
    places = np.array(tracer.view.grid(_SEEDS)).reshape(_SEEDS, _SEEDS, 2)
    heights = np.array([[tracer.at(p)[0] @ tracer.plane.normal - tracer.plane.offset for p in row] for row in places])
    done: list[Floats] = []
    for k, m in zip(*np.nonzero((heights[:, :-1] > 0.0) != (heights[:, 1:] > 0.0)), strict=True):
        share = heights[k, m] / (heights[k, m] - heights[k, m + 1])
        place, point = tracer.onto_plane(places[k, m] + share * (places[k, m + 1] - places[k, m]))
        if not tracer.view.holds(float(place[0]), float(place[1])):
            continue
        if any(np.linalg.norm(points - point, axis=1).min() < tracer.size / _SHARE for points in done):
            continue
        points = tracer.follow(place, point, 1.0, [])[1]
        done.append(points)
        yield None, None, points


def _unit(vector: Floats) -> Floats:
    return vector / (float(np.linalg.norm(vector)) or 1.0)
