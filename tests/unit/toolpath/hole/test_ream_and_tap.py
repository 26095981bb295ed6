"""Reamers, boring bars and taps in their cycles: how deep, at which feed, and what they refuse to cut."""

from __future__ import annotations

from dataclasses import replace

import pytest
from pytest import approx

from milling import SETUP, box_blank, cutting
from own_shop import own_shop
from trunnion.model.motion.cycle import CycleKind
from trunnion.plan.holes.drive import HoleDrive
from trunnion.plan.holes.finish_tools import set_to
from trunnion.plan.holes.hole import HoleThread, PlannedHole
from trunnion.plan.holes.settings import FineBoringSettings, ReamSettings, TapSettings
from trunnion.progress import NO_PROGRESS
from trunnion.settings import choose
from trunnion.toolpath.hole.fine_bore import fine_bore
from trunnion.toolpath.hole.ream import ream
from trunnion.toolpath.hole.tap import tap
from trunnion.toolpath.stock.heightfield import PlanningStock

TOOLS = {t.name: t for t in own_shop().tools}
M6 = HoleThread(diameter=6.0, pitch=1.0, depth=0.0)


def bore(n, diameter, through=True, bottom=-20.0):
    return PlannedHole(
        feature=f"hole-{n}",
        x=20.0 + 20.0 * n,
        y=30.0,
        top=0.0,
        bottom=bottom,
        diameter=diameter,
        through=through,
        point_angle=140.0,
    )


def stock():
    return PlanningStock.of(box_blank((0, 0, -40), (100, 60, 0)), SETUP)


def reamed(tool, *holes, **choices):
    settings = choose(ReamSettings, {f"hole.ream.{k}": v for k, v in choices.items()})
    drive = HoleDrive(kind="ream", holes=holes)
    return ream(drive, TOOLS[tool], cutting(10.0, 0.1), stock(), SETUP, settings, NO_PROGRESS)


def tapped(tool, *holes, thread=M6, spindle=500.0, **choices):
    settings = choose(TapSettings, {f"hole.tap.{k}": v for k, v in choices.items()})
    drive = HoleDrive(kind="tap", holes=holes, threads=(thread,) * len(holes))
    data = replace(cutting(6.0, 3.0), spindle=spindle, feed=spindle * thread.pitch)
    return tap(drive, TOOLS[tool], data, stock(), SETUP, settings, NO_PROGRESS)


def test_a_reamer_goes_through_with_its_lead_and_comes_out_at_the_feed():
    planned = reamed("RE-H7 D10", bore(0, 10.0), bore(1, 10.0), breakthrough=1.5)
    path, tool = planned.path, TOOLS["RE-H7 D10"]
    assert [b.cycle.kind for b in path.cycles] == [CycleKind.REAM] * 2
    assert path.position[:, 2].min() == approx(-20.0 - tool.lead - 1.5)
    assert not planned.findings


def test_the_end_of_a_blind_bore_that_the_lead_leaves_is_told():
    planned = reamed("RE-H7 D10", bore(0, 10.0, through=False))
    assert planned.path.position[:, 2].min() == approx(-20.0)
    (told,) = planned.findings
    assert told.code == "hole.finished-depth" and "19.2 of its 20 mm" in told.text


def test_a_reamer_of_another_size_cuts_nothing():
    planned = reamed("RE-H7 D9", bore(0, 10.0))
    assert not len(planned.path) and planned.findings[0].code == "hole.other-size"


def bored(diameter, *holes, **choices):
    settings = choose(FineBoringSettings, {f"hole.fine_bore.{k}": v for k, v in choices.items()})
    bar = set_to(TOOLS["FB D20-26"], diameter, "H6")
    drive = HoleDrive(kind="fine_bore", holes=holes)
    return fine_bore(drive, bar, cutting(10.0, 0.2), stock(), SETUP, settings, NO_PROGRESS)


def test_a_boring_bar_goes_in_and_out_at_the_feed_and_may_wait_between():
    path = bored(22.0, bore(0, 22.0), bore(1, 22.0), dwell=0.3).path
    assert [b.cycle.kind for b in path.cycles] == [CycleKind.BORE] * 2
    assert path.dwells().sum() == approx(0.6)
    assert path.position[:, 2].min() == approx(-20.0 - 0.2 - 0.5)


def test_a_boring_bar_that_is_set_to_another_diameter_cuts_nothing():
    planned = bored(22.1, bore(0, 22.0))
    assert not len(planned.path) and planned.findings[0].code == "hole.other-size"


def test_a_tap_is_fed_at_its_pitch_a_revolution_from_some_pitches_over_the_hole():
    path = tapped("TAP-B M6x1", bore(0, 5.0), spindle=640.0, start_pitches=4.0).path
    (block,) = path.cycles
    assert block.cycle.kind is CycleKind.TAP and block.cycle.pitch == 1.0
    feeds = path.feed[path.feed > 0.0]
    assert feeds == approx(640.0)
    # From the retract plane, four pitches over the mouth, through the bore with the lead, and a millimetre on.
    assert block.cycle.depth == approx(4.0 + 20.0 + TOOLS["TAP-B M6x1"].lead + 1.0)


def test_a_blind_thread_stays_over_the_bottom_or_ends_at_its_own_depth():
    blind = bore(0, 5.0, through=False)
    tool = TOOLS["TAP-C M6x1"]
    assert tapped("TAP-C M6x1", blind).path.position[:, 2].min() == approx(-19.0)
    short = tapped("TAP-C M6x1", blind, thread=replace(M6, depth=10.0))
    assert short.path.position[:, 2].min() == approx(-10.0 - tool.lead)
    assert not short.findings


def test_a_thread_that_ends_too_high_is_told():
    blind = bore(0, 5.0, through=False, bottom=-12.0)
    (told,) = tapped("TAP-C M6x1", blind, thread=replace(M6, depth=11.0)).findings
    assert told.code == "hole.thread-depth" and "8.5 of 11 mm" in told.text


def test_a_hole_without_a_thread_is_told():
    settings, drive = choose(TapSettings, {}), HoleDrive(kind="drill", holes=(bore(0, 5.0),))
    data = cutting(6.0, 3.0)
    found = tap(drive, TOOLS["TAP-B M6x1"], data, stock(), SETUP, settings, NO_PROGRESS)
    assert not len(found.path) and found.findings[0].code == "hole.no-thread"


@pytest.mark.parametrize("tool", ["TAP-B M8x1", "TAP-B M8x1.25", "DR-K D5"])
def test_a_tool_that_does_not_cut_the_thread_cuts_nothing(tool):
    planned = tapped(tool, bore(0, 5.0))
    assert not len(planned.path) and planned.findings[0].code == "hole.other-thread"
