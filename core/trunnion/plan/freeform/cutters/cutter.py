"""A cutter as surface strategies see it: its lower side for drops, and where it touches a face of a given inclination.

The lower side (design: drop along the axis) is the cutting part's profile from the tip to its widest circle, as pieces over the distance
from the axis (`geometry.kernels.cutter_contact.drop_cutter`). An allowance makes the profile thicker all round by as much: a drop of
the thicker cutter keeps the allowance in every direction.
"""

from __future__ import annotations

import math

import numpy as np

from trunnion.findings import Refused
from trunnion.geometry.arrays import Floats
from trunnion.geometry.kernels.cutter_contact.drop_cutter import RHO1, ROUND, A, B, C
from trunnion.model.tool import Tool

SURFACE_FORMS = ("flat", "bull", "ball", "taper", "barrel")
"""Forms that surface strategies cut with: a lower side that is convex and rises from the tip outwards."""


def lower_side(tool: Tool, allowance: float = 0.0) -> Floats:
    """Return the lower side (p, 6) of a cutter, thicker by an allowance; its tip stays at height 0, `allowance` below the tool's own.

    So the tool's tip is at the dropped height plus the allowance. A negative one makes it thinner: what a surface within as much may lift
    the cutter by, where both are as round, doesn't lift the thinner one. A corner that is smaller than that gets sharp. Raises `Refused`
    for a form that surface strategies don't cut with.
    """
    if tool.form not in SURFACE_FORMS:
        raise Refused(
            f"{tool.name}: a {tool.form} cutter can't finish curved surfaces; choose one of {', '.join(SURFACE_FORMS)}"
        )
    a, c, r = allowance, tool.corner_radius, tool.radius
    corner, inner = max(c + a, 0.0), r - c + min(c + a, 0.0)
    if tool.form == "taper":
        lean = math.radians(tool.taper_angle)
        foot = r - c + c * math.cos(lean)
        top = foot + math.tan(lean) * (tool.flute_length - c * (1.0 - math.sin(lean)))
        rows = [_level(inner), _arc(inner, inner + corner * math.cos(lean), inner, corner, corner)]
        rows.append(
            _line(
                inner + corner * math.cos(lean),
                top + a * math.cos(lean),
                corner * (1.0 - math.sin(lean)),
                1.0 / math.tan(lean),
            )
        )
    elif tool.form == "barrel":
        big, centre, height = tool.barrel_radius, r - tool.barrel_radius, tool.widest_height
        contact = c * (0.0 - centre) / (big - c)
        rows = [
            _arc(0.0, contact * (c + a) / c, 0.0, c + a, c + a),
            _arc(contact * (c + a) / c, r + a, centre, height + a, big + a),
        ]
    else:
        rows = [_level(inner), _arc(inner, r + a, inner, corner, corner)]
    return np.array([row for row in rows if row[1] > row[0]])


def touching(tool: Tool, angle: Floats) -> tuple[Floats, Floats]:
    """Return where on its profile a cutter touches a plane whose outward normal leans by angles (k,) rad from the cutter's axis.

    Distance from the axis (k,) and height above the tip (k,), mm: the contact lies on the side the normal points away from. A flat end
    that is on a level plane touches with its rim.
    """
    angle = np.asarray(angle, dtype=np.float64)
    pieces = lower_side(tool)
    slope = np.tan(np.clip(angle, 0.0, math.pi / 2 - 1e-12))
    rho = np.full(angle.shape, pieces[0, 0])
    height = np.zeros(angle.shape)
    for k, row in enumerate(pieces):
        low, high = _slopes(row)
        inside = slope >= low
        if row[ROUND]:
            at = np.clip(row[A] + row[C] * np.sin(angle), row[0], row[1])
            z = row[B] - np.sqrt(np.maximum(row[C] ** 2 - (at - row[A]) ** 2, 0.0))
        else:
            past = slope >= high
            at = np.where(past, row[1], row[0])
            z = row[A] + row[B] * (at - row[0])
            inside = inside & past
        rho, height = np.where(inside, at, rho), np.where(inside, z, height)
        if k == 0 and not row[ROUND]:
            # A level end touches a level plane all over; its rim is what goes on from there.
            rho, height = np.where(angle <= 0.0, row[1], rho), np.where(angle <= 0.0, 0.0, height)
    return rho, height


def tip_at(tool: Tool, contact: Floats, normal: Floats, axis: Floats) -> Floats:
    """Return the tips (k, 3) of a cutter with axes (k, 3) that touches contact points (k, 3) of faces with outward normals (k, 3)."""
    cosine = np.clip((normal * axis).sum(axis=1), -1.0, 1.0)
    across = normal - cosine[:, None] * axis
    size = np.linalg.norm(across, axis=1, keepdims=True)
    radial = np.divide(across, size, out=np.zeros_like(across), where=size > 0.0)
    rho, height = touching(tool, np.arctan2(size[:, 0], cosine))
    # Seen from the axis the contact lies against the normal.
    return np.asarray(contact + rho[:, None] * radial - height[:, None] * axis)


def _slopes(row: Floats) -> tuple[float, float]:
    if row[ROUND]:
        root = [math.sqrt(max(row[C] ** 2 - (rho - row[A]) ** 2, 0.0)) for rho in (row[0], row[1])]
        return tuple(
            (rho - row[A]) / z if z > 0.0 else math.inf
            for rho, z in zip((row[0], row[1]), root, strict=True)
        )  # type: ignore[return-value]
    return float(row[B]), float(row[B])


def _level(end: float) -> list[float]:
    return [0.0, end, 0.0, 0.0, 0.0, 0.0]


def _line(start: float, end: float, height: float, slope: float) -> list[float]:
    return [start, end, 0.0, height, slope, 0.0]


def _arc(start: float, end: float, centre: float, height: float, radius: float) -> list[float]:
    return [start, end, 1.0, centre, height, radius]


def level_disc(radius: float) -> Floats:
    """Return the lower side of a level disc, as kernels of drops know it."""
    row = np.zeros((1, 6))
    row[0, RHO1] = radius
    return row
