"""The height field's loops: every column as a plain formula says it, for every form of cutter; nothing left out that the move before
has cut; and what a field can't show is left standing."""

from __future__ import annotations

import math

import numpy as np
import pytest
from pytest import approx

from trunnion.geometry.arrays import floats
from trunnion.verify.cutter import bodies_of, lowest_height
from trunnion.verify.kernels.body import KIND
from trunnion.verify.kernels.stock import zmap as kernel
from trunnion.verify.motion import moves_of
from trunnion.verify.profile import cones_of, open_height, profiles_of
from verify_tools import FORMS, bull, flat, program_section

PITCH, TOP = 0.5, 20.0
CHORD = 2e-3
ORIGIN = floats((0.0, 0.0), (2,), "origin")
"""Read-only, as a stock's is: the kernels are not compiled for another kind of array."""
PLAIN = {"flat": flat(10.0)(), "bull": bull(10.0, 2.0)(), "ball": bull(10.0, 5.0)()}


def cut(tool, stops, *, joined=True, floor=0.0, size=(60, 80), top=TOP):
    """Return the heights, what each move took off, and how many columns it left standing."""
    moves = moves_of([program_section(tool, stops)])
    heights = np.full(size, top)
    profile = profiles_of(moves.tools, moves.bodies)[0]
    done = []
    for k in np.flatnonzero(~moves.rapid):
        goes_on = joined and kernel.joins(moves.row, moves.rapid, moves.tool, k)
        done.append(
            kernel.zmap_cut_move(
                heights,
                ORIGIN,
                PITCH,
                floor,
                moves.row[k],
                goes_on,
                profile,
                moves.bodies.arc,
                moves.bodies.piece,
                CHORD,
            )
        )
    return heights, np.array([r for r, _ in done]), np.array([s for _, s in done])


def plain(tool, stops, size=(60, 80), top=TOP):
    """Return the heights by formulas over whole arrays: exact for level lines and arcs, by a search over convex heights for slopes."""
    y, x = (np.indices(size) + 0.5) * PITCH
    heights = np.full(size, top)
    at = np.array(stops[0], dtype=float)
    for stop in stops[1:]:
        point, centre = stop if len(stop) == 2 else (stop, None)
        point = np.array(point, dtype=float)
        if centre is not None:
            low = lowest_height(tool, distance_to_arc(x, y, at, point, centre)) + at[2]
        elif at[2] == point[2] or (at == point)[:2].all():
            low = lowest_height(tool, distance_to_line(x, y, at, point)) + min(at[2], point[2])
        else:
            low = lowest_on_slope(tool, x, y, at, point)
        heights = np.minimum(heights, low)
        at = point
    return heights


def distance_to_line(x, y, a, b):
    along = (b - a)[:2]
    share = np.clip(
        ((x - a[0]) * along[0] + (y - a[1]) * along[1]) / max(along @ along, 1e-30), 0.0, 1.0
    )
    return np.hypot(x - a[0] - share * along[0], y - a[1] - share * along[1])


def distance_to_arc(x, y, a, b, centre):
    start = math.atan2(a[1] - centre[1], a[0] - centre[0])
    sweep = (math.atan2(b[1] - centre[1], b[0] - centre[0]) - start) % math.tau
    angle = (np.arctan2(y - centre[1], x - centre[0]) - start) % math.tau
    ends = np.minimum(np.hypot(x - a[0], y - a[1]), np.hypot(x - b[0], y - b[1]))
    return np.where(
        angle <= sweep,
        abs(np.hypot(x - centre[0], y - centre[1]) - math.hypot(*(a[:2] - centre))),
        ends,
    )


def lowest_on_slope(tool, x, y, a, b):
    """Search where a column meets the tool lowest: in the covered part of the way, on a grid, then by thirds around the best of it."""
    along, length, widest = (
        b - a,
        math.hypot(*(b - a)[:2]),
        bodies_of((tool,)).widest(cutting=True)[0],
    )
    foot = ((x - a[0]) * along[0] + (y - a[1]) * along[1]) / length**2
    beside = np.hypot(x - a[0] - foot * along[0], y - a[1] - foot * along[1])
    half = np.sqrt(np.clip(widest**2 - beside**2, 0.0, None)) / length
    low, high = np.maximum(foot - half, 0.0), np.minimum(foot + half, 1.0)
    covered = (low <= high) & (beside < widest)

    def height(t):
        rho = np.minimum(np.hypot(beside, (t - foot) * length), widest * (1.0 - 1e-14))
        return a[2] + t * along[2] + lowest_height(tool, rho)

    grid = low + (high - low) * np.linspace(0.0, 1.0, 65).reshape(-1, 1, 1)
    best = np.argmin(height(grid), axis=0)[None]
    low, high = (np.take_along_axis(grid, np.clip(best + k, 0, 64), axis=0)[0] for k in (-1, 1))
    for _ in range(90):
        p, q = low + (high - low) / 3.0, high - (high - low) / 3.0
        left = height(p) < height(q)
        low, high = np.where(left, low, p), np.where(left, q, high)
    found = np.minimum(height(0.5 * (low + high)), height(grid).min(axis=0))
    return np.where(covered, found, np.inf)


LEVEL = [
    (8, 8, 15),
    (8, 8, 13),
    (12.3, 9.1, 13),
    (13.2, 9.7, 13),
    (20, 20, 13),
    (19, 25, 13),
    (30, 25, 13),
    ((22, 25, 13), (26, 25)),
]


@pytest.mark.parametrize("form", sorted(FORMS))
def test_level_lines_and_arcs_leave_what_a_formula_says_for_every_form(form):
    tool, stops = (
        FORMS[form],
        [
            (*stop[:2], stop[2] + 3.0) if len(stop) == 3 else ((*stop[0][:2], 16.0), stop[1])
            for stop in LEVEL
        ],
    )
    heights, _, stands = cut(tool, stops)
    assert not stands.any()
    assert heights == approx(plain(tool, stops), abs=1e-9)


@pytest.mark.parametrize("form", sorted(PLAIN))
def test_the_cells_that_the_move_before_has_cut_are_left_out_and_nothing_else(form):
    rng = np.random.default_rng(5)
    steps = rng.normal(0.0, 1.2, (200, 2)).cumsum(axis=0)
    stops = [
        (20, 15, 25),
        (20, 15, 14),
        *((20 + abs(x) % 15, 15 + abs(y) % 10, 14.0) for x, y in steps),
    ]
    quick, all_of_it = cut(PLAIN[form], stops), cut(PLAIN[form], stops, joined=False)
    assert quick[0] == approx(all_of_it[0], abs=1e-9)
    assert quick[1] == approx(all_of_it[1], abs=1e-6)
    assert quick[0] == approx(plain(PLAIN[form], stops), abs=1e-9)


@pytest.mark.parametrize("form", ["flat", "bull", "ball", "taper", "taper ball", "drill", "form"])
def test_slopes_up_and_down_leave_what_a_search_finds(form):
    tool = {**FORMS, **PLAIN}[form]
    stops = [
        (8, 8, 18),
        (20, 9, 16.5),
        (21.1, 9.4, 16.6),
        (28, 20, 19),
        (15, 22, 15.5),
        (15.5, 21, 12.0),
    ]
    heights, _, stands = cut(tool, stops)
    assert not stands.any()
    assert heights == approx(np.minimum(plain(tool, stops), TOP), abs=1e-7)


@pytest.mark.parametrize("clockwise", [False, True])
@pytest.mark.parametrize("rise", [-6.0, 4.0])
@pytest.mark.parametrize("sweep", [1.0, 4.0, math.tau, 8.0, 7.0 * math.pi])
def test_a_helix_of_a_flat_cutter_is_exact(sweep, rise, clockwise):
    turn = -sweep if clockwise else sweep
    moves = moves_of([program_section(PLAIN["flat"], [(25, 15, 16), ((25, 15, 14), (20, 15))])])
    row = moves.row[1].copy()
    row[[kernel.START_ANGLE, kernel.SWEEP, kernel.Z_START, kernel.Z_END]] = (
        0.3,
        turn,
        14.0,
        14.0 + rise,
    )
    row[[kernel.MX, kernel.MY, kernel.COS_HALF]] = (
        math.cos(0.3 + turn / 2),
        math.sin(0.3 + turn / 2),
        math.cos(min(sweep / 2, math.pi)),
    )
    row[[kernel.X0, kernel.Y0]] = 20 + 5 * math.cos(0.3), 15 + 5 * math.sin(0.3)
    row[[kernel.X1, kernel.Y1]] = 20 + 5 * math.cos(0.3 + turn), 15 + 5 * math.sin(0.3 + turn)
    heights = np.full((60, 80), TOP)
    took, _ = kernel.zmap_cut_move(
        heights,
        ORIGIN,
        PITCH,
        0.0,
        row,
        False,
        profiles_of(moves.tools, moves.bodies)[0],
        moves.bodies.arc,
        moves.bodies.piece,
        CHORD,
    )
    y, x = (np.indices(heights.shape) + 0.5) * PITCH
    finest = np.full(heights.shape, TOP)
    for t in np.linspace(0.0, 1.0, 4001):
        inside = (
            np.hypot(x - 20 - 5 * math.cos(0.3 + t * turn), y - 15 - 5 * math.sin(0.3 + t * turn))
            < 5.0
        )
        finest = np.where(inside, np.minimum(finest, 14.0 + t * rise), finest)
    # Between two moments that were looked at a column may be covered a little longer, or for the first time.
    assert (heights <= finest + 1e-9).all() and took == approx((TOP - heights).sum())
    assert np.quantile(np.abs(heights - finest), 0.998) < abs(rise) / 4000 + 1e-9


def test_a_helix_is_cut_by_chords_that_stay_within_their_error():
    tool, turn = PLAIN["ball"], np.linspace(0.0, math.tau, 4001)
    heights, _, _ = cut(tool, [(25, 15, 19), ((15, 15, 16), (20, 15)), ((25, 15, 13), (20, 15))])
    y, x = (np.indices(heights.shape) + 0.5) * PITCH
    finest = np.full(heights.shape, TOP)
    for t in turn:
        rho = np.hypot(x - 20 - 5 * math.cos(t), y - 15 - 5 * math.sin(t))
        finest = np.minimum(finest, 19 - 6 * t / math.tau + lowest_height(tool, rho))
    # At its rim a ball is steep: there a chord's error beside the way is a larger one in height.
    well_inside = np.isfinite(finest) & (finest < 19.0) & (heights < 16.0)
    assert np.abs(heights - finest)[well_inside].max() < 2.5 * CHORD


def test_each_move_takes_off_what_the_field_loses():
    heights, removed, _ = cut(PLAIN["ball"], LEVEL)
    assert removed.sum() == approx((TOP - heights).sum())


def test_below_the_blank_there_is_nothing_to_cut():
    heights, removed, _ = cut(PLAIN["flat"], [(15, 15, 25), (15, 15, -5), (30, 15, -5)], floor=2.0)
    assert heights.min() == 2.0
    assert removed.sum() == approx((TOP - heights).sum())


def test_columns_higher_than_the_flutes_are_left_standing_and_counted():
    short = flat(10.0)(flute=5.0)
    heights, removed, stands = cut(short, [(15, 15, 25), (15, 15, 11), (30, 15, 11)])
    assert stands[0] == 0 and stands[1] > 0
    assert removed[1] == 0.0 and (heights[30, 45:] == TOP).all()


def test_a_plunge_passes_all_of_a_column():
    short = flat(10.0)(flute=5.0)
    _, _, stands = cut(short, [(15, 15, 25), (15, 15, 3)])
    assert not stands.any()


def test_up_to_where_a_cutter_gets_no_thinner():
    assert open_height(PLAIN["flat"]) == PLAIN["flat"].flute_length
    assert open_height(FORMS["taper"]) == FORMS["taper"].flute_length
    assert open_height(FORMS["barrel"]) == approx(FORMS["barrel"].widest_height)
    slot = FORMS["t-slot"]
    assert open_height(slot) == approx(slot.flute_length - slot.corner_radius)


def test_a_barrel_cuts_a_field_up_to_its_widest_circle_and_no_higher():
    barrel = FORMS["barrel"]
    low = TOP - barrel.widest_height
    assert not cut(barrel, [(10, 15, low + 0.01), (30, 15, low + 0.01)])[2].any()
    assert cut(barrel, [(10, 15, low - 0.01), (30, 15, low - 0.01)])[2].any()


def test_the_holder_is_a_stack_of_cones_with_its_free_faces():
    cones, start = cones_of((flat(10.0)(),))
    assert start.tolist() == [0, len(cones)]
    assert cones[-2].tolist() == [12.0, 20.0, 33.0, 43.0, 1.0]


def test_profiles_name_the_bodies_that_cut():
    tools = tuple(FORMS.values())
    profiles, bodies = profiles_of(tools, bodies_of(tools)), bodies_of(tools)
    assert profiles[:, kernel.RADIUS] == approx(bodies.widest(cutting=True))
    for row in profiles:
        assert (bodies.piece[int(row[kernel.FIRST]) : int(row[kernel.LAST]), KIND] == 0.0).all()
