"""The drop-cutter of `kernels.cutter_contact.drop_cutter` compiled: closed forms, each edge and corner once, and only
triangles that could be higher (branch and bound over a tree).

With g the cutter's lower side, convex and never falling, the tip over (px, py) is lifted to the
greatest of z - g(rho). Bounds from above, of a facet or of a node of the tree, by three convex
arguments:

* nothing of it is above its highest z, and g at the nearest plan distance is the least lift-off;
* nothing of it is above a plane: touching that plane lifts the tip by a closed form (`plane_lift_loop`);
* g is above its tangents: over the middle of the box (`_tangent_height_bound`), of a ball also from where
  it touches the plane (`_ball_clearance`).

_SLACK (mm) keeps the rounding of a bound from leaving out what is higher: heights are exact. mm,
tool axis +z.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from trunnion.geometry.arrays import Floats, Ints
from trunnion.geometry.kernels.cutter_contact.drop_bvh import X0, X1, Y0, Y1, Z1
from trunnion.geometry.kernels.cutter_contact.drop_cutter import RHO0, RHO1, ROUND, A, B, C
from trunnion.geometry.kernels.kernel_arrays import BORROWED

(
    AX,
    AY,
    AZ,
    BX,
    BY,
    BZ,
    CX,
    CY,
    CZ,
    GX,
    GY,
    STEEP,
    TURN,
    LOW_X,
    LOW_Y,
    HIGH_X,
    HIGH_Y,
    HIGH_Z,
    OWNS,
) = range(19)
"""A triangle's row: corners; slope of its plane along x and y, how steep that is, twice its signed plan area; its box; and which edges
(bits 0 to 2, from the corner of that number on) and corners (bits 3 to 5) it looks after."""
FACET_COLUMNS = 19
LIFT_X, LIFT_Y, LIFT, OUT_X, OUT_Y, HEIGHT, SLOPE, SECANT = range(8)
"""How a triangle's plane lifts a cutter over (x, y): LIFT_X x + LIFT_Y y + LIFT (infinite: it stands upright), touching it OUT away;
HEIGHT is its own over (0, 0), SLOPE how steep it is, SECANT how much larger than its plan a piece of it is."""
LIFT_COLUMNS = 8
ALL = 63
"""The bits of all edges and corners."""
DEEPEST = 64
"""Levels of a tree at most."""
STEPS = 60
"""Most steps of a search that mostly ends after four."""
_TINY, _ROUNDING, _SLACK = 1e-300, 1e-13, 1e-10


@njit(**BORROWED, inline="always")
def _profile_height(pieces: Floats, rho: float) -> float:
    """Return g (mm), the height above the tip at which the cutter begins at the distance rho; rho
    within its radius."""
    k = 0
    while k < len(pieces) - 1 and rho > pieces[k, RHO1]:
        k += 1
    if pieces[k, ROUND] != 0.0:
        out = rho - pieces[k, A]
        return pieces[k, B] - math.sqrt(max(pieces[k, C] * pieces[k, C] - out * out, 0.0))
    return pieces[k, A] + pieces[k, B] * (rho - pieces[k, RHO0])


@njit(**BORROWED, inline="always")
def _profile_slope(pieces: Floats, rho: float) -> float:
    """Return g'(rho), towards the axis where the lower side has a bend."""
    k = 0
    while k < len(pieces) - 1 and rho > pieces[k, RHO1]:
        k += 1
    if pieces[k, ROUND] == 0.0:
        return pieces[k, B]
    out = rho - pieces[k, A]
    return out / math.sqrt(max(pieces[k, C] * pieces[k, C] - out * out, _TINY))


@njit(**BORROWED)
def _contact_radius(pieces: Floats, steep: float) -> float:
    """Return the largest distance rho (mm) from the axis at which the lower side is not steeper than a
    plane of slope `steep`: where it touches.

    On an arc g' = steep at rho = A + C steep / sqrt(1 + steep^2).
    """
    if steep == 0.0:
        return 0.0
    rho = 0.0
    for k in range(len(pieces)):
        if pieces[k, ROUND] != 0.0:
            at = pieces[k, A] + pieces[k, C] * steep / math.sqrt(1.0 + steep * steep)
            if at < pieces[k, RHO1]:
                return max(at, rho)
        elif pieces[k, B] >= steep:
            return rho
        rho = pieces[k, RHO1]
    return rho


@njit(**BORROWED)
def _edge_contact_offset(pieces: Floats, lateral: float, rise: float, reach: float) -> float:
    """Return how far (u, mm) from the foot of the axis, 0 to `reach`, an edge that climbs by `rise` >=
    0 touches, at a distance beside the axis.

    The contact is where the lower side's slope along the edge, g'(rho) u / rho with rho^2 =
    beside^2 + u^2, equals the edge's; it grows with u, so the piece is found by its value at each
    piece's outer end.
    """
    low = 0.0
    for k in range(len(pieces)):
        if pieces[k, RHO1] <= lateral:
            continue
        high = min(math.sqrt(pieces[k, RHO1] * pieces[k, RHO1] - lateral * lateral), reach)
        rho = math.sqrt(lateral * lateral + high * high)
        # The piece's slope along the edge at its outer end, compared without a division: the root
        # is 0 at a vertical end.
        if pieces[k, ROUND] != 0.0:
            out = rho - pieces[k, A]
            root = math.sqrt(max(pieces[k, C] * pieces[k, C] - out * out, 0.0))
            steeper = out * high >= rise * root * rho
        else:
            steeper = pieces[k, B] * high >= rise * rho
        if steeper:
            return _piece_contact_offset(pieces[k], lateral, rise, low, high)
        low = high
    return reach


@njit(**BORROWED)
def _piece_contact_offset(
    piece: Floats, lateral: float, rise: float, low: float, high: float
) -> float:
    """Return where (u, mm) one piece is as steep along an edge as the edge climbs, between two
    distances from the foot.

    A cone and a sphere have closed forms; a torus takes Newton's method, safeguarded by bisection.
    """
    if piece[ROUND] == 0.0:
        # Cone: B u / rho = rise.
        square = piece[B] * piece[B] - rise * rise
        return min(max(rise * lateral / math.sqrt(square), low), high) if square > 0.0 else high
    a, c = piece[A], piece[C]
    # Sphere about the axis: u = rise sqrt((c^2 - beside^2) / (1 + rise^2)).
    if a == 0.0:
        return min(
            max(rise * math.sqrt(max((c * c - lateral * lateral) / (1.0 + rise * rise), 0.0)), low),
            high,
        )
    u = 0.5 * (low + high)
    for _ in range(STEPS):
        rho = math.sqrt(lateral * lateral + u * u)
        out = rho - a
        root = math.sqrt(max(c * c - out * out, _TINY))
        k = out / root
        value = k * u / rho - rise
        if value > 0.0:
            high = u
        else:
            low = u
        # d/du of g'(rho) u / rho: g'' (u / rho)^2 + g' beside^2 / rho^3, with g'' = c^2 / root^3.
        # At a vertical end the root is nothing but rounding, and its cube may be none at all: halve there.
        cube = root * root * root
        bend = 0.0
        if cube > 0.0:
            bend = c * c / cube * (u / rho) ** 2 + k * lateral * lateral / (rho * rho * rho)
        step = u - value / bend if bend > 0.0 else low
        nearer = step if low < step < high else 0.5 * (low + high)
        if abs(nearer - u) <= _ROUNDING * max(1.0, u):
            return nearer
        u = nearer
    return u


@njit(**BORROWED)
def _edge_drop(
    px: float,
    py: float,
    ax: float,
    ay: float,
    az: float,
    bx: float,
    by: float,
    bz: float,
    pieces: Floats,
    radius: float,
    best: float,
) -> float:
    """Return the larger of `best` and the height (mm) to which an edge from a to b lifts the tip over
    (px, py).

    An edge that is vertical in plan is left to its corners.
    """
    dx, dy = bx - ax, by - ay
    square = dx * dx + dy * dy
    if square == 0.0:
        return best
    cross = (ax - px) * dy - (ay - py) * dx
    # Out of the cutter's radius, or even its higher end too low.
    if (
        cross * cross > radius * radius * square
        or max(az, bz) - _profile_height(pieces, min(abs(cross) / math.sqrt(square), radius))
        <= best
    ):
        return best
    length = math.sqrt(square)
    lateral, foot = abs(cross) / length, -((ax - px) * dx + (ay - py) * dy) / length
    # The stretch of the edge under the cutter, by u from the foot of the axis.
    reach = math.sqrt(max(radius * radius - lateral * lateral, 0.0))
    rise = (bz - az) / length
    low, high = max(-foot, -reach), min(length - foot, reach)
    if low > high:
        return best
    # The tip's height along an edge is concave: its tangent in the middle bounds it, and most edges need no more.
    middle = 0.5 * (low + high)
    rho = math.sqrt(lateral * lateral + middle * middle)
    fall = _profile_slope(pieces, rho) * middle / rho if rho > 0.0 else 0.0
    if (
        az
        + rise * (foot + middle)
        - _profile_height(pieces, min(rho, radius))
        + abs(rise - fall) * 0.5 * (high - low)
        <= best
    ):
        return best
    u = _edge_contact_offset(pieces, lateral, abs(rise), reach)
    if rise < 0.0:
        u = -u
    if u < -foot:
        u = -foot
    if u > length - foot:
        u = length - foot
    if abs(u) > reach:
        return best
    rho = min(math.sqrt(lateral * lateral + u * u), radius)
    return max(best, az + rise * (foot + u) - _profile_height(pieces, rho))


@njit(**BORROWED)
def _edge_drop_ball(
    px: float,
    py: float,
    ax: float,
    ay: float,
    az: float,
    bx: float,
    by: float,
    bz: float,
    ball: float,
    radius: float,
    best: float,
) -> float:
    """Return the larger of `best` and the height (mm) to which an edge lifts the tip of a ball end of
    radius `ball`, in closed form."""
    dx, dy = bx - ax, by - ay
    square = dx * dx + dy * dy
    if square == 0.0:
        return best
    cross = (ax - px) * dy - (ay - py) * dx
    lateral = cross * cross / square
    if lateral > radius * radius:
        return best
    length = math.sqrt(square)
    foot, reach, rise = (
        -((ax - px) * dx + (ay - py) * dy) / length,
        math.sqrt(radius * radius - lateral),
        (bz - az) / length,
    )
    low, high = max(-foot, -reach), min(length - foot, reach)
    if low > high:
        return best
    u = min(max(rise * math.sqrt((ball * ball - lateral) / (1.0 + rise * rise)), low), high)
    return max(
        best, az + rise * (foot + u) - ball + math.sqrt(max(ball * ball - lateral - u * u, 0.0))
    )


@njit(**BORROWED)
def _vertex_drop(
    px: float, py: float, x: float, y: float, z: float, pieces: Floats, radius: float, best: float
) -> float:
    """Return the larger of `best` and the height (mm) to which a corner (x, y, z) lifts the tip."""
    square = (x - px) * (x - px) + (y - py) * (y - py)
    if z <= best or square > radius * radius:
        return best
    return max(best, z - _profile_height(pieces, math.sqrt(square)))


@njit(**BORROWED)
def _facet_drop(px: float, py: float, f: Floats, pieces: Floats, best: float) -> float:
    """Return the larger of `best` and the height (mm) to which the inside of a facet (19,) lifts the
    tip; vertical facets have no inside in plan.

    The cutter touches the plane uphill of its axis, where its lower side is as steep as the plane.
    """
    turn = f[TURN]
    if turn == 0.0:
        return best
    rho = _contact_radius(pieces, f[STEEP])
    x, y = px, py
    if f[STEEP] > 0.0:
        x, y = px + rho * f[GX] / f[STEEP], py + rho * f[GY] / f[STEEP]
    z = f[AZ] + (x - f[AX]) * f[GX] + (y - f[AY]) * f[GY] - _profile_height(pieces, rho)
    if z <= best:
        return best
    # The touching point must be inside: left of all edges, or right of all, as the facet turns.
    side = 1.0 if turn > 0.0 else -1.0
    if side * ((f[BX] - f[AX]) * (y - f[AY]) - (f[BY] - f[AY]) * (x - f[AX])) < 0.0:
        return best
    if side * ((f[CX] - f[BX]) * (y - f[BY]) - (f[CY] - f[BY]) * (x - f[BX])) < 0.0:
        return best
    if side * ((f[AX] - f[CX]) * (y - f[CY]) - (f[AY] - f[CY]) * (x - f[CX])) < 0.0:
        return best
    return z


@njit(**BORROWED)
def _plane_lift(plane: Floats, pieces: Floats, lift: Floats) -> None:
    """Fill lift (8,), as `LIFT_X` to `SECANT` name it, with how a plane (3,), slopes along x and y and
    height over (0, 0), lifts a cutter.

    Touching the plane at rho uphill lifts the tip to plane(x, y) + rho steep - g(rho).
    """
    gx, gy, height = plane[0], plane[1], plane[2]
    steep = math.sqrt(gx * gx + gy * gy)
    lift[LIFT_X], lift[LIFT_Y], lift[OUT_X], lift[OUT_Y] = gx, gy, 0.0, 0.0
    rho = _contact_radius(pieces, steep)
    if steep > 0.0:
        lift[OUT_X], lift[OUT_Y] = rho * gx / steep, rho * gy / steep
    lift[HEIGHT], lift[SLOPE], lift[SECANT] = height, steep, math.sqrt(1.0 + steep * steep)
    lift[LIFT] = height + rho * steep - _profile_height(pieces, rho)


@njit(**BORROWED)
def plane_lift_loop(planes: Floats, pieces: Floats, lifts: Floats) -> None:
    """Fill lifts (n, 8) with how planes (n, 3) lift a cutter, row by row as `_plane_lift` does."""
    for n in range(len(planes)):
        _plane_lift(planes[n], pieces, lifts[n])


@njit(**BORROWED, inline="always")
def _height_bound(
    px: float,
    py: float,
    lift: Floats,
    x0: float,
    y0: float,
    x1: float,
    y1: float,
    pieces: Floats,
    radius: float,
    ball: float,
) -> float:
    """Return a height (mm) that nothing below a plane and inside a box lifts the tip over: an upper
    bound."""
    top = lift[LIFT_X] * px + lift[LIFT_Y] * py + lift[LIFT]
    if top < np.inf:
        if ball > 0.0:
            # A ball leaves the plane away from where it touches: at the box's nearest point, by
            # plan gap and by the gap in height along the slope.
            x, y = px + lift[OUT_X], py + lift[OUT_Y]
            gx, gy = max(max(x0 - x, x - x1), 0.0), max(max(y0 - y, y - y1), 0.0)
            rise = abs(lift[LIFT_X] * (0.5 * (x0 + x1) - x) + lift[LIFT_Y] * (0.5 * (y0 + y1) - y))
            rise = max(
                rise - 0.5 * (abs(lift[LIFT_X]) * (x1 - x0) + abs(lift[LIFT_Y]) * (y1 - y0)), 0.0
            )
            top -= _ball_clearance(gx * gx + gy * gy + rise * rise, lift, ball)
        else:
            top = min(top, _tangent_height_bound(px, py, lift, x0, y0, x1, y1, pieces, radius))
    return top


@njit(**BORROWED, inline="always")
def _ball_clearance(square: float, lift: Floats, ball: float) -> float:
    """Return how far (mm) at least a ball that touches a plane stands above positions of the plane at a
    squared distance `square` (mm2) from where it touches, measured along z.

    Along the line from the ball's centre to the position the gap is sqrt(ball^2 + d^2) - ball; the
    tangent plane there is below the ball, and the gap along z to it is that over the z part of its
    normal, at most (ball + d slope) / (secant away).
    """
    away = math.sqrt(ball * ball + square)
    return square * away * lift[SECANT] / ((away + ball) * (ball + math.sqrt(square) * lift[SLOPE]))


@njit(**BORROWED)
def _tangent_height_bound(
    px: float,
    py: float,
    lift: Floats,
    x0: float,
    y0: float,
    x1: float,
    y1: float,
    pieces: Floats,
    radius: float,
) -> float:
    """Return an upper bound (mm) as `_height_bound` does, by the tangent plane of the lower side over the
    middle of the box: the lower side is convex, so nowhere below it.

    Infinite where the middle is beyond the cutter.
    """
    x, y = 0.5 * (x0 + x1) - px, 0.5 * (y0 + y1) - py
    rho = math.sqrt(x * x + y * y)
    if rho >= radius:
        return np.inf
    fall = _profile_slope(pieces, rho) / rho if rho > 0.0 else 0.0
    # Plane less tangent is linear: its greatest over the box is at the middle plus half the extent
    # along its slopes.
    gx, gy = abs(lift[LIFT_X] - fall * x), abs(lift[LIFT_Y] - fall * y)
    middle = (
        lift[HEIGHT]
        + lift[LIFT_X] * (px + x)
        + lift[LIFT_Y] * (py + y)
        - _profile_height(pieces, rho)
    )
    return middle + 0.5 * (gx * (x1 - x0) + gy * (y1 - y0))


@njit(**BORROWED)
def _triangle_drop(
    px: float,
    py: float,
    f: Floats,
    lift: Floats,
    owns: int,
    pieces: Floats,
    radius: float,
    ball: float,
    best: float,
) -> float:
    """Return the larger of `best` and the height (mm) to which a facet, with the edges and corners
    that `owns` has bits of, lifts the tip.

    Edges and corners that another facet owns are left to that one.
    """
    # Bounds first: by its highest z, by its plane, by the tangent over its box.
    if f[HIGH_Z] <= best or lift[LIFT_X] * px + lift[LIFT_Y] * py + lift[LIFT] <= best - _SLACK:
        return best
    if (
        ball <= 0.0
        and _tangent_height_bound(
            px, py, lift, f[LOW_X], f[LOW_Y], f[HIGH_X], f[HIGH_Y], pieces, radius
        )
        <= best - _SLACK
    ):
        return best
    if f[TURN] != 0.0:
        # Where the plane touches inside the facet, that is the most of all of it. Else it is less
        # by how far that is from an edge: `out` is the largest squared distance, in plan scale, to
        # an edge that it lies beyond.
        x, y = px + lift[OUT_X], py + lift[OUT_Y]
        side = 1.0 if f[TURN] > 0.0 else -1.0
        out = 0.0
        for k in range(3):
            a, b = 3 * k, 3 * ((k + 1) % 3)
            dx, dy = f[b] - f[a], f[b + 1] - f[a + 1]
            cross = side * (dx * (y - f[a + 1]) - dy * (x - f[a]))
            if cross < 0.0:
                dz = f[b + 2] - f[a + 2]
                out = max(out, cross * cross / (dx * dx + dy * dy + dz * dz))
        top = lift[LIFT_X] * px + lift[LIFT_Y] * py + lift[LIFT]
        if out == 0.0:
            return max(best, top)
        if (
            ball > 0.0
            and top - _ball_clearance(out * lift[SECANT] * lift[SECANT], lift, ball)
            <= best - _SLACK
        ):
            return best
    # Bound by the plan distance of the box; then what it owns, one by one.
    gx, gy = (
        max(max(f[LOW_X] - px, px - f[HIGH_X]), 0.0),
        max(max(f[LOW_Y] - py, py - f[HIGH_Y]), 0.0),
    )
    near = gx * gx + gy * gy
    if near > radius * radius or f[HIGH_Z] - _profile_height(pieces, math.sqrt(near)) <= best:
        return best
    for k in range(3):
        a, b = 3 * k, 3 * ((k + 1) % 3)
        if owns & (1 << k):
            if ball > 0.0:
                best = _edge_drop_ball(
                    px, py, f[a], f[a + 1], f[a + 2], f[b], f[b + 1], f[b + 2], ball, radius, best
                )
            else:
                best = _edge_drop(
                    px, py, f[a], f[a + 1], f[a + 2], f[b], f[b + 1], f[b + 2], pieces, radius, best
                )
        if owns & (8 << k):
            best = _vertex_drop(px, py, f[a], f[a + 1], f[a + 2], pieces, radius, best)
    return best


@njit(**BORROWED)
def _edge_contact_share(
    px: float, py: float, f: Floats, k: int, pieces: Floats, radius: float
) -> float:
    """Return at which share of its k-th edge, 0 to 1, a facet lifts the cutter most; of a vertical
    edge the higher end."""
    a, b = 3 * k, 3 * ((k + 1) % 3)
    dx, dy = f[b] - f[a], f[b + 1] - f[a + 1]
    length = math.sqrt(dx * dx + dy * dy)
    if length == 0.0:
        return 0.0 if f[a + 2] > f[b + 2] else 1.0
    lateral, foot = (
        abs((f[a] - px) * dy - (f[a + 1] - py) * dx) / length,
        -((f[a] - px) * dx + (f[a + 1] - py) * dy) / length,
    )
    if lateral > radius:
        return 0.0
    rise = (f[b + 2] - f[a + 2]) / length
    u = _edge_contact_offset(
        pieces, lateral, abs(rise), math.sqrt(max(radius * radius - lateral * lateral, 0.0))
    )
    if rise < 0.0:
        u = -u
    return min(max(foot + u, 0.0), length) / length


@njit(**BORROWED)
def _contact_point(
    px: float, py: float, f: Floats, pieces: Floats, radius: float, at: Floats
) -> None:
    """Fill at (3,) with the point of a facet that lifts the tip most: on its inside, or on one of its
    edges (corners are their ends)."""
    best = -np.inf
    rho = _contact_radius(pieces, f[STEEP])
    if _facet_drop(px, py, f, pieces, best) > best:
        x, y = px, py
        if f[STEEP] > 0.0:
            x, y = px + rho * f[GX] / f[STEEP], py + rho * f[GY] / f[STEEP]
        at[0], at[1], at[2] = x, y, f[AZ] + (x - f[AX]) * f[GX] + (y - f[AY]) * f[GY]
        best = at[2] - _profile_height(pieces, rho)
    for k in range(3):
        t = _edge_contact_share(px, py, f, k, pieces, radius)
        a, b = 3 * k, 3 * ((k + 1) % 3)
        x, y, z = (
            f[a] + t * (f[b] - f[a]),
            f[a + 1] + t * (f[b + 1] - f[a + 1]),
            f[a + 2] + t * (f[b + 2] - f[a + 2]),
        )
        away = math.sqrt((x - px) * (x - px) + (y - py) * (y - py))
        if (
            away <= radius * (1.0 + _ROUNDING)
            and z - _profile_height(pieces, min(away, radius)) > best
        ):
            best = z - _profile_height(pieces, min(away, radius))
            at[0], at[1], at[2] = x, y, z


@njit(**BORROWED, inline="always")
def _node_bound(
    px: float,
    py: float,
    box: Floats,
    lift: Floats,
    pieces: Floats,
    radius: float,
    ball: float,
    best: float,
) -> float:
    """Return an upper bound (mm) of the height to which anything below a plane and inside a box lifts
    the tip; -inf when that is not above `best`.

    The cheap bounds first: highest z, plane, plan distance. _SLACK covers their rounding.
    """
    top = box[Z1]
    if top <= best or lift[LIFT_X] * px + lift[LIFT_Y] * py + lift[LIFT] <= best - _SLACK:
        return -np.inf
    gx, gy = max(max(box[X0] - px, px - box[X1]), 0.0), max(max(box[Y0] - py, py - box[Y1]), 0.0)
    near = gx * gx + gy * gy
    if near > radius * radius:
        return -np.inf
    top -= _profile_height(pieces, math.sqrt(near))
    if top <= best:
        return -np.inf
    top = min(
        top,
        _height_bound(px, py, lift, box[X0], box[Y0], box[X1], box[Y1], pieces, radius, ball)
        + _SLACK,
    )
    return top if top > best else -np.inf


@njit(cache=True, nogil=True)
def drop_cutter_loop(
    first: int,
    last: int,
    points: Floats,
    facets: Floats,
    start: Ints,
    boxes: Floats,
    node_planes: Floats,
    planes: Floats,
    node_lifts: Floats,
    lifts: Floats,
    pieces: Floats,
    ball: float,
    lowest: Floats,
    highest: Floats,
    out: Floats,
    facet: Ints,
    contact: Floats,
) -> None:
    """Fill out[first:last] with the tip's height (mm) over plan points (n, 2) when the cutter touches
    facets (t, 19), at least lowest (n,). Where that is no less than highest (n,) the search ends at any facet that lifts the
    tip as high.

    Facets lie in a tree as `drop_bvh` makes it: start (leaves + 1,), boxes (nodes, 5). planes (t, 3) and
    node_planes (nodes, 3) are those that nothing of a facet or a node's facets is above, lifts (t, 8) and
    node_lifts (nodes, 8) as `plane_lift_loop` makes them of these; a row whose SECANT is 0 is not known
    yet and filled when it is met: then only one thread may have the arrays. ball: the radius of a ball
    end, 0 for other cutters. facet (n,) gets the row of the one that is touched, -1 over none, contact
    (n, 3) where, NaN over none.

    What the cutter touched last mostly lies under it at the next point too: a height to begin with
    that leaves little to search.
    """
    radius = pieces[len(pieces) - 1, RHO1]
    inner = len(start) - 2
    nodes, reaches = np.empty(DEEPEST, np.int64), np.empty(DEEPEST)
    contact_row = -1
    for n in range(first, last):
        px, py = points[n, 0], points[n, 1]
        best, own = lowest[n], -1
        if contact_row >= 0:
            better = _triangle_drop(
                px, py, facets[contact_row], lifts[contact_row], ALL, pieces, radius, ball, best
            )
            if better > best:
                best, own = better, contact_row
        # Depth first, the more promising child first. Invariant: what may lift the tip above `best`
        # is on the stack.
        nodes[0], reaches[0] = 0, np.inf
        waiting = 1
        enough = highest[n]
        while waiting > 0 and best < enough:
            waiting -= 1
            node = nodes[waiting]
            reach = reaches[waiting]
            while node < inner and reach > best:
                a, b = 2 * node + 1, 2 * node + 2
                if node_lifts[a, SECANT] == 0.0:
                    _plane_lift(node_planes[a], pieces, node_lifts[a])
                if node_lifts[b, SECANT] == 0.0:
                    _plane_lift(node_planes[b], pieces, node_lifts[b])
                reach = _node_bound(px, py, boxes[a], node_lifts[a], pieces, radius, ball, best)
                other = _node_bound(px, py, boxes[b], node_lifts[b], pieces, radius, ball, best)
                # What may lift it more comes first: most of the rest is then too low to matter.
                node = a
                if other > reach:
                    node, b = b, a
                    reach, other = other, reach
                if other > best:
                    nodes[waiting], reaches[waiting] = b, other
                    waiting += 1
            if reach > best:
                for r in range(start[node - inner], start[node - inner + 1]):
                    if r != contact_row:
                        if lifts[r, SECANT] == 0.0:
                            _plane_lift(planes[r], pieces, lifts[r])
                        better = _triangle_drop(
                            px,
                            py,
                            facets[r],
                            lifts[r],
                            int(facets[r, OWNS]),
                            pieces,
                            radius,
                            ball,
                            best,
                        )
                        if better > best:
                            best, own = better, r
        out[n], facet[n] = best, own
        contact[n, 0], contact[n, 1], contact[n, 2] = np.nan, np.nan, np.nan
        if own >= 0:
            _contact_point(px, py, facets[own], pieces, radius, contact[n])
            contact_row = own
