"""How holes read in the window: the size in their row, and the units of their sizes."""

from __future__ import annotations

from dataclasses import replace

import pytest

from trunnion.model.feature import FaceRole, Feature
from trunnion_gui import i18n
from trunnion_gui.docks.properties import feature_rows
from trunnion_gui.families.contract import demanded, main_size

HOLE = Feature(
    id="hole-01",
    kind="hole",
    faces=(FaceRole(role="counterbore_side", face=4), FaceRole(role="side", face=5)),
    sizes={
        "diameter": 8.5,
        "depth": 20.0,
        "through": True,
        "counterbore_diameter": 14.0,
        "countersink_angle": 90.0,
    },
    attributes={"pattern": "circle", "pitch_circle_diameter": 60.0},
)


def test_the_main_size_of_a_hole_is_its_diameter():
    assert main_size(HOLE) == "8.5"


def test_a_demand_stands_beside_the_size_of_a_hole():
    threaded = replace(HOLE, attributes={**HOLE.attributes, "thread": "M10"})
    assert demanded(threaded) == ("M10",) and demanded(HOLE) == ()


def test_sizes_of_holes_have_units():
    rows = dict(feature_rows(HOLE))
    assert rows["Counterbore diameter"] == "14 mm" and rows["Countersink angle"] == "90 °"
    assert rows["Through"] == "yes" and rows["Pattern"] == "circle" and rows["Side"] == "5"


@pytest.mark.parametrize("language", [n for n in i18n.languages() if n != "en"])
def test_holes_read_in_other_languages(language):
    i18n.use(language)
    try:
        words = {w for w, _ in feature_rows(HOLE)}
    finally:
        i18n.use("en")
    assert not {w for w in words if w.isascii()}
