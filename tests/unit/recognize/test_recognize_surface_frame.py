"""From where a part of curved surfaces is milled, however it lies in its file."""

from __future__ import annotations

import cadquery as cq
import numpy as np
import pytest

from samples import read
from trunnion.geometry.frame import WORLD
from trunnion.recognize.surface.frame import frame_of

SIDES = [((1, 0, 0), 90.0), ((1, 0, 0), -90.0), ((0, 1, 0), 90.0), ((1, 0, 0), 180.0)]


@pytest.mark.parametrize("axis, angle", SIDES)
def test_a_curved_plate_is_milled_from_its_curved_side(axis, angle):
    block = cq.Workplane("XY").box(80, 60, 20, centered=False)
    ball = cq.Workplane("XY").sphere(150.0).translate((40, 30, -133.0))
    laid = block.intersect(ball).val().rotate((0, 0, 0), axis, angle)
    up = cq.Workplane(cq.Face.makePlane()).val().rotate((0, 0, 0), axis, angle).normalAt()
    frame = frame_of(read(laid.wrapped).graph())
    assert frame.z == pytest.approx(np.array(up.toTuple()), abs=1e-9)
    assert abs(float(frame.x @ frame.z)) < 1e-12


def test_a_part_that_is_curved_all_round_keeps_its_files_frame():
    blade = cq.Workplane("XY").ellipse(20.0, 4.0).extrude(60.0)
    assert frame_of(read(blade.val().wrapped).graph()) is WORLD
