"""The order of operations on curved parts: what hangs over comes before what lies below, else larger cutters come first."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from flat_parts import operation
from trunnion.geometry.frame import WORLD
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


@pytest.mark.parametrize("hanging", [{3}, set()])
def test_what_hangs_over_is_cut_first_though_its_cutter_is_smaller(hanging):
    below, over = semi("floor", (1, 2), 8.0), semi("blade", (3,), 5.0)
    graph = SimpleNamespace(centre=np.zeros((3, 3)))
    space = SimpleNamespace(frame=WORLD, part=SimpleNamespace(graph=lambda: graph))
    state = SimpleNamespace(operations=[below, over], hanging=hanging, space=space)
    order = [o.id for o in in_order(state, (STAGE,))]
    assert order == (["semi-blade", "semi-floor"] if hanging else ["semi-floor", "semi-blade"])
