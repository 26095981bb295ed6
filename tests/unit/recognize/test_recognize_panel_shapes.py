"""Small panels from CAD, as they lie in aircraft axes: turned, and with shapes that strangers draw."""

from __future__ import annotations

from typing import Any

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
