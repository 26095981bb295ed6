"""Every step looks at its progress often enough, whatever the machine: counted in calls between two looks, not in seconds.

Calls of the interpreter in the step's own thread count: what goes on aside is waited for with looks.
"""

from __future__ import annotations

import itertools
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial

import numpy as np
import pytest

from milling import SETUP, box_blank, cutting, mill
from samples import block_with_pocket_shape, dome_on_a_plate_shape, read, written
from trunnion.findings import Cancelled
from trunnion.geometry.frame import WORLD
from trunnion.part.shape.facets import facet_samples, facets_of, grouped
from trunnion.pipeline import STEPS, Engine
from trunnion.progress import Progress
from trunnion.toolpath.motion.builder import PathBuilder
from trunnion.toolpath.stock import heightfield as planning
from trunnion.toolpath.stock.heightfield import PlanningStock

MOST_CALLS = 100_000
"""Calls between two looks on a part of a few dozen faces: a tenth of a second or less (measured: 250 000 take 0.15 s)."""


class Counter:
    """Counts the calls that the interpreter makes in this thread between two looks, and keeps the most of each piece of work."""

    def __init__(self) -> None:
        self.fractions: list[float] = []
        self.most, self._calls = 0, 0

    def look(self) -> bool:
        self.most, self._calls = max(self.most, self._calls), 0
        return False

    @contextmanager
    def counting(self) -> Iterator[Progress]:
        self.most, self._calls, self.fractions = 0, 0, []
        before = sys.getprofile()
        sys.setprofile(self._count)
        try:
            yield Progress(lambda fraction, _: self.fractions.append(fraction), self.look)
        finally:
            sys.setprofile(before)
            self.look()

    def _count(self, frame: object, event: str, argument: object) -> None:
        self._calls += event in ("call", "c_call")


def work_on(file, folder, steps) -> dict[str, tuple[int, list[float]]]:
    """Return the most calls between two looks, and the fractions told, by piece of work on a part."""
    engine, again, counter, found = Engine(), Engine(), Counter(), {}

    def done(name, work, *given):
        with counter.counting() as progress:
            made = work(*given, progress=progress)
        found[name] = (counter.most, counter.fractions)
        return made

    session = done("open", engine.open, file)
    for step in steps:
        session = done(step, engine.run, session, step)
    done("mesh", engine.mesh, session)
    done("save", engine.save, session, folder / "part.trunnion")
    done("reopen", again.open, folder / "part.trunnion")
    if "verify" in steps:
        done("moment", engine.moment, done("playback", engine.playback, session, 1.0).key, 1e9, 1e9)
        done("deviation", engine.deviation_map, session)
    return found


@pytest.fixture(
    scope="module",
    params=[(block_with_pocket_shape, STEPS), (dome_on_a_plate_shape, STEPS[:4])],
    ids=["panel", "surface"],
)
def worked(request, tmp_path_factory):
    """What is counted on a small part of a family; the first time, when all is imported and compiled, doesn't count."""
    shape, steps = request.param
    file, folder = written(shape()), tmp_path_factory.mktemp("looks")
    engine = Engine()
    engine.run(engine.open(file), steps[-1])
    return work_on(file, folder, steps)


def test_no_piece_of_work_goes_long_without_a_look(worked):
    assert {name: most for name, (most, _) in worked.items() if not 0 < most <= MOST_CALLS} == {}
    assert [name for name, (_, fractions) in worked.items() if fractions != sorted(fractions)] == []


def test_cancel_half_way_ends_every_step():
    engine, session, file = Engine(), None, written(block_with_pocket_shape())
    for step in ("open", *STEPS):
        work = partial(engine.open, file) if step == "open" else partial(engine.run, session, step)
        after, looks = work(), itertools.count()
        # The part remembers what was asked of it: the second time is like all that follow.
        work(progress=Progress(cancelled=partial(_has_come, looks, 10**9)))
        half = next(looks) // 2
        with pytest.raises(Cancelled):
            work(progress=Progress(cancelled=partial(_has_come, itertools.count(), half)))
        session = after
    assert session.verdict is not None


def _has_come(looks, last) -> bool:
    return next(looks) >= last


def test_a_stock_lowered_slice_by_slice_is_the_same_to_the_last_bit(monkeypatch):
    builder = PathBuilder(
        mill(10),
        cutting(4, 4),
        PlanningStock.of(box_blank((0, 0, -20), (60, 40, 2)), SETUP),
        SETUP,
        2.0,
    )
    builder.rapid((-10, 5, 50))
    for k in range(30):
        builder.line((-10 + 2.7 * k, 5 + k, -0.2 * k), 500.0)
        builder.arc((-8 + 2.7 * k, 7 + k, -0.2 * k), (-8 + 2.7 * k, 5 + k), 1.5 * np.pi, 500.0)
    path, found = builder.finished(), []
    for moves in (10**9, 7, 1):
        monkeypatch.setattr(planning, "MOVES", moves)
        stock = PlanningStock.of(box_blank((0, 0, -20), (60, 40, 2)), SETUP).working()
        found.append((stock.lower(path, mill(10)).tobytes(), stock.heights.tobytes()))
    assert found[0] == found[1] == found[2]


def test_samples_of_many_faces_are_those_of_each_face_one_after_the_other():
    facets = facets_of(read(dome_on_a_plate_shape()), WORLD)
    rows = np.arange(len(facets.tag))
    together = facet_samples(facets, rows[::-1], 0.7)
    apart = [facet_samples(facets, np.array([row]), 0.7) for row in rows]
    for whole, each in zip(together, zip(*apart, strict=True), strict=True):
        assert whole.tobytes() == np.concatenate(each).tobytes()
    assert set(together[0]) == set(rows) and together[3].sum() > 0.0
    assert all(len(empty) == 0 for empty in facet_samples(facets, np.zeros(0, np.int64), 0.7))


@pytest.mark.parametrize("count", [0, 1, 2000])
def test_rows_are_grouped_as_numpy_does_it(count):
    rows = np.random.default_rng(3).integers(-6, 7, (count, 3))
    assert np.array_equal(grouped(rows), np.unique(rows, axis=0, return_inverse=True)[1].ravel())
