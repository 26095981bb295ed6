"""What a path depends on of the stock: nothing beyond where it was looked at, and only what depends on a change is made again."""

from __future__ import annotations

from dataclasses import replace

import cadquery as cq
import numpy as np
import pytest

from long_mark import mostly_long
from samples import written
from subjects import DEAR, PLANNERS, own, until
from trunnion.pipeline import Engine
from trunnion.pipeline.operation_path import PathJob
from trunnion.pipeline.toolpaths import make_paths
from trunnion.plan.freeform.space import SurfaceSpace
from trunnion.plan.manual.operation_change import OperationChange
from trunnion.progress import NO_PROGRESS
from trunnion.settings import choose
from trunnion.toolpath.stock.heightfield import PlanningStock
from trunnion.toolpath.stock.stock_reads import EVERYWHERE


def eight_pockets():
    """Return a panel with eight pockets of three depths, of which no two touch."""
    made = cq.Workplane("XY").box(340.0, 180.0, 20.0, centered=False).edges("|Z").fillet(10.0)
    for n in range(8):
        depth = (8.0, 12.0, 16.0)[n % 3]
        pocket = cq.Workplane("XY").box(50.0, 45.0, depth, centered=(True, True, False))
        pocket = pocket.edges("|Z").fillet(8.0).faces("<Z").edges().fillet(3.0)
        place = (50.0 + 80.0 * (n % 4), 50.0 + 80.0 * (n // 4), 20.0 - depth)
        made = made.cut(pocket.translate(place))
    return made.val().wrapped


@pytest.fixture(scope="module")
def panel():
    """An engine and its session of a panel with many features, with toolpaths."""
    engine = Engine()
    session = engine.open(written(eight_pockets(), name="eight-pockets"))
    return engine, engine.run(session, until="toolpath")


def other_elsewhere(stock: PlanningStock, box: tuple[float, ...], rng) -> PlanningStock:
    """Return a stock with any heights wherever a path did not look at it."""
    low, high = float(stock.field.min()), float(stock.field.max()) + 20.0
    made = rng.uniform(low, high, stock.field.shape)
    centre = [stock.corner[k] + (np.arange(n) + 0.5) * stock.cell for k, n in enumerate(made.shape)]
    inside = [
        (c > box[k] - stock.cell) & (c < box[k + 2] + stock.cell) for k, c in enumerate(centre)
    ]
    return replace(stock, field=np.where(np.outer(*inside), stock.field, made))


def columns(path):
    return path.position, path.axis, path.motion, path.centre, path.feed, path.mark


@pytest.fixture
def checked(monkeypatch):
    """Every path is made a second time with another stock wherever it did not look; returns how many shares of the stock it looked at."""
    make, shares, rng = PathJob.planned, {}, np.random.default_rng(7)

    def planned(job, progress):
        made = make(job, progress)
        if made.stock_box == EVERYWHERE:
            return made
        other = replace(job, stock=other_elsewhere(job.stock, made.stock_box, rng))
        again = make(other, progress)
        assert again.stock_box == made.stock_box, job.operation.id
        for one, two in zip(columns(again.path), columns(made.path), strict=True):
            np.testing.assert_array_equal(one, two, err_msg=job.operation.id)
        assert again.findings == made.findings
        low, high = job.stock.box()
        size = np.clip(made.stock_box[2:], low, high) - np.clip(made.stock_box[:2], low, high)
        shares[job.operation.id] = float(np.prod(size) / np.prod(high - low))
        return made

    monkeypatch.setattr(PathJob, "planned", planned)
    return shares


def test_paths_of_a_panel_do_not_depend_on_stock_that_they_did_not_look_at(panel, checked):
    engine, session = panel
    make_paths(replace(session, paths=()), engine.context, NO_PROGRESS)
    assert len(checked) > 0.9 * len(session.process.operations)
    assert np.median(list(checked.values())) < 0.2


@pytest.mark.parametrize(
    # Of a panel, the eight pockets above are looked at.
    "name",
    mostly_long(PLANNERS, *(n for n in PLANNERS if n not in (*DEAR, "casing", "panel"))),
)
def test_paths_of_no_family_depend_on_stock_that_they_did_not_look_at(name, checked):
    engine, session = own(name)[0], until(name, "optimize")
    make_paths(replace(session, paths=()), engine.context, NO_PROGRESS)


def test_after_a_change_only_what_depends_on_it_is_made_again_and_nothing_is_missed(
    panel, monkeypatch
):
    engine, session = panel
    rough = next(o for o in session.process.operations if o.kind == "rough")
    change = choose(OperationChange, {"operation.tool": "AL3-regular D12 R3"})
    changed = engine.with_operation_change(session, rough.id, change)
    made, make = [], PathJob.planned
    monkeypatch.setattr(
        PathJob, "planned", lambda job, p: made.append(job.operation.id) or make(job, p)
    )
    after = make_paths(changed, engine.context, NO_PROGRESS)
    again, made = made.copy(), made
    whole = make_paths(replace(changed, paths=()), engine.context, NO_PROGRESS)
    assert rough.id in again and 3 * len(again) < len(session.process.operations), again
    for one, two in zip(after, whole, strict=True):
        assert (one.operation, one.key, one.findings) == (two.operation, two.key, two.findings)
        for a, b in zip(columns(one.path), columns(two.path), strict=True):
            np.testing.assert_array_equal(a, b, err_msg=one.operation)


def test_drives_of_paths_that_stay_are_not_made(monkeypatch):
    engine, session = own("surface")[0], until("surface", "toolpath")

    def made(*_, **__):
        raise AssertionError("nobody looks at this drive")

    monkeypatch.setattr(SurfaceSpace, "drive_of", made)
    assert any(o.strategy.startswith("surface.") for o in session.process.operations)
    again = make_paths(session, engine.context, NO_PROGRESS)
    assert [p.key for p in again] == [p.key for p in session.paths]
    assert all(a.path is b.path for a, b in zip(again, session.paths, strict=True))
