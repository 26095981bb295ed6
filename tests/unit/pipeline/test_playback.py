"""Playback: where the tool is over time, and a stock that shrinks to the same shape whichever way one gets there."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest

from trunnion.findings import BadCall
from trunnion.geometry.frame import WORLD, Frame
from trunnion.model.blank import Box
from trunnion.model.motion.toolpath import Mark, Motion, Toolpath
from trunnion.model.operation import CuttingData, Operation, OperationPath
from trunnion.model.playback import Passage, Timeline
from trunnion.model.process import ProcessTree
from trunnion.model.session import Session
from trunnion.model.setup import Setup
from trunnion.model.tool import Holder, Tool
from trunnion.pipeline.proof.playback import Playback, fresh_of
from trunnion.progress import Progress
from trunnion.shop import load_shop

HOLDER = Holder(name="H", rows=((0, 20, 50, 25),))
FLAT = Tool(
    number=1,
    name="D10",
    form="flat",
    diameter=10.0,
    corner_radius=0.0,
    flute_length=30,
    neck_diameter=10,
    neck_length=30,
    shank_diameter=10,
    stickout=50,
    gauge_length=100,
    teeth=2,
    centre_cutting=True,
    helix_angle=30,
    holder=HOLDER,
)
DATA = CuttingData(
    speed=300,
    spindle=8000,
    feed_per_tooth=0.1,
    feed=1200,
    plunge_feed=400,
    depth=2,
    width=8,
    removal_rate=20,
    power=1,
    power_limit=10,
    torque=1,
    rules=(),
)
UP = np.array([0.0, 0.0, 1.0])


def path(*rows) -> Toolpath:
    """Return a toolpath of rows (motion, x, y, z[, centre x, centre y])."""
    n = len(rows)
    centre = np.full((n, 3), np.nan)
    for k, row in enumerate(rows):
        if len(row) > 4:
            centre[k] = (*row[4:6], row[3])
    motion = np.array([r[0] for r in rows])
    return Toolpath(
        position=np.array([r[1:4] for r in rows], dtype=float),
        axis=np.tile(UP, (n, 1)),
        motion=motion,
        centre=centre,
        feed=np.where(motion == Motion.RAPID, 0.0, 1200.0),
        mark=np.full(n, int(Mark.CUT)),
    )


SLOT = path(
    (Motion.RAPID, -10, 10, 20),
    (Motion.RAPID, -10, 10, -2),
    (Motion.LINE, 50, 10, -2),
    (Motion.LINE, 50, 10, 20),
)
BOW = path(
    (Motion.RAPID, 20, 40, 20),
    (Motion.LINE, 20, 40, -3),
    (Motion.ARC_CCW, 40, 40, -3, 30, 40),
    (Motion.LINE, 40, 40, 20),
)


@pytest.fixture
def session():
    """A block of 60 x 50 x 10 mm with a slot and a half circle cut into its top, two operations of one tool."""
    setup = Setup(
        name="S1",
        frame=Frame(np.array([0.0, 0.0, 10.0]), np.array([1.0, 0, 0]), UP),
        work_offset="G54",
        clearance=20.0,
        machine=next(iter(load_shop().machines)),
    )
    operations = tuple(
        Operation(
            id=id, kind="rough", strategy="made.up", feature="f", setup="S1", tool=FLAT, data=DATA
        )
        for id in "ab"
    )
    blank = Box(
        frame=WORLD,
        low=np.zeros(3),
        high=np.array([60.0, 50.0, 10.0]),
        material="al-7075",
        density=2.81,
    )
    return Session(
        part=SimpleNamespace(name="block"),
        blank=blank,
        setups=(setup,),
        process=ProcessTree(plan="p", material="al-7075", setups=(setup,), operations=operations),
        paths=(
            OperationPath(operation="a", path=SLOT, key="1"),
            OperationPath(operation="b", path=BOW, key="2"),
        ),
    )


@pytest.fixture
def playback(session):
    return Playback(session, SimpleNamespace(shop=load_shop()), cell=0.5)


def volume(moment) -> float:
    """Return the volume inside a surface."""
    a, b, c = np.moveaxis(moment.points.astype(float)[moment.triangles], 1, 0)
    return float((np.cross(a, b) * c).sum() / 6)


def test_all_blocks_of_all_operations_are_there_in_order(playback):
    assert playback.n_blocks == 8
    assert [p.operation for p in playback.timeline.passages] == ["a", "b"]
    assert list(playback.timeline.first) == [0, 4, 8]


def test_before_the_first_block_the_stock_is_the_blank(playback):
    moment = playback.at(0)
    assert volume(moment) == pytest.approx(60 * 50 * 10, rel=1e-6)
    assert not moment.fresh.any()
    assert moment.removed == 0.0


def test_the_stock_shrinks_by_what_is_removed(playback):
    volumes = [volume(playback.at(k)) for k in range(9)]
    assert all(a >= b for a, b in pairwise(volumes))
    end = playback.at(8)
    # The slot is 55 long with a half circle at its end, the bow half a ring of mean radius 10 with two half circles.
    slot, bow = 2 * (50 * 10 + np.pi * 25 / 2), 3 * (np.pi * 10 * 10 + np.pi * 25)
    assert end.removed == pytest.approx(slot + bow, rel=0.02)
    # Walls of the drawn surface lean over one cell.
    assert volume(end) == pytest.approx(60 * 50 * 10 - end.removed, rel=0.01)


def test_going_back_shows_the_same_stock_as_going_there_directly(playback):
    there = playback.at(3)
    playback.at(8)
    back = playback.at(3)
    assert np.array_equal(there.points, back.points) and np.array_equal(
        there.triangles, back.triangles
    )
    assert there.removed == back.removed


def test_a_part_of_a_block_is_cut_as_far_as_the_tool_is(playback, session):
    moment = playback.at(2.5)
    assert moment.tip == pytest.approx([20.0, 10.0, 8.0])
    # Half of the 60 mm: 20 mm inside the blank, and the half circle before it.
    assert moment.removed == pytest.approx(2 * (20 * 10 + np.pi * 25 / 2), rel=0.02)
    stopped, whole = (
        playback.at(3),
        Playback(session, SimpleNamespace(shop=load_shop()), cell=0.5).at(3),
    )
    assert np.array_equal(stopped.points, whole.points)
    assert stopped.removed == pytest.approx(whole.removed)


def test_a_moment_knows_operation_and_time(playback):
    early, late = playback.at(3), playback.at(7)
    assert (early.operation, late.operation) == ("a", "b")
    assert 0.0 < early.time < late.time <= playback.timeline.seconds


def test_what_was_cut_is_told_from_the_blanks_own_surface(playback):
    moment = playback.at(8)
    heights = moment.points[moment.triangles][:, :, 2]
    floor = np.isclose(heights, 8.0).all(axis=1) | np.isclose(heights, 7.0).all(axis=1)
    top = np.isclose(heights, 10.0).all(axis=1)
    assert floor.any() and moment.fresh[floor].all()
    assert top.any() and not moment.fresh[top].any()


def test_a_look_at_the_clock_ends_a_long_way_early_and_goes_on_later(playback):
    moment = playback.towards(8.0, 0.0)
    while moment.position < 8.0:
        before, moment = moment.position, playback.towards(8.0, 0.0)
        assert moment.position > before
    assert moment.removed == pytest.approx(playback.at(8).removed)


def test_a_cancelled_playback_goes_on_from_where_it_was(playback):
    from trunnion.findings import Cancelled

    with pytest.raises(Cancelled):
        playback.at(8, Progress(cancelled=lambda: True))
    assert playback.at(8).position == 8.0


def test_nothing_to_play_is_said(session):
    with pytest.raises(BadCall, match="no toolpaths"):
        Playback(Session(), SimpleNamespace(shop=load_shop()))


def test_a_triangle_in_a_side_of_the_blank_is_not_fresh(session):
    points = np.array([[0.0, 0, 0], [0, 50, 0], [0, 50, 10], [1, 50, 10]])
    assert list(fresh_of(points, np.array([[0, 1, 2], [0, 2, 3]]), session.blank, 1e-6)) == [
        False,
        True,
    ]


# the timeline


@pytest.fixture
def line():
    """A rapid to x 0, a line to x 10 in 2 s, half a circle to y 10 in 3 s; then another tool's rapid and a line that turns its axis."""
    nowhere = np.full(3, np.nan)
    lean = np.array([0.0, 1.0, 0.0])
    return Timeline(
        key="k",
        passages=tuple(Passage(operation=id, setup="S1", tool=FLAT, file="S1.nc") for id in "ab"),
        first=np.array([0, 3, 5]),
        tip=np.array([[0.0, 0, 0], [10, 0, 0], [10, 10, 2], [50, 0, 0], [50, 4, 0]]),
        axis=np.array([UP, UP, UP, UP, lean]),
        centre=np.array([nowhere, nowhere, [10, 5, 0], nowhere, nowhere]),
        sweep=np.array([0, 0, np.pi, 0, 0]),
        rapid=np.array([True, False, False, True, False]),
        mark=np.zeros(5, int),
        line=np.array([4, 5, 7, 20, 21]),
        time=np.array([0.0, 0.0, 2.0, 5.0, 9.0, 10.0]),
    )


def test_the_tool_runs_straight_along_a_line(line):
    assert line.pose(1.25)[0] == pytest.approx([2.5, 0.0, 0.0])


def test_the_tool_runs_round_an_arc_and_climbs(line):
    assert line.pose(2.5)[0] == pytest.approx([15.0, 5.0, 1.0])
    assert line.pose(3.0)[0] == pytest.approx([10.0, 10.0, 2.0])


def test_the_axis_turns_at_an_even_rate(line):
    tip, axis = line.pose(4.5)
    assert tip == pytest.approx([50.0, 2.0, 0.0])
    assert axis == pytest.approx([0.0, np.sqrt(0.5), np.sqrt(0.5)])


def test_a_new_tool_does_not_come_from_where_the_last_one_ended(line):
    assert line.pose(3.5)[0] == pytest.approx([50.0, 0.0, 0.0])


def test_position_and_time_belong_together(line):
    assert line.position_at(1.0) == pytest.approx(1.5)
    assert line.seconds_at(1.5) == pytest.approx(1.0)
    assert line.position_at(0.0) == 1.0  # the first block takes no time
    assert line.position_at(99.0) == 5.0
    assert line.seconds == 10.0


def test_a_position_belongs_to_the_block_on_its_way(line):
    assert [line.block(p) for p in (0.0, 0.5, 1.0, 1.5, 5.0)] == [0, 0, 0, 1, 4]
    assert [line.passage(p).operation for p in (0.0, 3.0, 3.1, 5.0)] == ["a", "a", "b", "b"]


def test_a_line_of_the_text_leads_to_the_block_in_it_or_the_next_one(line):
    assert line.position_of("S1.nc", 5) == 2.0
    assert line.position_of("S1.nc", 6) == 3.0
    assert line.position_of("S1.nc", 8) == 4.0
    assert line.position_of("S1.nc", 99) is None
    assert line.position_of("S2.nc", 5) is None


def test_the_way_is_opened_into_chords_on_the_arc(line):
    points, reached = line.run(0)
    arc = reached > 2.0
    assert np.linalg.norm(points[arc, :2] - [10, 5], axis=1) == pytest.approx(5.0)
    assert arc.sum() == 30
    assert points[-1] == pytest.approx([10, 10, 2])
    assert (np.diff(reached) > 0).all()


# leaning axes and the engine's door


@pytest.fixture
def leaning(session):
    """The same block with one straight cut by a tool that leans 30 degrees, and turns upright on the way."""
    lean = np.array([0.5, 0.0, np.sqrt(0.75)])
    made = Toolpath(
        position=np.array([[5.0, 25, 20], [5, 25, -3], [45, 25, -3], [45, 25, 20]]),
        axis=np.array([lean, lean, UP, UP]),
        motion=np.array([Motion.RAPID, Motion.LINE, Motion.LINE, Motion.LINE]),
        centre=np.full((4, 3), np.nan),
        feed=np.array([0.0, 400, 1200, 1200]),
        mark=np.zeros(4, int),
    )
    return replace(session, paths=(OperationPath(operation="a", path=made, key="3"),))


def test_a_turning_tool_cuts_on_its_way(leaning):
    playback = Playback(leaning, SimpleNamespace(shop=load_shop()), cell=1.0)
    assert playback.at(2.5).axis == pytest.approx(
        [np.sin(np.radians(15)), 0.0, np.cos(np.radians(15))]
    )
    removed = [playback.at(p).removed for p in (0.0, 1.0, 2.0, 2.25, 2.5, 2.75, 3.0, 4.0)]
    assert removed == sorted(removed) and len(set(removed)) >= 6
    end = playback.at(4.0)
    assert volume(end) == pytest.approx(60 * 50 * 10 - end.removed, rel=0.02)


def test_a_leaning_stock_is_the_same_there_and_back(leaning):
    playback = Playback(leaning, SimpleNamespace(shop=load_shop()), cell=1.0)
    there = playback.at(2.0)
    playback.at(4.0)
    back = playback.at(2.0)
    assert np.array_equal(there.points, back.points) and there.removed == back.removed


def test_the_engine_refuses_a_plan_that_is_not_played(session, monkeypatch):
    from trunnion.pipeline import Engine

    monkeypatch.setattr(Engine, "context", SimpleNamespace(shop=load_shop()))
    engine = Engine()
    with pytest.raises(BadCall, match="not played any more"):
        engine.moment("nothing", 0.0)
    line = engine.playback(session)
    assert engine.moment(line.key, 3.0).position == 3.0
    changed = engine.playback(replace(session, paths=session.paths[:1]))
    assert changed.key != line.key
    with pytest.raises(BadCall, match="start the playback again"):
        engine.moment(line.key, 3.0)
