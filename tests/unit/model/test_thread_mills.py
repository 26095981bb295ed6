"""Thread mills: what of them is checked, what they are taken to cut, and how deep their teeth go."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pytest import approx

from own_shop import own_shop
from parts import ROOT
from trunnion.findings import BadInput
from trunnion.model.tool.lead import basic_minor_diameter
from trunnion.model.tool.thread_mill import (
    cuts_pitch,
    groove_depth,
    lowest_tooth,
    root_width,
    teeth_along,
)
from trunnion.shop import load_shop
from trunnion.verify.cutter import lowest_height

SHOP = own_shop()
TOOLS = {t.name: t for t in SHOP.tools}
COMB, SINGLE = TOOLS["TM-C D6.3x1"], TOOLS["TM-S D12 P1-2.5"]
MILLS = [t for t in SHOP.tools if t.form == "thread-mill"]


def test_a_comb_is_taken_to_cut_what_is_inside_its_teeth():
    # ISO 724: M8x1 has a basic minor diameter of 6.917 mm, 1.083 mm less than its diameter.
    assert COMB.core_diameter == approx(6.3 - 1.083, abs=0.0005)
    heights = lowest_height(COMB, np.array([0.0, 2.6, 2.62]))
    assert list(heights) == [0.0, 0.0, math.inf]


def test_a_single_tooth_cuts_a_range_and_a_comb_its_pitch():
    assert [cuts_pitch(SINGLE, p) for p in (0.75, 1.0, 1.75, 2.5, 3.0)] == [
        False,
        *[True] * 3,
        False,
    ]
    assert [cuts_pitch(COMB, p) for p in (0.75, 1.0, 1.25)] == [False, True, False]
    assert (teeth_along(COMB), teeth_along(SINGLE)) == (12, 1)
    assert (lowest_tooth(COMB), lowest_tooth(SINGLE)) == (0.5, 1.25)


@given(st.sampled_from(MILLS), st.floats(0.0, 1.0), st.floats(1.05, 4.0))
def test_the_core_stays_inside_of_the_threads_minor_diameter_at_every_pitch(tool, share, times):
    """With its teeth at the bottom of a groove."""
    low, high = (tool.pitch, tool.pitch) if tool.pitch else (tool.pitch_low, tool.pitch_high)
    pitch = low + share * (high - low)
    diameter = times * (tool.diameter + 1.0825317 * pitch)
    minor = basic_minor_diameter(diameter, pitch)
    orbit = 0.5 * minor + groove_depth(tool, pitch) - tool.radius
    assert orbit + tool.core_radius <= 0.5 * minor + 1e-9
    if pitch == high:
        assert orbit + tool.core_radius == approx(0.5 * minor)


@given(st.sampled_from([t for t in MILLS if not t.pitch]), st.floats(0.0, 1.0))
def test_the_tooth_of_a_range_has_its_flanks_where_the_basic_profile_has_them(tool, share):
    """At the major diameter the groove is P / 8 wide: the tooth there is its own flat, and both flanks at 30 degrees."""
    pitch = tool.pitch_low + share * (tool.pitch_high - tool.pitch_low)
    extra = groove_depth(tool, pitch) - 5 / 8 * math.sqrt(3) / 2 * pitch
    assert tool.pitch_low / 8 + 2 * extra * math.tan(math.pi / 6) == approx(pitch / 8)
    # The groove stays inside of the fundamental triangle, H / 8 over the major diameter (ISO 68-1).
    assert extra <= math.sqrt(3) / 2 * pitch / 8


def test_a_tooth_is_three_quarters_of_its_coarsest_pitch_wide_at_the_core():
    # ISO 68-1: the groove is P / 8 wide at the major diameter, 3/4 P at the minor one.
    assert root_width(SINGLE) == approx(0.75 * 2.5)
    assert root_width(COMB) == approx(0.75 * 1.0)


@pytest.mark.parametrize(
    ("tool", "change", "words"),
    [
        (COMB, {"pitch": 0.0}, "needs a pitch above 0, or for a single tooth pitch_low"),
        (COMB, {"pitch_low": 1.0, "pitch_high": 2.0}, "needs a pitch above 0, or for"),
        (SINGLE, {"pitch_low": 3.0}, "needs a pitch above 0, or for"),
        (SINGLE, {"pitch_low": 0.0}, "needs a pitch above 0, or for"),
        (COMB, {"pitch": 6.0}, "too small for the height of its teeth"),
        (COMB, {"flute_length": 0.9}, "at least that of a tooth, 1.000 mm"),
        (SINGLE, {"flute_length": 1.8}, "at least that of a tooth, 1.875 mm"),
        (COMB, {"neck_diameter": 5.3}, "no thicker than its core, 5.217 mm"),
        (COMB, {"lead": 1.0}, "no corner radius, no lead and no fit"),
        (COMB, {"fit": "H7"}, "no corner radius, no lead and no fit"),
    ],
)
def test_numbers_that_make_no_thread_mill_are_refused(tool, change, words):
    with pytest.raises(ValueError, match=words):
        replace(tool, **change)


def test_a_range_of_pitches_is_of_thread_mills_alone():
    with pytest.raises(ValueError, match="only thread mills have a range of pitches"):
        replace(TOOLS["TAP-B M6x1"], pitch_low=1.0)


def test_the_list_of_tools_names_the_pitch_or_the_range_of_pitches():
    assert COMB.as_dict()["pitch"] == 1.0 and "pitch_low" not in COMB.as_dict()
    assert (SINGLE.as_dict()["pitch_low"], SINGLE.as_dict()["pitch_high"]) == (1.0, 2.5)
    assert "pitch" not in SINGLE.as_dict()


FILE = ROOT / "resources" / "trunnion_resources" / "tools" / "thread-mills.toml"


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("diameter = 2, pitch = 0.5,", "diameter = 2,", "a thread mill gives its pitch, either"),
        ("pitch_low = 0.5, ", "", "pitch_low is missing"),
        ("neck_diameter = 1.4", "neck_diameter = 1.5", "no thicker than its core"),
    ],
)
def test_a_fault_in_a_file_of_thread_mills_is_told_with_its_series(tmp_path, old, new, words):
    (tmp_path / "tools").mkdir()
    text = FILE.read_text("utf-8").replace(old, new, 1)
    (tmp_path / "tools" / "own.toml").write_text(text, "utf-8")
    with pytest.raises(BadInput, match=words):
        load_shop(tmp_path)


def test_an_inch_comb_has_the_pitch_of_its_threads_per_inch(tmp_path):
    (tmp_path / "tools").mkdir()
    text = FILE.read_text("utf-8").replace("pitch = 0.5,", "threads_per_inch = 50,", 1)
    (tmp_path / "tools" / "own.toml").write_text(text, "utf-8")
    assert "TM-C D2x0.508" in {t.name for t in load_shop(tmp_path).tools}
