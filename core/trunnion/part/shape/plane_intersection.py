"""Follows the curve in which a plane meets a free surface, step by step in the surface's own parameters.

A step is as long as an arc between its ends stays within `tolerance.FITTED` of the curve: for an arc both ends make the same angle with the
chord, so half the difference of the two angles, times the chord, bounds what lies between.
"""

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
from trunnion.part.topology.faces import TrimmedFace

_MOST_TURN = 0.5
_LONGEST, _SHORTEST = 0.125, 1e-5
_GROWTH = 1.6
_MOST_STEPS, _NEWTON = 5000, 12
_SEEDS = 21
Node = tuple[int, int]
Nodes = list[tuple[Node, Floats]]
Piece = tuple[Node | None, Node | None, Floats, Floats]
Triple = tuple[float, float, float]
UV = tuple[float, float]


@dataclass(slots=True, eq=False)
class Tracer:
    """One face cut by one plane; `size` (mm) is the face's. Inner loops use plain numbers: arrays of three cost more than they save."""

    view: TrimmedFace
    normal: Triple
    offset: float
    size: float
    bounds: tuple[float, float, float, float] = field(init=False)
    wraps: tuple[str, str] = field(init=False)
    _projection: Any = field(init=False)
    _held: tuple[Any, Any, Any] = field(init=False)

    def __post_init__(self) -> None:
        surface = self.view.adaptor
        self.bounds = self.view.bounds()
        self.wraps = (
            _wrap(surface.IsUPeriodic(), surface.IsUClosed()),
            _wrap(surface.IsVPeriodic(), surface.IsVClosed()),
        )
        self._projection = ShapeAnalysis_Surface(BRep_Tool.Surface_s(self.view.face))
        self._held = (gp_Pnt(), gp_Vec(), gp_Vec())

    def uv_of(self, point: Floats) -> UV:
        """Return the (u, v) under a point on the surface."""
        found = self._projection.ValueOfUV(gp_Pnt(*point.tolist()), tolerance.COINCIDENT)
        return self._bounded(found.X(), found.Y())

    def at(self, uv: UV) -> tuple[Triple, Triple, Triple]:
        """Return the point and the two first derivatives at (u, v)."""
        point, du, dv = self._held
        self.view.adaptor.D1(uv[0], uv[1], point, du, dv)
        return point.Coord(), du.Coord(), dv.Coord()

    def above(self, point: Triple) -> float:
        """Return the height of a point above the plane."""
        return _dot(point, self.normal) - self.offset

    def direction(self, uv: UV) -> Triple:
        """Return the unit direction of the curve at (u, v)."""
        _, du, dv = self.at(uv)
        return _unit(_cross(_cross(du, dv), self.normal))

    def stepped(self, uv: UV, along: Triple) -> UV:
        """Return the position on the plane after a step in space."""
        _, du, dv = self.at(uv)
        a, b = _solved(du, dv, along)
        return self.onto_plane((uv[0] + a, uv[1] + b))

    def onto_plane(self, uv: UV) -> UV:
        """Return the position pulled onto the plane along the surface's steepest direction."""
        for _ in range(_NEWTON):
            uv = self._bounded(*uv)
            point, du, dv = self.at(uv)
            miss = self.above(point)
            if abs(miss) < tolerance.PARAMETRIC:
                break
            across = _unit(_cross(du, dv))
            lean = _dot(across, self.normal)
            steep = 1.0 - lean * lean
            if steep < tolerance.PARAMETRIC:
                break
            a, b = _solved(
                du, dv, _scaled(_less(self.normal, _scaled(across, lean)), -miss / steep)
            )
            uv = (uv[0] + a, uv[1] + b)
        return self._bounded(*uv)

    def _bounded(self, u: float, v: float) -> UV:
        u0, u1, v0, v1 = self.bounds
        return _bounded(u, u0, u1, self.wraps[0]), _bounded(v, v0, v1, self.wraps[1])

    def follow(
        self, start: UV, sense: float, targets: list[tuple[Node, Triple, UV]]
    ) -> tuple[Node | None, Floats, Floats] | None:
        """Return the node where the curve ends (None: where it began, when there are no targets), points to it and directions, or None."""
        uv, (point, _, _), step = start, self.at(start), self.size * _LONGEST
        home, heading = point, _scaled(self.direction(start), sense)
        points, headings, travelled = [point], [heading], 0.0
        for _ in range(_MOST_STEPS):
            end = self._end(point, heading, step, targets)
            if (
                end is None
                and not targets
                and travelled > 0.25 * self.size
                and _ahead(point, home, heading, step)
            ):
                return None, np.array([*points, home]), np.array([*headings, headings[0]])
            after = targets[end][2] if end is not None else self.stepped(uv, _scaled(heading, step))
            there = targets[end][1] if end is not None else self.at(after)[0]
            towards = _scaled(self.direction(after), sense)
            moved = math.dist(point, there)
            # A step far longer than the surface is round is pulled back to where it began.
            is_good = _follows(point, heading, there, towards) and (
                end is not None or moved >= 0.01 * step
            )
            if not is_good and step > self.size * _SHORTEST:
                step *= 0.5
                continue
            points.append(there)
            headings.append(towards)
            if end is not None:
                return targets[end][0], np.array(points), np.array(headings)
            if moved < 0.01 * step:
                return None
            travelled += moved
            uv, point, heading = after, there, towards
            step = min(_GROWTH * step, self.size * _LONGEST)
        return None

    @staticmethod
    def _end(
        point: Triple, heading: Triple, step: float, targets: list[tuple[Node, Triple, UV]]
    ) -> int | None:
        near = [
            (math.dist(point, p), n)
            for n, (_, p, _) in enumerate(targets)
            if _ahead(point, p, heading, step)
        ]
        return min(near)[1] if near else None


def trace(
    view: TrimmedFace, plane: Any, own: Nodes, seams: set[int], low: Floats, high: Floats
) -> Iterator[Piece]:
    """Yield the pieces of the curve in which a plane meets a trimmed face: nodes at both ends (None: a closed loop),
    points (k, 3) from one to the other and the unit directions (k, 3) there.

    `own` are the points where the plane meets the face's edges, `seams` the edges that are no boundary, `low` and `high` the face's box.
    Raises `BadInput` when a curve can't be followed from edge to edge.
    """
    size = max(float(np.linalg.norm(high - low)), tolerance.COINCIDENT)
    tracer = Tracer(view, tuple(plane.normal.tolist()), plane.offset, size)
    remaining = [
        (node, tuple(point.tolist()), tracer.uv_of(point))
        for node, point in own
        if node[0] not in seams
    ]
    if not remaining:
        yield from _loops(tracer)
    while remaining:
        first, *others = remaining
        found = _followed(tracer, first, others)
        start = first
        if found is None:
            # Beside a corner a curve may be lost that is found from its other end.
            for start in others:
                found = _followed(tracer, start, [o for o in remaining if o is not start])
                if found is not None and found[0] == first[0]:
                    break
                found = None
        if found is None:
            raise BadInput(
                "a section curve ends inside a free-form face; heal the part in the CAD system"
            )
        remaining = [item for item in remaining if item[0] not in (start[0], found[0])]
        yield start[0], *found


def _followed(
    tracer: Tracer, start: tuple[Node, Triple, UV], others: list[tuple[Node, Triple, UV]]
) -> tuple[Node | None, Floats, Floats] | None:
    """Return what `Tracer.follow` does from a node to one of the others, first to the side where the face is; None where that is lost."""
    _, point, uv = start
    if not others:
        return None
    nearest = min(math.dist(p, point) for _, p, _ in others)
    nudge = 0.02 * min(tracer.size, nearest)
    senses = sorted(
        (1.0, -1.0),
        key=lambda sense: (
            not tracer.view.holds(*tracer.stepped(uv, _scaled(tracer.direction(uv), sense * nudge)))
        ),
    )
    return next(
        (f for f in (tracer.follow(uv, sense, others) for sense in senses) if f is not None), None
    )


def _loops(tracer: Tracer) -> Iterator[Piece]:
    """Yield the closed curves of a plane that meets a face but none of its edges, from positions where samples change side."""
    seeds = np.array(tracer.view.grid(_SEEDS)).reshape(_SEEDS, _SEEDS, 2)
    heights = np.array(
        [[tracer.above(tracer.at((u, v))[0]) for u, v in row] for row in seeds.tolist()]
    )
    done: list[Floats] = []
    for k, m in zip(*np.nonzero((heights[:, :-1] > 0.0) != (heights[:, 1:] > 0.0)), strict=True):
        share = heights[k, m] / (heights[k, m] - heights[k, m + 1])
        u, v = (seeds[k, m] + share * (seeds[k, m + 1] - seeds[k, m])).tolist()
        uv = tracer.onto_plane((u, v))
        point = np.array(tracer.at(uv)[0])
        if not tracer.view.holds(*uv) or any(_is_near(points, point) for points in done):
            continue
        found = tracer.follow(uv, 1.0, [])
        if found is None:
            raise BadInput(
                "a closed section curve can't be followed over a free-form face; heal the part in the CAD system"
            )
        done.append(found[1])
        yield None, *found


def _is_near(points: Floats, point: Floats) -> bool:
    """Return whether a point lies on a curve that was followed already: nearer to a chord than a tenth of its length."""
    start, chord = points[:-1], np.diff(points, axis=0)
    square = (chord * chord).sum(axis=1)
    share = np.clip(
        ((point - start) * chord).sum(axis=1) / np.maximum(square, tolerance.PARAMETRIC**2),
        0.0,
        1.0,
    )
    away = np.linalg.norm(start + share[:, None] * chord - point, axis=1)
    return bool((away < 0.15 * np.sqrt(square)).any())


def _follows(point: Triple, heading: Triple, there: Triple, towards: Triple) -> bool:
    """Return whether an arc between two points with given directions is within `tolerance.FITTED` of the curve between."""
    chord = _less(there, point)
    size = math.sqrt(_dot(chord, chord))
    if size < tolerance.COINCIDENT:
        return True
    first, last = _angle(heading, chord, size), _angle(towards, chord, size)
    return first + last < _MOST_TURN and 0.2 * size * abs(first - last) < tolerance.FITTED


def _angle(direction: Triple, chord: Triple, size: float) -> float:
    across = _cross(direction, chord)
    return math.atan2(math.sqrt(_dot(across, across)) / size, _dot(direction, chord) / size)


def _ahead(point: Triple, target: Triple, heading: Triple, step: float) -> bool:
    sense = _less(target, point)
    return math.sqrt(_dot(sense, sense)) <= step and _dot(sense, heading) > -tolerance.COINCIDENT


def _wrap(is_periodic: bool, is_closed: bool) -> str:
    return "free" if is_periodic else "round" if is_closed else "bound"


def _bounded(value: float, low: float, high: float, wrap: str) -> float:
    """Return a parameter where the surface has it: one that is periodic goes on for ever, others end or begin again at their bounds."""
    if wrap == "free" or low <= value <= high:
        return value
    return low + (value - low) % (high - low) if wrap == "round" else min(max(value, low), high)


def _solved(du: Triple, dv: Triple, along: Triple) -> tuple[float, float]:
    """Return the shares of two directions that come nearest to a vector."""
    uu, uv, vv = _dot(du, du), _dot(du, dv), _dot(dv, dv)
    a, b = _dot(du, along), _dot(dv, along)
    det = uu * vv - uv * uv
    if det <= tolerance.PARAMETRIC**2 * max(uu, vv) ** 2:
        return (a / uu, 0.0) if uu >= vv and uu > 0.0 else (0.0, b / vv if vv > 0.0 else 0.0)
    return (a * vv - b * uv) / det, (b * uu - a * uv) / det


def _dot(a: Any, b: Any) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _cross(a: Any, b: Any) -> Triple:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def _less(a: Triple, b: Triple) -> Triple:
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def _scaled(a: Triple, by: float) -> Triple:
    return a[0] * by, a[1] * by, a[2] * by


def _unit(a: Triple) -> Triple:
    size = math.sqrt(_dot(a, a))
    return _scaled(a, 1.0 / size) if size > 0.0 else a
