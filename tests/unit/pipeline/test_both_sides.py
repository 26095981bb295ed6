"""Panels cut from both sides: which setup makes what, webs without support, and the whole line on small plates."""

from __future__ import annotations

from dataclasses import replace

import cadquery as cq
import pytest
from pytest import approx

from drilled_parts import box, cylinder, pointed, through
from trunnion.model.verdict import Outcome
from trunnion.pipeline import Engine
from trunnion.plan.settings import HALVES
from trunnion.plan.setups.flip import TURNED_OVER
from trunnion.report.html import report_html
from trunnion.tolerance import GOUGE

COARSE = {"repair.rounds": 0, "verify.cell": 1.0, "verify.spacing": 3.0}
LENGTH, WIDTH, HEIGHT = 140.0, 90.0, 24.0
WEB = 2.0
BELOW = ((0, 0, 0), (1, 0, 0), 180)
"""The turn that brings a cutter of holes under the plate."""


def pocket(x: float, low: float, length: float, depth: float) -> cq.Workplane:
    """Return what a pocket of 60 mm width with corners of 6 mm takes out over a height."""
    tool = cq.Workplane().box(length, 60.0, depth, centered=(True, True, False))
    return tool.edges("|Z").fillet(6.0).translate((x, 0.5 * WIDTH, low))


def boss(x: float, low: float, height: float) -> cq.Workplane:
    """Return what stands as an island of 18 x 18 mm with corners of 4 mm."""
    tool = cq.Workplane().box(18.0, 18.0, height, centered=(True, True, False))
    return tool.edges("|Z").fillet(4.0).translate((x, 0.5 * WIDTH, low))


def plate() -> cq.Workplane:
    """Return a plate with pockets that share a web, an island in each of them, and holes from both sides."""
    made = box((LENGTH, WIDTH, HEIGHT))
    made = made.cut(pocket(40.0, 13.0, 56.0, 20.0)).cut(pocket(40.0, -9.0, 56.0, 20.0))
    made = made.union(boss(40.0, 13.0, 6.0)).union(boss(40.0, 4.0, 7.0))
    made = made.cut(pocket(105.0, 12.0, 44.0, 20.0))
    for y in (6.0, 84.0):
        made = made.cut(pointed(6, 10).rotate(*BELOW).translate((6.0, y, 0.0)))
    made = made.cut(through(8, HEIGHT).translate((134.0, 6.0, HEIGHT)))
    wide = cylinder(14, 5, (134.0, 84.0, 0.0)).union(cylinder(14, 5, (134.0, 84.0, HEIGHT - 5)))
    return made.cut(wide).cut(through(8, HEIGHT).translate((134.0, 84.0, HEIGHT)))


def opened(engine, shape, folder, **choices):
    file = folder / "part.step"
    cq.exporters.export(shape, str(file))
    return replace(engine.open(file), choices={**COARSE, **choices})


def run(shape, folder, until, **choices):
    engine = Engine()
    return engine.run(opened(engine, shape, folder, **choices), until=until)


@pytest.fixture(scope="module")
def proven(tmp_path_factory):
    return run(plate(), tmp_path_factory.mktemp("plate"), "verify")


def setups_of(session, kind):
    """Return the setups that cut each feature of a kind."""
    found = {f.id: set() for f in session.recognition.of_kind(kind)}
    for operation in session.process.operations:
        for id in set(operation.all_features) & set(found):
            found[id].add(operation.setup)
    return found


def test_a_plate_cut_from_both_sides_passes(proven):
    verdict = proven.verdict
    assert verdict.outcome is Outcome.PASSED
    assert verdict.coverage == approx(1.0)
    assert max(o.gouge for o in verdict.operations) <= GOUGE
    assert (
        [s.name for s in proven.setups] == ["S1", "S2"] == [s.name for s in proven.process.setups]
    )


def test_each_feature_is_cut_from_the_side_that_reaches_it(proven):
    for kind in ("pocket", "island"):
        for feature in proven.recognition.of_kind(kind):
            side = "S2" if "direction" in feature.attributes else "S1"
            assert setups_of(proven, kind)[feature.id] == {side}
    assert setups_of(proven, "profile") == {"profile-01": {"S1"}}
    holes = setups_of(proven, "hole")
    for hole in proven.recognition.of_kind("hole"):
        word = hole.attributes["identification"]
        wanted = {"blind hole": {"S2"}, "through hole": {"S1"}}.get(word, {"S1", "S2"})
        assert holes[hole.id] == wanted, word


def test_a_web_that_nothing_carries_is_told_of(proven):
    (found,) = [f for f in proven.findings() if f.code == "route.thin-web"]
    (below,) = [f for f in proven.recognition.of_kind("pocket") if "direction" in f.attributes]
    assert found.severity == "warning" and below.id in found.where
    assert f"a web of {WEB:g} mm" in found.text and "S2" in found.text
    assert "vacuum" in found.remedy and "filler" in found.remedy


def test_the_note_on_turning_says_the_axis_and_where_zero_is(proven):
    (note,) = [f for f in proven.findings() if f.code == TURNED_OVER]
    assert "by 180 degrees about X of S1" in note.text
    assert "G55 of S2" in note.text and "5 mm outside its side of smallest X" in note.text


def test_the_report_says_under_its_heading_how_a_setup_is_turned(proven, tmp_path):
    page = report_html(proven, "plate", (), tmp_path)
    heading = page.index("<h2>Setup S2</h2>")
    assert "turned by 180 degrees about X of S1" in page[heading : page.index("<table>", heading)]
    assert "is turned" not in page[:heading]


def test_a_web_is_thin_below_a_setting(tmp_path):
    session = run(plate(), tmp_path, "route", **{"route.sides.thin_web": WEB})
    assert "route.thin-web" not in {f.code for f in session.findings()}


def test_a_plate_without_anything_below_has_one_setup(tmp_path):
    made = box((LENGTH, WIDTH, HEIGHT)).cut(pocket(40.0, 12.0, 56.0, 20.0))
    session = run(made.cut(through(8).translate((130.0, 10.0, HEIGHT))), tmp_path, "route")
    assert [s.name for s in session.setups] == ["S1"]
    assert TURNED_OVER not in {f.code for f in session.findings()}


def test_no_setup_is_left_for_a_hole_from_below_that_no_tool_makes(tmp_path):
    made = box((LENGTH, WIDTH, HEIGHT)).cut(pocket(40.0, 12.0, 56.0, 20.0))
    slender = pointed(0.4, 10).rotate(*BELOW).translate((130.0, 10.0, 0.0))
    session = run(made.cut(slender), tmp_path, "route")
    assert [s.name for s in session.setups] == ["S1"]
    assert "route.no-cutter" in {f.code for f in session.findings()}


def test_what_stands_under_the_part_is_faced_from_below(tmp_path):
    made = box((60.0, 50.0, 20.0)).cut(
        cq.Workplane().box(30, 20, 20).edges("|Z").fillet(6).translate((30, 25, 20))
    )
    session = run(made, tmp_path, "verify", **{"blank.bottom": 2.0})
    assert [o.id for o in session.process.of_setup("S2")] == ["face-S2"]
    assert session.verdict.outcome is Outcome.PASSED


def test_what_is_below_is_planned_like_its_twin_above(tmp_path):
    half = box((160.0, WIDTH, HEIGHT)).cut(pocket(36.0, 8.0, 50.0, 40.0))
    half = half.cut(pocket(36.0, 4.0, 30.0, 40.0)).cut(pocket(150.0, 10.0, 90.0, 40.0))
    half = half.cut(pocket(81.0, 6.0, 26.0, 40.0)).union(boss(81.0, 6.0, 9.0))
    session = run(half.union(half.rotate(*BELOW).translate((0, WIDTH, 0))), tmp_path, "route")
    kinds = [
        sorted(
            (o.kind, o.cutter.name, round(o.data.depth, 6))
            for o in session.process.of_setup(setup)
            if o.kind not in ("face", "profile_rough", "profile_finish")
        )
        for setup in ("S1", "S2")
    ]
    assert kinds[0] == kinds[1] and len(kinds[0]) > 12


def test_halves_survive_a_project_file(tmp_path):
    made = box((60.0, 50.0, 120.0)).cut(through(8, 130.0).translate((10.0, 10.0, 125.0)))
    engine = Engine()
    session = engine.run(opened(engine, made, tmp_path), until="route")
    engine.save(session, tmp_path / "part.trunnion")
    again = engine.open(tmp_path / "part.trunnion")
    halves = [o.id for o in again.process.operations if o.choices.get(HALVES) is True]
    assert len(halves) == 6 and len(again.setups) == 2


def test_an_outline_deeper_than_every_cutter_is_cut_half_from_each_side(tmp_path):
    made = box((60.0, 50.0, 120.0)).cut(
        cq.Workplane().box(30, 20, 20).edges("|Z").fillet(6).translate((30, 25, 120))
    )
    session = run(made, tmp_path, "verify")
    assert setups_of(session, "profile") == {"profile-01": {"S1", "S2"}}
    assert session.verdict.outcome is Outcome.PASSED and session.verdict.coverage == approx(1.0)
