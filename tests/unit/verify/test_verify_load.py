"""Load on cutter and spindle: by hand, and as the proof judges it."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from pytest import approx

from own_shop import own_shop
from programs import S1
from trunnion.model.motion.program import Program
from trunnion.model.spindle import FeedMode
from trunnion.model.verdict import Outcome
from trunnion.post.dialects.linuxcnc import LinuxCncDialect
from trunnion.post.header import Header
from trunnion.post.readers.linuxcnc import read_linuxcnc
from trunnion.post.settings import PostSettings
from trunnion.verify.judge.load import least_angle, load_of, mean_share, stretched
from trunnion.verify.judge.overload import allowed_load
from trunnion.verify.motion import moves_of
from trunnion.verify.stock import StockRun
from verify_tools import BLANK, MACHINE, TOP, flat, program_section, proof

HEADER = Header(name="B1", part="B1", part_digest="ab12", plan_digest="cd34")
MATERIAL = own_shop().material("EN AW-7075")
SLOTTER = flat(10.0)(flute=25.0)
DEPTH = 6.0
SLOT = [(-45.0, 0.0, 30.0), (-45.0, 0.0, TOP), (45.0, 0.0, TOP), (45.0, 0.0, 30.0)]
"""A cut across the blank in full width, 6 deep."""
HIGH_BLANK = replace(BLANK, high=(30.0, 18.0, TOP + DEPTH))


def slot(feed=3000.0, width=10.0, depth=DEPTH, chosen=3000.0, spindle=10000.0):
    """Return the section of the slot; its data are for a width and a depth at a chosen feed."""
    section = program_section(SLOTTER, SLOT, operation="slot", rapid_to=1)
    path = replace(section.path, feed=np.where(section.path.feed > 0.0, feed, 0.0))
    return replace(section, path=path, width=width, depth=depth, feed=chosen, spindle=spindle)


def judged(section, machine=MACHINE, material=MATERIAL, **choices):
    """Return the verdict on a section in a blank that stands 6 mm over the part; coverage is not its subject."""
    return proof(
        section, blank=HIGH_BLANK, machine=machine, material=material, coverage=0.0, **choices
    )


def codes(verdict):
    return {f.code for f in verdict.findings} & {"verify.power", "verify.load", "verify.air"}


def test_a_full_slot_has_the_chips_and_the_power_of_the_formula():
    # fz = 3000 / (3 * 10000) = 0.1; h = 0.1 * 2 / pi; k_c = 700 h^-0.25; Q = 10 * 6 * 3000 = 180 cm3/min.
    section = slot()
    moves = moves_of((section,))
    run = StockRun(
        removed=np.where(moves.rapid, 0.0, 60.0 * moves.length),
        rapid_depth=np.zeros(4),
        rapid_position=np.zeros((4, 3)),
        body_depth=np.zeros(4),
        engagement=np.full(4, math.pi),
        depth_of_cut=np.full(4, 6.0),
        widest=np.full(4, 10.0),
        peak=np.ones(4),
    )
    speed = np.where(moves.rapid, 0.0, 50.0)
    load = load_of(moves, run, speed, (section,), 0.5, MATERIAL)
    force = 700.0 * (0.2 / math.pi) ** -0.25
    assert load.rate[2] == approx(180.0)
    assert load.depth[2] == approx(6.0)
    assert load.mean_chip[2] == approx(0.2 / math.pi)
    assert load.power[2] == approx(180.0 * force / 60_000.0)
    assert load.torque[2] == approx(load.power[2] * 60_000.0 / (2 * math.pi * 10000.0))
    assert not load.power[moves.rapid].any()


def test_a_slot_fed_by_the_revolution_is_proven_like_one_fed_by_the_minute():
    proofs = []
    for mode in FeedMode:
        program = Program(name="S1", setup=S1, sections=(replace(slot(), feed_mode=mode),))
        text = LinuxCncDialect().write([program], HEADER, PostSettings())
        (read,) = read_linuxcnc(text, (SLOTTER,), S1).sections
        proofs.append(judged(replace(read, width=10.0, depth=DEPTH, feed=3000.0)).operations[0])
    first, *others = proofs
    assert first.power > 4.0
    for other in others:
        assert (other.power, other.torque, other.chip) == approx(
            (first.power, first.torque, first.chip), rel=1e-4
        )
        assert (other.time_s, other.power_limit) == approx((first.time_s, first.power_limit))


def test_a_move_through_the_air_beside_a_cut_has_no_load():
    # Down beside the blank at more than three times the slot's feed: it takes nothing, though the stretch about it reaches into the slot.
    stops = [(-35.5, 0.0, 30.0), (-35.5, 0.0, TOP + 2.0), (-35.5, 0.0, TOP), *SLOT[2:]]
    section = program_section(SLOTTER, stops, operation="slot", rapid_to=1)
    fast = replace(
        slot(), path=replace(section.path, feed=np.array([0.0, 0.0, 10_000.0, 3000.0, 3000.0]))
    )
    measured = judged(fast).operations[0]
    assert measured.power == approx(4.2, rel=0.05)
    assert measured.rate == approx(180.0, rel=0.02)


def test_a_cut_narrower_than_the_cells_has_about_the_power_of_the_formula():
    # ae 0.3 at D 10: 0.348 rad, of which the chip's mean is a share of 0.172; k_c = 700 (0.1 * 0.172)^-0.25; Q = 5.4 cm3/min. The stock
    # has columns 0.5 mm apart, and gives one of them.
    beside = [(x, 22.7, z) for x, _, z in SLOT]
    section = replace(
        slot(),
        path=replace(program_section(SLOTTER, beside, rapid_to=1).path, feed=slot().path.feed),
    )
    power = 5.4 * 700.0 * (0.1 * 0.1725) ** -0.25 / 60_000.0
    measured = judged(section).operations[0]
    assert measured.engaged == 0.0
    assert power <= measured.power <= 2.0 * power


def test_the_least_angle_is_that_of_a_cut_all_along_the_flutes():
    # 50 mm2 along 20 mm of flutes: 2.5 wide, a quarter of the diameter.
    assert least_angle(np.array([50.0, 0.0]), np.full(2, 5.0), np.full(2, 20.0)) == approx(
        [math.pi / 3.0, 0.0]
    )


def test_a_short_widening_counts_for_no_more_than_its_own_section():
    # 94 mm with 3.4 mm2 on the mean; over a diameter 2.9 mm wide and 6.5 deep, eight times the mean of the widths that were seen.
    moves = moves_of((slot(),))
    run = StockRun(
        removed=np.where(moves.rapid, 0.0, 3.4 * moves.length),
        rapid_depth=np.zeros(4),
        rapid_position=np.zeros((4, 3)),
        body_depth=np.zeros(4),
        engagement=np.full(4, 2.0),
        depth_of_cut=np.full(4, 6.5),
        widest=np.full(4, 2.9),
        peak=np.full(4, 8.0),
    )
    assert load_of(moves, run, np.where(moves.rapid, 0.0, 50.0), (slot(),), 0.5, MATERIAL).rate[
        2
    ] == approx(2.9 * 6.5 * 3.0)


def test_what_a_slower_neighbour_takes_off_goes_at_the_neighbours_feed():
    # A slow block takes 20 mm2, a quick one of the same length 2 mm2: within a diameter the quick one bears (20 * 500 + 2 * 3000) / 2.
    section = program_section(SLOTTER, [(0.0, 0.0, 0.0), (5.0, 0.0, 0.0), (10.0, 0.0, 0.0)])
    moves = moves_of((replace(section, spindle=10000.0),))
    taken, feed = np.array([0.0, 100.0, 10.0]), np.array([0.0, 500.0, 3000.0])
    run = StockRun(
        removed=taken,
        rapid_depth=np.zeros(3),
        rapid_position=np.zeros((3, 3)),
        body_depth=np.zeros(3),
        engagement=np.full(3, math.pi / 2),
        depth_of_cut=np.full(3, 4.0),
        widest=np.zeros(3),
        peak=np.ones(3),
    )
    load = load_of(moves, run, feed / 60.0, (section,), 0.5, MATERIAL)
    # The window of 10 mm about a block of 5 mm reaches over half of each neighbour.
    assert load.rate[2] == approx((2.5 * 20 * 500 + 5 * 2 * 3000) / 7.5 / 1000.0)
    # The slow block bears no more than its stretch at its own feed.
    assert load.rate[1] == approx((5 * 20 + 2.5 * 2) / 7.5 * 500 / 1000.0)


def test_the_mean_chip_over_half_a_turn_is_two_over_pi():
    assert mean_share(np.array([math.pi, math.pi / 2, 0.0])) == approx(
        [2 / math.pi, 2 / math.pi, 0.0]
    )


def test_volumes_that_come_in_steps_are_spread_over_the_stretch():
    # A hundred blocks of 0.1 mm; every fifth takes a column that the others only pass: 2 mm2 on the mean.
    section = program_section(
        SLOTTER, [(0.0, 0.0, 0.0), *((0.1 * k, 0.0, 0.0) for k in range(1, 101))]
    )
    moves = moves_of((section,))
    removed = np.where(np.arange(101) % 5 == 0, 1.0, 0.0)
    removed[0] = 0.0
    assert stretched(moves, removed, np.full(101, 5.0))[30:70] == approx(2.0, rel=0.05)


def test_a_stretch_ends_at_a_rapid():
    stops = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (2.0, 0.0, 0.0), (3.0, 0.0, 0.0)]
    section = program_section(SLOTTER, stops, rapid_to=0)
    middle = replace(
        section, path=replace(section.path, motion=[0, 1, 0, 1], feed=[0.0, 100.0, 0.0, 100.0])
    )
    moves = moves_of((middle,))
    assert stretched(moves, np.array([0.0, 5.0, 0.0, 1.0]), np.full(4, 50.0)) == approx(
        [0.0, 5.0, 0.0, 1.0]
    )


def test_the_proof_measures_a_slot_as_what_it_is():
    measured = judged(slot()).operations[0]
    assert measured.rate == approx(180.0, rel=0.02)
    assert math.degrees(measured.engaged) == approx(180.0, abs=10.0)
    assert measured.depth == approx(DEPTH, rel=0.1)
    assert measured.power == approx(4.2, rel=0.05)
    assert measured.chip == approx(0.1, rel=0.01)


def test_a_spindle_that_is_too_weak_fails_and_the_feed_offered_keeps_its_limit():
    weak = replace(MACHINE, power=((100.0, 0.03), (20000.0, 6.0)))
    verdict = judged(slot(), weak)
    (finding,) = [f for f in verdict.findings if f.code == "verify.power"]
    assert verdict.outcome is Outcome.FAILED
    assert "of the spindle at 10000 1/min, test mill gives 3.0 kW" in finding.text
    offer = next(o for o in verdict.offers if o.reason == "verify.power")
    assert offer.kind == "feed" and f"{offer.feed:.0f} mm/min" in finding.remedy
    assert codes(judged(slot(feed=offer.feed), weak)) == set()
    assert codes(judged(slot(feed=1.2 * offer.feed), weak)) == {"verify.power"}


def test_a_spindle_that_is_strong_enough_is_clean():
    assert codes(judged(slot())) == set()


def test_a_full_slot_at_more_than_the_feed_for_a_quarter_of_the_width_is_excess_engagement():
    # Data for ae 0.25 D, the same depth and 2400 mm/min: the slot removes five times that, three are allowed.
    verdict = judged(slot(width=2.5, chosen=2400.0))
    assert codes(verdict) == {"verify.load"}
    assert verdict.outcome is Outcome.REMARKS
    offer = next(o for o in verdict.offers if o.reason == "verify.load")
    assert offer.feed == approx(1800.0, rel=0.02)
    assert codes(judged(slot(width=2.5, feed=offer.feed, chosen=2400.0))) == set()


def test_a_full_slot_at_reduced_feed_is_judged_by_its_load_not_by_its_angle():
    assert codes(judged(slot(feed=1800.0, width=2.5, chosen=2400.0))) == set()


def test_a_feed_that_makes_chips_too_thick_is_excess_even_where_little_is_removed():
    # fz = 0.3 at a table that ends at 0.12 for 10 mm; the depth of 0.5 keeps the removal rate low.
    thin = [(x, y, z + DEPTH - 0.5 if z < 30.0 else z) for x, y, z in SLOT]
    section = program_section(SLOTTER, thin, operation="slot", rapid_to=1)
    path = replace(section.path, feed=np.where(section.path.feed > 0.0, 9000.0, 0.0))
    fast = replace(section, path=path, width=10.0, depth=6.0, feed=3000.0)
    assert codes(judged(fast)) == {"verify.load"}


def test_the_tables_of_the_material_widen_what_a_finishing_cut_may_meet():
    finishing = allowed_load(slot(width=0.3, depth=2.0), MATERIAL)
    assert finishing.rate == approx(0.6 * 0.25 * 100.0 * 3.0)
    assert finishing.chip == approx(0.12)
    assert allowed_load(slot(width=0.3, depth=2.0), None).rate == approx(0.6 * 3.0)


def test_nothing_is_said_of_loads_where_nothing_is_known():
    unknown = replace(slot(width=0.0, depth=0.0, chosen=0.0))
    assert codes(judged(unknown, material=None)) == set()


@pytest.mark.parametrize(("passes", "remarked"), [(1, False), (12, True)])
def test_cutting_air_for_long_is_remarked_and_a_rest_operation_offered(passes, remarked):
    stops = [*SLOT[:2], *[SLOT[2], SLOT[1]] * passes, SLOT[3]]
    section = replace(
        program_section(SLOTTER, stops, operation="slot", rapid_to=1),
        width=10.0,
        depth=6.0,
        feed=1000.0,
    )
    verdict = judged(section)
    assert ("verify.air" in codes(verdict)) is remarked
    assert [o.kind for o in verdict.offers] == (["rest"] if remarked else [])


def test_blocks_keep_what_was_measured_of_them():
    verdict = judged(slot())
    (blocks,) = verdict.blocks
    assert len(blocks.time) == len(SLOT) and blocks.rate.dtype == np.float32
    assert (
        np.isnan(blocks.left_min[0])
        and blocks.left_min[2] == approx(0.0, abs=1e-3)
        and blocks.left_max[2] >= blocks.left_mean[2]
    )
    assert float(blocks.removed.sum()) == approx(verdict.operations[0].removed, rel=1e-5)
