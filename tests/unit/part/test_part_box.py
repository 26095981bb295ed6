"""The box around a part in any frame."""

import math

import cadquery as cq
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import samples
from trunnion import tolerance
from trunnion.geometry.frame import WORLD, Frame
from trunnion.part.part import Part
from trunnion.part.topology import part_box

DIRECTIONS = st.tuples(*[st.floats(-1.0, 1.0)] * 3).filter(lambda v: np.linalg.norm(v) > 0.2)


@pytest.fixture(scope="module")
def rod() -> Part:
    """Return a rod of 50 mm and radius 7 that stands on the origin."""
    return samples.read(cq.Workplane().circle(7.0).extrude(50.0).val().wrapped)


@pytest.fixture(scope="module")
def vase() -> Part:
    """Return a body whose side is a spline's."""
    side = [(4.0, 0.0), (6.2, 2.4), (3.0, 6.0), (4.4, 9.0)]
    outline = cq.Workplane("XZ").lineTo(*side[0]).spline(side[1:], includeCurrent=True)
    return samples.read(outline.lineTo(0.0, 9.0).close().revolve().val().wrapped)


def frame_along(z: tuple[float, ...], origin: tuple[float, ...] = (0.0, 0.0, 0.0)) -> Frame:
    """Return a frame whose z is along a direction."""
    x = np.eye(3)[int(np.argmin(np.abs(z)))]
    return Frame(np.array(origin), x, np.array(z) / np.linalg.norm(z))


@pytest.mark.examples(10)
@settings(max_examples=30, deadline=None)
@given(z=DIRECTIONS, origin=st.tuples(*[st.floats(-1e3, 1e3)] * 3))
def test_a_rod_reaches_as_far_as_its_rims_say(
    rod: Part, z: tuple[float, ...], origin: tuple[float, ...]
) -> None:
    frame = frame_along(z, origin)
    low, high = rod.box(frame)
    for axis, direction in enumerate(frame.axes):
        radius = 7.0 * math.sqrt(max(1.0 - direction[2] ** 2, 0.0))
        ends = np.array([0.0, 50.0 * direction[2]]) - direction @ frame.origin
        assert low[axis] == pytest.approx(ends.min() - radius, abs=2.0 * tolerance.COINCIDENT)
        assert high[axis] == pytest.approx(ends.max() + radius, abs=2.0 * tolerance.COINCIDENT)


@pytest.mark.examples(3)
@settings(max_examples=8, deadline=None)
@given(z=DIRECTIONS)
def test_a_splines_box_holds_its_triangles_and_is_no_farther_off_than_these(
    vase: Part, z: tuple[float, ...]
) -> None:
    frame, chord = frame_along(z), 1e-3
    low, high = vase.box(frame)
    points = frame.to_local(vase.mesh(chord).points)
    away = np.concatenate([points.min(axis=0) - low, high - points.max(axis=0)])
    assert away.min() > -tolerance.FITTED and away.max() < 2.0 * chord


@pytest.mark.parametrize("z", [(0.0, 0.0, 1.0), (1.0, 0.0, 0.0), (0.3, -0.2, 0.9)])
def test_a_balls_box_is_its_radius_round_its_middle(z: tuple[float, ...]) -> None:
    part = samples.read(cq.Workplane().sphere(9.0).translate((3.0, -4.0, 5.0)).val().wrapped)
    frame = frame_along(z)
    middle = frame.to_local(np.array([3.0, -4.0, 5.0]))
    assert np.array(part.box(frame)) == pytest.approx(
        np.array([middle - 9.0, middle + 9.0]), abs=2.0 * tolerance.COINCIDENT
    )


def test_faces_that_can_reach_no_farther_are_not_asked(monkeypatch: pytest.MonkeyPatch) -> None:
    block = samples.read(samples.block_with_pocket_shape())
    asked = []
    monkeypatch.setattr(part_box, "_face_box_in", lambda *given: asked.append(given))
    block.box(frame_along((0.3, -0.2, 0.9)))
    assert asked == []


def test_the_box_is_that_of_the_chosen_solid() -> None:
    part = samples.read(samples.two_blocks_shape(), solid=2)
    low, high = part.box(WORLD)
    assert np.concatenate([low, high]) == pytest.approx(
        np.concatenate(part.mesh().box()), abs=2.0 * tolerance.COINCIDENT
    )
