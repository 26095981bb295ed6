"""How long a machine takes for a toolpath: acceleration, axis limits, and how fast it may go through the joints between blocks.

Along a block the speed follows a trapezoid. Through a joint that turns by an angle a, a machine with acceleration A that rounds the joint
by at most d may go at sqrt(A d s / (1 - s)), s = cos(a / 2) (the circle that touches both blocks and passes d from the joint).
On an arc the centripetal acceleration bounds the speed.
"""

from __future__ import annotations

import math

import numpy as np

from trunnion.geometry.arrays import Bools, Floats
from trunnion.model.material import Machine
from trunnion.model.toolpath import Motion, Toolpath
from trunnion.units import SECONDS_PER_MINUTE

ROUNDING = 0.01
"""mm: how far the machine may round a joint while it keeps moving, about what a control does in contouring mode."""


def machining_time(path: Toolpath, machine: Machine) -> float:
    """Return the seconds that a machine takes for a path, rapids included, from where its first block ends."""
    return float(block_times(path, machine).sum())


def block_times(path: Toolpath, machine: Machine) -> Floats:
    """Return the seconds (n,) of each block; the first, whose start is unknown, takes none."""
    times = np.zeros(len(path))
    length = path.lengths()
    rows = np.flatnonzero(length > 0.0)
    if len(rows) == 0:
        return times
    length = length[rows]
    first, last = _directions(path, rows)
    axes = [machine.axis(name) for name in "XYZ"]
    rate = np.array([a.rapid / SECONDS_PER_MINUTE for a in axes])
    push = np.array([a.acceleration for a in axes])
    share = np.maximum(np.abs(first), np.abs(last))
    is_arc = path.motion[rows] >= Motion.ARC_CW
    share[is_arc, :2] = 1.0
    with np.errstate(divide="ignore"):
        acceleration = (push / share).min(axis=1)
        limit = (rate / share).min(axis=1)
    is_rapid = path.motion[rows] == Motion.RAPID
    speed = np.where(is_rapid, limit, np.minimum(np.minimum(path.feed[rows], machine.feed_max) / SECONDS_PER_MINUTE, limit))
    speed[is_arc] = np.minimum(speed[is_arc], np.sqrt(acceleration[is_arc] * _radii(path, rows[is_arc])))
    joint = _joint_speeds(first, last, speed, acceleration, is_rapid)
    times[rows] = _trapezoids(length, speed, acceleration, _looked_ahead(length, joint, acceleration))
    return times


def _directions(path: Toolpath, rows: np.ndarray) -> tuple[Floats, Floats]:
    """Return the unit directions (m, 3) at the beginning and at the end of blocks."""
    start, sweep = path.starts(), path.sweeps()
    way = path.position[rows] - start[rows]
    first, last = way.copy(), way.copy()
    arcs = np.flatnonzero(path.motion[rows] >= Motion.ARC_CW)
    at = rows[arcs]
    for out, point in ((first, start[at]), (last, path.position[at])):
        ray = point[:, :2] - path.centre[at, :2]
        turn = sweep[at][:, None]
        out[arcs, :2] = np.stack([-ray[:, 1], ray[:, 0]], axis=1) * turn
    return _units(first), _units(last)


def _units(vectors: Floats) -> Floats:
    scaled: Floats = vectors / np.maximum(np.linalg.norm(vectors, axis=1, keepdims=True), np.finfo(float).tiny)
    return scaled


def _radii(path: Toolpath, rows: np.ndarray) -> Floats:
    radius: Floats = np.linalg.norm(path.position[rows, :2] - path.centre[rows, :2], axis=1)
    return radius


def _joint_speeds(first: Floats, last: Floats, speed: Floats, acceleration: Floats, is_rapid: Bools) -> Floats:
    """Return the greatest speed (m + 1,) at each block's beginning, and 0 at the end of the path; rapids begin and end at rest."""
    turn = np.clip((last[:-1] * first[1:]).sum(axis=1), -1.0, 1.0)
    half = np.sqrt(0.5 * (1.0 + turn))
    with np.errstate(divide="ignore"):
        rounded = np.sqrt(np.minimum(acceleration[:-1], acceleration[1:]) * ROUNDING * half / (1.0 - half))
    inner = np.minimum(np.minimum(speed[:-1], speed[1:]), rounded)
    inner[is_rapid[:-1] != is_rapid[1:]] = 0.0
    return np.concatenate([[0.0], inner, [0.0]])


def _looked_ahead(length: Floats, joint: Floats, acceleration: Floats) -> Floats:
    """Return the joint speeds that the machine can also reach and brake from."""
    reached = joint.tolist()
    gain = (2.0 * acceleration * length).tolist()
    for k in range(len(length) - 1, -1, -1):
        reached[k] = min(reached[k], math.sqrt(reached[k + 1] ** 2 + gain[k]))
    for k in range(len(length)):
        reached[k + 1] = min(reached[k + 1], math.sqrt(reached[k] ** 2 + gain[k]))
    return np.array(reached)


def _trapezoids(length: Floats, speed: Floats, acceleration: Floats, joint: Floats) -> Floats:
    begin, end = joint[:-1], joint[1:]
    peak = np.minimum(speed, np.sqrt(acceleration * length + 0.5 * (begin**2 + end**2)))
    ramps = (2.0 * peak**2 - begin**2 - end**2) / (2.0 * acceleration)
    cruise = np.maximum(length - ramps, 0.0) / peak
    times: Floats = (2.0 * peak - begin - end) / acceleration + cruise
    return times
