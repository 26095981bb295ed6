"""Small panels from CAD, as they lie in aircraft axes: turned, and with shapes that strangers draw."""

from __future__ import annotations

from typing import Any

import cadquery as cq
import pytest

import samples
from trunnion.model.feature import Recognition
from trunnion.progress import NO_PROGRESS
from trunnion.recognize.panel import PanelFamily
from trunnion.recognize.surface import SurfaceFamily
from trunnion.settings import choose


def recognized(shape: Any, suffix: str = "step") -> Recognition:
    part = samples.read(shape, suffix)
    return PanelFamily().recognize(
        part.graph(), part, choose(PanelFamily.settings, {}), NO_PROGRESS
    )


@pytest.mark.parametrize("degrees", [10.0, 37.3, 45.0])
def test_nothing_stands_over_the_pockets_of_a_panel_turned_about_its_own_axis(
    degrees: float,
) -> None:
    still = recognized(samples.two_pockets_and_a_rib_shape())
    found = recognized(samples.turned(samples.two_pockets_and_a_rib_shape(), (0, 0, 1), degrees))
    assert found.counts() == still.counts()
    assert not [f.id for f in found if "refused" in f.attributes]


def test_a_dome_on_a_plate_is_no_fillet_and_nothing_is_planned_beside_it() -> None:
    shape = samples.dome_on_a_plate_shape()
    graph = samples.read(shape).graph()
    dome = graph.surface.index("sphere") + 1
    found = recognized(shape)
    assert dome not in {tag for f in found for tag in f.tags} and dome in found.unexplained
    assert ["lean" in str(f.attributes["refused"]) for f in found.of_kind("open_pocket")] == [True]
    assert "recognize.family=surface" in next(
        f.remedy for f in found.findings if f.code == "panel.leaning-wall"
    )


def test_a_dome_on_a_plate_is_taken_for_a_curved_part_and_a_panel_is_not() -> None:
    def best(shape) -> str:
        graph = samples.read(shape).graph()
        return max(
            (PanelFamily(), SurfaceFamily()), key=lambda family: family.suits(graph).score
        ).name

    assert best(samples.dome_on_a_plate_shape()) == "surface"
    assert best(samples.two_pockets_and_a_rib_shape()) == "panel"


def test_a_top_that_the_part_hangs_over_is_no_boss_whatever_stands_around_it() -> None:
    recess = cq.Workplane("XY").box(30.0, 110.0, 20.0).translate((0.0, 0.0, -2.0))
    block = cq.Workplane("XY").box(200.0, 120.0, 40.0).cut(recess)
    block = block.union(cq.Workplane("XY").box(16.0, 20.0, 10.0).translate((0.0, 0.0, -8.0)))
    found = recognized(block.val().wrapped)
    assert "boss" not in found.counts() and "rib" not in found.counts()
    (told,) = [f for f in found.findings if f.code == "panel.undercut"]
    assert len(told.where) >= 2
