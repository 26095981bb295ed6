"""Lays passes at constant engagement over an area until nothing is left that the cutter reaches without passing the angle.

One rule lays them all: the cutter keeps the material at its right (it climbs), as far to the right as the angle of contact allows, and
where there is no material the wall. From a helix in the middle this gives a spiral; where the spiral meets walls it runs along them, and
what stands in corners and channels is taken by crescents, each begun where the one before met material. In a channel hardly wider than the
cutter the crescents are the loops of trochoidal milling.

The next position is on the line of equal engagement, and of all headings the one that goes on along it is taken. That the angle is never
passed doesn't depend on how the passes are begun.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from trunnion.geometry.arrays import Floats, Ints
from trunnion.plan.cutting.milling import FILM
from trunnion.progress import Progress
from trunnion.toolpath.constant_engagement.cleared_area import ClearedArea, Remaining

STEP = 1.0 / 12.0
"""Radii that a march goes at once."""

RIGHT_TURN = 0.5
"""Radii of the tightest turn towards the material."""

RUN_IN = 0.5
"""Radii that a pass begins before it meets material."""

RUN_OUT = 0.1
"""Radii that a pass goes on behind the last material."""

IDLE_BEFORE = 5.0
"""Radii that the next crescent's start may be before its material: from farther away a link is quicker than a feed."""

IDLE_AFTER = 0.7
"""Radii without material that end a pass."""

SCOUTED = 25.0
"""Radii along walls and edges that the next material is looked for before the whole area is."""

CONTACT = 0.05
"""Radii: a cutter that is as much wider touches what the true one is beside."""

UPSTREAM = 60.0
"""Radii that a front is followed against the passes' direction to where it begins."""

SMALLEST_REST = 0.02
"""Squares of the radius: a place with less to stand on is left to the pass along the wall."""

LOST = 3
"""Starts on one place that may meet nothing before it is left."""


@dataclass(frozen=True, slots=True, eq=False)
class EngagedPass:
    """A pass by positions (k, 2) of the axis, a heading (k,) rad and the engagement (k,) rad at each.

    Where `centre` (2,) is given the cutter goes down into full material, by a helix about it that ends at the first position. `straight`:
    it comes straight from the end of the pass before through what is cleared by then.
    """

    points: Floats
    heading: Floats
    engagement: Floats
    centre: Floats | None = None
    straight: bool = False


def engaged_passes(
    area: ClearedArea,
    angle: float,
    helix_radius: Callable[[float], float],
    progress: Progress,
) -> list[EngagedPass]:
    """Return the passes over an area, in order, which clear it as they are laid; none where the cutter neither stands free nor enters.

    `angle` (rad) is the engagement that is kept; `helix_radius` gives the radius of the helix that the cutter enters by where the axis
    region is so deep (mm), 0 where it can't.
    """
    return _Laying(area, angle, helix_radius, progress).all()


class _Laying:
    """Passes in the making; `_ends` (3,) are positions and headings behind which more material may be found along the wall."""

    def __init__(
        self,
        area: ClearedArea,
        angle: float,
        helix_radius: Callable[[float], float],
        progress: Progress,
    ) -> None:
        self._area, self._angle, self._helix_radius = area, angle, helix_radius
        self._progress = progress
        self._least = math.acos(1.0 - FILM)
        self._passes: list[EngagedPass] = []
        self._ends: list[Floats] = []

    def all(self) -> list[EngagedPass]:
        lost: dict[tuple[int, int], int] = {}
        while True:
            start = self._next_start(lost)
            if start is None:
                return self._passes
            begin, centre = start
            count = len(self._passes)
            self._from(begin, centre)
            while self._ends:
                # What comes next along the wall behind the last pass is cut before what is elsewhere.
                self._from(self._ends.pop(), None, SCOUTED)
            if len(self._passes) == count:
                key = self._key(begin)
                lost[key] = lost.get(key, 0) + 1

    def _from(self, start: Floats, centre: Floats | None, idle: float = IDLE_BEFORE) -> None:
        """Lay passes from a start (3,: position, heading) until none meets material; each begins where the one before met it."""
        radius = self._area.radius
        while True:
            self._progress.check()
            straight = centre is None and self._comes_straight(start, idle * radius)
            path, _ = self._march(start, idle * radius)
            met = np.flatnonzero(path[:, 3] > self._least)
            if not len(met):
                return
            # A helix ends where the march begins: its circle is as large as the first position is far from its centre.
            first = _first_of(met) if centre is None else 0
            last = min(int(met[-1]) + 1 + round(RUN_OUT / STEP), len(path) - 1)
            self._add(path[first : last + 1], centre, straight)
            self._ends = [path[last, :3]]
            start, centre, idle = path[first, :3], None, IDLE_BEFORE

    def _comes_straight(self, start: Floats, idle: float) -> bool:
        """Return whether the cutter comes straight from the last pass to where a march from a start begins to count, before that is cut."""
        if not self._passes:
            return False
        path, _ = self._march(start, idle, cuts=False)
        met = np.flatnonzero(path[:, 3] > self._least)
        return bool(len(met)) and self._area.line_is_free(
            self._passes[-1].points[-1], path[_first_of(met), :2]
        )

    def _march(self, start: Floats, idle: float, *, cuts: bool = True) -> tuple[Floats, int]:
        """Return a march at the angle; one that doesn't cut ends a radius behind the first material at the latest."""
        radius = self._area.radius
        return self._area.march(
            start,
            self._angle,
            step=STEP * radius,
            turn=STEP / RIGHT_TURN,
            idle_before=idle,
            idle_after=IDLE_AFTER * radius,
            longest=self._longest() if cuts else idle + radius,
            least=self._least,
            cuts=cuts,
        )

    def _add(self, path: Floats, centre: Floats | None, straight: bool) -> None:
        self._passes.append(
            EngagedPass(
                points=self._area.held(path[:, :2]),
                heading=path[:, 2],
                engagement=path[:, 3],
                centre=centre,
                straight=straight,
            )
        )

    def _longest(self) -> float:
        """Return how long in mm a pass may be: as long as one that clears all of the area by layers of a twentieth of the radius."""
        area = float((self._area.depth >= 0.0).sum()) * self._area.cell**2
        return area / (0.05 * self._area.radius) + 100.0 * self._area.radius

    def _next_start(self, lost: dict[tuple[int, int], int]) -> tuple[Floats, Floats | None] | None:
        """Return where the next pass begins (3,) with the centre of the helix that leads there, if any; None when all is done."""
        for rest in self._area.remaining():
            if rest.area < SMALLEST_REST * self._area.radius**2:
                return None
            found = self._at_front(rest, lost) or self._entered(rest, lost)
            if found is not None:
                return found
        return None

    def _at_front(
        self, rest: Remaining, lost: dict[tuple[int, int], int]
    ) -> tuple[Floats, None] | None:
        """Return where the front of a place begins, seen along the passes, from the free position beside it that is nearest to the tool."""
        if not len(rest.fronts):
            return None
        radius = self._area.radius
        away = rest.fronts - rest.material
        size = np.linalg.norm(away, axis=1, keepdims=True)
        away = np.divide(away, size, out=np.zeros_like(away), where=size > 0.0)
        beside = rest.material + (radius + 2.0 * self._area.thin + 0.5 * self._area.cell) * away
        here = self._passes[-1].points[-1] if self._passes else beside[0]
        for row in np.argsort(np.linalg.norm(beside - here, axis=1), kind="stable")[::7]:
            if not self._area.is_free(beside[row]):
                continue
            # The material is at the right.
            heading = math.atan2(-away[row, 1], -away[row, 0]) + 0.5 * math.pi
            start = self._upstream(np.array([*beside[row], heading]))
            if lost.get(self._key(start), 0) < LOST:
                return start, None
        return None

    def _upstream(self, start: Floats) -> Floats:
        """Return where the front beside a start begins: it is followed backwards, its material at the left, until it is out of touch."""
        radius = self._area.radius
        contact = CONTACT * radius
        path, _ = self._area.march(
            np.array([start[0], start[1], start[2] + math.pi]),
            math.acos(1.0 - 0.5 * CONTACT),
            step=STEP * radius,
            turn=STEP / RIGHT_TURN,
            idle_before=0.0,
            idle_after=RUN_IN * radius,
            longest=UPSTREAM * radius,
            least=math.acos(1.0 - 0.1 * CONTACT),
            wider=contact,
            side=-1.0,
        )
        last = path[-1]
        return np.array([last[0], last[1], last[2] + math.pi])

    def _entered(
        self, rest: Remaining, lost: dict[tuple[int, int], int]
    ) -> tuple[Floats, Floats] | None:
        """Return where a helix ends in a place that is entered from above, its circle cleared, and its centre; None where none fits."""
        centre, depth = self._area.deepest(rest.positions)
        helix = self._helix_radius(depth)
        if helix <= 0.0 or lost.get(self._key(centre), 0):
            return None
        lost[self._key(centre)] = LOST
        angle = np.linspace(0.0, math.tau, 65)
        circle = centre + helix * np.column_stack([np.cos(angle), np.sin(angle)])
        self._area.clear(np.vstack([centre, circle]))
        return np.array([*circle[0], 0.5 * math.pi]), centre

    def _key(self, position: Floats) -> tuple[int, int]:
        node = np.rint((position[:2] - self._area.corner) / self._area.radius)
        return int(node[0]), int(node[1])


def _first_of(met: Ints) -> int:
    """Return where on a march a pass begins that meets material at rows (k,)."""
    return max(int(met[0]) - round(RUN_IN / STEP), 0)
