"""The foot of a boss on its ground: the curve in which its sides, extended against its direction, meet the ground, and its bounds.

With the fillet the toe counts: a ball of the fillet's radius f rolls along side and ground; its centre lies on the outline grown by f and
on the ground raised by f, r = rho + f sqrt(1 + k^2), and it touches the ground f below along the ground's normal.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from trunnion.geometry.arrays import Floats
from trunnion.recognize.casing.meridian import Meridian
from trunnion.recognize.casing.outline import BossOutline, OutlinePiece
from trunnion.tolerance import ANGLE, COINCIDENT

GRID = np.linspace(0.0, 1.0, 65)
ZOOM = np.linspace(-1.0, 1.0, 17)
ROUNDS = 4
"""Times that the surroundings of an extreme are looked at eight times finer: to four millionths of a piece; what it is off there goes
with the square of that, far below a micrometre."""
NEAR = 0.1
"""mm: pieces whose best point of the grid comes so near to the best of all are looked at: a grid's error on a circle of 200 mm."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FootBounds:
    """The rectangle around a foot: angles about the main axis (radians, high above low) and heights (mm)."""

    theta_low: float
    theta_high: float
    z_low: float
    z_high: float


def foot_curve(
    outline: BossOutline, piece: OutlinePiece, meridian: Meridian, share: Floats, toe: bool
) -> Floats:
    """Return points (k, 3) of the foot under a piece of the outline at shares (k,) of its length; NaN where it misses the ground."""
    grown = piece.fillet if toe else 0.0
    plane = piece.at(share) + grown * piece.outward(share)
    points = outline.space(plane)
    down = meridian.foot(points, outline.frame.z, grown)
    found = points - down[:, None] * outline.frame.z
    if grown:
        found = _toe_points(found, meridian, grown)
    return np.asarray(found)


def _toe_points(centre: Floats, meridian: Meridian, radius: float) -> Floats:
    """Return where balls of a radius above the ground touch it."""
    normal = meridian.normal(centre[:, 2])
    away = centre[:, :2] / np.maximum(np.linalg.norm(centre[:, :2], axis=1), COINCIDENT)[:, None]
    return np.asarray(centre - radius * np.column_stack([normal[:, :1] * away, normal[:, 1]]))


def bounds(outline: BossOutline, meridian: Meridian, toe: bool = False) -> FootBounds:
    """Return the bounds of a foot: the extremes of its curve. Where something higher cuts the boss it reaches the ground's end there."""
    pieces = [p for p in outline.pieces if p.side >= 0]
    if toe:
        pieces += _corners(outline.pieces)
    if not pieces:
        pieces = list(outline.pieces)
    middle = foot_middle(outline, meridian)
    zero = float(np.arctan2(middle[1], middle[0]))

    def values(piece: OutlinePiece, share: Floats) -> Floats:
        point = foot_curve(outline, piece, meridian, share, toe)
        angle = np.arctan2(point[:, 1], point[:, 0]) - zero
        return np.column_stack([(angle + np.pi) % (2.0 * np.pi) - np.pi, point[:, 2]])

    rough = [values(p, GRID) for p in pieces]
    reach = float(np.hypot(*middle[:2])) or 1.0
    extremes = [
        _extreme(pieces, rough, values, axis, sign, NEAR / reach if axis == 0 else NEAR)
        for axis in (0, 1)
        for sign in (-1.0, 1.0)
    ]
    theta_low, theta_high, z_low, z_high = extremes
    for cut in (p for p in outline.pieces if p.side < 0):
        height = float(outline.space(cut.at(np.array([0.5])))[0, 2])
        first, last = meridian.ends
        if abs(height - first) < abs(height - last):
            z_low = first
        else:
            z_high = last
    return FootBounds(
        theta_low=zero + theta_low, theta_high=zero + theta_high, z_low=z_low, z_high=z_high
    )


def foot_middle(outline: BossOutline, meridian: Meridian) -> Floats:
    """Return the point (3,) of the ground under the middle of the outline."""
    middle = outline.frame.origin[None]
    down = meridian.foot(middle, outline.frame.z)
    return np.asarray(middle[0] - np.nan_to_num(down[0]) * outline.frame.z)


def _extreme(
    pieces: Sequence[OutlinePiece],
    rough: Sequence[Floats],
    values: Callable[[OutlinePiece, Floats], Floats],
    axis: int,
    sign: float,
    near: float,
) -> float:
    """Return the largest (sign +1) or smallest value along an axis over all pieces, each looked at ever finer around its best point."""
    with_points = [n for n, r in enumerate(rough) if np.isfinite(r[:, axis]).any()]
    best = {n: float(np.nanmax(sign * rough[n][:, axis])) for n in with_points}
    most = max(best.values(), default=0.0)
    found = most
    for n in with_points:
        if best[n] < most - near:
            continue
        at, width = GRID[int(np.nanargmax(sign * rough[n][:, axis]))], GRID[1]
        for _ in range(ROUNDS):
            share = at + width * ZOOM
            if not pieces[n].is_whole:
                share = np.clip(share, 0.0, 1.0)
            value = sign * values(pieces[n], share)[:, axis]
            k = int(np.nanargmax(value))
            at, width = share[k], width / 8.0
            found = max(found, float(value[k]))
    return sign * found


def _corners(pieces: Sequence[OutlinePiece]) -> list[OutlinePiece]:
    """Return arcs of no size at the sharp outer corners between pieces with a fillet: the ball rolls round them."""
    found = []
    for a, b in zip(pieces, (*pieces[1:], *pieces[:1]), strict=True):
        first, second = a.outward(np.array([1.0]))[0], b.outward(np.array([0.0]))[0]
        turn = float(np.arctan2(first[0] * second[1] - first[1] * second[0], first @ second))
        fillet = min(a.fillet, b.fillet)
        if fillet > 0.0 and turn > ANGLE:
            found.append(
                OutlinePiece(
                    start=a.end + COINCIDENT * first,
                    end=a.end + COINCIDENT * second,
                    side=a.side,
                    centre=a.end,
                    radius=COINCIDENT,
                    turn=turn,
                    fillet=fillet,
                )
            )
    return found
