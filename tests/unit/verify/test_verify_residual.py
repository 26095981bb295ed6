"""How near what cuts comes to points of the part: closed forms for each cutter form and motion."""

from __future__ import annotations

import math

import numpy as np
import pytest
from pytest import approx

from five_axis import five_axis_case, surface
from leaning_tools import EVERY_FORM, PlainCutter, cutter, leaning_section
from trunnion.findings import Cancelled
from trunnion.model.motion.toolpath import Motion
from trunnion.progress import Progress
from trunnion.verify.finish.sweep import RESIDUAL_BOUND, Sweep, flutes_of, residual_by_block
from trunnion.verify.kernels import residual as kernel
from trunnion.verify.motion import moves_of
from verify_tools import bull, flat, program_section

UP, LEVEL = (0.0, 0.0, 1.0), (1.0, 0.0, 0.0)


def left(section, points, most=20.0, near=20.0):
    points = np.atleast_2d(np.asarray(points, dtype=np.float64))
    return Sweep.of(moves_of([section]), near).residual(points, np.full(len(points), most))[0]


@pytest.mark.parametrize("form", EVERY_FORM)
def test_every_form_is_closed_at_the_top_of_its_flutes(form):
    tool = EVERY_FORM[form]
    flutes = flutes_of(moves_of([leaning_section(tool, [[0, 0, 0]], [UP])]))
    rho, h = (
        a.ravel()
        for a in np.meshgrid(
            np.linspace(0.0, 15.0, 40), np.linspace(-5.0, tool.flute_length + 5.0, 60)
        )
    )
    mine = np.array(
        [kernel.flute_signed_distance(flutes, 0, r, z, False) for r, z in zip(rho, h, strict=True)]
    )
    true = PlainCutter(tool).distance(rho, h)
    if form == "form":
        mine, true = np.maximum(mine, 0.0), np.maximum(true, 0.0)
    assert mine == approx(true, abs=1e-4)


@pytest.mark.parametrize("lean", [0.0, 0.3, 1.2])
def test_a_ball_leaves_the_same_whatever_its_axis_leans(lean):
    # Its centre runs 5 above the plane y z at z = 5: beside the line at distance d, sqrt(25 + d^2) - 5 is left.
    axis = np.array([0.0, math.sin(lean), math.cos(lean)])
    tips = np.array([[0.0, 0.0, 5.0], [40.0, 0.0, 5.0]]) - 5.0 * axis
    points = [[20.0, -d, 0.0] for d in (0.0, 0.5, 2.0)]
    assert left(leaning_section(EVERY_FORM["ball"], tips, [axis, axis]), points) == approx(
        [math.hypot(5.0, d) - 5.0 for d in (0, 0.5, 2)]
    )


def test_a_tilted_flat_end_cuts_with_its_lowest_rim():
    # Leaning back by 10 degrees along +x, the rim's lowest place is R sin 10 below its middle.
    lean = math.radians(10.0)
    axis = np.array([math.sin(lean), 0.0, math.cos(lean)])
    tips = np.array([[-50.0, 0.0, 5.0 * math.sin(lean)], [50.0, 0.0, 5.0 * math.sin(lean)]])
    assert left(
        leaning_section(EVERY_FORM["flat"], tips, [axis, axis]), [[0.0, 0.0, 0.0]]
    ) == approx([0.0], abs=1e-9)


def test_a_t_slot_cuts_upwards_too_and_leaves_what_is_above():
    # A disc 20 across and 5 thick, rounded by 1, its tip at z = 0.
    section = leaning_section(EVERY_FORM["t-slot"], [[0, 0, 0.0], [50, 0, 0]], [UP, UP])
    assert left(section, [[25, 0, 5.0], [25, 0, 6.5], [25, 12.0, 2.5]]) == approx(
        [0.0, 1.5, 2.0], abs=1e-9
    )


def test_a_drill_that_plunges_leaves_its_cone():
    # Half of 118 degrees: below the flank the hole narrows by tan 59 a millimetre.
    section = leaning_section(EVERY_FORM["drill"], [[0, 0, 20.0], [0, 0, -10]], [UP, UP])
    assert left(section, [[5.0, 0, 0.0], [0, 0, -10.0], [0, 0, -12]]) == approx(
        [0.0, 0.0, 2.0], abs=RESIDUAL_BOUND
    )


def test_a_leaning_plunge_goes_along_its_own_axis():
    axis = np.array([0.6, 0.0, 0.8])
    section = leaning_section(EVERY_FORM["flat"], [20 * axis, 0 * axis], [axis, axis])
    beside = np.array([-0.8, 0.0, 0.6])
    assert left(section, [7.0 * axis + 6.0 * beside, -1.0 * axis, 41.0 * axis]) == approx(
        [1.0, 1.0, 1.0], abs=RESIDUAL_BOUND
    )


def test_a_barrel_leaves_a_flat_scallop_on_a_wall():
    # Its widest circle touches the wall y = 0; 2 mm higher the flank of radius 60 has gone 60 - sqrt(60^2 - 4) back.
    tool = EVERY_FORM["barrel"]
    section = leaning_section(
        tool, [[0, 5.0, -tool.widest_height], [50, 5.0, -tool.widest_height]], [UP, UP]
    )
    assert left(section, [[25, 0, 0.0], [25, 0, 2.0]]) == approx(
        [0.0, math.hypot(60.0, 2.0) - 60.0], abs=1e-9
    )


@pytest.mark.parametrize("climb", [0.0, -3.0])
def test_a_helix_about_a_leaning_axis_is_the_upright_one_turned(climb):
    tool, turn = (
        EVERY_FORM["bull"],
        np.array([[0.36, 0.48, -0.8], [-0.8, 0.6, 0.0], [0.48, 0.64, 0.6]]),
    )
    tips, points = (
        np.array([[12.0, 0, 0], [-12, 0, climb]]),
        np.array([[0.0, 18.0, 1.0], [5.0, 10.0, -3.0], [1.0, 5.0, 4.0]]),
    )
    upright = left(
        leaning_section(tool, tips, [UP, UP], centre=[0, 0, 0], motion=Motion.ARC_CCW), points
    )
    turned = left(
        leaning_section(
            tool, tips @ turn.T, [turn[:, 2]] * 2, centre=[0, 0, 0], motion=Motion.ARC_CCW
        ),
        points @ turn.T,
    )
    assert turned == approx(upright, abs=2 * RESIDUAL_BOUND)


def test_an_axis_that_turns_about_the_tip_sweeps_a_fan():
    # The tip stands still while the axis turns from up to along x: half way it leans by 45 degrees.
    section = leaning_section(EVERY_FORM["flat"], [[0, 0, 0.0], [0, 0, 0]], [UP, LEVEL])
    way = np.array([1.0, 0.0, 1.0]) / math.sqrt(2.0)
    # The rim of the flutes' top comes round to the middle of the fan from both sides.
    far = 21.0 - math.hypot(20.0, 5.0)
    assert left(section, [10.0 * way + [0, 5.5, 0], 21.0 * way, [-1.0, 0.0, -1.0]]) == approx(
        [0.5, far, 1.0], abs=2 * RESIDUAL_BOUND
    )


def test_what_is_left_beyond_the_listed_cells_is_told_in_hundredths():
    section = program_section(flat(10.0)(), [(0, 0, 50), (0, 0, 2), (50, 0, 2)])
    assert left(section, [[25, 40, 5.0], [25, 0, -20]], most=60.0, near=2.0) == approx(
        [35.0, 22.0], abs=0.01
    )


def test_points_beyond_the_ends_of_the_flutes_are_as_far_as_their_rim():
    section = program_section(flat(10.0)(flute=8.0), [(0, 0, 20), (0, 0, 2), (50, 0, 2)])
    assert left(section, [[25, 8.0, 14.0]]) == approx([5.0])


def test_only_earlier_moves_have_cut():
    section = leaning_section(
        EVERY_FORM["ball"],
        [[0, 0, 0], [40, 0, 0.0], [40, 20, 0], [0, 20, 0]],
        [LEVEL, LEVEL, UP, UP],
    )
    sweep = Sweep.of(moves_of([section]), 2.0)
    points = np.array([[20, 3.0, 3.0], [20, 19.0, 5.0], [20, 19.0, 60.0]])
    assert sweep.cut_before(points, 2).tolist() == [True, False, False]
    # Upright plain cutters remove all above them.
    assert sweep.cut_before(points, 4).tolist() == [True, True, True]
    assert sweep.cut_before(points, 0).tolist() == [False, False, False]


def test_rapids_cut_nothing():
    section = program_section(flat(10.0)(), [(0, 0, 0), (50, 0, 0)], rapid_to=1)
    sweep = Sweep.of(moves_of([section]), 2.0)
    assert sweep.residual(np.zeros((1, 3)), np.array([9.0]))[1].tolist() == [-1]


def test_blocks_are_told_what_they_left_on_the_samples_nearest_to_them():
    told = residual_by_block(
        np.array([0.1, 0.3, -0.2, 5.0]),
        np.array([1, 1, 2, -1]),
        4,
        area=np.array([1.0, 3.0, 1.0, 1.0]),
    )
    assert told.count.tolist() == [0, 2, 1, 0]
    assert told.least[1:3].tolist() == [0.1, -0.2] and told.most[1:3].tolist() == [0.3, -0.2]
    assert told.mean[1:3] == approx([0.25, -0.2]) and np.isnan(told.mean[[0, 3]]).all()


def test_any_number_of_threads_measures_the_same():
    upright = program_section(bull(8.0, 2.0)(), [(0, 0, 9), (90, 90, 3), (0, 150, 3)])
    sweep = Sweep.of(moves_of([five_axis_case(500, 100).section, upright]), 2.0)
    points = surface(*np.random.default_rng(0).uniform(0.0, 200.0, (2, 3000)))[0]
    one, three = (sweep.residual(points, np.full(len(points), 30.0), threads=n) for n in (1, 3))
    assert one[0].tobytes() == three[0].tobytes() and one[1].tobytes() == three[1].tobytes()
    assert (
        sweep.cut_before(points, 300, threads=1).tobytes()
        == sweep.cut_before(points, 300, threads=3).tobytes()
    )


def test_measuring_stops_when_asked_to():
    sweep = Sweep.of(moves_of([program_section(flat(10.0)(), [(0, 0, 9), (90, 90, 3)])]), 2.0)
    with pytest.raises(Cancelled):
        sweep.residual(np.zeros((5000, 3)), np.full(5000, 3.0), Progress(cancelled=lambda: True))


def test_a_taper_leaves_its_lean_on_a_wall():
    tool = cutter("taper", corner=1.0, taper_angle=10.0)
    section = leaning_section(tool, [[0, 0, 0.0], [50, 0, 0]], [UP, UP])
    # The corner ends 1 - sin 10 high, 4 + cos 10 from the axis; from there the flank leans out by tan 10.
    lean = math.radians(10.0)
    at = 4.0 + math.cos(lean) + (10.0 - 1.0 + math.sin(lean)) * math.tan(lean)
    assert left(section, [[25, at, 10.0], [25, at + 1.0, 10.0]]) == approx(
        [0.0, math.cos(lean)], abs=1e-9
    )
