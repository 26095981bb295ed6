"""How deep places lie in a round blank: never deeper than said, and outside of it known to be outside as far as the corners of its box."""

from __future__ import annotations

import numpy as np

from trunnion.geometry.frame import WORLD
from trunnion.model.blank import Revolved
from trunnion.plan.channel.blank_depth import CELL, BlankDepth

RADIUS, HEIGHT = 60.0, 50.0
BLANK = Revolved(
    frame=WORLD,
    outline=np.array([[10.0, 0.0], [RADIUS, 0.0], [30.0, HEIGHT], [10.0, HEIGHT]]),
    material="EN AW-7075",
    density=2.8,
)


def places(seed: int) -> np.ndarray:
    return np.random.default_rng(seed).uniform([-80, -80, -20], [80, 80, 70], (4000, 3))


def test_no_place_is_deeper_in_the_blank_than_said() -> None:
    for seed in range(3):
        points = places(seed)
        said = BlankDepth.of(BLANK, WORLD)(points)
        true = np.asarray(BLANK.inward(BLANK.own(points, WORLD)))
        assert (said >= true - 1e-9).all()
        near = true > -1.0
        assert (said[near] - true[near]).max() < 2.0 * CELL


def test_in_the_corners_of_its_box_places_are_as_far_outside_as_its_radius_says() -> None:
    """They were taken to lie at its surface: tools led round the blank found no way there."""
    turn = np.linspace(0.0, 2.0 * np.pi, 65)
    for away in (4.0, 10.0, 20.0):
        r = RADIUS + away
        points = np.column_stack([r * np.cos(turn), r * np.sin(turn), np.full(65, 10.0)])
        inside_box = (np.abs(points[:, :2]) <= RADIUS).all(axis=1)
        said = BlankDepth.of(BLANK, WORLD)(points[inside_box])
        assert inside_box.any() and (said <= -away + 1e-6).all()
