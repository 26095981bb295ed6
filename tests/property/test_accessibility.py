"""Random places and tools: what obstacles remember must change no answer, only how soon it comes."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st

from leaning_tools import contact_of
from samples import block_with_pocket_shape, read
from trunnion import tolerance
from trunnion.geometry.frame import WORLD
from trunnion.part.shape.facets import facets_of
from trunnion.part.shape.surfaces import surfaces_of
from trunnion.verify.contact import Obstacles, PartContact
from trunnion.verify.finish.accessibility import leaning_poses, upright_poses
from trunnion.verify.finish.coverage import samples_of
from trunnion.verify.finish.tilted_poses import leaning_axes
from trunnion.verify.motion import poses_of
from verify_tools import FORMS, plain_depth, supports_of

POCKET = read(block_with_pocket_shape())
SURFACES, FACETS = surfaces_of(POCKET, WORLD), facets_of(POCKET, WORLD)
CLOSED = PartContact(SURFACES, FACETS)
SAMPLES = samples_of(SURFACES, 2.0, facets=FACETS)
PLAIN = [FORMS["flat"], FORMS["bull"], FORMS["ball"]]
ALLOWED = 0.02
PLACES = st.lists(st.integers(0, len(SAMPLES) - 1), min_size=1, max_size=20, unique=True).map(
    np.array
)


def plainly(contact, tool, tips, axes, wanted):
    """Say for k places whether one of the poses (k, a, 3) that are wanted is clear: each is asked alone."""
    return np.array(
        [
            any(
                contact.clear(poses_of(tool, tips[k, n : n + 1], axes[k, n : n + 1]), ALLOWED)[0]
                for n in np.flatnonzero(wanted[k])
            )
            for k in range(len(tips))
        ]
    )


@pytest.mark.examples(5)
@settings(deadline=None, max_examples=15, phases=[Phase.explicit, Phase.generate])
@given(rows=PLACES, tools=st.permutations(PLAIN), leans=st.booleans())
def test_what_obstacles_remember_changes_no_answer(rows, tools, leans):
    point, normal = SAMPLES.point[rows], SAMPLES.normal[rows]
    axes = np.stack(list(leaning_axes(normal)), axis=1)[:, ::4]
    every, obstacles = np.arange(len(rows)), Obstacles.none(len(rows))
    for tool in tools:
        tips, axis, wanted = (
            leaning_poses(point, normal, axes, np.ones(axes.shape[:2], bool), tool, every)
            if leans
            else upright_poses(point, normal, tool, every)
        )
        found = CLOSED.any_clear(tool, tips, axis, wanted, ALLOWED, obstacles, threads=2)
        assert found.tolist() == plainly(CLOSED, tool, tips, axis, wanted).tolist()


@pytest.mark.examples(15)
@settings(deadline=None, max_examples=40, phases=[Phase.explicit, Phase.generate])
@given(form=st.sampled_from(sorted(FORMS)), seed=st.integers(0, 2**32 - 1))
def test_an_obstacle_stops_just_the_tools_that_it_is_deep_in(form, seed):
    random, tool = np.random.default_rng(seed), FORMS[form]
    place = random.uniform(-8.0, 8.0, (6, 3))
    tips, axes = (
        random.uniform(-12.0, 12.0, (30, 3)) - [0.0, 0.0, 10.0],
        random.normal(size=(30, 3)),
    )
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    obstacles = Obstacles.none(1)
    obstacles.add(place, np.zeros(6, np.int64))
    stopped = obstacles.stop(tool, tips, axes, np.zeros(30, np.int64), ALLOWED)
    for tip, axis, said in zip(tips, axes, stopped, strict=True):
        h = (place - tip) @ axis
        rho = np.linalg.norm(place - tip - h[:, None] * axis, axis=1)
        deepest = max(float(plain_depth(part, rho, h).max()) for part in supports_of(tool))
        # Near a joint of two parts a depth counts for both of them.
        assert not said or deepest > ALLOWED + tolerance.CONTACT_BOUND - 1e-9
        middle = [
            (h > part[1])
            & (h < part[2])
            & (plain_depth(part, rho, h) > ALLOWED + tolerance.CONTACT_BOUND)
            & (h - part[1] > 20.0 * ALLOWED)
            & (part[2] - h > 20.0 * ALLOWED)
            for part in supports_of(tool)
        ]
        assert said or not any(m.any() for m in middle)


def test_of_more_obstacles_than_are_kept_the_last_ones_are():
    obstacles = Obstacles.none(2)
    kept = obstacles.position.shape[1]
    row = np.ones(1, np.int64)
    for n in range(kept + 3):
        obstacles.add(np.array([[float(n), 0.0, 0.0]]), row)
    obstacles.add(np.full((1, 3), np.nan), row)
    assert obstacles.count.tolist() == [0, kept]
    assert obstacles.position[1, :, 0].tolist() == list(range(kept + 2, 2, -1))


def test_a_pit_that_no_tool_enters_is_known_after_the_first_poses():
    pit = contact_of(
        *(((x, y, 0.0), (x + 40.0, y + 40.0, 40.0)) for x in (-41.0, 1.0) for y in (-41.0, 1.0)),
        ((-1.0, -41.0, 0.0), (1.0, 41.0, 1.0)),
        ((-41.0, -1.0, 0.0), (41.0, 1.0, 1.0)),
    )
    point, normal = np.array([[0.0, 0.0, 1.0]]), np.array([[0.0, 0.0, 1.0]])
    axes, tool = np.stack(list(leaning_axes(normal)), axis=1), FORMS["ball"]
    tips, axis, wanted = leaning_poses(
        point, normal, axes, np.ones(axes.shape[:2], bool), tool, np.array([0])
    )
    obstacles = Obstacles.none(1)
    assert not pit.any_clear(tool, tips, axis, wanted, ALLOWED, obstacles).any()
    assert 0 < obstacles.count[0] < wanted.sum() / 4
    rows = np.zeros(int(wanted.sum()), np.int64)
    assert obstacles.stop(tool, tips[wanted], axis[wanted], rows, ALLOWED).mean() > 0.9
