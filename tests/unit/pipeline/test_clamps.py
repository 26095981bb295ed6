"""A panel with a clamp at its border is released: what the clamp covers is left out and named, and nothing comes near it."""

from __future__ import annotations

from dataclasses import replace

import cadquery as cq
import pytest

from clamps import clamp, least_room
from trunnion import tolerance
from trunnion.model.verdict import Outcome
from trunnion.pipeline import Engine

COARSE = {"repair.rounds": 0, "verify.cell": 1.0, "verify.spacing": 3.0}
LOW = ((-133.0, -4.0, 0.0), (-103.0, 4.0, 6.0))
HIGH = ((-133.0, -3.0, 0.0), (-103.0, 3.0, 25.0))
TOWER = ((-133.0, -3.0, 0.0), (-103.0, 3.0, 60.0))


@pytest.fixture(scope="module")
def opened(tmp_path_factory):
    """An engine and a panel of 200 x 140 x 10 mm with a pocket of 160 x 100 x 6, with nothing computed."""
    body = cq.Workplane().box(200.0, 140.0, 10.0, centered=(True, True, False))
    pocket = cq.Workplane().box(160.0, 100.0, 12.0, centered=(True, True, False))
    shape = body.cut(pocket.edges("|Z").fillet(10.0).translate((0.0, 0.0, 4.0)))
    file = tmp_path_factory.mktemp("clamps") / "panel.step"
    cq.exporters.export(shape, str(file))
    engine = Engine()
    return engine, replace(engine.open(file), choices=COARSE)


def rooms(session, box):
    """Return the least room of each operation from a box."""
    (setup,) = session.setups
    return {
        o.id: least_room(session.path_of(o.id).path, o.cutter, setup.frame, *box)
        for o in session.process.operations
    }


def programmed(opened, box, until="verify"):
    engine, session = opened
    return engine.run(replace(session, fixtures=(clamp(*box),)), until=until)


def kept_off(session):
    return [f for f in session.findings() if f.code == "fixture.kept-off"]


@pytest.mark.parametrize("box", [LOW, HIGH], ids=["lower than the part", "higher"])
def test_a_panel_with_a_clamp_at_its_border_is_released(opened, box):
    session = programmed(opened, box)
    assert session.verdict.outcome in (Outcome.PASSED, Outcome.REMARKS)
    assert session.verdict.collisions == 0
    assert 0.99 <= session.verdict.coverage < 0.999
    assert min(rooms(session, box).values()) > tolerance.FIXTURE_CLEARANCE - 1e-3


def test_what_the_clamp_covers_is_named_with_place_and_clamp(opened):
    told = kept_off(programmed(opened, LOW, "toolpath"))
    assert {f.where[0] for f in told} == {"profile-01"}
    # Cutters of 20 mm stay 11 mm from the clamp, whose end is 3 mm from the wall: 2 sqrt(11^2 - 7^2) + 8 mm of it, up to 1 mm over
    # the clamp.
    assert any(
        "210 mm2 of walls of profile-01" in f.text and "fixture clamp" in f.text for f in told
    )


def test_over_a_low_clamp_the_top_is_faced_as_a_whole(opened):
    faced = programmed(opened, LOW, "toolpath").path_of("face-S1").path
    free = opened[0].run(opened[1], until="toolpath").path_of("face-S1").path
    assert faced.position.tolist() == free.position.tolist()


def test_rapids_rise_over_a_tower(opened):
    session = programmed(opened, TOWER, "toolpath")
    assert min(rooms(session, TOWER).values()) > tolerance.FIXTURE_CLEARANCE - 1e-3


def test_another_clamp_makes_the_toolpaths_stale(opened):
    engine, _ = opened
    session = programmed(opened, LOW, "toolpath")
    assert engine.states(session)["toolpath"] == "done"
    assert engine.states(replace(session, fixtures=()))["toolpath"] == "stale"
