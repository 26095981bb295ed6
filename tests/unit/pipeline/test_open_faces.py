"""Faces that enclose no material go through the whole line on a machine of three axes."""

from __future__ import annotations

import math
from functools import cache

import cadquery as cq
import numpy as np
import pytest

from samples import written
from trunnion.findings import BadInput
from trunnion.model.motion.toolpath import Mark
from trunnion.model.verdict import Outcome
from trunnion.pipeline import Engine
from trunnion.pipeline.step import Step
from trunnion.pipeline.steps import STEP_TABLE


@cache
def wavy():
    return cq.Face.makeSplineApprox(
        [
            [cq.Vector(x, y, 1.5 * math.sin(x / 8.0) * math.cos(y / 9.0)) for y in range(0, 29, 4)]
            for x in range(0, 37, 4)
        ]
    )


def opened(shape, **choices):
    engine = Engine()
    return engine, engine.with_choices(engine.open(written(shape.wrapped)), {**choices})


@pytest.fixture(scope="module")
def proven():
    engine, session = opened(wavy())
    return engine, engine.run(session, "verify")


def test_one_open_patch_is_finished_and_released(proven) -> None:
    verdict = proven[1].verdict
    assert verdict.outcome in (Outcome.PASSED, Outcome.REMARKS)
    assert verdict.coverage >= 0.99 and verdict.gouge < 1e-3 and verdict.collisions == 0


def test_nothing_is_told_of_a_backing_nor_planned_on_it(proven) -> None:
    session = proven[1]
    assert {f.face for f in session.verdict.faces} == {1}
    assert set(session.verdict.deviation.face.tolist()) == {1}
    assert {t for o in session.process.operations for t in o.faces} <= {1}
    told = {w for f in session.findings() for w in f.where if w.startswith("face ")}
    assert told <= {"face 1"}


def test_a_finding_says_that_faces_are_open_and_which_side_is_machined(proven) -> None:
    (told,) = [f for f in proven[1].findings() if f.code == "open.side"]
    assert "enclose no material: they are machined from +z" in told.text


def test_the_documents_and_a_project_opened_again_keep_it(proven, tmp_path) -> None:
    engine, session = proven
    files = engine.write(session, tmp_path, name="wavy")
    (project,) = [f for f in files if f.endswith(".trunnion")]
    other = Engine()
    again = other.open(tmp_path / project)
    assert other.states(again)["verify"] == "done"


def test_side_and_thickness_make_steps_stale_on_open_faces_only(proven) -> None:
    engine, session = proven
    for words in ({"open.side": "-z"}, {"open.backing": 7.0}):
        states = engine.states(engine.with_choices(session, words))
        assert states["recognize"] == states["blank"] == states["verify"] == "stale"
    solid = cq.Workplane().box(30, 20, 10).val()
    engine, session = opened(solid)
    step: Step = STEP_TABLE[0]
    context = engine.context_of(session)
    assert step.key(session, context) == step.key(
        engine.with_choices(session, {"open.side": "-z"}), context
    )


def test_the_side_that_a_person_chooses_is_the_setup_s_z() -> None:
    engine, session = opened(wavy(), **{"open.side": "-z", "open.backing": 3.0})
    session = engine.run(session, "blank")
    assert session.recognition.frame.z.tolist() == [0.0, 0.0, -1.0]
    low, high = session.blank.box_in(session.recognition.frame)
    # The patch waves by 1.5 mm both ways at most; 2 mm are over it and 3 mm under it.
    assert high[2] - low[2] == pytest.approx(2.0 + 3.0 + 3.0, abs=0.2)


def test_a_blank_of_a_file_may_end_over_the_base_of_the_backing(tmp_path) -> None:
    box = cq.Workplane().box(50, 40, 6).translate((18, 14, 0))
    file = tmp_path / "blank.step"
    cq.exporters.export(box, str(file))
    choices = {"blank.kind": "file", "blank.file": str(file)}
    engine, session = opened(wavy(), **choices)
    session = engine.run(session, "blank")
    assert "blank.too-small" not in {f.code for f in session.findings()}


def test_the_wrong_side_is_refused_in_one_line() -> None:
    engine, session = opened(wavy(), **{"open.side": "+x"})
    with pytest.raises(BadInput, match="from the side \\+x.*choose open.side") as told:
        engine.run(session, "verify")
    assert "\n" not in str(told.value)


def test_finishing_runs_on_past_the_rim_by_choice(proven) -> None:
    engine, session = opened(wavy(), **{"surface.extension": 4.0, "surface.scallop": 0.02})
    session = engine.run(session, "verify")
    verdict = session.verdict
    assert verdict.outcome in (Outcome.PASSED, Outcome.REMARKS)
    assert verdict.coverage >= 0.99 and verdict.gouge < 1e-3 and verdict.collisions == 0
    plain, longer = (
        max(
            float(np.ptp(told.path.position[told.path.mark == Mark.CUT][:, axis]))
            for told in each.paths
            if told.operation.startswith("finish")
            for axis in (0, 1)
        )
        for each in (proven[1], session)
    )
    assert longer > plain + 4.0
