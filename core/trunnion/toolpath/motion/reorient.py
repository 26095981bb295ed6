"""From one direction of the tool to another: rapids that keep the whole tool clear of the work while it turns.

Round everything that is on the table lies a sphere. A tool whose tip is outside it and that points at its middle is outside with all of
its body, however wide: it stands behind the plane that touches the sphere at the tip. So the tool goes out along its axis until it is
behind such a plane, turns round the sphere, and comes in along its new axis.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Floats
from trunnion.model.blank import Blank
from trunnion.model.motion.toolpath import Mark, Motion, Toolpath
from trunnion.model.setup import Setup

STEP = math.radians(5.0)
"""Largest turn in one block: the straight paths of the tip between stay outside the sphere because it is taken a thousandth larger."""
FAR = math.radians(30.0)
"""Lean from upright beyond which a tool goes round the part's axis rather than over the top."""
LEAST_SAFE = 1.0
"""mm: how far outside of everything the sphere lies at least, whatever the clearance."""
Pose = tuple[Floats, Floats]
"""A tip (3,) and the tool's unit axis (3,)."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ClearanceSphere:
    """The sphere that a turning tool stays out of: `centre` (3,) and `radius` mm, in the setup frame."""

    centre: Floats
    radius: float

    def above(self, tip: Floats, axis: Floats) -> Floats:
        """Return where a tip (3,) comes to when it goes out along its axis (3,) until the tool is clear of the sphere."""
        out = self.radius - float((tip - self.centre) @ axis)
        return np.asarray(tip + max(out, 0.0) * axis)


def clearance_sphere(blank: Blank, setup: Setup) -> ClearanceSphere:
    """Return the sphere round the blank and the fixtures of a setup, as far from them as the clearance height is from the blank."""
    low, high = blank.box_in(setup.frame)
    centre = 0.5 * (low + high)
    held = [
        setup.frame.to_local(f.mesh.points) for f in setup.fixtures if f.setup in ("", setup.name)
    ]
    top = max((high[2], *(float(points[:, 2].max()) for points in held)))
    safe = max(setup.clearance - top, LEAST_SAFE)
    reaches = [float(np.linalg.norm(points - centre, axis=1).max()) for points in held]
    radius = max((blank.reach(centre, setup.frame), *reaches)) + safe
    return ClearanceSphere(centre=centre, radius=radius / math.cos(0.5 * STEP))


def moved_over(path: Toolpath, before: Pose | None, sphere: ClearanceSphere) -> Toolpath:
    """Return a path with the rapids in front that bring the tool safely to its first pose.

    `before` is the pose that the tool was left in, or None when it comes from its change: then it comes in along its axis from outside the
    sphere. A path that begins in the direction that the tool has already, or upright from its change, is returned as it is.
    """
    if not len(path):
        return path
    tip, axis = path.position[0], path.axis[0]
    upright = float(np.linalg.norm(axis - np.array([0.0, 0.0, 1.0]))) <= tolerance.PARAMETRIC
    if before is None:
        return path if upright else _led([(sphere.above(tip, axis), axis)], path)
    start, direction = np.asarray(before[0]), np.asarray(before[1])
    if float(np.linalg.norm(axis - direction)) <= tolerance.PARAMETRIC:
        return path
    turned = turned_round(direction, axis)
    around = [(sphere.centre + sphere.radius * a, a) for a in turned]
    return _led(
        [(sphere.above(start, direction), direction), *around, (sphere.above(tip, axis), axis)],
        path,
    )


def led_away(path: Toolpath, sphere: ClearanceSphere) -> Toolpath:
    """Return a path after which the tool may be drawn straight up, as machines do before a tool change.

    Upwards a tool that points upwards (its axis with z below 0) comes nearer to what stands over it: such a path goes on out of the sphere
    and round it until the tool is level, when no way up comes nearer.
    """
    if not len(path) or path.axis[-1, 2] >= -tolerance.PARAMETRIC:
        return path
    tip, axis = path.position[-1], path.axis[-1]
    poses = [(sphere.above(tip, axis), axis)]
    poses += [(sphere.centre + sphere.radius * a, a) for a in turn(axis, _level(axis))]
    return Toolpath.join([path, _rapids(poses, path)])


def _level(axis: Floats) -> Floats:
    """Return the level direction (3,) that is nearest to an axis (3,); x for one that is upright."""
    size = float(np.hypot(axis[0], axis[1]))
    return np.array(
        [axis[0] / size, axis[1] / size, 0.0] if size > tolerance.PARAMETRIC else [1.0, 0.0, 0.0]
    )


def joined(
    paths: Sequence[Toolpath], changes: Sequence[bool], sphere: ClearanceSphere
) -> tuple[Toolpath, ...]:
    """Return paths that are cut one after the other, each led from where the one before has left the tool.

    `changes` says which of them begin with a tool change.
    """
    led: list[Toolpath] = []
    before: Pose | None = None
    for path, change in zip(paths, changes, strict=True):
        led.append(moved_over(path, None if change else before, sphere))
        if len(path):
            before = (path.position[-1], path.axis[-1])
    return tuple(led)


def turned_round(first: Floats, last: Floats) -> Floats:
    """Return unit directions (k, 3) from `first` to `last`, no two further apart than `STEP`, both ends included.

    Between two that lean far, lean and angle about z change evenly: no direction leans lower than the lower end, and a head with a table
    turning about z stays on its side, which it would leave on the shortest way over the top.
    """
    lean = np.arccos(np.clip([first[2], last[2]], -1.0, 1.0))
    if lean.min() < FAR or lean.max() > math.pi - FAR:
        return turn(first, last)
    begin, end = (math.atan2(v[1], v[0]) for v in (first, last))
    round_z = math.remainder(end - begin, 2.0 * math.pi)
    count = max(1, math.ceil(math.hypot(lean[1] - lean[0], round_z) / STEP))
    share = np.linspace(0.0, 1.0, count + 1)
    down, angle = lean[0] + share * (lean[1] - lean[0]), begin + share * round_z
    axes = np.column_stack(
        [np.sin(down) * np.cos(angle), np.sin(down) * np.sin(angle), np.cos(down)]
    )
    axes[0], axes[-1] = first, last
    return axes


def turn(first: Floats, last: Floats) -> Floats:
    """Return unit directions (k, 3) from `first` to `last` on the shortest way, no two further apart than `STEP`, both ends included."""
    across = last - (last @ first) * first
    size = float(np.linalg.norm(across))
    if size <= tolerance.PARAMETRIC:
        # Straight back: any way round does; over the top where there is one.
        seed = np.array([0.0, 0.0, 1.0]) if abs(first[2]) < 0.9 else np.array([1.0, 0.0, 0.0])
        across, size = (
            seed - (seed @ first) * first,
            float(np.linalg.norm(seed - (seed @ first) * first)),
        )
    angle = math.atan2(float(np.linalg.norm(np.cross(first, last))), float(first @ last))
    share = np.linspace(0.0, angle, max(1, math.ceil(angle / STEP)) + 1)[:, None]
    axes = np.cos(share) * first + np.sin(share) * (across / size)
    axes[-1] = last
    return np.asarray(axes)


def _led(poses: Sequence[Pose], path: Toolpath) -> Toolpath:
    """Return a path with rapids through poses in front; those that go nowhere are left out."""
    rows = [poses[0]]
    for tip, axis in poses[1:]:
        if (
            max(np.abs(tip - rows[-1][0]).max(), np.abs(axis - rows[-1][1]).max())
            > tolerance.COINCIDENT
        ):
            rows.append((tip, axis))
    if np.abs(rows[-1][0] - path.position[0]).max() <= tolerance.COINCIDENT:
        rows.pop()
    return Toolpath.join([_rapids(rows, path), path]) if rows else path


def _rapids(poses: Sequence[Pose], path: Toolpath) -> Toolpath:
    """Return rapids through poses as a path of its own, of the kind of another one."""
    n = len(poses)
    return replace(
        path,
        position=np.array([t for t, _ in poses]),
        axis=np.array([a for _, a in poses]),
        motion=np.full(n, Motion.RAPID),
        centre=np.full((n, 3), np.nan),
        feed=np.zeros(n),
        mark=np.full(n, Mark.RETRACT),
        dwell=None,
        cycles=(),
    )
