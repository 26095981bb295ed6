"""Where the work stands on a machine, and poses of the tool to positions of the axes and back: what joint words are computed from.

The words of a program are positions of the machine's own axes. X, Y and Z count from the work offset, which lies at the setup's origin
while all rotary axes stand at 0, with the tool's length taken off: so an upright tool is where its words say, as on three axes.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from trunnion.geometry.arrays import Bools, Floats
from trunnion.model.material import Axis, Machine

UP = np.array([0.0, 0.0, 1.0])
SLACK = 1e-6
"""rad: how far an angle may lie beyond a limit before it counts as outside; far below what an axis repeats."""
POLE = 2e-7
"""Sine of the lean below which an axis is free to stand anywhere: it moves the tool by less than the last written decimal of an angle."""
UPRIGHT = 1e-9
"""Two directions closer than this (their difference's length) are one."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class WorkPosition:
    """A machine, and where the work stands on it.

    `foot` (3,) is the point, in the setup frame, that lies on the middle of the table's top with all axes at 0. Round `centre` (3,), setup
    frame, lies all that stands on the table within `radius` mm, clearance included.
    """

    machine: Machine
    foot: Floats
    centre: Floats
    radius: float

    @property
    def names(self) -> str:
        """The letters of the rotary axes, in the machine's order."""
        return "".join(a.name for a in self.machine.rotary)

    @property
    def limits(self) -> tuple[Floats, Floats]:
        """Lowest and highest angle (a,) of the rotary axes in rad."""
        return tuple(
            np.radians([getattr(a, end) for a in self.machine.rotary]) for end in ("low", "high")
        )  # type: ignore[return-value]


WorkPositions = Mapping[str, WorkPosition]
"""Positions by the names of their setups."""
NO_WORK_POSITIONS: WorkPositions = MappingProxyType({})
"""What is known of three axes: nothing more is needed."""


def words_of(work_position: WorkPosition, tip: Floats, angle: Floats, gauge: float) -> Floats:
    """Return the X, Y, Z words (k, 3) in mm that put tips (k, 3) of the setup frame where they belong at rotary angles (k, a) in rad."""
    work, spindle = _carried(work_position.machine, tip - work_position.foot, angle, gauge)
    return np.asarray(work - spindle + work_position.foot - gauge * UP)


def poses_of(
    work_position: WorkPosition, words: Floats, angle: Floats, gauge: float
) -> tuple[Floats, Floats]:
    """Return tips (k, 3) and unit tool axes (k, 3) in the setup frame at X, Y, Z words (k, 3) and rotary angles (k, a) in rad."""
    machine, n = work_position.machine, len(words)
    at = words - work_position.foot + gauge * UP
    tool, axis = np.tile(-gauge * UP, (n, 1)), np.tile(UP, (n, 1))
    for k, rotary in reversed(list(enumerate(machine.rotary))):
        if rotary.carries == "tool":
            turn, point = rotations(rotary, angle[:, k]), np.array(rotary.point)
            tool, axis = point + _turned(turn, tool - point), _turned(turn, axis)
    at = at + tool
    for k, rotary in enumerate(machine.rotary):
        if rotary.carries == "work":
            back, point = rotations(rotary, -angle[:, k]), np.array(rotary.point)
            at, axis = point + _turned(back, at - point), _turned(back, axis)
    return at + work_position.foot, axis / np.linalg.norm(axis, axis=1, keepdims=True)


def axes_of(work_position: WorkPosition, angle: Floats) -> Floats:
    """Return the unit tool axes (k, 3) in the setup frame at rotary angles (k, a) in rad."""
    return poses_of(work_position, np.zeros((len(angle), 3)), angle, 0.0)[1]


def spindle_of(work_position: WorkPosition, angle: Floats) -> Floats:
    """Return the tool's direction (k, 3) on the machine, X, Y, Z fixed to its bed, at rotary angles (k, a)."""
    axis = np.tile(UP, (len(angle), 1))
    for k, rotary in reversed(list(enumerate(work_position.machine.rotary))):
        if rotary.carries == "tool":
            axis = _turned(rotations(rotary, angle[:, k]), axis)
    return axis


def lift_of(work_position: WorkPosition, angle: Floats) -> Floats:
    """Return where the machine's Z goes (3,), in the setup frame, with the rotary axes at angles (a,)."""
    up = UP[None]
    for k, rotary in enumerate(work_position.machine.rotary):
        if rotary.carries == "work":
            up = _turned(rotations(rotary, -angle[k : k + 1]), up)
    return np.asarray(up[0])


def rotary_solutions(machine: Machine, axis: Floats) -> tuple[Floats, Bools, Bools]:
    """Return both ways (k, 2, a) in rad to hold tool axes (k, 3), which angles are free (k, 2, a), and which axes can be held (k,).

    Limits are not looked at. Two rotary axes one and two hold an axis where R1 R2 v = w; as R2 changes nothing along its own direction u2,
    u2 . (R1 back) w = u2 . v, an equation of the first angle alone; the second then follows from both ends of its turn.
    """
    axes = machine.rotary
    up = np.broadcast_to(UP, axis.shape)
    if len(axes) == 1:
        v, w = (axis, up) if axes[0].carries == "work" else (up, axis)
        angle, is_free = _about(np.array(axes[0].direction), v, w)
        held = np.linalg.norm(_turned(rotations(axes[0], angle), v) - w, axis=1) < POLE
        return (
            np.repeat(angle[:, None, None], 2, axis=1),
            np.repeat(is_free[:, None, None], 2, axis=1),
            held,
        )
    one, two = axes
    if one.carries == two.carries:
        v, w = (axis, up) if one.carries == "work" else (up, axis)
        return _both(one, two, v, w, 1.0)
    if one.carries == "work":
        return _both(one, two, up, axis, -1.0)
    angle, is_free, held = _both(two, one, up, axis, -1.0)
    return angle[:, :, ::-1], is_free[:, :, ::-1], held


def pole_of(machine: Machine) -> Floats:
    """Return the direction (3,) of the tool axis, in the setup frame, at which one rotary axis may stand anywhere."""
    axes = machine.rotary
    work, tool = [a for a in axes if a.carries == "work"], [a for a in axes if a.carries == "tool"]
    return np.array((work[-1] if work else tool[0]).direction)


def rotations(axis: Axis, angle: Floats) -> Floats:
    """Return the matrices (k, 3, 3) that turn right-handed about an axis's direction by angles (k,) in rad."""
    x, y, z = axis.direction
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    sine, rest = np.sin(angle)[:, None, None], (1.0 - np.cos(angle))[:, None, None]
    return np.asarray(np.eye(3) + sine * cross + rest * (cross @ cross))


def _carried(machine: Machine, work: Floats, angle: Floats, gauge: float) -> tuple[Floats, Floats]:
    """Return positions in the work and the tip of the tool, each (k, 3) from the middle of the table and of the spindle's face."""
    tool = np.tile(-gauge * UP, (len(work), 1))
    for k, rotary in reversed(list(enumerate(machine.rotary))):
        turn, point = rotations(rotary, angle[:, k]), np.array(rotary.point)
        if rotary.carries == "work":
            work = point + _turned(turn, work - point)
        else:
            tool = point + _turned(turn, tool - point)
    return work, tool


def _turned(turn: Floats, vectors: Floats) -> Floats:
    return np.asarray(np.einsum("kij,kj->ki", turn, vectors))


def _both(one: Axis, two: Axis, v: Floats, w: Floats, sign: float) -> tuple[Floats, Bools, Bools]:
    """Return both ways to solve R1 R2 v = w for unit v, w (k, 3); `sign` of the first angle.

    Where one angle is free the other is that of the pole itself: with its own small lean the tool would lean to whatever side the free
    one happens to stand at, away from where it should by up to twice as much.
    """
    u1, u2 = np.array(one.direction), np.array(two.direction)
    along, both = w @ u1, float(u1 @ u2)
    p, q, s = w @ u2 - along * both, np.cross(u1, w) @ u2, v @ u2 - along * both
    # p cos + (-q) sin = s has two solutions beside the angle at which its left side is largest.
    size = np.hypot(p, q)
    is_free = size < POLE
    ratio = s / np.where(is_free, 1.0, size)
    half_angle = np.where(
        is_free, 0.0, np.arctan2(np.sqrt(np.maximum((1.0 - ratio) * (1.0 + ratio), 0.0)), ratio)
    )
    second_free = np.linalg.norm(v - np.outer(v @ u2, u2), axis=1) < POLE
    half_angle = np.where(second_free, np.where(half_angle < 0.5 * np.pi, 0.0, np.pi), half_angle)
    middle = np.where(is_free, 0.0, np.arctan2(-q, p))
    held = np.where(is_free, np.abs(s) < POLE, np.abs(ratio) < 1.0 + POLE)
    w = np.where(is_free[:, None], np.where(along < 0.0, -1.0, 1.0)[:, None] * u1, w)
    angle, free = np.zeros((len(v), 2, 2)), np.zeros((len(v), 2, 2), bool)
    for solution, side in enumerate((1.0, -1.0)):
        first = middle + side * half_angle
        angle[:, solution, 0], free[:, solution, 0] = sign * first, is_free
        angle[:, solution, 1], free[:, solution, 1] = _about(
            u2, v, _turned(rotations(one, -first), w)
        )
    return angle, free, held


def _about(u: Floats, v: Floats, w: Floats) -> tuple[Floats, Bools]:
    """Return the angles (k,) about u that bring v to w (k, 3), and where any does because v lies along u."""
    a, b = v - np.outer(v @ u, u), w - np.outer(w @ u, u)
    angle = np.arctan2(np.cross(a, b) @ u, (a * b).sum(axis=1))
    return np.asarray(angle), np.asarray(
        np.minimum(np.linalg.norm(a, axis=1), np.linalg.norm(b, axis=1)) < POLE
    )
