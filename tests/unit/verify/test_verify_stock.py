"""The stock engine: volumes worked out by hand, rapids, memory, and its compiled loops against plain ones."""

from __future__ import annotations

import math

import numpy as np
import pytest
from pytest import approx

from trunnion import tolerance
from trunnion.findings import OutOfMemory
from trunnion.geometry.frame import WORLD, Frame
from trunnion.model.blank import Box
from trunnion.verify.cutter import lowest_height
from trunnion.verify.finish.sweep import Sweep
from trunnion.verify.motion import moves_of
from trunnion.verify.stock import Stock, run_stock
from verify_tools import bull, flat, program_section

BOX = Box(frame=WORLD, low=(0.0, 0.0, 0.0), high=(100.0, 60.0, 20.0), material="test", density=2.8)


def cut(tool, stops, cell=0.25, rapid_to=0):
    moves = moves_of([program_section(tool, stops, rapid_to=rapid_to)])
    stock = Stock.of(BOX, cell)
    return stock, run_stock(stock, moves, WORLD, Sweep.of(moves, 2.0))


def test_a_level_line_removes_a_capsule():
    stock, run = cut(flat(10.0)(), [(20, 30, 25), (20, 30, 15), (80, 30, 15)])
    assert run.removed.sum() == approx((math.pi * 25 + 60 * 10) * 5, rel=2e-3)
    assert BOX.volume - stock.volume == approx(run.removed.sum())


def test_an_arc_removes_a_bent_capsule():
    run = cut(flat(10.0)(), [(70, 30, 25), (70, 30, 15), ((30, 30, 15), (50, 30))])[1]
    assert run.removed.sum() == approx((math.pi * 25 + math.pi * 20 * 10) * 5, rel=2e-3)


def test_a_ball_leaves_half_a_cylinder():
    run = cut(bull(10.0, 5.0)(), [(-20, 30, 15), (120, 30, 15)], rapid_to=0)[1]
    assert run.removed[1] == approx(math.pi * 25 / 2 * 100, rel=2e-3)


def test_a_ramp_leaves_the_lowest_that_its_sweep_reaches():
    stock = cut(flat(10.0)(), [(20, 30, 20), (80, 30, 14)])[0]
    row = stock.field.top[120]
    # Column at x = 50.125 is last under the rim when the axis is 5 further on.
    assert row[200] == approx(20.0 - 6.0 * (50.125 + math.sqrt(25 - 0.125**2) - 20.0) / 60.0)


def test_every_column_is_as_a_plain_loop_says():
    tool, stops = (
        bull(12.0, 3.0)(),
        [(10, 10, 25), (30, 20, 15), (55, 41.3, 13), ((35.0, 41.3, 13.0), (45.0, 41.3))],
    )
    stock = cut(tool, stops, cell=2.0)[0]
    y, x = (np.indices(stock.field.top.shape) + 0.5) * 2.0
    top = np.full(x.shape, 20.0)
    for t in np.linspace(0.0, 1.0, 4001):
        angle = t * math.pi
        for tip in (
            [10 + 20 * t, 10 + 10 * t, 25 - 10 * t],
            [30 + 25 * t, 20 + 21.3 * t, 15 - 2 * t],
            [45 + 10 * math.cos(angle), 41.3 + 10 * math.sin(angle), 13.0],
        ):
            top = np.minimum(top, tip[2] + lowest_height(tool, np.hypot(x - tip[0], y - tip[1])))
    # Samples along the moves stay short of the sweep's very rim, where a column falls from the blank's top at once.
    assert (stock.field.top <= top + tolerance.COINCIDENT).all()
    assert (np.abs(stock.field.top - top) < 0.02).mean() > 0.99


def test_a_rapid_over_the_stock_is_clear_and_through_it_is_not():
    stops = [(20, 30, 25), (20, 30, 20.005), (80, 30, 20.005), (80, 30, 19.9), (90, 30, 19.9)]
    run = cut(flat(10.0)(), stops, rapid_to=5)[1]
    assert run.rapid_depth == approx([0.0, 0.0, 0.0, 0.1, 0.1])


def test_a_rapid_back_over_a_fresh_floor_is_clear():
    stops = [(20, 30, 25), (20, 30, 15), (80, 30, 15)]
    there = program_section(flat(10.0)(), stops)
    back = program_section(flat(10.0)(), [(80, 30, 15), (20, 30, 15), (20, 30, 25)], rapid_to=3)
    moves = moves_of([there, back])
    assert (
        run_stock(Stock.of(BOX, 0.5), moves, WORLD, Sweep.of(moves, 2.0)).rapid_depth.max() == 0.0
    )


def test_below_the_blank_a_rapid_meets_nothing():
    # A ball below the bottom of a hole that it has drilled goes back down to where it was, as a peck does.
    stops = [(20, 30, 25), (20, 30, -6), (20, 30, 25), (20, 30, 25), (20, 30, -6)]
    drilled = program_section(bull(10.0, 5.0)(), stops[:3])
    back = program_section(bull(10.0, 5.0)(), stops[3:], rapid_to=1)
    moves = moves_of([drilled, back])
    stock = Stock.of(BOX, 0.5)
    run = run_stock(stock, moves, WORLD, Sweep.of(moves, 2.0))
    assert stock.field.top.min() == 0.0
    assert run.rapid_depth.max() == 0.0


def test_below_the_blank_a_shank_meets_nothing():
    # Shank and holder, wider than the flutes, stand below the bottom and in a hole that is wide enough for them.
    tool = flat(10.0)(flute=5.0)
    wide = program_section(flat(50.0)(), [(20, 30, 25), (20, 30, -1), (20, 30, 25)])
    deep = program_section(tool, [(20, 30, 25), (20, 30, -20), (20, 30, 25)], rapid_to=2)
    moves = moves_of([wide, deep])
    run = run_stock(Stock.of(BOX, 0.5), moves, WORLD, Sweep.of(moves, 2.0))
    assert run.body_depth[3:].max() == 0.0


def test_a_sloped_rapid_is_judged_at_the_height_it_has():
    run = cut(
        flat(10.0)(), [(-20, 30, 15), (-20, 30, 15), (-6.5, 30, 19.0), (50, 30, 60)], rapid_to=4
    )[1]
    assert run.rapid_depth.max() == 0.0


def test_a_holder_beside_standing_stock_is_seen():
    # Stickout 8, nose radius 12: a slot 9 deep, cut in two levels, leaves stock 1 mm into the holder.
    stops = [(20, 30, 25), (20, 30, 15), (80, 30, 15), (80, 30, 11), (20, 30, 11)]
    assert cut(flat(10.0)(flute=5.0), stops)[1].body_depth[4] == approx(1.0, abs=0.1)
    assert cut(flat(10.0)(flute=8.0), stops)[1].body_depth.max() == approx(
        0.0, abs=tolerance.COINCIDENT
    )


def test_what_short_flutes_leave_above_them_is_met_by_the_shank():
    # Flutes of 5 in a slot 9 deep leave a roof from 16 to 20; the shank is from 17 on, the holder from 19.
    run = cut(flat(10.0)(flute=5.0), [(20, 30, 25), (20, 30, 11), (80, 30, 11)])[1]
    assert run.body_depth[2] > 1.0


def test_a_field_too_large_is_refused_with_what_to_do():
    with pytest.raises(OutOfMemory, match=r"choose verify\.cell of at least 0\.01"):
        Stock.of(BOX, 0.001)


def test_a_blank_is_found_in_a_turned_setup():
    turned = Frame(
        np.array([100.0, 0.0, 20.0]), np.array([-1.0, 0.0, 0.0]), np.array([0.0, 0.0, -1.0])
    )
    low, high = BOX.box_in(turned)
    assert (low, high) == (approx([0.0, 0.0, 0.0]), approx([100.0, 60.0, 20.0]))


def test_removed_volume_never_depends_on_where_the_work_is_cut_in_chunks(monkeypatch):
    stops = [(20, 30, 25), *((20 + k, 30 + 5 * math.sin(k), 15.0) for k in range(60))]
    whole = cut(flat(10.0)(), stops)[1]
    monkeypatch.setattr("trunnion.verify.stock.heights.CHUNK_CELLS", 1)
    assert cut(flat(10.0)(), stops)[1].removed.tobytes() == whole.removed.tobytes()
    assert whole.rapid_depth.max() < tolerance.RAPID_DEPTH
