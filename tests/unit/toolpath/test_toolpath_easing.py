"""Feeds are eased where more is in front of the cutter than they were chosen for."""

from __future__ import annotations

import numpy as np
import pytest

from milling import SETUP, box_blank, cutting, mill
from trunnion.model.motion.toolpath import Mark, Motion, Toolpath
from trunnion.toolpath.motion.easing import eased
from trunnion.toolpath.stock.heightfield import PlanningStock

TOOL, DATA = mill(16.0), cutting(depth=5.0, width=4.0, feed=1000.0)
STOCK = PlanningStock.of(box_blank((0.0, 0.0, -20.0), (100.0, 60.0, 0.0)), SETUP)


def path_through(*points, feed=1000.0, mark=Mark.CUT):
    n = len(points)
    return Toolpath(
        position=np.array(points, dtype=float),
        axis=np.tile([0.0, 0.0, 1.0], (n, 1)),
        motion=np.array([Motion.RAPID] + [Motion.LINE] * (n - 1)),
        centre=np.full((n, 3), np.nan),
        feed=np.array([0.0] + [feed] * (n - 1)),
        mark=np.full(n, int(mark)),
    )


def test_a_full_slot_goes_at_the_slot_feed_and_a_quarter_of_it_at_the_feed() -> None:
    slot = path_through((-20, 30, -5), (120, 30, -5))
    quarter = path_through((-20, 60 + 8 - 4, -5), (120, 60 + 8 - 4, -5))
    assert eased(slot, TOOL, DATA, STOCK, 0.6).feed[1:].min() == pytest.approx(600.0)
    assert eased(quarter, TOOL, DATA, STOCK, 0.6).feed.tolist() == [0.0, 1000.0]


def test_a_block_is_cut_where_the_load_changes_and_ends_where_it_did() -> None:
    # Half of the way the material before it has been taken away.
    stock = STOCK.after(path_through((-20, 30, -5), (50, 30, -5)), TOOL)
    found = eased(path_through((-20, 30, -5), (120, 30, -5)), TOOL, DATA, stock, 0.6)
    slowest = int(np.argmin(found.feed[1:])) + 1
    # The first piece wholly in what stands begins a radius and half a diameter behind the end of what was cut.
    assert found.feed[slowest] == pytest.approx(600.0)
    assert 58.0 <= found.position[slowest - 1, 0] <= 74.0
    assert found.position[-1].tolist() == [120.0, 30.0, -5.0]
    assert found.feed[1] == found.feed[-1] == 1000.0


def test_a_shallow_slot_needs_no_easing() -> None:
    assert eased(
        path_through((-20, 30, -1), (120, 30, -1)), TOOL, DATA, STOCK, 0.6
    ).feed.tolist() == [0.0, 1000.0]


def test_entries_and_feeds_that_are_slower_already_stay() -> None:
    entry = path_through((-20, 30, -5), (120, 30, -5), mark=Mark.ENTRY)
    slow = path_through((-20, 30, -5), (120, 30, -5), feed=300.0)
    assert eased(entry, TOOL, DATA, STOCK, 0.6).feed.tolist() == [0.0, 1000.0]
    assert eased(slow, TOOL, DATA, STOCK, 0.6).feed.tolist() == [0.0, 300.0]


def test_arcs_keep_their_centre_and_turn_as_far_as_before() -> None:
    half = Toolpath(
        position=np.array([[30.0, 30, -5], [70.0, 30, -5]]),
        axis=np.tile([0.0, 0.0, 1.0], (2, 1)),
        motion=np.array([Motion.RAPID, Motion.ARC_CCW]),
        centre=np.array([[np.nan] * 3, [50.0, 30, -5]]),
        feed=np.array([0.0, 1000.0]),
        mark=np.zeros(2, int),
    )
    found = eased(half, TOOL, DATA, STOCK, 0.6)
    assert len(found) > 2
    assert found.sweeps().sum() == pytest.approx(np.pi)
    assert np.linalg.norm(found.position[1:, :2] - [50.0, 30.0], axis=1) == pytest.approx(
        np.full(len(found) - 1, 20.0)
    )
