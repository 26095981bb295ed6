"""Bands of a pocket's bottom along the main axis: what stands in each, the free gaps around it, and how it is machined.

The bounds of all bosses and the ends of the bottom cut it into bands. No boss: turn. Bosses, and every free gap between neighbours long
enough: interrupted. Else mill.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from trunnion.recognize.casing.meridian import Meridian

TURN, INTERRUPTED, MILL = "turn", "interrupted", "mill"
SAME_HEIGHT = 1e-3
"""mm: bounds that differ by less are one: far below what any machine positions to, above the noise of a part that lies askew."""
FULL = 2.0 * np.pi

Needed = Callable[[str, str], float]
"""The arc length (mm) that a gap between two bosses must have at least."""


@dataclass(frozen=True, slots=True, kw_only=True)
class BossBox:
    """A boss as the rectangle that it takes of the unrolled bottom: angles (radians, high above low) and heights (mm)."""

    boss: str
    theta_low: float
    theta_high: float
    z_low: float
    z_high: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Gap:
    """A free gap of a band: from where boss `after` ends to where boss `before` begins, angles in radians,
    counted on from that boss's own beginning, which is from 0 to a whole turn.

    `arc` is its length at the band's mean radius, `needed` what it must have to be turned, mm.
    """

    after: str
    before: str
    theta: tuple[float, float]
    arc: float
    needed: float

    @property
    def long_enough(self) -> bool:
        """Whether it can be turned: a gap that is just as long as needed can."""
        return self.arc >= self.needed - SAME_HEIGHT


@dataclass(frozen=True, slots=True, kw_only=True)
class BottomBand:
    """A band between two heights (mm), with its mean radius (mm), the bosses in it and the gaps between them, both in order of angle."""

    z: tuple[float, float]
    mean_radius: float
    bosses: tuple[str, ...]
    gaps: tuple[Gap, ...]

    @property
    def kind(self) -> str:
        """How the band as a whole is machined."""
        if not self.bosses:
            return TURN
        return INTERRUPTED if self.gaps and all(g.long_enough for g in self.gaps) else MILL


def widened(box: BossBox, meridian: Meridian, by: float) -> BossBox:
    """Return a boss's rectangle with a margin (mm) on all sides; around the axis at the smallest radius that it reaches."""
    low, high = box.z_low - by, box.z_high + by
    radius = float(meridian.radius(np.array([low, high])).min())
    turn = by / radius if by else 0.0
    return BossBox(
        boss=box.boss,
        theta_low=box.theta_low - turn,
        theta_high=box.theta_high + turn,
        z_low=low,
        z_high=high,
    )


def bands_of(
    meridian: Meridian, boxes: Sequence[BossBox], needed: Needed
) -> tuple[BottomBand, ...]:
    """Return the bands of a bottom from its lower to its upper end."""
    first, last = meridian.ends
    bounds = [first, last]
    bounds += [z for b in boxes for z in (b.z_low, b.z_high) if first < z < last]
    cuts = _apart(bounds)
    return tuple(_band(meridian, boxes, needed, low, high) for low, high in pairwise(cuts))


def _apart(values: Sequence[float]) -> list[float]:
    """Return ascending values, those that are one once; the first and the last stay."""
    ordered = sorted(values)
    found = [ordered[0]]
    for value in ordered[1:]:
        if value - found[-1] > SAME_HEIGHT:
            found.append(value)
    if len(found) > 1:
        found[-1] = ordered[-1]
    return found


def _band(
    meridian: Meridian, boxes: Sequence[BossBox], needed: Needed, low: float, high: float
) -> BottomBand:
    inside = [b for b in boxes if b.z_low < high - SAME_HEIGHT and b.z_high > low + SAME_HEIGHT]
    ends = meridian.radius_inside(np.array([low, high]))
    radius = float(ends.mean())
    return BottomBand(
        z=(low, high),
        mean_radius=radius,
        bosses=tuple(sorted({b.boss for b in inside})),
        gaps=free_gaps(inside, radius, needed),
    )


def free_gaps(boxes: Sequence[BossBox], radius: float, needed: Needed) -> tuple[Gap, ...]:
    """Return the free gaps around the axis between rectangles, overlapping ones taken as one, in order of angle."""
    if not boxes:
        return ()
    turned = sorted(
        (
            (b.theta_low % FULL, b.theta_low % FULL + (b.theta_high - b.theta_low), b.boss)
            for b in boxes
        ),
    )
    spans = [(low, high, boss, boss) for low, high, boss in turned]
    # Once more round, so that what goes on over zero is merged with what it reaches there.
    spans += [(low + FULL, high + FULL, first, last) for low, high, first, last in spans]
    reach, last, lap = spans[0][1], spans[0][3], 0.0
    gaps: list[Gap] = []
    for low, high, first, own in spans[1:]:
        if low > reach + SAME_HEIGHT / radius:
            begin = reach - lap
            gaps.append(
                Gap(
                    after=last,
                    before=first,
                    theta=(begin, begin + low - reach),
                    arc=(low - reach) * radius,
                    needed=needed(last, first),
                )
            )
        if high > reach:
            reach, last, lap = high, own, FULL if low >= FULL else 0.0
    distinct: dict[tuple[str, str, int], Gap] = {}
    for gap in gaps:
        distinct.setdefault((gap.after, gap.before, round(gap.theta[0] % FULL * 1e6)), gap)
    return tuple(sorted(distinct.values(), key=lambda g: g.theta))
