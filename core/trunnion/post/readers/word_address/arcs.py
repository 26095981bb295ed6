"""Centres of arcs in the plane XY from what a line says of them; what a control would refuse or could take for another arc is refused."""

from __future__ import annotations

import math

from trunnion import tolerance
from trunnion.findings import BadInput
from trunnion.model.motion.toolpath import Motion
from trunnion.post.readers.sections import Point


def refuse_no_radius(line: int, radius: float, letter: str = "R") -> None:
    """Raise `BadInput` for an arc whose radius in mm is below what decimals can say: where it goes is left to rounding."""
    if abs(radius) < tolerance.WRITTEN:
        raise BadInput(f"line {line}: an arc without a radius; check its centre or {letter}")


def refuse_nearly_closed(line: int, start: Point, end: Point) -> None:
    """Raise `BadInput` for an arc that ends almost where it starts: a control may take it for a full turn or for none."""
    apart = math.dist(start[:2], end[:2])
    if 0.0 < apart < tolerance.COINCIDENT:
        raise BadInput(
            f"line {line}: the arc ends {apart:.2g} mm from its start; write the start's own numbers for a full circle, "
            "or a line"
        )


def centre_by_offset(
    line: int, start: Point, end: Point, offset: tuple[float, float], letter: str = "R"
) -> Point:
    """Return the centre of an arc given by its offset from the start (I and J), at the height of the start.

    Lengths in mm; `letter` is that of a radius on this control.
    """
    x, y = start[0] + offset[0], start[1] + offset[1]
    first, last = math.dist((x, y), start[:2]), math.dist((x, y), end[:2])
    refuse_no_radius(line, first, letter)
    if abs(first - last) > tolerance.ARC_RADIUS:
        raise BadInput(
            f"line {line}: the arc starts at radius {first:.4f} and ends at {last:.4f} mm; check its end or its centre"
        )
    refuse_no_radius(line, last, letter)
    refuse_nearly_closed(line, start, end)
    return (x, y, start[2])


def centre_by_radius(
    line: int, motion: Motion, start: Point, end: Point, radius: float, letter: str = "R"
) -> Point:
    """Return the centre of an arc given by its radius; negative for the longer way round.

    Lengths in mm; `letter` is that of the radius on this control.
    """
    dx, dy = end[0] - start[0], end[1] - start[1]
    chord = math.hypot(dx, dy)
    refuse_no_radius(line, radius, letter)
    refuse_nearly_closed(line, start, end)
    if chord == 0.0:
        raise BadInput(
            f"line {line}: an arc with {letter} must end elsewhere than it starts; use I and J for a full circle"
        )
    if chord / 2 - abs(radius) > tolerance.ARC_RADIUS:
        raise BadInput(
            f"line {line}: the radius {letter}{radius:g} is too small to reach the arc's end, {chord:.4f} mm away"
        )
    height = math.sqrt(max(radius**2 - chord**2 / 4, 0.0))
    left = (motion == Motion.ARC_CCW) == (radius > 0.0)
    side = height / chord if left else -height / chord
    return (start[0] + dx / 2 - dy * side, start[1] + dy / 2 + dx * side, start[2])
