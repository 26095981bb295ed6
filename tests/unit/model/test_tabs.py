"""Tabs as an operation's choices keep them, and their geometry."""

from __future__ import annotations

import math

import numpy as np
import pytest

from trunnion.findings import BadInput
from trunnion.model.tabs import HEIGHT, POSITIONS, RAMP, WIDTH, Tab, tabs_of, written

CHOICES = {WIDTH: 8.0, HEIGHT: 1.5, RAMP: 20.0}
TAB = Tab(
    middle=(10.0, 0.0),
    direction=math.radians(-90.0),
    width=8.0,
    reach=25.0,
    bottom=-20.0,
    top=-18.5,
    ramp=math.radians(20.0),
)


def test_tabs_are_read_as_they_were_written() -> None:
    text = written([(10.0, 0.0, -20.0, -90.0, 25.0), (-3.5, 40.25, -20.0, 90.0, 25.0)])
    first, second = tabs_of({**CHOICES, POSITIONS: text}, "outline")
    assert first == TAB
    assert second.middle == (-3.5, 40.25) and second.direction == math.radians(90.0)


def test_without_positions_there_are_no_tabs() -> None:
    assert tabs_of(CHOICES, "outline") == ()


@pytest.mark.parametrize("text", ["1 2 3", "1 2 3 4 5 6", "1 2 3 x 5", "1 2 3 4 nan", "1 2 3 4 5;"])
def test_what_are_no_tabs_is_refused_in_a_line_with_the_operation(text: str) -> None:
    with pytest.raises(BadInput, match="outline: its tabs .* plan the route again"):
        tabs_of({**CHOICES, POSITIONS: text}, "outline")


def test_a_tab_without_its_width_is_refused() -> None:
    with pytest.raises(BadInput, match="outline"):
        tabs_of({HEIGHT: 1.5, RAMP: 20.0, POSITIONS: "1 2 3 4 5"}, "outline")


def test_distances_are_those_from_its_box() -> None:
    # The box goes from x 6 to 14 and from y 0 down to -25.
    points = np.array([(10.0, -5.0), (16.0, -5.0), (10.0, 3.0), (17.0, 4.0), (2.0, -28.0)])
    assert TAB.distance(points) == pytest.approx([0.0, 2.0, 3.0, 5.0, 5.0])
    assert TAB.world(TAB.local(points)) == pytest.approx(points)


def test_its_sizes_are_those_of_a_box_with_ramps() -> None:
    assert TAB.height == 1.5 and TAB.volume == 8.0 * 25.0 * 1.5
    assert TAB.run == pytest.approx(1.5 / math.tan(math.radians(20.0)))
    assert TAB.half_length(10.0, -18.5) == 14.0
    assert TAB.half_length(10.0, -20.0) == pytest.approx(14.0 + TAB.run)
