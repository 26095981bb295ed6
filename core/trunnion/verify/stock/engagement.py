"""How much of a cutter's circumference is in material on the way, and how deep: where to look, and what the counts mean.

The compiled loops (`kernels/stock/engagement.py`) count, tile by tile, which directions of the cutter's front are in material;
counts of tiles are added, so the result is the same for any number of them. Of the rings the widest counts that
is no higher than half the depth of the material there: the circle at which a rounded end cuts on average.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Floats, Ints
from trunnion.model.tool import PLAIN_FORMS, Tool
from trunnion.verify.cutter import outline_of
from trunnion.verify.kernels.stock.engagement import FLUTE_STEPS, RINGS
from trunnion.verify.motion import Moves

DIRECTIONS = 45
"""Directions over the front half of a circle, 4 degrees apart: about a cell of 0.5 mm on a cutter of 16 mm."""
APART = 0.5
"""Distance of probes along a move, in radii."""
MOST_PROBES = 16
"""Most probes of a move, however long it is."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Probes:
    """Where to look: start (n + 1,) the first probe of each move (none for rapids); circle (m, 2) cosines and sines of the front's
    directions; rings (t, RINGS, 2) radius and height of each tool's; flute (t, s, 2) radius and height along its flutes."""

    start: Ints
    circle: Floats
    rings: Floats
    flute: Floats


@dataclass(frozen=True, slots=True, eq=False)
class Tally:
    """What was seen: counted (p, RINGS) directions in material at each probe; spans (p, 2) lowest and highest material from the tip, mm."""

    counted: Ints
    spans: Floats

    @staticmethod
    def empty(probes: int) -> Tally:
        """Return a tally of nothing seen."""
        return Tally(np.zeros((probes, RINGS), np.int64), np.tile([np.inf, -np.inf], (probes, 1)))

    def plus(self, other: Tally) -> Tally:
        """Return what two tiles have seen together."""
        low, high = (
            np.minimum(self.spans[:, 0], other.spans[:, 0]),
            np.maximum(self.spans[:, 1], other.spans[:, 1]),
        )
        return Tally(self.counted + other.counted, np.column_stack([low, high]))


@dataclass(frozen=True, slots=True, eq=False)
class Engagement:
    """A row a move: largest (n,) and mean (n,) angle of the circumference in material, rad, 0 for rapids and in air; depth (n,) the
    largest depth of the material along the axis, mm; widest (n,) mm how wide the cut is, from the cutter's side, over the diameter's length
    where it is widest, and peak (n,) how many times as wide as on the mean of the path, 1 in air."""

    largest: Floats
    mean: Floats
    depth: Floats
    widest: Floats
    peak: Floats


def probes_of(moves: Moves) -> Probes:
    """Return where to look along some moves: at the end of each feed move, and every half radius before it on long ones."""
    angles = (np.arange(DIRECTIONS) + 0.5) / DIRECTIONS * math.pi - math.pi / 2
    rings = np.array([rings_of(tool) for tool in moves.tools]).reshape(-1, RINGS, 2)
    flute = np.array([flute_of(tool) for tool in moves.tools]).reshape(-1, FLUTE_STEPS, 2)
    apart = APART * np.array([tool.core_radius for tool in moves.tools])[moves.tool]
    count = np.where(
        moves.rapid, 0, np.clip(np.ceil(moves.length / np.maximum(apart, 1e-9)), 1, MOST_PROBES)
    ).astype(np.int64)
    return Probes(
        start=np.concatenate([[0], np.cumsum(count)]),
        circle=np.column_stack([np.cos(angles), np.sin(angles)]),
        rings=rings,
        flute=flute,
    )


def engagement_of(probes: Probes, tally: Tally, moves: Moves) -> Engagement:
    """Return what the counts at the probes say about each move."""
    n, owner = len(moves), np.repeat(np.arange(len(moves)), np.diff(probes.start))
    # What stands over the flutes, as over the disc of a T-slot cutter, is not cut.
    flutes = np.array([tool.flute_length for tool in moves.tools])[moves.tool] if n else np.zeros(0)
    lowest, highest = tally.spans[:, 0], np.minimum(tally.spans[:, 1], flutes[owner])
    seen = highest > lowest
    deep = np.where(seen, highest - np.where(seen, lowest, 0.0), 0.0)
    # The widest ring at most half as high as the material is deep; where none is, the lowest.
    height = probes.rings[moves.tool[owner], :, 1]
    row = np.minimum((height > 0.5 * deep[:, None]).sum(axis=1), RINGS - 1)
    angle = tally.counted[np.arange(len(owner)), row] * (math.pi / len(probes.circle))
    largest, depth = np.zeros(n), np.zeros(n)
    np.maximum.at(largest, owner, angle)
    np.maximum.at(depth, owner, deep)
    count = np.maximum(np.diff(probes.start), 1)
    return Engagement(
        largest, np.bincount(owner, angle, n) / count, depth, *_widest(probes, moves, owner, angle)
    )


def _widest(probes: Probes, moves: Moves, owner: Ints, angle: Floats) -> tuple[Floats, Floats]:
    """Return how wide the cut of each move is over a diameter's length where it is widest (n,) mm, and how many times as wide as on the
    mean of the move that is (n,)."""
    n, count = len(moves), np.maximum(np.diff(probes.start), 1)
    diameter = (
        np.array([tool.core_diameter for tool in moves.tools])[moves.tool] if n else np.zeros(0)
    )
    several = np.clip(np.ceil(diameter * count / np.maximum(moves.length, 1e-9)), 1, count).astype(
        np.int64
    )
    # A cutter engaged from its side over an angle cuts a width in proportion to 1 - cos.
    width = np.concatenate([[0.0], np.cumsum(1.0 - np.cos(angle))])
    last = np.maximum(np.arange(len(owner)) + 1, probes.start[owner] + several[owner])
    around = (width[last] - width[last - several[owner]]) / several[owner]
    widest, mean = np.zeros(n), (width[probes.start[1:]] - width[probes.start[:-1]]) / count
    np.maximum.at(widest, owner, around)
    return 0.5 * diameter * widest, np.divide(
        widest, mean, out=np.ones(n), where=mean > tolerance.PARAMETRIC
    )


def rings_of(tool: Tool) -> list[tuple[float, float]]:
    """Return radius and height of a tool's rings: its widest circle, as low as it is, and three below it."""
    spans = outline_of(tool)
    height = _widest_height(tool)
    return [
        (
            tool.radius
            if k == 0 and tool.form in PLAIN_FORMS
            else _radius_at(spans, height / 4**k),
            height / 4**k,
        )
        for k in range(RINGS)
    ]


def flute_of(tool: Tool) -> list[tuple[float, float]]:
    """Return radius and height at even steps along a tool's flutes."""
    spans = outline_of(tool)
    heights = (np.arange(FLUTE_STEPS) + 0.5) / FLUTE_STEPS * tool.flute_length
    return [(_radius_at(spans, float(h)), float(h)) for h in heights]


def _widest_height(tool: Tool) -> float:
    """Return the lowest height at which a cutter is as wide as it gets."""
    best, at = 0.0, 0.0
    for r0, z0, r1, z1, cr, cz, radius in outline_of(tool):
        bulges = radius > 0.0 and min(z0, z1) < cz < max(z0, z1)
        for r, z in ((r0, z0), (cr + radius, cz) if bulges else (r1, z1), (r1, z1)):
            if r > best + 1e-9:
                best, at = r, z
    return at


def _radius_at(
    spans: Sequence[tuple[float, float, float, float, float, float, float]], height: float
) -> float:
    """Return the largest radius of an outline at a height."""
    best = 0.0
    for r0, z0, r1, z1, cr, cz, radius in spans:
        if not min(z0, z1) <= height <= max(z0, z1):
            continue
        if radius:
            best = max(
                best,
                cr + math.copysign(math.sqrt(max(radius**2 - (height - cz) ** 2, 0.0)), radius),
            )
        elif z0 == z1:
            best = max(best, r0, r1)
        else:
            best = max(best, r0 + (r1 - r0) * (height - z0) / (z1 - z0))
    return best
