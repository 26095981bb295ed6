"""Blank and setups."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from pytest import approx

from flat_parts import MILL, blank_of, panel
from own_shop import own_shop
from trunnion.geometry.frame import WORLD, Frame
from trunnion.model.blank import Revolved
from trunnion.model.feature import Feature
from trunnion.plan.blank import BlankSettings, make_blank
from trunnion.plan.setups import SetupSettings, make_setups
from trunnion.settings import choose

SHOP = own_shop()
BELOW = Feature(id="pocket-09", kind="pocket", faces=(), attributes={"direction": (0.0, 0.0, -1.0)})


def test_the_blank_is_larger_than_the_part_by_its_allowances():
    blank = make_blank(
        WORLD,
        np.zeros(3),
        np.array([100.0, 50.0, 20.0]),
        SHOP.material("C45"),
        choose(BlankSettings, {"blank.top": 3}),
    )
    assert blank.low.tolist() == [-5, -5, 0] and blank.high.tolist() == [105, 55, 23]
    assert blank.mass == approx(110 * 60 * 23 * 7.85e-6)


def test_zero_lies_on_the_blanks_top_corner_and_the_clearance_above_it():
    part, recognition = panel()
    (setup,) = make_setups(recognition, blank_of(part), choose(SetupSettings, MILL))
    assert setup.frame.origin == approx([-5, -5, 32])
    assert setup.clearance == 20.0 and setup.work_offset == "G54"


def test_zero_may_lie_in_the_middle_of_the_bottom():
    part, recognition = panel()
    (setup,) = make_setups(
        recognition, blank_of(part), choose(SetupSettings, {**MILL, "origin": "centre bottom"})
    )
    assert setup.frame.origin == approx([100, 50, 0])
    assert setup.clearance == 52.0


def test_zero_lies_on_the_axis_of_a_round_blank_unless_its_corner_is_asked_for():
    _, recognition = panel()
    bar = Revolved.cylinder(WORLD, 60.0, (-5.0, 40.0), "C45", 7.8)
    (setup,) = make_setups(recognition, bar, choose(SetupSettings, MILL))
    assert setup.frame.origin == approx([0, 0, 40])
    (setup,) = make_setups(
        recognition, bar, choose(SetupSettings, {**MILL, "origin": "corner top"})
    )
    assert setup.frame.origin == approx([-60, -60, 40])


def test_a_feature_reached_from_below_gets_a_setup_turned_about_x():
    part, recognition = panel()
    recognition = replace(recognition, features=(*recognition.features, BELOW))
    _, below = make_setups(recognition, blank_of(part), choose(SetupSettings, MILL))
    assert below.frame.z.tolist() == [0, 0, -1] and below.work_offset == "G55"
    low, high = blank_of(part).box_in(below.frame)
    assert low == approx([0, 0, -32]) and high == approx([210, 110, 0])


def test_a_hole_that_leans_downward_is_not_reached_from_below():
    part, recognition = panel()
    leaning = replace(BELOW, id="hole-09", kind="hole", attributes={"direction": (0.6, 0.0, -0.8)})
    recognition = replace(recognition, features=(*recognition.features, leaning))
    assert len(make_setups(recognition, blank_of(part), choose(SetupSettings, MILL))) == 1


def test_setups_after_the_first_may_stand_on_another_machine():
    part, recognition = panel()
    recognition = replace(recognition, features=(*recognition.features, BELOW))
    words = {"machine": "Mill 1200", "next_machine": "Trunnion 650"}
    made = make_setups(recognition, blank_of(part), choose(SetupSettings, words))
    assert [s.machine for s in made] == ["Mill 1200", "Trunnion 650"]


def test_setups_stand_on_one_machine_where_no_other_is_named():
    part, recognition = panel()
    recognition = replace(recognition, features=(*recognition.features, BELOW))
    made = make_setups(recognition, blank_of(part), choose(SetupSettings, MILL))
    assert [s.machine for s in made] == ["Mill 1200", "Mill 1200"]


def test_a_turned_part_has_its_blank_in_its_own_frame():
    frame = Frame(np.array([10.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0]), np.array([1.0, 0.0, 0.0]))
    blank = make_blank(
        frame,
        np.zeros(3),
        np.array([100.0, 50.0, 20.0]),
        SHOP.material("C45"),
        choose(BlankSettings, {}),
    )
    assert blank.box_in(frame)[1] == approx([105, 55, 22])
