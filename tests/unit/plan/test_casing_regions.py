"""Turning, interrupted turning or milling of the bottoms of casings: thresholds, bands, gaps and regions, by hand where they can be."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from trunnion.plan.casing.regions.bands import BossBox, bands_of, free_gaps, widened
from trunnion.plan.casing.regions.gaps import busy_time, shortest_gap, speed_for
from trunnion.plan.casing.regions.machining_regions import (
    around_bosses,
    merged,
    regions_of,
    same_kind,
    uncovered,
    without_slivers,
)
from trunnion.plan.casing.regions.settings import RegionSettings
from trunnion.plan.turning.retract import travel_time
from trunnion.recognize.casing.meridian import Meridian
from trunnion.settings import choose
from trunnion.units import radians

DRUM = Meridian.straight((0.0, 100.0), (100.0, 100.0))
CONE = Meridian.straight((0.0, 100.0), (100.0, 150.0))


def box(name: str, low: float, high: float, z_low: float, z_high: float) -> BossBox:
    return BossBox(
        boss=name, theta_low=radians(low), theta_high=radians(high), z_low=z_low, z_high=z_high
    )


def fixed(length: float):
    return lambda after, before: length


TWO = (box("a", 10.0, 20.0, 20.0, 50.0), box("b", 40.0, 60.0, 40.0, 70.0))


def settings_of(**words) -> RegionSettings:
    return choose(RegionSettings, words)


def test_a_short_way_is_accelerated_and_braked_and_a_long_one_has_a_stretch_at_full_speed() -> None:
    # v2 / a = 10 mm: below, 2 sqrt(L / a); above, L / v + v / a.
    assert travel_time(2.5, 100.0, 1000.0) == pytest.approx(0.1)
    assert travel_time(40.0, 100.0, 1000.0) == pytest.approx(0.5)


def test_the_shortest_gap_is_the_way_of_the_ground_while_the_tool_is_busy() -> None:
    # 60 m/min are 1000 mm/s; out and in over 40 mm takes 0.5 s each, and the cut 0.1 s: 1100 mm and 50 mm of margin, times 2.
    chosen = settings_of(
        surface_speed=60.0,
        retract_speed=6.0,
        acceleration=1000.0,
        clearance=10.0,
        shortest_cut=0.1,
        margin=50.0,
        shop_factor=2.0,
    )
    assert busy_time(30.0, chosen) == pytest.approx(1.1)
    assert shortest_gap(30.0, chosen) == pytest.approx(2.0 * (1100.0 + 50.0))
    assert shortest_gap(30.0, settings_of(threshold=60.0)) == 60.0


def test_a_lower_speed_is_offered_where_it_makes_a_gap_long_enough_and_the_grade_allows_it() -> (
    None
):
    chosen = settings_of(surface_speed=60.0, lowest_speed=20.0)
    arc = 0.5 * shortest_gap(10.0, chosen)
    speed = speed_for(arc, 10.0, chosen)
    assert speed is not None and 20.0 < speed < 60.0
    assert shortest_gap(10.0, settings_of(surface_speed=speed)) == pytest.approx(arc)
    assert speed_for(0.1 * arc, 10.0, chosen) is None
    assert speed_for(arc, 10.0, settings_of(threshold=60.0)) is None


def test_bounds_of_bosses_and_the_ends_cut_a_bottom_into_bands() -> None:
    bands = bands_of(DRUM, TWO, fixed(60.0))
    assert [b.z for b in bands] == [(0, 20), (20, 40), (40, 50), (50, 70), (70, 100)]
    assert [b.bosses for b in bands] == [(), ("a",), ("a", "b"), ("b",), ()]
    assert [b.kind for b in bands] == ["turn", "interrupted", "mill", "interrupted", "turn"]
    short, long = bands[2].gaps
    assert (short.after, short.before) == ("a", "b")
    assert short.arc == pytest.approx(100.0 * radians(20.0))
    assert long.arc == pytest.approx(100.0 * radians(310.0)) and long.long_enough


def test_a_gap_that_is_just_as_long_as_needed_is_turned() -> None:
    arc = 100.0 * radians(20.0)
    assert bands_of(DRUM, TWO, fixed(arc))[2].kind == "interrupted"
    assert bands_of(DRUM, TWO, fixed(arc + 0.01))[2].kind == "mill"


def test_overlapping_bosses_count_as_one_and_over_zero_too() -> None:
    boxes = (box("a", -10.0, 10.0, 0, 1), box("b", 5.0, 30.0, 0, 1), box("c", 340.0, 352.0, 0, 1))
    (gap,) = free_gaps(boxes, 100.0, fixed(1.0))
    assert (gap.after, gap.before) == ("b", "c")
    assert np.degrees(gap.theta) == pytest.approx((30.0, 340.0))


def test_bosses_all_round_leave_no_gap_and_the_band_is_milled() -> None:
    ring = tuple(box(str(k), 90.0 * k - 1.0, 90.0 * k + 91.0, 10.0, 20.0) for k in range(4))
    assert bands_of(DRUM, ring, fixed(1.0))[1].gaps == ()
    assert bands_of(DRUM, ring, fixed(1.0))[1].kind == "mill"


def test_neighbouring_bands_of_one_kind_become_one() -> None:
    runs = merged(bands_of(DRUM, TWO, fixed(1.0)), same_kind)
    assert [(r.z, r.kind) for r in runs] == [
        ((0, 20), "turn"),
        ((20, 70), "interrupted"),
        ((70, 100), "turn"),
    ]
    assert runs[1].bosses == ("a", "b")


def test_a_long_gap_of_a_milled_band_is_a_region_to_be_turned_by_itself() -> None:
    regions = regions_of(bands_of(DRUM, TWO, fixed(60.0)), DRUM)
    shown = {(r.z, r.kind, r.after, r.before) for r in regions}
    assert ((40, 50), "mill", "a", "b") in shown and ((40, 50), "interrupted", "b", "a") in shown


def test_a_gap_goes_on_over_bands_as_long_as_it_keeps_its_neighbours() -> None:
    boxes = (*TWO, box("c", 200.0, 210.0, 45.0, 48.0))
    regions = regions_of(bands_of(DRUM, boxes, fixed(60.0)), DRUM)
    assert [r.z for r in regions if (r.after, r.before) == ("a", "b")] == [(40.0, 50.0)]


def test_a_boss_is_widened_by_the_same_length_on_all_sides() -> None:
    wide = widened(box("a", 10.0, 20.0, 20.0, 50.0), CONE, 5.0)
    assert (wide.z_low, wide.z_high) == (15.0, 55.0)
    # The smallest radius that it reaches is at z = 15: 107.5 mm.
    assert wide.theta_low == pytest.approx(radians(10.0) - 5.0 / 107.5)


def test_a_free_band_narrower_than_the_insert_goes_to_the_turned_one_beside_it() -> None:
    boxes = (box("a", 10.0, 20.0, 20.0, 50.0), box("b", 40.0, 60.0, 53.0, 70.0))
    bands = without_slivers(bands_of(DRUM, boxes, fixed(60.0)), 8.0)
    assert [b.kind for b in bands] == ["turn", "interrupted", "interrupted", "interrupted", "turn"]


@given(
    st.lists(
        st.tuples(
            st.floats(0.0, 360.0), st.floats(1.0, 80.0), st.floats(1.0, 90.0), st.floats(1.0, 40.0)
        ),
        max_size=7,
    ),
    st.floats(0.0, 300.0),
)
def test_regions_and_bosses_cover_the_bottom_exactly_once(rows, threshold) -> None:
    boxes = [box(str(n), at, at + wide, z, z + high) for n, (at, wide, z, high) in enumerate(rows)]
    for meridian in (DRUM, CONE):
        bands = bands_of(meridian, boxes, fixed(threshold))
        regions = regions_of(bands, meridian)
        assert uncovered(regions, around_bosses(bands, meridian), meridian) < 1e-9


def test_the_area_of_a_cone_is_that_of_guldin() -> None:
    # Mean radius 125 mm, slant length sqrt(100^2 + 50^2).
    assert CONE.area(0.0, 100.0, 2.0 * pi) == pytest.approx(
        2.0 * pi * 125.0 * np.hypot(100.0, 50.0)
    )
