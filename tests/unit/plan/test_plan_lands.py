"""Level lands of curved parts: which there are, where an end mill may be on them, which one is taken, and what is cut in what order."""

from __future__ import annotations

import math
from dataclasses import replace

import cadquery as cq
import numpy as np
import pytest

from milling import mill
from samples import read, written
from trunnion import tolerance
from trunnion.geometry.frame import WORLD
from trunnion.geometry.plane.region import Region
from trunnion.model.blank import Box
from trunnion.model.setup import Setup
from trunnion.model.verdict import Outcome
from trunnion.part.shape.skin import skin_of
from trunnion.pipeline import Engine
from trunnion.plan.freeform.cutters.end_mills import end_mills_for
from trunnion.plan.freeform.lands import SKIM, LandClearances, PartAbove, covered, lands_of, without
from trunnion.plan.freeform.reach import samples_on
from trunnion.plan.freeform.roughing.layers import plane_drive_of
from trunnion.plan.freeform.space import SurfaceSpace
from trunnion.progress import NO_PROGRESS
from trunnion.toolpath.stock.heightfield import PlanningStock

SETUP = Setup(name="S1", frame=WORLD, work_offset="G54", clearance=40.0, machine="Mill 1200")
BARE, KEEPING = (LandClearances(lateral=beside, around=0.5, above=1.0) for beside in (0.0, 0.4))
MILLS = [mill(d) for d in (4.0, 6.0, 8.0, 12.0, 16.0)]
CURVED = {"recognize.family": "surface", "surface.scallop": 0.02, "surface.semi_allowance": 0.0}


def box(x0, y0, z0, x1, y1, z1):
    return cq.Workplane("XY").box(x1 - x0, y1 - y0, z1 - z0, centered=False).translate((x0, y0, z0))


def walled(height=15.0):
    """Return a plate of 40 x 30 x 6 with an upright wall 5 mm thick on it at x = 0."""
    return box(0, 0, 0, 40, 30, 6).union(box(0, 0, 0, 5, 30, 6 + height))


def grooved(height=8.0):
    """Return a small plate with a wall and, beside the land at its foot, a round groove of radius 7."""
    groove = cq.Workplane("XZ").circle(7.0).extrude(-20).translate((22, 0, 11))
    return box(0, 0, 0, 32, 20, 6).union(box(0, 0, 0, 4, 20, 6 + height)).cut(groove)


def boss():
    """Return a plate with a round boss of radius 6 in its middle, a fillet of 3 mm at its foot."""
    plate = box(0, 0, 0, 40, 30, 6).union(
        cq.Workplane("XY").circle(6).extrude(12).translate((20, 15, 0))
    )
    foot = [e for e in plate.edges("%CIRCLE").vals() if abs(e.Center().z - 6.0) < 1e-6]
    return plate.newObject(foot).fillet(3.0)


def spaced(work):
    part = read(work.val().wrapped)
    high = np.ceil(part.high)
    blank = Box(frame=WORLD, low=np.floor(part.low), high=high, material="EN AW-7075", density=2.8)
    return SurfaceSpace(
        part=part,
        blank=blank,
        setup=SETUP,
        direction=(0.0, 0.0, 1.0),
        skin=skin_of(part, WORLD, tolerance.CHORD),
        low=blank.low,
        high=blank.high,
    )


def lands(space):
    return lands_of(space, space.part.tags)


def chosen(space, mills=MILLS, ball=1.0, kept=()):
    return end_mills_for(
        PartAbove(space), lands(space), mills, ball, 0.97, KEEPING, kept, NO_PROGRESS
    )


def at(found, z):
    return next((c for c in found if abs(c.land.z - z) < 1e-6), None)


# which lands there are


def test_lands_look_up_and_lie_level_the_highest_first() -> None:
    ramp = cq.Workplane("XZ").moveTo(0, 6).lineTo(10, 6).lineTo(10, 9).close().extrude(-30)
    found = lands(spaced(walled().union(ramp.translate((30, 0, 0)))))
    assert [round(land.z, 6) for land in found] == [21.0, 6.0]
    assert found[1].region.area == pytest.approx(25.0 * 30.0)


def test_level_faces_that_hang_together_are_one_land() -> None:
    found = lands(spaced(box(0, 0, 0, 20, 20, 5).union(box(20, 0, 0, 40, 20, 5), clean=False)))
    assert [len(land.tags) for land in found] == [2]
    assert found[0].region.area == pytest.approx(800.0)


# where an end mill may be


def test_what_hangs_over_a_land_is_in_the_way() -> None:
    space = spaced(walled().union(box(0, 0, 18, 15, 30, 21)))
    over = PartAbove(space).over(6.0 + SKIM)
    assert over.area == pytest.approx(15.0 * 30.0, rel=0.01)
    assert over.contains([[14.9, 15.0]])[0]


def test_an_end_mill_goes_up_to_a_wall_and_hardly_over_the_rim_of_a_fillet() -> None:
    land = lands(spaced(walled()))[1]
    assert covered(
        land, PartAbove(spaced(walled())).free(land.z, MILLS[2], BARE), MILLS[2]
    ).area == pytest.approx(35.0 * 30.0, abs=1e-3)
    space = spaced(boss())
    free = PartAbove(space).free(6.0, MILLS[2], BARE)
    rim = 9.0 - math.sqrt(2.0 * 3.0 * SKIM)
    assert not free.contains([[20.0 + rim - 1e-3, 15.0]])[0]
    assert free.contains([[20.0 + rim + 1e-3, 15.0]])[0]


def test_it_keeps_off_sides_that_are_not_finished_yet_but_not_off_a_fillet() -> None:
    space = spaced(walled())
    assert covered(
        lands(space)[1], PartAbove(space).free(6.0, MILLS[2], KEEPING), MILLS[2]
    ).area == pytest.approx(34.6 * 30.0, abs=1e-3)
    space = spaced(boss())
    whole = lands(space)[-1]
    assert (
        without(
            whole.region, covered(whole, PartAbove(space).free(6.0, MILLS[2], KEEPING), MILLS[2])
        ).area
        < 1e-3
    )


def test_it_keeps_farther_off_an_unfinished_side_that_is_higher_than_its_flutes() -> None:
    space, low = spaced(walled()), replace(mill(8.0), flute_length=8.0)
    rims = [
        PartAbove(space).free(6.0, low, keeping).signed_distance([[10.0, 15.0]])[0]
        for keeping in (BARE, KEEPING)
    ]
    assert rims == pytest.approx([5.0, 4.0], abs=1e-3)


def test_a_shank_as_thick_as_the_cutter_keeps_off_a_taller_wall() -> None:
    short = replace(
        mill(8.0),
        flute_length=8.0,
        neck_length=10.0,
        neck_diameter=7.6,
        shank_diameter=8.0,
        stickout=60.0,
    )
    space = spaced(walled(30.0))
    assert PartAbove(space).free(6.0, short, BARE).signed_distance([[5.5, 15.0]])[
        0
    ] == pytest.approx(0.0, abs=1e-3)


# which is taken


@pytest.mark.parametrize("made", [walled, grooved, boss])
@pytest.mark.parametrize("clearances", [BARE, KEEPING])
def test_near_an_area_the_free_area_is_the_same_when_nothing_else_is_looked_at(
    made, clearances
) -> None:
    space = spaced(made())
    for land in lands(space):
        for tool in MILLS:
            whole = PartAbove(space).free(land.z, tool, clearances).intersect(land.region)
            near = PartAbove(space).free(land.z, tool, clearances, land.region)
            near = near.intersect(land.region)
            assert near.minus(whole).area + whole.minus(near).area < 1e-6


def test_no_section_is_made_where_nothing_near_is_as_high(monkeypatch) -> None:
    space = spaced(walled())
    part_above, tool = PartAbove(space), MILLS[0]
    monkeypatch.setattr(type(space.part), "section", lambda *_: pytest.fail("a section"))
    far = Region.rectangle(25.0, 10.0, 35.0, 20.0)
    free = part_above.free(6.0, tool, BARE, far)
    assert free.intersect(far).area == pytest.approx(far.area)


def test_the_largest_that_covers_nearly_all_is_taken_and_comes_back_to_the_foot_of_the_wall() -> (
    None
):
    found = at(chosen(spaced(walled())), 6.0)
    assert found.tool.diameter == 16.0
    assert found.rest.diameter == 16.0
    assert found.remaining.area < 0.1


def test_a_narrow_passage_asks_for_a_smaller_one() -> None:
    # 8.9 mm between two walls: with 0.4 mm kept on both sides 8 mm go in, 12 mm don't.
    wide = box(5, 0, 0, 13.9, 30, 6)
    assert (
        at(
            chosen(spaced(walled().union(wide).union(box(13.9, 0, 0, 40, 30, 21)))), 6.0
        ).tool.diameter
        == 8.0
    )


def test_small_lands_that_balls_finish_too_stay_with_them() -> None:
    assert chosen(spaced(cq.Workplane("XY").circle(10).extrude(10, taper=25))) == ()


def test_a_small_land_beside_a_wall_is_worth_an_end_mill() -> None:
    step = box(0, 0, 0, 40, 30, 6).union(box(0, 0, 0, 8, 9, 30)).union(box(8, 0, 0, 14, 9, 12))
    assert at(chosen(spaced(step)), 12.0) is not None


def test_a_slot_stays_with_a_ball() -> None:
    slot = box(0, 0, 0, 40, 30, 20).cut(box(10, 5, 8, 13, 25, 20))
    assert at(chosen(spaced(slot)), 8.0) is None


def test_a_land_under_an_overhang_is_left_alone() -> None:
    assert at(chosen(spaced(walled().union(box(0, 0, 18, 30, 30, 21)))), 6.0) is None


def test_a_cutter_in_use_serves_where_it_is_not_much_smaller() -> None:
    assert at(chosen(spaced(walled()), kept=[MILLS[3]]), 6.0).tool.diameter == 12.0
    assert at(chosen(spaced(walled()), kept=[MILLS[0]]), 6.0).tool.diameter == 16.0


def test_the_foot_of_the_wall_is_finished_with_the_land_and_no_more_of_it() -> None:
    space = spaced(walled())
    found = at(chosen(space), 6.0)
    wall = next(t for t in space.part.tags if abs(space.part.graph().centre[t - 1][0] - 5.0) < 1e-6)
    places = samples_on(space.skin, (wall,))
    done = found.finishes(places)
    assert places.point[done, 2].max() <= 6.0 + 8.0
    assert (done == (places.point[:, 2] <= 14.0)).all()


# operations


def routed(shape, **words):
    engine = Engine()
    return engine, engine.run(
        engine.with_choices(engine.open(written(shape.val().wrapped)), {**CURVED, **words}), "route"
    )


@pytest.fixture(scope="module")
def line():
    return routed(grooved())


def test_lands_come_before_curved_faces_and_their_corners_last(line) -> None:
    kinds = [o.kind for o in line[1].process.operations]
    assert (
        kinds.index("rough")
        < kinds.index("land")
        < kinds.index("finish")
        < kinds.index("rest_land")
    )


def test_no_ball_cuts_a_land_and_the_wall_beside_asks_for_no_small_one(line) -> None:
    process = line[1].process
    flat = {t for o in process.operations if o.kind in ("land", "rest_land") for t in o.faces}
    balls = [o for o in process.operations if o.tool.form == "ball"]
    assert flat and not any(flat & set(o.faces) for o in balls)
    assert min(o.tool.diameter for o in balls) >= 8.0


def test_a_small_land_joins_those_that_an_end_mill_is_there_for(line) -> None:
    land = next(o for o in line[1].process.operations if o.kind == "land")
    assert len(land.faces) == 3


@pytest.mark.parametrize(("end", "kinds"), [(38, 0), pytest.param(26, 1, marks=pytest.mark.long)])
def test_a_land_with_slits_that_only_balls_come_into_stays_with_them(end, kinds) -> None:
    pocket = box(0, 0, 0, 44, 26, 9).cut(box(3, 3, 5, 25, 23, 9)).cut(box(20, 12, 5, end, 15, 9))
    process = routed(pocket)[1].process
    assert len([o for o in process.operations if o.kind == "rest_land"]) == kinds


def test_the_setting_leaves_lands_to_balls() -> None:
    process = routed(grooved(), **{"surface.lands": False})[1].process
    assert not [o for o in process.operations if o.kind in ("land", "rest_land")]


def test_thick_stock_comes_off_a_land_in_steps() -> None:
    session = routed(grooved(), **{"surface.rough_allowance": 0.8})[1]
    land = next(o for o in session.process.operations if o.kind == "land")
    assert land.data.depth == pytest.approx(0.4)
    stock = PlanningStock.of(session.blank, session.setups[0])
    space = SurfaceSpace.of(
        read(grooved().val().wrapped), spaced(grooved()).skin, session.blank, session.setups[0]
    )
    floors = plane_drive_of(land, space, stock, NO_PROGRESS).floors
    assert [
        round(f.z - min(g.z for g in floors if g.face == f.face), 6)
        for f in floors
        if f.face == floors[-1].face
    ] == [0.4, 0.0]


def test_the_whole_line_passes_with_every_land_finished(line) -> None:
    engine, session = line
    verdict = engine.run(session, "verify").verdict
    assert verdict.outcome in (Outcome.PASSED, Outcome.REMARKS)
    assert (verdict.collisions, verdict.rapids_in_stock) == (0, 0)
    assert verdict.coverage > 0.999
    assert verdict.gouge <= tolerance.FINISH_GOUGE
