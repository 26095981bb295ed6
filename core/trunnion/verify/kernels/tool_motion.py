"""Compiled tool motion along one block, and its division into spans that are nearly linear in the
tool's own frame.

A block moves the tip on a line while the axis turns at an even rate in one plane (slerp), or on an
arc about a still axis, helical with CLIMB; arcs with a turning axis do not occur. A share t runs
from 0 to 1 over the block.

A span is a part of a block. Seen in the frame that the tool has in the middle of the span, a fixed
point of space follows q(t) = M(t) (p - tip(t)). It stays close to the chord between its positions
at both ends of the span: the deviation is bounded by `chord_sag`, so a span represents a continuous
motion without sampling it. Lengths mm, angles rad, all in the frame of the moves.
"""

from __future__ import annotations

import math

from numba import njit

from trunnion.geometry.arrays import Floats
from trunnion.geometry.kernels.kernel_arrays import BORROWED

# A way: how the tool goes along one move.
START, VECTOR, AXIS, PIVOT, ANGLE, CENTRE, ACROSS, ALONG = 0, 3, 6, 9, 12, 13, 16, 19
R_START, R_END, SWEEP, CLIMB, LENGTH = range(22, 27)
MOTION_COLUMNS = 27
"""START and VECTOR of the tip; AXIS at the start turns about the unit vector PIVOT, perpendicular to
it, by ANGLE >= 0. An arc (SWEEP not 0) is about CENTRE from the unit vector ACROSS towards ALONG =
AXIS x ACROSS; R_START, R_END its radius at both ends, CLIMB its rise. LENGTH bounds the tip's path
from above."""

# A span of a way: for each end the matrix (9) that turns what is relative to the tip into the frame of the middle, and the tip (3).
TIP, END_COLUMNS = 9, 12
S_AXIS, S_ANGLE, S_LENGTH, S_BULGE, S_FROM, S_TO = 0, 3, 4, 5, 6, 7
SPAN_COLUMNS = 8

MOST_TURN, MOST_SWEEP = 0.1, 0.25
"""rad: how far the axis turns, or an arc goes, in one span: their sags stay far below the size of a tool."""
NARROW = 1.0
"""mm: a body of a smaller radius gets no shorter spans."""
FLAT = 1e-12


@njit(cache=True, nogil=True)
def fill_tool_motion(
    start: Floats,
    end: Floats,
    axis: Floats,
    end_axis: Floats,
    centre: Floats,
    sweep: float,
    motion: Floats,
) -> None:
    """Fill motion (27,) from a block's tips start, end (3,), its unit axes at both, and an arc's centre
    (3,) and signed angle `sweep` (0: a line, centre unused)."""
    motion[:] = 0.0
    square = 0.0
    for k in range(3):
        motion[START + k], motion[VECTOR + k], motion[AXIS + k] = (
            start[k],
            end[k] - start[k],
            axis[k],
        )
        square += motion[VECTOR + k] * motion[VECTOR + k]
    motion[LENGTH] = math.sqrt(square)
    if sweep != 0.0:
        _fill_arc_motion(start, end, axis, centre, sweep, motion)
        return
    # Axis of the turn: axis x end_axis, whose length is the sine of the angle.
    wx, wy, wz = (
        axis[1] * end_axis[2] - axis[2] * end_axis[1],
        axis[2] * end_axis[0] - axis[0] * end_axis[2],
        axis[0] * end_axis[1] - axis[1] * end_axis[0],
    )
    sine, cosine = (
        math.sqrt(wx * wx + wy * wy + wz * wz),
        axis[0] * end_axis[0] + axis[1] * end_axis[1] + axis[2] * end_axis[2],
    )
    if sine < FLAT:
        if cosine > 0.0:
            return
        # Turned right over: no plane is given, so any will do, the same one each time.
        if abs(axis[0]) < 0.9:
            wx, wy, wz = 0.0, axis[2], -axis[1]
        else:
            wx, wy, wz = -axis[2], 0.0, axis[0]
    size = math.sqrt(wx * wx + wy * wy + wz * wz)
    motion[PIVOT], motion[PIVOT + 1], motion[PIVOT + 2], motion[ANGLE] = (
        wx / size,
        wy / size,
        wz / size,
        math.atan2(sine, cosine),
    )


@njit(**BORROWED)
def _fill_arc_motion(
    start: Floats, end: Floats, axis: Floats, centre: Floats, sweep: float, motion: Floats
) -> None:
    """Fill the columns of an arc: the centre moved along the axis to the start's level, the frame
    across the axis, both radii and the climb.

    The radius runs linearly from the start's to the end's: rounded words of the text leave them
    apart by up to `tolerance.ARC_RADIUS`, and the arc must end where the next block starts.
    """
    up = climb = 0.0
    for k in range(3):
        up += (start[k] - centre[k]) * axis[k]
        climb += (end[k] - start[k]) * axis[k]
    square = last = 0.0
    for k in range(3):
        motion[CENTRE + k] = centre[k] + up * axis[k]
        motion[ACROSS + k] = start[k] - motion[CENTRE + k]
        square += motion[ACROSS + k] ** 2
        last += (end[k] - climb * axis[k] - motion[CENTRE + k]) ** 2
    radius = math.sqrt(square)
    for k in range(3):
        motion[ACROSS + k] /= max(radius, FLAT)
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        motion[ALONG + k] = axis[i] * motion[ACROSS + j] - axis[j] * motion[ACROSS + i]
    motion[R_START], motion[R_END], motion[SWEEP], motion[CLIMB] = (
        radius,
        math.sqrt(last),
        sweep,
        climb,
    )
    # Arc length at the larger radius: never too short.
    motion[LENGTH] = math.hypot(max(radius, motion[R_END]) * abs(sweep), climb)


@njit(**BORROWED)
def tip_at(motion: Floats, t: float) -> tuple[float, float, float]:
    """Return the tip (mm) at a share t of the block."""
    if motion[SWEEP] == 0.0:
        return (
            motion[START] + t * motion[VECTOR],
            motion[START + 1] + t * motion[VECTOR + 1],
            motion[START + 2] + t * motion[VECTOR + 2],
        )
    radius = motion[R_START] + t * (motion[R_END] - motion[R_START])
    a, b, c = (
        radius * math.cos(t * motion[SWEEP]),
        radius * math.sin(t * motion[SWEEP]),
        t * motion[CLIMB],
    )
    return (
        motion[CENTRE] + a * motion[ACROSS] + b * motion[ALONG] + c * motion[AXIS],
        motion[CENTRE + 1] + a * motion[ACROSS + 1] + b * motion[ALONG + 1] + c * motion[AXIS + 1],
        motion[CENTRE + 2] + a * motion[ACROSS + 2] + b * motion[ALONG + 2] + c * motion[AXIS + 2],
    )


@njit(**BORROWED)
def axis_at(motion: Floats, t: float) -> tuple[float, float, float]:
    """Return the unit tool axis at a share t of the block."""
    ax, ay, az = motion[AXIS], motion[AXIS + 1], motion[AXIS + 2]
    if motion[ANGLE] == 0.0:
        return ax, ay, az
    wx, wy, wz = motion[PIVOT], motion[PIVOT + 1], motion[PIVOT + 2]
    # Rodrigues' rotation formula; the term along PIVOT drops out because PIVOT is perpendicular to
    # AXIS.
    c, s = math.cos(t * motion[ANGLE]), math.sin(t * motion[ANGLE])
    return (
        c * ax + s * (wy * az - wz * ay),
        c * ay + s * (wz * ax - wx * az),
        c * az + s * (wx * ay - wy * ax),
    )


@njit(**BORROWED)
def fill_swept_segment(motion: Floats, t0: float, t1: float, ends: Floats, span: Floats) -> None:
    """Fill ends (2, 12) and span (8,) for the part of a block between two shares.

    ends: for both ends the rotation matrix (9, row by row) that takes world directions into the
    frame of the span's middle, and the tip (3). span: S_AXIS the axis in the middle, S_ANGLE the
    angle turned (rad), S_LENGTH the tip's path (mm), S_BULGE how far (mm) an arc leaves the chord
    of its ends, S_FROM and S_TO the shares.
    """
    middle = 0.5 * (t0 + t1)
    span[S_AXIS], span[S_AXIS + 1], span[S_AXIS + 2] = axis_at(motion, middle)
    share = t1 - t0
    span[S_ANGLE], span[S_LENGTH], span[S_BULGE] = (
        share * motion[ANGLE],
        share * motion[LENGTH],
        0.0,
    )
    span[S_FROM], span[S_TO] = t0, t1
    if motion[SWEEP] != 0.0:
        # Sagitta r (1 - cos(turn / 2)) of the larger radius, up to 2 r for a full turn; the second term is the mixed
        # derivative of a radius that drifts while it turns, 2 drift turn / 8.
        turn = min(share * abs(motion[SWEEP]), 2.0 * math.pi)
        drift = share * abs(motion[R_END] - motion[R_START])
        span[S_BULGE] = (
            max(motion[R_START], motion[R_END]) * (1.0 - math.cos(0.5 * turn)) + 0.25 * drift * turn
        )
    for e in range(2):
        ends[e, TIP], ends[e, TIP + 1], ends[e, TIP + 2] = tip_at(motion, t0 if e == 0 else t1)
        # At the start the tool is half the angle behind its middle: points turn forward by it, at
        # the end back. Rodrigues' matrix about PIVOT; the identity where the axis keeps still.
        half = 0.5 * span[S_ANGLE] if e == 0 else -0.5 * span[S_ANGLE]
        c, s = math.cos(half), math.sin(half)
        wx, wy, wz = motion[PIVOT], motion[PIVOT + 1], motion[PIVOT + 2]
        v = 1.0 - c
        ends[e, 0], ends[e, 1], ends[e, 2] = (
            c + v * wx * wx,
            v * wx * wy - s * wz,
            v * wx * wz + s * wy,
        )
        ends[e, 3], ends[e, 4], ends[e, 5] = (
            v * wx * wy + s * wz,
            c + v * wy * wy,
            v * wy * wz - s * wx,
        )
        ends[e, 6], ends[e, 7], ends[e, 8] = (
            v * wx * wz - s * wy,
            v * wy * wz + s * wx,
            c + v * wz * wz,
        )


@njit(**BORROWED, inline="always")
def point_in_tool_frame(
    ends: Floats, e: int, px: float, py: float, pz: float
) -> tuple[float, float, float]:
    """Return a point of space (mm) relative to the tip at end e (0, 1) of a span, in the frame of the
    span's middle."""
    x, y, z = px - ends[e, TIP], py - ends[e, TIP + 1], pz - ends[e, TIP + 2]
    return (
        ends[e, 0] * x + ends[e, 1] * y + ends[e, 2] * z,
        ends[e, 3] * x + ends[e, 4] * y + ends[e, 5] * z,
        ends[e, 6] * x + ends[e, 7] * y + ends[e, 8] * z,
    )


@njit(**BORROWED)
def segment_count(motion: Floats, radius: float) -> int:
    """Return into how many equal spans a block is cut for a body of a radius (mm).

    No span is longer than the body is wide, turns by more than MOST_TURN or sweeps more than
    MOST_SWEEP. For lines these are choices of speed alone; an arc's bulge is a bound only up to
    half a circle, far above MOST_SWEEP.
    """
    most = max(
        motion[LENGTH] / (2.0 * max(radius, NARROW)),
        motion[ANGLE] / MOST_TURN,
        abs(motion[SWEEP]) / MOST_SWEEP,
    )
    return max(1, int(math.ceil(most)))


@njit(**BORROWED, inline="always")
def chord_sag(span: Floats, far: float) -> float:
    """Return how far (mm) a point that stays within `far` of the tip can leave the chord between its
    positions at both ends of a span, in the frame of the middle.

    With q(t) = M(t) v(t), v linear in t and M turning by `angle` at an even rate, the second
    derivative is |q''| <= angle^2 far + 2 angle length, and a curve leaves its chord by |q''| / 8
    at most: the sag is angle (angle far / 8 + length / 4). Arcs, whose axis keeps still, have their
    own bulge instead. The sag errs on the deep side: callers add it to a depth.
    """
    return span[S_ANGLE] * (0.125 * span[S_ANGLE] * far + 0.25 * span[S_LENGTH]) + span[S_BULGE]
