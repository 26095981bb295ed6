"""What triangles have above a height, in plan."""

from __future__ import annotations

import numpy as np
import pytest
import shapely

from trunnion.geometry.plane.plan_area import _cut_off, plan_area_above, tiled

BASE = np.array([[0.0, 0.0, 0.0], [10.0, 0.0, 0.0], [10.0, 10.0, 0.0], [0.0, 10.0, 0.0]])
TIP = np.array([5.0, 5.0, 10.0])
SIDES = np.stack([BASE, np.roll(BASE, -1, axis=0), np.tile(TIP, (4, 1))], axis=1)
EVENED = 0.05
"""mm that a rim may stand out."""


@pytest.mark.parametrize("z", [1.0, 5.0, 9.0])
def test_a_pyramid_is_as_wide_above_a_height_as_its_section_there(z):
    area = plan_area_above(SIDES, z)
    wide = 10.0 - z
    assert wide**2 <= area.area < (wide + 2.0 * EVENED) ** 2


@pytest.mark.parametrize("z", [1.0, 5.0, 9.0])
def test_a_funnel_is_all_above_a_height_but_its_tip(z):
    funnel = SIDES * [1.0, 1.0, -1.0] + [0.0, 0.0, 10.0]
    area = plan_area_above(funnel, z)
    hollow = 100.0 - z**2
    assert hollow <= area.area < hollow + 80.0 * EVENED


def test_a_corner_at_the_very_height_counts_as_above_it():
    area = plan_area_above(SIDES[:1] + [0.0, 0.0, -10.0], -10.0)
    assert area.area == pytest.approx(25.0, abs=30.0 * EVENED)


def dome(n: int, lean: float) -> np.ndarray:
    """Return the triangles (t, 3, 3) of a round top that leans over, n by n of them twice: some of its plan lies over itself."""
    at = np.linspace(-10.0, 10.0, n + 1)
    x, y = np.meshgrid(at, at, indexing="ij")
    z = np.maximum(60.0 - x * x - y * y, 0.0) / 6.0
    points = np.stack([x + lean * z, y, z], axis=-1)
    a, b, c, d = points[:-1, :-1], points[1:, :-1], points[1:, 1:], points[:-1, 1:]
    return np.concatenate([np.stack(t, axis=2).reshape(-1, 3, 3) for t in ((a, b, c), (a, c, d))])


@pytest.mark.parametrize("lean", [0.0, 0.4, 1.7])
@pytest.mark.parametrize("z", [-1.0, 0.5, 4.0])
def test_pieces_joined_tile_by_tile_cover_what_they_covered(z: float, lean: float) -> None:
    corners = dome(40, lean)
    corners = corners[corners[:, :, 2].min(axis=1) > z]
    pieces = np.asarray(shapely.polygons(corners[:, :, :2]))
    up = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[:, 2] > 0.0
    assert up.all() == (lean < 1.0)
    joined = tiled(pieces, up)
    assert len(joined) < 0.5 * len(pieces)
    before, after = shapely.union_all(pieces), shapely.union_all(joined)
    assert shapely.area(shapely.symmetric_difference(before, after)) < 1e-9 * shapely.area(before)


def test_pieces_that_overlap_stay_as_they_are() -> None:
    pieces = np.asarray(shapely.polygons(SIDES[:, :, :2] + np.arange(4)[:, None, None]))
    assert sorted(shapely.area(tiled(pieces, np.ones(4, bool)))) == sorted(shapely.area(pieces))


def test_triangles_that_cross_a_height_are_joined_above_it() -> None:
    """The halves of triangles meet where they were cut; of a roof's two sides none is left apart."""
    corners = dome(40, 0.0)
    crossing = corners[(corners[:, :, 2].min(axis=1) < 4.0) & (corners[:, :, 2].max(axis=1) > 4.0)]
    cut = _cut_off(crossing, 4.0)
    assert len(cut) > 50
    joined = tiled(cut, np.ones(len(cut), bool))
    assert len(joined) < 0.2 * len(cut)
    assert shapely.area(joined).sum() == pytest.approx(shapely.area(cut).sum(), rel=1e-9)


@pytest.mark.parametrize("z", [0.5, 5.0, 9.5])
def test_upright_walls_add_nothing_to_what_they_carry_and_all_they_have_alone(z: float) -> None:
    low, high = BASE, BASE + [0.0, 0.0, 10.0]
    after = [np.roll(v, -1, axis=0) for v in (low, high)]
    walls = np.concatenate(
        [np.stack([low, after[0], after[1]], axis=1), np.stack([low, after[1], high], axis=1)]
    )
    lid = np.stack([high[[0, 0]], high[[1, 2]], high[[2, 3]]], axis=1)
    whole, bare = plan_area_above(np.concatenate([walls, lid]), z), plan_area_above(walls, z)
    assert 100.0 <= whole.area < (10.0 + 2.0 * EVENED) ** 2
    assert 0.0 < bare.area < 80.0 * EVENED


def test_of_pieces_that_overlap_in_one_place_the_others_are_joined() -> None:
    corners = dome(40, 0.0)
    pieces = np.asarray(shapely.polygons(corners[:, :, :2]))
    doubled = np.concatenate([pieces, pieces[1600:1601]])
    joined = tiled(doubled, np.ones(len(doubled), bool))
    assert len(joined) < 0.1 * len(doubled)
    assert shapely.area(shapely.union_all(joined)) == pytest.approx(400.0)
