"""Countersinks: as deep as their width asks for, and only with a cutter of their angle."""

from __future__ import annotations

import pytest
from pytest import approx

from milling import SETUP, box_blank, cutting
from own_shop import own_shop
from trunnion.model.motion.cycle import CycleKind
from trunnion.plan.holes.drive import HoleDrive
from trunnion.plan.holes.hole import Countersink, PlannedHole
from trunnion.progress import NO_PROGRESS
from trunnion.toolpath.hole.countersink import CountersinkSettings, countersink
from trunnion.toolpath.stock.heightfield import PlanningStock

TOOLS = {t.name: t for t in own_shop().tools}


def sunk(tool, *sinks, dwell=0.2, bore=6.0):
    holes = tuple(
        PlannedHole(
            feature=f"hole-{n}",
            x=20.0 + 20.0 * n,
            y=30.0,
            top=0.0,
            bottom=-20.0,
            diameter=bore,
            through=True,
        )
        for n in range(len(sinks))
    )
    drive = HoleDrive(
        kind="countersink",
        holes=holes,
        sinks=tuple(Countersink(diameter=d, angle=a) for d, a in sinks),
    )
    stock = PlanningStock.of(box_blank((0, 0, -40), (100, 60, 0)), SETUP)
    settings = CountersinkSettings(dwell=dwell)
    data = cutting(6.0, 12.0)
    return countersink(drive, TOOLS[tool], data, stock, SETUP, settings, NO_PROGRESS)


@pytest.mark.parametrize(("wide", "deep"), [(12.0, 4.6), (10.0, 3.6)])
def test_the_cone_is_as_wide_at_the_mouth_as_is_wanted(wide, deep):
    """A cutter of 90 degrees with a tip of D 2.8 is as deep as its radius at the mouth is wider than that."""
    path = sunk("CS90 D12.4", (wide, 90.0)).path
    assert path.position[:, 2].min() == approx(-deep)


def test_holes_of_one_angle_are_cut_each_to_its_own_depth_with_a_dwell():
    path = sunk("CS90 D12.4", (12.0, 90.0), (10.0, 90.0)).path
    assert [b.cycle.kind for b in path.cycles] == [CycleKind.DWELL] * 2
    assert path.dwells().sum() == approx(0.4)
    assert sunk("CS90 D12.4", (12.0, 90.0), dwell=0.0).path.cycles[0].cycle.kind is CycleKind.DRILL


@pytest.mark.parametrize(
    ("tool", "sink"),
    [
        ("CS100 D12.4", (12.0, 90.0)),
        ("CS90 D8.3", (12.0, 90.0)),
        ("DR-K D6", (12.0, 90.0)),
        ("CS90 D25", (12.0, 90.0)),
    ],
    ids=["another angle", "too narrow", "no cone", "a tip wider than the hole"],
)
def test_a_cutter_that_does_not_make_the_cone_leaves_it_and_says_so(tool, sink):
    planned = sunk(tool, sink, bore=3.0 if tool == "CS90 D25" else 6.0)
    assert not len(planned.path)
    assert [f.code for f in planned.findings] == ["hole.other-cone"]
