"""The catalogues: what they hold, what a user's folder changes, and the line a fault in a file gets."""

from __future__ import annotations

from pathlib import Path

import pytest

from trunnion.findings import BadInput
from trunnion.shop import load_shop

HOLDER = '["Chuck"]\ntitle = "A chuck"\nrows = [[0, 10, 30, 12]]\n'
TOOL = """
[tool."My D6"]
title = "A cutter"
diameter = 6
corner_radius = 1
flute_length = 12
neck_diameter = 5.5
neck_length = 20
shank_diameter = 6
stickout = 24
teeth = 3
helix_angle = 40
centre_cutting = true
holder = "Chuck"
suits = ["N"]
"""


def folder(tmp_path: Path, **texts: str) -> Path:
    """Return a user's folder with one file a kind."""
    for kind, text in texts.items():
        (tmp_path / kind).mkdir()
        (tmp_path / kind / "own.toml").write_text(text, encoding="utf-8")
    return tmp_path


def test_the_catalogue_has_cutters_from_4_to_25_mm_in_flat_and_bull_form():
    tools = load_shop().tools_for("N", "finish")
    assert {t.diameter for t in tools} >= {4, 5, 6, 8, 10, 12, 14, 16, 20, 25}
    assert {t.form for t in tools} == {"flat", "bull"}
    assert {t.corner_radius for t in tools} == {0, 0.5, 1, 1.5, 2, 2.5, 3, 4}


def test_cutters_for_aluminium_have_fewer_teeth_than_those_for_titanium():
    shop = load_shop()
    assert max(t.teeth for t in shop.tools_for("N", "rough")) == 3
    assert min(t.teeth for t in shop.tools_for("S", "rough")) == 4


def test_the_gauge_length_is_stickout_and_holder():
    tool = next(t for t in load_shop().tools if t.name == "AL3-regular D12 R3")
    assert tool.gauge_length == tool.stickout + 90.0


def test_every_number_of_a_material_names_its_source():
    assert load_shop().material("C45").source.count(": ") >= 7


def test_a_machine_has_the_travel_and_the_spindle_of_its_file():
    machine = load_shop().machine("Mill 1200")
    assert [machine.axis(n).high for n in "XYZ"] == [1200, 800, 600]
    assert machine.spindle_high == 24000


def test_the_typical_plan_of_panels_faces_first_and_finishes_the_outline_last():
    stages = [s.kind for s in load_shop().plan_for("panel").stages]
    assert stages[0] == "face" and stages[-1] == "profile_finish"


def test_a_user_adds_a_cutter_in_a_holder_of_his_own(tmp_path):
    shop = load_shop(folder(tmp_path, holders=HOLDER, tools=TOOL))
    tool = next(t for t in shop.tools if t.name == "My D6")
    assert (tool.form, tool.gauge_length, tool.number) == ("bull", 54.0, 0)


def test_a_user_replaces_a_machine_of_the_same_name(tmp_path):
    text = """["Mill 1200"]
title = "Ours"
feed_max = 8000
tool_change_s = 9
tool_places = 24
axes = [
    { name = "X", kind = "linear", low = 0, high = 1000, rapid = 20000, acceleration = 2000 },
    { name = "Y", kind = "linear", low = 0, high = 500, rapid = 20000, acceleration = 2000 },
    { name = "Z", kind = "linear", low = 0, high = 500, rapid = 20000, acceleration = 2000 },
]
spindle = { low = 50, high = 12000, power = [[50, 1], [12000, 15]] }
"""
    shop = load_shop(folder(tmp_path, machines=text))
    assert shop.machine("Mill 1200").title == "Ours"
    assert "Gantry 4000" in shop.machines


def test_another_catalogue_has_another_digest(tmp_path):
    assert load_shop().digest == load_shop().digest
    assert load_shop(folder(tmp_path, holders=HOLDER, tools=TOOL)).digest != load_shop().digest


def test_a_user_without_a_folder_gets_the_programs_own(tmp_path):
    assert load_shop(tmp_path / "nothing here").digest == load_shop().digest


@pytest.mark.parametrize(("old", "new", "words"), [
    ("diameter = 6", "diameter = -6", "diameter must be a number from 0 to 1000; got -6"),
    ("teeth = 3", "teeth = 2.5", "teeth must be a whole number"),
    ("teeth = 3\n", "", "teeth is missing"),
    ("corner_radius = 1", "corner_radius = 4", "corner radius 4.0 does not fit diameter 6.0"),
    ('"Chuck"', '"Chuk"', "holder 'Chuk' is not in the catalogue"),
    ("helix_angle", "helix_angel", "is missing"),
    ('suits = ["N"]', 'suits = ["N"]\ncolour = "red"', "colour is not a field here"),
    ('suits = ["N"]', 'suits = ["X"]', "suits knows P, M, K, N, S, H; got 'X'"),
])
def test_a_fault_in_a_tool_is_told_in_one_line_with_file_entry_and_field(tmp_path, old, new, words):
    with pytest.raises(BadInput) as told:
        load_shop(folder(tmp_path, holders=HOLDER, tools=TOOL.replace(old, new)))
    line = str(told.value)
    assert "own.toml" in line and "My D6" in line and words in line and "\n" not in line


@pytest.mark.parametrize(("kind", "text", "words"), [
    ("holders", "rows = [", "own.toml: "),
    ("holders", "rows = 3", "rows must be a table"),
    ("holders", '["A"]\ntitle = "a"\nrows = [[5, 1, 9, 1]]\n', "rows must start at the nose"),
    ("machines", '["M"]\ntitle = "m"\naxes = []\nspindle = { low = 1, high = 2, power = [[1, 1]] }\n', "axes must be a list of tables"),
    ("materials", '["M"]\ntitle = "m"\niso_group = "Q"\n', "iso_group must be one of"),
    ("plans", '["P"]\ntitle = "p"\nfamily = "panel"\nstage = [{ name = "a", kind = "a", strategy = "a", on = [], cutter = "magic" }]\n',
     "cutter must be one of"),
    ("tools", '[drill."D6"]\n', "tables are named [tool.NAME] or [series.NAME]"),
])
def test_a_broken_file_is_told_in_one_line(tmp_path, kind, text, words):
    with pytest.raises(BadInput) as told:
        load_shop(folder(tmp_path, **{kind: text}))
    assert words in str(told.value) and "\n" not in str(told.value)


def test_an_unknown_name_lists_the_known_ones():
    with pytest.raises(BadInput, match="unknown material Brass; known: C45, EN AW-7050"):
        load_shop().material("Brass")
