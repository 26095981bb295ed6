"""Trimmed faces as arrays: areas, normals and boxes against the CAD kernel's own."""

from __future__ import annotations

import math
from dataclasses import replace

import cadquery as cq
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pytest import approx

from samples import (
    block_with_pocket_shape,
    drilled_block_shape,
    moved,
    read,
    turned,
    two_pockets_and_a_rib_shape,
)
from trunnion import tolerance
from trunnion.findings import BadInput
from trunnion.geometry.frame import WORLD, Frame
from trunnion.part.shape import surfaces as strips
from trunnion.part.shape.facets import facets_of
from trunnion.part.shape.surfaces import (
    Guide,
    Profile,
    level_face,
    line_edges,
    strips_of,
    surfaces_of,
)
from trunnion.verify.contact import PartContact
from trunnion.verify.finish.coverage import samples_of
from trunnion.verify.motion import moves_of
from verify_tools import flat, program_section

SHAPES = {
    "pocket": block_with_pocket_shape,
    "hole": drilled_block_shape,
    "panel": two_pockets_and_a_rib_shape,
}


@pytest.mark.parametrize("name", SHAPES)
def test_the_samples_of_every_face_add_up_to_the_parts_area(name):
    part = read(SHAPES[name]())
    samples = samples_of(surfaces_of(part, WORLD), 0.25)
    assert samples.area.sum() == approx(part.area, rel=1e-4)


@pytest.mark.parametrize("name", SHAPES)
def test_the_flow_through_the_samples_is_the_parts_volume(name):
    # Gauss: the integral of the position along outward normals is three times the volume; it holds only when every normal points out.
    part = read(SHAPES[name]())
    samples = samples_of(surfaces_of(part, WORLD), 0.25)
    flow = (samples.area[:, None] * samples.normal * samples.point).sum(axis=0)
    assert flow == approx([part.volume] * 3, rel=2e-3)


def in_thin_strips(surfaces, count):
    """Return surfaces whose largest upright plane face comes in many thin strips, as one that is cut by curved edges does."""
    straight = surfaces.strip[:, strips.PROFILE] == 0.0
    length = np.hypot(
        *(
            surfaces.strip[:, strips.PW1 : strips.PZ1 + 1]
            - surfaces.strip[:, strips.PW0 : strips.PZ0 + 1]
        ).T
    )
    row = int(np.argmax(np.where(straight & (surfaces.strip[:, strips.GUIDE] == 0.0), length, 0.0)))
    whole = surfaces.strip[row]
    shares = np.linspace(0.0, 1.0, count + 1)
    thin = np.repeat(whole[None], count, axis=0)
    for first, last in ((strips.U0, strips.U1), (strips.PW0, strips.PW1), (strips.PZ0, strips.PZ1)):
        at = whole[first] + shares * (whole[last] - whole[first])
        thin[:, first], thin[:, last] = at[:-1], at[1:]
    for kind in (strips.L_KIND, strips.R_KIND):
        assert whole[kind] == 0.0
        thin[:, kind + 1] += whole[kind + 2] * (thin[:, strips.U0] - whole[strips.U0])
    face = surfaces.strip_face[row]
    return face, replace(
        surfaces,
        strip=np.vstack([np.delete(surfaces.strip, row, axis=0), thin]),
        strip_face=np.append(np.delete(surfaces.strip_face, row), np.full(count, face)),
    )


def test_a_face_in_thousands_of_thin_strips_has_no_more_samples_than_its_area_asks_for():
    """The wall of a casing came in 3.5 million samples where 30,000 do: each strip had a row of them, however thin."""
    part, spacing = read(block_with_pocket_shape()), 1.0
    surfaces = surfaces_of(part, WORLD)
    face, split = in_thin_strips(surfaces, 3000)
    usual, found = samples_of(surfaces, spacing), samples_of(split, spacing)
    mine, before = found.face == face, usual.face == face
    assert mine.sum() < 2.5 * before.sum()
    assert found.area[mine].sum() == approx(usual.area[before].sum(), rel=1e-9)
    assert found.area[mine].max() < 4.0 * spacing**2
    away = np.linalg.norm(usual.point[before][:, None] - found.point[mine][None], axis=2).min(
        axis=1
    )
    assert away.max() < 2.0 * spacing
    # Other faces have the samples that they had.
    assert (found.point[~mine] == usual.point[~before]).all()


def test_faces_are_exact_strips_in_a_turned_part_and_its_own_frame():
    part = read(
        turned(moved(block_with_pocket_shape(), (1000.0, 200.0, 0.0)), (1.0, 2.0, 3.0), 40.0)
    )
    half = np.radians(40.0) / 2
    w, (x, y, z) = np.cos(half), np.sin(half) * np.array([1.0, 2.0, 3.0]) / np.sqrt(14.0)
    turn = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )
    surfaces = surfaces_of(part, Frame(turn @ [1000.0, 200.0, 0.0], turn[:, 0], turn[:, 2]))
    assert not len(surfaces.free)
    assert sorted(surfaces.region_z.round(6)) == approx([0.0, 8.0, 18.0])


def test_a_part_lying_askew_has_its_hole_listed_as_free_and_samples_on_its_facets():
    part = read(turned(drilled_block_shape(), (1.0, 2.0, 0.0), 30.0))
    surfaces, facets = surfaces_of(part, WORLD), facets_of(part, WORLD)
    assert len(surfaces.free) == 1
    samples = samples_of(surfaces, 0.5, facets=facets)
    assert set(samples.face) == set(range(len(surfaces.tag)))
    assert samples.area.sum() == approx(part.area, rel=1e-3)
    flow = (samples.area[:, None] * samples.normal * samples.point).sum(axis=0)
    assert flow == approx([part.volume] * 3, rel=5e-3)


def test_contact_with_a_face_without_closed_form_is_refused_without_its_facets():
    part = read(turned(drilled_block_shape(), (1.0, 2.0, 0.0), 30.0))
    surfaces = surfaces_of(part, WORLD)
    with pytest.raises(BadInput, match=f"face {surfaces.tag[surfaces.free[0]]} has no closed form"):
        PartContact(surfaces)
    PartContact(surfaces, facets_of(part, WORLD, only=surfaces.tag[surfaces.free]))


def test_an_outline_with_a_gap_of_one_rounding_error_is_closed() -> None:
    sides = (
        (0.0, 0.0, 4.0, 0.0),
        (4.0, 0.0, 4.0, 3.0),
        (4.0, 3.0000000000000004, 0.0, 3.0),
        (0.0, 3.0, 0.0, 0.0),
    )
    edges = [e for side in sides for e in line_edges(np.array(side).reshape(2, 2))]
    face = level_face(1, 0.0, edges)
    assert face is not None
    ends = [tuple(end) for end in face.outline[:, :4].reshape(-1, 2)]
    assert sorted(ends.count(end) for end in set(ends)) == [2, 2, 2, 2]


@pytest.mark.parametrize("gap", [5e-7, 3e-6, 5e-3])
def test_a_level_face_is_sampled_whole_though_its_edges_miss_each_other(gap: float) -> None:
    # Ends farther apart than rounding once left such a face without a sample: nobody asked whether it is finished.
    corners = np.array([(0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 3.0)])
    sides = [
        np.array([a, b + [0.0, -gap if k == 1 else 0.0]])
        for k, (a, b) in enumerate(zip(corners, np.roll(corners, -1, axis=0), strict=True))
    ]
    face = level_face(1, 0.0, [e for side in sides for e in line_edges(side)])
    assert face is not None
    samples = samples_of(strips.surfaces_from([face]), 0.25)
    assert samples.area.sum() == approx(12.0, abs=0.05)


def test_a_level_face_whose_edges_do_not_close_is_none_in_closed_form() -> None:
    sides = [(0.0, 0.0, 4.0, 0.0), (4.0, 0.0, 4.0, 3.0), (4.0, 2.0, 0.0, 3.0), (0.0, 3.0, 0.0, 0.0)]
    edges = [e for side in sides for e in line_edges(np.array(side).reshape(2, 2))]
    assert level_face(1, 0.0, edges) is None


def wall_under(tops: list[tuple[float, float]]) -> np.ndarray:
    """Return the strips of an upright wall from s = 0 and u = 0 up to a chain of points (s, u)."""
    outline = np.array([(tops[0][0], 0.0), *tops, (tops[-1][0], 0.0), (tops[0][0], 0.0)])
    made = strips_of(
        Guide(0, 0.0, 0.0, 1.0, 0.0), Profile(0.0, 0.0, 0.0, 1.0), line_edges(outline), 1.0
    )
    assert made is not None
    return made


def area_of(rows: np.ndarray) -> float:
    half = 0.5 * (rows[:, strips.U1] - rows[:, strips.U0])
    width = (
        rows[:, strips.RA]
        + rows[:, strips.RB] * half
        - rows[:, strips.LA]
        - rows[:, strips.LB] * half
    )
    return float((width * 2.0 * half).sum())


@given(st.floats(1e-7, 5e-6))
def test_a_dip_in_a_walls_rim_stays_open_though_its_sides_differ_by_a_rounding(off: float) -> None:
    rows = wall_under([(0.0, 10.0), (5.0, 9.0), (10.0, 8.0), (15.0, 9.0 + off), (20.0, 10.0)])
    assert area_of(rows) == approx(20.0 * 9.0, abs=1e-4)
    middle = rows[0.5 * (rows[:, strips.U0] + rows[:, strips.U1]) > 8.0]
    assert not ((middle[:, strips.LA] < 9.0) & (middle[:, strips.RA] > 11.0)).any()


@settings(deadline=None)
@given(
    st.lists(
        st.sampled_from([3.0, 4.0, 5.0, 5.0 + 1.1e-6, 5.0 + 2.3e-6, 4.0 - 1.5e-6]),
        min_size=2,
        max_size=9,
    )
)
def test_a_walls_strips_cover_what_lies_under_its_rim(heights: list[float]) -> None:
    rows = wall_under([(2.0 * k, u) for k, u in enumerate(heights)])
    assert area_of(rows) == approx(float(np.trapezoid(heights, dx=2.0)), abs=1e-4)


@pytest.mark.parametrize("radius", [60.0, 260.0])
def test_a_dome_that_is_cut_off_upright_ends_where_it_is_cut_off(radius):
    # The cut is no line or circle in the sphere's parameters, of which one is an angle about its axis: it is followed by chords.
    x = 0.75 * min(radius, 84.0)
    dome = (
        cq.Workplane("XY")
        .box(2.0 * x, 0.5 * x, 2.0 * radius)
        .intersect(cq.Workplane("XY").sphere(radius))
    )
    side = radius - math.hypot(x, 0.25 * x) / 4.0
    contact = PartContact(surfaces_of(read(dome.val().wrapped), WORLD))
    tool = flat(14.0)(flute=40.0)
    beside = [(x + 7.0, y, 0.5 * side) for y in (-x, x)]
    depth = contact.along(moves_of([program_section(tool, beside)])).depth[-1]
    assert depth[0] <= tolerance.CONTACT_BOUND
    into = [(at - 0.01, y, z) for at, y, z in beside]
    deeper = contact.along(moves_of([program_section(tool, into)])).depth[-1]
    assert deeper[0] == approx(0.01, abs=tolerance.CONTACT_BOUND)
