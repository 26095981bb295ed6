"""Operations whose tools lean are made beside each other: the paths are those of one after the other, whatever was before."""

from __future__ import annotations

import os
from dataclasses import replace

import numpy as np
import pytest

from long_mark import mostly_long
from trunnion import registry
from trunnion.findings import Cancelled, Refused, info
from trunnion.model.motion.toolpath import Mark, Motion, Toolpath
from trunnion.pipeline import Engine, path_jobs
from trunnion.pipeline.toolpaths import make_paths
from trunnion.plan.contract import LazyDrive, planner_for
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.settings import settings
from trunnion.toolpath.contract import Planned, leaning_axis, strategy

UPRIGHT, LEANT = np.array([0.0, 0.0, 1.0]), np.array([0.6, 0.0, 0.8])
can_copy = pytest.mark.skipif(not hasattr(os, "fork"), reason="this system can't copy processes")


@settings("shop.test")
class NoSettings:
    """A strategy of a test takes none."""


def across(start, way, setup, axis, known):
    """Return a path from above into a start and along a way; which process made it and what it knew of the stock are findings."""
    tips = np.array([[*start[:2], setup.clearance], start, np.add(start, way)])
    return Planned(
        path=Toolpath(
            position=tips,
            axis=np.tile(axis, (3, 1)),
            motion=np.array([Motion.RAPID, Motion.LINE, Motion.LINE]),
            feed=np.array([0.0, 100.0, 100.0]),
            mark=np.array([Mark.RETRACT, Mark.ENTRY, Mark.CUT]),
            centre=np.full((3, 3), np.nan),
        ),
        findings=(info("test.process", str(os.getpid())), info("test.stock", f"{known:.6f}")),
    )


def planned(stock, setup, axis, deep):
    """Return a path that goes into the middle of the stock and across, and looks at all of it."""
    middle = stock.corner + 0.5 * stock.cell * np.array(stock.heights.shape)
    low = [*middle, stock.heights.max() - deep]
    return across(low, [10.0, 0.0, 0.0], setup, axis, stock.heights.sum())


@strategy(settings=NoSettings, tool_axis=leaning_axis)
def lean(drive, tool, data, stock, setup, settings, progress):
    """Lean, as declared."""
    return planned(stock, setup, LEANT, 1.0)


@strategy(settings=NoSettings, tool_axis=leaning_axis)
def stand(drive, tool, data, stock, setup, settings, progress):
    """Stand upright, though declared as leaning, and cut."""
    return planned(stock, setup, UPRIGHT, 2.0)


@strategy(settings=NoSettings)
def cut(drive, tool, data, stock, setup, settings, progress):
    """Stand upright, and cut deeper."""
    return planned(stock, setup, UPRIGHT, 3.0)


@strategy(settings=NoSettings, tool_axis=leaning_axis)
def refuse(drive, tool, data, stock, setup, settings, progress):
    """Refuse."""
    raise Refused("nothing but corners")


@strategy(settings=NoSettings, tool_axis=leaning_axis)
def fail(drive, tool, data, stock, setup, settings, progress):
    """Fail as no strategy should."""
    raise ZeroDivisionError("of a test")


def slot(stock, setup, share):
    """Return an upright path across the stock at a share of its width, a little lower than all that stands within 5 mm of it."""
    x, y = stock.corner + stock.cell * np.array(stock.field.shape) * (share, 0.5)
    start = np.array([x, y])
    deep = stock.height(start, start + [0.0, 10.0], 5.0) - 0.5
    return across([x, y, deep], [0.0, 10.0, 0.0], setup, UPRIGHT, deep)


@strategy(settings=NoSettings)
def left(drive, tool, data, stock, setup, settings, progress):
    """Cut a slot on the left."""
    return slot(stock, setup, 0.1)


@strategy(settings=NoSettings)
def right(drive, tool, data, stock, setup, settings, progress):
    """Cut a slot on the right."""
    return slot(stock, setup, 0.9)


OWN = {f.__name__: f for f in (lean, stand, cut, refuse, fail, left, right)}


@pytest.fixture(scope="module")
def routed(sample_part):
    """An engine and its session of the small part, with operations."""
    engine = Engine()
    return engine, engine.run(engine.open(sample_part), until="optimize")


@pytest.fixture
def made(routed, monkeypatch):
    """Returns the paths of operations by some of the strategies above, one cutter for all, with copies or without."""
    known = registry.get
    monkeypatch.setattr(registry, "get", lambda kind, name: OWN.get(name) or known(kind, name))
    engine, session = routed
    first = session.process.operations[0]

    def make(names, beside=2, progress=NO_PROGRESS, kept=(), features=()):
        monkeypatch.setattr(path_jobs, "copies", lambda: beside)
        own = tuple(replace(first, id=f"own-{n}", strategy=s) for n, s in enumerate(names))
        if features:
            own = tuple(replace(o, feature=f) for o, f in zip(own, features, strict=True))
        process = replace(session.process, operations=own)
        return make_paths(replace(session, process=process, paths=kept), engine.context, progress)

    return make


def told(path, code):
    return next(f.text for f in path.findings if f.code == code)


@can_copy
@pytest.mark.parametrize(
    "names",
    [
        ("lean", "lean", "lean", "cut", "lean", "lean"),
        ("lean", "stand", "lean", "lean"),
        ("stand", "cut", "lean"),
        ("cut", "refuse", "lean", "stand", "lean", "cut"),
    ],
)
def test_paths_made_beside_each_other_are_those_made_in_turn(made, names) -> None:
    beside, turn = made(names), made(names, beside=0)
    assert [p.key for p in beside] == [p.key for p in turn]
    for one, other in zip(beside, turn, strict=True):
        assert one.path.position == pytest.approx(other.path.position)
        assert one.path.axis == pytest.approx(other.path.axis)
        texts = ([f.text for f in p.findings if f.code != "test.process"] for p in (one, other))
        assert next(texts) == next(texts)


@can_copy
def test_leaning_tools_are_led_in_copies_all_but_the_last_of_a_setup(made) -> None:
    paths = made(["lean", "lean", "cut", "lean", "lean"])
    here = [int(told(p, "test.process")) == os.getpid() for p in paths]
    assert here == [False, False, True, False, True]
    assert len({told(p, "test.process") for p in paths}) == 4
    assert all(int(told(p, "test.process")) == os.getpid() for p in made(["lean"] * 3, beside=0))


@can_copy
def test_what_an_upright_tool_has_cut_the_next_one_knows_though_it_was_declared_to_lean(
    made,
) -> None:
    first, second, third = made(["stand", "lean", "lean"])
    before, after = (float(told(p, "test.stock")) for p in (first, second))
    assert after < before and told(third, "test.stock") == told(second, "test.stock")


@can_copy
def test_what_a_strategy_refuses_in_a_copy_is_said_and_the_others_go_on(made) -> None:
    refused, other, _ = made(["refuse", "lean", "lean"])
    assert [f.code for f in refused.findings] == ["toolpath.refused"]
    assert "nothing but corners" in refused.findings[0].text and len(other.path)


@can_copy
def test_an_error_in_a_copy_is_not_lost(made) -> None:
    with pytest.raises(ZeroDivisionError, match="of a test"):
        made(["fail", "lean", "lean"])


@can_copy
def test_a_cancel_ends_all_copies(made, monkeypatch) -> None:
    forks = []

    class Kept(path_jobs.Fork):
        def __init__(self, work):
            super().__init__(work)
            forks.append(self)

    @strategy(settings=NoSettings, tool_axis=leaning_axis)
    def endless(drive, tool, data, stock, setup, settings, progress):
        while True:
            progress.check()

    monkeypatch.setitem(OWN, "endless", endless)
    monkeypatch.setattr(path_jobs, "Fork", Kept)
    with pytest.raises(Cancelled):
        made(
            ["endless", "endless", "endless"], progress=Progress(cancelled=lambda: len(forks) == 2)
        )
    assert len(forks) == 2 and all(f.is_done() for f in forks)


def test_paths_that_are_still_true_are_kept(made) -> None:
    names = ["lean", "lean", "lean"]
    first = made(names)
    again = made(names, kept=first)
    assert all(a is b for a, b in zip(first, again, strict=True))


@pytest.fixture
def cuts_known(routed, monkeypatch):
    """Has all leave an allowance but those that `finish`, which ask what the others have cut: returns what they were told, by operation."""
    planner = type(planner_for(routed[1].recognition.family))
    drive, told_cuts = planner.drive, {}

    def allowed(self, operation, needs, scene, progress):
        driven = drive(self, operation, needs, scene, progress)
        if operation.strategy != "finish":
            return replace(driven, allowance=0.3)
        stock = scene.remaining_stock(driven.setup.frame, progress, leaning=True)
        told_cuts[operation.id] = stock.cut
        return replace(driven, identity=(driven.identity, stock.cut))

    @strategy(settings=NoSettings, tool_axis=leaning_axis)
    def finish(drive, tool, data, stock, setup, settings, progress):
        return planned(stock, setup, LEANT, 1.5)

    monkeypatch.setitem(OWN, "finish", finish)
    monkeypatch.setattr(planner, "drive", allowed, raising=True)
    return told_cuts


@can_copy
def test_a_leaning_tool_that_leaves_nothing_knows_what_those_before_it_have_cut(made, cuts_known):
    names = ["lean", "lean", "finish", "finish", "lean", "finish"]
    beside, known = made(names), dict(cuts_known)
    turn = made(names, beside=0)
    assert cuts_known == known and [p.key for p in beside] == [p.key for p in turn]
    # The third allowance is cut before the last one is asked for.
    assert known["own-2"] == known["own-3"] != known["own-5"] and all(known.values())
    assert len({told(p, "test.process") for p in beside[:2]}) == 2


@can_copy
def test_its_path_is_stale_when_what_they_cut_is_another(made, cuts_known):
    first = made(["lean", "finish"])
    assert made(["lean", "finish"], kept=first)[1] is first[1]
    again = made(["lean", "lean", "finish"])
    other = replace(again[2], operation="own-1")
    assert made(["lean", "finish"], kept=(first[0], other))[1].key == first[1].key != other.key


@pytest.fixture
def asked(routed, monkeypatch):
    """Has those that `finish` ask what leaning tools have cut for their feature: returns how much they were told of, by operation."""
    planner = type(planner_for(routed[1].recognition.family))
    drive, count = planner.drive, {}

    def asking(self, operation, needs, scene, progress):
        driven = drive(self, operation, needs, scene, progress)
        if operation.strategy != "finish":
            return driven
        cuts = tuple(c.digest for c in scene.leaning_cuts(operation.feature))
        count[operation.id] = len(cuts)
        return replace(driven, identity=(driven.identity, cuts))

    @strategy(settings=NoSettings, tool_axis=leaning_axis)
    def finish(drive, tool, data, stock, setup, settings, progress):
        return planned(stock, setup, LEANT, 1.5)

    monkeypatch.setitem(OWN, "finish", finish)
    monkeypatch.setattr(planner, "drive", asking, raising=True)
    return count


@can_copy
def test_what_leaning_tools_have_cut_for_its_feature_is_waited_for(made, asked) -> None:
    names = ["lean", "lean", "finish", "lean", "finish", "lean", "finish"]
    features = ["a", "b", "a", "b", "a", "b", "b"]
    beside = made(names, features=features)
    assert asked == {"own-2": 1, "own-4": 2, "own-6": 3}
    turn = made(names, beside=0, features=features)
    assert [p.key for p in beside] == [p.key for p in turn]
    assert len({told(p, "test.process") for p in beside[:2]}) == 2


@pytest.fixture
def all_ahead(monkeypatch):
    """Has every path be worth a copy, as long as any are kept."""
    monkeypatch.setattr(path_jobs, "LEAST_S", 0.0)


@pytest.fixture
def taken_late(monkeypatch):
    """Has no path be taken over before it must be, however soon its copy is done."""
    monkeypatch.setattr(path_jobs.PathJobs, "_is_next_done", lambda self: False)


def made_here(paths):
    return [int(told(p, "test.process")) == os.getpid() for p in paths]


@can_copy
def test_upright_paths_elsewhere_are_made_ahead_and_kept(made, all_ahead) -> None:
    names = ["left", "right", "left", "right", "left", "right"]
    paths = made(names, features=names)
    # The first of each strategy is timed here; the last of all has nothing to go on beside.
    assert made_here(paths) == [True, True, False, False, False, True]
    deep = [float(told(p, "test.stock")) for p in paths]
    assert np.diff(deep[::2]) == pytest.approx(-0.5) and np.diff(deep[1::2]) == pytest.approx(-0.5)


@can_copy
def test_a_path_on_stock_that_was_cut_since_is_made_anew(made, all_ahead, taken_late) -> None:
    names = ["left", "left", "left", "left", "left"]
    paths = made(names, features=[f"pocket-{n}" for n in range(5)])
    deep = [float(told(p, "test.stock")) for p in paths]
    assert np.diff(deep) == pytest.approx(-0.5)
    # The first one ahead was alone; the next ones began before it was cut off.
    assert made_here(paths) == [True, False, True, True, True]


@can_copy
def test_upright_tools_on_the_same_feature_wait_for_each_other(made, all_ahead) -> None:
    names = ["left", "left", "left", "left", "left"]
    assert made_here(made(names)) == [True, False, False, False, True]


@can_copy
def test_nothing_is_made_ahead_any_more_where_it_was_for_nothing(
    made, all_ahead, taken_late, monkeypatch
) -> None:
    forks, fork = [], path_jobs.Fork
    monkeypatch.setattr(path_jobs, "Fork", lambda work: forks.append(work) or fork(work))
    names = ["left"] * 20
    paths = made(names, features=[f"pocket-{n}" for n in range(20)])
    assert made_here(paths) == [True, False, *[True] * 18]
    # As many as may wait, and one for each miss that is let pass.
    assert len(forks) == path_jobs.WAITING * 2 + path_jobs.MISSES + 2


@can_copy
def test_behind_many_leaning_tools_an_upright_one_is_made_too(made, all_ahead) -> None:
    names = ["left", *["lean"] * 12, "left", "right"]
    paths = made(names, features=names)
    assert not made_here(paths)[-2] and len(paths) == 15


@can_copy
def test_a_drive_that_looks_at_the_paths_before_it_waits_for_them(
    made, all_ahead, routed, monkeypatch
) -> None:
    planner = type(planner_for(routed[1].recognition.family))
    drive, seen = planner.drive, []

    def looking(self, operation, needs, scene, progress):
        driven = drive(self, operation, needs, scene, progress)

        def make():
            seen.append(len(scene.laid))
            return driven.lazy.made()

        return replace(driven, lazy=LazyDrive(make))

    monkeypatch.setattr(planner, "drive", looking)
    names = ["left", "right", "left", "right", "left"]
    assert all(made_here(made(names, features=names)))
    assert seen == [0, 1, 2, 3, 4]


@can_copy
def test_short_work_is_done_here(made) -> None:
    names = ["left", "right", "left", "right"]
    assert all(made_here(made(names, features=names)))


@can_copy
@pytest.mark.parametrize("seed", mostly_long(range(6), 0, 4))
def test_paths_made_ahead_are_those_made_in_turn(made, all_ahead, seed: int) -> None:
    pick = np.random.default_rng(seed)
    names = pick.choice(["left", "right", "cut", "lean", "refuse", "stand"], 9).tolist()
    features = pick.choice(["one", "two", "three"], 9).tolist()
    ahead, turn = made(names, features=features), made(names, beside=0, features=features)
    assert [p.key for p in ahead] == [p.key for p in turn]
    assert [p.stock_key for p in ahead] == [p.stock_key for p in turn]
    for one, other in zip(ahead, turn, strict=True):
        assert (one.path.position == other.path.position).all()
        texts = ([f.text for f in p.findings if f.code != "test.process"] for p in (one, other))
        assert next(texts) == next(texts)
