"""Lines along the stream in a channel between two blades: on the hub, or on levels between hub and shroud.

Lines of equal share of the way from blade to blade run with the stream. A channel widens: where they would lie too far apart, more of them
begin between the others. Each is there only between the two walls, or the toes of their fillets.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from trunnion.geometry.arrays import Bools, Floats
from trunnion.plan.channel.blade_channel import BladeChannel
from trunnion.toolpath.contact_passes.contacts import Contacts

SHORT = 3
"""Contacts that a line has at least."""
STEP = 0.05
"""Share of the way from hub to shroud over which a wall's lean is taken."""
LEAST_UPRIGHT = 0.3
"""Cosine of the largest lean of a ruling that levels are raised for."""
LATE = 0.05
"""Share of the stream from which on a blade that begins so far behind the others is a splitter."""
CLEARANCE, TOE_CLEARANCE = 0.05, 0.03
"""mm more that lines stay off walls, and off toes: what nets and triangles may be off."""

Surface = Callable[[Floats, Floats], tuple[Floats, Floats]]
"""From u and v (k,) to points and normals (k, 3) of a level of a channel."""


def lines_between(
    surface: Surface, u: Floats, low: Floats, high: Floats, stepover: float
) -> list[list[Contacts]]:
    """Return lines over a surface at places u (nu,) between v `low` and `high` (nu,), none where these cross: first the two that follow
    these ends, then those that go all along, then those between them, set by set; no farther apart than a stepover (mm)."""
    known = low < high
    if not known.any():
        return []
    inner = np.where(known, low, 0.5), np.where(known, high, 0.5)
    ends = [surface(u, v)[0] for v in inner]
    width = np.linalg.norm(ends[1] - ends[0], axis=1)
    span = np.where(known, high - low, 1.0)
    whole = width / span
    sets = [[line for v in inner for line in _runs(surface, u, v, known)]]
    count = max(1, math.ceil(float(whole[known].min()) / stepover))
    places, wide = [k / count for k in range(1, count)], known
    while True:
        some = []
        for v in places:
            at = np.full_like(u, v)
            some += _runs(surface, u, at, wide & (low < at) & (at < high))
        sets.append(some)
        wide = known & (whole / count > stepover)
        if not wide.any():
            return [s for s in sets if s]
        # A place more at either end: what lies beside is cleared there.
        wide |= known & (np.append(wide[1:], False) | np.append(False, wide[:-1]))
        places = [(k + 0.5) / count for k in range(count)]
        count *= 2


def hub_of(channel: BladeChannel) -> Surface:
    """Return the hub of a channel."""
    return channel.hub


def level_of(
    channel: BladeChannel, height: Callable[[Floats], Floats], radius: float, off: float
) -> Surface:
    """Return a level of a channel, as high over the hub as `height` says in mm at u (k,); its normals are the rulings.

    Where these lean out of the hub's normal, by an angle a, a ball of a radius on them is nearer to the hub than its contact. The level is
    raised where the ball would be nearer than `off` mm: (h + R) cos(a) - R >= off.
    """

    def surface(u: Floats, v: Floats) -> tuple[Floats, Floats]:
        ruling = channel.rulings(u, v)
        upright = np.maximum((ruling * channel.hub(u, v)[1]).sum(axis=1), LEAST_UPRIGHT)
        lowest = (radius + off) / upright - radius
        w = np.maximum(height(u), lowest) / channel.meridian.height(np.clip(u, 0.0, 1.0))
        return channel.at(u, v, w), ruling

    return surface


def between_walls(channel: BladeChannel, u: Floats, w: Floats, off: float) -> tuple[Floats, Floats]:
    """Return the v (nu,), (nu,) that lie `off` mm off the walls of a channel at u and w (nu,); off the cambers before the leading edges.

    Before a splitter the channel is open: lines come up to its camber, and go round its leading edge.
    """
    low, high = channel.lower.at(u, w), channel.upper.at(u, w)
    radius = np.maximum(channel.meridian.at(u, w)[:, 0], 1e-3)
    tall = channel.meridian.height(np.clip(u, 0.0, 1.0))
    ends = []
    for camber, side, sign in ((channel.lower, 1, 1.0), (channel.upper, 0, -1.0)):
        begin = camber.begin(w)
        ahead = np.where(begin > LATE, (begin - u) * channel.meridian.hub.run, 0.0)
        alone = (u < 0.0) | (ahead > 0.0)
        middle, beside = camber.at(u, w), camber.side(side, u, w)
        wall = np.where(alone, middle, beside)
        rz = channel.meridian.at(u, w)
        run = np.linalg.norm(np.gradient(rz, axis=0), axis=1)
        turn = np.where(alone, np.gradient(middle), np.gradient(beside))
        along = radius * turn / np.maximum(run, 1e-6)
        rise = camber.side(side, u, w + STEP) - camber.side(side, u, w - STEP)
        inside = np.clip(w + STEP, 0.0, 1.0) - np.clip(w - STEP, 0.0, 1.0)
        across = radius * rise / (inside * tall)
        # Across a wall that is swept and leans it is farther round the axis than square to the wall: by the length of its gradient.
        longer = np.sqrt(1.0 + along**2 + across**2)
        # Square to a swept camber the nose is nearer than it is far along the camber.
        size = off + CLEARANCE + radius * np.abs(beside - middle) / longer
        nose = np.maximum(ahead * np.sqrt(1.0 + along**2) - np.abs(along) * size, 0.0)
        beyond = np.sqrt(np.maximum(size**2 - nose**2, 0.0))
        away = longer * np.where(ahead > 0.0, beyond, off + CLEARANCE)
        ends.append(wall + sign * away / radius)
    span = high - low
    return (ends[0] - low) / span, (ends[1] - low) / span


def between_toes(
    channel: BladeChannel, u: Floats, off: float = TOE_CLEARANCE
) -> tuple[Floats, Floats]:
    """Return the v (nu,), (nu,) that lie `off` mm off the toes of a channel's blades at u (nu,)."""
    zero = np.zeros_like(u)
    low, high = channel.lower.at(u, zero), channel.upper.at(u, zero)
    turn = off / channel.meridian.at(u, zero)[:, 0]
    return (
        (channel.lower.toe(1, u) + turn - low) / (high - low),
        (channel.upper.toe(0, u) - turn - low) / (high - low),
    )


def _runs(surface: Surface, u: Floats, v: Floats, rows: Bools) -> list[Contacts]:
    """Return the lines (u, v) over a surface in each run of rows (nu,)."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], rows, [False]]).astype(np.int8)))
    found = []
    for a, b in edges.reshape(-1, 2).tolist():
        if b - a >= SHORT:
            point, normal = surface(u[a:b], v[a:b])
            found.append(Contacts(point=point, normal=normal))
    return found
