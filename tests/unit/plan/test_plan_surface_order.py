"""The order of operations on curved parts: what hangs over comes before what lies below, else larger cutters come first."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from flat_parts import operation
from trunnion.geometry.frame import WORLD
from trunnion.plan.freeform.keys import EARLIER, UPRIGHT_EARLIER
from trunnion.plan.surface.order import in_order
from trunnion.shop.plans import Stage
from verify_tools import bull

STAGE = Stage(
    name="semi-finish", kind="semi", strategy="surface.parallel", on=("group",), cutter="area",
    finish=False, after=(), after_all=(), rule="",
)  # fmt: skip


def semi(name, faces, diameter):
    tool = replace(bull(diameter, 0.5 * diameter)(), name=f"D{diameter:g}", number=int(diameter))
    return replace(operation("semi", name, tool), faces=faces, group="semi-finish")


def in_turn(*operations, hanging=frozenset()):
    """Return the ids of operations on three faces in the order they are cut."""
    graph = SimpleNamespace(centre=np.zeros((3, 3)))
    space = SimpleNamespace(frame=WORLD, part=SimpleNamespace(graph=lambda: graph))
    state = SimpleNamespace(operations=list(operations), hanging=hanging, space=space)
    return [o.id for o in in_order(state, (STAGE,))]


@pytest.mark.parametrize("hanging", [{3}, set()])
def test_what_hangs_over_is_cut_first_though_its_cutter_is_smaller(hanging):
    below, over = semi("floor", (1, 2), 8.0), semi("blade", (3,), 5.0)
    order = in_turn(below, over, hanging=hanging)
    assert order == (["semi-blade", "semi-floor"] if hanging else ["semi-floor", "semi-blade"])


def with_choice(operation, key, value):
    return replace(operation, choices={**operation.choices, key: value})


@pytest.mark.parametrize("diameter", [4.0, 5.0, 6.0])
def test_a_leaning_cutter_comes_after_the_upright_ones_whose_rest_it_takes(diameter):
    upright, other = semi("upright", (1, 2), 5.0), semi("other", (3,), 5.0)
    leaning = with_choice(semi("leaning", (1,), diameter), UPRIGHT_EARLIER, "D3")
    for operations in ((leaning, upright, other), (other, leaning, upright)):
        order = in_turn(*operations)
        assert order.index("semi-upright") < order.index("semi-leaning")


def test_a_rest_comes_after_the_cutter_that_leaves_it():
    wide = semi("wide", (1, 2), 5.0)
    rest = with_choice(semi("rest", (2,), 4.0), EARLIER, "D5")
    last = with_choice(semi("last", (2,), 3.0), EARLIER, "D4")
    finishing = [replace(o, kind="rest_finish") for o in (last, rest, wide)]
    assert in_turn(*finishing) == ["semi-wide", "semi-rest", "semi-last"]


def test_larger_leaning_cutters_of_other_areas_hold_no_upright_one_back():
    """A leaning cutter is larger than the upright ones, and waits for that of its own area: the areas would wait for each other."""
    areas = [((1,), "one"), ((2,), "two"), ((3,), "three")]
    upright = [semi(name, faces, 5.0) for faces, name in areas]
    leaning = [
        with_choice(semi(f"{name}-leaning", faces, 16.0), UPRIGHT_EARLIER, "D5")
        for faces, name in areas
    ]
    operations = [o for pair in zip(upright, leaning, strict=True) for o in pair]
    order = in_turn(*operations)
    assert sorted(order[:3]) == sorted(o.id for o in upright)


def test_what_hangs_over_comes_after_the_upright_cutter_whose_rest_it_is():
    upright, below = semi("upright", (1, 3), 5.0), semi("below", (2,), 5.0)
    over = with_choice(semi("over", (3,), 4.0), UPRIGHT_EARLIER, "D5")
    order = in_turn(upright, below, over, hanging={3})
    assert order == ["semi-upright", "semi-over", "semi-below"]
