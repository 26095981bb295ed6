"""Setups on a panel's edges: which are made, what each cuts, and what is said where the machine does not take them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from flat_parts import MILL, blank_of, panel
from own_shop import own_shop
from trunnion.geometry.frame import WORLD, Frame
from trunnion.model.blank import Box
from trunnion.model.feature import FaceRole, Feature
from trunnion.plan.feasibility import both_sides
from trunnion.plan.panel.edges import lost_on_edges, number_on_edge, with_edges
from trunnion.plan.setups import SetupSettings, level_direction, make_setups, on_edge
from trunnion.plan.setups.flip import turn_words
from trunnion.settings import choose

SHOP, SETTINGS = own_shop(), choose(SetupSettings, MILL)
SIDES = [(1.0, 0.0, 0.0), (-1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, -1.0, 0.0), (0.6, 0.8, 0.0)]


def at_edge(direction, id="pocket-07", *, floor=True):
    faces = (FaceRole(role="floor", face=1),) if floor else (FaceRole(role="wall", face=1),)
    return Feature(id=id, kind="pocket", faces=faces, attributes={"direction": direction})


def made_for(*features, blank=None):
    part, recognition = panel()
    blank = blank or blank_of(part)
    setups = make_setups(recognition, blank, SETTINGS)
    return with_edges(setups, features, recognition, blank, SHOP, SETTINGS), recognition


@pytest.mark.parametrize("direction", SIDES)
def test_an_edge_is_set_up_by_a_quarter_turn_about_a_level_axis(direction):
    (first, edge), recognition = made_for(at_edge(direction))
    assert recognition.frame.local_direction(edge.frame.z) == pytest.approx(direction)
    words = turn_words(first, edge)
    assert words.startswith("The part is turned by 90 degrees about")
    if 1.0 in np.abs(direction):
        assert "about X" in words or "about Y" in words or "about minus" in words
    assert (edge.name, edge.work_offset, edge.machine) == ("S2", "G55", first.machine)


def test_zero_lies_on_the_corner_of_the_blank_as_it_stands():
    part, recognition = panel()
    blank = blank_of(part)
    setup = on_edge(blank, recognition.frame, np.array([0.0, 1.0, 0.0]), SETTINGS, 1)
    low, high = blank.box_in(setup.frame)
    assert low[:2] == pytest.approx([0.0, 0.0]) and high[2] == pytest.approx(0.0)


def test_each_direction_is_one_setup_and_what_goes_through_asks_for_none_of_its_own():
    features = (
        at_edge((0.0, -1.0, 0.0), "tunnel-01", floor=False),
        at_edge((0.0, 1.0, 0.0), "pocket-07"),
        at_edge((0.0, 1.0, 0.0), "pocket-08"),
        at_edge((1.0, 0.0, 0.0), "pocket-09"),
    )
    setups, recognition = made_for(*features)
    assert [s.name for s in setups] == ["S1", "S2", "S3"]
    assert [number_on_edge(f, setups, recognition) for f in features] == [1, 1, 1, 2]


def test_what_opens_above_or_below_or_leans_is_at_no_edge():
    for direction in ((0.0, 0.0, -1.0), (0.0, 0.0, 1.0), (0.6, 0.0, 0.8)):
        assert level_direction(at_edge(direction)) is None
    assert level_direction(Feature(id="pocket-01", kind="pocket", faces=())) is None


def test_an_edge_that_the_machine_does_not_take_is_left_out_and_told():
    tall = Box(
        frame=WORLD,
        low=np.zeros(3),
        high=np.array([1100.0, 100.0, 40.0]),
        material="7050-T7451",
        density=2.83,
    )
    feature = at_edge((1.0, 0.0, 0.0))
    setups, recognition = made_for(feature, blank=tall)
    assert len(setups) == 1
    (reason,) = lost_on_edges([feature], setups, recognition).values()
    assert "the machine does not take the part" in reason
    setups, recognition = made_for(at_edge((0.0, 1.0, 0.0)), blank=tall)
    assert len(setups) == 2


def test_the_part_turned_over_comes_after_its_edges():
    part, _ = panel()
    setups, _ = made_for(at_edge((0.0, 1.0, 0.0)))
    found = both_sides(setups, blank_of(part), SHOP, SETTINGS)
    assert [s.name for s in found] == ["S1", "S2", "S3"]
    assert found[2].frame.z == pytest.approx(-found[0].frame.z)
    assert both_sides(found, blank_of(part), SHOP, SETTINGS) == found


def test_a_setup_follows_a_part_that_lies_turned_in_its_file():
    part, _ = panel()
    turned = Frame(np.array([1.0, 2.0, 3.0]), np.array([0.0, 1.0, 0.0]), np.array([1.0, 0.0, 0.0]))
    blank = replace(blank_of(part), frame=turned)
    setup = on_edge(blank, turned, np.array([1.0, 0.0, 0.0]), SETTINGS, 1)
    assert setup.frame.z == pytest.approx(turned.x) and setup.frame.y == pytest.approx(turned.y)
