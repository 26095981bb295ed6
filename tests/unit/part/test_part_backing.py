"""Open faces get a backing from the side that sees all of them; what no side sees is refused."""

from __future__ import annotations

import math

import cadquery as cq
import numpy as np
import pytest

from samples import read
from shaped_parts import part_of_shape
from trunnion.findings import BadInput
from trunnion.part.backing import backed
from trunnion.part.open_side import open_side
from trunnion.part.part import Part


def sheet(height=lambda x, y: 0.02 * x * y, width=30, depth=24):
    return cq.Face.makeSplineApprox(
        [
            [cq.Vector(x, y, height(x, y)) for y in range(0, depth + 1, 3)]
            for x in range(0, width + 1, 3)
        ]
    )


def cylinder_faces(*cuts):
    body = cq.Workplane("XZ").circle(10).extrude(40)
    for cut in cuts:
        body = body.cut(cut)
    return cq.Shell.makeShell([f for f in body.faces().vals() if f.geomType() == "CYLINDER"])


def half_cylinder():
    return cylinder_faces(cq.Workplane().box(100, 100, 50).translate((0, 0, -25)))


def holed_sphere():
    body = cq.Workplane().sphere(10).cut(cq.Workplane().circle(3).extrude(20))
    return cq.Shell.makeShell([f for f in body.faces().vals() if f.geomType() == "SPHERE"])


def made(shape, wanted="auto", thickness=5.0):
    part = read(shape.wrapped)
    return part, backed(part, open_side(part, wanted), thickness)


def test_a_backing_makes_a_solid_and_keeps_the_faces_and_their_tags() -> None:
    part, solid = made(sheet())
    assert solid.is_closed and solid.graph().open_edges == 0
    assert solid.backing == (2, 3, 4, 5, 6) and solid.tags == (1, 2, 3, 4, 5, 6)
    assert solid.graph().area[0] == pytest.approx(part.graph().area[0])
    # 0.02 x y has its mean at the middle of the rectangle.
    assert solid.volume == pytest.approx(30 * 24 * (5.0 + 0.02 * 15 * 12), rel=1e-6)
    assert solid.low[2] == pytest.approx(-5.0, abs=1e-5)


def test_a_part_with_a_backing_survives_as_bytes() -> None:
    _, solid = made(sheet())
    again = Part.from_bytes(solid.to_bytes())
    assert (again.backing, again.tags, again.is_closed) == (solid.backing, solid.tags, True)


def test_rims_may_be_upright() -> None:
    _, solid = made(half_cylinder())
    assert solid.volume == pytest.approx(40 * (math.pi * 50 + 20 * 5.0), rel=1e-6)


def test_faces_that_stand_upright_belong_to_the_side() -> None:
    body = cq.Workplane().box(40, 30, 20).faces(">Z").workplane().rect(20, 10).cutBlind(-8)
    inside = [f for f in body.faces().vals() if abs(f.Center().x) < 11 and abs(f.Center().y) < 8]
    _, solid = made(cq.Shell.makeShell([f for f in inside if f.Center().z > 0.1]))
    assert solid.volume == pytest.approx(40 * 30 * 13 - 20 * 10 * 8, rel=1e-9)


def test_several_pieces_stand_on_one_base() -> None:
    pieces = cq.Compound.makeCompound([sheet(), sheet().moved(cq.Location((40, 0, 3)))])
    _, solid = made(pieces)
    one = 30 * 24 * (5.0 + 0.02 * 15 * 12)
    assert solid.volume == pytest.approx(2 * one + 30 * 24 * 3.0, rel=1e-6)
    assert len(solid.backing) == 10


def test_the_normals_of_the_file_decide_only_where_they_are_asked() -> None:
    part, over = read(sheet().wrapped), read(sheet().wrapped.Reversed())
    for wanted, sign in (("auto", 1.0), ("normals", -1.0), ("-z", -1.0)):
        assert open_side(over, wanted).direction.tolist() == [0.0, 0.0, sign]
    assert open_side(part, "normals").direction.tolist() == [0.0, 0.0, 1.0]


def test_a_side_that_does_not_see_all_faces_is_refused() -> None:
    for wanted in ("+y", "-y"):
        with pytest.raises(BadInput, match=f"can't be machined from the side \\{wanted}"):
            open_side(read(half_cylinder().wrapped), wanted)


@pytest.mark.parametrize("wanted", ["auto", "normals", "+z"])
def test_a_shell_that_closes_over_itself_is_refused_with_what_to_do(wanted) -> None:
    with pytest.raises(BadInput, match="looks away there .face 1.; choose open.side") as told:
        open_side(read(holed_sphere().wrapped), wanted)
    assert "\n" not in str(told.value)


def test_a_half_pipe_that_folds_back_under_itself_is_refused() -> None:
    folded = cylinder_faces(cq.Workplane().box(100, 100, 50).translate((0, 0, -30)))
    with pytest.raises(BadInput, match="enclose no material and can't be machined"):
        open_side(read(folded.wrapped), "+z")


def test_pieces_over_one_another_are_refused() -> None:
    over = cq.Compound.makeCompound([sheet(), sheet().moved(cq.Location((5, 5, 30)))])
    with pytest.raises(BadInput, match="some lie under others"):
        open_side(read(over.wrapped), "+z")


def test_pieces_that_look_to_opposite_sides_are_refused_by_their_normals() -> None:
    turned = cq.Face(sheet().moved(cq.Location((40, 0, 0))).wrapped.Reversed())
    pieces = read(cq.Compound.makeCompound([sheet(), turned]).wrapped)
    with pytest.raises(BadInput, match="looks away"):
        open_side(pieces, "normals")
    assert open_side(pieces, "auto").direction.tolist() == [0.0, 0.0, 1.0]


@pytest.mark.parametrize("seed", range(12))
def test_any_wavy_patch_in_any_position_has_a_backing_of_its_plan_area_times_its_mean_depth(
    seed,
) -> None:
    random = np.random.default_rng(seed)
    a, b, c, d = random.uniform(-1.0, 1.0, 4)

    def height(x, y):
        return 2.0 * a * math.sin(x / 6.0 + 3.0 * b) * math.cos(y / 7.0 + 3.0 * c) + 0.2 * d * x

    axis = random.normal(size=3)
    place = cq.Location(cq.Plane((1, 2, 3), tuple(random.normal(size=3)), tuple(axis)))
    patch = part_of_shape(sheet(height).moved(place).wrapped)
    side = open_side(patch)
    solid = backed(patch, side, 4.0)
    mesh = patch.mesh(1e-3)
    corners = side.frame().to_local(mesh.corners().reshape(-1, 3)).reshape(-1, 3, 3)
    a_, b_, c_ = np.moveaxis(corners, 1, 0)
    plan = 0.5 * np.abs(np.cross(b_ - a_, c_ - a_)[:, 2])
    base = corners[:, :, 2].min() - 4.0
    expected = float((plan * (corners[:, :, 2].mean(axis=1) - base)).sum())
    assert solid.is_closed and solid.volume == pytest.approx(expected, rel=0.01)
    assert (
        side.direction @ patch.graph().sample_normal.T * (-1.0 if side.turned else 1.0) > 0
    ).all()
