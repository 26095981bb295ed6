"""Passes that run on past free rims, along the face's tangent, and end where the part goes on or stands in the way."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from surface_drives import driven, grid, joined
from trunnion.toolpath.contact_passes.extension import extended
from trunnion.toolpath.contact_passes.passes import UPRIGHT, Pass
from verify_tools import bull

RADIUS, FAR = 4.0, 3.0
SLOPE = 0.25
BALL = bull(2.0 * RADIUS, RADIUS)()
NORMAL = np.array([-SLOPE, 0.0, 1.0]) / np.hypot(1.0, SLOPE)


def incline(x, y):
    return 20.0 + SLOPE * x + 0.0 * y


def along_x(low=0.0, high=30.0, y=15.0):
    """A pass of a ball over the incline, its contacts from one x to another."""
    x = np.linspace(low, high, 31)
    contact = np.column_stack([x, np.full(31, y), incline(x, y)])
    tip = contact + RADIUS * NORMAL - RADIUS * UPRIGHT
    return Pass(
        tip=tip, axis=np.broadcast_to(UPRIGHT, tip.shape), normal=np.broadcast_to(NORMAL, tip.shape)
    )


def test_both_ends_at_free_rims_run_on_along_the_tangent() -> None:
    drive = replace(driven(grid(incline))[0], extension=FAR)
    one = along_x()
    (longer,) = extended([one], drive, BALL)
    assert len(longer) == len(one) + 2
    tangent = np.array([1.0, 0.0, SLOPE]) / np.hypot(1.0, SLOPE)
    assert longer.tip[-1] == pytest.approx(one.tip[-1] + FAR * tangent)
    assert longer.tip[0] == pytest.approx(one.tip[0] - FAR * tangent)


def test_a_pass_that_ends_within_the_part_stays_as_it_is() -> None:
    drive = replace(driven(grid(incline))[0], extension=FAR)
    (longer,) = extended([along_x(high=20.0)], drive, BALL)
    assert longer.tip[-1] == pytest.approx(along_x(high=20.0).tip[-1])
    assert len(longer) == 32


def test_a_wall_in_the_way_keeps_a_pass_as_it_is() -> None:
    post = grid(lambda x, y: 40.0 + 0.0 * x, n=4, low=(36.0, 0.0), high=(36.5, 30.0), tag=2)
    drive = replace(driven(joined(grid(incline), post))[0], extension=FAR)
    (longer,) = extended([along_x()], drive, BALL)
    assert longer.tip[-1] == pytest.approx(along_x().tip[-1])


def test_without_an_extension_nothing_changes_and_closed_passes_have_no_ends() -> None:
    drive = driven(grid(incline))[0]
    one = along_x()
    assert extended([one], drive, BALL) == [one]
    closed = replace(one, closed=True)
    assert extended([closed], replace(drive, extension=FAR), BALL) == [closed]


def test_a_leaning_pass_runs_on_where_its_query_says_it_is_clear() -> None:
    drive = replace(driven(grid(incline))[0], extension=FAR)
    one = along_x()
    leaning = replace(one, axis=np.broadcast_to(NORMAL, one.tip.shape))

    def clear(tip, axis, start_tip=None, start_axis=None):
        return tip[:, 0] > 0.0

    (longer,) = extended([leaning], drive, BALL, query=clear)
    assert len(longer) == len(one) + 1
    assert longer.tip[-1][0] > one.tip[-1][0] + 0.9 * FAR
    assert extended([leaning], drive, BALL) == [leaning]
