"""What a person demands of holes: fits and threads, checked against the bore, kept in numbers, taken away again."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pytest import approx

from holed import HIGH, feature, hole
from own_shop import own_shop
from trunnion.findings import BadInput
from trunnion.geometry.frame import WORLD, Frame
from trunnion.model.feature import Feature, Recognition
from trunnion.plan.holes.demand import (
    bore_demands,
    demand_of,
    fit_demand,
    fits_within,
    needs_reaming,
    thread_demand,
    with_demand,
)
from trunnion.plan.holes.hole import bore_start, hole_in, is_plain_through, thread_of

SHOP = own_shop()
WIDER = {"counterbore_diameter": 18.0, "counterbore_depth": 6.0}


def recognition(*holes, frame=WORLD):
    features = tuple(feature(n, h) for n, h in enumerate(holes, 1))
    pocket = Feature(id="pocket-01", kind="pocket", faces=())
    return Recognition(family="panel", frame=frame, features=(*features, pocket))


def demanded(sizes, demand):
    return with_demand(recognition(sizes), ["hole-01"], demand, SHOP).feature("hole-01")


def test_a_fit_stands_on_the_hole_in_words_and_in_mm():
    made = demanded(hole(30, 20, 10), fit_demand("H7"))
    assert made.attributes["fit"] == "H7"
    assert (made.sizes["fit_lower"], made.sizes["fit_upper"]) == approx((0.0, 0.015))
    assert demand_of(made) == fit_demand("H7")
    assert needs_reaming(made, SHOP)


def test_a_thread_stands_on_the_hole_in_words_and_in_mm():
    made = demanded(hole(30, 20, 5), thread_demand("m6 x 1", 8.0))
    assert made.attributes["thread"] == "M6"
    thread = thread_of(made)
    assert (thread.diameter, thread.pitch, thread.depth) == (6.0, 1.0, 8.0)
    assert hole_in(made, WORLD, WORLD).thread == thread


def test_several_holes_get_a_demand_together_and_others_stay_the_same():
    before = recognition(hole(10, 10, 10), hole(30, 20, 10), hole(50, 20, 10))
    after = with_demand(before, ["hole-01", "hole-03"], fit_demand("H7"), SHOP)
    assert ["fit" in f.attributes for f in after.of_kind("hole")] == [True, False, True]
    assert after.feature("hole-02") is before.feature("hole-02")


def test_a_demand_is_taken_away_without_words():
    before = recognition(hole(30, 20, 10))
    once = with_demand(before, ["hole-01"], fit_demand("H7"), SHOP)
    again = with_demand(once, ["hole-01"], fit_demand(""), SHOP).feature("hole-01")
    assert dict(again.sizes) == dict(before.feature("hole-01").sizes)
    assert not {"fit", "thread"} & set(again.attributes)


def test_a_demand_takes_the_place_of_the_one_before():
    made = demanded(hole(30, 20, 8.5), fit_demand("H7"))
    threaded = with_demand(
        Recognition(family="panel", features=(made,)), [made.id], thread_demand("M10"), SHOP
    ).feature(made.id)
    assert "fit" not in threaded.attributes and "fit_upper" not in threaded.sizes
    assert threaded.attributes["thread"] == "M10"


def test_the_same_demand_again_changes_nothing():
    once = with_demand(recognition(hole(30, 20, 10)), ["hole-01"], fit_demand("H7"), SHOP)
    assert with_demand(once, ["hole-01"], fit_demand("H7"), SHOP) is once


@pytest.mark.parametrize(
    ("id", "demand", "words"),
    [
        ("hole-09", fit_demand("H7"), "there is no feature hole-09; holes: hole-01"),
        ("pocket-01", fit_demand("H7"), "pocket-01 is a pocket"),
        ("hole-01", fit_demand("Q77"), "hole-01: "),
        ("hole-01", thread_demand("M6"), r"M6 needs a bore of 4\.917 to 5\.153 mm.* has 10 mm"),
        ("hole-01", thread_demand("W3/8"), "hole-01: "),
        ("hole-01", replace(fit_demand("H7"), thread="M10"), "not both"),
        ("hole-01", replace(fit_demand("H7"), thread_depth=5.0), "name the thread too"),
    ],
)
def test_what_a_hole_does_not_bear_is_refused_in_one_line(id, demand, words):
    with pytest.raises(BadInput, match=words) as caught:
        with_demand(recognition(hole(30, 20, 10)), [id], demand, SHOP)
    assert "\n" not in str(caught.value)


def test_a_thread_deeper_than_its_bore_is_refused():
    with pytest.raises(BadInput, match=r"15 mm deep does not fit into its bore of 14 mm"):
        demanded(hole(30, 20, 8.5, HIGH, **WIDER), thread_demand("M10", 15.0))


@pytest.mark.parametrize(("fit", "reamed"), [("H6", 1), ("H9", 1), ("H10", 0), ("H11", 0)])
def test_bores_are_reamed_to_fits_finer_than_drills_hold(fit, reamed):
    assert needs_reaming(demanded(hole(30, 20, 10), fit_demand(fit)), SHOP) == bool(reamed)


@pytest.mark.parametrize(
    ("fit", "served"),
    [("H7", True), ("H8", True), ("+0.02/0", True), ("H6", False), ("G7", False), ("K7", False)],
)
def test_a_reamer_serves_fits_whose_limits_hold_its_own(fit, served):
    made = demanded(hole(30, 20, 10), fit_demand(fit))
    assert fits_within(made, ["H7"], SHOP) == (("H7",) if served else ())


def test_a_bore_begins_at_the_floor_of_its_deepest_counterbore():
    assert bore_start(feature(1, hole(30, 20, 9))) == 0.0
    assert bore_start(feature(1, hole(30, 20, 9, **WIDER))) == 6.0
    narrow = hole_in(feature(1, hole(30, 20, 9, **WIDER)), WORLD, WORLD).narrow
    assert (narrow.top, narrow.bottom) == approx((HIGH - 6.0, 0.0))


def test_a_thread_that_ends_within_a_hole_is_cut_from_its_mouth():
    whole = demanded(hole(30, 20, 5), thread_demand("M6"))
    short = demanded(hole(30, 20, 5), thread_demand("M6", 8.0))
    assert is_plain_through(whole) and not is_plain_through(short)


def test_the_proof_is_told_of_threads_and_fine_fits_where_they_stand_in_the_part():
    frame = Frame(np.array([5.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0]), np.array([1.0, 0.0, 0.0]))
    found = recognition(
        hole(30, 20, 10, **WIDER), hole(40, 20, 5, 12.0), hole(50, 20, 9), frame=frame
    )
    found = with_demand(found, ["hole-01"], fit_demand("H7"), SHOP)
    found = with_demand(found, ["hole-02"], thread_demand("M6", 8.0), SHOP)
    found = with_demand(found, ["hole-03"], fit_demand("H12"), SHOP)
    fit, thread = bore_demands(found, SHOP)
    assert (fit.feature, fit.fits, fit.is_thread) == ("hole-01", ("H7",), False)
    assert (thread.thread_diameter, thread.pitch, thread.thread_depth) == (6.0, 1.0, 8.0)
    local = found.feature("hole-01").sizes
    begins = np.array([local["x"], local["y"], local["top_z"] - 6.0])
    assert fit.start == approx(frame.to_world(begins[None])[0])
    assert fit.out == approx(frame.z) and fit.depth == approx(HIGH - 6.0)


@given(diameter=st.floats(2.0, 60.0), fit=st.sampled_from(["H6", "H7", "H8", "F8", "JS7", "P7"]))
def test_a_fit_lies_within_itself_and_its_limits_are_in_order(diameter, fit):
    made = demanded(hole(30, 20, round(diameter, 3)), fit_demand(fit))
    assert made.sizes["fit_lower"] < made.sizes["fit_upper"]
    assert fit in fits_within(made, [fit, "H13"], SHOP)
