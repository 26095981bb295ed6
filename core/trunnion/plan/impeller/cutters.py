"""Which cutters an impeller is milled with: by the narrowest place between blades, the root fillets and the blades' height."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
from scipy.spatial import cKDTree

from trunnion import tolerance
from trunnion.geometry.arrays import Floats
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
WORTHWHILE = 0.75
"""Of the time to rough with one cutter: a second one that does not get below it is not worth its change and its entries."""
SLIM = 0.3
"""mm by which a shank may be thicker than the flutes end: less than any allowance that roughing leaves on both sides."""
NEAREST = 12
"""Places on the other wall that are looked at for one that faces."""


@dataclass(frozen=True, slots=True, kw_only=True)
class WheelSizes:
    """What bounds the cutters, mm: the narrowest `channel`, the smallest root `fillet` (0: none), the largest `height` of blades. `widths`
    (k, 2): how wide channels are at places of the walls, and the share of the walls that each place stands for."""

    channel: float
    fillet: float
    height: float
    widths: Floats = field(default_factory=lambda: np.zeros((0, 2)))

    def share_of(self, width: float) -> float:
        """Return the share of the channels that is at least so many mm wide."""
        return float(self.widths[self.widths[:, 0] >= width, 1].sum())


def sizes_of(wheel: Wheel, skin: Skin) -> WheelSizes:
    """Return the sizes of a wheel, from a skin in the rotor's frame."""
    pairs = zip(
        wheel.blades[: wheel.period],
        (*wheel.blades[1 : wheel.period], wheel.blades[wheel.period % len(wheel.blades)]),
        strict=True,
    )
    widths = np.vstack([_between(skin, a, b) for a, b in pairs])
    if len(widths):
        widths[:, 1] /= widths[:, 1].sum()
    return WheelSizes(
        channel=float(widths[:, 0].min(initial=np.inf)),
        fillet=min(
            (_roundness(skin, f.with_role(*ROOT)) for f in wheel.blades[: wheel.period]),
            default=0.0,
        ),
        height=float(wheel.meridian.height(np.linspace(0.0, 1.0, 33)).max()),
        widths=widths,
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


def _between(skin: Skin, first: Feature, second: Feature) -> Floats:
    """Return rows (k, 2) of how far in mm places of a blade's walls are from what faces them on the other blade, and the mm2 that each of
    them stands for."""
    sides = []
    for f in (first, second):
        triangles = skin.triangles[skin.of(f.with_role(*WALLS))]
        corners = skin.points[triangles]
        area = np.linalg.norm(
            np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
        )
        # A third of half the product of its sides goes to each corner of a triangle.
        whole = np.bincount(triangles.ravel(), np.repeat(area / 6.0, 3), len(skin.points))
        rows = np.unique(triangles)
        sides.append((skin.points[rows], skin.normals[rows], whole[rows]))
    (point, normal, area), (other, facing, _) = sides
    away, near = cKDTree(other).query(point, k=min(NEAREST, len(other)))
    away, near = (np.asarray(a).reshape(len(point), -1) for a in (away, near))
    faces = (normal[:, None] * facing[near]).sum(axis=2) < FACING
    width = np.where(faces, away, np.inf).min(axis=1, initial=np.inf)
    known = np.isfinite(width)
    return np.column_stack([width[known], area[known]])


def through_channel(tools: Sequence[Tool], sizes: WheelSizes, allowance: float) -> Tool | None:
    """Return the largest tapered ball that goes through the narrowest place with an allowance on both sides, with flutes as long as the
    blades are high; of equal ones the shortest."""
    return _largest(tools, min(sizes.channel - 2.0 * allowance, np.inf), sizes.height + OVER)


def in_wide_parts(
    tools: Sequence[Tool],
    sizes: WheelSizes,
    allowance: float,
    narrow: Tool,
    removal: Callable[[Tool], float],
) -> Tool | None:
    """Return the tapered ball that saves most when it goes first wherever it fits, before a `narrow` one; None where none saves a quarter.

    `removal` says what a cutter takes off in a minute. A wide one takes the share s of the channels at its own rate, the narrow one the
    rest: s r(narrow) / r(wide) + 1 - s of the narrow one's time alone.
    """
    best, least = None, WORTHWHILE
    for tool in sorted(tools, key=lambda t: (t.stickout, t.name)):
        if not _is_deep_ball(tool, sizes.height + OVER) or tool.diameter <= narrow.diameter:
            continue
        share = sizes.share_of(tool.diameter + 2.0 * allowance)
        time = share * removal(narrow) / removal(tool) + 1.0 - share
        if time < least - tolerance.PARAMETRIC:
            best, least = tool, time
    return best


def on_walls(tools: Sequence[Tool], sizes: WheelSizes, allowance: float) -> Tool | None:
    """Return the largest tapered ball that goes through the narrowest channel, and down to the rims of the root fillets: no larger than
    they are."""
    fillet = 2.0 * (sizes.fillet + ROUND) if sizes.fillet > 0.0 else np.inf
    return _largest(tools, min(sizes.channel - 2.0 * allowance, fillet), sizes.height + OVER)


def in_fillet(tools: Sequence[Tool], sizes: WheelSizes) -> Tool | None:
    """Return the largest tapered ball that goes into the root fillets with room to turn in them, and through the narrowest channel.

    Nothing but its ball cuts there: where no flutes are as long as the blades are high, a shank no thicker than they are goes down with
    them.
    """
    widest = min(2.0 * SMALLER * sizes.fillet if sizes.fillet > 0.0 else np.inf, sizes.channel)
    deep = sizes.height + OVER
    slim = [t for t in tools if t.shank_diameter <= min(_flute_end(t) + SLIM, sizes.channel)]
    return _largest(tools, widest, deep) or _largest(slim, widest, deep, by_shank=True)


def on_hub(tools: Sequence[Tool], sizes: WheelSizes) -> Tool | None:
    """Return the largest tapered ball that is no larger than the root fillets and the narrowest channel: it goes up to their toes."""
    return _largest(
        tools,
        min(2.0 * (sizes.fillet + ROUND) if sizes.fillet > 0.0 else np.inf, sizes.channel),
        sizes.height + OVER,
    )


def _largest(
    tools: Sequence[Tool], widest: float, deep: float, *, by_shank: bool = False
) -> Tool | None:
    fits = [t for t in tools if t.diameter <= widest and _is_deep_ball(t, deep, by_shank=by_shank)]
    return max(fits, key=lambda t: (t.diameter, -t.stickout, t.name), default=None)


def _is_deep_ball(tool: Tool, deep: float, *, by_shank: bool = False) -> bool:
    """Return whether a cutter is a tapered ball with flutes of so many mm at least; `by_shank` what stands out of the holder counts."""
    length = tool.stickout if by_shank else tool.flute_length
    return tool.form == "taper" and tool.corner_radius == tool.radius and length >= deep


def _flute_end(tool: Tool) -> float:
    """Return how thick in mm a tapered ball is where its flutes end."""
    rise = math.tan(math.radians(tool.taper_angle))
    return 2.0 * (tool.radius + rise * (tool.flute_length - tool.corner_radius))
