"""A cutter marched through an area at constant engagement: hot loops over two fields on a grid.

Both fields hold values at the nodes (nx, ny) of a grid of square cells: node (i, j) is at `x0 + i cell`, `y0 + j cell`; between
nodes they are bilinear. `depth` is how far inside the axis region a position is (negative outside), `uncut` how far a place is from
all that was cleared (negative where it was): the signed distance that discs swept so far leave, exact in a band about the edge of what
they cleared. mm, rad.
"""

from __future__ import annotations

import math

from numba import njit

from trunnion.geometry.arrays import Floats

MET, NOTHING_MET, STUCK, LONG = 0, 1, 2, 3
"""Why a march ended: it ran out of what it cut; it met nothing; no heading was left; the arrays were full."""

ROUNDS = 8
"""Headings that are tried between one that is too far to the side and one that isn't."""

CLOSE = 0.006
"""rad below the engagement that is kept: a heading so close is taken."""

FINE = 0.002
"""rad: headings that close are one."""

NUDGE = 0.03
"""rad to either side of the turn of the step before: where the next heading is looked for first."""

LEFTWARD = 0.2
"""rad: step to the left while headings beyond the ordinary turn are tried."""

BAND = 2.0
"""Cells beyond a disc's rim up to which the distance from it is kept."""


@njit(cache=True, nogil=True)
def field_value(field: Floats, x0: float, y0: float, cell: float, x: float, y: float) -> float:
    """Return a field's value at a point, that of the nearest point of the grid outside of it."""
    nx, ny = field.shape
    u = min(max((x - x0) / cell, 0.0), nx - 1.0)
    v = min(max((y - y0) / cell, 0.0), ny - 1.0)
    i, j = min(int(u), nx - 2), min(int(v), ny - 2)
    u -= i
    v -= j
    low = (1.0 - v) * field[i, j] + v * field[i, j + 1]
    high = (1.0 - v) * field[i + 1, j] + v * field[i + 1, j + 1]
    return (1.0 - u) * low + u * high


@njit(cache=True, nogil=True)
def engagement_at(
    uncut: Floats,
    x0: float,
    y0: float,
    cell: float,
    x: float,
    y: float,
    heading: float,
    radius: float,
    fan: Floats,
    thin: float,
    side: float,
) -> float:
    """Return the angle (rad) over which the front half of a cutter's rim is in what is uncut.

    `fan` (n, 2): cosine and sine of the angles from 0 to pi at which the rim is looked at, from the side of the material
    (`side` 1: right of the heading, -1: left) round to the other one. What is nearer than `thin` to what was cleared doesn't count.
    """
    hx, hy = math.cos(heading), math.sin(heading)
    total, before = 0.0, 0.0
    for k in range(len(fan)):
        across, ahead = radius * side * fan[k, 0], radius * fan[k, 1]
        now = (
            field_value(
                uncut, x0, y0, cell, x + hy * across + hx * ahead, y - hx * across + hy * ahead
            )
            - thin
        )
        if k > 0:
            if now > 0.0 and before > 0.0:
                total += 1.0
            elif now > 0.0:
                total += now / (now - before)
            elif before > 0.0:
                total += before / (before - now)
        before = now
    return total * math.pi / (len(fan) - 1)


@njit(cache=True, nogil=True)
def sweep_disc(
    uncut: Floats,
    x0: float,
    y0: float,
    cell: float,
    ax: float,
    ay: float,
    bx: float,
    by: float,
    radius: float,
) -> None:
    """Clear what a disc sweeps from (ax, ay) straight to (bx, by): every node near gets its distance from it where that is less."""
    nx, ny = uncut.shape
    reach = radius + BAND * cell
    first_i = max(0, int(math.ceil((min(ax, bx) - reach - x0) / cell)))
    last_i = min(nx - 1, int(math.floor((max(ax, bx) + reach - x0) / cell)))
    first_j = max(0, int(math.ceil((min(ay, by) - reach - y0) / cell)))
    last_j = min(ny - 1, int(math.floor((max(ay, by) + reach - y0) / cell)))
    dx, dy = bx - ax, by - ay
    square = dx * dx + dy * dy
    for i in range(first_i, last_i + 1):
        x = x0 + i * cell - ax
        for j in range(first_j, last_j + 1):
            known = uncut[i, j] + radius
            if known <= 0.0:
                continue
            y = y0 + j * cell - ay
            share = (x * dx + y * dy) / square if square > 0.0 else 0.0
            share = min(max(share, 0.0), 1.0)
            away = (x - share * dx) ** 2 + (y - share * dy) ** 2
            if away < known * known:
                uncut[i, j] = math.sqrt(away) - radius


@njit(cache=True, nogil=True)
def _stamp_disc(
    uncut: Floats, x0: float, y0: float, cell: float, x: float, y: float, radius: float
) -> None:
    """Clear a disc about (x, y), a short step from one that was cleared: nodes near its rim get their distance from it where that is less.

    Between two steps of a twelfth of the radius the discs' rims are within 0.001 radii of what the cutter sweeps.
    """
    nx, ny = uncut.shape
    outer, inner = radius + BAND * cell, radius - BAND * cell
    first, last = (
        max(0, int(math.ceil((x - outer - x0) / cell))),
        min(nx - 1, int((x + outer - x0) / cell)),
    )
    for i in range(first, last + 1):
        across = (x0 + i * cell - x) ** 2
        reach = math.sqrt(max(outer * outer - across, 0.0))
        gap = math.sqrt(inner * inner - across) if across < inner * inner else 0.0
        low, high = (
            max(0, int(math.ceil((y - reach - y0) / cell))),
            min(ny - 1, int((y + reach - y0) / cell)),
        )
        # Of the column the two stretches in the band are looked at; inside of it the disc before has been.
        below = min(high, int(math.floor((y - gap - y0) / cell)))
        above = max(low, int(math.ceil((y + gap - y0) / cell)), below + 1)
        for stretch in range(2):
            first_j, last_j = (low, below) if stretch == 0 else (above, high)
            for j in range(first_j, last_j + 1):
                away = math.sqrt(across + (y0 + j * cell - y) ** 2) - radius
                if away < uncut[i, j]:
                    uncut[i, j] = away


@njit(cache=True, nogil=True)
def disc_is_free(
    uncut: Floats,
    depth: Floats,
    x0: float,
    y0: float,
    cell: float,
    x: float,
    y: float,
    radius: float,
    fan: Floats,
    thin: float,
) -> bool:
    """Return whether a cutter at a position is in the axis region and its whole rim in what was cleared."""
    if field_value(depth, x0, y0, cell, x, y) < -thin:
        return False
    for half in (1.0, -1.0):
        for k in range(len(fan)):
            px, py = x + half * radius * fan[k, 0], y + half * radius * fan[k, 1]
            if field_value(uncut, x0, y0, cell, px, py) > thin:
                return False
    return True


@njit(cache=True, nogil=True)
def line_is_free(
    uncut: Floats,
    depth: Floats,
    x0: float,
    y0: float,
    cell: float,
    ax: float,
    ay: float,
    bx: float,
    by: float,
    radius: float,
    fan: Floats,
    thin: float,
) -> bool:
    """Return whether a cutter goes straight from one position to another through what was cleared, and stays in the axis region."""
    count = int(math.hypot(bx - ax, by - ay) / (2.0 * cell)) + 1
    for k in range(count + 1):
        share = k / count
        x, y = ax + share * (bx - ax), ay + share * (by - ay)
        if not disc_is_free(uncut, depth, x0, y0, cell, x, y, radius, fan, thin):
            return False
    return True


@njit(cache=True, nogil=True)
def _excess(
    uncut: Floats,
    depth: Floats,
    x0: float,
    y0: float,
    cell: float,
    x: float,
    y: float,
    heading: float,
    step: float,
    radius: float,
    fan: Floats,
    thin: float,
    side: float,
    angle: float,
) -> float:
    """Return by how much the engagement passes an angle after a step along a heading; a full turn where that leaves the axis region."""
    px, py = x + step * math.cos(heading), y + step * math.sin(heading)
    if field_value(depth, x0, y0, cell, px, py) < 0.0:
        return math.tau
    return engagement_at(uncut, x0, y0, cell, px, py, heading, radius, fan, thin, side) - angle


@njit(cache=True, nogil=True)
def march_engaged(
    uncut: Floats,
    depth: Floats,
    x0: float,
    y0: float,
    cell: float,
    start: Floats,
    radius: float,
    fan: Floats,
    thin: float,
    side: float,
    cuts: bool,
    angle: float,
    least: float,
    step: float,
    turn: float,
    idle_before: float,
    idle_after: float,
    path: Floats,
) -> tuple[int, int]:
    """March a cutter from `start` (3,: x, y, heading) and return the number of positions in `path` and why it ended.

    Every step of `step` mm takes the heading farthest to the side of the material (`side` 1: right, -1: left) at which the engagement
    stays within `angle` and the cutter in the axis region: it keeps the material, or the wall, at its side. It turns to that side by no
    more than `turn` a step, to the other one as far as it must. Where it `cuts`, each step is cleared. It ends after `idle_after`
    mm with less than `least` in engagement behind the last that was more, or when nothing is met for `idle_before` mm. `path`
    (m, 4): x, y, heading and engagement of each position.
    """
    x, y, heading = start[0], start[1], start[2]
    path[0, 0], path[0, 1], path[0, 2], path[0, 3] = x, y, heading, 0.0
    n, idle, met, bend = 1, 0.0, False, 0.0
    while n < len(path):
        # Most steps go on as the one before: a heading too far to the side and one that isn't are looked for about that first.
        near, far = heading + bend - side * NUDGE, heading + bend + side * NUDGE
        over = _excess(uncut, depth, x0, y0, cell, x, y, near, step, radius, fan, thin, side, angle)
        excess = _excess(
            uncut, depth, x0, y0, cell, x, y, far, step, radius, fan, thin, side, angle
        )
        if over <= 0.0 or excess > 0.0 or abs(bend) + NUDGE > turn:
            near = heading - side * turn
            far, away = near, 0.0
            over = _excess(
                uncut, depth, x0, y0, cell, x, y, near, step, radius, fan, thin, side, angle
            )
            excess = over
            while excess > 0.0:
                near, over = far, excess
                away += turn if away < 3.0 * turn else LEFTWARD
                if away > math.pi:
                    return n, STUCK
                far = heading - side * (turn - away)
                excess = _excess(
                    uncut, depth, x0, y0, cell, x, y, far, step, radius, fan, thin, side, angle
                )
        rounds = 0
        while over > 0.0 and excess < -CLOSE and rounds < ROUNDS and abs(far - near) > FINE:
            # False position while both are engagements, halving where one is out of the axis region; every third round halves anyway.
            share = 0.5
            if over < math.pi and rounds % 3 < 2:
                share = min(max(over / (over - excess), 0.05), 0.95)
            middle = near + share * (far - near)
            found = _excess(
                uncut, depth, x0, y0, cell, x, y, middle, step, radius, fan, thin, side, angle
            )
            if found > 0.0:
                near, over = middle, found
            else:
                far, excess = middle, found
            rounds += 1
        best = far
        bend = best - heading
        heading = best
        x, y = x + step * math.cos(heading), y + step * math.sin(heading)
        engagement = excess + angle
        if cuts and engagement > 0.0:
            _stamp_disc(uncut, x0, y0, cell, x, y, radius)
        path[n, 0], path[n, 1], path[n, 2], path[n, 3] = x, y, heading, engagement
        n += 1
        if engagement > least:
            met, idle = True, 0.0
        else:
            idle += step
            if met and idle > idle_after:
                return n, MET
            if not met and idle > idle_before:
                return n, NOTHING_MET
    return n, LONG
