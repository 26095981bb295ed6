"""A few boxes around points: what they hold, and what they leave free."""

from __future__ import annotations

import numpy as np
import pytest

from trunnion.geometry.boxes import boxes_around

RING = np.array(
    [(x, y, -float(x)) for x in range(41) for y in range(31) if min(x, 40 - x, y, 30 - y) < 4],
    dtype=float,
)
"""Points 1 mm apart on the rim, 3 mm wide, of a rectangle of 40 x 30 mm."""


def _held(points, boxes):
    return (
        ((points[:, None] >= boxes[None, :, :3]) & (points[:, None] <= boxes[None, :, 3:]))
        .all(axis=2)
        .any(axis=1)
    )


@pytest.mark.parametrize("most", [1, 3, 12])
def test_every_point_is_held_by_no_more_boxes_than_allowed(most):
    boxes = boxes_around(RING, most)
    assert len(boxes) <= most and _held(RING, boxes).all()


def test_boxes_along_the_rim_leave_the_middle_free():
    boxes = boxes_around(RING, 12)
    assert len(boxes) == 4
    middle = np.array([(x, y, -float(x)) for x in range(4, 37) for y in range(4, 27)])
    assert not _held(middle, boxes).any()
    # The last of a box's numbers is its top: the side at x = 0 is higher than the one at x = 40.
    assert boxes[0][5] == 0.0 and boxes[-1][5] == -37.0


def test_the_same_points_in_any_order_are_in_the_same_boxes():
    mixed = RING[np.random.default_rng(4).permutation(len(RING))]
    assert (boxes_around(mixed, 3) == boxes_around(RING, 3)).all()


def test_two_boxes_are_joined_where_that_takes_in_least():
    far = np.array([[0.0, 0.0, 0.0], [3.0, 0.0, 1.0], [50.0, 40.0, 2.0]])
    assert boxes_around(far, 2).tolist() == [[0, 0, 0, 3, 0, 1], [50, 40, 2, 50, 40, 2]]


def test_no_points_need_no_box():
    assert boxes_around(np.zeros((0, 3)), 4).shape == (0, 6)
