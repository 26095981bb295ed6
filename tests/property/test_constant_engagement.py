"""Passes at constant engagement on random areas: measured by discs along the path, without the grid that they were laid on."""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from scipy.spatial import cKDTree

from trunnion.geometry.arrays import Bools, Floats
from trunnion.geometry.plane.region import Region
from trunnion.progress import NO_PROGRESS
from trunnion.toolpath.constant_engagement.cleared_area import ClearedArea
from trunnion.toolpath.constant_engagement.passes import EngagedPass, engaged_passes

SEEDS = [0, 4, *(pytest.param(n, marks=pytest.mark.long) for n in (1, 2, 3, *range(5, 20)))]
OVER = math.radians(5.0)
"""rad that the engagement may pass the set angle by, on half a per cent of the length in material at most."""
IN_MATERIAL = math.radians(10.0)
"""rad of contact from which a position counts as in material: less is a film that the grid doesn't know."""
RIM = 90
"""Places on the front half of the rim at which material is looked for."""
FINELY = 0.03
"""Radii between the discs that stand for a path."""
MEASURED = 600
"""Positions at which the engagement is measured."""
BEHIND = 0.3
"""Radii of path behind the tool whose discs are the tool's own."""
FILM = 0.012
"""Radii: thickness of what may be left where the cutter reaches."""


@dataclass(frozen=True, kw_only=True)
class Laid:
    """An area with its passes: `track` (k, 2) are discs along them, `begins` the row of each pass's first, `shown` (m,) rows of those at
    which the engagement is measured, with the headings (m,) there."""

    axis_region: Region
    radius: float
    angle: float
    passes: list[EngagedPass]
    track: Floats
    begins: list[int]
    shown: list[int]
    headings: list[float]

    def engagement(self) -> Floats:
        """Return the angle (m,) over which the front half of the rim is in material."""
        tree, fan = cKDTree(self.track), np.linspace(0.0, math.pi, RIM)
        own = round(BEHIND / FINELY)
        found = []
        for row, heading in zip(self.shown, self.headings, strict=True):
            x, y = math.cos(heading), math.sin(heading)
            rim = self.track[row] + self.radius * np.column_stack(
                [y * np.cos(fan) + x * np.sin(fan), -x * np.cos(fan) + y * np.sin(fan)]
            )
            near = tree.query_ball_point(rim, (1.0 + 0.5 * FILM) * self.radius)
            met = [min(rows, default=row) >= row - own for rows in near]
            found.append(math.pi * float(np.mean(met)))
        return np.array(found)

    def left(self) -> float:
        """Return how far in radii the cutter would still enter what is left, at the worst position of the axis region."""
        low, high = self.axis_region.box()
        step = self.radius / 12.0
        x, y = (
            np.arange(a - self.radius, b + self.radius, step)
            for a, b in zip(low, high, strict=True)
        )
        places = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)
        away, _ = cKDTree(self.track).query(places)
        uncut = places[away > (1.0 + FILM) * self.radius]
        if not len(uncut):
            return 0.0
        inside = places[self.axis_region.contains(places)]
        nearest, _ = cKDTree(uncut).query(inside)
        return float(1.0 - nearest.min() / self.radius)


def laid(
    axis_region: Region,
    radius: float,
    angle: float,
    is_material: Callable[[Floats], Bools] | None = None,
    wanted: Region | None = None,
) -> Laid:
    """Return the passes over an axis region, in full material where nothing else is said."""
    area = ClearedArea.of(
        axis_region,
        axis_region.offset(radius) if wanted is None else wanted,
        radius,
        is_material or (lambda points: np.ones(len(points), dtype=bool)),
    )
    passes = engaged_passes(
        area,
        angle,
        lambda deep: min(0.9 * radius, 0.98 * deep) if deep > 0.3 * radius else 0.0,
        NO_PROGRESS,
    )
    track: list[Floats] = []
    shown: list[int] = []
    headings: list[float] = []
    begins: list[int] = []
    count = 0
    length = sum(float(np.hypot(*np.diff(p.points, axis=0).T).sum()) for p in passes)
    spacing = max(round(length / (FINELY * radius) / MEASURED), 1)
    for one in passes:
        if one.centre is not None:
            turn = np.linspace(0.0, math.tau, 400)
            helix = float(np.hypot(*(one.points[0] - one.centre)))
            track += [
                one.centre[None],
                one.centre + helix * np.column_stack([np.cos(turn), np.sin(turn)]),
            ]
            count += 401
        way = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(one.points, axis=0).T))])
        at = np.arange(0.0, way[-1], FINELY * radius)
        track.append(np.column_stack([np.interp(at, way, one.points[:, k]) for k in (0, 1)]))
        begins.append(count)
        rows = range(min(spacing // 2, len(at) - 1), len(at), spacing)
        shown += [count + k for k in rows]
        following = np.minimum(np.searchsorted(way, at[list(rows)]), len(way) - 1)
        headings += one.heading[following].tolist()
        count += len(at)
    return Laid(
        axis_region=axis_region,
        radius=radius,
        angle=angle,
        passes=passes,
        track=np.vstack(track) if track else np.zeros((0, 2)),
        begins=begins,
        shown=shown,
        headings=headings,
    )


def random_region(seed: int) -> tuple[Region, float, float]:
    """Return a pocket with islands, some of them at its walls, the radius of a cutter for it and an angle of contact."""
    pick = random.Random(seed)
    width, height = pick.uniform(40.0, 120.0), pick.uniform(40.0, 100.0)
    region = Region.rectangle(0.0, 0.0, width, height)
    for _ in range(pick.randint(0, 3)):
        x, y = pick.uniform(0.0, width), pick.uniform(0.0, height)
        island = (
            Region.circle((x, y), pick.uniform(3.0, 10.0))
            if pick.random() < 0.5
            else Region.rectangle(x, y, x + pick.uniform(5.0, 20.0), y + pick.uniform(5.0, 20.0))
        )
        region = region.minus(island.rotated(pick.uniform(0.0, 3.0), (x, y)))
    radius = pick.choice((5.0, 6.0, 8.0, 10.0))
    angle = math.acos(1.0 - pick.choice((0.2, 0.5, 0.6, 1.0)))
    return region.offset(-radius).opened(0.15 * radius), radius, angle


@cache
def laid_at_random(seed: int) -> Laid:
    """Return the passes over a random area."""
    return laid(*random_region(seed))


@pytest.mark.parametrize("seed", SEEDS)
def test_the_angle_of_contact_is_kept_and_used(seed: int) -> None:
    found = laid_at_random(seed)
    engagement = found.engagement()
    cutting = engagement[engagement > IN_MATERIAL]
    assert (cutting > found.angle + OVER).mean() <= 0.005
    removed = 1.0 - np.cos(np.minimum(cutting, math.pi))
    assert (cutting * removed).sum() / removed.sum() >= 0.85 * found.angle


@pytest.mark.parametrize("seed", SEEDS)
def test_nothing_is_left_that_the_cutter_reaches_and_it_stays_in_its_region(seed: int) -> None:
    found = laid_at_random(seed)
    assert found.left() <= 2.0 * FILM
    for one in found.passes:
        assert found.axis_region.signed_distance(one.points).min() > -0.002 * found.radius
        if one.centre is not None:
            helix = float(np.hypot(*(one.points[0] - one.centre)))
            assert helix <= 0.9 * found.radius + 1e-9
            assert found.axis_region.signed_distance(one.centre)[0] >= helix


@pytest.mark.parametrize("seed", SEEDS)
def test_straight_links_go_through_what_was_cleared_before(seed: int) -> None:
    found = laid_at_random(seed)
    tree, fan = cKDTree(found.track), np.linspace(0.0, math.tau, 90)
    rim = found.radius * np.column_stack([np.cos(fan), np.sin(fan)])
    links = 0
    for (before, after), row in zip(pairwise(found.passes), found.begins[1:], strict=True):
        if not after.straight:
            continue
        links += 1
        for share in np.linspace(0.0, 1.0, 9):
            at = before.points[-1] + share * (after.points[0] - before.points[-1])
            near = tree.query_ball_point(at + rim, (1.0 + 2.0 * FILM) * found.radius)
            assert all(min(rows, default=row) < row for rows in near)
    assert links > 0


def test_a_round_pocket_is_one_spiral() -> None:
    found = laid(Region.circle((0.0, 0.0), 40.0), 8.0, math.radians(60.0))
    assert len(found.passes) <= 3
    assert found.passes[0].centre is not None
    # At a constant angle the removal goes with the way: pi (48^2 - r^2) at 4 mm, behind the helix.
    way = sum(float(np.hypot(*np.diff(p.points, axis=0).T).sum()) for p in found.passes)
    helix = float(np.hypot(*(found.passes[0].points[0] - found.passes[0].centre)))
    assert way == pytest.approx(math.pi * (48.0**2 - (8.0 + helix) ** 2) / 4.0, rel=0.06)


def test_an_open_area_is_begun_outside_and_needs_no_helix() -> None:
    def is_material(points: Floats) -> Bools:
        return np.asarray(points[:, 0] > 0.0)

    found = laid(
        Region.rectangle(-20.0, 8.0, 92.0, 72.0),
        8.0,
        math.radians(60.0),
        is_material,
        Region.rectangle(0.0, 0.0, 100.0, 80.0),
    )
    assert found.passes
    assert all(one.centre is None for one in found.passes)
    assert found.passes[0].points[0, 0] < 0.0


def test_a_pass_begins_on_its_helix_though_it_meets_material_later() -> None:
    """Slots of another tool stand all round the helix, too narrow for the cutter to be free in them."""

    def is_material(points: Floats) -> Bools:
        away = np.linalg.norm(points - [60.0, 40.0], axis=1)
        return np.asarray((away < 15.0) | (away > 22.0))

    found = laid(Region.rectangle(8.0, 8.0, 112.0, 72.0), 8.0, math.radians(60.0), is_material)
    entered = [one for one in found.passes if one.centre is not None]
    assert entered
    for one in entered:
        assert np.hypot(*(one.points[0] - one.centre)) == pytest.approx(0.9 * 8.0)


def test_a_channel_is_cut_by_loops_within_the_angle() -> None:
    found = laid(Region.rectangle(0.0, 0.0, 80.0, 6.0).opened(1.2), 8.0, math.radians(60.0))
    assert len(found.passes) > 20
    assert (found.engagement() > found.angle + OVER).mean() <= 0.005


def test_where_no_helix_fits_there_are_no_passes() -> None:
    assert laid(Region.rectangle(0.0, 0.0, 3.0, 3.0), 8.0, math.radians(60.0)).passes == []
