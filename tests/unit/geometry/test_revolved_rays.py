"""Rays through solids of revolution: the compiled loop against the plain one, and against brute force."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from trunnion.geometry.arrays import Floats
from trunnion.geometry.kernels.revolved_rays import inside_outline, revolved_rays
from trunnion.geometry.revolved import revolved_intervals

RING = np.array([[20.0, 0.0], [30.0, 0.0], [34.0, 12.0], [30.0, 30.0], [20.0, 30.0], [24.0, 15.0]])
SOLID = np.array([[0.0, -5.0], [12.0, -5.0], [12.0, 3.0], [7.0, 9.0], [0.0, 20.0]])
COMB = np.array(
    [[5.0, 0.0], [40.0, 0.0], *([r, z] for k in range(9) for r, z in ((40.0, 4.0 * k + 2.0), (15.0, 4.0 * k + 3.0))),
     [40.0, 40.0], [5.0, 40.0]]
)  # fmt: skip


def rays(seed: int, count: int) -> tuple[Floats, Floats]:
    """Return starts (n, 3) around a solid and one unit direction (3,)."""
    random = np.random.default_rng(seed)
    direction = random.normal(size=3)
    return random.uniform(-60.0, 60.0, (count, 3)), direction / np.linalg.norm(direction)


@pytest.mark.parametrize("outline", [RING, SOLID, COMB])
@settings(deadline=None)
@given(seed=st.integers(0, 10_000))
def test_the_compiled_loop_says_what_the_plain_one_does(outline: Floats, seed: int) -> None:
    start, direction = rays(seed, 60)
    made, plain = (
        revolved_intervals(outline, start, direction),
        revolved_rays(outline, start, direction),
    )
    assert (made.count == plain.count).all()
    assert made.low.shape == plain.low.shape
    assert made.low == pytest.approx(plain.low, abs=1e-9)
    assert made.high == pytest.approx(plain.high, abs=1e-9)


@pytest.mark.parametrize("direction", [(0.0, 0.0, 1.0), (1.0, 0.0, 0.0), (0.0, -1.0, 0.0)])
@pytest.mark.parametrize("outline", [RING, SOLID, COMB])
def test_rays_along_the_axes_are_inside_as_long_as_their_points_are(
    outline: Floats, direction: tuple[float, float, float]
) -> None:
    along = np.array(direction)
    across = np.flatnonzero(along == 0.0)
    start = np.zeros((200, 3))
    start[:, across] = np.random.default_rng(3).uniform(-40.0, 40.0, (200, 2))
    made = revolved_intervals(outline, start, along)
    assert made.count.max() > 0
    t = np.linspace(-80.0, 80.0, 4001)
    for k in range(len(start)):
        at = start[k] + t[:, None] * along
        inside = inside_outline(outline, np.column_stack([np.hypot(at[:, 0], at[:, 1]), at[:, 2]]))
        length = (made.high[k] - made.low[k])[: made.count[k]].sum()
        assert length == pytest.approx(
            inside.sum() * (t[1] - t[0]), abs=0.05 * max(made.count[k], 1) + 0.04
        )


def test_a_ray_that_is_inside_more_often_than_there_was_room_for_is_looked_at_again() -> None:
    made = revolved_intervals(COMB, np.array([[30.0, 0.0, -10.0]]), np.array([0.0, 0.0, 1.0]))
    plain = revolved_rays(COMB, np.array([[30.0, 0.0, -10.0]]), np.array([0.0, 0.0, 1.0]))
    assert made.count[0] == plain.count[0] > 8
    assert made.low[0] == pytest.approx(plain.low[0]) and made.high[0] == pytest.approx(
        plain.high[0]
    )
