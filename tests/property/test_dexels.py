"""Random moves through the three bundles, beside a far finer plain reference and beside solids of manifold3d."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import Phase, example, given, settings
from hypothesis import strategies as st

from leaning_tools import EVERY_FORM, leaning_section
from solids import box_solid, cutter_solid, swept
from trunnion import tolerance
from trunnion.geometry.frame import WORLD
from trunnion.model.blank import Box
from trunnion.model.motion.toolpath import Motion
from trunnion.verify.kernels.stock import dexels as kernel
from trunnion.verify.motion import moves_of
from trunnion.verify.stock import Stock, run_stock
from trunnion.verify.stock.bundles import cycle
from trunnion.verify.stock.spans import spans_of
from verify_tools import FORMS, plain_depth, supports_of

LOW, HIGH = np.zeros(3), np.array([24.0, 20.0, 16.0])
BLANK = Box(frame=WORLD, low=LOW, high=HIGH, material="test", density=1.0)
TOOLS = st.sampled_from(sorted(FORMS))
BOUND = 0.01
"""mm, of the reference: its steps over time, and the chords of spans."""
seeds = st.integers(0, 2**20)


def cut(sections, pitch):
    stock = Stock.of(BLANK, pitch, ("x", "y", "z"))
    moves = moves_of(sections)
    return stock, run_stock(stock, moves, WORLD, threads=1), moves


def bundles_of(stock):
    stock.open_field()
    return stock.rays


def poses(moves, steps):
    """Return tips and axes of the last move at many times, worked out anew."""
    a, b = moves.start_axis[-1], moves.end_axis[-1]
    t = np.linspace(0.0, 1.0, steps)[:, None]
    theta = np.arccos(np.clip(a @ b, -1.0, 1.0))
    axes = (
        np.tile(a, (steps, 1))
        if theta < 1e-9
        else (np.sin((1 - t) * theta) * a + np.sin(t * theta) * b) / np.sin(theta)
    )
    tips = moves.start[-1] + t * (moves.end[-1] - moves.start[-1])
    if moves.sweep[-1]:
        arm = moves.start[-1] - moves.centre[-1]
        along = arm @ a
        arm, angle = arm - along * a, t * moves.sweep[-1]
        climb = (moves.end[-1] - moves.start[-1]) @ a
        tips = (
            moves.centre[-1]
            + np.cos(angle) * arm
            + np.sin(angle) * np.cross(a, arm)
            + (along + t * climb) * a
        )
    return tips, axes


def deepest(tool, moves, points, steps=1500):
    """Return how deep points are in the cutter at any of many times."""
    best, cutting = np.full(len(points), -np.inf), supports_of(tool)[0]
    _, low, high, _ = cutting
    for tip, axis in zip(*poses(moves, steps), strict=True):
        away = points - tip
        h = away @ axis
        rho = np.linalg.norm(away - h[:, None] * axis, axis=1)
        # Past its ends a point is as far outside as it is past them: hairs there are within the bound.
        past = np.minimum(h - low, high - h)
        inside = plain_depth(cutting, rho, np.clip(h, low, high))
        best = np.maximum(best, np.minimum(inside, past))
    return best


def random_ends(seed, lean, aligned=True):
    """Return tips and axes of one move that starts anywhere in the block and turns by some of `lean`; every fourth along x, y or z."""
    rng = np.random.default_rng(seed)
    axis = rng.normal(size=3)
    axis /= np.linalg.norm(axis)
    if aligned and seed % 4 == 0:
        axis = np.eye(3)[rng.integers(3)] * rng.choice([-1.0, 1.0])
    middle, way = rng.uniform(LOW + 4.0, HIGH - 4.0), rng.normal(size=3) * 3.0
    return (
        np.array([middle - way / 2, middle + way / 2]),
        np.array([axis, axis + lean * rng.normal(size=3)]),
        rng,
    )


@pytest.mark.examples(3)
@given(TOOLS, seeds, st.sampled_from([0.0, 0.02, 0.4]))
@example("t-slot", 107, 0.4)  # A point 0.65 um under the tool at the end of its swing.
@settings(max_examples=8, deadline=None)
def test_points_on_rays_are_gone_where_the_cutter_was_at_any_time(form, seed, lean):
    tips, axes, rng = random_ends(seed, lean)
    check_rays(FORMS[form], leaning_section(FORMS[form], tips, axes), rng)


@pytest.mark.examples(2)
@given(st.sampled_from(["flat", "bull", "t-slot"]), seeds)
@settings(max_examples=4, deadline=None)
def test_arcs_and_helices_about_any_axis_cut_what_they_pass(form, seed):
    (start, _), (axis, _), rng = random_ends(seed, 0.0)
    arm = np.cross(axis, rng.normal(size=3))
    arm *= rng.uniform(1.0, 5.0) / np.linalg.norm(arm)
    turn = rng.uniform(0.3, 6.0)
    end = (
        start
        - arm
        + np.cos(turn) * arm
        + np.sin(turn) * np.cross(axis, arm)
        + rng.choice([0.0, 2.0]) * axis
    )
    section = leaning_section(
        FORMS[form], [start, end], [axis, axis], centre=start - arm, motion=Motion.ARC_CCW
    )
    check_rays(FORMS[form], section, rng)


@pytest.mark.examples(6)
@given(st.sampled_from(["flat", "bull", "drill", "form"]), seeds)
@settings(max_examples=20, deadline=None, phases=[Phase.explicit, Phase.generate])
def test_a_tool_that_swings_within_a_span_takes_nothing_from_beyond_its_sweep(form, seed):
    rng, tool = np.random.default_rng(seed), FORMS[form]
    lean, height = rng.choice([0.007, 0.014, 0.03]), tool.flute_length * rng.uniform(0.3, 0.7)
    # The ray at (12.5, 10.5) passes a pivot on the axis so near beside the flank that the tool leaves up to 3 mm of it on both sides.
    beside, angle = tool.radius + 0.5 * lean * rng.uniform(0.0, 3.0), rng.uniform(0.0, 2.0 * np.pi)
    ahead = np.array([np.cos(angle), np.sin(angle), 0.0])
    pivot = np.array([12.5, 10.5, rng.uniform(2.0, 14.0)]) - beside * ahead
    tilt = 0.1 * rng.normal() * lean + rng.choice([-0.5, 0.5]) * np.array([1.0, -1.0]) * lean
    axes = np.array([np.sin(k) * ahead + np.cos(k) * np.array([0.0, 0.0, 1.0]) for k in tilt])
    stock, _, moves = cut([leaning_section(tool, pivot - height * axes, axes)], 1.0)
    column, w = (
        np.stack(np.meshgrid([-1.0, 0.0, 1.0], [-1.0, 0.0, 1.0])).reshape(2, -1).T + (12.5, 10.5),
        np.linspace(0.01, 15.99, 200),
    )
    points = np.column_stack([np.repeat(column, len(w), axis=0), np.tile(w, len(column))])
    gone, depth = ~bundles_of(stock)["z"].contains(points), closed_depth(tool, moves, points, 400)
    steps = lean * tool.flute_length / 400.0
    assert (depth[gone] > -tolerance.STOCK_CHORD - steps).all()
    assert (depth[~gone] < tolerance.STOCK_CHORD).all()


def closed_depth(tool, moves, points, steps):
    """Return how deep points are in the cutter at any of many times; beyond its ends at least as far outside as it says."""
    best, part = np.full(len(points), -np.inf), supports_of(tool)[0]
    for tip, axis in zip(*poses(moves, steps), strict=True):
        away = points - tip
        h = away @ axis
        rho, beyond = (
            np.linalg.norm(away - h[:, None] * axis, axis=1),
            np.maximum(part[1] - h, h - part[2]),
        )
        depth = plain_depth(part, rho, np.clip(h, part[1], part[2]))
        best = np.maximum(
            best,
            np.where(
                beyond > 0.0, -np.hypot(np.minimum(depth, 0.0), beyond), np.minimum(depth, -beyond)
            ),
        )
    return best


@given(TOOLS, seeds)
@settings(max_examples=60, deadline=None, phases=[Phase.explicit, Phase.generate])
def test_the_deepest_of_a_ray_in_a_swinging_body_is_found_wherever_it_is(form, seed):
    rng, tool = np.random.default_rng(seed), FORMS[form]
    lean, height = rng.uniform(0.002, 0.03), tool.flute_length * rng.uniform(0.0, 1.0)
    tilt = rng.normal() * 0.3 * lean + np.array([-0.5, 0.5]) * lean
    axes = np.column_stack([np.sin(tilt), 0.0 * tilt, np.cos(tilt)])
    moves = moves_of([leaning_section(tool, [10.0, 10.0, 8.0] - height * axes, axes)])
    span = spans_of(moves, np.array([1]), np.array([1]), np.zeros(1, bool)).row[0]
    piece, ray = moves.bodies.piece[0], np.zeros(kernel.RAY_COLUMNS)
    body = (
        moves.bodies.arc,
        int(piece[kernel.CLOSED_FIRST]),
        int(piece[kernel.CLOSED_LAST]),
        np.inf,
    )
    ray[kernel.TWIST] = kernel._ray_turn(span)
    kernel._ray_in_tool_frame(
        ray, span, 10.0 + tool.radius + rng.uniform(-0.5, 0.3) * lean * tool.flute_length, 10.0
    )
    low, high = np.sort(rng.uniform(8.0 - height - 2.0, 8.0 - height + tool.flute_length + 2.0, 2))
    deepest = max(
        kernel._swept_depth(*body, ray, w, kernel.NO_GUESS)[0] for w in np.linspace(low, high, 600)
    )
    found, place = kernel._max_depth_turning(*body, ray, low, high, -0.05)
    assert max(found, -0.05) >= deepest - tolerance.CONTACT_BOUND
    assert (
        low <= place <= high
        and found <= kernel._swept_depth(*body, ray, place, kernel.NO_GUESS)[0] + 1e-9
    )


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("form", sorted(FORMS))
def test_a_guess_of_when_it_is_deepest_changes_only_how_soon_it_is_found(form, seed):
    rng, tool = np.random.default_rng(100 + seed), FORMS[form]
    lean = rng.uniform(0.0, 0.5, 2)
    axis = np.array([np.sin(lean[0]), np.sin(lean[1]) * np.cos(lean[0]), 1.0])
    axis /= np.linalg.norm(axis)
    end = np.array([10.0, 10.0, 8.0]) + rng.uniform(-6.0, 6.0, 3)
    moves = moves_of(
        [leaning_section(tool, np.array([[10.0, 10.0, 8.0], end]), np.array([axis, axis]))]
    )
    span = spans_of(moves, np.array([1]), np.array([1]), np.zeros(1, bool)).row[0]
    piece, ray = moves.bodies.piece[0], np.zeros(kernel.RAY_COLUMNS)
    first, last = int(piece[kernel.CLOSED_FIRST]), int(piece[kernel.CLOSED_LAST])
    body = moves.bodies.arc, first, last, np.inf
    kernel._ray_in_tool_frame(ray, span, *(10.0 + rng.uniform(-12.0, 12.0, 2)))
    at = rng.uniform(-5.0, 40.0, 12)
    plain = [kernel._swept_depth(*body, ray, w, kernel.NO_GUESS) for w in at]
    for guess in (0.0, 1e-6, 0.2, 0.5, 0.9, 1.0, *rng.uniform(0.0, 1.0, 4)):
        for w, (deep, _, _) in zip(at, plain, strict=True):
            found, slope, when = kernel._swept_depth(*body, ray, w, guess)
            assert abs(found - deep) <= 2.0 * kernel.NOISE + 0.12 * max(-deep, 0.0)
            assert 0.0 <= when <= 1.0
            # The slope bounds the depth everywhere on the ray.
            for other, (its, _, _) in zip(at, plain, strict=True):
                room = 2.0 * kernel.NOISE + 0.06 * max(-its, 0.0)
                assert its <= found + slope * (other - w) + room


def check_rays(tool, section, rng):
    stock, _, moves = cut([section], 1.0)
    points, said = [], []
    for name, bundle in bundles_of(stock).items():
        axis = "xyz".index(name)
        cell = rng.integers(0, len(bundle.count), 400)
        local = np.column_stack(
            [
                *(
                    bundle.origin
                    + (np.column_stack([cell % bundle.columns, cell // bundle.columns]) + 0.5)
                ).T,
                rng.uniform(LOW[axis], HIGH[axis], len(cell)),
            ]
        )
        own = np.empty_like(local)
        own[:, cycle(axis)] = local
        points.append(own)
        said.append(bundle.contains(own))
    points, said = np.vstack(points), np.concatenate(said)
    depth = deepest(tool, moves, points)
    # The rapid before the move cuts nothing; at its first pose the move begins.
    sure = np.abs(depth) > BOUND
    assert (said == (depth < 0.0))[sure].all()


@given(TOOLS, seeds)
@settings(max_examples=6, deadline=None)
def test_straight_sweeps_take_off_the_volume_of_solids(form, seed):
    # A face along two axes of the blank is only known to half a cell by the rays in it: none here.
    tips, axes, _ = random_ends(seed, 0.0, aligned=False)
    gone = (box_solid(LOW, HIGH) ^ swept(cutter_solid(FORMS[form]), tips, axes)).volume()
    stock, run, _ = cut([leaning_section(FORMS[form], tips, axes)], 0.2)
    for bundle in bundles_of(stock).values():
        assert abs(BLANK.volume - bundle.volume - gone) < 5e-3 * max(gone, 100.0)
    assert abs(run.removed.sum() - gone) < 5e-3 * max(gone, 100.0)


@given(st.sampled_from(["ball", "t-slot", "form"]), seeds)
@settings(max_examples=3, deadline=None)
def test_cutters_of_several_bodies_and_chains_of_moves_leave_the_same_for_every_bundle(form, seed):
    rng = np.random.default_rng(seed)
    tips = rng.uniform(LOW + 3.0, HIGH - 3.0, (8, 3))
    axes = rng.normal(size=3) + 0.3 * rng.normal(size=(8, 3))
    stock, run, _ = cut([leaning_section(EVERY_FORM[form], tips, axes)], 0.25)
    volumes = [b.volume for b in bundles_of(stock).values()]
    assert np.ptp(volumes) < 5e-3 * BLANK.volume
    assert abs(BLANK.volume - np.mean(volumes) - run.removed.sum()) < 1e-6 * BLANK.volume
