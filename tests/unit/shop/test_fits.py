"""Tolerance classes of holes, against figures printed in ISO 286-2, and what of them is refused."""

from __future__ import annotations

import math
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from own_shop import own_shop
from trunnion.findings import BadInput
from trunnion.shop import load_shop

SHOP = own_shop()
FITS = SHOP.fits
SIZES = st.floats(1.0, 500.0)
GRADES = st.integers(5, 13)


@pytest.mark.parametrize(
    ("text", "diameter", "lower", "upper"),
    # ISO 286-2:2010, tables of holes, um.
    [
        ("H7", 10, 0, 15),
        ("H7", 25, 0, 21),
        ("H7", 3, 0, 10),
        ("H8", 6, 0, 18),
        ("H6", 120, 0, 22),
        ("H11", 25, 0, 130),
        ("H13", 500, 0, 970),
        ("G7", 20, 7, 28),
        ("G6", 25, 7, 20),
        ("F7", 25, 20, 41),
        ("F8", 25, 20, 53),
        ("E8", 25, 40, 73),
        ("E8", 100, 72, 126),
        ("D10", 25, 65, 149),
        ("JS7", 25, -10.5, 10.5),
        ("JS6", 10, -4.5, 4.5),
        ("K6", 25, -11, 2),
        ("K7", 25, -15, 6),
        ("K8", 25, -23, 10),
        ("K7", 3, -10, 0),
        ("K7", 5, -9, 3),
        ("K7", 60, -21, 9),
        ("K7", 150, -28, 12),
        ("K9", 2, -25, 0),
        ("M6", 25, -17, -4),
        ("M7", 25, -21, 0),
        ("M7", 3, -12, -2),
        ("M6", 280, -41, -9),
        ("N6", 25, -24, -11),
        ("N7", 25, -28, -7),
        ("N7", 12, -23, -5),
        ("N9", 10, -36, 0),
        ("N9", 3, -29, -4),
        ("P7", 25, -35, -14),
        ("P7", 5, -20, -8),
        ("P7", 150, -68, -28),
        ("P8", 25, -55, -22),
        ("P9", 40, -88, -26),
    ],
)
def test_classes_have_the_limits_that_the_standard_prints(text, diameter, lower, upper):
    limits = SHOP.fit_limits(text, diameter)
    assert (1000 * limits.lower, 1000 * limits.upper) == pytest.approx((lower, upper), abs=1e-6)


@pytest.mark.parametrize(
    ("text", "lower", "upper"),
    [
        ("+0.021/0", 0.0, 0.021),
        (" +0.01 / -0.01 ", -0.01, 0.01),
        ("0/-0.02", -0.02, 0.0),
        ("+-0.02", -0.02, 0.02),
        ("+/-0.02", -0.02, 0.02),
        ("\u00b1.05", -0.05, 0.05),
    ],
)
def test_deviations_may_be_typed(text, lower, upper):
    limits = SHOP.fit_limits(text, 7.3)
    assert (limits.lower, limits.upper) == (lower, upper)


@given(SIZES, GRADES)
def test_a_hole_h_begins_at_the_nominal_size_and_js_lies_evenly_about_it(diameter, grade):
    basic, even = (FITS.limits(f"{letters}{grade}", diameter) for letters in ("H", "JS"))
    assert basic.lower == 0.0 and even.middle == pytest.approx(0.0, abs=1e-9)
    assert even.width == pytest.approx(basic.width)


@given(SIZES, GRADES, st.sampled_from("DEFG"))
def test_clearance_holes_are_as_wide_as_their_grade_and_above_the_nominal_size(d, grade, letter):
    limits = FITS.limits(f"{letter}{grade}", d)
    assert limits.lower > 0.0
    assert limits.width == pytest.approx(FITS.limits(f"H{grade}", d).width)


@given(SIZES, st.sampled_from("HGFED"), st.integers(5, 12))
def test_a_coarser_grade_is_wider_and_begins_where_the_finer_does(diameter, letter, grade):
    fine, coarse = (FITS.limits(f"{letter}{g}", diameter) for g in (grade, grade + 1))
    assert coarse.width > fine.width and coarse.lower == fine.lower


@given(st.floats(1.0, 250.0), st.floats(1.0, 2.0), st.sampled_from("DEFGH"), GRADES)
def test_larger_holes_have_limits_that_are_no_tighter(diameter, times, letter, grade):
    small, large = (FITS.limits(f"{letter}{grade}", d) for d in (diameter, times * diameter))
    assert large.width >= small.width and large.lower >= small.lower


@given(SIZES, st.integers(5, 8))
def test_letters_follow_one_another_into_the_material(diameter, grade):
    uppers = [FITS.limits(f"{letter}{grade}", diameter).upper for letter in "DEFGHKMNP"]
    assert all(a >= b for a, b in pairwise(uppers))


@given(st.floats(3.0, 500.0, exclude_min=True), st.integers(6, 8))
def test_an_increment_is_the_step_between_two_grades(diameter, grade):
    # ISO 286-1: Delta = ITn - IT(n - 1), so that a hole M7 or N7 lets a shaft of grade 6 in as the shaft-basis fit of that letter does.
    increment = next(v for most, v in FITS.increments[grade] if diameter <= most)
    fine, coarse = (FITS.limits(f"H{g}", diameter).width for g in (grade - 1, grade))
    assert increment == pytest.approx(1000 * (coarse - fine), abs=1e-6)


MULTIPLES = {5: 7, 6: 10, 7: 16, 8: 25, 9: 40, 10: 64, 11: 100, 12: 160, 13: 250}
"""Standard tolerances over the tolerance unit i, by grade (ISO 286-1:1988, table 7)."""


def ranges(rows):
    """Return the geometric mean in mm and the value in um of each range over 3 mm: up to 3 mm the standard rounds as it likes."""
    return [(math.sqrt(low * high), value) for (low, _), (high, value) in pairwise(rows)]


@pytest.mark.parametrize("grade", MULTIPLES)
def test_standard_tolerances_follow_the_unit_that_they_are_rounded_from(grade):
    # i = 0.45 D^(1/3) + 0.001 D, um.
    for mean, tolerance in ranges(FITS.tolerances[grade]):
        unit = 0.45 * mean ** (1 / 3) + 0.001 * mean
        assert tolerance == pytest.approx(MULTIPLES[grade] * unit, rel=0.06, abs=0.7)


@pytest.mark.parametrize(
    ("letter", "factor", "power"),
    # ISO 286-1:1988, table of formulas for fundamental deviations, D in mm and um.
    [("D", 16.0, 0.44), ("E", 11.0, 0.41), ("F", 5.5, 0.41), ("G", 2.5, 0.34)],
)
def test_deviations_of_clearance_holes_follow_their_formulas(letter, factor, power):
    for mean, deviation in ranges(FITS.deviations[letter].fine):
        assert deviation == pytest.approx(factor * mean**power, rel=0.06, abs=0.6)


def test_deviations_of_holes_k_to_p_mirror_the_formulas_of_shafts():
    fine = {letter: [v for _, v in ranges(FITS.deviations[letter].fine)] for letter in "KMNP"}
    means = [mean for mean, _ in ranges(FITS.deviations["N"].fine)]
    steps = [
        a - b
        for (_, a), (_, b) in zip(
            ranges(FITS.tolerances[7]), ranges(FITS.tolerances[6]), strict=True
        )
    ]
    for mean, step, k, m, n, p in zip(means, steps, *(fine[x] for x in "KMNP"), strict=True):
        # k: 0.6 D^(1/3); m: IT7 - IT6; n: 5 D^0.34; p: IT7 and up to 5 um, each rounded.
        assert -k == pytest.approx(0.6 * mean ** (1 / 3), abs=1.0)
        assert -m == pytest.approx(step, abs=1.0)
        assert -n == pytest.approx(5 * mean**0.34, rel=0.06, abs=1.0)
        assert 0.0 <= -p - FITS.limits("H7", mean).width * 1000 <= 5.0


@pytest.mark.parametrize(
    ("text", "diameter", "words"),
    [
        (
            "h7",
            10,
            "small letters are classes of shafts; a hole's class has capital ones, such as H7",
        ),
        ("X7", 10, "known letters of holes are D, E, F, G, H, JS, K, M, N, P"),
        ("H4", 10, "known grades are 5, 6, 7"),
        ("H7", 501, "classes are known from 1 to 500 mm"),
        ("H7", 0.9, "classes are known from 1 to 500 mm"),
        ("K9", 10, "the standard has no such class at this size"),
        ("tight", 10, "give a class of holes such as H7, or deviations in mm"),
        ("", 10, "give a class of holes"),
        ("0/0.02", 10, "the upper deviation comes first"),
        ("+-0", 10, "the upper deviation comes first"),
        ("+21/0", 10, "deviations are mm, at most 5"),
    ],
)
def test_what_is_no_fit_is_refused_in_one_line(text, diameter, words):
    with pytest.raises(BadInput, match=words) as refused:
        SHOP.fit_limits(text, diameter)
    assert "\n" not in str(refused.value)


OWN = """
[R]
kind = "deviation"
title = "Holes R"
source = "ISO 286-1, table 3"
side = "upper"
delta_to = 7
deviations = [[3, -10], [6, -15], [10, -19]]
coarser = [[3, -10], [6, -15], [10, -19]]
"""


def own_folder(tmp_path, text):
    (tmp_path / "fits").mkdir()
    (tmp_path / "fits" / "own.toml").write_text(text, "utf-8")
    return tmp_path


def test_a_users_folder_adds_a_letter(tmp_path):
    shop = load_shop(own_folder(tmp_path, OWN))
    limits = shop.fit_limits("R7", 10)
    # ISO 286-2: R7 of 6 to 10 mm is -13/-28.
    assert (limits.lower, limits.upper) == (-0.028, -0.013)
    assert shop.fit_limits("H7", 10) == SHOP.fit_limits("H7", 10)
    assert shop.digest != SHOP.digest


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('kind = "deviation"', 'kind = "shaft"', "R: kind knows tolerance, deviation; got 'shaft'"),
        ('side = "upper"', 'side = "left"', "side knows lower, upper, middle; got 'left'"),
        ("[R]", "[r]", "named by the letters of its class"),
        (
            "[6, -15], [10, -19]]\nc",
            "[2, -15], [10, -19]]\nc",
            "deviations must begin with the sizes",
        ),
        ("deviations =", "deviation =", "deviations is missing"),
        ("delta_to = 7", "delta_to = 7\ncolour = 1", "colour is not a field here"),
        ('kind = "deviation"', 'kind = "tolerance"', "a table of tolerances is named IT or Delta"),
    ],
)
def test_a_fault_in_a_file_of_fits_is_told_with_its_table(tmp_path, old, new, words):
    with pytest.raises(BadInput, match=words):
        load_shop(own_folder(tmp_path, OWN.replace(old, new, 1)))
