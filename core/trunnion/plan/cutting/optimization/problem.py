"""The problem of choosing spindle speed and feed per tooth: objectives, constraints, and what each point comes to.

Objectives of Yu et al. (2020), Optimisation of cutting parameters, after Ai and Xiao, Concise handbook of cutting parameters (1994):

    t = t0 + tm + tc tm / T            min;  tm = L / (fz Z n)
    C = t c0 + (tm / T) ct + cs fz^a n^b
    M = t / t_min + C / C_min - 2      t_min, C_min: each optimum alone

Every constraint is a power law of the feed per tooth at a given spindle speed, as forces by Kienzle and by the handbook, feeds and feed
marks all are: so the largest feed that keeps all of them is known in closed form.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats

OfSpeed = Callable[[Floats], Floats]
"""Something by spindle speeds (n,) 1/min."""
BINDS = 0.999
"""Share of a limit from which it counts as what stops the optimum."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Economics:
    """Times in min, costs in money: `auxiliary` t0 of the operation, `change` tc of a worn tool, `rate` c0 a minute, `tool` ct of a tool's
    life; `by_data` cs, `feed_exponent` a and `speed_exponent` b of the cost by feed and speed that the paper adds."""

    auxiliary: float = 0.0
    change: float = 0.0
    rate: float = 0.0
    tool: float = 0.0
    by_data: float = 0.0
    feed_exponent: float = 0.0
    speed_exponent: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Constraint:
    """A limit: `unit_share` is the value over its limit at a feed per tooth of 1 mm, by spindle speed; it goes with the feed's power
    `exponent`, above 0. A share of 1 is allowed, more is not."""

    name: str
    exponent: float
    unit_share: OfSpeed

    def share(self, spindle: Floats, feed: Floats) -> Floats:
        """Return the value over its limit (n,) at spindle speeds (n,) 1/min and feeds per tooth (n,) mm."""
        return np.asarray(self.unit_share(spindle) * feed**self.exponent)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CuttingProblem:
    """One operation's choice: ranges of spindle speed (1/min) and feed per tooth (mm), constraints, and the objectives of a way of `length`
    mm with `teeth`; `life` is the tool's life in min by spindle speed; `load` is the constraint that counts as load of the spindle.

    `handbook` is the point (spindle, feed per tooth) of the tables. Problems of one `identity`, where it is given, have one solution.
    """

    length: float
    teeth: int
    spindle: tuple[float, float]
    feed: tuple[float, float]
    life: OfSpeed
    economics: Economics
    constraints: tuple[Constraint, ...]
    handbook: tuple[float, float]
    spindle_bounds: tuple[str, str] = ("spindle speed", "spindle speed")
    feed_bounds: tuple[str, str] = ("chip thickness", "chip thickness")
    load: str = ""
    identity: Hashable = None

    def time(self, spindle: ArrayLike, feed: ArrayLike) -> Floats:
        """Return the times t (n,) in min."""
        n, fz = np.asarray(spindle, float), np.asarray(feed, float)
        cutting = self.length / (fz * self.teeth * n)
        e = self.economics
        return np.asarray(e.auxiliary + cutting * (1.0 + e.change / self.life(n)))

    def cost(self, spindle: ArrayLike, feed: ArrayLike) -> Floats:
        """Return the costs C (n,) in money."""
        n, fz = np.asarray(spindle, float), np.asarray(feed, float)
        cutting = self.length / (fz * self.teeth * n)
        e = self.economics
        by_data = e.by_data * fz**e.feed_exponent * n**e.speed_exponent if e.by_data else 0.0
        return np.asarray(self.time(n, fz) * e.rate + cutting / self.life(n) * e.tool + by_data)

    def shares(self, spindle: ArrayLike, feed: ArrayLike) -> Floats:
        """Return every constraint's value over its limit (k, n)."""
        n, fz = np.atleast_1d(np.asarray(spindle, float)), np.atleast_1d(np.asarray(feed, float))
        if not self.constraints:
            return np.zeros((0, len(n)))
        return np.stack([c.share(n, fz) for c in self.constraints])

    def largest_feed(self, spindle: Floats) -> Floats:
        """Return the largest feed per tooth (n,) mm that keeps all constraints, within its range; NaN where even the smallest does not."""
        top = np.full(len(spindle), self.feed[1])
        for c in self.constraints:
            top = np.minimum(top, c.unit_share(spindle) ** (-1.0 / c.exponent))
        # The smallest feed itself keeps a limit that it comes to but for rounding.
        bottom = self.feed[0] * (1.0 - tolerance.PARAMETRIC)
        return np.where(top >= bottom, np.maximum(top, self.feed[0]), np.nan)

    def feed_between(self, spindle: Floats, step: Floats) -> Floats:
        """Return feeds per tooth (n,) mm between the smallest (step 0) and the largest that keeps all constraints (step 1), in equal
        ratios; the smallest where even that does not keep them."""
        largest = self.largest_feed(spindle)
        span = np.where(np.isfinite(largest), largest / self.feed[0], 1.0)
        return np.asarray(np.where(step == 1.0, self.feed[0] * span, self.feed[0] * span**step))

    def is_feasible(self, spindle: ArrayLike, feed: ArrayLike) -> Bools:
        """Return whether points (n,) keep their ranges and all constraints."""
        n, fz = np.atleast_1d(np.asarray(spindle, float)), np.atleast_1d(np.asarray(feed, float))
        slack = 1.0 + tolerance.PARAMETRIC
        inside = np.ones(len(n), bool)
        for value, (low, high) in ((n, self.spindle), (fz, self.feed)):
            inside &= (value >= low / slack) & (value <= high * slack)
        return np.asarray(inside & (self.shares(n, fz) <= slack).all(axis=0))

    def binding(self, spindle: float, feed: float) -> tuple[str, ...]:
        """Return what stops a point from being quicker: constraints at their limits and ends of the ranges; none where wear does."""
        found = [
            c.name
            for c, share in zip(self.constraints, self.shares(spindle, feed)[:, 0], strict=True)
            if share >= BINDS
        ]
        if feed >= BINDS * self.feed[1]:
            found.append(self.feed_bounds[1])
        if spindle >= BINDS * self.spindle[1]:
            found.append(self.spindle_bounds[1])
        return tuple(dict.fromkeys(found))


@dataclass(frozen=True, slots=True, kw_only=True)
class Optimum:
    """The chosen point: spindle 1/min, feed per tooth mm; time min and cost money there, M, and the least time and cost, each alone."""

    spindle: float
    feed: float
    time: float
    cost: float
    objective: float
    least_time: float
    least_cost: float


def weighted(
    time: ArrayLike, cost: ArrayLike, least_time: float, least_cost: float, weight: float
) -> Floats:
    """Return the weighted objective (n,): 2 w t / t_min + 2 (1 - w) C / C_min - 2, at a weight of 0.5 the paper's M."""
    return np.asarray(
        2.0 * weight * np.asarray(time) / least_time
        + 2.0 * (1.0 - weight) * np.asarray(cost) / least_cost
        - 2.0
    )


def optimum_at(
    problem: CuttingProblem,
    spindle: float,
    feed: float,
    least_time: float,
    least_cost: float,
    weight: float,
) -> Optimum:
    """Return a point as an optimum, with what it comes to."""
    time, cost = float(problem.time(spindle, feed)), float(problem.cost(spindle, feed))
    return Optimum(
        spindle=spindle,
        feed=feed,
        time=time,
        cost=cost,
        objective=float(weighted(time, cost, least_time, least_cost, weight)),
        least_time=least_time,
        least_cost=least_cost,
    )
