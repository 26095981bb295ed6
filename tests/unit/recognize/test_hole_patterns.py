"""Patterns of equal holes: bolt circles, rows and grids, and what is none."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import cadquery as cq
import numpy as np
import pytest
from pytest import approx

import samples
from drilled_parts import UP, box, graph_of
from trunnion.geometry.frame import WORLD
from trunnion.recognize.holes.features import pattern_attributes
from trunnion.recognize.holes.patterns import HolePattern, hole_patterns
from trunnion.recognize.holes.recognize import find_holes

Point = Sequence[float]
GRID = [(20.0 * i, 25.0 * j) for i in range(3) for j in range(2)]


def plate(*holes: tuple[Iterable[Point], float]) -> Any:
    """Return a plate of 200 x 200 x 10 in its middle with through holes: positions and diameters."""
    found = box((200, 200, 10), (-100, -100, 0)).faces(">Z").workplane(origin=(0, 0, 10))
    for points, diameter in holes:
        found = found.pushPoints([tuple(p) for p in points]).hole(diameter)
    return found.val().wrapped


def around(count: int, diameter: float, centre: Point = (0, 0), first: float = 10.0) -> list[Point]:
    """Return positions around a circle."""
    angle = np.radians(first + 360.0 / count * np.arange(count))
    return [
        (centre[0] + 0.5 * diameter * c, centre[1] + 0.5 * diameter * s)
        for c, s in zip(np.cos(angle), np.sin(angle), strict=True)
    ]


def found_in(shape: Any) -> tuple[HolePattern, ...]:
    graph = graph_of(shape)
    return hole_patterns(graph, find_holes(graph, 30.0, UP), WORLD)


def test_holes_around_a_bore_are_a_bolt_circle() -> None:
    (found,) = found_in(plate((around(6, 80), 6.6), ([(0, 0)], 30)))
    assert found.kind == "circle" and found.counts == (6, 6) and found.diameter == approx(80)


def test_a_bolt_circle_is_found_wherever_it_lies() -> None:
    shape = samples.turned(plate((around(8, 70, (15, 9)), 5)), (1, 2, 3), 40.0, about=(5, 6, 7))
    (found,) = found_in(shape)
    assert found.kind == "circle" and found.counts == (8, 8) and found.diameter == approx(70)


def test_a_bolt_circle_may_have_positions_without_a_hole() -> None:
    (found,) = found_in(plate((around(8, 80)[1:], 6), (around(8, 80)[:1], 10)))
    assert found.kind == "circle" and found.counts == (7, 8)


def test_four_holes_in_a_square_are_a_circle_around_something_round_only() -> None:
    square = around(4, 60, first=45)
    (circle,) = found_in(plate((square, 6), ([(0, 0)], 20)))
    (grid,) = found_in(plate((square, 6)))
    assert circle.kind == "circle" and grid.kind == "grid"
    assert grid.pitch == approx((60 / np.sqrt(2), 60 / np.sqrt(2))) and grid.counts == (2, 2)


@pytest.mark.parametrize("angle", [0.0, 30.0, 77.0])
def test_a_grid_is_found_at_any_angle(angle: float) -> None:
    (found,) = found_in(samples.turned(plate((GRID, 6)), (0, 0, 1), angle))
    assert found.kind == "grid" and len(found.members) == 6
    assert sorted(zip(found.pitch, found.counts, strict=True)) == [(20.0, 3), (25.0, 2)]


def test_a_row_has_one_pitch() -> None:
    (found,) = found_in(plate(([(0, 0), (15, 0), (30, 0), (45, 0)], 6)))
    assert found.kind == "row" and found.pitch == approx((15,)) and found.counts == (4,)
    assert found_in(plate(([(0, 0), (15, 0), (31, 0)], 6))) == ()


def test_rows_on_two_sides_are_two_rows() -> None:
    points = [(-80, 20 * k) for k in range(4)] + [(80, 20 * k) for k in range(4)]
    found = found_in(plate((points, 6)))
    assert [(f.kind, f.counts, f.pitch) for f in found] == 2 * [("row", (4,), (20.0,))]


def test_only_equal_holes_are_in_a_pattern() -> None:
    points = [(15.0 * k, 0.0) for k in range(4)]
    assert len(found_in(plate((points[:3], 6), (points[3:], 6.5)))[0].members) == 3
    lower = cq.Workplane(cq.Shape.cast(plate((points, 6)))).cut(box((30, 60, 4), (25, -30, 6)))
    assert found_in(lower) == ()


def test_a_pattern_does_not_depend_on_the_order_of_the_holes() -> None:
    graph = graph_of(plate((around(5, 60, (-40, 0)), 6), ([(50, 12.0 * k) for k in range(5)], 6)))
    holes = find_holes(graph, 30.0, UP)
    as_found = hole_patterns(graph, holes, WORLD)
    reversed_ = hole_patterns(graph, holes[::-1], WORLD)
    assert [p.kind for p in as_found] == ["circle", "row"]
    for pattern in as_found:
        mirrored = tuple(sorted(len(holes) - 1 - m for m in pattern.members))
        assert mirrored in {p.members for p in reversed_ if p.kind == pattern.kind}


def test_members_say_what_pattern_they_are_in() -> None:
    graph = graph_of(plate((around(6, 80), 6), ([(0, 0)], 20)))
    holes = find_holes(graph, 30.0, UP)
    attributes = pattern_attributes(hole_patterns(graph, holes, WORLD))
    assert len(attributes) == 6
    assert all(
        a
        == {
            "pattern": "circle",
            "pattern_number": 1,
            "pattern_count": 6,
            "pitch_circle_diameter": 80.0,
        }
        for a in attributes.values()
    )
