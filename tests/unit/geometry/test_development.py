"""Cylinders and cones laid flat, meshes over them, and what turning leaves of a part."""

from __future__ import annotations

import math

import numpy as np
import pytest

from trunnion.geometry.developed_mesh import developed_triangles
from trunnion.geometry.development import Development
from trunnion.geometry.frame import WORLD, Frame
from trunnion.geometry.turned_state import turned_state

SLOPES = pytest.mark.parametrize("slope", [0.0, 0.2, -0.3])
LEANING = Frame(np.array([5.0, 6.0, 7.0]), np.array([1.0, 1.0, 0.0]), np.array([0.0, 0.3, 1.0]))


def development(slope: float, frame: Frame = WORLD) -> Development:
    return Development(frame=frame, radius=100.0, height=10.0, slope=slope, middle=0.4)


def over_it(count: int = 60) -> np.ndarray:
    draw = np.random.default_rng(3)
    return np.column_stack([draw.uniform(low, high, count) for low, high in BOX])


BOX = ((-250.0, 250.0), (-5.0, 80.0), (-3.0, 20.0))


@SLOPES
def test_what_is_laid_flat_comes_back(slope: float) -> None:
    flat, own = over_it(), development(slope, LEANING)
    assert own.to_local(own.to_world(flat)) == pytest.approx(flat, abs=1e-9)


@SLOPES
def test_lengths_on_the_ground_stay_what_they_are(slope: float) -> None:
    flat, own, step = over_it() * [1.0, 1.0, 0.0], development(slope), 1e-4
    for along in ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.6, 0.8, 0.0]):
        moved = own.to_world(flat + step * np.array(along)) - own.to_world(flat)
        assert np.linalg.norm(moved, axis=1) / step == pytest.approx(1.0, abs=1e-5)


@SLOPES
def test_heights_go_along_the_normals(slope: float) -> None:
    flat, own = over_it(), development(slope, LEANING)
    up = own.to_world(flat + [0.0, 0.0, 2.0]) - own.to_world(flat)
    assert up / 2.0 == pytest.approx(own.normals(flat), abs=1e-9)


def test_a_full_turn_of_a_cylinder_is_its_circumference() -> None:
    at = development(0.0).from_cylindrical(
        np.array([100.0, 100.0]), np.array([-math.pi, math.pi]), np.array([10.0, 10.0])
    )
    assert at[1, 0] - at[0, 0] == pytest.approx(2.0 * math.pi * 100.0)


def test_a_cone_takes_the_angle_of_the_plane_that_its_sine_says() -> None:
    assert development(0.75).half_turn == pytest.approx(math.pi * 0.6)


@SLOPES
def test_a_straight_cutter_along_a_normal_stays_inside_of_the_planned_one(slope: float) -> None:
    own, radius = development(slope), 8.0
    tip = own.to_world(np.array([[30.0, 20.0, 0.0]]))[0]
    axis = own.normals(np.array([[30.0, 20.0, 0.0]]))[0]
    side = np.cross(axis, [0.3, 0.4, 0.5])
    side /= np.linalg.norm(side)
    turn = np.linspace(0.0, 2.0 * np.pi, 73)[:, None]
    rim = np.cos(turn) * side + np.sin(turn) * np.cross(axis, side)
    for height in (0.0, 5.0, 20.0):
        flat = own.to_local(tip + radius * rim + height * axis)
        away = np.linalg.norm(flat[:, :2] - [30.0, 20.0], axis=1)
        assert away.max() <= radius + 1e-3 and flat[:, 2].min() >= height - 1e-9


def test_a_plane_over_a_cylinder_is_cut_until_straight_edges_stand_for_it() -> None:
    # The flat of a boss 40 mm wide, tangent to a radius of 110: its rim is higher over the ground than its middle.
    own = Development(frame=WORLD, radius=100.0, height=0.0, slope=0.0, middle=0.0)
    corners = np.array([[[110.0, -20.0, 0.0], [110.0, 20.0, 0.0], [110.0, 20.0, 30.0]]])
    flat = developed_triangles(corners, own, 0.0, 0.1)
    assert flat[:, :, 2].max() == pytest.approx(math.hypot(110.0, 20.0) - 100.0)
    middle = flat.mean(axis=1)
    assert np.abs(own.to_world(middle)[:, 0] - 110.0).max() < 0.01


def test_what_lies_where_the_plane_ends_is_there_on_both_sides() -> None:
    own = Development(frame=WORLD, radius=100.0, height=0.0, slope=0.0, middle=0.0)
    corners = np.array([[[-105.0, -1.0, 0.0], [-105.0, 1.0, 0.0], [-105.0, 0.0, 2.0]]])
    u = developed_triangles(corners, own, 0.0, 0.2)[:, :, 0]
    assert (u.min() < -310.0) and (u.max() > 310.0)


def ring(low: float, high: float, radius: float, tag: int, count: int = 24) -> tuple:
    """Return points, triangles and tags of a cylinder's side."""
    turn = 2.0 * np.pi * np.arange(count) / count
    circle = radius * np.column_stack([np.cos(turn), np.sin(turn)])
    points = np.vstack([np.column_stack([circle, np.full(count, z)]) for z in (low, high)])
    n, after = np.arange(count), (np.arange(count) + 1) % count
    triangles = np.vstack(
        [np.column_stack([n, after, n + count]), np.column_stack([after, after + count, n + count])]
    )
    return points, triangles, np.full(len(triangles), tag)


def test_turning_leaves_a_ring_where_a_boss_rises_and_the_rest_to_size() -> None:
    outer, inner = ring(0.0, 50.0, 40.0, 1), ring(0.0, 50.0, 36.0, 2)
    boss = np.array([[45.0, -3.0, 20.0], [45.0, 3.0, 20.0], [45.0, 0.0, 30.0]])
    points = np.vstack([outer[0], inner[0], boss])
    first = len(outer[0])
    triangles = np.vstack(
        [outer[1], inner[1] + first, [[2 * first, 2 * first + 1, 2 * first + 2]]]
    ).astype(np.int64)
    face = np.concatenate([outer[2], inner[2], [3]])
    tags = np.array([1, 2])
    outline = turned_state(points, triangles, face, tags, tags)
    assert np.isclose(outline[:, 0], 36.0).sum() == 2
    assert np.isclose(outline[:, 0], 40.0).sum() == 4
    high = outline[outline[:, 0] > 40.5]
    assert high[:, 0].max() >= math.hypot(45.0, 3.0) - 1e-9
    assert high[:, 1].min() >= 18.0 and high[:, 1].max() <= 32.0
