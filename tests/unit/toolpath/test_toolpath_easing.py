"""Feeds are eased where more is in front of the cutter than they were chosen for, and raised where it is less."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from milling import SETUP, box_blank, cutting, mill
from trunnion.model.motion.toolpath import Mark, Motion, Toolpath
from trunnion.plan.cutting.milling import chip_thinning
from trunnion.toolpath.motion.load.easing import eased_finish, fed_by_load
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
    assert fed_by_load(slot, TOOL, DATA, STOCK, 0.6).feed[1:].min() == pytest.approx(600.0)
    assert fed_by_load(quarter, TOOL, DATA, STOCK, 0.6).feed.tolist() == [0.0, 1000.0]


def test_a_block_is_cut_where_the_load_changes_and_ends_where_it_did() -> None:
    # Half of the way the material before it has been taken away.
    stock = STOCK.after(path_through((-20, 30, -5), (50, 30, -5)), TOOL)
    found = fed_by_load(path_through((-20, 30, -5), (120, 30, -5)), TOOL, DATA, stock, 0.6)
    slowest = int(np.argmin(found.feed[1:])) + 1
    # The first piece wholly in what stands begins a radius and half a diameter behind the end of what was cut.
    assert found.feed[slowest] == pytest.approx(600.0)
    assert 58.0 <= found.position[slowest - 1, 0] <= 74.0
    assert found.position[-1].tolist() == [120.0, 30.0, -5.0]
    assert found.feed[1] == found.feed[-1] == 1000.0


def test_a_shallow_slot_needs_no_easing() -> None:
    assert fed_by_load(
        path_through((-20, 30, -1), (120, 30, -1)), TOOL, DATA, STOCK, 0.6
    ).feed.tolist() == [0.0, 1000.0]


def test_entries_and_feeds_that_are_slower_already_stay() -> None:
    entry = path_through((-20, 30, -5), (120, 30, -5), mark=Mark.ENTRY)
    slow = path_through((-20, 30, -5), (120, 30, -5), feed=300.0)
    assert fed_by_load(entry, TOOL, DATA, STOCK, 0.6).feed.tolist() == [0.0, 1000.0]
    assert fed_by_load(slow, TOOL, DATA, STOCK, 0.6).feed.tolist() == [0.0, 300.0]


def test_arcs_keep_their_centre_and_turn_as_far_as_before() -> None:
    half = Toolpath(
        position=np.array([[30.0, 30, -5], [70.0, 30, -5]]),
        axis=np.tile([0.0, 0.0, 1.0], (2, 1)),
        motion=np.array([Motion.RAPID, Motion.ARC_CCW]),
        centre=np.array([[np.nan] * 3, [50.0, 30, -5]]),
        feed=np.array([0.0, 1000.0]),
        mark=np.zeros(2, int),
    )
    found = fed_by_load(half, TOOL, DATA, STOCK, 0.6)
    assert len(found) > 2
    assert found.sweeps().sum() == pytest.approx(np.pi)
    assert np.linalg.norm(found.position[1:, :2] - [50.0, 30.0], axis=1) == pytest.approx(
        np.full(len(found) - 1, 20.0)
    )


THIN = replace(DATA, thin_share=1.3, fastest_link=20_000.0)


def along(width, **changed):
    """A straight cut through the blank's side of a width, from one end to the other."""
    return path_through((-20, 60 + 8 - width, -5), (120, 60 + 8 - width, -5), **changed)


def test_a_narrow_cut_goes_at_the_feed_whose_chips_are_as_thick() -> None:
    def feed_in(width):
        found = fed_by_load(along(width), TOOL, THIN, STOCK, 1.0)
        # The feed of the block that the middle of the way is in.
        return float(found.feed[np.searchsorted(found.position[:, 0], 50.0)])

    assert feed_in(4.0) == 1000.0
    assert feed_in(1.5) == 1300.0
    # Two steps lead to the highest: what is between goes at the lower one.
    for width, feed in ((3.0, 1000.0), (2.5, 1150.0)):
        share = chip_thinning(16.0, width) / chip_thinning(16.0, 4.0)
        assert feed_in(width) == feed and feed <= 1000.0 * share < feed + 150.0


def test_no_feed_is_raised_before_a_wide_cut_begins_or_where_the_machine_ends() -> None:
    # What stands begins at x 0: the cutter's rim meets it at x -8.
    found = fed_by_load(along(8.0), TOOL, THIN, STOCK, 1.0)
    raised = found.feed > 1000.0
    assert raised.any()
    assert (found.position[raised, 0] <= -8.0).all() or (found.position[raised, 0] >= 104.0).any()
    inside = (found.position[:, 0] > -8.0) & (found.position[:, 0] <= 100.0)
    assert not raised[inside].any()
    bound = replace(THIN, fastest_link=1100.0)
    assert fed_by_load(along(1.0), TOOL, bound, STOCK, 1.0).feed.max() == pytest.approx(1100.0)


def test_entries_links_and_finishing_passes_are_never_raised() -> None:
    for mark in (Mark.ENTRY, Mark.LINK, Mark.LEAD):
        found = fed_by_load(along(1.0, mark=mark), TOOL, THIN, STOCK, 1.0)
        assert found.feed.max() == pytest.approx(1000.0)
    assert eased_finish(along(1.0), TOOL, THIN, STOCK).feed.max() == pytest.approx(1000.0)


@given(st.lists(st.tuples(st.floats(-20, 120), st.floats(-10, 70)), min_size=2, max_size=8))
def test_raised_feeds_keep_their_steps_and_the_way(points) -> None:
    path = path_through(*[(x, y, -5.0) for x, y in points])
    plain, found = (fed_by_load(path, TOOL, data, STOCK, 0.6) for data in (DATA, THIN))
    assert found.lengths().sum() == pytest.approx(path.lengths().sum())
    assert set(np.round(found.feed[1:] / 50.0, 6) % 1.0) == {0.0}
    assert found.feed.max() <= 1300.0 + 1e-9
    assert (found.lengths() / np.maximum(found.feed, 1.0)).sum() <= (
        plain.lengths() / np.maximum(plain.feed, 1.0)
    ).sum() + 1e-9
