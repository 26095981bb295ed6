"""At which heights a cutter goes over an area: layers of roughing, axial steps on walls, steps on a fillet."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

from trunnion import tolerance


def steps_down(top: float, bottom: float, step: float) -> tuple[float, ...]:
    """Return heights from below `top` down to `bottom` in equal steps of at most `step`.

    >>> steps_down(0.0, -9.0, 4.0)
    (-3.0, -6.0, -9.0)
    """
    count = max(1, math.ceil((top - bottom) / step - tolerance.COINCIDENT))
    return (*(top - (top - bottom) * n / count for n in range(1, count)), bottom)


def with_tops(heights: Sequence[float], top: float, tops: Iterable[float]) -> tuple[float, ...]:
    """Return heights of passes, which go down from below `top`, with those of some tops between that are none of them: over what is avoided
    a wall is cut down to its top.

    >>> with_tops((-3.0, -6.0), 0.0, (-1.0, -3.0, -7.0))
    (-1.0, -3.0, -6.0)
    """
    between = {
        z
        for z in tops
        if heights[-1] < z < top - tolerance.SEW
        and min(abs(z - h) for h in heights) > tolerance.SEW
    }
    return tuple(sorted({*heights, *between}, reverse=True)) if between else tuple(heights)


def layers(
    top: float, bottom: float, step: float, horizontals: Iterable[float], allowance: float
) -> tuple[float, ...]:
    """Return the heights of the layers of a band that begins at `top`; on a horizontal face at its bottom the allowance stays."""
    on_face = any(abs(z - bottom) < tolerance.SEW for z in horizontals)
    last = bottom + allowance if on_face else bottom
    return steps_down(top, last, step) if top - last > tolerance.SEW else ()


def fillet_steps(fillet: float, corner_radius: float, scallop: float) -> tuple[float, ...]:
    """Return the heights above the floor, downwards and ending with 0, at which a cutter whose corner radius is smaller than the fillet
    leaves cusps of at most `scallop` on it (none above 0 when the corner is as large as the fillet).

    The centre of the cutter's corner goes along an arc of radius fillet - corner_radius; two positions on it an angle a apart leave a cusp
    fillet - g cos(a / 2) - sqrt(rc^2 - g^2 sin^2(a / 2)) high, g that radius. A sharp corner leaves steps half as high as they are wide.
    """
    gap = fillet - corner_radius
    if gap <= tolerance.SEW:
        return (0.0,)
    angle = (
        2.0 * scallop / gap
        if corner_radius <= scallop
        else _widest_angle(gap, corner_radius, scallop)
    )
    count = max(1, math.ceil(0.5 * math.pi / angle))
    return tuple(gap * (1.0 - math.sin(0.5 * math.pi * n / count)) for n in range(count)) + (0.0,)


def _widest_angle(gap: float, corner_radius: float, scallop: float) -> float:
    low, high = 0.0, math.pi / 2
    for _ in range(40):
        half = 0.25 * (low + high)
        inside = corner_radius**2 - (gap * math.sin(half)) ** 2
        cusp = (
            gap + corner_radius - gap * math.cos(half) - math.sqrt(inside)
            if inside > 0.0
            else math.inf
        )
        if cusp > scallop:
            high = 0.5 * (low + high)
        else:
            low = 0.5 * (low + high)
    return max(low, tolerance.COINCIDENT)
