"""How far a pose may lean, plunge or be shortened before it touches, where the first touch is known in closed form."""

from __future__ import annotations

import math

import numpy as np
import pytest
from pytest import approx

from leaning_tools import contact_of
from trunnion.findings import Cancelled
from trunnion.model.tool import Holder, Tool
from trunnion.progress import Progress
from trunnion.verify.contact.query import STICKOUT_STEP, pose_clearance

UP = np.array([[0.0, 0.0, 1.0]])
ALLOWED = 0.001
CLOSE = math.radians(0.05)
"""What a touch of a few microns over tens of millimetres may make of an angle."""


def tool(diameter=10.0, stickout=60.0, holder=20.0):
    """Return a flat end of one diameter up to a cylindrical holder."""
    return Tool(
        number=1,
        name="flat",
        form="flat",
        diameter=diameter,
        corner_radius=0.0,
        flute_length=20.0,
        neck_diameter=diameter,
        neck_length=20.0,
        shank_diameter=diameter,
        stickout=stickout,
        gauge_length=stickout + 40.0,
        teeth=3,
        centre_cutting=True,
        helix_angle=30.0,
        holder=Holder(name="straight", rows=((0.0, holder, 40.0, holder),)),
    )


WALL = ((8.0, -200.0, 0.0), (60.0, 200.0, 30.0))


def lean_to_an_edge(gap, height, radius=5.0):
    """Return how far a cylinder may lean about its tip until its flank meets an edge `gap` beside and `height` above the tip."""
    return math.acos(radius / math.hypot(gap, height)) - math.atan2(height, gap)


def test_beside_a_wall_the_flank_meets_its_upper_edge():
    found = pose_clearance(
        contact_of(WALL),
        tool(holder=5.0),
        np.array([[0.0, 0.0, 10.0]]),
        UP,
        directions=4,
        allowed=ALLOWED,
    )
    # The rim's lowest point comes down to z = 10 - 5 sin at most: nothing is below it here.
    assert found.towards[0] == approx(np.array([[1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]]))
    assert found.clear.all() and found.lean[0, 0] == approx(lean_to_an_edge(8.0, 20.0), abs=CLOSE)
    assert found.lean[0, 2] > math.radians(89.0)


def test_in_a_slot_both_sides_stop_it_alike():
    other = ((-60.0, -200.0, 0.0), (-8.0, 200.0, 30.0))
    found = pose_clearance(
        contact_of(WALL, other),
        tool(holder=5.0),
        np.array([[0.0, 0.0, 10.0]]),
        UP,
        directions=4,
        allowed=ALLOWED,
    )
    assert found.lean[0, [0, 2]] == approx(lean_to_an_edge(8.0, 20.0), abs=CLOSE)


def test_over_a_floor_the_rim_comes_down_as_it_leans_and_the_tip_as_it_plunges():
    floor = contact_of(((-200.0, -200.0, -10.0), (200.0, 200.0, 0.0)))
    found = pose_clearance(
        floor,
        tool(),
        np.array([[0.0, 0.0, 2.0], [0.0, 0.0, 1.0]]),
        np.tile(UP, (2, 1)),
        allowed=ALLOWED,
        most_lean=1.0,
    )
    # A rim that enters by less than the bound of a turning move still counts as clear: 5 um to its nearest side, seen at a slant.
    assert found.lean[0] == approx(np.full(8, math.asin(2.0 / 5.0)), abs=2 * CLOSE)
    assert found.lean[1] == approx(np.full(8, math.asin(1.0 / 5.0)), abs=2 * CLOSE)
    assert found.plunge == approx([2.0, 1.0], abs=0.05)


def test_leaning_about_a_ball_end_never_enters_its_floor():
    floor = contact_of(((-200.0, -200.0, -10.0), (200.0, 200.0, 0.0)))
    ball = Tool(
        **{**{n: getattr(tool(), n) for n in Tool.__slots__}, "form": "ball", "corner_radius": 5.0}
    )
    found = pose_clearance(
        floor,
        ball,
        np.zeros((1, 3)),
        UP,
        pivot=np.array([[0.0, 0.0, 5.0]]),
        directions=3,
        allowed=0.01,
    )
    # About its own centre the ball keeps touching; the holder's rim, 20 from the axis and 55 above the centre, comes down at last.
    assert found.lean[0] == approx(
        np.full(3, math.pi / 2 - math.atan2(20.0, 55.0) + math.asin(5.0 / math.hypot(20.0, 55.0))),
        abs=CLOSE,
    )
    assert found.plunge == approx([0.0], abs=0.02)


def test_a_thin_rib_on_the_way_is_not_jumped_over():
    # A rib 0.2 mm thick, thinner than any step: the flank meets its edge, though a pose far beyond it would be clear.
    rib = ((20.0, -0.5, 0.0), (20.2, 0.5, 18.0))
    found = pose_clearance(
        contact_of(rib),
        tool(holder=5.0),
        np.array([[0.0, 0.0, 10.0]]),
        UP,
        directions=4,
        allowed=ALLOWED,
    )
    assert found.lean[0, 0] == approx(lean_to_an_edge(20.0, 8.0), abs=CLOSE)


def test_a_holder_beside_a_wall_may_come_down_to_its_top():
    found = pose_clearance(
        contact_of(WALL), tool(), np.array([[0.0, 0.0, 0.5]]), UP, directions=1, allowed=ALLOWED
    )
    # The wall stands 29.5 above the tip, and the holder's radius of 20 reaches over it.
    assert found.stickout == approx([29.5], abs=1.01 * STICKOUT_STEP)
    assert found.plunge[0] == approx(30.5, abs=0.05)


def test_a_pose_whose_holder_touches_is_told_how_long_it_must_be():
    deep = ((8.0, -200.0, 0.0), (60.0, 200.0, 75.0))
    found = pose_clearance(
        contact_of(deep), tool(), np.array([[0.0, 0.0, 0.5]]), UP, directions=2, allowed=ALLOWED
    )
    assert not found.clear[0] and found.lean.max() == 0.0 and found.plunge[0] == 0.0
    assert found.stickout == approx([74.5], abs=1.01 * STICKOUT_STEP)
    assert np.isnan(
        pose_clearance(
            contact_of(deep), tool(), np.array([[5.0, 0.0, 0.5]]), UP, directions=2
        ).stickout[0]
    )


def test_asking_stops_when_told_to():
    with pytest.raises(Cancelled):
        pose_clearance(
            contact_of(WALL),
            tool(),
            np.zeros((1, 3)),
            UP,
            progress=Progress(cancelled=lambda: True),
        )
