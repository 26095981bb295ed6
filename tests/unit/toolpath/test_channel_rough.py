"""Roughing of channels: levels over the hub, what is left behind a cutter before, and passes that are reached from outside."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

import wheels
from leaning_tools import cutter
from trunnion.plan.channel.cut_space import CutSpace
from trunnion.plan.channel.meridian import cylindrical
from trunnion.toolpath.channel.rough import GONE, OVERLAP, from_outside, still_to_cut
from trunnion.toolpath.contact_passes.channel_lines import level_of
from trunnion.toolpath.contact_passes.contacts import Contacts
from trunnion.toolpath.contact_passes.passes import Pass
from wheels import links_round

SMALL = cutter("ball", 2.0, 1.0)
OFF = 0.3


def test_no_ball_on_the_lowest_level_is_nearer_to_the_hub_than_said_where_rulings_lean():
    channel = wheels.channel()
    lean = 0.4

    class Leaning:
        meridian, at, hub = channel.meridian, channel.at, channel.hub

        @staticmethod
        def rulings(u, v):
            # Rulings that lean out of the hub's normal round the axis.
            normal = channel.hub(u, v)[1]
            around = np.cross([0.0, 0.0, 1.0], channel.hub(u, v)[0])
            around /= np.linalg.norm(around, axis=1, keepdims=True)
            return np.cos(lean) * normal + np.sin(lean) * around

    u, v = np.linspace(0.05, 0.95, 40), np.full(40, 0.5)
    radius = 1.5
    point, ruling = level_of(Leaning, lambda at: np.full_like(at, OFF), radius, OFF)(u, v)
    rz, _ = cylindrical(point + radius * ruling)
    # The hub is a quarter circle about (40, 32) in the meridian.
    away = wheels.HUB_RADIUS - np.hypot(rz[:, 0] - 40.0, rz[:, 1] - 32.0) - radius
    assert away.min() >= OFF - 0.02 and away.max() < OFF + 0.1


def line(y: float) -> Contacts:
    x = np.arange(0.0, 60.0, 0.5)
    point = np.column_stack([x, np.full_like(x, y), np.zeros_like(x)])
    return Contacts(point=point, normal=np.tile([0.0, 0.0, 1.0], (len(x), 1)))


def drive(*cut, inward=lambda points: np.ones(len(points))):
    return SimpleNamespace(cut=cut, inward=inward)


def ball_along(x, radius=3.0) -> CutSpace:
    centre = np.column_stack([x, np.zeros_like(x), np.full_like(x, radius)])
    return CutSpace(
        centre=centre,
        axis=np.tile([0.0, 0.0, 1.0], (len(x), 1)),
        radius=radius,
        flank=0.0,
        above=9.0,
    )


def test_a_small_ball_goes_only_where_the_large_one_before_was_not():
    wide = ball_along(np.arange(0.0, 40.0, 0.3))
    (left,) = still_to_cut([line(0.0)], SMALL, drive(wide))
    x = left.point[:, 0]
    assert x[-1] == 59.5 and x[0] == pytest.approx(40.0 - OVERLAP, abs=2.0)
    # Beside the large ball's path it meets what that one left.
    assert len(still_to_cut([line(4.0)], SMALL, drive(wide))[0]) == 120
    assert len(still_to_cut([line(0.0)], SMALL, drive())[0]) == 120


def test_outside_of_the_blank_nothing_is_left():
    inward = lambda points: 20.0 - points[:, 0]  # noqa: E731
    far = ball_along(np.arange(0.0, 1.0, 0.3))
    (left,) = still_to_cut([line(0.0)], SMALL, drive(far, inward=inward))
    assert left.point[-1, 0] <= 20.0 + SMALL.radius + OVERLAP + 0.5


def test_two_stretches_near_each_other_are_one_pass():
    near = ball_along(np.concatenate([np.arange(0.0, 5.0, 0.3), np.arange(20.0, 30.0, 0.3)]))
    assert len(still_to_cut([line(0.0)], SMALL, drive(near))) == 1
    far = ball_along(np.arange(10.0, 45.0, 0.3))
    assert len(still_to_cut([line(0.0)], SMALL, drive(far))) == 2


def test_what_the_large_ball_left_thinner_than_is_looked_for_is_not_gone_over():
    wide = ball_along(np.arange(-5.0, 65.0, 0.3))
    low = Contacts(point=line(0.0).point - [0.0, 0.0, 0.8 * GONE], normal=line(0.0).normal)
    lower = Contacts(point=line(0.0).point - [0.0, 0.0, 1.5 * GONE], normal=line(0.0).normal)
    assert not still_to_cut([low], SMALL, drive(wide))
    assert len(still_to_cut([lower], SMALL, drive(wide))) == 1


def straight(y: float, start: float, end: float) -> Pass:
    tip = np.column_stack([np.linspace(start, end, 9), np.full(9, y), np.zeros(9)])
    axis = np.tile([0.0, 0.0, 1.0], (9, 1))
    return Pass(tip=tip, axis=axis, normal=axis)


def test_passes_begin_outside_or_beside_the_end_of_the_one_before():
    def inward(points):
        return points[:, 0] - 0.0

    passes = [straight(0.0, 30.0, -5.0), straight(2.0, 30.0, -5.0), straight(40.0, 25.0, -5.0)]
    order = from_outside(passes, SMALL, inward, links_round(3.0))
    begins = [(one.tip[0, 0], one.tip[0, 1]) for one in order]
    assert begins == [(-5.0, 0.0), (30.0, 2.0), (-5.0, 40.0)]
    # Far from each other both begin outside; one that is reached from nowhere is left to a smaller cutter.
    begins = [one.tip[0, 0] for one in from_outside(passes, SMALL, inward, links_round(1.0))]
    assert begins == [-5.0, -5.0, -5.0]
    inside = straight(60.0, 10.0, 30.0)
    assert len(from_outside([*passes, inside], SMALL, inward, links_round(3.0))) == 3
