"""The proof of turning: closed forms, and planted faults beside their clean twins."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
import shapely
from pytest import approx

from programs import CCW, LINE, RAPID, turned_path
from trunnion.findings import BadInput
from trunnion.geometry.frame import WORLD, Frame
from trunnion.model.motion.program import Program, ProgramSection
from trunnion.part.shape.facets import Facets
from trunnion.verify.judge.turned import (
    TurnedWork,
    prove_turned,
    turned_findings,
    turned_operations,
)
from trunnion.verify.settings import ProofSettings
from trunnion.verify.turning.moves import MeridianFrame, depth_between, in_order
from trunnion.verify.turning.proof import prove_turning
from turned_rings import (
    BACK,
    RING,
    SETUP,
    SHOP,
    STRONG,
    blank_of,
    ring_area,
    turned_over,
    turning_tool,
)

SHAFT = np.array([(0, 0), (50, 0), (50, 80), (0, 80)], float)
"""A plain shaft of radius 50, 80 high."""
BAR = np.array([(0, 0), (53, 0), (53, 80), (0, 80)], float)
LATHE, MATERIAL = SHOP.machine("Vertical lathe 600"), SHOP.material("EN AW-7075")
NOSE = 1.2


def section(*blocks, tool=STRONG, **changes):
    fields = {"spindle": 1000.0, "surface_speed": 300.0, "depth": 3.0, **changes}
    return ProgramSection(
        operation="turn", tool=turning_tool(tool), path=turned_path(*blocks), **fields
    )


def proof(*sections, part=SHAFT, stock=BAR, frame=WORLD, machine=LATHE):
    program = Program(name="s.S1", setup=replace(SETUP, frame=frame), sections=tuple(sections))
    plane = MeridianFrame.of(frame, WORLD, "S1")
    return prove_turning(
        program, plane, shapely.Polygon(part), shapely.Polygon(stock), machine, MATERIAL
    )


def along(radius, start=90.0, end=5.0, **changes):
    """Return a pass along the shaft at a radius, from above it down."""
    return section(
        (RAPID, 70.0, 100.0),
        (RAPID, radius, 100.0),
        (LINE, radius, start, 300.0),
        (LINE, radius, end, 300.0),
        (LINE, 60.0, end, 300.0),
        (RAPID, 70.0, 100.0),
        **changes,
    )


def codes(made, settings=None):
    from trunnion.verify.finish.coverage import Samples

    work = TurnedWork(proofs=(made,), before=blank_of(BAR), after=blank_of(SHAFT))
    point = np.array([[50.0, 0.0, z] for z in (20.0, 40.0)])
    samples = Samples(
        face=np.zeros(2, int), point=point, normal=np.tile([1.0, 0, 0], (2, 1)), area=np.ones(2)
    )
    found = turned_findings(
        work, samples, WORLD, np.array([7]), MATERIAL, settings or ProofSettings()
    )
    return {f.code: f for f in found}


def test_a_pass_takes_what_guldin_says():
    made = proof(along(50.0))
    # A ring of 3 mm from z = 80 down to the nose, which is round: its middle lies a nose radius over the path's end.
    length = 80.0 - 5.0
    under = 3.0 - NOSE * 0.0
    whole = 2.0 * math.pi * 51.5 * 3.0 * length
    assert made.removed.sum() == approx(whole, rel=0.01) and under == 3.0
    assert made.depth.max() == approx(3.0, rel=0.2)
    assert made.gouge.max() == 0.0 and "verify.gouge" not in codes(made)


@pytest.mark.parametrize("deep", [0.005, 0.05, 0.3])
def test_a_pass_that_goes_too_deep_is_measured(deep):
    made = proof(along(50.0 - deep))
    assert made.gouge.max() == approx(deep, abs=1.5e-3)
    assert ("verify.gouge" in codes(made)) == (deep > 0.02)


def test_the_face_that_is_entered_is_named():
    found = codes(proof(along(49.9)))["verify.gouge"]
    assert "face 7" in found.where and "0.100 mm" in found.text


def test_a_larger_nose_leaves_more_in_a_corner():
    part = np.array([(0, 0), (70, 0), (70, 20), (50, 20), (50, 80), (0, 80)], float)
    stock = np.array([(0, 0), (70, 0), (70, 20.5), (50.5, 20.5), (50.5, 80), (0, 80)], float)
    corner = shapely.box(49.9, 19.9, 51.3, 21.3)
    for name, nose in (("DCLNR2525M12 CNMG120408", 0.8), (STRONG, 1.2)):
        made = proof(along(50.0, end=20.0, tool=name), part=part, stock=stock)
        left = made.left.difference(shapely.Polygon(part)).intersection(corner)
        assert made.gouge.max() < 2e-3
        assert left.area == approx((1.0 - math.pi / 4.0) * nose**2, abs=0.02)


def test_a_missing_pass_leaves_its_stock():
    made = proof(along(50.0, end=40.0))
    left = made.left.difference(shapely.Polygon(SHAFT))
    assert left.area == approx(3.0 * 40.0, rel=0.02)


def test_a_holder_that_touches_the_part_is_found():
    # A left-hand tool that goes down along the shaft has its shank below its point: it runs into a collar there.
    part = np.array([(0, 0), (70, 0), (70, 30), (50, 30), (50, 80), (0, 80)], float)
    clean = along(50.0, start=90.0, end=70.0, tool=BACK)
    assert proof(clean, part=part, stock=part).collision.max() == 0.0
    low = along(50.0, start=90.0, end=52.0, tool=BACK)
    made = proof(low, part=part, stock=part)
    assert made.collision.max() > 1.0 and "verify.collision" in codes(made)


def test_a_rapid_through_a_tenth_of_stock_is_found():
    through = section(
        (RAPID, 70.0, 100.0), (RAPID, 52.9, 100.0), (RAPID, 52.9, 10.0), (RAPID, 70.0, 10.0)
    )
    beside = section(
        (RAPID, 70.0, 100.0), (RAPID, 53.0, 100.0), (RAPID, 53.0, 10.0), (RAPID, 70.0, 10.0)
    )
    assert proof(through).rapid_depth.max() == approx(0.1, abs=2e-3)
    assert proof(beside).rapid_depth.max() == 0.0
    assert "verify.rapid-in-stock" in codes(proof(through))


def test_too_deep_a_cut_is_excess_engagement_and_asks_too_much_power():
    thick = np.array([(0, 0), (65, 0), (65, 80), (0, 80)], float)
    made = proof(along(50.0), stock=thick)
    assert "verify.engagement" in codes(made)
    weak = replace(
        LATHE, work_spindle=replace(LATHE.work_spindle, power=((10.0, 0.1), (1000.0, 1.0)))
    )
    found = codes(proof(along(50.0), machine=weak))
    assert "verify.power" in found
    assert "verify.power" not in codes(proof(along(50.0)))


def test_a_depth_is_that_of_a_stretch():
    # Coming along a shoulder an edge cuts all of its length for some hundredths: that is no depth of 10 mm.
    part = np.array([(0, 0), (70, 0), (70, 20), (50, 20), (50, 80), (0, 80)], float)
    stock = np.array([(0, 0), (70, 0), (70, 20.3), (50.3, 20.3), (50.3, 80), (0, 80)], float)
    blocks = (
        (RAPID, 80.0, 100.0),
        (RAPID, 80.0, 60.0),
        (LINE, 80.0, 20.03, 300.0),
        (LINE, 50.0, 20.03, 300.0),
        (LINE, 50.0, 20.0, 300.0),
        (LINE, 80.0, 20.0, 300.0),
    )
    made = proof(section(*blocks, depth=0.3), part=part, stock=stock)
    assert made.gouge.max() < 2e-3 and made.depth.max() < 0.9
    assert "verify.engagement" not in codes(made)


def test_power_is_that_of_the_makers_formula():
    made = proof(along(50.0))
    row = int(np.argmax(made.depth * (made.moves.end[:, 0] == 50.0)))
    feed = made.moves.feed[row] / made.moves.turns[row]
    force = MATERIAL.force * (feed * math.sin(math.radians(95.0))) ** -MATERIAL.force_exponent
    speed = math.pi * 100.0 * made.moves.turns[row] / 1000.0
    assert made.power[row] == approx(speed * feed * made.depth[row] * force / 60e3, rel=1e-6)


def test_a_machine_that_does_not_turn_is_named():
    found = codes(proof(along(50.0), machine=SHOP.machine("Mill 1200")))
    assert "verify.no-work-spindle" in found


def test_a_table_that_turns_too_fast_is_named():
    assert "verify.spindle" in codes(proof(along(50.0, spindle=3000.0, surface_speed=0.0)))


def test_arcs_go_round_where_the_program_says():
    # A quarter from the cylinder over the shaft's edge to its end, the nose's middle round (45, 75) at 5 + its radius.
    r = 5.0 + NOSE
    rounded = np.array(
        [
            (50, 0),
            *[
                (45 + 5 * math.cos(a), 75 + 5 * math.sin(a))
                for a in np.linspace(0, math.pi / 2, 200)
            ],
        ]
    )
    part = np.vstack([[(0, 0)], rounded, [(0, 80)]])
    made = proof(
        section(
            (RAPID, 40.0, 100.0),
            (RAPID, 45.0 - NOSE, 90.0),
            (LINE, 45.0 - NOSE, 75.0 + r - NOSE, 200.0),
            (CCW, 45.0 - NOSE + r, 75.0 - NOSE, 45.0 - NOSE, 75.0 - NOSE, 200.0),
            (LINE, 50.0, 5.0, 200.0),
            (LINE, 60.0, 5.0, 200.0),
        ),
        part=part,
        stock=SHAFT,
    )
    assert made.gouge.max() < 2e-3
    corner = made.left.difference(shapely.Polygon(part)).intersection(shapely.box(44, 74, 51, 81))
    assert corner.area < 0.01


def test_a_part_that_is_turned_over_is_seen_from_its_other_end():
    frame = turned_over(80.0)
    made = proof(along(49.9), frame=frame)
    straight = proof(along(49.9))
    assert made.gouge.max() == approx(straight.gouge.max(), abs=1e-4)
    assert made.removed.sum() == approx(straight.removed.sum(), rel=1e-6)
    assert made.left.bounds[1] < 1e-9 and made.left.bounds[3] == approx(80.0)


def test_another_axis_is_refused():
    off = Frame(np.array([1.0, 0.0, 0.0]), np.array([1.0, 0, 0]), np.array([0, 0, 1.0]))
    with pytest.raises(BadInput, match="the work turns about its z"):
        MeridianFrame.of(off, WORLD, "S1")


def test_turning_after_milling_is_refused():
    from programs import FLAT_16, WALL
    from programs import section as milled

    turning = Program(name="a", setup=SETUP, sections=(along(50.0),))
    milling = Program(
        name="b", setup=replace(SETUP, name="S2"), sections=(milled("w", FLAT_16, WALL),)
    )
    assert in_order([turning, milling]) == 1
    with pytest.raises(BadInput, match="setup S1 turns what was milled before"):
        in_order([milling, turning])


def test_a_program_that_turns_all_away_is_refused_in_one_line():
    points = np.array(
        [(0.0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (9, 9, 9), (9, 9, 8), (9, 8, 9), (8, 9, 9)]
    )
    triangles = np.array(
        [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3), (4, 6, 5), (4, 5, 7), (5, 6, 7), (6, 4, 7)]
    )
    turning = Program(name="a", setup=SETUP, sections=(along(2.0, end=-30.0),))
    small = blank_of(np.array([(3, 0), (6, 0), (6, 2), (3, 2)], float))
    one = Facets.of_mesh(points[:4], triangles[:4], np.arange(4), np.arange(1, 5))
    with pytest.raises(BadInput, match="setup S1 turns all of the stock away"):
        prove_turned([turning], small, [LATHE], MATERIAL, one)
    two = Facets.of_mesh(points, triangles, np.arange(8), np.arange(1, 9))
    with pytest.raises(
        BadInput, match="can't be held against turning: the meridian is in 2 pieces"
    ):
        prove_turned([turning], small, [LATHE], MATERIAL, two)


def test_how_deep_two_areas_lie_in_each_other():
    box = shapely.box(0, 0, 10, 10)
    deep, at = depth_between(box, shapely.box(9.5, -5, 20, 15), 1e-3)
    assert deep == approx(0.5) and at[0] in (9.5, 10.0)
    assert depth_between(box, shapely.box(10, 0, 20, 10), 1e-3)[0] == 0.0
    # A wall that is wholly inside counts by how far it is from the rim.
    assert depth_between(box, shapely.box(4, -5, 4.2, 15), 1e-3)[0] >= 4.0


def test_operations_are_measured():
    work = TurnedWork(proofs=(proof(along(50.0)),), before=blank_of(BAR), after=blank_of(SHAFT))
    (found,) = turned_operations(work, ProofSettings())
    assert found.outcome.value == "passed" and found.removed > 0.0 and found.power > 0.0
    assert found.depth == approx(3.0, rel=0.2) and found.time_s > 10.0
    assert ring_area(RING).area > 0.0
