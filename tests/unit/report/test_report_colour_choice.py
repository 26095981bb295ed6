"""Groups of a class stay apart: however many there are, without red or green cones, beside neighbours and on every background."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from parts import PARTS, needs_parts
from trunnion.model.feature import FaceRole, Feature
from trunnion.report.colour_choice import pairs_of
from trunnion.report.colour_space import contrast, light, light_of, oklab, written
from trunnion.report.palette import load_palette

PALETTE = load_palette()
WITHOUT = {
    "all cones": np.eye(3),
    "no long cones": np.array(
        [[0.11238, 0.88762, 0], [0.11238, 0.88762, 0], [0.00401, -0.00401, 1]]
    ),
    "no medium cones": np.array(
        [[0.29275, 0.70725, 0], [0.29275, 0.70725, 0], [-0.02234, 0.02234, 1]]
    ),
}
"""Another model than the program's own: F. Vienot, H. Brettel, J. D. Mollon, Color Research and Application 24 (1999)."""
TELLABLE = 0.02
"""Distance in OKLab that a person just notices beside each other."""


def groups(count, local=lambda n: False):
    return [
        Feature(
            id=f"group-{n:02}",
            kind="group",
            faces=(FaceRole(role="face", face=n),),
            attributes={"local": local(n)},
        )
        for n in range(1, count + 1)
    ]


def apart(a, b) -> float:
    """Return how far two colours are apart in OKLab for whoever sees them nearest."""
    pair = light(np.array([a, b], dtype=float))
    return min(
        float(np.linalg.norm(np.subtract(*oklab(np.clip(pair @ m.T, 0, 1)))))
        for m in WITHOUT.values()
    )


def nearest(colours) -> float:
    return min(apart(a, b) for a, b in itertools.combinations(colours, 2))


@pytest.mark.parametrize("is_local", [False, True])
@pytest.mark.parametrize(("count", "least"), [(6, 0.09), (7, 0.07), (12, 0.05), (24, 0.03)])
def test_so_many_groups_of_a_class_are_told_apart_by_everybody(count, least, is_local):
    colours = PALETTE.features(groups(count, lambda n: is_local)).values()
    assert nearest(colours) > least > TELLABLE


def test_both_classes_are_told_apart_too():
    colours = PALETTE.features(groups(20, lambda n: n % 2 == 0)).values()
    assert nearest(colours) > 0.04


@pytest.mark.parametrize("is_local", [False, True])
def test_cold_ones_are_bluer_than_red_and_warm_ones_redder_than_blue(is_local):
    for red, _, blue in PALETTE.features(groups(40, lambda n: is_local)).values():
        assert (red > blue) == is_local


def test_every_colour_stands_off_every_background():
    colours = np.array(list(PALETTE.features(groups(40, lambda n: n % 2 == 0)).values()), float)
    assert len(PALETTE.backgrounds) >= 4 and (255, 255, 255) in PALETTE.backgrounds
    for background in PALETTE.backgrounds:
        assert contrast(colours, np.array(background, float)).min() > 1.29


def test_groups_keep_off_the_colours_of_what_is_selected_and_of_what_is_in_no_group():
    others = (PALETTE.other, PALETTE.unexplained, *PALETTE.selections)
    assert len(others) >= 4
    for is_local in (False, True):
        colours = PALETTE.features(groups(16, lambda _, value=is_local: value)).values()
        assert min(apart(c, other) for c in colours for other in others) > 2.0 * TELLABLE


@pytest.mark.parametrize("step", [1, 3, 7])
def test_neighbours_on_the_part_are_farther_apart_than_others_need_be(step):
    ring = np.array([(n, (n - 1 + step) % 14 + 1) for n in range(1, 15)])
    found = groups(14)
    colours = PALETTE.features(found, ring)
    beside = [apart(colours[found[a - 1].id], colours[found[b - 1].id]) for a, b in ring.tolist()]
    assert min(beside) > 0.1 > nearest(colours.values())
    assert min(beside) > min(
        apart(*(PALETTE.features(found)[found[k - 1].id] for k in pair)) for pair in ring.tolist()
    )


def test_the_same_groups_have_the_same_colours():
    ring = np.array([(1, 2), (2, 3)])
    assert PALETTE.features(groups(9), ring) == load_palette().features(groups(9), ring)


def test_the_first_of_a_class_has_the_colour_that_stands_for_it_in_legends():
    found = groups(9, lambda n: n > 4)
    colours = PALETTE.features(found)
    for first in (found[0], found[4]):
        assert colours[first.id] == PALETTE.class_of(first).colours[0]


def test_neighbours_are_features_with_a_common_edge():
    owners = [(1, 2), (3,), (4,), (2, 5)]
    pairs = np.array([(1, 2), (2, 3), (3, 1), (9, 4)])
    # face 2 is in two features: they meet where its edges are
    assert pairs_of(owners, pairs) == ((0, 1), (0, 3), (1, 3))


def test_oklab_of_known_colours():
    known = {(255, 255, 255): (1.0, 0.0, 0.0), (255, 0, 0): (0.628, 0.225, 0.126)}
    for colour, lab in known.items():
        assert oklab(light(np.array([colour], float)))[0] == pytest.approx(lab, abs=1e-3)
    grid = np.array(list(itertools.product((0.0, 3.0, 120.0, 255.0), repeat=3)))
    assert written(light_of(oklab(light(grid)))) == pytest.approx(grid, abs=1e-3)


def test_the_largest_contrast_is_that_of_black_and_white():
    assert contrast(np.zeros((1, 3)), np.full(3, 255.0))[0] == pytest.approx(21.0)


@needs_parts
@pytest.mark.parametrize("name", ["D1", pytest.param("D3", marks=pytest.mark.long)])
def test_groups_that_meet_on_a_real_part_are_told_apart(name):
    from trunnion.pipeline import Engine

    engine = Engine()
    session = engine.open(PARTS / "surface" / f"{name}.igs")
    session = engine.run(engine.with_choices(session, {"recognize.family": "surface"}), "recognize")
    found = session.recognition
    colours = PALETTE.features(found, found.neighbours)
    meeting = pairs_of([f.tags for f in found], found.neighbours)
    ids = [f.id for f in found]
    assert len(set(colours.values())) == len(ids) and meeting
    assert min(apart(colours[ids[a]], colours[ids[b]]) for a, b in meeting) > 0.08
