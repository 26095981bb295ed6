"""Sections of a control that follows the tip by itself: points in a tilted plane or in the work, each with the tool's direction."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from trunnion import tolerance
from trunnion.findings import BadInput
from trunnion.geometry.arrays import Floats
from trunnion.model.material import leaning_axis
from trunnion.model.motion.program import UNSAID, Stance
from trunnion.model.motion.toolpath import Motion, Toolpath
from trunnion.model.tool import AnyTool
from trunnion.post.readers.sections import (
    CuttingState,
    Pace,
    Point,
    SectionBlocks,
    Sections,
    path_of,
)
from trunnion.shop.kinematics import (
    SLACK,
    UP,
    UPRIGHT,
    WorkPosition,
    axes_of,
    lift_of,
    rotary_solutions,
)
from trunnion.shop.rotary_angles import TURN

SAME_DIRECTION = 1e-6
"""Two directions closer than this (their difference's length) differ by what angles and vectors are written to."""
SWIVEL = math.radians(5.0)
"""Largest turn of an axis in one block of a swivel."""


@dataclass(frozen=True, slots=True, eq=False)
class TipPoses:
    """Points are tips in the setup frame and the unit axis of the tool, on a machine that has to hold it."""

    work_position: WorkPosition
    clearance: float

    def above(self, point: Point, tool: AnyTool) -> Point | None:
        """See `PoseInterpreter`: an upright tool is lifted to the clearance height, a leaning one with the machine's Z beyond all that
        stands on the table."""
        tip, axis = np.array(point[:3]), np.array(point[3:])
        if float(np.linalg.norm(axis - UP)) < UPRIGHT:
            more, lift = self.clearance - float(tip[2]), UP
        else:
            lift = lift_of(self.work_position, angle_at(self.work_position, axis))
            more = self.work_position.radius - float((tip - self.work_position.centre) @ lift)
        if more <= tolerance.WRITTEN:
            return None
        return (*(tip + more * lift).tolist(), *point[3:])

    def opened(self, rows: SectionBlocks) -> tuple[Toolpath, tuple[int, ...]]:
        """See `PoseInterpreter`: between two blocks the tip goes straight and the axis turns evenly, as a toolpath means it."""
        points = np.array(rows.point)
        axis = points[:, 3:] / np.linalg.norm(points[:, 3:], axis=1, keepdims=True)
        path = path_of(rows, points[:, :3], axis, np.array(rows.centre)[:, :3])
        return path, tuple(rows.line)


def angle_at(work_position: WorkPosition, axis: Floats) -> Floats:
    """Return angles (a,) in rad at which a machine holds a tool axis (3,): the way that is within its limits, else the first."""
    low, high = work_position.limits
    both = rotary_solutions(work_position.machine, axis[None])[0][0]
    least = low + np.mod(both - low + SLACK, TURN) - SLACK
    within = (least <= high + SLACK).all(axis=1)
    return np.asarray(least[int(np.argmax(within))])


def swivelled(work_position: WorkPosition, first: Floats, last: Floats) -> Floats:
    """Return the tool's directions (k, 3) on the way from one to another in steps, the first among them: by an even turn where that stays
    within the limits of the rotary axes, else as these go straight; none where both are one.

    Between two directions that lean alike an even turn leans more, which the machine never does.
    """
    angle = math.atan2(float(np.linalg.norm(np.cross(first, last))), float(first @ last))
    if angle < SAME_DIRECTION:
        return np.zeros((0, 3))
    share = np.linspace(0.0, 1.0, max(2, math.ceil(angle / SWIVEL)) + 1)[:, None]
    if angle < math.pi - SWIVEL:
        even = (np.sin((1.0 - share) * angle) * first + np.sin(share * angle) * last) / math.sin(
            angle
        )
        if _holds(work_position, even):
            return even[:-1]
    start, end = angle_at(work_position, first), angle_at(work_position, last)
    low, high = work_position.limits
    way = end - start
    way = np.where(high - low >= TURN, np.remainder(way + math.pi, TURN) - math.pi, way)
    count = max(2, math.ceil(float(np.abs(way).max()) / SWIVEL))
    return axes_of(work_position, start + np.arange(count)[:, None] / count * way)


def _holds(work_position: WorkPosition, axes: Floats) -> bool:
    """Return whether a machine holds all of some tool axes (k, 3) within its limits."""
    low, high = work_position.limits
    both = rotary_solutions(work_position.machine, axes)[0]
    least = low + np.mod(both - low + SLACK, TURN) - SLACK
    return bool(np.all(np.any(np.all(least <= high + SLACK, axis=2), axis=1)))


class TiltedSections(Sections):
    """Sections whose points are given in the plane in force: x, y, z there and the tool's direction.

    `matrix` (3, 3) has the plane's axes in the setup frame as columns, `level` says that it is the setup's own, `known` that the rotary
    axes stand as the plane wants it; `follows` that the control follows the tip, in the setup's own plane. `axis` (3,) is the tool's
    direction in the setup frame, None while it is not known; `_left` the one in which it was taken out of sight.
    """

    def __init__(self, poses: TipPoses) -> None:
        super().__init__(poses)
        self._work_position = poses.work_position
        self._left: Floats | None = None
        self.matrix = np.eye(3)
        self.known = self.follows = False
        self.level = True
        self.axis: Point | None = None
        self._local: Point | None = None

    @property
    def local(self) -> Point | None:
        """Where the tool is, in the plane in force; None while that is not known."""
        if self.at is None:
            return None
        if self._local is None:
            back = self.matrix.T @ np.array([self.at[:3], self.at[3:]]).T
            self._local = (*back[:, 0].tolist(), *back[:, 1].tolist())
        return self._local

    def tilt(self, matrix: Floats, known: bool) -> None:
        """Put another plane into force, the tool standing along its z when it is known to."""
        self.matrix, self.known, self._local = matrix, known, None
        self.level = bool((matrix == np.eye(3)).all())
        if known:
            self.axis = tuple(matrix[:, 2].tolist())

    def follow(self, line: int, code: str, no_plane: str) -> None:
        """Follow the tip from here on: points are tips in the work, directions are vectors; raise `BadInput` in a tilted plane."""
        if not self.level:
            raise BadInput(
                f"line {line}: {code} in a tilted plane is not understood; put {no_plane} first"
            )
        axis = self.axis
        self.tilt(np.eye(3), False)
        self.axis, self.follows = axis, True

    def turn_to(self, line: int, code: str, matrix: Floats, top: str, side: int) -> None:
        """Tilt the plane of the program to axes (3, 3), columns in the setup frame, and turn the tool along its z, to the side named by
        the text (`Stance`): at the top of the machine, unless it points there; raise `BadInput` elsewhere."""
        axis = self.axis if self.known else None
        keeps = axis is not None and np.linalg.norm(matrix[:, 2] - np.array(axis)) <= SAME_DIRECTION
        if self.at is not None and not keeps:
            raise BadInput(
                f"line {line}: {code} turns the tool while it is at the work; put {top} first"
            )
        self.tilt(matrix, True)
        self.stance = UNSAID if keeps else Stance(side)

    def level_out(self) -> None:
        """Take the plane of the setup again; the tool points where it did."""
        axis, level = self.axis, self.level
        self.tilt(np.eye(3), self.known and level)
        self.axis = axis

    def turned_away(self, angle: Floats | None, work_position: WorkPosition) -> None:
        """Let the rotary axes stand at angles (a,) rad, None while one is not known: with all at 0 the plane is the setup's own."""
        at_zero = angle is not None and not angle.any()
        self.tilt(np.eye(3), at_zero)
        self.axis = (
            None if angle is None else tuple(axes_of(work_position, angle[None])[0].tolist())
        )
        self.stance = UNSAID if angle is None else Stance(0, tuple(angle.tolist()))

    def rapid(self, line: int, point: Point, tool: AnyTool, state: CuttingState) -> None:
        """Add a rapid to a point of the plane; where the tool was turned out of sight, with the way round all that stands on the table: at
        each direction the tip is over the point, beyond the sphere round that. A straight way there would go through it."""
        goal, stance = self._in_setup(point), self.stance
        if self.at is None and self._left is not None:
            last = np.array(goal[3:])
            for axis in swivelled(self._work_position, self._left, last):
                self.stance = Stance(self._side_of(stance, last))
                between = (*goal[:3], *axis.tolist())
                super().rapid(line, self.interpreter.above(between, tool) or between, tool, state)
        self._left, self.stance = None, stance
        super().rapid(line, goal, tool, state)
        self._reached(point)

    def feed(
        self,
        line: int,
        motion: Motion,
        point: Point,
        centre: Point,
        pace: Pace,
        tool: AnyTool,
        cutting: CuttingState,
    ) -> None:
        """Add a feed move, its point and centre in the plane."""
        middle = centre if self.level else tuple((self.matrix @ np.array(centre[:3])).tolist())
        super().feed(line, motion, self._in_setup(point), middle, pace, tool, cutting)
        self._reached(point)

    def lift(self, line: int, tool: AnyTool, state: CuttingState) -> None:
        """Take the tool straight up out of sight."""
        if self.at is not None:
            if (up := self.interpreter.above(self.at, tool)) is not None:
                super().rapid(line, up, tool, state)
            self._left = np.array(self.at[3:])
            self.at = None
        self._local = None

    def change_tool(self) -> None:
        """End the section; see `Sections`."""
        super().change_tool()
        self._local = self._left = None

    def _side_of(self, stance: Stance, axis: Floats) -> int:
        """Return the side to which a tool along an axis (3,) leans in a stance; 0 where it is not said, or the tool leans to none."""
        lead = leaning_axis(self._work_position.machine)
        if abs(angle_at(self._work_position, axis)[lead]) < SLACK:
            return 0
        return int(np.sign(stance.angles[lead])) if stance.angles else stance.side

    def _in_setup(self, point: Point) -> Point:
        if self.level:
            return point
        both = self.matrix @ np.array([point[:3], point[3:]]).T
        return (*both[:, 0].tolist(), *both[:, 1].tolist())

    def _reached(self, point: Point) -> None:
        self._local = point
        if self.at is not None:
            self.axis = self.at[3:]
