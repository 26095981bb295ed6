"""How far apart planes may lie: no farther than whatever lies between two of them allows."""

from __future__ import annotations

from dataclasses import fields

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from milling import mill
from trunnion.toolpath.contact_passes.stepover.spacing import (
    FacetSlopes,
    least_over,
    marched,
    tip_spacing,
)


@settings(deadline=None, max_examples=30)
@given(st.integers(0, 10_000))
def test_the_least_over_each_strip_is_that_of_all_that_lies_over_it(seed: int) -> None:
    rng = np.random.default_rng(seed)
    count = int(rng.integers(1, 40))
    first, last = np.sort(rng.integers(0, count, (2, 12)), axis=0)
    values = rng.uniform(0.1, 2.0, 12)
    plain = [values[(first <= k) & (k <= last)].min(initial=np.inf) for k in range(count)]
    assert least_over(first, last, values, count).tolist() == plain


def test_planes_are_nearer_to_each_other_where_something_between_demands_it() -> None:
    at = marched(np.array([0.0, 4.0]), np.array([10.0, 5.0]), np.array([1.0, 0.25]), 0.0, 10.0)
    step = np.diff(at)
    assert at[0] == 0.0 and at[-1] == 10.0 and step.max() <= 1.0 + 1e-9
    near = (at[1:] > 4.0) & (at[:-1] < 5.0)
    assert step[near].max() <= 0.25 + 1e-9 and (step[at[1:] < 3.9] > 0.99).all()


@settings(deadline=None, max_examples=60)
@given(st.floats(1e-6, 4.0), st.sampled_from([0.002, 0.004, 0.05]))
def test_ridges_in_a_hollow_stay_low_however_nearly_it_is_as_round_as_the_cutter(
    wider: float, height: float
) -> None:
    radius = 3.0
    hollow = radius + wider
    turn = np.array([0.0, 1e-3])
    # The bottom of a hollow about y, as triangles: its normals look at the axis.
    ring = np.column_stack([hollow * np.sin(turn), np.zeros(2), -hollow * np.cos(turn)])
    normals = -ring / hollow
    corners = np.array([[ring[0], ring[1], ring[0] + [0.0, 1e-3, 0.0]]])
    facing = np.array([[normals[0], normals[1], normals[0]]])
    places = FacetSlopes(
        row=np.array([0]),
        normal=facing.mean(axis=1),
        area=np.ones(1),
        tips=corners + radius * facing,
        edges=corners[:, 1:] - corners[:, :1],
        turns=facing[:, 1:] - facing[:, :1],
    )
    step = float(
        tip_spacing(places, mill(2.0 * radius, radius), height, np.array([1.0, 0.0, 0.0]))[0]
    )
    # Centres of the cutter go round the axis of the hollow, `wider` from it.
    half = min(0.5 * step / wider, 0.5 * np.pi)
    middle = wider * np.cos(half) + np.sqrt(radius**2 - (wider * np.sin(half)) ** 2)
    assert hollow - middle <= 1.1 * height


def strip(normals, width=0.1, length=1.0, radius=3.0):
    """Return triangles in a row along x, as long along y, whose corners have normals (n + 1, 3)."""
    n = len(normals) - 1
    x = width * np.arange(n + 1)
    corners = np.stack(
        [
            np.column_stack([x[:-1], np.zeros(n), np.zeros(n)]),
            np.column_stack([x[1:], np.zeros(n), np.zeros(n)]),
            np.column_stack([x[:-1], np.full(n, length), np.zeros(n)]),
        ],
        axis=1,
    )
    facing = np.stack([normals[:-1], normals[1:], normals[:-1]], axis=1)
    return FacetSlopes(
        row=np.arange(n),
        normal=facing[:, 0],
        area=np.full(n, 0.5 * width * length),
        tips=corners + radius * facing,
        edges=corners[:, 1:] - corners[:, :1],
        turns=facing[:, 1:] - facing[:, :1],
    )


@pytest.mark.parametrize(("size", "binds"), [(0.002, False), (0.1, True)])
def test_one_triangle_that_is_off_does_not_bind_all_passes(size: float, binds: bool) -> None:
    """A level strip, and in it a triangle whose normals turn as those of a hollow as round as the ball."""
    level = np.tile([0.0, 0.0, 1.0], (401, 1))
    turn = size / 3.0
    hollow = np.array([[np.sin(0.5 * turn), 0.0, 1.0], [-np.sin(0.5 * turn), 0.0, 1.0]])
    flat, off = strip(level), strip(hollow, width=size)
    slopes = FacetSlopes(
        **{
            f.name: np.concatenate([getattr(flat, f.name), getattr(off, f.name)])
            for f in fields(FacetSlopes)
        }
    )
    cutter, across = mill(6.0, 3.0), np.array([1.0, 0.0, 0.0])
    spacing = tip_spacing(slopes, cutter, 0.004, across)
    plain = tip_spacing(flat, cutter, 0.004, across)
    assert bool(spacing.min() < 0.5 * plain.min()) is binds
    assert tip_spacing(off, cutter, 0.004, across).min() < 0.5 * plain.min()
    assert (spacing[:-1] == plain).all()
