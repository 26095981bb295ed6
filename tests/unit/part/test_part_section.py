"""Sections and outlines: exact lines and arcs, the same through STEP and IGES."""

from __future__ import annotations

import math
from typing import Any

import cadquery as cq
import numpy as np
import pytest

import samples
from long_mark import mostly_long
from seeded.leaning_panels import leaning_panel
from seeded.plates import plate
from trunnion import tolerance
from trunnion.findings import BadInput
from trunnion.geometry.frame import WORLD, Frame
from trunnion.part.shape.plane_intersection import Tracer
from trunnion.part.shape.section import SolidSlicer

BOTH = pytest.mark.parametrize("suffix", ["step", "igs"])
TOP = 60 * 36 - (36 * 20 - (4 - math.pi) * 4**2)


@BOTH
def test_a_box_is_cut_to_its_rectangle(suffix: str) -> None:
    region = samples.read(samples.box_shape(), suffix).section(WORLD, 7.0)
    assert region.area == pytest.approx(40 * 30, abs=1e-6)
    assert np.concatenate(region.box()) == pytest.approx([0, 0, 40, 30])


@BOTH
def test_a_bore_is_cut_to_an_exact_circle(suffix: str) -> None:
    region = samples.read(samples.drilled_block_shape(), suffix).section(WORLD, 7.0)
    assert region.area == pytest.approx(40 * 30 - math.pi * 16, abs=1e-6)
    assert region.pieces[0].holes[0].segments().radius == pytest.approx([4.0, 4.0])


def test_an_arc_is_in_its_face_though_its_middle_is_right_beside_a_corner() -> None:
    # A dome between four planes: the classifier's ray from the middle of each arc meets a corner of the face, and one was taken for out.
    shape = cq.Shape.cast(plate(606).shape)
    slicer = SolidSlicer(shape.wrapped, [face.wrapped for face in shape.Faces()])
    along_x = Frame(origin=np.zeros(3), x=np.array([0.0, 0.0, -1.0]), z=np.array([1.0, 0.0, 0.0]))
    low, middle, high = (slicer.section(along_x, 250.996996 + d).area for d in (-0.01, 0.0, 0.01))
    assert low > middle > high > 0.99 * low


@pytest.mark.parametrize("peak", [(13.3, 20.0), (0.25, 20.0)])
def test_an_edge_that_comes_through_the_plane_between_its_samples_is_met_twice(peak) -> None:
    # A crest that is 0.2 mm wide where it is cut, on an edge of 40 mm.
    def height(x: float) -> float:
        return peak[1] - (x - peak[0]) ** 2 / 100.0

    crest = [(x, height(x)) for x in np.linspace(0.0, 40.0, 21).tolist()]
    made = cq.Workplane("XZ").moveTo(0.0, 0.0).lineTo(*crest[0])
    solid = made.spline(crest[1:], includeCurrent=True).lineTo(40.0, 0.0).close().extrude(-10.0)
    slicer = SolidSlicer(solid.val().wrapped, [face.wrapped for face in solid.val().Faces()])
    top = solid.val().BoundingBox(1e-9).zmax
    low, high = slicer.section(WORLD, peak[1] - 1e-4).box()
    assert top > peak[1] - 1e-4
    assert (high - low)[0] == pytest.approx(2.0 * math.sqrt(100.0 * 1e-4), rel=0.1)
    assert (high - low)[1] == pytest.approx(10.0)


@BOTH
def test_a_pocket_above_its_fillet_is_lines_and_four_arcs(suffix: str) -> None:
    region = samples.read(samples.block_with_pocket_shape(), suffix).section(WORLD, 15.0)
    assert region.area == pytest.approx(TOP, abs=1e-5)
    radii = region.pieces[0].holes[0].segments().radius
    assert np.sort(radii[np.isfinite(radii)]) == pytest.approx([4.0] * 4, abs=1e-6)


@BOTH
def test_a_pocket_inside_its_fillet_is_narrower_by_the_fillet(suffix: str) -> None:
    # Half a fillet's radius (2) over the floor: narrower by 2 - sqrt(4 - 1) all round, corner radius by as much.
    by = 2 - math.sqrt(3)
    hollow = (36 - 2 * by) * (20 - 2 * by) - (4 - math.pi) * (4 - by) ** 2
    region = samples.read(samples.block_with_pocket_shape(), suffix).section(WORLD, 9.0)
    assert region.area == pytest.approx(60 * 36 - hollow, abs=1e-4)


@BOTH
def test_a_plane_in_a_floor_or_through_corners_cuts_a_hair_above(suffix: str) -> None:
    part = samples.read(samples.block_with_pocket_shape(), suffix)
    assert part.section(WORLD, 10.0).area == pytest.approx(TOP, abs=1e-3)
    assert not part.section(WORLD, 18.0)
    assert not part.section(WORLD, 30.0)


@BOTH
def test_a_leaning_cylinder_is_cut_to_an_ellipse_within_the_fit(suffix: str) -> None:
    region = samples.read(samples.oblique_cylinder_shape(), suffix).section(WORLD, 25.0)
    long, short = 10 / math.cos(math.radians(30)), 10.0
    assert region.area == pytest.approx(math.pi * long * short, rel=1e-5)
    middle = 25 * math.tan(math.radians(30))
    angles = np.linspace(0, 2 * math.pi, 50)
    ellipse = np.stack([middle + long * np.cos(angles), short * np.sin(angles)], axis=1)
    assert region.pieces[0].outer.distance(ellipse).max() < 2 * tolerance.FITTED


@BOTH
def test_a_ball_is_cut_to_a_circle(suffix: str) -> None:
    region = samples.read(samples.ball_shape(), suffix).section(WORLD, 6.0)
    assert region.area == pytest.approx(math.pi * 64, rel=1e-5)


@pytest.mark.parametrize("turn", [0, 60, 90, 180, 270, 300])
def test_a_ball_cut_off_by_a_plane_has_its_seam_anywhere(turn: int) -> None:
    """Not with the seam beside the middle of what is cut off: there OCC writes the other side of the face into the file."""
    ball = cq.Workplane("XY").sphere(30.0).rotate((0, 0, 0), (0, 0, 1), turn)
    shape = ball.intersect(cq.Workplane("XY").box(40.0, 200.0, 200.0).translate((12.0, 0.0, 0.0)))
    region = samples.read(shape.val().wrapped, "step").section(WORLD, 6.0)
    radius = math.sqrt(30.0**2 - 6.0**2)
    cap = radius**2 * math.acos(8.0 / radius) - 8.0 * math.sqrt(radius**2 - 8.0**2)
    assert region.area == pytest.approx(math.pi * radius**2 - cap, rel=1e-5)


@BOTH
@pytest.mark.parametrize(
    ("axis", "degrees"), [((1, 2, 3), 40.0), ((0, 1, 0), 90.0), ((1, 0, 0), 180.0)]
)
def test_a_turned_part_is_cut_the_same_in_its_own_frame(
    suffix: str, axis: tuple[float, ...], degrees: float
) -> None:
    part = samples.read(
        samples.turned(samples.block_with_pocket_shape(), axis, degrees, (5.0, 7.0, 9.0)), suffix
    )
    from scipy.spatial.transform import Rotation

    turn = Rotation.from_rotvec(
        np.radians(degrees) * np.array(axis) / np.linalg.norm(axis)
    ).as_matrix()
    about = np.array([5.0, 7.0, 9.0])
    frame = Frame(about - turn @ about, turn[:, 0], turn[:, 2])
    assert part.section(frame, 15.0).area == pytest.approx(TOP, abs=1e-4)
    assert part.section(frame, 9.0).pieces[0].holes[0].n_segments == 8


@pytest.mark.parametrize("suffix", mostly_long(["step", "igs"], "step"))
def test_sections_added_up_are_the_volume(suffix: str) -> None:
    part = samples.read(samples.two_pockets_and_a_rib_shape(), suffix)
    heights = (np.arange(200) + 0.5) * 0.1
    assert sum(part.section(WORLD, float(z)).area for z in heights) * 0.1 == pytest.approx(
        part.volume, rel=1e-4
    )


def test_a_section_is_computed_once() -> None:
    part = samples.read(samples.box_shape())
    assert part.section(WORLD, 3.0) is part.section(WORLD, 3.0)


@BOTH
def test_a_level_face_has_its_outline_with_arcs_and_holes(suffix: str) -> None:
    part = samples.read(samples.block_with_pocket_shape(), suffix)
    graph = part.graph()
    top = next(
        t
        for t in part.tags
        if graph.normal[t - 1][2] > 0.99 and graph.centre[t - 1][2] == pytest.approx(18.0)
    )
    region = part.face_outline(WORLD, top)
    assert region.area == pytest.approx(TOP, abs=1e-5)
    assert len(region.pieces[0].holes) == 1


def test_a_leaning_face_has_no_outline() -> None:
    part = samples.read(samples.box_shape())
    wall = next(t for t in part.tags if abs(part.graph().normal[t - 1][0]) > 0.99)
    with pytest.raises(BadInput, match=f"face {wall} of sample is not level"):
        part.face_outline(WORLD, wall)


def test_a_plane_that_leans_meets_circles_whose_farthest_points_lie_below_it() -> None:
    # A disc of radius 50 cut 46 mm off its axis, 60 degrees from x: none of the rim's ends along x and y is as far out.
    disc = cq.Workplane("XY").circle(50.0).extrude(5.0).val().wrapped
    out = np.array([math.cos(math.radians(60.0)), math.sin(math.radians(60.0)), 0.0])
    leaning = Frame(np.zeros(3), np.array([0.0, 0.0, 1.0]), out)
    wide = 2.0 * math.sqrt(50.0**2 - 46.0**2)
    assert samples.read(disc).section(leaning, 46.0).area == pytest.approx(5.0 * wide, abs=1e-6)


def test_a_narrow_fillet_of_a_wide_rim_is_cut_though_steps_are_longer_than_it_is_round() -> None:
    # 2 mm round on a rim of 59 mm radius, cut beside its inner edge: a step of 5 mm over it was pulled back to where it began.
    shape = cq.Shape.cast(leaning_panel(144).shape)
    slicer = SolidSlicer(shape.wrapped, [face.wrapped for face in shape.Faces()])
    low, middle, high = (slicer.section(WORLD, 37.755208237 + d).area for d in (-0.01, 0.0, 0.01))
    assert low > middle > high > 0.99 * low


def test_a_curve_that_is_lost_from_one_end_is_found_from_the_other(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    part = samples.read(samples.oblique_cylinder_shape(), "igs")
    whole = part.section(WORLD, 1.3)
    followed, follow = [], Tracer.follow

    def lost_at_first(tracer: Tracer, *way: Any) -> Any:
        followed.append(way)
        return None if len(followed) <= 2 else follow(tracer, *way)

    monkeypatch.setattr(Tracer, "follow", lost_at_first)
    again = part.section(WORLD, 1.3 + 1e-8)
    assert len(followed) > 2
    assert again.area == pytest.approx(whole.area, rel=1e-6)
