"""The peak of an operation's load: foreseen by the formula, kept within the spindle's limit, told where it can't be."""

from __future__ import annotations

import math
from dataclasses import fields, make_dataclass, replace
from typing import Any

import numpy as np
import pytest
from pytest import approx

from flat_parts import operation
from own_shop import own_shop
from samples import two_pockets_and_a_rib
from trunnion import registry
from trunnion.findings import Severity
from trunnion.geometry.frame import WORLD
from trunnion.model.load import spindle_loads
from trunnion.model.operation import CuttingData, Engagement
from trunnion.model.process import ProcessTree
from trunnion.model.setup import Setup
from trunnion.model.verdict import OperationProof, Outcome, Verdict
from trunnion.pipeline import Engine
from trunnion.plan.cutting.milling import CuttingSettings
from trunnion.plan.cutting.optimize import balance
from trunnion.plan.cutting.peak import LEAST_SHARE, overloads
from trunnion.plan.cutting.power import cutting_power
from trunnion.settings import choose, digest
from trunnion.toolpath.contract import strategy
from trunnion.toolpath.motion.load.engagement import corner_width, segment, step_width

SHOP = own_shop()
ALUMINIUM = SHOP.material("EN AW-7075")
TABLES = {"optimize.data": "handbook"}
SETUP = Setup(name="S1", frame=WORLD, work_offset="G54", clearance=20.0, machine="Mill 1200")


def tool(name: str):
    return next(t for t in SHOP.tools if t.name == name)


D20, D10 = tool("AL3-regular D20 R0"), tool("AL3-regular D10 R0")


def one(kind="rough", cutter=D20, depth=12.0, width=5.0, by_hand=False, **more):
    made = operation(kind, "pocket-01", cutter)
    return replace(made, data=replace(made.data, depth=depth, width=width), by_hand=by_hand, **more)


def process(*operations) -> ProcessTree:
    return ProcessTree(plan="", material="EN AW-7075", setups=(SETUP,), operations=operations)


def balanced(*operations, choices=None, **cutting):
    chosen = choose(CuttingSettings, {f"cutting.{name}": value for name, value in cutting.items()})
    words = {**TABLES, **(choices or {})}
    return balance(process(*operations), SHOP, chosen, words).operations


def slot_power(data, share):
    """Return the power in kW of a slot by D20 at a share of the feed."""
    feed = share * data.feed
    return cutting_power(ALUMINIUM, 20.0, feed / (D20.teeth * data.spindle), data.depth, 20.0, feed)


def test_roughing_foresees_a_full_slot_at_its_slot_feed():
    # fz = 0.6 * 5885 / (3 * 11141) = 0.1057; h = fz * 2 / pi; k_c = 700 h^-0.25 = 1374; Q = 20 * 12 * 3531 = 847 cm3/min.
    data = balanced(one())[0].data
    assert data.peak_power == approx(847.4e3 * 1374.0 / 60e6, rel=1e-3)
    assert data.power == approx(7.65, rel=1e-3) and data.highest_power == data.peak_power
    assert data.peak_torque == approx(data.peak_power * 60_000.0 / (2.0 * math.pi * data.spindle))
    assert data.peak_at == "the cutter enters at full width"
    assert (
        "peak 19.4 kW where the cutter enters at full width: ae 20, ap 12 at 0.6 of the feed"
        in data.rules
    )


def test_the_strategys_own_slot_feed_is_the_one_that_is_foreseen():
    data = balanced(one(), choices={"plane.rough.slot_feed": 0.3})[0].data
    assert data.peak_power == approx(slot_power(data, 0.3))
    own = balanced(one(choices={"plane.rough.slot_feed": 0.4}))[0].data
    assert own.peak_power == approx(slot_power(own, 0.4))


def test_what_has_no_overload_keeps_its_feeds_and_depths():
    data = balanced(one())[0].data
    assert (data.slot_share, data.depth, data.routed_depth) == (1.0, 12.0, 0.0)
    assert overloads(balanced(one())) == ()


def test_the_feed_in_full_width_is_lowered_first():
    easy, tight = balanced(one())[0].data, balanced(one(), power_share=0.4)[0].data
    assert tight.peak_power == approx(14.0, rel=1e-6) and tight.slot_share < 1.0
    assert (tight.feed, tight.depth) == (easy.feed, easy.depth)
    assert any("the feed there times 0.65: the spindle's limit" in rule for rule in tight.rules)


def test_the_depth_of_cut_is_lowered_next_and_comes_back():
    tight = balanced(one(), power_share=0.25)
    data = tight[0].data
    assert 0.6 * data.slot_share == approx(LEAST_SHARE)
    assert data.peak_power == approx(8.75, rel=1e-6) and data.depth < 12.0
    assert data.power <= data.power_limit
    assert balanced(*tight)[0].data == balanced(one())[0].data


def test_what_feed_and_depth_can_not_bring_below_the_limit_is_told():
    finish = one("profile_finish", D10, 20.0, 0.5, strategy="plane.profile_finish", faces=(3,))
    (finding,) = overloads(balanced(one(), finish, power_share=0.05))
    assert (finding.code, finding.severity, finding.where) == (
        "optimize.load",
        Severity.WARNING,
        ("profile_finish-pocket-01",),
    )
    assert (
        "where it meets what roughing left, 1.5 kW are allowed at" in finding.text
        and "smaller depth" in finding.remedy
    )


def test_data_set_by_hand_are_foreseen_and_told_but_not_changed():
    rough = one(by_hand=True)
    strong = replace(rough, data=replace(balanced(one())[0].data, feed=12_000.0, power_limit=28.0))
    (once,) = balanced(strong)
    assert (once.data.feed, once.data.slot_share) == (12_000.0, 1.0) and once.data.peak_power > 28.0
    assert [f.where for f in overloads((once,))] == [("rough-pocket-01",)]
    assert balanced(once) == (once,)
    assert overloads((replace(once, suppressed=True),)) == ()


def test_a_wall_after_a_larger_cutter_meets_what_that_left_in_corners():
    wall = one("wall", D10, 12.0, 0.5, strategy="plane.wall", faces=(3,))
    alone, after_small, after_large = (
        balanced(*before, wall)[-1].data for before in ((), (one(cutter=D10),), (one(),))
    )
    assert alone.peak_power == after_small.peak_power < after_large.peak_power
    assert after_large.peak_at == "it meets what roughing left"


def test_a_rib_wider_than_the_width_of_cut_is_met_in_one():
    rib = one("rib_top", depth=6.0, strategy="plane.rib_top")
    narrow, wide = (
        balanced(replace(rib, data=replace(rib.data, widest=w)))[0].data for w in (4.0, 14.0)
    )
    assert narrow.peak_power == approx(narrow.power) and wide.peak_power > 1.5 * wide.power


def test_a_top_that_one_row_takes_is_as_wide_as_it_is():
    mill = tool("FM-AL D63 Z5")
    face = one("face", mill, 2.0, 44.1, strategy="plane.face")
    narrow, wide = (
        balanced(replace(face, data=replace(face.data, widest=w)))[0].data for w in (55.0, 200.0)
    )
    assert wide.peak_power == approx(wide.power) and narrow.peak_power > narrow.power


def test_a_strategy_that_says_nothing_meets_no_more_than_its_data():
    @strategy(settings=CuttingSettings)
    def plain(*_):
        raise AssertionError

    met = plain.meets(D20, one().data, None, None)
    assert met == Engagement(width=5.0, depth=12.0, share=1.0, at="")


@pytest.mark.parametrize("name", registry.names("strategies"))
def test_every_strategy_says_what_it_meets(name):
    made = registry.get("strategies", name)
    met = made.meets(D10, one(cutter=D10).data, choose(made.settings, {}), one())
    assert 0.0 < met.width <= 10.0 and met.depth > 0.0 and 0.0 < met.share <= 1.0


def test_a_roughing_cutters_corner_leaves_its_square_less_its_quarter_circle_on_a_wall():
    bull = replace(D20, name="bull", form="bull", corner_radius=2.0)
    before = one(cutter=bull, depth=5.0)
    assert step_width(before) == approx((4.0 - math.pi) / 5.0)
    # A layer of half the radius: the mean of r - sqrt(r^2 - (r - z)^2) over it.
    mean = np.mean([2.0 - math.sqrt(4.0 - (2.0 - z) ** 2) for z in np.linspace(0.0, 1.0, 100_001)])
    assert step_width(one(cutter=bull, depth=1.0)) == approx(mean, abs=1e-4)
    assert step_width(one(cutter=D20)) == step_width(None) == 0.0


def test_into_a_square_corner_half_a_segment_comes_to_the_layer():
    # A layer of 10 at R 10: half of half the circle over a diameter's way.
    assert segment(10.0, 10.0) == approx(50.0 * math.pi)
    assert corner_width(D20, 10.0) == approx(10.0 + 25.0 * math.pi / 20.0)
    assert corner_width(D20, 30.0) == 20.0


def test_the_lower_feed_is_in_the_path():
    engine = Engine()
    session = engine.open(two_pockets_and_a_rib())
    feeds = []
    for share in (0.8, 0.2):
        done = engine.run(
            engine.with_choices(session, {"cutting.power_share": share}), until="toolpath"
        )
        rough = next(o for o in done.process.operations if o.strategy == "plane.rough")
        feeds.append(
            (
                rough.data.slot_share,
                float(
                    done.path_of(rough.id).path.feed[done.path_of(rough.id).path.mark == 0].min()
                ),
            )
        )
        assert rough.data.peak_power <= rough.data.power_limit * 1.000001
    (_, easy), (share, slow) = feeds
    assert share < 1.0 and slow < easy


def test_another_slot_feed_makes_the_balance_stale():
    engine = Engine()
    # The optimiser would find data for the same peak.
    opened = engine.with_choices(
        engine.open(two_pockets_and_a_rib()), {"optimize.data": "handbook"}
    )
    session = engine.run(opened, until="optimize")
    again = engine.with_choices(session, {"plane.rough.slot_feed": 0.9})
    assert (
        engine.states(session)["optimize"] == "done" and engine.states(again)["optimize"] == "stale"
    )
    before, after = (
        next(o for o in s.process.operations if o.strategy == "plane.rough").data.peak_power
        for s in (session, engine.run(again, until="optimize"))
    )
    assert after > before


def proof(power: float) -> Verdict:
    measured = OperationProof(
        operation="rough-pocket-01",
        setup="S1",
        outcome=Outcome.PASSED,
        gouge=0.0,
        collisions=0,
        rapids_in_stock=0,
        time_s=1.0,
        removed=1.0,
        air_share=0.0,
        power=power,
    )
    return Verdict(
        outcome=Outcome.PASSED,
        coverage=1.0,
        reachable=1.0,
        gouge=0.0,
        collisions=0,
        rapids_in_stock=0,
        machining_time_s=1.0,
        operations=(measured,),
    )


def test_the_highest_load_is_the_peak_and_after_the_proof_what_that_measured():
    operations = balanced(one())
    (foreseen,), (measured,), (idle,) = (
        spindle_loads(operations, v) for v in (None, proof(19.8), proof(0.1))
    )
    assert (foreseen.highest, foreseen.at) == (
        operations[0].data.peak_power,
        "the cutter enters at full width",
    )
    assert (measured.highest, measured.measured, measured.share) == (
        19.8,
        True,
        approx(19.8 / 28.0),
    )
    assert (idle.highest, idle.measured) == (operations[0].data.power, False)


def test_data_of_older_files_keep_their_digest():
    old = {f.name: getattr(one().data, f.name) for f in fields(CuttingData) if not f.metadata}
    assert len(old) == 12
    before = make_dataclass("CuttingData", [(name, Any) for name in old])(**old)
    assert digest(one().data) == digest(before)
    assert digest(replace(one().data, slot_share=0.5)) != digest(before)
