"""A part that its machine does not take: nothing is planned, nothing is looked at by the micron, and the reason is told at the end."""

from __future__ import annotations

import pytest

import trunnion.pipeline.proof.posted_programs as proof
from samples import box_shape, dome_on_a_plate_shape, written
from trunnion.findings import Refused
from trunnion.model.verdict import Outcome
from trunnion.pipeline import Engine
from trunnion.pipeline.context import Context


def refused(*args, **options):
    raise AssertionError("metres of faces are opened, or held against nothing")


@pytest.mark.parametrize("family", ["panel", "surface"])
def test_what_the_machine_does_not_take_is_rejected_at_once_with_the_reason(
    family, tmp_path, monkeypatch
):
    part = box_shape(1500.0, 100.0, 20.0) if family == "panel" else dome_on_a_plate_shape()
    engine = Engine()
    session = engine.open(written(part))
    # A blank of metres around a small part is as much too large as a part of metres, and quicker to test.
    words = {"setup.machine": "Mill 1200"} | ({"blank.side": 499.0} if family == "surface" else {})
    session = engine.with_choices(session, words)
    monkeypatch.setattr(proof, "prove_programs", refused)
    monkeypatch.setattr(Context, "skin", refused)
    # Nor are pictures drawn of what does not leave: the mesh of one takes minutes for a part of metres.
    monkeypatch.setattr(Engine, "_picture_mesh", refused)
    session = engine.run(session, ahead=refused)
    assert not session.process.operations
    assert session.verdict.outcome is Outcome.FAILED
    assert "verify.errors-before" in {f.code for f in session.verdict.findings}
    with pytest.raises(Refused, match=r"exceeds the machine's travel.*choose a larger machine"):
        engine.write(session, tmp_path)
