"""Setups hand stock on: planned, proven and told to a text from outside."""

from __future__ import annotations

import math
from dataclasses import replace

import cadquery as cq
import numpy as np
import pytest
from pytest import approx

from trunnion.findings import BadCall
from trunnion.model.verdict import Outcome
from trunnion.pipeline import Engine
from trunnion.pipeline.execution import run_step
from trunnion.pipeline.proof.external_nc import verify_texts
from trunnion.pipeline.steps import STEPS, step_named
from trunnion.pipeline.toolpaths import make_paths
from trunnion.progress import NO_PROGRESS
from trunnion.toolpath.stock.views import StockViews

COARSE = {"repair.rounds": 0, "verify.cell": 1.0, "verify.spacing": 3.0}


def pocketed(body, x, z, length, depth):
    """Return a body without a pocket of 36 mm with corners of 5 mm."""
    tool = cq.Workplane().box(length, 36.0, depth, centered=(True, True, False))
    return body.cut(tool.edges("|Z").fillet(5.0).translate((x, 0.0, z)))


def ran(engine, session, *steps):
    for step in steps:
        session = run_step(
            session, step_named(step), engine.context_of(session), NO_PROGRESS, STEPS
        )
    return session


@pytest.fixture(scope="module")
def both_sides(tmp_path_factory):
    """A block of 80 x 50 x 20 mm with a pocket 12 deep from above and one 10 deep from below."""
    body = cq.Workplane().box(80.0, 50.0, 20.0, centered=(True, True, False))
    shape = pocketed(pocketed(body, -18.0, 8.0, 36.0, 12.0), 20.0, 0.0, 30.0, 10.0)
    file = tmp_path_factory.mktemp("sides") / "both.step"
    cq.exporters.export(shape, str(file))
    engine = Engine()
    session = engine.run(replace(engine.open(file), choices=COARSE), until="recognize")
    return engine, ran(engine, session, "size", "blank", "route", "optimize", "toolpath", "verify")


def test_a_block_cut_from_both_sides_is_released(both_sides):
    verdict = both_sides[1].verdict
    assert verdict.outcome in (Outcome.PASSED, Outcome.REMARKS) and verdict.coverage == approx(1.0)
    assert {o.setup for o in verdict.operations} == {"S1", "S2"}


def test_the_second_setup_removes_its_pocket_and_nothing_twice(both_sides):
    taken = dict.fromkeys(("S1", "S2"), 0.0)
    for operation in both_sides[1].verdict.operations:
        taken[operation.setup] += operation.removed
    corners = (4.0 - math.pi) * 5.0**2
    assert taken["S2"] == approx((30.0 * 36.0 - corners) * 10.0, rel=5e-3)
    assert taken["S1"] == approx(
        90.0 * 60.0 * 22.0 - 80.0 * 50.0 * 20.0 + (36.0 * 36.0 - corners) * 12.0, rel=5e-3
    )


def test_what_was_cut_away_from_above_is_planned_as_gone_from_below(both_sides):
    engine, session = both_sides
    seen = planned_stock(engine, session)
    low, high = session.blank.box_in(session.setups[1].frame)
    margin = int(4.0 / seen.cell)
    # The outline was cut right through: of the blank's margin of 5 mm nothing stands, the pocket from above is not seen.
    assert seen.heights[:margin].max() == seen.heights[:, :margin].max() == approx(low[2])
    assert seen.heights[2 * margin, 3 * margin] == approx(high[2])


def planned_stock(engine, session):
    """Return the stock that the first operation of the second setup is planned on."""
    seen, own = [], StockViews.seen

    def noted(self, setup, *cell):
        found = own(self, setup, *cell)
        if setup.name == "S2":
            seen.append(found)
        return found

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(StockViews, "seen", noted)
        make_paths(session, engine.context_of(session), NO_PROGRESS)
    return seen[0]


def test_a_change_in_the_first_setup_is_one_in_the_second(both_sides):
    engine, session = both_sides
    first = session.process.of_setup("S1")[-1]
    without = session.process.of_setup("S1")[:-1] + session.process.of_setup("S2")
    changed = replace(session, process=replace(session.process, operations=without))
    after = make_paths(changed, engine.context_of(session), NO_PROGRESS)
    assert first.id not in {p.operation for p in after}
    assert planned_stock(engine, changed).digest != planned_stock(engine, session).digest
    anew = make_paths(replace(changed, paths=()), engine.context_of(session), NO_PROGRESS)
    for path, made in zip(after, anew, strict=True):
        assert (path.operation, path.stock_key) == (made.operation, made.stock_key)
        assert np.array_equal(path.path.position, made.path.position), path.operation
    states = engine.states(changed)
    assert states["toolpath"] == states["verify"] == "stale"


def test_operations_clamped_anew_are_planned_on_what_the_first_clamping_left(sample_panel):
    engine = Engine()
    session = engine.run(engine.open(sample_panel), until="toolpath")
    (setup,) = session.setups
    last = session.process.operations[-2:]
    moved = tuple(replace(o, setup="S2") if o in last else o for o in session.process.operations)
    setups = (setup, replace(setup, name="S2", work_offset="G55"))
    process = replace(session.process, setups=setups, operations=moved)
    again = make_paths(
        replace(session, setups=setups, process=process, paths=()),
        engine.context_of(session),
        NO_PROGRESS,
    )
    for path in again:
        before = session.path_of(path.operation).path
        assert np.array_equal(path.path.position, before.position), path.operation


def texts(session, tmp_path):
    for text in session.posted:
        if text.setup:
            (tmp_path / f"{text.setup}.nc").write_text(text.text)
    return tmp_path / "S2.nc"


def test_a_text_for_the_second_setup_is_told_what_it_starts_from(both_sides, tmp_path):
    engine, session = both_sides
    file = texts(session, tmp_path)
    after = verify_texts(engine, session, [f"S2={file}"], NO_PROGRESS)
    (told,) = [f for f in after.verdict.findings if f.code == "verify.started-from"]
    assert "S2.nc is proven on the blank without what" in told.text and "S1" in told.text
    assert after.verdict.outcome is session.verdict.outcome
    assert [t.setup for t in after.posted] == ["S1", "S2"]
    own = [[o.removed for o in s.verdict.operations] for s in (session, after)]
    assert own[0] == approx(own[1])


def test_a_text_for_a_setup_that_is_not_there_is_refused(both_sides, tmp_path):
    engine, session = both_sides
    file = texts(session, tmp_path)
    with pytest.raises(BadCall, match="there is no setup S3; the part has S1, S2"):
        verify_texts(engine, session, [f"S3={file}"], NO_PROGRESS)
    with pytest.raises(BadCall, match="setup S2 has a program already"):
        verify_texts(engine, session, [f"S2={file}", f"S2={file}"], NO_PROGRESS)
