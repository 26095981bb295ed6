"""Small panels from CAD, as they lie in aircraft axes: turned, and with shapes that strangers draw."""

from __future__ import annotations

from typing import Any

import pytest

import samples
from trunnion.model.feature import Recognition
from trunnion.progress import QUIET
from trunnion.recognize.panel import PanelFamily
from trunnion.settings import choose


def recognized(shape: Any, suffix: str = "step") -> Recognition:
    part = samples.read(shape, suffix)
    return PanelFamily().recognize(part.graph(), part, choose(PanelFamily.settings, {}), QUIET)


@pytest.mark.parametrize("degrees", [10.0, 37.3, 45.0])
def test_nothing_stands_over_the_pockets_of_a_panel_turned_about_its_own_axis(degrees: float) -> None:
    still = recognized(samples.two_pockets_and_a_rib_shape())
    found = recognized(samples.turned(samples.two_pockets_and_a_rib_shape(), (0, 0, 1), degrees))
    assert found.counts() == still.counts()
    assert not [f.id for f in found if "refused" in f.attributes]
