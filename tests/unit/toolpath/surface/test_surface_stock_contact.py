"""Upright tools beside stock that roughing left: nothing above their flutes meets it, and what they leave for that is said."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from programs import LINE, RAPID, path_of
from surface_drives import DATA, driven, grid, joined, roughed
from trunnion.geometry.kernels.heightfield import zmap_meets, zmap_meets_reference
from trunnion.model.motion.toolpath import Mark, Motion
from trunnion.progress import NO_PROGRESS
from trunnion.toolpath.contact_passes.linking.link_passes import linked_in_order
from trunnion.toolpath.contact_passes.linking.parameters import LinkParameters
from trunnion.toolpath.contact_passes.passes import UPRIGHT, Pass
from trunnion.toolpath.contact_passes.upright.body_stock import SMALLER
from trunnion.toolpath.contact_passes.upright.stock_contact import without_stock_contact
from trunnion.toolpath.contact_passes.upright.upright_path import linked_without_contact
from trunnion.toolpath.surface.constant import ConstantSettings, constant
from trunnion.toolpath.surface.parallel import ParallelSettings, parallel
from trunnion.toolpath.surface.waterline import WaterlineSettings, waterline
from verify_tools import bull

SLENDER = replace(
    bull(2.0, 1.0)(flute=3.0),
    neck_diameter=1.9,
    neck_length=10.0,
    shank_diameter=4.0,
    stickout=30.0,
)
"""A ball of 2 mm: its neck of 1.9 mm begins 3 mm, its shank of 4 mm 10 mm over the tip."""


@pytest.mark.parametrize("seed", range(5))
def test_the_compiled_kernel_and_the_plain_one_agree(seed):
    pick = np.random.default_rng(seed)
    heights, tips = pick.uniform(0.0, 10.0, (40, 30)), pick.uniform(-3.0, 20.0, (300, 3))
    rows = np.array([[1.0, 0.8, 4.0, 0.8], [4.0, 0.8, 7.0, 3.0], [7.0, 4.0, 20.0, 2.0]])
    found, plain = np.zeros(300, bool), np.zeros(300, bool)
    heights[pick.random(heights.shape) < 0.1] = -np.inf
    zmap_meets(heights, 10.0, -1.0, 2.0, 0.5, tips, rows, found)
    zmap_meets_reference(heights, 10.0, -1.0, 2.0, 0.5, tips, rows, plain)
    assert (found == plain).all() and 0 < found.sum() < 300


def trench(wide, deep=20.0):
    """Return a drive, the setup and the stock of a level floor, cut down to it only in a trench along x about y = 15."""
    drive, setup, stock = driven(grid(lambda x, y: 0.0 * x, n=8), top=deep)
    y = stock.corner[1] + (np.arange(stock.heights.shape[1]) + 0.5) * stock.cell
    heights = stock.heights.copy()
    heights[:, np.abs(y - 15.0) < 0.5 * wide] = 0.3
    return drive, setup, replace(stock, field=heights)


def standing_from(stock, past, high=20.0):
    """Return a stock that stands high where x is greater than `past`."""
    heights = stock.heights.copy()
    x = stock.corner[0] + (np.arange(len(heights)) + 0.5) * stock.cell
    heights[x > past] = high
    return replace(stock, field=heights)


def along(y, z=0.0, start=2.0, end=28.0):
    tips = np.array([[start, y, z], [end, y, z]])
    return Pass(tip=tips, axis=np.tile(UPRIGHT, (2, 1)), normal=np.tile(UPRIGHT, (2, 1)))


def run_of(start, end, y, z=0.0):
    """Return a pass along x in short moves."""
    run = np.linspace(start, end, 217)
    return Pass(
        tip=np.column_stack([run, np.full(217, y), np.full(217, z)]),
        axis=np.tile(UPRIGHT, (217, 1)),
        normal=np.tile(UPRIGHT, (217, 1)),
    )


@pytest.mark.parametrize(("wide", "clear"), [(30.0, True), (1.5, False)])
def test_a_pass_in_a_trench_is_cut_where_neck_and_shank_have_space(wide, clear):
    drive, _, stock = trench(wide)
    kept, _, findings = without_stock_contact(
        [along(15.0)], drive, SLENDER, stock, 0.5, NO_PROGRESS
    )
    assert bool(kept) is clear and bool(findings) is not clear
    if findings:
        assert findings[0].code == "surface.in-stock" and "13.0 mm2" in findings[0].text


def test_stock_no_higher_than_the_flutes_are_long_is_in_no_neck_s_way():
    drive, _, stock = trench(1.5, deep=2.9)
    kept, _, findings = without_stock_contact([along(5.0)], drive, SLENDER, stock, 0.5, NO_PROGRESS)
    assert len(kept) == 1 and not findings


def split(one, count):
    """Return a pass along a straight line in so many moves."""
    tips = np.linspace(one.tip[0], one.tip[-1], count + 1)
    up = np.tile(UPRIGHT, (count + 1, 1))
    return Pass(tip=tips, axis=up, normal=up)


@pytest.mark.parametrize("count", [1, 2, 52])
def test_of_a_pass_that_runs_into_stock_the_rest_is_cut(count):
    """Its moves may be as long as itself."""
    drive, _, stock = trench(30.0)
    stock = standing_from(stock, 20.0)
    (kept,), _, (finding,) = without_stock_contact(
        [split(along(15.0), count)], drive, SLENDER, stock, 0.5, NO_PROGRESS
    )
    # Its shank has a radius of 2 mm, the stock begins at x = 20: 10 mm are left.
    assert kept.tip[0, 0] == 2.0 and 17.5 < kept.tip[-1, 0] <= 18.0
    assert len(kept) <= count + 1
    assert 5.0 <= area_of(finding) <= 5.2


def area_of(finding):
    """Return the area in mm2 that a finding tells of."""
    return float(finding.text.split(" mm2")[0].split()[-1])


def test_a_long_move_ends_before_stock_that_only_its_last_position_meets():
    """After it a short one goes on along the stock: both have that position in common."""
    drive, _, stock = trench(30.0)
    stock = standing_from(stock, 20.0)
    tips = np.array([[2.0, 10.0, 0.0], [18.2, 10.0, 0.0], [18.2, 11.0, 0.0]])
    up = np.tile(UPRIGHT, (3, 1))
    corner = Pass(tip=tips, axis=up, normal=np.array([[0.0, 1.0, 0.0]] * 2 + [[-1.0, 0.0, 0.0]]))
    (kept,), _, _ = without_stock_contact([corner], drive, SLENDER, stock, 0.5, NO_PROGRESS)
    assert kept.tip[0, 0] == 2.0 and 17.7 < kept.tip[-1, 0] <= 18.0
    assert np.allclose(np.linalg.norm(kept.normal, axis=1), 1.0)


def test_a_long_move_over_a_ridge_is_cut_on_both_sides_of_it():
    drive, _, stock = trench(30.0)
    heights = stock.heights.copy()
    x = stock.corner[0] + (np.arange(len(heights)) + 0.5) * stock.cell
    heights[np.abs(x - 15.0) < 1.0] = 20.0
    kept, _, _ = without_stock_contact(
        [along(15.0)], drive, SLENDER, replace(stock, field=heights), 0.5, NO_PROGRESS
    )
    assert [len(p) for p in kept] == [2, 2]
    assert 11.5 < kept[0].tip[1, 0] <= 12.0 and 18.0 <= kept[1].tip[0, 0] < 18.5


def test_what_is_cut_of_long_moves_makes_space_for_the_neck_of_those_below():
    """Level by level down into stock 9 mm high, before a wall of it that is higher than all flutes and neck."""
    drive, _, stock = trench(1.5, deep=9.0)
    stock = standing_from(stock, 20.0)
    stairs = [along(5.0, z) for z in np.arange(7.0, -0.1, -1.0)]
    kept, _, findings = without_stock_contact(stairs, drive, SLENDER, stock, 0.5, NO_PROGRESS)
    assert findings and [p.tip[0, 2] for p in kept] == [p.tip[0, 2] for p in stairs]
    assert all(p.tip[0, 0] == 2.0 and 17.0 < p.tip[-1, 0] <= 20.0 for p in kept)


def test_the_area_that_is_said_to_be_left_is_that_of_faces():
    """Passes lie half a millimetre from each other, as leaning faces ask for; the widest stepover, on others, is ten times as large."""
    drive, _, stock = trench(30.0)
    stock = standing_from(stock, 20.0)
    rows = [along(y) for y in np.arange(10.0, 20.1, 0.5).tolist()]
    _, _, (finding,) = without_stock_contact(rows, drive, SLENDER, stock, 5.0, NO_PROGRESS)
    # From x = 18 to 28 and from y = 10 to 20, and past their ends.
    assert 100.0 <= area_of(finding) <= 13.0 * 20.0
    _, _, (finding,) = without_stock_contact(rows, drive, SLENDER, stock, 0.5, NO_PROGRESS)
    assert area_of(finding) == pytest.approx(10.0 * 10.5, rel=0.1)


@pytest.mark.parametrize("backwards", [False, True])
def test_a_pass_in_short_moves_ends_where_its_neck_is_still_free(backwards):
    drive, _, stock = trench(30.0)
    stock = standing_from(stock, 20.0)
    slim = replace(SLENDER, shank_diameter=1.9)
    whole = run_of(2.0, 28.0, 15.0)
    (kept,), _, _ = without_stock_contact(
        [whole.reversed() if backwards else whole],
        drive,
        slim,
        stock,
        0.5,
        NO_PROGRESS,
    )
    # Its neck of 0.95 mm comes to the stock at x = 19.05, moves are 0.12 mm long.
    assert 18.8 < kept.tip[:, 0].max() <= 19.05 + SMALLER


def test_passes_that_go_down_step_by_step_make_space_for_the_neck_of_those_below():
    drive, _, stock = trench(1.5, deep=9.0)
    stairs = [along(5.0, z) for z in np.arange(7.0, -0.1, -1.0)]
    kept, _, findings = without_stock_contact(stairs, drive, SLENDER, stock, 0.5, NO_PROGRESS)
    assert len(kept) == len(stairs) and not findings
    kept, _, findings = without_stock_contact(stairs[-1:], drive, SLENDER, stock, 0.5, NO_PROGRESS)
    assert not kept and findings


def test_where_the_shank_is_wider_than_the_cutter_steps_make_no_space_for_it():
    drive, _, stock = trench(1.5, deep=20.0)
    stairs = [along(5.0, z) for z in np.arange(18.0, -0.1, -1.0)]
    thick = replace(SLENDER, shank_diameter=6.0)
    kept, _, findings = without_stock_contact(stairs, drive, thick, stock, 0.5, NO_PROGRESS)
    assert kept and 9.0 <= min(p.tip[:, 2].min() for p in kept) <= 10.0 and findings


def rows_of(z, y):
    """Return a path in rows along x at a height, the first one at y, past the far side of the field."""
    ends = [(x, at) for at in np.arange(y, 40.0, 4.0).tolist() for x in (-10.0, 40.0)]
    return path_of((RAPID, *ends[0], z), *((LINE, *end, z, 100.0) for end in ends[1:]))


@pytest.mark.parametrize(
    ("thick", "off", "clear"),
    [
        (0.0, 1.05, True),
        (0.05, 1.05, True),
        (0.2, 1.05, False),
        (0.2, 1.15, True),
        (0.8, 1.05, False),
        (0.8, 2.85, True),
        (2.5, 2.0, False),
    ],
)
def test_what_is_left_on_a_wall_is_told_from_the_rim_that_the_field_keeps_there(thick, off, clear):
    """The wall ends at y = 15; beside it stock of a thickness stands as high as the wall, cut by an end mill of 6 mm."""
    floor = grid(lambda x, y: 0.0 * x, n=8)
    wall = grid(lambda x, y: 9.0 + 0.0 * x, n=8, high=(30.0, 15.0), tag=2)
    drive, _, stock = driven(joined(floor, wall), top=20.0)
    stock = stock.after(rows_of(9.0, -5.0), bull(6.0, 0.0)(flute=20.0))
    stock = stock.after(rows_of(0.3, 18.0 + thick), bull(6.0, 0.0)(flute=20.0))
    rim = int((15.0 + thick - stock.corner[1]) // stock.cell)
    assert (stock.heights[:, rim] > 5.0).any() or thick == 0.0
    kept, _, findings = without_stock_contact(
        [along(15.0 + off)], drive, SLENDER, stock, 0.5, NO_PROGRESS
    )
    assert bool(kept) is clear and bool(findings) is not clear


def test_passes_step_by_step_into_tall_stock_end_where_the_neck_would_come_to_it():
    """Stock stands 20 mm high from y = 15 on; flutes of 3 mm go by under it, and what is over them stays in the way of the next pass."""
    drive, _, stock = trench(30.0)
    y = stock.corner[1] + (np.arange(stock.heights.shape[1]) + 0.5) * stock.cell
    heights = stock.heights.copy()
    heights[:, y > 15.0] = 20.0
    slim = replace(SLENDER, shank_diameter=1.9)
    steps = [run_of(2.0, 28.0, at) for at in np.arange(13.9, 15.5, 0.005)]
    kept, _, findings = without_stock_contact(
        steps, drive, slim, replace(stock, field=heights), 0.005, NO_PROGRESS
    )
    assert findings
    # Its neck of 0.95 mm comes to the stock at y = 14.05: cells of a quarter of a millimetre could not tell.
    deepest = max(p.tip[0, 1] for p in kept)
    assert 14.05 - 0.005 < deepest <= 14.05 + SMALLER + 0.005


def test_a_ridge_away_from_walls_is_stock_though_it_is_narrow():
    drive, _, stock = trench(30.0)
    y = stock.corner[1] + (np.arange(stock.heights.shape[1]) + 0.5) * stock.cell
    heights = stock.heights.copy()
    heights[:, np.abs(y - 15.0) < 0.9] = 12.0
    stock = replace(stock, field=heights)
    assert not without_stock_contact([along(15.0)], drive, SLENDER, stock, 0.5, NO_PROGRESS)[0]
    assert without_stock_contact([along(18.25)], drive, SLENDER, stock, 0.5, NO_PROGRESS)[0]


STRATEGIES = (
    (parallel, ParallelSettings()),
    (constant, ConstantSettings()),
    (waterline, WaterlineSettings(chord=0.005, shallowest=0.0)),
)


@pytest.mark.parametrize(
    ("strategy", "chosen"), STRATEGIES, ids=["parallel", "constant", "waterline"]
)
@pytest.mark.parametrize("is_roughed", [True, False])
def test_a_strategy_leaves_what_lies_under_stock_and_says_so(strategy, chosen, is_roughed):
    hill = grid(lambda x, y: 0.5 * (x + y), n=12, high=(8.0, 8.0))
    drive, setup, stock = driven(joined(hill), height=0.05, top=30.0)
    stock = roughed(stock, hill) if is_roughed else stock
    made = strategy(drive, SLENDER, DATA, stock, setup, chosen, NO_PROGRESS)
    codes = [f.code for f in made.findings]
    assert ("surface.in-stock" in codes) is not is_roughed
    assert bool((made.path.mark == Mark.CUT).any()) is is_roughed
    # All of the face is left.
    areas = [area_of(f) for f in made.findings if f.code == "surface.in-stock"]
    assert areas == pytest.approx([] if is_roughed else [64.0 * 1.5**0.5], abs=0.1)


@pytest.mark.parametrize("backwards", [False, True])
def test_leads_do_not_go_on_into_what_the_pass_ends_before(backwards):
    """Stock stands from x = 20 on, higher than the flutes are long; the pass goes up to it, or begins there."""
    drive, setup, stock = trench(30.0)
    stock = standing_from(stock, 20.0)
    slim = replace(SLENDER, shank_diameter=1.9)
    run = np.linspace(2.0, 28.0, 105)[:: -1 if backwards else 1]
    whole = Pass(
        tip=np.column_stack([run, np.full(105, 15.0), np.zeros(105)]),
        axis=np.tile(UPRIGHT, (105, 1)),
        normal=np.tile(UPRIGHT, (105, 1)),
    )
    kept, beside, _ = without_stock_contact([whole], drive, slim, stock, 0.5, NO_PROGRESS)
    near = kept[0].tip[0 if backwards else -1, 0]
    assert 18.0 < near <= 19.3
    parameters = LinkParameters(stepover=0.5, lead_radius=1.0)
    blind, seeing = (
        linked_in_order(kept, drive, slim, DATA, stock, setup, replace(parameters, pass_stock=f))
        for f in (None, beside)
    )
    low = [p.position[p.position[:, 2] < 15.0, 0] for p in (blind, seeing)]
    assert low[0].max() > near + 0.9
    assert low[1].max() < near + 0.05
    # At the other end nothing is in the way of its lead.
    assert seeing.position[:, 0].min() == pytest.approx(1.0)


def with_ridge(stock, half, height=20.0):
    """Return a stock with a ridge about y = 15, from x = 25 on."""
    heights = stock.heights.copy()
    x, y = (
        stock.corner[k] + (np.arange(n) + 0.5) * stock.cell for k, n in enumerate(heights.shape)
    )
    heights[np.ix_(x > 25.0, np.abs(y - 15.0) < half)] = height
    return replace(stock, field=heights)


def test_no_link_goes_through_what_stands_between_the_ends_of_two_passes():
    """A ridge stands between two passes from x = 25 on: they end before it, and the straight link between them would touch it."""
    drive, setup, stock = trench(30.0)
    stock = with_ridge(stock, 0.6)
    slim = replace(SLENDER, shank_diameter=1.9)
    passes = [run_of(2.0, 29.0, 14.0), run_of(29.0, 2.0, 16.0)]
    kept, beside, _ = without_stock_contact(passes, drive, slim, stock, 0.7, NO_PROGRESS)
    assert len(kept) == 2 and np.allclose(kept[0].tip[-1, 0], kept[1].tip[0, 0], atol=0.3)
    parameters = LinkParameters(stepover=0.7, lead_radius=0.0)
    blind, seeing = (
        linked_in_order(kept, drive, slim, DATA, stock, setup, replace(parameters, pass_stock=f))
        for f in (None, beside)
    )
    assert (blind.mark == Mark.LINK).any() and not (seeing.mark == Mark.LINK).any()


def test_no_link_goes_through_what_only_later_passes_cut():
    """A ridge stands between two passes; those after them cut it away step by step, the first two are linked before."""
    drive, setup, stock = trench(30.0)
    stock = with_ridge(stock, 0.6)
    slim = replace(SLENDER, shank_diameter=1.9, neck_length=25.0)
    first = [run_of(2.0, 29.0, 14.0), run_of(29.0, 2.0, 16.0)]
    stairs = [run_of(24.0, 29.5, 15.0, z) for z in np.arange(18.0, -0.1, -2.0)]
    parameters = LinkParameters(stepover=0.7, lead_radius=0.0)
    for later, earlier in ((stairs, []), ([], stairs)):
        passes = [*earlier, *first, *later]
        kept, beside, _ = without_stock_contact(passes, drive, slim, stock, 0.7, NO_PROGRESS)
        made = linked_in_order(
            kept, drive, slim, DATA, stock, setup, replace(parameters, pass_stock=beside)
        )
        links = made.position[made.mark == Mark.LINK]
        across = np.abs(links[:, 1] - 15.0) < 1.5
        # Cut away before, nothing of it is in the way.
        assert bool((across & (links[:, 2] < 1.0)).any()) is bool(earlier)


def test_a_tool_is_fed_out_past_what_stands_round_it_where_its_pass_ends():
    """Beyond the pass's end stock stands 2.5 mm high, no higher than the flutes are long: the lead goes into it, no rapid up from there."""
    drive, setup, stock = trench(30.0)
    x, y = (
        stock.corner[k] + (np.arange(n) + 0.5) * stock.cell
        for k, n in enumerate(stock.heights.shape)
    )
    heights = stock.heights.copy()
    heights[x > 20.0] = 2.5
    heights[:, y > 25.0] = 20.0
    stock = replace(stock, field=heights)
    passes = [run_of(2.0, 28.0, 25.5), run_of(2.0, 20.0, 15.0)]
    kept, beside, _ = without_stock_contact(passes, drive, SLENDER, stock, 0.5, NO_PROGRESS)
    assert [p.tip[0, 1] for p in kept] == [15.0]
    parameters = LinkParameters(stepover=0.5, lead_radius=1.0, pass_stock=beside)
    made = linked_in_order(kept, drive, SLENDER, DATA, stock, setup, parameters)
    out = int(np.flatnonzero(made.mark == Mark.CUT)[-1]) + 1
    fed = made.position[out:][made.motion[out:] != Motion.RAPID]
    assert fed[-2, 2] == pytest.approx(1.0) and fed[-1, 2] == pytest.approx(2.5)
    assert (fed[-2:, :2] == fed[-1, :2]).all() and fed[-1, 0] > 20.5


@pytest.mark.parametrize("order", ["given", "nearest"])
def test_passes_are_asked_in_the_order_that_they_are_cut(order):
    """Steps make space for those below, but the lowest one begins nearest to the end of the pass before: cut at first it makes none."""
    drive, setup, stock = trench(30.0, deep=9.0)
    y = stock.corner[1] + (np.arange(stock.heights.shape[1]) + 0.5) * stock.cell
    heights = stock.heights.copy()
    heights[:, y > 18.0] = 9.0
    stock = replace(stock, field=heights)
    stairs = [run_of(28.0, 2.0, 22.0, z) for z in np.arange(7.0, -0.1, -1.0)]
    parameters = LinkParameters(stepover=0.5, lead_radius=0.0, order=order)
    made, findings = linked_without_contact(
        [run_of(2.0, 28.0, 15.0), *stairs],
        0.5,
        drive,
        SLENDER,
        DATA,
        stock,
        setup,
        parameters,
        NO_PROGRESS,
    )
    cut = made.position[(made.mark == Mark.CUT) & (np.abs(made.position[:, 1] - 22.0) < 0.1)]
    assert bool(findings) is (order == "nearest")
    assert bool(cut[:, 2].min() > 1.0) is (order == "nearest")


def test_leftovers_as_thick_as_the_flutes_are_long_are_in_a_neck_s_way_uphill():
    """Ground falls to both sides of x = 15; 2.5 mm lie on it, uphill of the pass higher than where its flutes end."""
    slope = grid(lambda x, y: -1.2 * np.abs(x - 15.0), n=31)
    drive, _, stock = driven(slope, top=20.0)
    x = stock.corner[0] + (np.arange(len(stock.heights)) + 0.5) * stock.cell
    ground = np.repeat((-1.2 * np.abs(x - 15.0))[:, None], stock.heights.shape[1], axis=1)
    tip = -1.2 * 10.0 + 1.0 * (np.hypot(1.0, 1.2) - 1.0)
    across = Pass(
        tip=np.array([[5.0, 2.0, tip], [5.0, 28.0, tip]]),
        axis=np.tile(UPRIGHT, (2, 1)),
        normal=np.tile(UPRIGHT, (2, 1)),
    )
    for thick, is_cut in ((0.3, True), (2.8, False)):
        kept, _, _ = without_stock_contact(
            [across], drive, SLENDER, replace(stock, field=ground + thick), 0.5, NO_PROGRESS
        )
        assert bool(kept) is is_cut
