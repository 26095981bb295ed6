"""A plate that is cut from above and on two of its edges: the whole line."""

from __future__ import annotations

import cadquery as cq
import pytest

from drilled_parts import box
from trunnion.model.verdict import Outcome
from trunnion.pipeline import Engine
from trunnion.plan.setups.flip import TURNED_OVER
from trunnion.tolerance import GOUGE

COARSE = {"repair.rounds": 0, "verify.cell": 1.0, "verify.spacing": 3.0}
SIZE = (90.0, 60.0, 36.0)


def plate() -> cq.Workplane:
    """Return a plate with a pocket on top, one with corners of 6 mm in its back edge and a blind hole in its left edge."""
    top = cq.Workplane().box(40.0, 26.0, 8.0).edges("|Z").fillet(6.0).translate((58.0, 22.0, 34.0))
    back = cq.Workplane().box(44.0, 20.0, 18.0).edges("|Y").fillet(6.0)
    hole = cq.Workplane("YZ").circle(4.0).extrude(20.0).translate((0.0, 40.0, 12.0))
    return box(SIZE).cut(top).cut(back.translate((50.0, 60.0, 16.0))).cut(hole)


@pytest.fixture(scope="module")
def programmed(tmp_path_factory):
    file = tmp_path_factory.mktemp("edges") / "plate.step"
    cq.exporters.export(plate(), str(file))
    engine = Engine()
    return engine.run(engine.with_choices(engine.open(file), COARSE))


def test_each_edge_has_its_setup_and_the_features_that_open_there(programmed):
    by_setup = {
        s.name: {i for o in programmed.process.of_setup(s.name) for i in o.all_features}
        for s in programmed.setups
    }
    frame = programmed.recognition.frame
    edges = {
        f.id: frame.world_direction(f.attributes["direction"])
        for f in programmed.recognition
        if "direction" in f.attributes
    }
    outward = sorted(tuple(out.round(9).tolist()) for out in edges.values())
    assert outward == [(-1.0, 0.0, 0.0), (0.0, 1.0, 0.0)]
    assert len(by_setup) == 3
    for setup in programmed.setups[1:]:
        (own,) = by_setup[setup.name]
        assert setup.frame.z == pytest.approx(edges[own])
    told = [f.text for f in programmed.records["route"].findings if f.code == TURNED_OVER]
    assert len(told) == 2 and all("turned by 90 degrees about" in text for text in told)


def test_nothing_is_cut_on_an_edge_that_was_cut_with_the_outline(programmed):
    assert [o.id for o in programmed.process.operations if o.kind == "face"] == ["face-S1"]


def test_the_program_passes_its_proof(programmed):
    verdict = programmed.verdict
    assert verdict.outcome in (Outcome.PASSED, Outcome.REMARKS)
    assert not any(o.collisions or o.rapids_in_stock for o in verdict.operations)
    assert verdict.gouge <= GOUGE and verdict.reachable >= 0.99
