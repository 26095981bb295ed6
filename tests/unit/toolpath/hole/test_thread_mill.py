"""Thread mills along their helices: pitch, hand, radius, depth, passes, and what they refuse to cut."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pytest import approx

from milling import SETUP, box_blank, cutting
from own_shop import own_shop
from trunnion.model.motion.toolpath import Motion
from trunnion.plan.holes.drive import HoleDrive
from trunnion.plan.holes.hole import HoleThread, PlannedHole
from trunnion.plan.holes.settings import ThreadMillSettings
from trunnion.plan.holes.thread_mills import full_depth, helix_of
from trunnion.progress import NO_PROGRESS
from trunnion.settings import choose
from trunnion.toolpath.hole.thread_mill import pass_radii, thread_mill
from trunnion.toolpath.stock.heightfield import PlanningStock

TOOLS = {t.name: t for t in own_shop().tools}
COMB, SINGLE = TOOLS["TM-C D16x2"], TOOLS["TM-S D16 P1.5-3"]
M27 = HoleThread(diameter=27.0, pitch=2.0, depth=0.0)
CHOSEN = choose(ThreadMillSettings, {})


def bore(n=0, diameter=25.0, through=True, bottom=-20.0):
    return PlannedHole(
        feature=f"hole-{n}",
        x=20.0 + 40.0 * n,
        y=30.0,
        top=0.0,
        bottom=bottom,
        diameter=diameter,
        through=through,
    )


def milled(tool, *holes, thread=M27, width=5.0, feed=1000.0, **choices):
    chosen = choose(ThreadMillSettings, {f"hole.thread_mill.{k}": v for k, v in choices.items()})
    drive = HoleDrive(kind="thread_mill", holes=holes, threads=(thread,) * len(holes))
    data = replace(cutting(10.0, 0.1), width=width, feed=feed)
    stock = PlanningStock.of(box_blank((0, 0, -40), (100, 60, 0)), SETUP)
    return thread_mill(drive, tool, data, stock, SETUP, chosen, NO_PROGRESS)


def turns_of(path, centre):
    """Return starts, ends, sweeps of the arcs of a path about a centre (2,)."""
    arcs = path.motion >= Motion.ARC_CW
    about = arcs & (np.hypot(*(np.nan_to_num(path.centre[:, :2]) - centre).T) < 1e-6)
    return path.starts()[about], path.position[about], path.sweeps()[about], path.feed[about]


def test_a_helix_rises_anticlockwise_by_the_pitch_a_turn_at_the_threads_radius():
    """Anticlockwise and upwards: a right-hand thread in climb milling."""
    starts, ends, sweeps, _ = turns_of(milled(SINGLE, bore()).path, (20.0, 30.0))
    assert (sweeps > 0.0).all()
    assert ends[:, 2] - starts[:, 2] == approx(2.0 * sweeps / math.tau)
    radius = np.hypot(ends[:, 0] - 20.0, ends[:, 1] - 30.0)
    # The single tooth has the flat of 1.5 mm pitch: it goes sqrt(3)/16 * 0.5 mm deeper.
    assert radius + 8.0 == approx(13.5 + math.sqrt(3) / 16 * 0.5)


def test_a_single_tooth_goes_round_without_leaving_the_wall():
    starts, ends, sweeps, _ = turns_of(milled(SINGLE, bore()).path, (20.0, 30.0))
    assert starts[1:] == approx(ends[:-1])
    # From half a pitch under the bore's end to half a pitch over its beginning: the tooth's middle is 1.5 mm above the tip.
    assert starts[0, 2] == approx(-20.0 - 1.0 - 1.5)
    assert ends[-1, 2] + 1.5 >= 1.0 and ends[-1, 2] + 1.5 < 1.0 + 2.0
    assert sweeps.sum() == approx(11 * math.tau)


def test_a_comb_turns_once_a_comb_length_in_step_with_its_groove():
    starts, _, sweeps, _ = turns_of(milled(COMB, bore()).path, (20.0, 30.0))
    # Ten teeth of 2 mm and a thread of 20 mm, with half a pitch at both ends: two turns.
    assert sweeps.sum() == approx(2 * math.tau)
    assert starts[0, 2] == approx(-20.0 - 1.0 - 1.0)
    assert starts[2, 2] - starts[0, 2] == approx(20.0)
    assert starts[2, :2] == approx(starts[0, :2])


def test_the_tool_enters_and_leaves_on_half_circles_in_step_with_the_helix():
    path = milled(COMB, bore()).path
    arcs = path.motion >= Motion.ARC_CW
    leads = arcs & (np.hypot(*(np.nan_to_num(path.centre[:, :2]) - [20.0, 30.0]).T) > 1e-6)
    first = int(np.flatnonzero(leads)[0])
    start, end = path.starts()[first], path.position[first]
    assert start[:2] == approx([20.0, 30.0]) and end[:2] == approx([25.5, 30.0])
    # Tangential: about the middle of the way, with half the helix's radius.
    assert path.centre[first, :2] == approx([22.75, 30.0])
    # The direction from the axis to the tool turns by a quarter turn in proportion to the way: so does the height, by P / 4.
    assert end[2] - start[2] == approx(0.5)
    for share in (0.25, 0.5, 0.9):
        angle = math.pi * (1.0 + share)
        at = np.array([2.75 + 2.75 * math.cos(angle), 2.75 * math.sin(angle)])
        assert math.atan2(at[1], at[0]) == approx(-0.5 * math.pi * (1.0 - share))


def test_the_tips_of_the_teeth_keep_the_feed():
    feeds = turns_of(milled(COMB, bore(), feed=900.0).path, (20.0, 30.0))[3]
    assert feeds == approx(900.0 * 5.5 / 13.5)


def test_a_deep_groove_is_cut_in_passes_of_about_the_same_section():
    helix = helix_of(bore(), M27, COMB, CHOSEN)
    depth = 0.541266 * 2.0
    assert pass_radii(helix, COMB, depth) == approx([5.5])
    one, two = pass_radii(helix, COMB, depth / math.sqrt(2))
    assert two == approx(5.5) and one == approx(5.5 - depth * (1 - math.sqrt(0.5)), abs=1e-5)
    assert len(pass_radii(helix, COMB, 0.6 * depth)) == 3
    sweeps = turns_of(milled(COMB, bore(), width=0.6 * depth).path, (20.0, 30.0))[2]
    assert sweeps.sum() == approx(3 * 2 * math.tau)


def test_a_blind_thread_keeps_its_distance_from_the_bottom_or_ends_at_its_own_depth():
    blind = bore(through=False)
    path = milled(COMB, blind, bottom_distance=0.7).path
    assert path.position[:, 2].min() == approx(-19.3)
    short = milled(COMB, blind, thread=replace(M27, depth=12.0))
    assert not short.findings
    # Full to 12 mm: the lowest tooth's middle begins half a pitch below that, 1 mm above the tip, the lead P / 4 lower.
    assert short.path.position[:, 2].min() == approx(-12.0 - 1.0 - 1.0 - 0.5)


def test_a_thread_that_ends_too_high_is_told():
    (told,) = milled(COMB, bore(through=False), thread=replace(M27, depth=18.0)).findings
    # 0.5 mm of distance, 0.5 of the lead, 1 of the tooth and 1 of half a pitch.
    assert told.code == "hole.thread-depth" and "17 of 18 mm" in told.text


@pytest.mark.parametrize("tool", ["TM-C D16x1.5", "TM-S D20 P2-5", "AL3-regular D12 R3"])
def test_a_tool_that_does_not_cut_the_thread_cuts_nothing(tool):
    """The second is as thick as its bore."""
    planned = milled(TOOLS[tool], bore(diameter=20.1 if "D20" in tool else 25.0))
    assert not len(planned.path) and planned.findings[0].code == "hole.other-thread"


def test_a_hole_without_a_thread_is_told():
    drive = HoleDrive(kind="drill", holes=(bore(),))
    stock = PlanningStock.of(box_blank((0, 0, -40), (100, 60, 0)), SETUP)
    data = cutting(10.0, 0.1)
    found = thread_mill(drive, COMB, data, stock, SETUP, CHOSEN, NO_PROGRESS)
    assert not len(found.path) and found.findings[0].code == "hole.no-thread"


def test_equal_holes_are_one_path_that_moves_between_them_over_the_part():
    path = milled(COMB, bore(0), bore(1)).path
    rapid = path.motion == Motion.RAPID
    aside = np.hypot(*(path.position[1:, :2] - path.position[:-1, :2]).T) > 1.0
    assert (path.position[1:, 2][rapid[1:] & aside] > 0.0).all()
    assert all(len(turns_of(path, c)[2]) == 4 for c in ((20.0, 30.0), (60.0, 30.0)))


@settings(deadline=None)
@given(
    st.sampled_from([t for t in TOOLS.values() if t.form == "thread-mill"]),
    st.floats(0.0, 1.0),
    st.floats(1.3, 3.0),
    st.floats(2.0, 40.0),
    st.booleans(),
)
def test_a_thread_is_whole_from_the_bores_beginning_to_where_it_says(
    tool, share, times, deep, through
):
    """At every angle the middles of the teeth reach from half a pitch below the full thread to half a pitch above it."""
    low, high = (tool.pitch, tool.pitch) if tool.pitch else (tool.pitch_low, tool.pitch_high)
    thread = HoleThread(diameter=times * tool.diameter, pitch=low + share * (high - low), depth=0.0)
    hole = bore(bottom=-deep, through=through)
    helix = helix_of(hole, thread, tool, CHOSEN)
    end = full_depth(hole, helix, tool)
    teeth = 1 if not tool.pitch else math.floor(tool.flute_length / tool.pitch + 1e-9)
    first = 0.5 * (tool.pitch or tool.flute_length)
    for angle in (0.0, 1.0, 3.0, 6.28):
        middles = sorted(
            helix.start
            + first
            + n * helix.step
            + k * thread.pitch
            + thread.pitch * angle / math.tau
            for n in range(helix.turns)
            for k in range(teeth)
        )
        assert np.diff(middles) == approx(thread.pitch)
        assert middles[0] <= -end + 0.5 * thread.pitch + 1e-9
        assert middles[-1] >= -0.5 * thread.pitch - 1e-9
    assert through == (helix.lowest < hole.bottom)
