"""Links over a wheel's blank: out along the axis until all of the tool is clear of it, across, and in along the next axis.

The blank is all that can stand there: where no part of the tool is inside of it nothing has to be known of what is cut. Between two poses
the tip goes straight and the axis turns evenly; every pose on the way is looked at, no two of them far apart.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from trunnion.geometry.arrays import Bools, Floats
from trunnion.geometry.sphere import angle_between
from trunnion.toolpath.contact_passes.blank_clearance import Outside
from trunnion.toolpath.contact_passes.contacts import slerp

LIFTS = np.array([0.0, 2.0, 4.0, 7.0, 10.0, 14.0, 18.0, 23.0, 28.0, 35.0, 45.0, 60.0])
"""mm along the axis that are tried to get clear of the blank."""
HIGHER = (0.0, 6.0, 15.0)
"""mm more that both ends of a link are lifted by where its way is not clear."""
STEP, TURN = 3.0, math.radians(3.0)
"""Largest way of the tip in mm and turn of the axis between two poses of a link."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ClearanceLink:
    """The poses of a link (k, 3), (k, 3): the first above the end of one pass, the last above the start of the next."""

    tip: Floats
    axis: Floats


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ClearanceLinks:
    """Links of a tool over a blank: `outside` says where all of the tool is clear of it, `holds` which axes the machine can hold."""

    outside: Outside
    holds: Outside

    def between(
        self,
        ends: tuple[Floats, Floats],
        starts: tuple[Floats, Floats],
    ) -> list[ClearanceLink | None]:
        """Return the links from tips with axes (n, 3) to others; None where the air between is not clear."""
        found: list[ClearanceLink | None] = [None] * len(ends[0])
        lifts = [self._lifts(*poses) for poses in (ends, starts)]
        for higher in HIGHER:
            rows = [
                k
                for k in range(len(found))
                if found[k] is None and np.isfinite(lifts[0][k] + lifts[1][k])
            ]
            links = [
                _way(
                    ends[0][k] + (lifts[0][k] + higher) * ends[1][k],
                    ends[1][k],
                    starts[0][k] + (lifts[1][k] + higher) * starts[1][k],
                    starts[1][k],
                )
                for k in rows
            ]
            for k, way, clear in zip(rows, links, self._clear(links), strict=True):
                found[k] = way if clear else None
        return found

    def _lifts(self, tip: Floats, axis: Floats) -> Floats:
        """Return how far (n,) mm tools are fed out until they stay clear of the blank; infinite where they don't."""
        n, m = len(tip), len(LIFTS)
        lifted = tip[:, None] + LIFTS[:, None] * axis[:, None]
        clear = self.outside(lifted.reshape(-1, 3), np.repeat(axis, m, axis=0)).reshape(n, m)
        # Clear from some lift on: the last one that is not decides.
        blocked = np.where(clear, -1, np.arange(m)).max(axis=1)
        return np.where(blocked + 1 < m, LIFTS[np.minimum(blocked + 1, m - 1)], np.inf)

    def _clear(self, links: Sequence[ClearanceLink]) -> list[bool]:
        if not links:
            return []
        tip, axis = (np.vstack([getattr(w, name) for w in links]) for name in ("tip", "axis"))
        clear: Bools = self.outside(tip, axis)
        clear &= self.holds(tip, axis)
        ends = np.cumsum([len(w.tip) for w in links])
        return [bool(part.all()) for part in np.split(clear, ends[:-1])]


def _way(start: Floats, start_axis: Floats, end: Floats, end_axis: Floats) -> ClearanceLink:
    """Return the poses from one to another, both among them."""
    turn = float(angle_between(start_axis[None], end_axis[None])[0])
    far = float(np.linalg.norm(end - start))
    count = max(1, math.ceil(far / STEP), math.ceil(turn / TURN))
    share = np.linspace(0.0, 1.0, count + 1)
    return ClearanceLink(
        tip=start + share[:, None] * (end - start),
        axis=slerp(
            np.repeat(start_axis[None], count + 1, axis=0),
            np.repeat(end_axis[None], count + 1, axis=0),
            share,
        ),
    )
