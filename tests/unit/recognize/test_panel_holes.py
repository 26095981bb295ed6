"""Holes of panels: where they open, how they are numbered, and that pockets, ribs and the outline stay what they are."""

from __future__ import annotations

from functools import cache
from typing import Any

import cadquery as cq
import pytest

import samples
from drilled_parts import box, counterbored, cylinder, flat_hole, through
from flat_parts import MILL
from trunnion import tolerance
from trunnion.model.feature import Feature, Recognition
from trunnion.pipeline import Engine
from trunnion.plan.holes.drive import KINDS
from trunnion.plan.prismatic.regions import SetupSpace
from trunnion.plan.setups import SetupSettings, make_setups
from trunnion.plan.size import size_table
from trunnion.progress import NO_PROGRESS
from trunnion.recognize.panel import PanelFamily
from trunnion.recognize.panel.kinds import generalized_pocket
from trunnion.settings import choose

HEIGHT, FLOOR, RIB = 20.0, 5.0, 14.0


@cache
def panel() -> cq.Workplane:
    """Return a panel of 160 x 100 x 20: two pockets x 10 to 78 and 82 to 150, y 10 to 90, floors at 5, corners R6, a rib at 14 between
    them, and in the left one an island of 24 mm up to 12 around (30, 30)."""
    plate = box((160, 100, HEIGHT)).edges("|Z").fillet(8)
    pocket = box((68, 80, HEIGHT)).edges("|Z").fillet(6)
    island = cylinder(24, 12, (30, 30, 0))
    for x in (10, 82):
        plate = plate.cut(pocket.translate((x, 10, FLOOR)))
    return plate.union(island).cut(box((4, 60, HEIGHT), (78, 20, RIB)))


def drilled(*cutters: cq.Workplane) -> Any:
    found = panel()
    for cutter in cutters:
        found = found.cut(cutter)
    return found.val().wrapped


def recognized(shape: Any, **chosen: Any) -> Recognition:
    part = samples.read(shape)
    settings = choose(PanelFamily.settings, chosen)
    return PanelFamily().recognize(part.graph(), part, settings, NO_PROGRESS)


def others(found: Recognition) -> list[tuple[Any, ...]]:
    """Return all features but holes, without the numbers of their faces."""
    return [
        (f.id, [r.role for r in f.faces], f.sizes, f.attributes) for f in found if f.kind != "hole"
    ]


def only_hole(*cutters: cq.Workplane) -> Feature:
    found, plain = recognized(drilled(*cutters)), recognized(drilled())
    assert others(found) == others(plain)
    assert len(found.unexplained) == len(plain.unexplained)
    assert [f.code for f in found.findings] == [f.code for f in plain.findings]
    (hole,) = found.of_kind("hole")
    return hole


def test_a_hole_in_a_floor_is_nested_in_its_pocket() -> None:
    hole = only_hole(through(6).translate((120, 40, HEIGHT)))
    assert hole.attributes == {"identification": "through hole", "nested_in": "pocket-02"}
    assert hole.sizes == {
        "diameter": 6.0,
        "depth": 5.0,
        "through": True,
        "x": 120.0,
        "y": 40.0,
        "top_z": 5.0,
    }


def test_the_pocket_has_its_hole_as_an_auxiliary_feature() -> None:
    found = recognized(drilled(flat_hole(6, 18).translate((120, 40, HEIGHT))))
    model = generalized_pocket(found.feature("pocket-02"), found)
    assert [f.id for f in model.auxiliary] == ["hole-01"] and model.islands == ()


@pytest.mark.parametrize(
    ("at", "carrier"), [((80, 50, RIB), "rib-01"), ((30, 30, 12), "island-01"), ((5, 50, 20), "")]
)
def test_a_hole_in_a_top_stands_on_what_has_the_top(at: tuple[float, ...], carrier: str) -> None:
    hole = only_hole(flat_hole(3, 8).translate(at))
    assert hole.attributes.get("on", "") == carrier and "nested_in" not in hole.attributes
    assert hole.sizes["top_z"] == at[2] and hole.sizes["depth"] == 8.0


def test_a_hole_from_below_says_so() -> None:
    cutter = counterbored(through(5), 9, 4).rotate((0, 0, 0), (1, 0, 0), 180)
    hole = only_hole(cutter.translate((80, 94, 0)))
    assert hole.attributes["direction"] == (0.0, 0.0, -1.0)
    assert hole.sizes["top_z"] == 0.0 and hole.sizes["counterbore_depth"] == 4.0


def test_a_hole_through_an_outer_wall_comes_from_outside_and_leaves_the_pocket_closed() -> None:
    hole = only_hole(cylinder(5, 20, (-5, 40, 12), (1, 0, 0)))
    assert hole.attributes["direction"] == (-1.0, 0.0, 0.0)
    assert [hole.sizes[n] for n in ("x", "y", "top_z", "depth")] == [0.0, 40.0, 12.0, 10.0]


def test_a_hole_through_a_rib_is_one() -> None:
    hole = only_hole(cylinder(4, 20, (70, 50, 9), (1, 0, 0)))
    assert hole.sizes["depth"] == 4.0 and hole.attributes["nested_in"].startswith("pocket")


def test_a_hole_at_the_edge_leaves_the_outline_whole() -> None:
    found = recognized(drilled(through(8).translate((80, 1.5, HEIGHT))))
    (hole,) = found.of_kind("hole")
    assert hole.attributes["open_side"] is True
    assert set(hole.tags) <= set(found.feature("profile-01").tags)
    half = recognized(drilled(through(8).translate((80, 0, HEIGHT))))
    assert half.of_kind("hole") == () and len(half.feature("profile-01").faces) == 10


def test_many_holes_leave_a_floor_a_floor() -> None:
    grid = [
        through(5).translate((87 + 8 * i, 16 + 8 * j, HEIGHT)) for i in range(8) for j in range(9)
    ]
    found = recognized(drilled(*grid))
    holes = found.of_kind("hole")
    assert found.counts() == {**recognized(drilled()).counts(), "hole": 72}
    assert len({h.attributes["nested_in"] for h in holes}) == 1
    assert {h.attributes["pattern"] for h in holes} == {"grid"}
    assert {h.attributes["pitch"] for h in holes} == {(8.0, 8.0)}


def test_holes_are_numbered_by_side_and_by_rows() -> None:
    below = flat_hole(4, 3).rotate((0, 0, 0), (1, 0, 0), 180)
    found = recognized(
        drilled(
            *(through(6).translate((x, y, HEIGHT)) for x, y in ((140, 80), (90, 80), (120, 20))),
            below.translate((20, 5, 0)),
            cylinder(5, 20, (-5, 8, 12), (1, 0, 0)).intersect(
                box((400, 400, 400), (-200, -200, 0))
            ),
        )
    )
    seen = [(h.id, h.sizes["x"], h.sizes["y"]) for h in found.of_kind("hole")]
    assert seen[:4] == [
        ("hole-01", 120.0, 20.0),
        ("hole-02", 90.0, 80.0),
        ("hole-03", 140.0, 80.0),
        ("hole-04", 20.0, 5.0),
    ]
    assert [h.attributes.get("direction") for h in found.of_kind("hole")][3:] == [
        (0.0, 0.0, -1.0),
        (-1.0, 0.0, 0.0),
    ]


def test_what_is_wider_than_the_largest_hole_is_a_pocket() -> None:
    shape = drilled(counterbored(through(6), 12, 17).translate((120, 40, HEIGHT)))
    assert recognized(shape).counts()["pocket"] == 2
    found = recognized(shape, hole_diameter=10.0)
    assert found.counts()["pocket"] == 3
    (hole,) = found.of_kind("hole")
    assert hole.sizes["top_z"] == 3.0
    recess = found.feature(str(hole.attributes["nested_in"]))
    assert recess.kind == "pocket" and recess.sizes["top_z"] == FLOOR


def test_the_smallest_hole_is_a_size_of_the_part() -> None:
    shape = drilled(*(through(d).translate((d * 10 + 50, 40, HEIGHT)) for d in (6, 4, 5)))
    table = size_table(recognized(shape), samples.read(shape).graph())
    (entry,) = [e for e in table if e.name == "smallest_hole"]
    assert entry.value == 4.0 and len(entry.faces) == 1


def test_a_recess_round_a_boss_is_a_pocket_as_before() -> None:
    ring = flat_hole(20, 3).cut(cylinder(10, 40, (0, 0, -20)))
    found = recognized(drilled(ring.translate((120, 40, FLOOR))))
    assert found.counts()["pocket"] == 3 and found.counts()["island"] == 2
    assert "hole" not in found.counts()


@pytest.mark.parametrize("x", [0.0, 78.0])
def test_the_section_of_a_pocket_does_not_run_out_through_a_hole_in_its_wall(x: float) -> None:
    engine = Engine()
    areas = []
    for cutters in ((), (cylinder(5, 10, (x, 60, 12), (1, 0, 0)),)):
        plate = box((160, 100, HEIGHT)).cut(
            box((68, 80, HEIGHT)).edges("|Z").fillet(6).translate((10, 10, FLOOR))
        )
        for cutter in cutters:
            plate = plate.cut(cutter)
        opened = engine.open(samples.written(plate.val().wrapped))
        session = engine.run(opened, "blank")
        (setup,) = make_setups(session.recognition, session.blank, choose(SetupSettings, MILL))
        space = SetupSpace.of(
            engine.context_of(session).part, session.recognition, session.blank, setup
        )
        (pocket,) = session.recognition.of_kind("pocket")
        areas.append([b.wanted.area for b in space.bands_of(pocket)])
    assert areas[0] == pytest.approx(areas[1], abs=tolerance.SEW)


def test_holes_change_no_operation_but_their_own() -> None:
    engine = Engine()
    others, own = [], []
    for cutters in (
        (),
        (through(6).translate((120, 40, HEIGHT)), flat_hole(3, 8).translate((80, 50, RIB))),
    ):
        session = engine.run(engine.open(samples.written(drilled(*cutters))), "route")
        operations = session.process.operations
        own.append([o for o in operations if o.kind in KINDS])
        others.append(
            [(o.id, o.strategy, o.cutter.name, o.data) for o in operations if o.kind not in KINDS]
        )
    assert others[0] == others[1]
    assert not own[0]
    assert {f for o in own[1] for f in o.all_features} == {"hole-01", "hole-02"}
