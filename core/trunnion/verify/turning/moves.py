"""The blocks of turning programs in the plane through the work's axis, and what a tool's outline sweeps along them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from trunnion import tolerance
from trunnion.findings import BadInput
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.frame import Frame
from trunnion.model.motion.program import Program, ProgramSection
from trunnion.model.motion.toolpath import Motion
from trunnion.model.tool import TurningTool

CHORD = 2e-4
"""mm: chord error at which arcs of blocks and of inserts are followed."""
SPACING = 0.25
"""mm between points round what two areas share: as large as what is missed between two of them is no deeper than half of it."""
ON_AXIS = 2e-3
"""mm and rad: a setup's zero and z lie this close to the work's axis."""


@dataclass(frozen=True, slots=True)
class MeridianFrame:
    """A setup's plane of motions in the work's own: height = `zero` + `up` z, radius = x; `up` is 1, or -1 where it is turned over."""

    zero: float
    up: float

    @staticmethod
    def of(setup: Frame, work: Frame, name: str) -> MeridianFrame:
        """Return how a setup's plane lies in that about the z of the work; raise `BadInput` where they have no common axis."""
        origin = work.to_local(setup.origin)
        up = float(setup.z @ work.z)
        if math.hypot(origin[0], origin[1]) > ON_AXIS or abs(abs(up) - 1.0) > ON_AXIS**2:
            raise BadInput(
                f"setup {name}: the work turns about its z, and the blank is none of revolution about that"
            )
        return MeridianFrame(zero=float(origin[2]), up=math.copysign(1.0, up))

    def of_points(self, x: Floats, z: Floats) -> Floats:
        """Return radius and height (n, 2) of points of a program."""
        return np.column_stack([x, self.zero + self.up * z])

    def of_tool(self, profile: Floats) -> Floats:
        """Return a tool's outline (m, 2) of x and z about its point as radius and height."""
        return profile * [1.0, self.up]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class TurningMoves:
    """The moves of a setup, n in order: start, end (n, 2) and centre (n, 2; NaN for lines) as radius and height; sweep (n,) rad from the
    height's direction to the radius's, 0 for lines; rapid (n,), feed (n,) mm/min, turns (n,) 1/min at the end, length (n,) mm; section,
    block (n,)."""

    start: Floats
    end: Floats
    centre: Floats
    sweep: Floats
    rapid: Bools
    feed: Floats
    turns: Floats
    length: Floats
    section: Ints
    block: Ints

    def __len__(self) -> int:
        return len(self.rapid)

    def poses(self, row: int) -> Floats:
        """Return points (k, 2) of a move, the first and the last among them, whose chords follow it."""
        start, end, sweep = self.start[row], self.end[row], float(self.sweep[row])
        if sweep == 0.0:
            return np.stack([start, end])
        centre = self.centre[row]
        radius = float(np.linalg.norm(start - centre))
        step = 2.0 * math.acos(max(1.0 - CHORD / max(radius, CHORD), -1.0))
        count = max(1, math.ceil(abs(sweep) / step))
        first = math.atan2(start[0] - centre[0], start[1] - centre[1])
        angle = first + sweep * np.arange(count + 1) / count
        points = centre + radius * np.column_stack([np.sin(angle), np.cos(angle)])
        points[0], points[-1] = start, end
        return points


def turning_moves(program: Program, plane: MeridianFrame) -> TurningMoves:
    """Return the moves of a program that turns, in the work's plane; raise `BadInput` where some of its sections don't turn."""
    start, end, centre, sweep = [], [], [], []
    rapid, feed, turns, length, section, block = [], [], [], [], [], []
    before: ProgramSection | None = None
    for index, s in enumerate(program.sections):
        if not s.path.work_turns or not isinstance(s.tool, TurningTool):
            raise BadInput(
                f"operation {s.operation}: a setup turns all along or mills all along; give it a setup of its own"
            )
        path = s.path
        first = path.starts()
        if before is not None and before.tool == s.tool and len(before.path) and len(path):
            first[0] = before.path.position[-1]
        start.append(plane.of_points(first[:, 0], first[:, 2]))
        end.append(plane.of_points(path.position[:, 0], path.position[:, 2]))
        centre.append(plane.of_points(path.centre[:, 0], path.centre[:, 2]))
        sweep.append(plane.up * path.sweeps())
        rapid.append(path.motion == Motion.RAPID)
        feed.append(path.feed)
        turns.append(s.turns())
        run = path.lengths()
        if len(run):
            run[0] = float(np.linalg.norm(path.position[0] - first[0]))
        length.append(run)
        section.append(np.full(len(path), index))
        block.append(np.arange(len(path)))
        before = s
    return TurningMoves(
        start=np.vstack([np.zeros((0, 2)), *start]),
        end=np.vstack([np.zeros((0, 2)), *end]),
        centre=np.vstack([np.zeros((0, 2)), *centre]),
        sweep=np.concatenate([np.zeros(0), *sweep]),
        rapid=np.concatenate([np.zeros(0, bool), *rapid]),
        feed=np.concatenate([np.zeros(0), *feed]),
        turns=np.concatenate([np.zeros(0), *turns]),
        length=np.concatenate([np.zeros(0), *length]),
        section=np.concatenate([np.zeros(0, int), *section]).astype(np.int64),
        block=np.concatenate([np.zeros(0, int), *block]).astype(np.int64),
    )


def swept(shape: Floats, poses: Floats) -> BaseGeometry:
    """Return what a convex outline (m, 2) sweeps that is carried along points (k, 2): the hulls of neighbours together."""
    a = poses[:-1, None] + shape
    b = poses[1:, None] + shape
    hulls = shapely.convex_hull(shapely.linestrings(np.concatenate([a, b], axis=1)))
    return shapely.union_all(hulls)


def is_turning(program: Program) -> bool:
    """Return whether any section of a program turns the work."""
    return any(s.path.work_turns or not s.tool.rotates for s in program.sections)


def in_order(programs: Sequence[Program]) -> int:
    """Return how many programs turn; raise `BadInput` where one turns after another has milled."""
    turning = [is_turning(p) for p in programs]
    count = sum(turning)
    if not all(turning[:count]):
        late = programs[max(k for k, turns in enumerate(turning) if turns)].setup.name
        raise BadInput(
            f"setup {late} turns what was milled before: interrupted cuts can't be proven yet; turn first, then mill"
        )
    return count


def depth_between(a: BaseGeometry, b: BaseGeometry, within: float) -> tuple[float, Floats]:
    """Return how deep two areas lie in each other (mm) and where: of the points round what they share, the farthest from either's rim.

    What they share but for `within` mm along their rims does not count. Points are no farther apart than `SPACING`, so that a wall which
    goes right through the other area is seen: its corners lie on both rims.
    """
    nowhere = np.zeros(2)
    if not shapely.intersects(a, b):
        return 0.0, nowhere
    shared = shapely.intersection(a, b)
    if shared.is_empty or shared.area <= within * tolerance.COINCIDENT:
        return 0.0, nowhere
    points = shapely.get_coordinates(shapely.segmentize(shared, SPACING))
    spots = shapely.points(points)
    away = np.maximum(
        shapely.distance(shapely.boundary(a), spots), shapely.distance(shapely.boundary(b), spots)
    )
    worst = int(np.argmax(away))
    depth = float(away[worst])
    return (depth, points[worst]) if depth > within else (0.0, nowhere)
