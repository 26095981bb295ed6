"""Rapids from one direction of the tool to another: clear of the work with all of the tool, and no more than needed."""

from __future__ import annotations

import math

import numpy as np
from pytest import approx

from milling import SETUP, box_blank
from trunnion.model.motion.toolpath import Mark, Motion, Toolpath
from trunnion.toolpath.motion.reorient import (
    STEP,
    clearance_sphere,
    joined,
    led_away,
    moved_over,
    turn,
    turned_round,
)

UP = np.array([0.0, 0.0, 1.0])
SWING = clearance_sphere(box_blank((-30, -20, -40), (30, 20, 0)), SETUP)


def lean(degrees: float, around: float = 0.0) -> np.ndarray:
    a, b = math.radians(degrees), math.radians(around)
    return np.array([math.sin(a) * math.cos(b), math.sin(a) * math.sin(b), math.cos(a)])


def standing(axis, tip=(5.0, 0.0, 20.0)) -> Toolpath:
    """Return a path of one rapid and a line, the axis held."""
    return Toolpath(
        position=[tip, (0.0, 0.0, -2.0)],
        axis=[axis, axis],
        motion=[Motion.RAPID, Motion.LINE],
        centre=np.full((2, 3), np.nan),
        feed=[0.0, 500.0],
        mark=[Mark.RETRACT, Mark.CUT],
    )


def test_the_sphere_holds_the_blank_with_the_clearance_round_it():
    half = math.sqrt(30.0**2 + 20.0**2 + 20.0**2)
    assert SWING.centre == approx([0.0, 0.0, -20.0])
    assert SWING.radius == approx((half + SETUP.clearance) / math.cos(STEP / 2))


def test_a_path_in_the_direction_that_the_tool_has_is_left_as_it_is():
    path = standing(lean(30))
    assert moved_over(path, (np.array([0.0, 0.0, 90.0]), lean(30)), SWING) is path
    assert moved_over(standing(UP), None, SWING).position == approx(standing(UP).position)


def test_from_its_change_a_leaning_tool_comes_in_along_its_axis():
    path = moved_over(standing(lean(30)), None, SWING)
    way = path.position[1] - path.position[0]
    assert len(path) == 3
    assert way / np.linalg.norm(way) == approx(-lean(30))
    assert (path.position[0] - SWING.centre) @ lean(30) == approx(SWING.radius)


def test_while_it_turns_the_whole_tool_stays_behind_a_plane_that_touches_the_blank_nowhere():
    path = moved_over(standing(lean(70, 120)), (np.array([8.0, 3.0, 20.0]), lean(60, -20)), SWING)
    assert (path.motion[:-1] == Motion.RAPID).all()
    turning = np.flatnonzero(np.abs(np.diff(path.axis, axis=0)).max(axis=1) > 1e-9)
    assert len(turning) > 10
    inside = math.sqrt(30.0**2 + 20.0**2 + 20.0**2) + SETUP.clearance
    for k in turning:
        for share in np.linspace(0.0, 1.0, 9):
            tip = path.position[k] + share * (path.position[k + 1] - path.position[k])
            axis = path.axis[k] + share * (path.axis[k + 1] - path.axis[k])
            assert (tip - SWING.centre) @ axis / np.linalg.norm(axis) >= inside - 1e-6


def test_the_last_rapid_goes_in_along_the_new_axis_to_where_the_path_begins():
    path = moved_over(standing(lean(40)), (np.array([0.0, 0.0, 20.0]), UP), SWING)
    way = path.position[-2] - path.position[-3]
    assert path.position[-2] == approx([5.0, 0.0, 20.0])
    assert way / np.linalg.norm(way) == approx(-lean(40))


def test_a_path_that_ends_pointing_up_is_led_out_until_no_way_up_comes_nearer():
    path = led_away(standing(lean(115, 40)), SWING)
    assert len(path) > 3 and (path.motion[2:] == Motion.RAPID).all()
    tip, axis = path.position[-1], path.axis[-1]
    assert axis[2] == approx(0.0, abs=1e-12)
    # Out along its axis first, then round the sphere; straight up from there it stays behind a plane that touches it.
    assert path.axis[2] == approx(lean(115, 40))
    assert (path.position[2] - SWING.centre) @ lean(115, 40) == approx(SWING.radius)
    for up in (0.0, 50.0, 500.0):
        assert (tip + [0.0, 0.0, up] - SWING.centre) @ axis >= SWING.radius - 1e-9
    for degrees in (0.0, 45.0, 90.0):
        assert len(led_away(standing(lean(degrees)), SWING)) == 2


def test_a_turn_straight_back_goes_over_the_top():
    way = turn(lean(90), lean(90, 180))
    assert way[:, 2].max() == approx(1.0)
    assert way[-1] == approx(lean(90, 180))


def test_paths_one_after_the_other_are_led_only_where_the_direction_changes():
    led = joined(
        [standing(UP), standing(UP), standing(lean(45)), standing(lean(45))],
        [True, False, False, True],
        SWING,
    )
    assert [len(p) > 2 for p in led] == [False, False, True, True]
    assert led[2].position[0] == approx([0.0, 0.0, SWING.centre[2] + SWING.radius])


def test_between_two_directions_from_below_it_goes_round_and_leans_no_lower_than_they_do():
    path = moved_over(standing(lean(115.0, 180.0)), (60.0 * lean(100.0), lean(100.0)), SWING)
    assert path.axis[:, 2].min() >= lean(115.0)[2] - 1e-9
    assert path.axis[:, 2].max() <= lean(100.0)[2] + 1e-9


def test_between_directions_that_lean_far_the_table_turns_and_the_head_does_not():
    way = turned_round(lean(80.0, -170.0), lean(60.0, 10.0))
    head = np.degrees(np.arccos(way[:, 2]))
    assert (np.diff(head) <= 0.0).all() and head[[0, -1]] == approx([80.0, 60.0])
    near = np.degrees(np.arccos(np.clip((way[1:] * way[:-1]).sum(axis=1), -1.0, 1.0)))
    assert near.max() <= np.degrees(STEP) + 1e-6
    # Where one hardly leans the shortest way is kept.
    assert turned_round(lean(10.0), lean(70.0, 90.0)) == approx(turn(lean(10.0), lean(70.0, 90.0)))
