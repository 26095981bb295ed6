"""Plane drives that leave what features keep: raised floors, walls kept off, and the rims of other features."""

from __future__ import annotations

import math
from dataclasses import replace

from hypothesis import given
from hypothesis import strategies as st
from pytest import approx

from milling import closed_pocket, rounded
from trunnion.geometry.plane.region import Region
from trunnion.plan.prismatic.kept import KeptArea, off_kept, with_kept

AMOUNTS = st.floats(0.02, 2.0)
DEPTH = 10.0


def pocket():
    return closed_pocket(rounded(0.0, 0.0, 60.0, 40.0, 6.0), DEPTH)


@given(wall=AMOUNTS, floor=AMOUNTS)
def test_floors_are_raised_and_walls_are_kept_off_beside_an_own_allowance(wall, floor):
    before = replace(pocket(), wall_allowance=0.5, earlier_allowance=0.5)
    made = with_kept(before, wall, floor)
    assert made.bottom == approx(before.bottom + floor) and made.top == before.top
    assert [f.z for f in made.floors] == approx([f.z + floor for f in before.floors])
    assert [w.bottom for w in made.walls] == approx([w.bottom + floor for w in before.walls])
    assert made.wall_allowance == made.earlier_allowance == approx(0.5 + wall)
    assert not made.finishes and with_kept(pocket(), wall, floor).finishes


def test_a_step_that_the_floors_allowance_takes_all_of_is_left_out():
    before = pocket()
    (level,) = before.levels
    half = replace(level, bottom=level.top - 0.1)
    stepped = replace(
        before,
        levels=(half, replace(level, top=half.bottom)),
        floors=(*before.floors, replace(before.floors[0], z=half.bottom)),
    )
    made = with_kept(stepped, 0.0, 0.1)
    (left,) = made.levels
    assert (left.top, left.bottom) == approx((level.top, level.bottom + 0.1))


def test_without_floors_all_levels_end_at_some():
    made = with_kept(replace(pocket(), floors=()), 0.0, 0.2)
    assert made.bottom == approx(pocket().bottom + 0.2)


@given(amount=AMOUNTS)
def test_the_rim_of_another_feature_is_no_space_for_a_cutter(amount):
    before = pocket()
    right = Region.rectangle(30.0, -50.0, 100.0, 90.0)
    made = off_kept(before, [KeptArea(feature="other", area=right, amount=amount)])
    (level,), (was,) = made.levels, before.levels
    assert level.wanted is was.wanted
    # Half of what the rounded rectangle loses when it is offset inwards.
    whole, inner = (
        (60.0 - 2.0 * a) * (40.0 - 2.0 * a) - (4.0 - math.pi) * (6.0 - a) ** 2
        for a in (0.0, amount)
    )
    assert was.boundary.area - level.boundary.area == approx(0.5 * (whole - inner), rel=1e-3)
    assert off_kept(before, ()) is before
