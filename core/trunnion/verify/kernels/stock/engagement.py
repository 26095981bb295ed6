"""Compiled measurement of cutter engagement: how much of the cutter's front is in material, before a
move cuts.

At some positions along a move (probes) points on circles around the cutter at some heights (rings)
are looked up in the stock as it stands. The fraction of a circle's directions that are in material
is the engagement angle. Only the front half of a circle counts, where the velocity points out of
the cutter; of a move straight along the axis the whole circle. This is a sample of directions: an
estimate for load and chip width, not a bound of the proof.

The lookups see columns, not points: a column within half a cell's diagonal (the margin) may stand
for its neighbour. So the front is narrowed by the margin on both sides, where a wall beside it is
not cut; and right behind the end of the move before it is moved ahead by as much, to where that has
cut nothing.

mm, rad, the frame of the stock. Columns of a move as in `kernels/contact/strips.py`.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from trunnion.geometry.arrays import Floats, Ints
from trunnion.verify.kernels.stock.intervals import COUNT, FIRST, Rays

KIND, X0, Y0, X1, Y1, CX, CY, ARC_RADIUS, MX, MY, COS_HALF, START_ANGLE, SWEEP, Z_START, Z_END = (
    range(15)
)
RINGS = 4
"""Rings of a tool below its widest circle and on it, each at a quarter of the height of the one before."""
ABOVE = 1e-6
"""mm; a column higher than a floor by less is the floor."""
STEEP = 1.0
"""A move that goes down by more than this for each mm in plan cuts with its whole circle, as a plunge does."""
CLEAR = 6.0
"""Margins from the start of a move at which the front is clear of what the move before has cut."""
STILL = 1e-9
LOW, HIGH = range(2)
FLUTE_STEPS = 64
"""Most heights along the flutes at which material beside a leaning cutter is looked for."""
MERIDIANS = 8


@njit(cache=True, nogil=True, inline="always")
def _upright_pose(move: Floats, t: float) -> tuple[float, float, float, float, float]:
    """Return tip (x, y, z) and unit plan direction of an upright move at its share t; direction 0 when
    it stands in plan."""
    z = move[Z_START] + t * (move[Z_END] - move[Z_START])
    if move[KIND] != 0.0:
        angle, side = move[START_ANGLE] + t * move[SWEEP], 1.0 if move[SWEEP] > 0.0 else -1.0
        c, s = math.cos(angle), math.sin(angle)
        return (
            move[CX] + move[ARC_RADIUS] * c,
            move[CY] + move[ARC_RADIUS] * s,
            z,
            -side * s,
            side * c,
        )
    dx, dy = move[X1] - move[X0], move[Y1] - move[Y0]
    length = math.sqrt(dx * dx + dy * dy)
    if length <= STILL:
        return move[X0], move[Y0], z, 0.0, 0.0
    return move[X0] + t * dx, move[Y0] + t * dy, z, dx / length, dy / length


@njit(cache=True, nogil=True, inline="always")
def _plan_length(move: Floats) -> float:
    """Return the length (mm) of a move in plan."""
    if move[KIND] != 0.0:
        return abs(move[SWEEP]) * move[ARC_RADIUS]
    return math.sqrt((move[X1] - move[X0]) ** 2 + (move[Y1] - move[Y0]) ** 2)


@njit(cache=True, nogil=True)
def engagement_in_zmap(
    top: Floats,
    origin: Floats,
    pitch: float,
    floor: float,
    move: Floats,
    rings: Floats,
    circle: Floats,
    first: int,
    last: int,
    counted: Ints,
    spans: Floats,
) -> None:
    """Count the engaged directions around the probes `first` to `last` of an upright feed move in a
    field of heights, before it cuts.

    top (rows, columns) heights, origin (2,), floor. rings (RINGS, 2): radius and height, the widest
    first; circle (m, 2): cosine and sine over the front half. To counted (p, RINGS) is added how
    many directions are in material; spans (p, 2) are widened to the lowest and highest material,
    from the tip. Adding and widening make the result independent of how the field is divided into
    tiles.
    """
    margin = 0.70711 * pitch
    rows, columns, cell = top.shape[0], top.shape[1], 1.0 / pitch
    drop, length = move[Z_START] - move[Z_END], _plan_length(move)
    whole = drop > STEEP * length
    if length <= STILL and not whole:
        return
    sides = 2 if whole else 1
    for probe in range(first, last):
        # Probes stand at even shares, the last at the move's end.
        share = (probe - first + 1) / (last - first)
        x, y, z, ux, uy = _upright_pose(move, share)
        # Moved ahead by up to a margin, fading out `CLEAR` margins from the start.
        ahead = min(max(CLEAR * margin - share * length, 0.0), margin)
        if whole and length <= STILL:
            ux = 1.0
        ox, oy = (x - origin[0]) * cell, (y - origin[1]) * cell
        most = -np.inf
        for k in range(RINGS):
            radius, height = rings[k, 0], rings[k, 1]
            # Rings below the one that counts are not needed: it is at most half as high as the material is deep.
            if k > 0 and (height >= rings[k - 1, 1] or most - z >= 2.0 * rings[k - 1, 1]):
                break
            reach = max(radius - margin, 0.0)
            floor_here, limit, hits = floor + ABOVE, z + height + ABOVE, 0
            for side in range(sides):
                # The ring's points: ahead along the direction of motion, narrowed across it; of a
                # plunge both halves of the circle, made smaller by the margin.
                for m in range(len(circle)):
                    along, across = (
                        radius * circle[m, 0] + ahead,
                        min(max(radius * circle[m, 1], -reach), reach),
                    )
                    if whole:
                        along = (1.0 - 2.0 * side) * reach * circle[m, 0]
                    i, j = (
                        int(math.floor(ox + (along * ux - across * uy) * cell)),
                        int(math.floor(oy + (along * uy + across * ux) * cell)),
                    )
                    if 0 <= i < columns and 0 <= j < rows:
                        h = top[j, i]
                        if h > floor_here:
                            most = max(most, h)
                            if h > limit:
                                hits += 1
            counted[probe, k] += hits
        if most > z + ABOVE:
            spans[probe, LOW] = min(spans[probe, LOW], max(floor - z, 0.0))
            spans[probe, HIGH] = max(spans[probe, HIGH], most - z)


@njit(cache=True, nogil=True, inline="always")
def _inside_intervals(
    x: float,
    y: float,
    z: float,
    table: Ints,
    ends: Floats,
    origin: Floats,
    cell: float,
    rows: int,
    columns: int,
) -> bool:
    """Return whether a point lies in the sorted intervals of the z ray whose cell holds it."""
    i, j = int(math.floor((x - origin[0]) * cell)), int(math.floor((y - origin[1]) * cell))
    if not (0 <= i < columns and 0 <= j < rows):
        return False
    ray = j * columns + i
    at = table[ray, FIRST]
    for m in range(at, at + table[ray, COUNT]):
        if z < ends[m, 0]:
            return False
        if z < ends[m, 1]:
            return True
    return False


@njit(cache=True, nogil=True)
def _pose_and_velocity(
    start: Floats,
    end: Floats,
    start_axis: Floats,
    end_axis: Floats,
    centre: Floats,
    sweep: float,
    t: float,
    tip: Floats,
    axis: Floats,
    speed: Floats,
    turning: Floats,
) -> None:
    """Fill tip (3,) and axis (3,) of a move at its share t, and their derivatives by t: speed (3,) mm
    and turning (3,)."""
    dot, square = 0.0, 0.0
    for c in range(3):
        dot += start_axis[c] * end_axis[c]
        square += (end_axis[c] - start_axis[c]) ** 2
    angle = math.acos(min(max(dot, -1.0), 1.0)) if square > STILL * STILL else 0.0
    # Spherical linear interpolation (Shoemake, Animating rotation with quaternion curves, 1985).
    if angle > STILL:
        s = math.sin(angle)
        a, b = math.sin((1.0 - t) * angle) / s, math.sin(t * angle) / s
        da, db = -math.cos((1.0 - t) * angle) * angle / s, math.cos(t * angle) * angle / s
        for c in range(3):
            axis[c] = a * start_axis[c] + b * end_axis[c]
            turning[c] = da * start_axis[c] + db * end_axis[c]
    else:
        axis[:], turning[:] = end_axis, 0.0
    if sweep == 0.0:
        for c in range(3):
            speed[c] = end[c] - start[c]
            tip[c] = start[c] + t * speed[c]
        return
    # About the axis through the centre: Rodrigues' turn of the arm, and what climbs along the axis.
    along, climb = 0.0, 0.0
    for c in range(3):
        along += (start[c] - centre[c]) * axis[c]
        climb += (end[c] - start[c]) * axis[c]
    cosine, sine = math.cos(t * sweep), math.sin(t * sweep)
    for c in range(3):
        e, f = (c + 1) % 3, (c + 2) % 3
        arm = start[c] - centre[c] - along * axis[c]
        side = axis[e] * (start[f] - centre[f]) - axis[f] * (start[e] - centre[e])
        tip[c] = centre[c] + cosine * arm + sine * side + (along + t * climb) * axis[c]
        speed[c] = sweep * (cosine * side - sine * arm) + climb * axis[c]


@njit(cache=True, nogil=True)
def engagement_in_dexels(
    rays: Rays,
    origin: Floats,
    pitch: float,
    rows: int,
    columns: int,
    start: Floats,
    end: Floats,
    start_axis: Floats,
    end_axis: Floats,
    centre: Floats,
    sweep: float,
    rings: Floats,
    flute: Floats,
    circle: Floats,
    first: int,
    last: int,
    counted: Ints,
    spans: Floats,
) -> None:
    """Count the engaged directions around the probes of a feed move with any axis in columns of
    intervals along z, before it cuts.

    rays: sorted intervals of rows x columns rays from origin (2,);
    start, end, axes, centre (3,) and sweep of one row of `Moves`; rings, circle, counted and spans
    as in `engagement_in_zmap`. flute (s, 2): radius and height of the cutter, upwards from the tip, at
    which material beside it is looked for.
    """
    table, ends = rays.ray, rays.ends
    margin, cell = 0.70711 * pitch, 1.0 / pitch
    v_low, v_high = origin[1], origin[1] + rows * pitch
    tip, axis, speed, turning, forward, across = (
        np.empty(3),
        np.empty(3),
        np.empty(3),
        np.empty(3),
        np.empty(3),
        np.empty(3),
    )
    for probe in range(first, last):
        share = (probe - first + 1) / (last - first)
        _pose_and_velocity(
            start, end, start_axis, end_axis, centre, sweep, share, tip, axis, speed, turning
        )
        bottom, most = np.inf, -np.inf
        for k in range(-len(flute), RINGS):
            # First the heights along the flutes on a few meridians, for the depth; then the rings, for the angle.
            radius, height = (
                (flute[k + len(flute), 0], flute[k + len(flute), 1])
                if k < 0
                else (rings[k, 0], rings[k, 1])
            )
            if k > 0 and (height >= rings[k - 1, 1] or most - bottom >= 2.0 * rings[k - 1, 1]):
                break
            # A circle leaves its middle by no more than its radius, ahead by a margin more.
            middle = tip[1] + height * axis[1]
            if middle + radius + margin < v_low or middle - radius - margin > v_high:
                continue
            # Velocity of the axis at the ring's height: the part along the axis plunges, the part
            # across it is the direction of the front.
            rate, square = 0.0, 0.0
            for c in range(3):
                rate += (speed[c] + height * turning[c]) * axis[c]
            for c in range(3):
                forward[c] = speed[c] + height * turning[c] - rate * axis[c]
                square += forward[c] ** 2
            size = math.sqrt(square)
            whole = -rate > STEEP * size
            # Standing in place: only a plunge engages, and then any direction across the axis
            # serves.
            if size <= STILL:
                if not whole:
                    continue
                thin = 0 if abs(axis[0]) < 0.7 else 1
                for c in range(3):
                    forward[c] = (1.0 if c == thin else 0.0) - axis[thin] * axis[c]
                size = math.sqrt(1.0 - axis[thin] ** 2)
            for c in range(3):
                forward[c] /= size
            for c in range(3):
                across[c] = (
                    axis[(c + 1) % 3] * forward[(c + 2) % 3]
                    - axis[(c + 2) % 3] * forward[(c + 1) % 3]
                )
            reach, hits = max(radius - margin, 0.0), 0
            ahead = min(max(CLEAR * margin - share * size, 0.0), margin)
            step = 1 if k >= 0 else max(len(circle) // MERIDIANS, 1)
            for side in range(2 if whole else 1):
                for m in range(0, len(circle), step):
                    f = (
                        (1.0 - 2.0 * side) * reach * circle[m, 0]
                        if whole
                        else radius * circle[m, 0] + ahead
                    )
                    g = min(max(radius * circle[m, 1], -reach), reach)
                    x = tip[0] + f * forward[0] + g * across[0] + height * axis[0]
                    y = tip[1] + f * forward[1] + g * across[1] + height * axis[1]
                    z = tip[2] + f * forward[2] + g * across[2] + height * axis[2] + ABOVE
                    if _inside_intervals(x, y, z, table, ends, origin, cell, rows, columns):
                        hits += 1
            if k >= 0:
                counted[probe, k] += hits
            # The depth of the material along the flutes, to a step of their heights.
            elif hits > 0:
                gap = flute[1, 1] - flute[0, 1] if len(flute) > 1 else 0.0
                bottom, most = min(bottom, height - 0.5 * gap), max(most, height + 0.5 * gap)
        if most > bottom:
            spans[probe, LOW] = min(spans[probe, LOW], bottom)
            spans[probe, HIGH] = max(spans[probe, HIGH], most)
