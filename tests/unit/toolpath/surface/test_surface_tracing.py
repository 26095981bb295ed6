"""Following a dropped cutter: every chord stays near the way, kinks stay, and nothing more is written than is needed."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from trunnion.findings import Cancelled
from trunnion.geometry.surface.drop_surface import DropSurface
from trunnion.progress import Progress
from trunnion.toolpath.contact_passes.upright.tracing import chord_distance, follow, thinned

BALL = np.array([[0.0, 3.0, 1.0, 0.0, 3.0, 3.0]])
FLAT = np.array([[0.0, 3.0, 0.0, 0.0, 0.0, 0.0]])
CHORD, LOWEST = 0.002, -50.0


def grid(height, n=60, size=30.0):
    """Return the drop surface of z = height(x, y) over a square."""
    x, y = np.meshgrid(*[np.linspace(0.0, size, n + 1)] * 2, indexing="ij")
    a = np.arange(n * (n + 1)).reshape(n, n + 1)[:, :-1].ravel()
    triangles = np.vstack(
        [np.column_stack([a, a + n + 1, a + n + 2]), np.column_stack([a, a + n + 2, a + 1])]
    )
    return DropSurface.of(np.column_stack([x.ravel(), y.ravel(), height(x, y).ravel()]), triangles)


def farthest(surface, pieces, path, shares=7):
    """Return how far places between the tips of a path are from where the cutter would stand over them."""
    worst = 0.0
    for share in np.linspace(0.0, 1.0, shares):
        places = path[:-1] + share * np.diff(path, axis=0)
        found = np.column_stack([places[:, :2], surface.drop(places[:, :2], pieces, LOWEST)])
        worst = max(worst, chord_distance(found, path[:-1], path[1:]).max())
    return worst


def test_on_a_plane_only_the_ends_are_written() -> None:
    (path,) = follow(
        grid(lambda x, y: 0.25 * x + 0.1 * y),
        BALL,
        [np.array([[5.0, 5.0], [25.0, 20.0]])],
        CHORD,
        LOWEST,
    )
    lift = 3.0 * math.sqrt(1.0 + 0.25**2 + 0.1**2) - 3.0
    assert path == pytest.approx(np.array([[5.0, 5.0, 1.75 + lift], [25.0, 20.0, 8.25 + lift]]))


def test_the_valley_between_two_slopes_is_a_kink_of_the_path_and_stays() -> None:
    (path,) = follow(
        grid(lambda x, y: np.abs(x - 15.0)),
        BALL,
        [np.array([[8.0, 9.0], [22.0, 9.0]])],
        CHORD,
        LOWEST,
    )
    # A ball of 3 mm on slopes of 45 degrees: its tip stands 3 (sqrt 2 - 1) above the lowest point.
    lowest = path[np.argmin(path[:, 2])]
    assert lowest == pytest.approx(
        np.array([15.0, 9.0, 3.0 * (math.sqrt(2.0) - 1.0)]), abs=2 * CHORD
    )
    assert len(path) <= 5


@settings(deadline=None, max_examples=8)
@given(st.integers(0, 1000), st.sampled_from([BALL, FLAT]))
@example(seed=78, pieces=FLAT)
@example(seed=144, pieces=FLAT)
@example(seed=934, pieces=FLAT)
def test_no_chord_leaves_the_way_of_the_cutter(seed: int, pieces: np.ndarray) -> None:
    rng = np.random.default_rng(seed)
    a, b, c = rng.uniform(0.1, 0.3, 3)
    surface = grid(lambda x, y: 3.0 * np.sin(a * x) * np.cos(b * y) + c * x)
    curves = [rng.uniform(4.0, 26.0, (3, 2)) for _ in range(3)]
    for path, curve in zip(follow(surface, pieces, curves, CHORD, LOWEST), curves, strict=True):
        assert farthest(surface, pieces, path) < CHORD
        assert path[[0, -1], :2].tolist() == curve[[0, -1]].tolist()


def test_a_thin_rib_across_the_way_is_not_overlooked() -> None:
    surface = DropSurface.of(
        np.array(
            [
                [0, 0, 0],
                [30, 0, 0],
                [30, 30, 0],
                [0, 30, 0],
                [14.9, 0, 0],
                [15, 0, 2],
                [15, 30, 2.0],
            ]
        ),
        np.array([[0, 1, 2], [0, 2, 3], [4, 5, 6]]),
    )
    (path,) = follow(surface, BALL, [np.array([[5.0, 15.0], [25.0, 15.0]])], CHORD, LOWEST)
    assert path[:, 2].max() == pytest.approx(2.0, abs=CHORD)
    assert farthest(surface, BALL, path) < CHORD


def test_thinning_keeps_the_ends_of_every_line_and_what_is_needed() -> None:
    points = np.array(
        [[0, 0, 0], [1, 0, 0.001], [2, 0, 0], [0, 5, 0], [1, 5, 1.0], [2, 5, 0]], dtype=float
    )
    assert thinned(points, np.array([0, 0, 0, 1, 1, 1]), 0.01).tolist() == [
        True,
        False,
        True,
        True,
        True,
        True,
    ]


def test_following_looks_at_cancel() -> None:
    asked = []
    with pytest.raises(Cancelled):
        follow(
            grid(lambda x, y: 0.0 * x),
            BALL,
            [np.array([[1.0, 1.0], [29.0, 1.0]])],
            CHORD,
            LOWEST,
            Progress(cancelled=lambda: asked.append(1) or len(asked) > 1),
        )


def test_each_line_is_followed_between_its_own_heights_alone() -> None:
    surface = grid(lambda x, y: 4.0 * np.sin(x / 4.0))
    lines = [np.array([[4.0, y], [26.0, y]]) for y in (8.0, 15.0, 22.0)]
    lowest, highest = np.array([LOWEST, -1.0, 1.0]), np.array([np.inf, 1.5, 2.0])
    paths = follow(surface, BALL, lines, CHORD, lowest, highest=highest)
    x = np.linspace(4.0, 26.0, 300)
    for path, line, low, high in zip(paths, lines, lowest, highest, strict=True):
        rests = surface.drop(np.column_stack([x, np.full(300, line[0, 1])]), BALL, LOWEST)
        found = np.interp(x, path[:, 0], path[:, 2])
        assert np.abs(found - np.clip(rests, low, high)).max() < 3.0 * CHORD
    assert len(paths[1]) < len(paths[0])
