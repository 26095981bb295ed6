"""Where no floor says which way is up, holes do: a part lies so that most of them can be drilled."""

from __future__ import annotations

import cadquery as cq
import numpy as np
import pytest

from drilled_parts import box, cone, cylinder, graph_of
from trunnion.recognize.panel.frame import choose_frame

TURNS = [((1, 0, 0), 0.0), ((1, 0, 0), 90.0), ((0, 1, 0), 90.0), ((1, 2, 3), 47.0)]
"""Axes and angles (degrees) that parts are turned by."""


def turned(shape: cq.Workplane, axis: tuple[float, float, float], angle: float) -> cq.Workplane:
    return shape.rotate((0, 0, 0), axis, angle)


def upward(shape: cq.Workplane) -> np.ndarray:
    return choose_frame(graph_of(shape)).z


def direction(
    vector: tuple[float, float, float], axis: tuple[float, float, float], angle: float
) -> np.ndarray:
    """Return a direction of the part as it was built, turned like the part."""
    plane = cq.Workplane("XY").add(cq.Edge.makeLine(cq.Vector(), cq.Vector(*vector)))
    end = plane.rotate((0, 0, 0), axis, angle).val().endPoint()
    return np.array(end.toTuple())


@pytest.mark.parametrize(("axis", "angle"), TURNS)
def test_a_block_stands_along_its_hole_not_on_its_largest_side(axis, angle):
    drilled = box((60, 40, 48)).cut(cylinder(6, 68, (30, 20, -10)))
    z = upward(turned(drilled, axis, angle))
    assert abs(z @ direction((0, 0, 1), axis, angle)) == pytest.approx(1.0, abs=1e-6)
    plain = upward(turned(box((60, 40, 48)), axis, angle))
    assert abs(plain @ direction((0, 1, 0), axis, angle)) == pytest.approx(1.0, abs=1e-6)


@pytest.mark.parametrize(("axis", "angle"), TURNS)
def test_the_axis_with_the_larger_area_of_holes_wins(axis, angle):
    drilled = box((60, 40, 48)).cut(cylinder(20, 68, (30, 20, -10)))
    for x in (10, 50):
        drilled = drilled.cut(cylinder(4, 60, (x, -10, 40), (0, 1, 0)))
    z = upward(turned(drilled, axis, angle))
    assert abs(z @ direction((0, 0, 1), axis, angle)) == pytest.approx(1.0, abs=1e-6)


@pytest.mark.parametrize(("axis", "angle"), TURNS)
@pytest.mark.parametrize("up", [1.0, -1.0])
def test_a_pointed_hole_opens_upward(up, axis, angle):
    low = 24.0 - 24.0 * up
    hole = cylinder(6, 30, (30, 20, low), (0, 0, up))
    tip = cone(6, 0.01, 2.0, (30, 20, low + 30.0 * up), (0, 0, up))
    z = upward(turned(box((60, 40, 48)).cut(hole).cut(tip), axis, angle))
    assert z @ direction((0, 0, -up), axis, angle) == pytest.approx(1.0, abs=1e-6)


def test_a_thin_plate_stays_lying_whatever_its_edge_is_drilled_for():
    drilled = box((200, 100, 10)).cut(cylinder(4, 60, (-1, 50, 5), (1, 0, 0)))
    assert abs(upward(drilled)[2]) == pytest.approx(1.0)


def test_floors_count_before_holes():
    pocketed = box((60, 40, 48)).cut(box((40, 20, 30), (10, 10, 40)))
    drilled = pocketed.cut(cylinder(12, 60, (30, -10, 20), (0, 1, 0)))
    assert upward(drilled)[2] == pytest.approx(1.0)
