"""How long a machine takes for a toolpath: acceleration, axis limits, and how fast it may go through the joints between blocks.

Along a block the speed follows a trapezoid. Through a joint that turns by an angle a, a machine with acceleration A that rounds the joint
by at most d may go at sqrt(A d s / (1 - s)), s = cos(a / 2) (the circle that touches both blocks and passes d from the joint).
On an arc the centripetal acceleration bounds the speed.

With rotary axes the blocks are paths of all axes together, and each axis has its own acceleration and rate: a tip that rests while the axis
turns takes the time that the slowest axis needs.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from trunnion.geometry.arrays import Bools, Floats
from trunnion.model.material import Machine
from trunnion.model.motion.toolpath import Motion, Toolpath
from trunnion.shop.kinematics import WorkPosition, spindle_of, words_of
from trunnion.shop.rotary_angles import followed
from trunnion.units import SECONDS_PER_MINUTE

ROUNDING = 0.01
"""mm: how far the machine may round a joint while it keeps moving, about what a control does in contouring mode."""
ROUNDING_TURNS = 0.05
"""mm of a rotary axis: what stays within ROUNDING at the tip, on an arm of 100 mm."""
NEAR_POLE = 1e-4
"""rad: a tool axis that close to the pole of the rotary axes may go through it."""


def machining_time(
    path: Toolpath, machine: Machine, work_position: WorkPosition | None = None, gauge: float = 0.0
) -> float:
    """Return the seconds that a machine takes for a path, rapids included, from where its first block ends."""
    return float(block_times(path, machine, work_position, gauge).sum())


def block_times(
    path: Toolpath, machine: Machine, work_position: WorkPosition | None = None, gauge: float = 0.0
) -> Floats:
    """Return the seconds (n,) of each block with its dwell; of the first, whose start is unknown, no more than that.

    On a machine with rotary axes `work_position` says where the work stands and `gauge` mm is the length of the tool from its tip to the
    spindle's face; raises `Refused` for what the machine can't hold or follow.
    """
    return _timed(path, machine, work_position, gauge)[0]


def reached_feeds(path: Toolpath, machine: Machine) -> Floats:
    """Return the feeds (n,) in mm/min that a machine's linear axes come up to in each block of a path of an upright tool: on short blocks
    less than is programmed. Rapids keep theirs."""
    peak = _timed(path, machine, None, 0.0)[1] * SECONDS_PER_MINUTE
    return np.where(path.motion == Motion.RAPID, path.feed, np.minimum(path.feed, peak))


def _timed(
    path: Toolpath, machine: Machine, work_position: WorkPosition | None, gauge: float
) -> tuple[Floats, Floats]:
    """Return the seconds (n,) of each block and the highest speed (n,) in it, in mm/s of all axes' common way."""
    times, peaks = np.array(path.dwells()), np.zeros(len(path))
    travel = _axis_travel(
        path,
        work_position if work_position is not None and work_position.machine.rotary else None,
        gauge,
    )
    rows = np.flatnonzero(travel.length > 0.0)
    if len(rows) == 0:
        return times, peaks
    length, first, last = travel.length[rows], travel.first[rows], travel.last[rows]
    axes = [*(machine.axis(name) for name in "XYZ"), *machine.rotary][: first.shape[1]]
    weight = np.array([1.0, 1.0, 1.0, *_weights(machine)])[: first.shape[1]]
    rate = np.array([a.rapid / SECONDS_PER_MINUTE for a in axes]) * weight
    push = np.array([a.acceleration for a in axes]) * weight
    share = np.maximum(np.abs(first), np.abs(last))
    is_arc = path.motion[rows] >= Motion.ARC_CW
    share[is_arc, :3] = np.maximum(share[is_arc, :3], travel.across[rows[is_arc]])
    with np.errstate(divide="ignore"):
        acceleration = (push / share).min(axis=1)
        limit = (rate / share).min(axis=1)
    is_rapid = path.motion[rows] == Motion.RAPID
    feed = np.minimum(path.feed[rows], machine.feed_max) / SECONDS_PER_MINUTE
    # In a block that turns the tip has its feed, however far the machine's axes go for it.
    stretch = np.divide(
        length, travel.tip[rows], out=np.full(len(rows), np.inf), where=travel.tip[rows] > 0.0
    )
    speed = np.where(is_rapid, limit, np.minimum(feed * np.where(is_rapid, 1.0, stretch), limit))
    speed[is_arc] = np.minimum(
        speed[is_arc], np.sqrt(acceleration[is_arc] * travel.radius[rows[is_arc]])
    )
    rounding = np.where(
        np.abs(first[:, 3:]).max(axis=1, initial=0.0) > 0.0, ROUNDING_TURNS, ROUNDING
    )
    joint = _joint_speeds(first, last, speed, acceleration, is_rapid, rounding)
    seconds, peaks[rows] = _trapezoids(
        length, speed, acceleration, _looked_ahead(length, joint, acceleration)
    )
    times[rows] += seconds
    return times, peaks


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _AxisTravel:
    """How a machine's axes go along blocks: length (n,) of their common way, of the tip's alone (n,), and the unit directions (n, 3 + a) in
    which they begin and end it. of arcs also across (n, 3), how much of it each linear axis takes, and radius (n,).

    Ways are in mm; of a rotary axis in the mm in which a linear one gains as much speed."""

    length: Floats
    tip: Floats
    first: Floats
    last: Floats
    across: Floats
    radius: Floats


def _axis_travel(path: Toolpath, work_position: WorkPosition | None, gauge: float) -> _AxisTravel:
    """Return the travel along a path: on a machine with rotary axes that of the positions of all its axes."""
    tip, sweep = path.lengths(), path.sweeps()
    arcs = np.flatnonzero(path.motion >= Motion.ARC_CW)
    position, axis, centre = path.position, path.axis[arcs], path.centre[arcs]
    turn = np.zeros((len(path), 0))
    if work_position is not None:
        angle = followed(path.axis, work_position, None, NEAR_POLE, "of the path")
        turn = np.diff(np.degrees(angle), axis=0, prepend=np.degrees(angle[:1])) * _weights(
            work_position.machine
        )
        position, axis = (
            words_of(work_position, position, angle, gauge),
            spindle_of(work_position, angle[arcs]),
        )
        centre = words_of(
            work_position,
            np.where(np.isnan(centre), path.position[arcs], centre),
            angle[arcs],
            gauge,
        )
    start = np.vstack([position[:1], position[:-1]])
    travel = np.column_stack([position - start, turn])
    first, last = travel.copy(), travel.copy()
    for out, point in ((first, start[arcs]), (last, position[arcs])):
        out[arcs, :3] = np.cross(axis, point - centre) * sweep[arcs, None]
    turns = np.abs(turn).max(axis=1, initial=0.0) > 0.0
    across, radius = np.zeros((len(path), 3)), np.zeros(len(path))
    across[arcs] = np.sqrt(np.maximum(1.0 - axis * axis, 0.0))
    radius[arcs] = np.linalg.norm(np.cross(axis, position[arcs] - centre), axis=1)
    return _AxisTravel(
        length=np.where(turns, np.linalg.norm(travel, axis=1), tip),
        tip=tip,
        first=_units(first),
        last=_units(last),
        across=across,
        radius=radius,
    )


def _weights(machine: Machine) -> list[float]:
    """Return for each rotary axis the mm in which the slowest linear axis gains as much speed as it does in a degree."""
    slowest = min(machine.axis(name).acceleration for name in "XYZ")
    return [slowest / a.acceleration for a in machine.rotary]


def _units(vectors: Floats) -> Floats:
    scaled: Floats = vectors / np.maximum(
        np.linalg.norm(vectors, axis=1, keepdims=True), np.finfo(float).tiny
    )
    return scaled


def _joint_speeds(
    first: Floats,
    last: Floats,
    speed: Floats,
    acceleration: Floats,
    is_rapid: Bools,
    rounding: Floats,
) -> Floats:
    """Return the greatest speed (m + 1,) at each block's beginning, and 0 at the end of the path; rapids begin and end at rest."""
    turn = np.clip((last[:-1] * first[1:]).sum(axis=1), -1.0, 1.0)
    half = np.sqrt(0.5 * (1.0 + turn))
    with np.errstate(divide="ignore"):
        rounded = np.sqrt(
            np.minimum(acceleration[:-1], acceleration[1:])
            * np.maximum(rounding[:-1], rounding[1:])
            * half
            / (1.0 - half)
        )
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


def _trapezoids(
    length: Floats, speed: Floats, acceleration: Floats, joint: Floats
) -> tuple[Floats, Floats]:
    """Return the seconds (n,) of blocks and the highest speed (n,) in each."""
    begin, end = joint[:-1], joint[1:]
    peak = np.minimum(speed, np.sqrt(acceleration * length + 0.5 * (begin**2 + end**2)))
    ramps = (2.0 * peak**2 - begin**2 - end**2) / (2.0 * acceleration)
    cruise = np.maximum(length - ramps, 0.0) / peak
    return (2.0 * peak - begin - end) / acceleration + cruise, peak
