"""A curved plate with a clamp at its border is released: nothing comes near the clamp, what it covers is named."""

from __future__ import annotations

from dataclasses import replace

import cadquery as cq
import pytest

from clamps import clamp, least_room
from trunnion import tolerance
from trunnion.model.verdict import Outcome
from trunnion.pipeline import Engine

pytestmark = pytest.mark.long

COARSE = {
    "repair.rounds": 0,
    "verify.cell": 1.0,
    "verify.spacing": 3.0,
    "surface.scallop": 0.02,
    "surface.semi_scallop": 0.3,
}
LOW = ((-95.0, -3.0, 0.0), (-65.0, 3.0, 4.0))
HIGH = ((-95.0, -3.0, 0.0), (-65.0, 3.0, 30.0))


@pytest.fixture(scope="module")
def opened(tmp_path_factory):
    """An engine and a plate of 120 x 90 x 12 mm under a sphere of 300 mm, with nothing computed."""
    body = cq.Workplane().box(120.0, 90.0, 14.0, centered=(True, True, False))
    shape = body.intersect(cq.Workplane().sphere(300.0).translate((0.0, 0.0, -288.0)))
    file = tmp_path_factory.mktemp("clamps") / "dome.step"
    cq.exporters.export(shape, str(file))
    engine = Engine()
    return engine, replace(engine.open(file), choices=COARSE)


def programmed(opened, box, until):
    engine, session = opened
    return engine.run(replace(session, fixtures=(clamp(*box),)), until=until)


def room(session, box):
    (setup,) = session.setups
    return min(
        least_room(session.path_of(o.id).path, o.cutter, setup.frame, *box)
        for o in session.process.operations
    )


def test_a_dome_with_a_low_clamp_at_its_border_is_released(opened):
    session = programmed(opened, LOW, "verify")
    assert session.verdict.outcome in (Outcome.PASSED, Outcome.REMARKS)
    assert 0.99 <= session.verdict.coverage < 0.995 and session.verdict.collisions == 0
    assert room(session, LOW) > tolerance.FIXTURE_CLEARANCE - 1e-3
    assert "fixture.kept-off" in {f.code for f in session.findings()}


def test_beside_a_high_clamp_the_curved_face_is_left_out_and_named(opened):
    session = programmed(opened, HIGH, "toolpath")
    assert room(session, HIGH) > tolerance.FIXTURE_CLEARANCE - 1e-3
    told = [f for f in session.findings() if f.code == "fixture.kept-off"]
    assert any(f.where[0] == "group-01" and "ball" in f.text for f in told)
