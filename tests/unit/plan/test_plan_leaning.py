"""Pockets with leaning walls and curved floors: what is planned for them, where layers and floors may be, and what is named as left."""

from __future__ import annotations

import math
import re
from functools import cache, partial
from typing import Any

import numpy as np
import pytest

import leaning_pockets
import samples
from flat_parts import MILL
from long_mark import mostly_long
from trunnion import tolerance
from trunnion.geometry.plane.region import union_all
from trunnion.model.session import Session
from trunnion.pipeline import Engine
from trunnion.plan.contract import DriveNeeds
from trunnion.plan.freeform.drive import SurfaceDrive
from trunnion.plan.freeform.space import SurfaceSpace
from trunnion.plan.panel.feasibility import adjacent, plannable
from trunnion.plan.panel.freeform.pocket import FreeformPocket
from trunnion.plan.prismatic.regions import SetupSpace
from trunnion.plan.setups import SetupSettings, make_setups
from trunnion.progress import NO_PROGRESS
from trunnion.settings import choose

SHAPES = {
    "away": leaning_pockets.leaning_block,
    "over": leaning_pockets.mixed_block,
    "over a fillet": partial(leaning_pockets.mixed_block, fillet=3.0),
    "over two floors": leaning_pockets.stepped_block,
    "bowl": leaning_pockets.bowl_block,
    "hill": leaning_pockets.hill_block,
    "bowl beside overhang": leaning_pockets.bowl_beside_overhang_block,
    "steep hill": partial(leaning_pockets.hill_block, radius=32.0),
    "sharp bowl": partial(leaning_pockets.bowl_block, fillet=0.0),
}


@cache
def routed(name: str) -> tuple[Engine, Session]:
    engine = Engine()
    return engine, engine.run(engine.open(samples.written(SHAPES[name]())), "route")


def operations(name: str) -> dict[str, Any]:
    process = routed(name)[1].process
    assert process is not None
    return {o.id: o for o in process.operations}


@cache
def pocket_of(name: str) -> tuple[FreeformPocket, SurfaceSpace]:
    engine, session = routed(name)
    assert session.recognition is not None and session.blank is not None
    setup, part = session.setups[0], engine.context.part
    space = SetupSpace.of(part, session.recognition, session.blank, setup)
    curved = SurfaceSpace.of(part, engine.context.skin(tolerance.CHORD), session.blank, setup)
    feature = session.recognition.feature("pocket-01")
    return FreeformPocket.of(feature, space, curved, frozenset()), curved


def not_planned(name: str) -> list[Any]:
    return [f for f in routed(name)[1].findings() if f.code == "route.not-planned"]


def test_a_pocket_whose_walls_lean_away_is_roughed_by_layers_and_finished_by_waterlines() -> None:
    found = operations("away")
    assert [found[f"{k}-pocket-01"].strategy for k in ("rough", "floor", "leaning_side")] == [
        "plane.rough",
        "plane.floor",
        "surface.waterline",
    ]
    assert not not_planned("away")


def test_its_waterlines_finish_every_side_with_an_end_that_fits_the_fillet() -> None:
    feature = pocket_of("away")[0].feature
    side = operations("away")["leaning_side-pocket-01"]
    sides = feature.with_role("outer_convergence", "corner", "floor_fillet")
    assert set(side.faces) == set(sides)
    assert 0.0 < side.tool.corner_radius <= 4.0
    assert side.choices["surface.scallop"] == 0.01


def test_steps_of_layers_stand_out_of_a_leaning_wall_by_no_more_than_is_wanted() -> None:
    rough = operations("away")["rough-pocket-01"]
    step = rough.choices["surface.layer"]
    assert isinstance(step, float) and step < rough.data.depth
    assert step * math.tan(math.radians(5.0)) <= 0.5 + 1e-9


@pytest.mark.parametrize("name", mostly_long(SHAPES, "away", "over", "hill"))
def test_layers_keep_the_allowance_off_all_that_stands_at_their_height_or_over_it(
    name: str,
) -> None:
    pocket, curved = pocket_of(name)
    area = pocket.layer_area()
    tall = area.height_map(curved, 0.25, 0.3, NO_PROGRESS)
    points = curved.skin.points
    for z in np.linspace(pocket.bottom + 0.4, pocket.top - 0.1, 7):
        free = tall.below(float(z), 0.15).intersect(area.within(float(z)))
        higher = points[points[:, 2] > z]
        assert free.signed_distance(higher[:, :2]).max() < -0.25, z


def test_a_wall_that_leans_over_is_named_with_its_faces_and_left() -> None:
    pocket, _ = pocket_of("over")
    (hanging,) = pocket.feature.with_role("inner_convergence")
    (told,) = not_planned("over")
    assert {"pocket-01", f"face {hanging}"} <= set(told.where)
    # Its corners lean over with it.
    area = float(routed("over")[0].context.part.graph().area[hanging - 1])
    assert area <= float(re.search(r"([\d.]+) mm2", told.text)[1]) < 4.0 * area
    assert all(hanging not in o.faces for o in operations("over").values())


def test_a_floor_under_it_ends_where_its_upper_edge_is_seen_from_above() -> None:
    pocket, _ = pocket_of("over")
    (floor,), (level,) = pocket.floors()
    away = 12.0 * math.tan(math.radians(5.0))
    wide = np.diff(np.array(floor.region.box()), axis=0)[0]
    outline = np.sort([leaning_pockets.FOOT[0] - away, leaning_pockets.FOOT[1]])
    assert np.sort(wide) == pytest.approx(outline, abs=0.01)
    assert not floor.region.minus(level.boundary.offset(1e-3))


def test_no_cutter_goes_under_an_upper_edge_that_lies_outside_of_the_floor_over_its_fillet() -> (
    None
):
    pocket, _ = pocket_of("over a fillet")
    (floor,), (level,) = pocket.floors()
    free = pocket.free_at(level.bottom + pocket.fillet + 0.1)
    for area in (floor.region, level.boundary):
        assert not area.minus(free.offset(0.02))
    assert pocket.overhang_rims()


def test_what_goes_down_to_a_lower_floor_has_its_space_at_the_height_of_higher_ones() -> None:
    higher, lower = pocket_of("over two floors")[0].floors()[1]
    assert higher.bottom > lower.bottom
    assert not lower.boundary.minus(higher.boundary.offset(0.02))


def test_a_flank_goes_along_the_upper_edge_of_a_wall_that_leans_over() -> None:
    (rim,) = pocket_of("over")[0].overhang_rims()
    edge = 0.5 * (leaning_pockets.BLOCK[0] + leaning_pockets.FOOT[0]) - 12.0 * math.tan(
        math.radians(5.0)
    )
    # The part lies on the right of a guide line: along high x it runs towards high y, and round both corners.
    setup, curved = routed("over")[1].setups[0], pocket_of("over")[1]
    run = setup.frame.to_world(
        np.column_stack([rim.curve.points, np.full(len(rim.curve.points), rim.bottom)])
    )
    straight = run[np.abs(run[:, 0] - edge) < 0.02]
    assert len(straight) >= 2 and straight[0, 1] < straight[-1, 1] - 10.0
    assert run[:, 0].max() < edge + 0.02
    assert (rim.top, rim.bottom) == pytest.approx((curved.skin.points[:, 2].max(), -12.0 + rim.top))


def test_sides_beside_such_an_edge_come_after_it_and_need_not_keep_off_what_was_left_there() -> (
    None
):
    found = operations("over")
    assert list(found).index("overhang_rim-pocket-01") < list(found).index("leaning_side-pocket-01")
    assert found["leaning_side-pocket-01"].choices["surface.overhang"] == 0.0
    rim = found["overhang_rim-pocket-01"]
    assert rim.tool.radius < 8.0 and rim.tool.corner_radius == 0.0
    assert not any(id.startswith("overhang_rim") for id in operations("away"))


def test_a_curved_floor_is_cut_at_a_constant_scallop_after_its_walls() -> None:
    found = list(operations("bowl"))
    order = [found.index(f"{k}-pocket-01") for k in ("rough", "leaning_side", "semi")]
    assert order == sorted(order)
    floor = operations("bowl")["curved_floor-pocket-01"]
    assert floor.strategy == "surface.constant"
    assert set(pocket_of("bowl")[0].curved) <= set(floor.faces)
    assert not not_planned("bowl")


def test_a_sharp_foot_of_a_curved_floor_gets_an_end_sharper_than_any_ball() -> None:
    floors = [o for o in operations("sharp bowl").values() if o.kind == "curved_floor"]
    *balls, last = [o.tool for o in floors]
    assert balls and all(t.form == "ball" for t in balls)
    assert last.form == "bull" and last.corner_radius < min(t.corner_radius for t in balls)
    assert floors[-1].choices["surface.earlier"] == balls[-1].name
    # In a fillet there is nothing for it.
    assert {o.tool.form for o in operations("bowl").values() if o.kind == "curved_floor"} == {
        "ball"
    }


def test_a_thinner_cutter_comes_after_a_sharp_end_that_a_falling_floor_keeps_off_the_foot() -> None:
    first, rest = (o for o in operations("hill").values() if o.kind == "leaning_side")
    assert rest.choices["surface.earlier"] == first.tool.name
    assert first.tool.corner_radius == 0.0 and rest.tool.diameter < first.tool.diameter


def test_what_hangs_over_behind_a_rib_keeps_no_cutter_off_the_walls_on_its_other_side() -> None:
    engine, session = routed("bowl beside overhang")
    assert session.recognition is not None and session.blank is not None
    (bowl,) = [
        f.id for f in session.recognition.of_kind("pocket") if not f.with_role("inner_convergence")
    ]
    space = SurfaceSpace.of(
        engine.context.part,
        engine.context.skin(tolerance.SKIN_CHORD),
        session.blank,
        session.setups[0],
    )
    found = [o for o in operations("bowl beside overhang").values() if o.feature == bowl]
    finishing = [o for o in found if o.kind in ("leaning_side", "semi", "curved_floor")]
    assert len(finishing) >= 3
    for operation in finishing:
        drive = space.drive_of(operation, DriveNeeds(drive=SurfaceDrive))
        faces = drive.skin.of(drive.faces), space.skin.of(operation.faces)
        own, whole = (
            s.areas(f).sum() for s, f in zip((drive.skin, space.skin), faces, strict=True)
        )
        assert own == pytest.approx(whole), operation.id


def test_rest_layers_go_so_far_down_beside_a_hill_that_no_neck_meets_what_stays() -> None:
    found = operations("steep hill")
    rough, rest = (found[f"{k}-pocket-01"].tool for k in ("rough", "rest"))
    flutes = min(
        o.tool.flute_length
        for o in found.values()
        if o.kind in ("leaning_side", "semi", "curved_floor")
    )

    def stays(diameter: float) -> float:
        """Return how high over the walls' foot the gap beside the hill is as wide as a cutter."""
        end = 0.5 * leaning_pockets.FOOT[0]
        return math.sqrt(32.0**2 - (end - diameter) ** 2) - math.sqrt(32.0**2 - end**2)

    assert stays(rest.diameter) < flutes < stays(rough.diameter)


def test_each_pocket_has_its_own_share_of_a_rib_that_goes_past_several() -> None:
    engine = Engine()
    session = engine.run(engine.open(samples.written(leaning_pockets.ribbed_block())), "blank")
    found, part = session.recognition, engine.context.part
    assert found is not None and session.blank is not None
    setup = make_setups(found, session.blank, choose(SetupSettings, MILL))[0]
    space = SetupSpace.of(part, found, session.blank, setup)
    curved = SurfaceSpace.of(part, engine.context.skin(tolerance.CHORD), session.blank, setup)
    beside = adjacent(found, part)
    (rib,) = found.of_kind("rib")
    whole = part.face_outline(setup.frame, rib.with_role("top")[0])
    pockets = [FreeformPocket.of(f, space, curved, beside[f.id]) for f in found.of_kind("pocket")]
    assert len(pockets) == 4
    for pocket in pockets:
        ((height, share),) = pocket.ribs
        assert height < pocket.top and 0.4 * whole.area < share.area < 0.6 * whole.area
        # What is its own at the top is not much wider than its mouth: by the rib, and by its walls on the way there.
        (low, high), (inner, outer) = pocket.limit(pocket.top).box(), pocket.mouth.box()
        assert (low > inner - 12.0).all() and (high < outer + 12.0).all()
    # Together they have all of it.
    assert whole.minus(union_all([p.limit(p.top) for p in pockets])).area < 1e-3


def test_a_typical_plan_without_layers_refuses_leaning_walls() -> None:
    _, session = routed("away")
    assert session.recognition is not None
    stages = routed("away")[0].context.shop.plan_for("panel", "").stages
    plain = [s for s in stages if s.cutter not in ("layers", "sides")]
    assert "pocket-01" in plannable(session.recognition, plain)[1]
    assert "pocket-01" not in plannable(session.recognition, stages, freeform=True)[1]
