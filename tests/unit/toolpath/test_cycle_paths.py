"""Cycles and dwells of toolpaths: checked on construction, kept when paths are joined, turned and saved, counted in times."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from pytest import approx

from own_shop import own_shop
from programs import FLAT_16, S1, WALL, path_of, section, session
from random_programs import cycle
from trunnion.geometry.frame import WORLD, Frame
from trunnion.model.motion.cycle import CycleKind
from trunnion.model.motion.drilling import drilled
from trunnion.model.motion.listing import listing
from trunnion.model.motion.program import Program
from trunnion.model.motion.toolpath import Toolpath
from trunnion.model.session import Session
from trunnion.pipeline.operation_path import turned
from trunnion.pipeline.proof.playback import timeline_of
from trunnion.store.mapping import Members, from_xml, to_xml
from trunnion.toolpath.motion.time import machining_time
from trunnion.verify.motion import moves_of

TOPS = np.array([[10.0, 5.0, 2.0], [30.0, 5.0, 2.0]])
HIGH = np.array([0.0, 0.0, 50.0])
MACHINE = own_shop().machine("Mill 1200")


def holes(kind=CycleKind.DWELL) -> Toolpath:
    return drilled(HIGH, TOPS, cycle(kind), 500.0)


@pytest.mark.parametrize(
    "spoil",
    [
        lambda p: {"position": p.position + (p.position[:, 2:] < 0) * np.array([0, 0, 0.01])},
        lambda p: {"feed": np.where(np.arange(len(p)) == 3, 501.0 * (p.feed > 0), p.feed)},
        lambda p: {"dwell": None},
        lambda p: {"cycles": (replace(p.cycles[0], last=len(p)), *p.cycles[1:])},
        lambda p: {"cycles": (replace(p.cycles[0], first=0), *p.cycles[1:])},
        lambda p: {"cycles": (replace(p.cycles[0], cycle=cycle(CycleKind.BORE)), *p.cycles[1:])},
    ],
    ids=["bottom", "feed", "dwell", "beyond", "first", "kind"],
)
def test_rows_that_are_not_those_of_their_cycle_are_refused(spoil):
    path = holes()
    changes = spoil(path)
    if "feed" in changes:
        path = holes(CycleKind.BORE)
        changes = spoil(path)
    with pytest.raises(ValueError, match="toolpath: .*cycle"):
        replace(path, **changes)


def test_a_dwell_below_zero_is_refused():
    with pytest.raises(ValueError, match="no dwell is below zero"):
        replace(WALL, dwell=np.array([0.0, -1.0, 0.0, 0.0]))


def test_joined_paths_keep_their_cycles_and_dwells():
    path = Toolpath.join([WALL, holes(), WALL])
    assert [(b.first, b.last) for b in path.cycles] == [
        (b.first + len(WALL), b.last + len(WALL)) for b in holes().cycles
    ]
    assert path.dwells().sum() == 1.0
    assert Toolpath.join([WALL, WALL]).dwell is None


def test_a_path_in_another_frame_keeps_its_cycles():
    other = Frame(np.array([5.0, 1.0, 2.0]), np.array([0.0, 0.6, 0.8]), np.array([1.0, 0.0, 0.0]))
    path = turned(holes(CycleKind.PECK), WORLD, other)
    assert path.cycles == holes(CycleKind.PECK).cycles
    assert path.axis[0] == approx(other.local_direction(np.array([0.0, 0.0, 1.0])))


def test_a_saved_session_keeps_cycles_and_says_nothing_of_them_where_there_are_none():
    kept = session()
    members = Members()
    assert to_xml(kept, Session, "session", members).find(".//cycles") is None
    drilled_one = replace(kept.paths[0], path=holes(CycleKind.PECK))
    waiting = replace(kept.paths[1], path=holes())
    changed = replace(kept, paths=(drilled_one, waiting))
    again = from_xml(to_xml(changed, Session, "session", members), Session, members)
    for before, after in zip(changed.paths, again.paths, strict=True):
        assert after.path.cycles == before.path.cycles
        assert after.path.dwells().tolist() == before.path.dwells().tolist()


def test_a_dwell_is_in_the_time_estimate_and_in_the_playback():
    without = replace(holes(), dwell=None, cycles=())
    assert machining_time(holes(), MACHINE) == approx(machining_time(without, MACHINE) + 1.0)
    times = []
    for path in (without, holes()):
        made = replace(section("holes", FLAT_16, path), dwell=float(path.dwells().sum()))
        program = Program(name="B1.S1", setup=S1, sections=(made,))
        times.append(timeline_of((program,), [moves_of((made,))], (), [MACHINE], "k").time)
    bottom = holes().dwells().tolist().index(0.5) + 1
    assert times[1][-1] == approx(times[0][-1] + 1.0)
    assert times[1][bottom] - times[0][bottom] == approx(0.5)


def test_the_listing_tells_dwells():
    program = Program(name="B1.S1", setup=S1, sections=(section("holes", FLAT_16, holes()),))
    assert listing(program).count("feed 500.0 dwell 0.5 cut") == 2


def test_a_path_without_cycles_is_what_it_was():
    assert path_of((0, 0.0, 0.0, 5.0)).cycles == ()
    assert WALL.dwell is None
