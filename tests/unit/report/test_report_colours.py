"""Colours of features and of radii, as window and report have them."""

from __future__ import annotations

import pytest

from trunnion.model.feature import FaceRole, Feature, Recognition
from trunnion.report.palette import load_palette
from trunnion.report.pictures import feature_legend

PALETTE = load_palette()


def group(number: int, local: bool) -> Feature:
    return Feature(
        id=f"group-{number:02}",
        kind="group",
        faces=(FaceRole(role="face", face=number),),
        attributes={"local": local},
    )


def test_local_groups_are_warm_and_the_others_cold():
    colours = PALETTE.features([group(1, False), group(2, True), group(3, False)])
    assert (
        colours["group-01"][2] > colours["group-01"][0]
        and colours["group-03"][2] > colours["group-03"][0]
    )
    assert colours["group-02"][0] > colours["group-02"][2]


def test_neighbours_in_a_class_are_told_apart():
    colours = PALETTE.features([group(n, False) for n in range(1, 5)])
    assert len(set(colours.values())) == 4


def test_a_change_of_one_groups_class_leaves_features_of_other_kinds_alone():
    pocket = Feature(id="pocket-01", kind="pocket", faces=())
    for local in (False, True):
        assert PALETTE.features([group(1, local), pocket])["pocket-01"] == PALETTE.kind("pocket")


@pytest.mark.parametrize(("radius", "step"), [(0.2, 0), (1.0, 0), (1.01, 1), (32.0, 5), (33.0, 6)])
def test_a_radius_has_the_colour_of_its_step(radius, step):
    assert PALETTE.radius.at(radius) == PALETTE.radius.colours[step]


def test_there_is_one_colour_more_than_limits_of_radii():
    assert len(PALETTE.radius.colours) == len(PALETTE.radius.limits) + 1


def test_the_legend_counts_groups_by_class():
    found = Recognition(
        family="surface", features=(group(1, False), group(2, True), group(3, True))
    )
    assert list(feature_legend(found, PALETTE)) == [
        "groups of the remaining area 1",
        "groups of local features 2",
    ]
    assert list(
        feature_legend(Recognition(family="surface", features=(group(1, False),)), PALETTE)
    ) == ["groups of the remaining area 1"]
