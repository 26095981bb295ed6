"""Milled threads as the proof reads their motions: whole arcs and parts of them, chords, from either end of a bore, in any direction."""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pytest import approx

from milling import SETUP, box_blank, cutting
from own_shop import own_shop
from trunnion.geometry.frame import Frame
from trunnion.model.hole_demand import BoreDemand
from trunnion.model.motion.program import ProgramSection
from trunnion.model.motion.toolpath import Motion
from trunnion.plan.holes.drive import HoleDrive
from trunnion.plan.holes.hole import HoleThread, PlannedHole
from trunnion.plan.holes.settings import ThreadMillSettings
from trunnion.post.linearize import lines_for_arcs
from trunnion.progress import NO_PROGRESS
from trunnion.settings import choose
from trunnion.toolpath.hole.thread_mill import thread_mill
from trunnion.toolpath.stock.heightfield import PlanningStock
from trunnion.verify.judge.milled_threads import milled_threads
from trunnion.verify.motion import moves_of
from trunnion.verify.settings import ProofSettings

TOOLS = {t.name: t for t in own_shop().tools}
PROOF = choose(ProofSettings, {})
BORE = PlannedHole(
    feature="hole-01", x=20.0, y=30.0, top=0.0, bottom=-20.0, diameter=25.0, through=True
)
M27 = HoleThread(diameter=27.0, pitch=2.0, depth=0.0)
DEMAND = BoreDemand(
    feature="hole-01",
    start=np.array([20.0, 30.0, 0.0]),
    out=np.array([0.0, 0.0, 1.0]),
    diameter=25.0,
    depth=20.0,
    through=True,
    words="M27x2",
    thread_diameter=27.0,
    pitch=2.0,
)


def path_of(tool, width=5.0, thread=M27):
    drive = HoleDrive(kind="thread_mill", holes=(BORE,), threads=(thread,))
    data = replace(cutting(10.0, 0.1), width=width)
    stock = PlanningStock.of(box_blank((0, 0, -40), (100, 60, 0)), SETUP)
    chosen = choose(ThreadMillSettings, {})
    return thread_mill(drive, TOOLS[tool], data, stock, SETUP, chosen, NO_PROGRESS).path


def judged(path, tool, demand=DEMAND, frame=None, removed=0.0):
    """Return the codes of the findings, and how deep the thread is full; `removed` mm3 by every move."""
    section = ProgramSection(operation="T", tool=TOOLS[tool], spindle=1000.0, path=path)
    moves = moves_of([section])
    frame = frame or Frame(origin=np.zeros(3), x=np.eye(3)[0], z=np.eye(3)[2])
    proof = SimpleNamespace(
        program=SimpleNamespace(sections=(section,), setup=SimpleNamespace(frame=frame)),
        moves=moves,
        stock=SimpleNamespace(removed=np.full(len(moves), removed)),
    )
    found, best = milled_threads([proof], [demand], PROOF)
    return [f.code for f in found], best.get("hole-01", 0.0)


BOTH = pytest.mark.parametrize("tool", ["TM-C D16x2", "TM-S D16 P1.5-3"])


@BOTH
@pytest.mark.parametrize("width", [5.0, 0.6])
def test_a_planned_thread_is_whole_through_its_bore(tool, width):
    """In one pass and in four: those before the last are no shallow threads."""
    assert judged(path_of(tool, width), tool) == ([], 20.0)


@BOTH
def test_the_depth_that_is_demanded_is_what_is_found(tool):
    codes, made = judged(path_of(tool, thread=replace(M27, depth=12.0)), tool)
    assert codes == [] and made == approx(12.0)


@BOTH
def test_arcs_that_are_opened_into_chords_prove_the_same(tool):
    path = path_of(tool)
    arcs = np.flatnonzero(path.motion >= Motion.ARC_CW)
    lines, _ = lines_for_arcs(path, arcs, 0.004)
    assert not (lines.motion >= Motion.ARC_CW).any()
    assert judged(lines, tool) == ([], 20.0)


def test_chords_that_are_too_coarse_make_no_thread():
    path = path_of("TM-S D16 P1.5-3")
    lines, _ = lines_for_arcs(path, np.flatnonzero(path.motion >= Motion.ARC_CW), 0.5)
    assert judged(lines, "TM-S D16 P1.5-3")[1] == 0.0


def split(path, share):
    """Return a path with every arc cut in two at a share of its sweep, as posts cut theirs at quadrants, in four digits."""
    rows, centres, motions = [], [], []
    starts, sweeps = path.starts(), path.sweeps()
    for k in range(len(path)):
        if path.motion[k] >= Motion.ARC_CW:
            away, turned = starts[k] - path.centre[k], share * sweeps[k]
            c, s = math.cos(turned), math.sin(turned)
            x, y = c * away[0] - s * away[1], s * away[0] + c * away[1]
            z = starts[k, 2] + share * (path.position[k, 2] - starts[k, 2])
            rows.append((k, (path.centre[k, 0] + x, path.centre[k, 1] + y, z)))
        rows.append((k, tuple(path.position[k])))
    index = [k for k, _ in rows]
    centres, motions = path.centre[index], path.motion[index]
    return replace(
        path,
        position=np.round(np.array([p for _, p in rows]), 4),
        centre=centres,
        motion=motions,
        axis=path.axis[index],
        feed=path.feed[index],
        mark=path.mark[index],
    )


@settings(deadline=None, max_examples=20)
@given(st.floats(0.1, 0.9))
def test_arcs_that_are_split_anywhere_and_rounded_prove_the_same(share):
    tool = "TM-S D16 P1.5-3"
    codes, made = judged(split(path_of(tool), share), tool)
    assert codes == [] and made == approx(20.0, abs=0.001)


@settings(deadline=None, max_examples=20)
@given(st.floats(-math.pi, math.pi), st.floats(-1.0, 1.0), st.floats(0.0, 50.0))
def test_a_thread_is_found_wherever_its_setup_stands(turn, z, away):
    """In a frame that is turned and moved against the part."""
    across = math.sqrt(1.0 - z * z)
    out = np.array([across * math.cos(turn), across * math.sin(turn), z])
    x = np.cross(out, np.eye(3)[int(np.argmin(np.abs(out)))])
    frame = Frame(origin=np.array([away, -3.0, 7.0]), x=x / np.linalg.norm(x), z=out)
    demand = replace(DEMAND, start=frame.to_world(DEMAND.start[None])[0], out=out)
    codes, made = judged(path_of("TM-C D16x2"), "TM-C D16x2", demand, frame)
    assert codes == [] and made == approx(20.0)


@BOTH
def test_a_through_thread_may_be_milled_from_its_far_end(tool):
    """The same path where the bore's beginning is at its other end: seen from there a right-hand thread is one as well."""
    demand = replace(DEMAND, start=np.array([20.0, 30.0, -20.0]), out=np.array([0.0, 0.0, -1.0]))
    assert judged(path_of(tool), tool, demand) == ([], 20.0)
    blind = replace(demand, through=False)
    assert judged(path_of(tool), tool, blind)[0] == ["verify.thread-elsewhere"]


@settings(deadline=None, max_examples=30)
@given(st.floats(0.9, 1.1))
def test_a_pitch_that_is_off_is_found(times):
    path = path_of("TM-S D16 P1.5-3")
    position = path.position.copy()
    feed = path.motion != Motion.RAPID
    low = position[feed, 2].min()
    position[feed, 2] = low + times * (position[feed, 2] - low)
    codes, _ = judged(replace(path, position=position), "TM-S D16 P1.5-3")
    # Over eleven turns of 2 mm what is off by 0.005 mm is found.
    off = abs(times - 1.0) * 22.0
    assert (codes == ["verify.thread-pitch"]) == (off > 0.005)


def test_a_turn_that_stands_still_in_height_and_then_jumps_is_found():
    """Its mean is the pitch, its groove is none."""
    path = path_of("TM-C D16x2")
    position = path.position.copy()
    halves = np.flatnonzero((path.motion == Motion.ARC_CCW) & (path.mark == 0))
    position[halves[0], 2] -= 1.0
    codes, _ = judged(replace(path, position=position), "TM-C D16x2")
    assert codes == ["verify.thread-pitch"]


def test_a_thread_mill_is_its_core_when_it_is_fed_and_as_thick_as_its_teeth_in_rapids():
    path = path_of("TM-C D16x2")
    section = ProgramSection(operation="T", tool=TOOLS["TM-C D16x2"], spindle=1000.0, path=path)
    moves = moves_of([section])
    thick = moves.bodies.widest(cutting=True)[moves.tool]
    rapid = path.motion == Motion.RAPID
    assert 0 < rapid.sum() < len(path)
    assert thick[rapid] == approx(8.0) and thick[~rapid] == approx(8.0 - 0.541266 * 2.0)


def test_stock_in_the_bore_is_found():
    codes, _ = judged(path_of("TM-C D16x2"), "TM-C D16x2", removed=10.0)
    assert codes == ["verify.thread-core"]


def test_of_two_bores_on_one_axis_each_has_its_own_thread():
    lower = replace(DEMAND, feature="hole-02", start=np.array([20.0, 30.0, -40.0]))
    section = ProgramSection(
        operation="T", tool=TOOLS["TM-C D16x2"], spindle=1000.0, path=path_of("TM-C D16x2")
    )
    moves = moves_of([section])
    proof = SimpleNamespace(
        program=SimpleNamespace(
            sections=(section,),
            setup=SimpleNamespace(frame=Frame(origin=np.zeros(3), x=np.eye(3)[0], z=np.eye(3)[2])),
        ),
        moves=moves,
        stock=SimpleNamespace(removed=np.zeros(len(moves))),
    )
    found, best = milled_threads([proof], [lower, DEMAND], PROOF)
    assert found == [] and best == {"hole-01": 20.0}
