"""Screw threads by their names, against figures printed in the standards, and the taps of the catalogue against them."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from own_shop import own_shop
from trunnion.findings import BadInput
from trunnion.shop import load_shop

SHOP = own_shop()
METRIC = [(d, p) for d, p, _ in SHOP.threads.metric]


@pytest.mark.parametrize(
    ("text", "name", "diameter", "pitch", "low", "high"),
    # Metric: ISO 965-2, class 6H. Inches: ASME B1.1, class 2B.
    [
        ("M3", "M3", 3.0, 0.5, 2.459, 2.599),
        ("M4", "M4", 4.0, 0.7, 3.242, 3.422),
        ("M5", "M5", 5.0, 0.8, 4.134, 4.334),
        ("M6", "M6", 6.0, 1.0, 4.917, 5.153),
        ("M8", "M8", 8.0, 1.25, 6.647, 6.912),
        ("M8x1", "M8x1", 8.0, 1.0, 6.917, 7.153),
        ("M10", "M10", 10.0, 1.5, 8.376, 8.676),
        ("M12", "M12", 12.0, 1.75, 10.106, 10.441),
        ("M16", "M16", 16.0, 2.0, 13.835, 14.210),
        ("M20", "M20", 20.0, 2.5, 17.294, 17.744),
        ("M24", "M24", 24.0, 3.0, 20.752, 21.252),
        ("1/4-20 UNC", "1/4-20 UNC", 6.35, 1.27, 0.196 * 25.4, 0.207 * 25.4),
        ("#4-40 UNC", "#4-40 UNC", 2.8448, 0.635, 0.0849 * 25.4, 0.0939 * 25.4),
        ("10-32 UNF", "#10-32 UNF", 4.826, 0.79375, 0.156 * 25.4, 0.164 * 25.4),
        ("3/8-24 UNF", "3/8-24 UNF", 9.525, 25.4 / 24, 0.330 * 25.4, 0.340 * 25.4),
    ],
)
def test_threads_have_the_sizes_and_core_limits_that_the_standards_print(
    text, name, diameter, pitch, low, high
):
    thread = SHOP.thread(text)
    assert (thread.name, thread.diameter) == (name, diameter)
    assert thread.pitch == pytest.approx(pitch, abs=1e-9)
    assert (thread.core_low, thread.core_high) == pytest.approx((low, high), abs=0.0006)


@pytest.mark.parametrize(
    ("texts", "name"),
    [
        (
            ("M6", "m6", "M6x1", "M6 x 1", "M6X1.0", "M6-6H", "M6x1-6H", "M6\u00d71 - 6H", " M 6 "),
            "M6",
        ),
        (("M6x0.75", "M6 x 0.75", "M6*0.75-6H"), "M6x0.75"),
        (
            ("1/4-20 UNC", "1/4-20UNC-2B", "1/4 - 20 unc", '1/4"-20 UNC - 2B', "1/4-20-UNC"),
            "1/4-20 UNC",
        ),
        (("#10-32 UNF", "10-32 UNF", "#10-32UNF-2B", "No. 10-32 UNF"), "#10-32 UNF"),
    ],
)
def test_a_thread_may_be_written_as_drawings_do(texts, name):
    assert {SHOP.thread(text).name for text in texts} == {name}


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("M6x1-6G", "limits of class 6G are not known, those of 6H are"),
        ("M6-6h", "limits of class 6h are not known"),
        ("1/4-20 UNC-3B", "limits of class 3B are not known, those of 2B are"),
        ("M6 LH", "left-hand threads are not programmed"),
        ("M6x1LH", "left-hand threads are not programmed"),
        ("M6x1-6H-LH", "left-hand threads are not programmed"),
        ("1/4-20 UNC-2B-LH", "left-hand threads are not programmed"),
        ("M6x0.9", "M6 is known with pitches of 1, 0.75 mm"),
        ("M6.5", "known sizes are M1, M1.2"),
        ("1/4-21 UNC", "known are #4-40 UNC, #5-40 UNC"),
        ("1/4-20 UNF", "known are #4-48 UNF"),
        ("1/4-32 UNEF", "known are #4-40 UNC"),
        ("G1/4", "known are metric threads such as M6 or M6x0.75, and inch ones"),
        ("Tr10x2", "known are metric threads"),
        ("", "known are metric threads"),
        ("M6x1 deep", "known are metric threads"),
    ],
)
def test_what_is_no_known_thread_is_refused_in_one_line(text, words):
    with pytest.raises(BadInput, match=words) as refused:
        SHOP.thread(text)
    assert "\n" not in str(refused.value)


@given(st.sampled_from(METRIC))
def test_a_metric_thread_is_found_by_its_own_name(size):
    diameter, pitch = size
    thread = SHOP.thread(f"M{diameter:g}x{pitch:g}")
    assert (thread.diameter, thread.pitch) == size
    assert SHOP.thread(thread.name) == thread
    assert 0.0 < thread.core_low < thread.core_high < thread.diameter
    assert thread.core_low == pytest.approx(diameter - 2.0 * thread.depth, abs=0.0005)


@given(st.sampled_from([p for p, _ in SHOP.threads.tolerances if p >= 0.25]))
def test_minor_diameter_tolerances_follow_the_formulas_of_the_standard(pitch):
    # ISO 965-1: the table has preferred numbers (steps of 6 %, some of 12 %) near the formulas' results.
    tolerance = dict(SHOP.threads.tolerances)[pitch] * 1000
    formula = 433 * pitch - 190 * pitch**1.22 if pitch <= 0.8 else 230 * pitch**0.7
    assert tolerance == pytest.approx(formula, rel=0.045)


@given(st.sampled_from(sorted(SHOP.threads.inch)))
def test_inch_threads_follow_the_formulas_of_the_standard(name):
    thread = SHOP.thread(name)
    low, high = thread.core_low / 25.4, thread.core_high / 25.4
    basic, pitch = (thread.diameter - 2.0 * thread.depth) / 25.4, thread.pitch / 25.4
    # ASME B1.1 rounds to 0.0001 in below 1/4 in (but many to 0.001), to 0.001 in from there on.
    assert low == pytest.approx(basic, abs=0.00055)
    least = 0.25 * pitch - 0.4 * pitch**2
    small = 0.05 * pitch ** (2 / 3) + 0.03 * pitch / (thread.diameter / 25.4) - 0.002
    tolerance = least if thread.diameter >= 6.35 else max(least, min(small, 0.394 * pitch))
    assert high == pytest.approx(basic + tolerance, abs=0.0007)


def test_sizes_are_given_once_and_coarse_ones_have_one_pitch():
    assert len(set(METRIC)) == len(METRIC)
    coarse = [d for d, _, first in SHOP.threads.metric if first]
    assert len(set(coarse)) == len(coarse)


def test_every_tap_of_the_catalogue_cuts_a_known_thread_that_its_name_says():
    for use in ("tap_through", "tap_blind"):
        taps = SHOP.tools_for("N", use)
        assert taps
        for tap in taps:
            _, size = tap.name.split(" ", 1)
            series, _, inches = size.partition(" ")
            thread = SHOP.thread(f"{inches} {series}" if inches else size)
            assert (tap.diameter, tap.pitch) == (thread.diameter, thread.pitch)
            assert tap.core_diameter == pytest.approx(thread.diameter - 2.0 * thread.depth)
            assert tap.core_diameter <= thread.core_high


def test_every_reamer_of_the_catalogue_has_a_fit_that_is_known_at_its_size():
    for reamer in SHOP.tools_for("N", "ream"):
        limits = SHOP.fit_limits(reamer.fit, reamer.diameter)
        assert limits.width > 0.0 and reamer.name.startswith(f"RE-{reamer.fit} D")


OWN = """
[UNEF]
kind = "inch"
title = "Extra fine"
source = "ASME B1.1"
sizes = [{ size = "1/4", diameter = 0.25, threads_per_inch = 32, minor = [0.216, 0.224] }]

["our fine"]
kind = "metric"
title = "A size of ours"
source = "drawing"
first = false
sizes = [[9, 1]]
"""


def own_folder(tmp_path, text):
    (tmp_path / "threads").mkdir()
    (tmp_path / "threads" / "own.toml").write_text(text, "utf-8")
    return tmp_path


def test_a_users_folder_adds_threads(tmp_path):
    shop = load_shop(own_folder(tmp_path, OWN))
    assert shop.thread("1/4-32 UNEF").core_high == pytest.approx(0.224 * 25.4, abs=0.0006)
    assert shop.thread("M9x1").core_low == 7.917
    assert shop.thread("M6") == SHOP.thread("M6")
    assert shop.digest != SHOP.digest


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('kind = "inch"', 'kind = "pipe"', "UNEF: kind knows metric, tolerance, inch; got 'pipe'"),
        ("[0.216, 0.224]", "[0.224, 0.216]", "minor is the lower and the upper limit"),
        ("[0.216, 0.224]", "[0.216]", "minor is the lower and the upper limit"),
        ("[UNEF]", "[unef]", "named by its series, such as UNEF"),
        ("[[9, 1]]", "[[9, 9]]", r"sizes are \(diameter, pitch\)"),
        ("first = false\n", "", "first is missing"),
        (
            "threads_per_inch = 32",
            "threads_per_inch = 3.2",
            "threads_per_inch must be a whole number",
        ),
    ],
)
def test_a_fault_in_a_file_of_threads_is_told_with_its_table(tmp_path, old, new, words):
    with pytest.raises(BadInput, match=words):
        load_shop(own_folder(tmp_path, OWN.replace(old, new, 1)))
