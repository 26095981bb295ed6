"""Segmentation of curved surfaces: sizes, groups, slivers, local features."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest

from parts import PARTS, needs_parts
from shaped_parts import bowl, plate, rounded_plate, torus
from trunnion.findings import BadInput
from trunnion.geometry.boundary import Boundary
from trunnion.geometry.facegraph import FaceGraph
from trunnion.part.topology.boundary import bounding_of
from trunnion.part.topology.identity import faces_of
from trunnion.pipeline import Engine
from trunnion.recognize.surface import SurfaceFamily, SurfaceSettings
from trunnion.recognize.surface.groups import aligned_groups, grouped, invariant_groups
from trunnion.recognize.surface.size import diameter, patch_sizes, repaired
from trunnion.settings import choose


class Rectangles:
    """Flat patches by width, height and angle about z (radians), as something with boundaries."""

    def __init__(self, *patches: tuple[float, float, float]) -> None:
        self.patches = patches

    def boundary(self, parts=None):
        corners = []
        for width, height, turn in self.patches:
            square = np.array([[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]])
            spin = np.array([[math.cos(turn), math.sin(turn)], [-math.sin(turn), math.cos(turn)]])
            corners.append(np.column_stack([square @ spin, np.zeros(4)]))
        points = np.array([[c[k], c[(k + 1) % 4]] for c in corners for k in range(4)]).reshape(
            -1, 3
        )
        n = len(self.patches)
        length = np.linalg.norm(points[1::2] - points[::2], axis=1)
        return Boundary(
            face=np.repeat(np.arange(1, n + 1), 4),
            length=length,
            edge=np.repeat(np.arange(4 * n), 2),
            point=points,
        )


def sizes_of(*patches):
    areas = np.array([w * h for w, h, _ in patches])
    return patch_sizes(Rectangles(*patches), range(1, len(patches) + 1), areas, exact=True)


def as_lists(groups):
    return [g.tolist() for g in groups]


def test_a_patch_joins_the_one_before_it_not_the_first_of_the_group() -> None:
    size = np.array([10.0, 10.08, 10.04, 9.0])
    assert as_lists(grouped(np.arange(4), size, 0.05)) == [[1, 2, 0], [3]]


def test_a_relative_tolerance_is_a_share_of_the_size() -> None:
    assert as_lists(grouped(np.arange(3), np.array([100.0, 96.0, 90.0]), 0.05, relative=True)) == [
        [0, 1],
        [2],
    ]


def test_equal_patches_at_different_angles_are_equal_only_by_what_does_not_turn() -> None:
    sizes = sizes_of((40.0, 10.0, 0.0), (40.0, 10.0, 0.7), (40.0, 10.0, 1.9))
    rows = np.arange(3)
    assert as_lists(invariant_groups(sizes, rows, 0.05, relative=False)) == [[0, 1, 2]]
    assert len(aligned_groups(sizes, rows, 0.05, relative=False, subdivide=False)) == 3


def test_equal_diagonals_with_other_sides_are_told_apart_by_the_sides() -> None:
    sizes = sizes_of((30.0, 40.0, 0.0), (14.0, 48.0, 0.0), (40.0, 30.0, 0.0))
    assert as_lists(aligned_groups(sizes, np.arange(3), 0.05, relative=False, subdivide=False)) == [
        [0, 1, 2]
    ]
    assert sorted(
        as_lists(aligned_groups(sizes, np.arange(3), 0.05, relative=False, subdivide=True))
    ) == [[0, 2], [1]]


def test_the_mean_width_tells_a_long_sliver_from_a_patch() -> None:
    assert sizes_of((50.0, 0.02, 0.0), (50.0, 5.0, 0.0)).width == pytest.approx(
        [0.02, 5.0 / 1.1], rel=1e-3
    )


def test_the_boundary_of_a_cylinder_has_no_seam_and_the_box_of_its_circles() -> None:
    from OCP.BRepPrimAPI import BRepPrimAPI_MakeCylinder

    faces = list(enumerate(faces_of(BRepPrimAPI_MakeCylinder(5.0, 20.0).Shape()), 1))
    side = max(faces, key=lambda f: len(bounding_of([f]).points(None).length))[0]
    bounds = bounding_of(faces).points(None)
    assert bounds.length_of(side) == pytest.approx(20.0 * math.pi)
    assert np.ptp(bounds.points_of(side), axis=0) == pytest.approx([10.0, 10.0, 20.0], abs=2e-5)


def test_an_edge_is_cut_into_pieces_of_equal_length() -> None:
    from OCP.BRepPrimAPI import BRepPrimAPI_MakeCylinder

    faces = list(enumerate(faces_of(BRepPrimAPI_MakeCylinder(5.0, 20.0).Shape()), 1))
    bounds = bounding_of(faces).points(lambda length: np.full(len(length), 8))
    ring = bounds.point[bounds.edge == 0]
    assert np.linalg.norm(np.diff(ring, axis=0), axis=1) == pytest.approx(
        np.full(8, 10.0 * math.sin(math.pi / 8)), rel=1e-3
    )


def recognised(part):
    return SurfaceFamily().recognize(part.graph(), part, SurfaceSettings())


def test_the_largest_distance_is_that_of_all_pairs() -> None:
    spread = np.random.default_rng(7)
    clouds = [spread.normal(size=(n, 3)) * (5.0, 1.0, 0.1) + 30.0 for n in (1, 2, 9, 250)]
    turn = np.linspace(0.0, 2.0 * math.pi, 77)
    clouds.append(np.column_stack([9.0 * np.cos(turn), 9.0 * np.sin(turn), 0.0 * turn]))
    for points in clouds:
        every = np.linalg.norm(points[:, None] - points[None], axis=2).max()
        assert diameter(points) == pytest.approx(every, rel=1e-9, abs=1e-9)


def test_a_hollow_ball_is_concave_and_the_edge_rounded_off_a_plate_is_a_rounding() -> None:
    hollow = recognised(bowl(40.0, 30.0, 12.0, 10.0))
    assert [
        f.sizes["concave_radius"] for f in hollow if "concave_radius" in f.sizes
    ] == pytest.approx([10.0])
    assert not any("convex_radius" in f.sizes or "fillet_radius" in f.sizes for f in hollow)
    rounded = recognised(rounded_plate(40.0, 30.0, 12.0, 3.0))
    along = [
        f.sizes["rounding_radius"]
        for f in rounded
        if f.sizes["area"] > 100.0 and "rounding_radius" in f.sizes
    ]
    assert along == pytest.approx([3.0, 3.0])


def test_a_round_hole_is_no_fillet() -> None:
    (hole,) = [
        f for f in recognised(plate(30.0, 30.0, 5.0, hole=10.0)) if "concave_radius" in f.sizes
    ]
    assert hole.sizes["concave_radius"] == pytest.approx(10.0)
    assert "fillet_radius" not in hole.sizes


def test_a_ring_bends_most_inside_and_least_across() -> None:
    bend = torus(10.0, 3.0).bend(1)
    assert (bend.least, bend.most) == pytest.approx((-1.0 / 7.0, 1.0 / 3.0), rel=1e-6)


def test_the_paper_s_repair_measures_edges_against_the_largest_feature() -> None:
    patches = Rectangles((100.0, 10.0, 0.0), (45.0, 10.0, 0.0), (25.0, 5.0, 0.0))
    asked = repaired(patches)(np.array([100.0, 75.0, 60.0, 45.0, 25.0, 10.0]))
    assert asked.tolist() == [8, 8, 6, 4, 2, 1]


GROUPINGS = (("aligned", "features"), ("invariant", "features_by_invariant_size"))


@needs_parts
@pytest.mark.parametrize(
    "name",
    [
        "D1.igs",
        "D2.step",
        pytest.param("D3.step", marks=pytest.mark.long),
        pytest.param("D3.igs", marks=pytest.mark.long),
    ],
)
def test_groups_are_those_of_the_truth(name: str) -> None:
    truth = json.loads((PARTS / "surface" / f"{name[:2]}.truth.json").read_text())
    number = "step_face" if name.endswith("step") else "iges_face"
    by_place = {tuple(f["at"]): f[number] for f in truth["faces"]}
    engine = Engine()
    opened = engine.open(PARTS / "surface" / name)
    for grouping, key in GROUPINGS:
        wanted = truth[key] if grouping == "aligned" else truth[key]["features"]
        found = engine.run(
            engine.with_choices(opened, {"grouping": grouping}), until="recognize"
        ).recognition
        assert found.family == "surface"
        assert {frozenset(f.tags) for f in found.features} == {
            frozenset(by_place[tuple(q["at"])] for q in f["faces"]) for f in wanted
        }
        assert not found.unexplained


@needs_parts
def test_radii_are_those_of_the_truth_and_fillets_have_their_nominal_one() -> None:
    truth = json.loads((PARTS / "surface" / "D2.truth.json").read_text())
    engine = Engine()
    part = engine.context_of(engine.open(PARTS / "surface" / "D2.step")).part
    for face in truth["faces"]:
        bend = part.bend(face["step_face"])
        for wanted, curvature in (
            (face["smallest_concave_radius"], -bend.least),
            (face["smallest_convex_radius"], bend.most),
        ):
            assert (1.0 / curvature if curvature > 1e-6 else None) == (
                wanted and pytest.approx(wanted, rel=0.03)
            )
    fillets = {
        tag: f.sizes["fillet_radius"]
        for f in recognised(part)
        if "fillet_radius" in f.sizes
        for tag in f.tags
    }
    nominal = {
        f["step_face"]: 2.5 if f["kind_of_face"].startswith("root") else 2.0
        for f in truth["faces"]
        if "_fillet_" in f["kind_of_face"]
    }
    assert fillets == pytest.approx(nominal, rel=0.01)


@needs_parts
@pytest.mark.long
def test_an_impeller_gives_one_group_for_each_kind_of_blade_face() -> None:
    engine = Engine()
    opened = engine.with_choices(
        engine.open(PARTS / "impeller" / "C3.step"), {"recognize.family": "surface"}
    )
    found = engine.run(opened, until="recognize").recognition
    assert {len(f.tags) for f in found.features} == {1, 2, 11}


class Squares(Rectangles):
    """Flat square patches by their sides, with bends."""

    def __init__(self, *sides: float) -> None:
        super().__init__(*((s, s, 0.0) for s in sides))

    def bend(self, tag):
        from trunnion.geometry.surface.curvature import FaceCurvature

        return FaceCurvature(least=0.0, most=0.0, spread=np.zeros((0, 2)))

    def graph(self):
        n = len(self.patches)
        none, points = np.full(n, np.nan), np.zeros((n, 3))
        return FaceGraph(
            surface=("plane",) * n,
            area=np.array([w * h for w, h, _ in self.patches]),
            centre=points,
            normal=np.tile([0.0, 0.0, 1.0], (n, 1)),
            axis_point=np.full((n, 3), np.nan),
            axis=np.full((n, 3), np.nan),
            radius=none,
            minor=none,
            bend=np.zeros(n, dtype=int),
            box_low=points,
            box_high=points + 1.0,
            sample_face=np.zeros(0, dtype=int),
            sample_point=np.zeros((0, 3)),
            sample_normal=np.zeros((0, 3)),
            edge_face=np.zeros((0, 2), dtype=int),
            convexity=np.zeros(0, dtype=int),
            dihedral=np.zeros(0),
            length=np.zeros(0),
            edge_loop=np.zeros((0, 2), dtype=int),
            curve=(),
            start=np.zeros((0, 3)),
            middle=np.zeros((0, 3)),
            end=np.zeros((0, 3)),
            curve_centre=np.zeros((0, 3)),
            curve_axis=np.zeros((0, 3)),
            curve_radius=np.zeros(0),
        )


def grouped_squares(*sides: float, **words):
    patches = Squares(*sides)
    return SurfaceFamily().recognize(patches.graph(), patches, choose(SurfaceSettings, words))


@pytest.mark.parametrize("grouping", ["aligned", "invariant"])
def test_patches_below_the_smallest_feature_size_join_no_group_and_are_told(grouping: str) -> None:
    found = grouped_squares(80.0, 20.0, 0.25, 0.3, grouping=grouping)
    assert [f.tags for f in found] == [(1,), (2,)]
    assert found.unexplained == (3, 4)
    (told,) = [f for f in found.findings if f.code == "surface.small"]
    assert told.where == ("face 3", "face 4")
    assert told.text == (
        "2 patches are below the smallest feature size of 0.5 mm and join no group: 0.354 to 0.424 mm across, "
        "0.152 mm2, 0.00% of the area"
    )
    assert "machined with the area around them" in told.remedy


def test_the_smallest_feature_size_is_a_setting() -> None:
    assert grouped_squares(80.0, 0.25, 0.3, **{"recognize.surface.smallest": 0.0}).unexplained == ()
    assert grouped_squares(80.0, 0.25, 0.3, **{"recognize.surface.smallest": 0.4}).unexplained == (
        2,
    )


def test_a_smallest_size_that_a_person_chose_holds_on_a_small_part_too() -> None:
    chosen = {"recognize.surface.smallest": 20.0}
    assert grouped_squares(40.0, 12.0, 10.0, **chosen).dropped == (2, 3)
    assert grouped_squares(0.5, 0.3, **{"recognize.surface.sliver_width": 0.16}).dropped == (2,)


def test_limits_that_leave_nothing_are_refused_by_name() -> None:
    with pytest.raises(BadInput, match=r"no patch is left .*recognize\.surface\.smallest"):
        grouped_squares(40.0, 12.0, **{"recognize.surface.smallest": 100.0})


def test_on_a_small_part_the_limits_are_a_hundredth_of_its_largest_patch() -> None:
    assert grouped_squares(0.5, 0.3, 0.04, 0.03).unexplained == ()
    assert grouped_squares(20.0, 0.3, 0.19).unexplained == (3,)


@needs_parts
def test_a_part_of_half_a_millimetre_is_grouped_as_a_whole() -> None:
    engine = Engine()
    opened = engine.with_choices(
        engine.open(PARTS / "nasty" / "tiny_half_millimetre.step"), {"recognize.family": "surface"}
    )
    found = engine.run(opened, until="recognize").recognition
    assert not found.unexplained and sum(len(f.tags) for f in found) == 16
