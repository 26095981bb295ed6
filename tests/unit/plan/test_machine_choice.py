"""The machine that a part is programmed for where nobody named one."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from own_shop import own_shop
from trunnion.findings import BadInput
from trunnion.geometry.frame import WORLD, Frame
from trunnion.model.blank import Box, Revolved
from trunnion.pipeline.planning.machine import with_machine
from trunnion.plan.contract import planner_for
from trunnion.plan.machine_choice import machine_for, takes
from trunnion.plan.setups import SetupSettings
from trunnion.settings import choose

SHOP = own_shop()
LYING = math.radians(90.0)
UPRIGHT = 0.0
ASKEW = Frame(np.array([3.0, -2.0, 7.0]), np.array([0.8, 0.6, 0.0]), np.array([0.36, -0.48, 0.8]))


def plate(x: float, y: float, z: float) -> Box:
    return Box(frame=WORLD, low=(0, 0, 0), high=(x, y, z), material="C45", density=7.8)


def disc(radius: float, height: float, frame: Frame = WORLD) -> Revolved:
    return Revolved.cylinder(frame, radius, (0.0, height), "C45", 7.8)


def chosen(blank, lean, shop=SHOP, **words) -> str:
    return machine_for(blank, lean, choose(SetupSettings, words), shop)


def travel_volume(machine) -> float:
    return math.prod(machine.axis(n).high - machine.axis(n).low for n in "XYZ")


def test_an_upright_tool_asks_for_three_axes_and_the_smallest_machine_that_takes_the_blank():
    assert chosen(plate(600, 300, 40), UPRIGHT) == "Mill 1200"
    assert chosen(plate(1900, 700, 40), UPRIGHT) == "Gantry 4000"


def test_a_leaning_tool_asks_for_rotary_axes_that_lean_it_all_round():
    name = chosen(disc(60, 40), LYING)
    mills = [m for m in SHOP.machines.values() if m.work_spindle is None]
    fit = [m for m in mills if takes(m, disc(60, 40), LYING, 20.0)]
    assert len(fit) > 2 and all(len(m.rotary) == 2 for m in fit)
    assert name == min(fit, key=travel_volume).name
    assert travel_volume(SHOP.machine(chosen(disc(310, 150), LYING))) > travel_volume(
        SHOP.machine(name)
    )


def test_a_large_ring_is_not_put_on_a_table_that_it_just_covers():
    assert chosen(disc(325, 280), LYING) not in ("Trunnion 650", "Trunnion 500 B")
    assert takes(SHOP.machine(chosen(disc(325, 280), LYING)), disc(325, 280), LYING, 20.0)


def test_a_head_needs_room_for_its_pivot_beside_the_part():
    """The tool of a head lies 400 mm beside its pivot: what a table takes with ease is too wide for it."""
    head, wide = SHOP.machine("Universal 1250"), disc(500, 100)
    assert takes(head, wide, UPRIGHT, 20.0) and not takes(head, wide, LYING, 20.0)


def test_rotary_axes_that_stop_short_of_the_lean_do_not_do():
    trunnion = SHOP.machine("Trunnion 650")
    short = tuple(replace(a, low=-45.0) if a.name == "A" else a for a in trunnion.axes)
    assert takes(trunnion, disc(60, 40), LYING, 20.0)
    assert not takes(replace(trunnion, axes=short), disc(60, 40), LYING, 20.0)


def test_a_named_machine_is_taken_whatever_it_lacks():
    assert chosen(disc(60, 40), LYING, machine="Mill 1200") == "Mill 1200"


def test_lathes_mill_nothing():
    lathes = {n: m for n, m in SHOP.machines.items() if m.work_spindle is not None}
    assert (
        len(lathes) > 1
        and chosen(plate(100, 50, 20), UPRIGHT, replace(SHOP, machines=lathes)) == ""
    )


def test_where_nothing_takes_the_blank_the_largest_with_the_axes_is_named():
    assert chosen(plate(9000, 300, 40), UPRIGHT) == "Gantry 6000 fork"
    assert SHOP.machine(chosen(disc(3000, 300), LYING)).rotary


@given(st.floats(20.0, 2500.0), st.floats(20.0, 900.0), st.sampled_from((UPRIGHT, 1.0, LYING)))
def test_the_choice_does_not_hang_on_where_the_blank_lies(radius, height, lean):
    assert chosen(disc(radius, height, ASKEW), lean) == chosen(disc(radius, height), lean)


@given(st.floats(20.0, 600.0), st.floats(20.0, 400.0), st.sampled_from((UPRIGHT, 1.0, LYING)))
def test_what_takes_a_blank_takes_a_smaller_one(radius, height, lean):
    for machine in SHOP.machines.values():
        if machine.work_spindle is None and takes(machine, disc(radius, height), lean, 20.0):
            assert takes(machine, disc(0.9 * radius, height), lean, 20.0)


def test_families_say_how_far_their_tools_lean():
    blank = disc(60, 40)
    for family in ("casing", "impeller"):
        choices = with_machine(planner_for(family), blank, {}, SHOP)
        assert SHOP.machine(str(choices["setup.machine"])).rotary
    assert with_machine(planner_for("panel"), blank, {}, SHOP)["setup.machine"] == "Mill 1200"


def test_an_unknown_machine_is_refused_with_the_known_ones():
    with pytest.raises(BadInput, match="no machine Mill 9 in the catalogue; known: .*Mill 1200"):
        with_machine(planner_for("panel"), plate(9, 9, 9), {"setup.machine": "Mill 9"}, SHOP)


def test_a_catalogue_without_mills_is_told():
    with pytest.raises(BadInput, match="no machine that mills"):
        with_machine(planner_for("panel"), plate(9, 9, 9), {}, replace(SHOP, machines={}))


def test_the_limits_of_an_axis_are_held_against_its_angles_whole_turns_apart():
    """A lean of 60 degrees about B is -300 too: a table that leans to 110 takes it."""
    small = SHOP.machine("Trunnion 500 B")
    assert takes(small, disc(60, 40), math.radians(60.0), 20.0)
    assert not takes(small, disc(60, 40), math.radians(115.0), 20.0)
    # Leaning the other way alone the table reaches 35 degrees; C turns the work round, so both signs of B are never needed.
    short = tuple(replace(a, high=50.0) if a.name == "B" else a for a in small.axes)
    assert not takes(replace(small, axes=short), disc(60, 40), math.radians(60.0), 20.0)
