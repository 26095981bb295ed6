"""The catalogues: what they hold, what a user's folder changes, and the line a fault in a file gets."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from trunnion import registry
from trunnion.findings import BadInput
from trunnion.model.tool import BUTTON
from trunnion.shop import load_shop
from trunnion.verify.cutter import bodies_of
from trunnion.verify.kernels.body import radius_at
from verify_tools import FORMS

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


def test_the_catalogue_has_cutters_of_every_form():
    assert {t.form for t in load_shop().tools} == {
        "flat",
        "bull",
        "ball",
        "taper",
        "barrel",
        "t-slot",
        "drill",
        "reamer",
        "boring-bar",
        "tap",
        "thread-mill",
        "button",
        "form",
    }


def test_the_tests_have_a_tool_of_every_form_of_the_catalogue():
    """What holds of tools of every form is tested on these; a button is a ball to all that cut."""
    assert {t.form for t in load_shop().tools} - {BUTTON} <= {t.form for t in FORMS.values()}


def test_ball_ends_are_for_curved_faces_and_keep_out_of_plane_work():
    shop = load_shop()
    balls = {t.diameter for t in shop.tools_for("S", "surface") if t.form == "ball"}
    assert balls == {2, 3, 4, 5, 6, 8, 10, 12, 16, 20}
    assert not {t.form for use in ("face", "rough", "finish") for t in shop.tools_for("N", use)} - {
        "flat",
        "bull",
    }


@pytest.mark.parametrize(
    ("name", "field", "value"),
    [
        ("AL2-ball D6 R3", "corner_radius", 3.0),
        ("HM4-taper D4 R2 A4", "taper_angle", 4.0),
        ("HM4-barrel D10 R2 B85", "barrel_radius", 85.0),
        ("UC6 D20 R0.5 H4", "flute_length", 4.0),
        ("DR-L D8.5", "point_angle", 140.0),
    ],
)
def test_a_cutter_is_named_by_what_its_form_needs(name, field, value):
    tool = next(t for t in load_shop().tools if t.name == name)
    assert getattr(tool, field) == value


def test_a_tapered_cutter_is_no_thicker_than_its_shank_where_its_flutes_end():
    for tool in (t for t in load_shop().tools if t.form == "taper"):
        body = bodies_of([tool])
        assert (
            radius_at(body.arc, 0, int(body.piece[0, 1]), tool.flute_length)
            <= tool.shank_diameter / 2
        )


def test_drills_reach_as_deep_as_their_standard_says():
    drills = {t.name: t for t in load_shop().tools_for("N", "drill")}
    assert [
        drills[name].flute_length for name in ("DR-K D6", "DR-L D6", "DR-K D10.2", "DR-L D20")
    ] == [28.0, 44.0, 55.0, 101.0]
    assert drills["DR-L D6"].point_length == pytest.approx(3.0 / math.tan(math.radians(70.0)))


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
    assert stages[0] == "face" and stages[-2:] == ["profile_finish", "corner_finish"]


PLAN = """
["{name}"]
title = "a plan"
family = "panel"
stage = [{{ name = "a", kind = "face", strategy = "plane.face", on = ["blank"], cutter = "{cutter}", finish = true, rule = "first" }}]
"""


def plans(tmp_path, *names, cutter="face"):
    return load_shop(
        folder(tmp_path, plans="".join(PLAN.format(name=name, cutter=cutter) for name in names))
    )


def test_a_shop_s_own_plan_comes_before_the_program_s_whatever_its_name(tmp_path):
    shop = plans(tmp_path, "Zebra", "Antelope")
    assert shop.plan_for("panel").name == "Zebra"
    assert shop.plan_for("surface").name == load_shop().plan_for("surface").name


def test_a_plan_is_taken_by_its_name(tmp_path):
    assert plans(tmp_path, "Zebra", "Antelope").plan_for("panel", "Antelope").name == "Antelope"


def test_a_plan_of_another_family_is_not_taken_by_its_name(tmp_path):
    with pytest.raises(
        BadInput, match="unknown typical plan for the family surface, Zebra; known: Curved surfaces"
    ):
        plans(tmp_path, "Zebra").plan_for("surface", "Zebra")


def test_the_order_of_plans_is_part_of_what_a_plan_was_made_with(tmp_path):
    (tmp_path / "a").mkdir(), (tmp_path / "b").mkdir()
    assert (
        plans(tmp_path / "a", "Zebra", "Antelope").digest
        != plans(tmp_path / "b", "Antelope", "Zebra").digest
    )


def test_a_cutter_rule_is_checked_by_the_planner_that_reads_the_plan(tmp_path):
    from trunnion.plan.typical import typical_plan

    shop = plans(tmp_path, "Zebra", cutter="layers")
    assert typical_plan(shop, "panel", "Zebra", ("layers",)).name == "Zebra"
    with pytest.raises(
        BadInput,
        match="typical plan Zebra, stage a: cutter must be one of face, rough; got 'layers'",
    ):
        typical_plan(shop, "panel", "", ("face", "rough"))


@pytest.mark.parametrize("family", ["panel", "surface"])
def test_our_plans_keep_to_the_rules_of_their_planners(family):
    from trunnion.plan.contract import planner_for
    from trunnion.plan.typical import typical_plan

    assert typical_plan(load_shop(), family, "", planner_for(family).cutter_rules).family == family


def test_a_user_adds_a_cutter_in_a_holder_of_his_own(tmp_path):
    shop = load_shop(folder(tmp_path, holders=HOLDER, tools=TOOL))
    tool = next(t for t in shop.tools if t.name == "My D6")
    assert (tool.form, tool.gauge_length, tool.number) == ("bull", 54.0, 0)


@pytest.mark.parametrize(
    ("form", "fields", "said"),
    [
        ("taper", "taper_angle = 5", {"taper_angle": 5.0}),
        ("barrel", "barrel_radius = 30", {"barrel_radius": 30.0}),
        ("t-slot", "", {}),
        ("drill", "point_angle = 118", {"point_angle": 118.0, "corner_radius": 0.0}),
        ("reamer", 'lead = 0.5\nfit = "F8"', {"lead": 0.5, "fit": "F8"}),
        ("tap", 'pitch = 0.25\nlead = 2.5\nuse = ["tap_blind"]', {"pitch": 0.25, "lead": 2.5}),
        (
            "form",
            "outline = [[1, 0, 0], [2, 1, -0.3], [3, 12, 0]]",
            {"outline": ((1.0, 0.0, 0.0), (2.0, 1.0, -0.3), (3.0, 12.0, 0.0))},
        ),
    ],
)
def test_a_user_adds_a_cutter_of_any_form(tmp_path, form, fields, said):
    text = TOOL.replace("diameter = 6", f'form = "{form}"\ndiameter = 6\n{fields}', 1)
    text = (
        text.replace("corner_radius = 1\n", "")
        if form in ("drill", "reamer", "tap", "form")
        else text
    )
    tool = next(
        t
        for t in load_shop(folder(tmp_path, holders=HOLDER, tools=text)).tools
        if t.name == "My D6"
    )
    assert tool.form == form and {name: getattr(tool, name) for name in said} == said


MACHINE = """
["M"]
title = "m"
feed_max = 100
tool_change_s = 1
tool_places = 1
axes = [
    { name = "X", kind = "linear", low = 0, high = 9, rapid = 9, acceleration = 9 },
    { name = "Y", kind = "linear", low = 0, high = 9, rapid = 9, acceleration = 9 },
    { name = "Z", kind = "linear", low = 0, high = 9, rapid = 9, acceleration = 9 },
]
spindle = { low = 1, high = 2, power = [[1, 1]] }
"""


def test_a_machine_names_its_control_or_has_linuxcnc(tmp_path):
    named = MACHINE.replace('"M"', '"N"') + 'control = "apt"\n'
    shop = load_shop(folder(tmp_path, machines=MACHINE + named))
    assert (shop.machine("M").control, shop.machine("N").control) == ("linuxcnc", "apt")


def test_a_machine_of_a_control_that_nobody_writes_for_is_refused(tmp_path):
    text = MACHINE + 'control = "abacus"\n'
    known = ", ".join(registry.names("dialects"))
    with pytest.raises(BadInput, match=f"M: control must be one of {known}; got 'abacus'"):
        load_shop(folder(tmp_path, machines=text))


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


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("diameter = 6", "diameter = -6", "diameter must be a number from 0 to 1000; got -6"),
        ("teeth = 3", "teeth = 2.5", "teeth must be a whole number"),
        ("teeth = 3\n", "", "teeth is missing"),
        ("corner_radius = 1", "corner_radius = 4", "corner radius 4.0 does not fit diameter 6.0"),
        ('"Chuck"', '"Chuk"', "holder 'Chuk' is not in the catalogue"),
        ("helix_angle", "helix_angel", "is missing"),
        ('suits = ["N"]', 'suits = ["N"]\ncolour = "red"', "colour is not a field here"),
        ('suits = ["N"]', 'suits = ["X"]', "suits knows P, M, K, N, S, H; got 'X'"),
        (
            "teeth = 3",
            'teeth = 3\nform = "saw"',
            "form knows end mill, taper, barrel, t-slot, drill, reamer, boring-bar, tap, thread-mill, button, form; got 'saw'",
        ),
        ("teeth = 3", 'teeth = 3\nform = "taper"', "taper_angle is missing"),
        (
            "teeth = 3",
            'teeth = 3\nform = "taper"\ntaper_angle = 95',
            "taper_angle must be a number from 0 to 90; got 95",
        ),
        (
            "teeth = 3",
            'teeth = 3\nform = "barrel"\nbarrel_radius = 2',
            "a barrel's tip radius, radius and barrel radius must grow",
        ),
        ("teeth = 3", "teeth = 3\ntaper_angle = 5", "taper_angle is not a field here"),
        (
            "corner_radius = 1",
            'form = "form"\noutline = [[1, 2], [3, 12]]',
            "outline must be rows of 3 numbers",
        ),
        (
            "corner_radius = 1",
            'form = "form"\noutline = [[1, 0, 0], [3, 11, 0]]',
            "the outline must rise from 0 to the flute length",
        ),
    ],
)
def test_a_fault_in_a_tool_is_told_in_one_line_with_file_entry_and_field(tmp_path, old, new, words):
    with pytest.raises(BadInput) as told:
        load_shop(folder(tmp_path, holders=HOLDER, tools=TOOL.replace(old, new)))
    line = str(told.value)
    assert "own.toml" in line and "My D6" in line and words in line and "\n" not in line


@pytest.mark.parametrize(
    ("kind", "text", "words"),
    [
        ("holders", "rows = [", "own.toml: "),
        ("holders", "rows = 3", "rows must be a table"),
        ("holders", '["A"]\ntitle = "a"\nrows = [[5, 1, 9, 1]]\n', "rows must start at the nose"),
        (
            "machines",
            '["M"]\ntitle = "m"\naxes = []\nspindle = { low = 1, high = 2, power = [[1, 1]] }\n',
            "axes must be a list of tables",
        ),
        ("materials", '["M"]\ntitle = "m"\niso_group = "Q"\n', "iso_group must be one of"),
        (
            "plans",
            '["P"]\ntitle = "p"\nfamily = "panel"\nstage = [{ name = "a", kind = "a", strategy = "a", on = [] }]\n',
            "cutter is missing",
        ),
        ("tools", '[drill."D6"]\n', "tables are named [tool.NAME] or [series.NAME]"),
    ],
)
def test_a_broken_file_is_told_in_one_line(tmp_path, kind, text, words):
    with pytest.raises(BadInput) as told:
        load_shop(folder(tmp_path, **{kind: text}))
    assert words in str(told.value) and "\n" not in str(told.value)


def test_the_papers_material_has_figures_of_its_own_with_their_sources():
    found = load_shop().material("EN AW-6061")
    assert (found.iso_group, found.density, found.force, found.force_exponent) == (
        "N",
        2.70,
        800.0,
        0.25,
    )
    assert "VDI 3323" in found.source and found.source.count(";") >= 6


def test_an_unknown_name_lists_the_known_ones():
    with pytest.raises(
        BadInput, match="unknown material Brass; known: C45, EN AW-6061, EN AW-7050"
    ):
        load_shop().material("Brass")
