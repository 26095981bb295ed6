"""The face graph of small parts whose faces and edges can be counted by hand."""

from __future__ import annotations

import math
from collections import Counter

import numpy as np
import pytest

import samples

BOTH = pytest.mark.parametrize("suffix", ["step", "igs"])


@BOTH
def test_a_box_has_twelve_convex_square_edges(suffix: str) -> None:
    graph = samples.read(samples.box_shape(), suffix).graph()
    assert len(graph.curve) == 12 and set(graph.convexity) == {1}
    assert graph.dihedral == pytest.approx(np.full(12, math.pi / 2))


@BOTH
def test_normals_point_out_of_the_material(suffix: str) -> None:
    graph = samples.read(samples.box_shape(), suffix).graph()
    assert ((graph.centre - (20, 15, 10)) * graph.normal).sum(axis=1) == pytest.approx(
        [20, 20, 15, 15, 10, 10]
    )


@BOTH
def test_a_bore_is_a_hollow_cylinder_with_two_convex_circles(suffix: str) -> None:
    graph = samples.read(samples.drilled_block_shape(), suffix).graph()
    bore = graph.surface.index("cylinder")
    assert (graph.radius[bore], graph.bend[bore]) == (pytest.approx(4.0), -1)
    assert abs(graph.axis[bore][2]) == pytest.approx(1.0) and graph.axis_point[bore][
        :2
    ] == pytest.approx((20, 15))
    rims = [
        e for e in graph.edges_of[bore] if graph.curve[e] == "circle" and graph.convexity[e] == 1
    ]
    assert len(rims) == 2 and graph.length[rims] == pytest.approx([8 * math.pi] * 2)
    assert graph.area[bore] == pytest.approx(2 * math.pi * 4 * 20)


@BOTH
def test_a_hole_is_an_inner_loop_of_the_face_it_opens_in(suffix: str) -> None:
    graph = samples.read(samples.drilled_block_shape(), suffix).graph()
    bore = graph.surface.index("cylinder")
    loops = [
        graph.edge_loop[e][list(graph.edge_face[e] != bore).index(True)]
        for e in graph.edges_of[bore]
        if graph.across(e, bore) != bore
    ]
    assert loops == [1, 1]


@BOTH
def test_a_pocket_has_hollow_corners_and_fillets(suffix: str) -> None:
    graph = samples.read(samples.block_with_pocket_shape(), suffix).graph()
    assert Counter(graph.surface) == {"plane": 11, "cylinder": 8, "torus": 4}
    round_faces = [n for n, s in enumerate(graph.surface) if s != "plane"]
    assert set(graph.bend[round_faces]) == {-1}
    tori = [n for n, s in enumerate(graph.surface) if s == "torus"]
    assert graph.minor[tori] == pytest.approx([2.0] * 4) and graph.radius[tori] == pytest.approx(
        [2.0] * 4
    )


@BOTH
def test_fillets_meet_their_neighbours_smoothly(suffix: str) -> None:
    # Smooth: 8 beside the corners, 8 over the fillets, 8 between fillets, 8 at the floor. Convex: 12 of the block, 8 of the rim.
    graph = samples.read(samples.block_with_pocket_shape(), suffix).graph()
    assert Counter(graph.convexity.tolist()) == {0: 32, 1: 20}


def test_step_and_iges_of_one_part_agree_face_by_face() -> None:
    one, two = (
        samples.read(samples.two_pockets_and_a_rib_shape(), s).graph() for s in ("step", "igs")
    )
    assert one.surface == two.surface
    for name in ("area", "radius", "minor", "bend", "box_low", "box_high"):
        assert np.allclose(getattr(one, name), getattr(two, name), atol=2e-3, equal_nan=True), name


@BOTH
def test_centres_lie_inside_their_trimmed_faces(suffix: str) -> None:
    part = samples.read(samples.two_pockets_and_a_rib_shape(), suffix)
    from OCP.BRep import BRep_Tool
    from OCP.BRepTopAdaptor import BRepTopAdaptor_FClass2d
    from OCP.gp import gp_Pnt
    from OCP.ShapeAnalysis import ShapeAnalysis_Surface
    from OCP.TopAbs import TopAbs_IN

    for tag, centre in zip(part.tags, part.graph().centre, strict=True):
        surface = ShapeAnalysis_Surface(BRep_Tool.Surface_s(part.face_shape(tag)))
        place = surface.ValueOfUV(gp_Pnt(*centre.tolist()), 1e-7)
        assert BRepTopAdaptor_FClass2d(part.face_shape(tag), 1e-7).Perform(place) == TopAbs_IN
        assert surface.Gap() < 1e-6


def test_every_curved_face_has_nine_samples_with_unit_normals() -> None:
    graph = samples.read(samples.two_pockets_and_a_rib_shape()).graph()
    counts = Counter(graph.sample_face.tolist())
    assert all(counts[n] >= 9 for n, s in enumerate(graph.surface) if s != "plane")
    assert np.linalg.norm(graph.sample_normal, axis=1) == pytest.approx(
        np.ones(len(graph.sample_face))
    )


def test_a_mirrored_part_has_the_same_bends() -> None:
    graph = samples.read(samples.mirrored(samples.block_with_pocket_shape())).graph()
    assert Counter(graph.bend.tolist()) == {0: 11, -1: 12}
    assert Counter(graph.convexity.tolist()) == {0: 32, 1: 20}


@pytest.mark.parametrize("suffix", ["step", "igs"])
def test_the_box_of_a_ball_is_its_diameter(suffix: str) -> None:
    part = samples.read(samples.ball_shape(), suffix)
    assert part.low == pytest.approx((-10, -10, -5), abs=1e-4) and part.high == pytest.approx(
        (10, 10, 10), abs=1e-4
    )
