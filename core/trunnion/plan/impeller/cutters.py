"""Which cutters an impeller is milled with: by the narrowest place between blades, the root fillets and the blades' height."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from trunnion.geometry.sheet.skin import Skin
from trunnion.model.feature import Feature
from trunnion.model.tool import Tool
from trunnion.plan.impeller.wheel import ROOT, WALLS, Wheel

FACING = -0.5
"""Largest cosine of the angle between the normals of two places that face each other over a channel."""
OVER = 1.0
"""mm that flutes are longer than blades are high: what is above them is thicker."""
SMALLER = 0.9
"""Of a fillet's radius: a ball as round as it is touches all of it at once, and flow lines over it lie nowhere."""
ROUND = 0.01
"""mm by which a cutter may be rounder than a fillet: what fillets are modelled to."""
SHORT, SHARPEST = 0.05, 0.98
"""mm: shorter sides of triangles say nothing of a bend; and the share of bends that are no sharper than the fillet's."""
NEAREST = 12
"""Places on the other wall that are looked at for one that faces."""


@dataclass(frozen=True, slots=True, kw_only=True)
class WheelSizes:
    """What bounds the cutters, mm: the narrowest `channel`, the smallest root `fillet` (0: none), the largest `height` of blades."""

    channel: float
    fillet: float
    height: float


def sizes_of(wheel: Wheel, skin: Skin) -> WheelSizes:
    """Return the sizes of a wheel, from a skin in the rotor's frame."""
    return WheelSizes(
        channel=min(
            _between(skin, a, b)
            for a, b in zip(
                wheel.blades[: wheel.period],
                (*wheel.blades[1 : wheel.period], wheel.blades[wheel.period % len(wheel.blades)]),
                strict=True,
            )
        ),
        fillet=min(
            (_roundness(skin, f.with_role(*ROOT)) for f in wheel.blades[: wheel.period]),
            default=0.0,
        ),
        height=float(wheel.meridian.height(np.linspace(0.0, 1.0, 33)).max()),
    )


def _roundness(skin: Skin, tags: tuple[int, ...]) -> float:
    """Return the radius in mm of the hollow that root fillets make, by the turn of normals along the sides of their triangles; 0 without
    fillets. A few sides may be sharper: the kernel's corner values."""
    triangles = skin.triangles[skin.of(tags)]
    if not len(triangles):
        return 0.0
    sides = np.vstack([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    step = skin.points[sides[:, 1]] - skin.points[sides[:, 0]]
    turn = skin.normals[sides[:, 1]] - skin.normals[sides[:, 0]]
    square = (step * step).sum(axis=1)
    rows = square > SHORT**2
    if not rows.any():
        return 0.0
    bend = -(turn * step).sum(axis=1)[rows] / square[rows]
    sharpest = float(np.quantile(bend, SHARPEST))
    return 1.0 / sharpest if sharpest > 0.0 else 0.0


def _between(skin: Skin, first: Feature, second: Feature) -> float:
    """Return the least distance in mm of places on two blades' walls that face each other."""
    sides = []
    for f in (first, second):
        rows = np.unique(skin.triangles[skin.of(f.with_role(*WALLS))])
        sides.append((skin.points[rows], skin.normals[rows]))
    (point, normal), (other, facing) = sides
    away, near = cKDTree(other).query(point, k=min(NEAREST, len(other)))
    away, near = (np.asarray(a).reshape(len(point), -1) for a in (away, near))
    faces = (normal[:, None] * facing[near]).sum(axis=2) < FACING
    return float(np.where(faces, away, np.inf).min(initial=np.inf))


def through_channel(tools: Sequence[Tool], sizes: WheelSizes, allowance: float) -> Tool | None:
    """Return the largest tapered ball that goes through the narrowest place with an allowance on both sides, with flutes as long as the
    blades are high; of equal ones the shortest."""
    return _largest(tools, min(sizes.channel - 2.0 * allowance, np.inf), sizes.height + OVER)


def on_walls(tools: Sequence[Tool], sizes: WheelSizes, allowance: float) -> Tool | None:
    """Return the largest tapered ball that goes through the narrowest channel, and down to the rims of the root fillets: no larger than
    they are."""
    fillet = 2.0 * (sizes.fillet + ROUND) if sizes.fillet > 0.0 else np.inf
    return _largest(tools, min(sizes.channel - 2.0 * allowance, fillet), sizes.height + OVER)


def in_fillet(tools: Sequence[Tool], sizes: WheelSizes) -> Tool | None:
    """Return the largest tapered ball that goes into the root fillets with room to turn in them, and through the narrowest channel."""
    return _largest(
        tools,
        min(2.0 * SMALLER * sizes.fillet if sizes.fillet > 0.0 else np.inf, sizes.channel),
        sizes.height + OVER,
    )


def on_hub(tools: Sequence[Tool], sizes: WheelSizes) -> Tool | None:
    """Return the largest tapered ball that is no larger than the root fillets and the narrowest channel: it goes up to their toes."""
    return _largest(
        tools,
        min(2.0 * (sizes.fillet + ROUND) if sizes.fillet > 0.0 else np.inf, sizes.channel),
        sizes.height + OVER,
    )


def _largest(tools: Sequence[Tool], widest: float, deep: float) -> Tool | None:
    fits = [
        t
        for t in tools
        if t.form == "taper"
        and t.corner_radius == t.radius
        and t.diameter <= widest
        and t.flute_length >= deep
    ]
    return max(fits, key=lambda t: (t.diameter, -t.stickout, t.name), default=None)
