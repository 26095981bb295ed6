"""Finds the holes of a part: runs put together across the holes that cross them, each with the end that it is drilled from."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from trunnion.geometry.arrays import Floats
from trunnion.geometry.facegraph import FaceGraph
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.recognize.holes.bores import is_coaxial
from trunnion.recognize.holes.hole import Hole, roles_of
from trunnion.recognize.holes.runs import CoaxialRun, coaxial_runs, runs_along
from trunnion.recognize.holes.segments import Segment, segments_of
from trunnion.tolerance import ANGLE, SLIVER


def find_holes(
    graph: FaceGraph, largest: float, up: Floats, progress: Progress = NO_PROGRESS
) -> tuple[Hole, ...]:
    """Return the holes of a part up to a diameter of their own side (mm), in the order of their first face rows.

    Every hole has one axis and opens to the outside. Pieces of one diameter on both sides of a hole that crosses them are one hole;
    coaxial holes in separate walls are one each. `up` (3,) is the direction that through holes which look the same from both ends are
    drilled from. Raises `Cancelled` when asked to stop.
    """
    pieces = coaxial_runs(graph, largest, progress)
    owner = {face: n for n, run in enumerate(pieces) for face in run.faces}
    runs = _across_crossings(graph, pieces, owner)
    inside = set(owner)
    middle = np.average(graph.centre, axis=0, weights=graph.area)
    found = []
    for run in progress.each(runs):
        ends = _Ends.of(graph, run, inside)
        if not all(ends.closed):
            found.append(_hole(graph, run, ends, _looks_up(run, ends, up, middle)))
    return tuple(found)


@dataclass(frozen=True, slots=True, eq=False)
class _Ends:
    """The low and the high end of a run: whether it is closed there, its radius, and the faces beyond its rim, those with the longest
    common edge first. `crossed` are the faces of other holes that it runs into; level floors of wider ones, which it opens in, are not.
    """

    closed: tuple[bool, bool]
    radius: tuple[float, float]
    beyond: tuple[tuple[int, ...], tuple[int, ...]]
    crossed: tuple[int, ...]

    @staticmethod
    def of(graph: FaceGraph, run: CoaxialRun, inside: set[int]) -> _Ends:
        """Return the ends of a run; `inside` are the faces of all runs."""
        first, last = run.segments[0], run.segments[-1]
        middle = 0.5 * (first.low + last.high)
        shared: tuple[dict[int, float], dict[int, float]] = ({}, {})
        crossed: dict[int, float] = {}
        for edge, _, other in run.outward(graph):
            height = float(run.frame.to_local(graph.middle[edge])[2])
            is_crossed = other in inside and graph.surface[other] != "plane"
            if not is_crossed and runs_along(graph, edge, run.frame):
                continue
            at = crossed if is_crossed else shared[int(height > middle)]
            at[other] = at.get(other, 0.0) + float(graph.length[edge])
        return _Ends(
            (any(s.closes < 0 for s in run.segments), any(s.closes > 0 for s in run.segments)),
            (first.radius_low, last.radius_high),
            (_longest(shared[0]), _longest(shared[1])),
            _longest(crossed),
        )


def _longest(shared: dict[int, float]) -> tuple[int, ...]:
    return tuple(sorted(shared, key=lambda face: (-round(shared[face], 3), face)))


def _across_crossings(
    graph: FaceGraph, pieces: tuple[CoaxialRun, ...], owner: dict[int, int]
) -> list[CoaxialRun]:
    """Return the runs, those joined that lie on one axis with one diameter on both sides of another hole."""
    met = [{owner[o] for *_, o in run.outward(graph) if o in owner} for run in pieces]
    whole = {n: {n} for n in range(len(pieces))}
    for a, b in combinations([n for n, others in enumerate(met) if others], 2):
        if (
            met[a] & met[b]
            and whole[a] is not whole[b]
            and _is_one_hole(graph, pieces[a], pieces[b])
        ):
            whole[a] |= whole[b]
            for n in whole[a]:
                whole[n] = whole[a]
    found = []
    for n, run in enumerate(pieces):
        if n == min(whole[n]):
            faces = tuple(sorted(f for k in whole[n] for f in pieces[k].faces))
            found.append(run if len(whole[n]) == 1 else CoaxialRun.of(graph, run.frame, faces))
    return found


def _is_one_hole(graph: FaceGraph, a: CoaxialRun, b: CoaxialRun) -> bool:
    """Return whether two runs lie behind each other on one axis, open towards each other with one diameter, and not closed outside."""
    if not is_coaxial(graph, b.narrowest[0].faces[0], a.frame):
        return False
    low, high = a.segments, segments_of(graph, b.faces, a.frame)
    if low[0].low > high[0].low:
        low, high = high, low
    ends = low[-1], high[0]
    return bool(
        high[0].low > low[-1].high - SLIVER
        and abs(ends[0].radius_high - ends[1].radius_low) < SLIVER
        and not ends[0].closes > 0
        and not ends[1].closes < 0
        and not (any(s.closes < 0 for s in low) and any(s.closes > 0 for s in high))
    )


def _looks_up(run: CoaxialRun, ends: _Ends, up: Floats, middle: Floats) -> bool:
    """Return whether a run is drilled from its high end: from the open one, the one outside of other holes, the wider one, the one that
    looks up, the one away from the middle of the part; at last the one that looks along the axes."""
    z = run.frame.z
    height = 0.5 * (run.segments[0].low + run.segments[-1].high)
    tests = (
        float(ends.closed[0]) - float(ends.closed[1]),
        float(bool(ends.beyond[1])) - float(bool(ends.beyond[0])),
        _sure(ends.radius[1] - ends.radius[0], SLIVER),
        _sure(float(z @ up), ANGLE),
        _sure(height - float(run.frame.to_local(middle)[2]), SLIVER),
        float(z[np.argmax(np.abs(z) > ANGLE)]),
    )
    return next(test for test in tests if test != 0.0) > 0.0


def _sure(value: float, least: float) -> float:
    return value if abs(value) > least else 0.0


def _hole(graph: FaceGraph, run: CoaxialRun, ends: _Ends, looks_up: bool) -> Hole:
    """Return the hole of a run that is drilled from its high end, or from its low one."""
    top = max(s.high for s in run.segments) if looks_up else min(s.low for s in run.segments)
    segments: list[Segment] = [
        s if looks_up else s.turned() for s in (run.segments[::-1] if looks_up else run.segments)
    ]
    shift = -top if looks_up else top
    moved = tuple(replace(s, low=s.low + shift, high=s.high + shift) for s in segments)
    through = not any(ends.closed)
    mouth, away = (ends.beyond[1], ends.beyond[0]) if looks_up else ends.beyond
    return Hole(
        mouth=run.frame.to_world(np.array([0.0, 0.0, top])),
        direction=run.frame.z if looks_up else -run.frame.z,
        segments=moved,
        roles=roles_of(moved, through),
        through=through,
        sweep=run.sweep(graph),
        opens_in=mouth,
        leaves_in=away if through else (),
        crosses=ends.crossed,
    )
