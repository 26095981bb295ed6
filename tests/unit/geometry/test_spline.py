"""B-spline surfaces as arrays: closed forms, the compiled loop beside the plain one, and the CAD kernel as oracle."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from trunnion.geometry.kernels.spline import evaluate_surface
from trunnion.geometry.surface.spline import SplineSurface


def spline(
    seed: int, degrees: tuple[int, int], counts: tuple[int, int], rational: bool = True
) -> SplineSurface:
    rng = np.random.default_rng(seed)
    weights = rng.uniform(0.5, 2.0, counts) if rational else np.ones(counts)
    poles = np.dstack([rng.uniform(-10.0, 10.0, (*counts, 3)) * weights[..., None], weights])
    knots = [
        np.concatenate([np.zeros(p), np.linspace(0.0, 3.0, n - p + 1), np.full(p, 3.0)])
        for p, n in zip(degrees, counts)
    ]
    return SplineSurface(
        knots_u=knots[0], knots_v=knots[1], degree_u=degrees[0], degree_v=degrees[1], poles=poles
    )


def test_a_sheet_between_four_corners_has_constant_slopes_and_a_twist() -> None:
    poles = np.array([[[0, 0, 0, 1], [0, 4, 0, 1]], [[2, 0, 0, 1], [2, 4, 8, 1]]], dtype=float)
    sheet = SplineSurface(
        knots_u=[0, 0, 1, 1], knots_v=[0, 0, 1, 1], degree_u=1, degree_v=1, poles=poles
    )
    point, du, dv, duu, duv, dvv = sheet.at(np.array([[0.5, 0.25]]))[0]
    assert point == pytest.approx([1.0, 1.0, 1.0])
    assert du == pytest.approx([2.0, 0.0, 2.0])
    assert dv == pytest.approx([0.0, 4.0, 4.0])
    assert duv == pytest.approx([0.0, 0.0, 8.0])
    assert not duu.any() and not dvv.any()


def test_weights_make_a_quarter_of_a_circle() -> None:
    half = np.sqrt(0.5)
    arc = np.array([[1, 0, 0, 1], [half, half, 0, half], [0, 1, 0, 1]])
    up = np.stack([arc, arc + np.outer(arc[:, 3], [0, 0, 1, 0])], axis=1)
    wall = SplineSurface(
        knots_u=[0, 0, 0, 1, 1, 1], knots_v=[0, 0, 1, 1], degree_u=2, degree_v=1, poles=up
    )
    at = wall.at(np.column_stack([np.linspace(0.0, 1.0, 9), np.linspace(0.0, 1.0, 9)]))
    assert np.hypot(at[:, 0, 0], at[:, 0, 1]) == pytest.approx(np.ones(9))
    assert (at[:, 0] * at[:, 1])[:, :2].sum(axis=1) == pytest.approx(np.zeros(9), abs=1e-12)
    assert np.cross(at[:, 1], at[:, 3])[:, 2] / np.linalg.norm(
        at[:, 1], axis=1
    ) ** 3 == pytest.approx(np.ones(9))


@settings(deadline=None, max_examples=25)
@given(st.integers(0, 10_000), st.integers(1, 5), st.integers(1, 5), st.booleans())
def test_the_compiled_loop_finds_what_the_definition_says(
    seed: int, p: int, q: int, rational: bool
) -> None:
    surface = spline(seed, (p, q), (p + 4, q + 3), rational)
    places = np.random.default_rng(seed).uniform(-0.1, 3.1, (5, 2))
    places[0], places[1] = 0.0, 3.0
    wanted = evaluate_surface(places, surface.knots_u, surface.knots_v, p, q, surface.poles)
    assert np.abs(surface.at(places) - wanted).max() < 1e-9 * max(1.0, np.abs(wanted).max())


def test_derivatives_are_what_small_steps_find() -> None:
    surface, step = spline(4, (3, 4), (8, 9)), 1e-5
    places = np.random.default_rng(0).uniform(0.1, 0.45, (20, 2))
    at = surface.at(places)
    for axis, one, two in ((0, 1, (3, 4)), (1, 2, (4, 5))):
        shift = step * np.eye(2)[axis]
        before, after = surface.at(places - shift), surface.at(places + shift)
        assert (after[:, 0] - before[:, 0]) / (2 * step) == pytest.approx(at[:, one], abs=1e-5)
        assert (after[:, 1:3] - before[:, 1:3]) / (2 * step) == pytest.approx(at[:, two], abs=1e-4)


def test_a_periodic_surface_goes_round() -> None:
    surface = spline(2, (2, 2), (6, 6))
    round_ = SplineSurface(
        knots_u=surface.knots_u,
        knots_v=surface.knots_v,
        degree_u=2,
        degree_v=2,
        poles=surface.poles,
        period=(3.0, 0.0),
    )
    beyond, within = (
        np.array([[3.5, 1.0], [-2.5, 1.0], [3.0, 1.0]]),
        np.array([[0.5, 1.0], [0.5, 1.0], [3.0, 1.0]]),
    )
    assert round_.at(beyond) == pytest.approx(surface.at(within))
