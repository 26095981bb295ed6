"""Tabs on the outline of small panels, from the settings to the proof of the posted programs."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import cadquery as cq
import numpy as np
import pytest

from seeded.edged_panels import edged_panel
from trunnion.model.tabs import HEIGHT, POSITIONS, tabs_of, written
from trunnion.pipeline import Engine
from trunnion.pipeline.proof.posted_programs import planned_tabs, programs_of, prove_programs
from trunnion.plan.panel.tabs import with_tabs
from trunnion.plan.prismatic.regions import SetupSpace
from trunnion.plan.prismatic.tabs import TabSettings
from trunnion.plan.settings import HALVES
from trunnion.progress import NO_PROGRESS
from trunnion.settings import choose

SMALL = {
    "route.largest": 10.0,
    "blank.side": 22.0,
    "profile.tabs.width": 6.0,
    "profile.tabs.frame": 4.0,
}


@pytest.fixture(scope="module")
def plate(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a plate of 120 by 80 by 12 mm with round corners, a pocket, and a hole near the middle of one long side."""
    shape = cq.Workplane("XY").box(120.0, 80.0, 12.0).edges("|Z").fillet(10.0)
    pocket = cq.Workplane("XY").box(60.0, 40.0, 8.0).edges("|Z").fillet(6.0)
    shape = shape.cut(pocket.translate((0.0, 0.0, 6.0)))
    shape = shape.cut(cq.Workplane("XY").cylinder(40.0, 2.5).translate((0.0, -35.0, 0.0)))
    path = tmp_path_factory.mktemp("tabs") / "plate.step"
    cq.exporters.export(shape, str(path))
    return path


def run(plate: Path, until: str = "verify", **words):
    engine = Engine()
    choices = {**SMALL, **{f"profile.tabs.{k}": v for k, v in words.items()}}
    return engine, engine.run(engine.with_choices(engine.open(plate), choices), until=until)


@pytest.fixture(scope="module")
def held(plate: Path):
    """Return the engine and the session of the plate on four tabs, proven."""
    return run(plate, count=4)


def codes(findings) -> list[str]:
    return [f.code for f in findings]


def test_four_tabs_stand_and_the_program_is_released_with_a_remark(held) -> None:
    verdict = held[1].verdict
    assert verdict.releases and verdict.gouge == 0.0 and verdict.collisions == 0
    assert verdict.rapids_in_stock == 0 and verdict.coverage > 0.999
    (told,) = [f for f in verdict.findings if f.code == "verify.tabs"]
    assert told.severity == "remark" and told.text.startswith("4 tabs up to 1.5 mm thick")
    assert not {"verify.tab-cut", "verify.tab-thick", "verify.coverage"} & set(
        codes(verdict.findings)
    )


def test_every_operation_on_the_outline_knows_them_and_why_says_so(held) -> None:
    outline = [o for o in held[1].process.operations if o.kind.startswith("profile")]
    assert len(outline) == 2
    for operation in outline:
        assert len(tabs_of(operation.choices, operation.id)) == 4
        assert (
            "4 tabs 6 mm wide and 1.5 mm thick hold the part in the blank's frame; they are cut off by hand afterwards"
            in operation.rules[-1]
        )
    assert "route.tabs" in codes(held[1].findings())


def test_none_stands_beside_the_hole_at_the_edge(held) -> None:
    """The hole is at the middle of a long side, where a tab would be best for even distances."""
    (setup,) = held[1].process.setups
    for planned in planned_tabs(held[1].process):
        hole = setup.frame.to_local(held[1].recognition.frame.to_world([[0.0, -35.0, 0.0]]))
        u, v = planned.tab.local(hole)[0]
        assert abs(u) > planned.tab.half_length(planned.radius, planned.tab.bottom) or v < -6.0


def test_tabs_where_the_plan_says_others_are_missing_material(held) -> None:
    """The proof measures: moved in the plan alone, they are neither where it says nor is what stands there left by intention."""
    engine, session = held
    moved = []
    for operation in session.process.operations:
        rows = []
        for tab in tabs_of(operation.choices, operation.id):
            x, y = tab.world(np.array([[25.0, 0.0]]))[0].tolist()
            rows.append((x, y, tab.bottom, math.degrees(tab.direction), tab.reach))
        choices = {**operation.choices, POSITIONS: written(rows)} if rows else operation.choices
        moved.append(replace(operation, choices=choices))
    strange = replace(session, process=replace(session.process, operations=tuple(moved)))
    verdict = prove_programs(strange, engine.context, programs_of(session), NO_PROGRESS)
    assert codes(verdict.findings).count("verify.tab-cut") == 4
    assert "verify.tabs" not in codes(verdict.findings)
    assert verdict.coverage < held[1].verdict.coverage
    assert {"verify.coverage", "verify.unfinished"} & set(codes(verdict.findings))


def test_tabs_thicker_than_the_plan_says_are_told(held) -> None:
    engine, session = held
    thinner = tuple(
        replace(o, choices={**o.choices, HEIGHT: 0.5}) if POSITIONS in o.choices else o
        for o in session.process.operations
    )
    strange = replace(session, process=replace(session.process, operations=thinner))
    verdict = prove_programs(strange, engine.context, programs_of(session), NO_PROGRESS)
    assert codes(verdict.findings).count("verify.tab-thick") == 4
    assert verdict.coverage < held[1].verdict.coverage


def test_the_width_that_is_asked_for_is_enough(plate: Path) -> None:
    """What the error says of the blank does it, and a millimetre less does not."""
    _, session = run(plate, "route", count=4, frame=12.0)
    (told,) = [f for f in session.findings() if f.code == "route.no-tabs"]
    needed = float(told.remedy.split("make the blank wider: ")[1].split(" mm")[0])
    for side, code in ((needed, "route.tabs"), (needed - 1.0, "route.no-tabs")):
        engine = Engine()
        choices = {**SMALL, "profile.tabs.count": 4, "profile.tabs.frame": 12.0, "blank.side": side}
        session = engine.run(engine.with_choices(engine.open(plate), choices), until="route")
        assert code in codes(session.findings())


def test_a_finishing_pass_that_does_not_know_them_cuts_them_off_and_that_is_told(held) -> None:
    engine, session = held
    without = tuple(
        replace(o, choices={}, by_hand=True) if o.kind == "profile_finish" else o
        for o in session.process.operations
    )
    session = replace(session, process=replace(session.process, operations=without))
    verdict = engine.run(session, until="verify").verdict
    assert codes(verdict.findings).count("verify.tab-cut") == 4
    assert verdict.coverage > 0.999


def test_a_distance_asks_for_as_many_as_it_needs(plate: Path) -> None:
    _, session = run(plate, "route", distance=130.0)
    # The outline is 2 (100 + 60) + 20 pi = 383 mm long.
    assert len(planned_tabs(session.process)) == 3


def test_without_tabs_nothing_of_a_plan_changes(plate: Path) -> None:
    _, none = run(plate, "toolpath")
    _, other = run(plate, "toolpath", height=2.0, width=9.0)
    assert none.process.operations == other.process.operations
    assert [p.key for p in none.paths] == [p.key for p in other.paths]
    assert not [o for o in none.process.operations if POSITIONS in o.choices]


def test_slimmer_cutters_in_corners_of_the_outline_leave_them_too(tmp_path) -> None:
    """Roughing, its rest, finishing and its corners: each of them goes over the tabs with its own radius."""
    shape = cq.Workplane("XY").box(140.0, 90.0, 30.0)
    for x in (-40.0, 0.0, 40.0):
        notch = cq.Workplane("XY").box(17.0, 24.0, 90.0).edges("|Z").fillet(2.6)
        shape = shape.cut(notch.translate((x, 45.0, 0.0)))
    pocket = cq.Workplane("XY").box(40.0, 25.0, 8.0).edges("|Z").fillet(6.0)
    shape = shape.cut(pocket.translate((-20.0, -10.0, 15.0)))
    path = tmp_path / "notched.step"
    cq.exporters.export(shape, str(path))
    engine = Engine()
    choices = {"profile.tabs.count": 4, "blank.side": 40.0, "repair.rounds": 0}
    session = engine.run(engine.with_choices(engine.open(path), choices))
    outline = [o for o in session.process.operations if o.feature.startswith("profile")]
    assert {"corner", "corner_finish"} < {o.kind for o in outline}
    assert {len(tabs_of(o.choices, o.id)) for o in outline} == {4}
    assert session.verdict.releases and session.verdict.coverage > 0.999
    found = codes(session.verdict.findings)
    assert found.count("verify.tabs") == 1 and "verify.tab-cut" not in found


def test_setups_on_edges_have_the_frame_in_their_way(tmp_path) -> None:
    path = tmp_path / "edged.step"
    cq.exporters.export(cq.Workplane(obj=cq.Shape.cast(edged_panel(1).shape)), str(path))
    engine = Engine()
    words = {"profile.tabs.count": 4, "blank.side": 45.0}
    session = engine.run(engine.with_choices(engine.open(path), words), until="route")
    edges = [s.name for s in session.process.setups[1:]]
    assert edges
    assert [f.where[0] for f in session.findings() if f.code == "route.frame-at-edge"] == edges


def test_an_outline_cut_half_from_each_side_has_none(held) -> None:
    operations = [
        replace(o, choices={**o.choices, HALVES: True}) for o in held[1].process.operations
    ]
    space = SetupSpace.of(
        held[0].context.machined(held[1].choices, NO_PROGRESS).part,
        held[1].recognition,
        held[1].blank,
        held[1].process.setups[0],
    )
    changed, (found,) = with_tabs(operations, space, choose(TabSettings, held[1].choices))
    assert changed == operations
    assert found.code == "route.no-tabs" and "half from each side" in found.text


@pytest.mark.parametrize(
    ("words", "code", "said"),
    [
        ({"count": 4, "frame": 12.0}, "route.no-tabs", "make the blank wider"),
        ({"count": 30}, "route.few-tabs", "of 30 tabs"),
        ({"count": 4, "height": 12.0}, "route.no-tabs", "none of the 4 tabs"),
    ],
)
def test_tabs_without_a_place_are_told_with_a_remedy(plate: Path, words, code, said) -> None:
    _, session = run(plate, "route", **words)
    (told,) = [f for f in session.findings() if f.code == code]
    assert said in f"{told.text}: {told.remedy}"
    assert told.severity == ("error" if code == "route.no-tabs" else "warning")
