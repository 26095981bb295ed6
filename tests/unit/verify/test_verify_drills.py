"""What the proof takes for the load of drills: their whole circle, chips as thick as their point makes them."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from pytest import approx

from own_shop import own_shop
from programs import section
from trunnion.model.motion.cycle import Cycle, CycleKind
from trunnion.model.motion.drilling import drilled
from trunnion.verify.judge.load import drill_shares
from trunnion.verify.judge.overload import allowed_load

SHOP = own_shop()
DRILL = next(t for t in SHOP.tools if t.name == "DR-K D10")
MILL = next(t for t in SHOP.tools if t.name == "AL3-regular D10 R0")
PATH = drilled(
    np.array([0.0, 0.0, 20.0]),
    np.array([[10.0, 10.0, 2.0]]),
    Cycle(kind=CycleKind.DRILL, depth=12.0),
    1200.0,
)


def drilling(tool):
    return replace(section("drill-hole-01", tool, PATH, 6000.0), width=10.0, depth=5.0, feed=1200.0)


def test_a_drills_chip_is_as_thick_as_its_point_makes_it():
    shares = drill_shares((drilling(DRILL), drilling(MILL)))
    assert shares == approx([math.sin(math.radians(70.0)), 0.0])


def test_a_drill_is_allowed_its_whole_circle_at_the_feed_of_its_data():
    allowed = allowed_load(drilling(DRILL), SHOP.material("EN AW-7075"))
    assert allowed.rate == approx(math.pi / 4 * 100.0 * 1200.0 / 1000.0)
    assert allowed.chip == approx(math.sin(math.radians(70.0)) * 1200.0 / (2 * 6000.0))


def test_a_reamers_chip_is_as_thick_as_its_lead_of_45_degrees_makes_it():
    reamer = next(t for t in SHOP.tools if t.name == "RE-H7 D10")
    assert drill_shares((drilling(reamer),)) == approx([math.sqrt(0.5)])


def test_a_reamer_is_allowed_the_ring_of_its_depth_of_cut():
    reamer = next(t for t in SHOP.tools if t.name == "RE-H7 D10")
    ring = math.pi / 4 * (10.0**2 - 9.8**2)
    allowed = allowed_load(replace(drilling(reamer), depth=0.1, width=10.0), None)
    assert allowed.rate == approx(ring * 1200.0 / 1000.0)
