"""Axis positions of a machine for each pose of the tool: rotary angles by the nearer turn, linear positions with the pivots in them.

A pose requires that the tool's direction on the machine and the axis in the work agree: Rot(p, alpha) Rot(q, beta) v = w for two rotary
axes, solved in closed form, with both solutions (Paden and Kahan's second subproblem; Murray, Li, Sastry, A Mathematical Introduction to
Robotic Manipulation, 1994, section 3.2).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from trunnion.geometry.arrays import Bools, Floats, Ints, items_of
from trunnion.model.material import Axis, Machine, leaning_axis
from trunnion.model.motion.program import NO_STANCES, Stance
from trunnion.verify.kernels.rotary import choose_angles_greedy
from trunnion.verify.motion import Moves

STEP = math.radians(2.0)
"""Largest turn of the tool axis, or of an arc, between two poses that are looked at."""
UNTURNED = 1e-9
"""Two directions closer than this (their difference's length) are one."""
SLACK = 1e-6
"""rad: how far an angle may be beyond a limit before it counts as outside."""
ROUNDED = 1e-4
"""rad: how far a written angle may be from the one that holds the axis: angles and vectors are rounded."""
UP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class AxisPositions:
    """Axis positions along the moves of a setup, at poses k close enough to follow every turn.

    move (k,): the move that each pose belongs to; a move's first pose is its start. linear (k, 3) mm: the positions of X, Y, Z up to where
    zero is. rotary (k, a) rad, in the order of `Machine.rotary`. reached (n,): whether the machine can hold the axis of each move.
    turns (n,): whether the axis turns on the way.
    """

    move: Ints
    linear: Floats
    rotary: Floats
    reached: Bools
    turns: Bools


def axis_positions(moves: Moves, machine: Machine, foot: Floats) -> AxisPositions:
    """Return how a machine stands along moves; `foot` (3,) is the position of the work, in the setup frame, on the middle of the table."""
    move, tip, axis = poses_of(moves)
    rotary, good = rotary_angles(axis, machine, _stances_by_pose(moves, move))
    reached = np.ones(len(moves), bool)
    reached[move[~good]] = False
    gauge = (
        np.array([t.gauge_length for t in moves.tools])[moves.tool[move]]
        if len(move)
        else np.zeros(0)
    )
    return AxisPositions(
        move=move,
        linear=linear_positions(tip - foot, gauge, rotary, machine),
        rotary=rotary,
        reached=reached,
        turns=moves.turning(),
    )


def poses_of(moves: Moves) -> tuple[Ints, Floats, Floats]:
    """Return poses along moves, start and end of each among them: move (k,), tip (k, 3), axis (k, 3).

    Of moves by which the machine's axes go straight to where a text says, start and end are all.
    """
    between = angle_between(moves.start_axis, moves.end_axis)
    steps = np.maximum(
        1, np.ceil(np.maximum(between, np.abs(moves.sweep)) / STEP - UNTURNED)
    ).astype(np.int64)
    steps[list(moves.stances)] = 1
    move, number = items_of(steps + 1)
    share = number / steps[move]
    tip = moves.start[move] + share[:, None] * (moves.end - moves.start)[move]
    arc = moves.sweep[move] != 0.0
    if arc.any():
        tip[arc] = on_arcs(moves, move[arc], share[arc])
    return (
        move,
        tip,
        turned_axes(moves.start_axis[move], moves.end_axis[move], between[move], share),
    )


def angle_between(a: Floats, b: Floats) -> Floats:
    """Return the angle (k,) between unit directions (k, 3)."""
    return np.asarray(
        2.0 * np.arctan2(np.linalg.norm(a - b, axis=1), np.linalg.norm(a + b, axis=1))
    )


def turned_axes(start: Floats, end: Floats, between: Floats, share: Floats) -> Floats:
    """Return the directions (k, 3) at a share (k,) of the even turn from start to end, which are `between` (k,) rad apart."""
    still = between < UNTURNED
    sine = np.where(still, 1.0, np.sin(between))
    a, b = np.sin((1.0 - share) * between) / sine, np.sin(share * between) / sine
    return np.where(still[:, None], start, a[:, None] * start + b[:, None] * end)


def _stances_by_pose(moves: Moves, move: Ints) -> Mapping[int, Stance]:
    """Return what is said of the rotary axes by pose: at the end of a move, and at its start where the tool keeps its direction."""
    rows = np.array(list(moves.stances), np.int64)
    last = (np.searchsorted(move, rows, side="right") - 1).tolist()
    begun = dict(zip(last, moves.stances.values(), strict=True))
    kept = np.abs(moves.end_axis - moves.start_axis)[rows].max(axis=1, initial=0.0) < UNTURNED
    first = np.searchsorted(move, rows[kept]).tolist()
    return begun | {
        pose: moves.stances[row] for pose, row in zip(first, rows[kept].tolist(), strict=True)
    }


def rotary_angles(
    axis: Floats, machine: Machine, stances: Mapping[int, Stance] = NO_STANCES
) -> tuple[Floats, Bools]:
    """Return the rotary angles (k, a) in rad at which a machine holds tool axes (k, 3), each near the one before, and which it can hold.

    Of both ways to begin, the one that passes the limits at fewer poses is taken, then the one that turns less. At poses of `stances` the
    axes stand as the text says, if they hold the tool axis so: a control chooses only where its text leaves it open.
    """
    rotary = machine.rotary
    if not rotary:
        return np.zeros((len(axis), 0)), np.asarray(np.linalg.norm(axis - UP, axis=1) < UNTURNED)
    if (axis == UP).all():
        return np.zeros((len(axis), len(rotary))), np.ones(len(axis), bool)
    angles, free, good = _both_solutions(axis, rotary)
    low, high = (np.radians([getattr(a, end) for a in rotary]) for end in ("low", "high"))
    for pose, stance in stances.items():
        solution = _solution_of(angles[pose], free[pose], stance, leaning_axis(machine))
        if solution is not None:
            angles[pose], free[pose] = solution, free[pose] & (not stance.angles)
    tried = []
    for first in (0, 1):
        angles_used = np.zeros((len(axis), len(rotary)))
        turned, outside = choose_angles_greedy(angles, free, low, high, first, SLACK, angles_used)
        tried.append((outside, turned, first, angles_used))
    return min(tried, key=lambda t: t[:3])[3], good


def _solution_of(both: Floats, free: Bools, stance: Stance, leaning: int) -> Floats | None:
    """Return the angles (a,) of the one of both ways (2, a) to hold an axis that a text means, None where it means neither or either."""
    if stance.angles:
        given = np.array(stance.angles)
        off = np.abs(np.remainder(both - given + math.pi, 2.0 * math.pi) - math.pi)
        return given if (free | (off < ROUNDED)).all(axis=1).any() else None
    rows = np.flatnonzero(np.sign(both[:, leaning]) == stance.side)
    return both[rows[0]] if len(rows) == 1 else None


def can_hold(axis: Floats, machine: Machine) -> Bools:
    """Return which tool axes (k, 3) a machine can hold within the limits of its rotary axes, each by itself."""
    rotary = machine.rotary
    if not rotary:
        return np.asarray(np.linalg.norm(axis - UP, axis=1) < UNTURNED)
    angles, free, good = _both_solutions(axis, rotary)
    low, high = (np.radians([getattr(a, end) for a in rotary]) for end in ("low", "high"))
    # The least of an angle's full turns that is not below the limit.
    least = low + np.mod(angles - low + SLACK, 2.0 * np.pi) - SLACK
    within = np.asarray(free | (least <= high + SLACK))
    return np.asarray(good & (within[:, 0].all(axis=1) | within[:, 1].all(axis=1)))


def linear_positions(tip: Floats, gauge: Floats, rotary: Floats, machine: Machine) -> Floats:
    """Return the positions (k, 3) of X, Y, Z that put the tips (k, 3), from the middle of the table, where they belong.

    gauge (k,) mm from the tip to the spindle's face.
    """
    axes = machine.rotary
    work, tool = tip, np.outer(-gauge, UP)
    for k in reversed(range(len(axes))):
        point = np.array(axes[k].point)
        if axes[k].carries == "work":
            work = point + turned(work - point, axes[k], rotary[:, k])
        else:
            tool = point + turned(tool - point, axes[k], rotary[:, k])
    return work - tool


def turned(vectors: Floats, axis: Axis, angle: Floats) -> Floats:
    """Return vectors (k, 3) turned about an axis's direction by angles (k,)."""
    u = np.array(axis.direction)
    cosine, sine = np.cos(angle)[:, None], np.sin(angle)[:, None]
    return np.asarray(
        vectors * cosine + np.cross(u, vectors) * sine + np.outer(vectors @ u, u) * (1.0 - cosine)
    )


def on_arcs(moves: Moves, move: Ints, share: Floats) -> Floats:
    """Return the tips at shares (k,) of arcs, which turn about the tool axis and may climb along it."""
    axis, centre = moves.start_axis[move], moves.centre[move]
    start, end = moves.start[move], moves.end[move]
    out = start - centre
    height = (out * axis).sum(axis=1, keepdims=True) * axis
    climb = ((end - start) * axis).sum(axis=1, keepdims=True) * axis
    out = out - height
    angle = (share * moves.sweep[move])[:, None]
    return np.asarray(
        centre
        + height
        + share[:, None] * climb
        + np.cos(angle) * out
        + np.sin(angle) * np.cross(axis, out)
    )


def _both_solutions(axis: Floats, rotary: tuple[Axis, ...]) -> tuple[Floats, Bools, Bools]:
    """Return both ways (k, 2, a) of rotary angles, which of them are free (k, 2, a), and which poses can be held (k,)."""
    up = np.broadcast_to(UP, axis.shape)
    first = rotary[0]
    if len(rotary) == 1:
        v, w = (axis, up) if first.carries == "work" else (up, axis)
        u = np.array(first.direction)
        angle, free = _about(u, v, w)
        good = np.linalg.norm(turned(v, first, angle) - w, axis=1) < math.sqrt(UNTURNED)
        return (
            np.repeat(angle[:, None, None], 2, axis=1),
            np.repeat(free[:, None, None], 2, axis=1),
            good,
        )
    one, two = rotary
    if one.carries != two.carries:
        work, tool = (one, two) if one.carries == "work" else (two, one)
        angles, free, good = _second_subproblem(
            np.array(work.direction), np.array(tool.direction), up, axis
        )
        angles[:, :, 0] *= -1.0
        return (angles, free, good) if work is one else (angles[:, :, ::-1], free[:, :, ::-1], good)
    v, w = (axis, up) if one.carries == "work" else (up, axis)
    return _second_subproblem(np.array(one.direction), np.array(two.direction), v, w)


def _second_subproblem(p: Floats, q: Floats, v: Floats, w: Floats) -> tuple[Floats, Bools, Bools]:
    """Solve Rot(p, alpha) Rot(q, beta) v = w for unit v, w (k, 3): both ways (k, 2, 2), which angles are free, whether there is one."""
    pq, across = float(p @ q), np.cross(p, q)
    vq, wp = v @ q, w @ p
    a, b = (pq * vq - wp) / (pq * pq - 1.0), (pq * wp - vq) / (pq * pq - 1.0)
    rest = (1.0 - a * a - b * b - 2.0 * a * b * pq) / float(across @ across)
    side = np.sqrt(np.maximum(rest, 0.0))
    angles, free = np.zeros((len(v), 2, 2)), np.zeros((len(v), 2, 2), bool)
    for solution, sign in enumerate((1.0, -1.0)):
        middle = np.outer(a, p) + np.outer(b, q) + np.outer(sign * side, across)
        angles[:, solution, 0], free[:, solution, 0] = _about(p, middle, w)
        angles[:, solution, 1], free[:, solution, 1] = _about(q, v, middle)
    return angles, free, rest > -math.sqrt(UNTURNED)


def _about(u: Floats, v: Floats, w: Floats) -> tuple[Floats, Bools]:
    """Return the angles (k,) about u that bring v to w (k, 3), and where any angle does because v lies along u."""
    a, b = v - np.outer(v @ u, u), w - np.outer(w @ u, u)
    angle = np.arctan2(np.cross(a, b) @ u, (a * b).sum(axis=1))
    return np.asarray(angle), np.asarray(
        np.minimum(np.linalg.norm(a, axis=1), np.linalg.norm(b, axis=1)) < math.sqrt(UNTURNED)
    )
