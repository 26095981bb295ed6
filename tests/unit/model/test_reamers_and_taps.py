"""Reamers and taps: what of them is checked, what they are taken to cut, and how their numbers come back from files."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from own_shop import own_shop
from parts import ROOT
from trunnion.findings import BadInput
from trunnion.model.tool.lead import basic_minor_diameter
from trunnion.post.header import tool_line
from trunnion.settings import digest
from trunnion.shop import load_shop
from trunnion.verify.cutter import lowest_height, outline_of

SHOP = own_shop()
TOOLS = {t.name: t for t in SHOP.tools}
REAMER = TOOLS["RE-H7 D8"]
TAP = TOOLS["TAP-B M6x1"]


@pytest.mark.parametrize(
    ("diameter", "pitch", "minor"),
    # ISO 724:1993, table 1: basic minor diameters D1.
    [
        (3.0, 0.5, 2.459),
        (6.0, 1.0, 4.917),
        (8.0, 1.0, 6.917),
        (10.0, 1.5, 8.376),
        (24.0, 3.0, 20.752),
    ],
)
def test_the_core_of_a_tap_is_the_basic_minor_diameter_of_the_standard(diameter, pitch, minor):
    assert basic_minor_diameter(diameter, pitch) == pytest.approx(minor, abs=0.0005)


@given(st.floats(0.2, 6.0), st.floats(1.1, 30.0))
def test_a_thread_is_as_deep_as_its_pitch_says_whatever_its_diameter(pitch, times):
    diameter = times * 1.25 * pitch
    depth = (diameter - basic_minor_diameter(diameter, pitch)) / 2
    assert depth == pytest.approx(0.541266 * pitch, rel=1e-5)


def test_a_tap_is_taken_to_cut_the_cylinder_of_its_core():
    assert TAP.core_diameter == pytest.approx(4.9175, abs=1e-4)
    assert outline_of(TAP)[-1][:4] == pytest.approx(
        (TAP.core_radius, 0.0, TAP.core_radius, TAP.flute_length)
    )
    heights = lowest_height(TAP, np.array([0.0, 2.45, 2.47]))
    assert list(heights) == [0.0, 0.0, math.inf]


def test_a_reamer_is_taken_to_cut_a_cylinder_with_a_chamfer_of_45_degrees():
    assert (REAMER.lead, REAMER.fit, REAMER.core_diameter) == (0.8, "H7", 8.0)
    heights = lowest_height(REAMER, np.array([3.2, 3.6, 3.999, 4.1]))
    assert list(heights) == pytest.approx([0.0, 0.4, 0.799, math.inf])


def test_a_reamer_and_a_tap_make_their_whole_size_above_the_lead():
    assert (REAMER.point_length, REAMER.full_width_height) == (0.8, 0.8)
    assert (TAP.point_length, TAP.full_width_height) == (5.0, 5.0)
    assert TOOLS["AL3-regular D12 R3"].point_length == 0.0


def test_a_shank_as_thick_as_a_tap_does_not_follow_it_into_the_hole():
    assert (TAP.shank_diameter, TAP.reach) == (6.0, 30.0)
    assert TOOLS["TAP-B M12x1.75"].reach == TOOLS["TAP-B M12x1.75"].stickout
    assert TAP.rings()[:2] == [(0.0, TAP.core_radius), (30.0, 3.0)]


@pytest.mark.parametrize(
    ("tool", "change", "words"),
    [
        (REAMER, {"lead": 0.0}, "needs a lead between 0 and its radius"),
        (REAMER, {"lead": 4.0}, "needs a lead between 0 and its radius"),
        (REAMER, {"fit": ""}, "needs the fit that it makes"),
        (REAMER, {"pitch": 1.0}, "no corner radius and no pitch"),
        (REAMER, {"corner_radius": 0.5}, "no corner radius and no pitch"),
        (TAP, {"pitch": 0.0}, "needs a pitch above 0"),
        (TAP, {"pitch": 6.0}, "needs a pitch above 0"),
        (TAP, {"lead": 0.0}, "needs a lead above 0"),
        (TAP, {"lead": 15.0}, "shorter than its thread"),
        (TAP, {"fit": "H7"}, "no corner radius and no fit"),
        (TOOLS["FB D20-26"], {"smallest": 27.0}, "up to its largest"),
        (TOOLS["FB D20-26"], {"smallest": 18.0}, "thinner than the smallest"),
        (TOOLS["FB D20-26"], {"lead": 0.0}, "a lead above 0"),
        (TOOLS["RE-H7 D10"], {"smallest": 9.0}, "only boring bars"),
        (
            TOOLS["DR-K D8"],
            {"lead": 1.0},
            "of tools for threads and fits, not of the form drill",
        ),
        (TAP, {"neck_diameter": 5.0}, "no thicker than the core, 4.917 mm"),
    ],
)
def test_numbers_that_make_no_reamer_and_no_tap_are_refused(tool, change, words):
    with pytest.raises(ValueError, match=words):
        replace(tool, **change)


def test_tools_of_other_forms_keep_the_digest_that_they_had():
    mill = TOOLS["AL3-regular D12 R3"]
    assert digest(replace(mill, pitch=0.0)) == digest(mill)
    assert digest(replace(TAP, pitch=0.75)) != digest(TAP)


def test_the_list_of_tools_names_pitch_lead_and_fit_of_those_that_have_them():
    assert REAMER.as_dict()["fit"] == "H7" and "pitch" not in REAMER.as_dict()
    assert (TAP.as_dict()["pitch"], TAP.as_dict()["lead"]) == (1.0, 5.0)
    assert not {"pitch", "lead", "fit"} & set(TOOLS["AL3-regular D12 R3"].as_dict())


def test_taps_for_open_holes_have_the_long_lead_and_those_for_blind_ones_the_short():
    through, blind = (
        {t.name[6:]: t for t in SHOP.tools_for("N", use)} for use in ("tap_through", "tap_blind")
    )
    assert set(through) == set(blind) and len(through) >= 40
    # DIN 2197: form B 3.5 to 5.5 threads, form C 2 to 3.
    assert all(3.5 <= t.lead / t.pitch <= 5.5 for t in through.values())
    assert all(2.0 <= t.lead / t.pitch <= 3.0 for t in blind.values())


def test_every_half_millimetre_from_2_to_20_has_a_reamer_that_is_named_by_its_fit():
    sizes = {t.diameter for t in SHOP.tools_for("S", "ream")}
    assert sizes >= {2.0 + 0.5 * k for k in range(37)}
    assert all(t.fit == "H7" and t.name.startswith("RE-H7 D") for t in SHOP.tools_for("S", "ream"))


def test_an_inch_tap_has_the_pitch_of_its_threads_per_inch():
    tap = TOOLS["TAP-C UNC 1/4-20"]
    assert (tap.diameter, tap.pitch, tap.lead) == (6.35, 25.4 / 20, 2.5 * 25.4 / 20)


TAPS = (ROOT / "resources" / "trunnion_resources" / "tools" / "taps.toml").read_text("utf-8")


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('use = ["tap_through"]\n', "", "TAP-B: use is missing"),
        (
            "diameter = 3, pitch = 0.5",
            "diameter = 3",
            "gives its pitch, either as pitch in mm or as",
        ),
        ("pitch = 0.5,", "pitch = 0.5, threads_per_inch = 20,", "gives its pitch, either"),
        ("lead_threads = 5\n", "", "lead_threads is missing"),
        ('thread = "#4-40 UNC"', 'thread = "UNC"', "such as 1/4-20 UNC; got 'UNC'"),
    ],
)
def test_a_fault_in_a_file_of_taps_is_told_with_its_series(tmp_path, old, new, words):
    (tmp_path / "tools").mkdir()
    (tmp_path / "tools" / "own.toml").write_text(TAPS.replace(old, new, 1), "utf-8")
    with pytest.raises(BadInput, match=words):
        load_shop(tmp_path)


def test_a_lead_may_be_given_in_mm(tmp_path):
    (tmp_path / "tools").mkdir()
    text = TAPS.replace("lead_threads = 5\n", "lead = 1.75\n", 1)
    (tmp_path / "tools" / "own.toml").write_text(text, "utf-8")
    shop = load_shop(tmp_path)
    assert {t.lead for t in shop.tools_for("N", "tap_through")} == {1.75}


def test_a_programs_header_names_the_pitch_of_a_tap():
    assert tool_line(TAP, "mm").startswith("TOOL 0 TAP-B M6x1 D6 PITCH 1 LENGTH 150 ")
    assert " R0 " in tool_line(REAMER, "mm")
