"""T-slot cutters: a disc on a thinner neck."""

from __future__ import annotations

from dataclasses import replace

import pytest

from verify_tools import FORMS

DISC = replace(
    FORMS["t-slot"],
    diameter=20.0,
    corner_radius=0.0,
    flute_length=6.0,
    neck_diameter=8.0,
    neck_length=30.0,
    shank_diameter=16.0,
    stickout=40.0,
    gauge_length=140.0,
)


@pytest.mark.parametrize(
    ("changed", "radius"),
    [
        ({}, 4.0),
        ({"neck_length": 6.0}, 8.0),
        ({"neck_length": 6.0, "shank_diameter": 25.0}, 10.0),
    ],
)
def test_over_a_disc_nothing_stays_where_its_neck_passes(changed, radius):
    assert replace(DISC, **changed).column_radius == radius


@pytest.mark.parametrize("form", [f for f in FORMS if f != "t-slot"])
def test_over_other_cutters_nothing_stays_within_their_core(form):
    assert FORMS[form].column_radius == FORMS[form].core_radius
