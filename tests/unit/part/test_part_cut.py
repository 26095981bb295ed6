"""Faces cut in two: by planes and by drawn ways, with areas worked out by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from shaped_parts import bowl, cylinder, face_towards, plate, sphere
from trunnion.findings import BadInput
from trunnion.geometry.cut import curve_cut, plane_cut
from trunnion.part.cut import divided
from trunnion.part.part import Part
from trunnion.part.topology.identity import faces_of
from trunnion.part.topology.measure import area_of


def areas(part: Part, *tags: int) -> list[float]:
    return [area_of(part.face_shape(t)) for t in tags]


def on_cylinder(
    radius: float, *places: tuple[float, float]
) -> tuple[tuple[float, float, float], ...]:
    return tuple((radius * math.cos(a), radius * math.sin(a), z) for a, z in places)


def test_what_lies_behind_the_plane_keeps_the_tag():
    top = face_towards(part := plate(30.0, 20.0, 5.0), 0, 0, 1)
    cut = divided(part, plane_cut(top, (10.0, 0.0, 0.0), (1.0, 0.0, 0.0)))
    assert areas(cut, top, 7) == pytest.approx([200.0, 400.0])
    turned = divided(part, plane_cut(top, (10.0, 0.0, 0.0), (-1.0, 0.0, 0.0)))
    assert areas(turned, top, 7) == pytest.approx([400.0, 200.0])


def test_the_part_stays_closed_and_as_large_and_the_faces_around_keep_their_tags():
    part = plate(30.0, 20.0, 5.0)
    top = face_towards(part, 0, 0, 1)
    cut = divided(part, plane_cut(top, (10.0, 0.0, 0.0), (1.0, 0.3, 0.0)))
    assert (cut.n_faces, cut.tags, cut.is_closed, cut.graph().open_edges) == (
        7,
        (1, 2, 3, 4, 5, 6, 7),
        True,
        0,
    )
    others = [t for t in part.tags if t != top]
    assert areas(cut, *others) == pytest.approx(areas(part, *others))
    assert cut.volume == part.volume
    assert {6, 7} - {top} <= set(cut.mesh().face.tolist())


def test_the_part_that_was_cut_stays_as_it_was():
    part = plate(30.0, 20.0, 5.0)
    top = face_towards(part, 0, 0, 1)
    divided(part, plane_cut(top, (10.0, 0.0, 0.0), (1.0, 0.0, 0.0)))
    assert areas(part, top) == pytest.approx([600.0])
    assert part.graph().open_edges == 0


def test_a_piece_can_be_cut_again():
    part = plate(30.0, 20.0, 5.0)
    top = face_towards(part, 0, 0, 1)
    once = divided(part, plane_cut(top, (10.0, 0.0, 0.0), (1.0, 0.0, 0.0)))
    twice = divided(once, plane_cut(7, (0.0, 5.0, 0.0), (0.0, 1.0, 0.0)))
    assert areas(twice, top, 7, 8) == pytest.approx([200.0, 100.0, 300.0])


def test_a_plane_across_a_cylinder_gives_two_rings():
    cut = divided(cylinder(5.0, 20.0), plane_cut(1, (0.0, 0.0, 5.0), (0.0, 0.0, 1.0)))
    assert areas(cut, 1, 4) == pytest.approx([50.0 * math.pi, 150.0 * math.pi])


def test_pieces_that_hang_apart_are_faces_of_their_own():
    part = plate(30.0, 12.0, 5.0, hole=5.0)
    top = face_towards(part, 0, 0, 1)
    upper_half = divided(part, plane_cut(top, (0.0, 6.0, 0.0), (0.0, -1.0, 0.0)))
    cut = divided(upper_half, plane_cut(top, (0.0, 8.0, 0.0), (0.0, 1.0, 0.0)))
    strip_of_hole = 2.0 * math.sqrt(25.0 - 4.0) + 25.0 * math.asin(2.0 / 5.0)
    legs = 60.0 - strip_of_hole
    rest = (360.0 - 25.0 * math.pi) / 2.0 - legs
    assert areas(cut, top, 9, 10) == pytest.approx([legs / 2.0, legs / 2.0, rest], rel=1e-4)


def test_a_plane_through_a_hole_cuts_on_both_sides_of_it():
    part = plate(30.0, 12.0, 5.0, hole=5.9)
    top = face_towards(part, 0, 0, 1)
    cut = divided(part, plane_cut(top, (15.0, 0.0, 0.0), (1.0, 0.0, 0.0)))
    whole = 30.0 * 12.0 - math.pi * 5.9**2
    assert areas(cut, top, 8) == pytest.approx([whole / 2.0, whole / 2.0], rel=1e-5)


def test_a_drawn_way_is_led_on_to_the_edges_and_its_left_keeps_the_tag():
    part = plate(30.0, 20.0, 5.0)
    top = face_towards(part, 0, 0, 1)
    cut = divided(part, curve_cut(top, ((5.0, 8.0, 5.0), (25.0, 8.0, 5.0))))
    assert areas(cut, top, 7) == pytest.approx([360.0, 240.0])
    back = divided(part, curve_cut(top, ((25.0, 8.0, 5.0), (5.0, 8.0, 5.0))))
    assert areas(back, top, 7) == pytest.approx([240.0, 360.0])


def test_left_is_as_seen_from_outside_below_too():
    part = plate(30.0, 20.0, 5.0)
    bottom = face_towards(part, 0, 0, -1)
    cut = divided(part, curve_cut(bottom, ((5.0, 8.0, 0.0), (25.0, 8.0, 0.0))))
    assert areas(cut, bottom, 7) == pytest.approx([240.0, 360.0])


def test_a_closed_way_cuts_an_area_out():
    part = plate(60.0, 60.0, 5.0)
    top = face_towards(part, 0, 0, 1)
    circle = [
        (30.0 + 10.0 * math.cos(a), 30.0 + 10.0 * math.sin(a), 5.0)
        for a in np.linspace(0.0, 2.0 * math.pi, 33)[:-1]
    ]
    cut = divided(part, curve_cut(top, (*circle, circle[0])))
    assert areas(cut, top, 7) == pytest.approx(
        [100.0 * math.pi, 3600.0 - 100.0 * math.pi], abs=0.01
    )


@pytest.mark.parametrize("start", [0.0, 1.0, 4.0])
def test_a_way_round_a_cylinder_closes_over_its_seam(start):
    ring = on_cylinder(
        5.0,
        *((a, 8.0 + math.sin(2.0 * a)) for a in np.linspace(start, start + 2.0 * math.pi, 25)[:-1]),
    )
    cut = divided(cylinder(5.0, 20.0), curve_cut(1, (*ring, ring[0])))
    assert areas(cut, 1, 4) == pytest.approx([120.0 * math.pi, 80.0 * math.pi], abs=1e-3)


def test_places_of_a_click_need_not_lie_on_the_face():
    part = sphere(10.0)
    ring = tuple(
        (10.05 * math.cos(a) * 0.8, 10.05 * math.sin(a) * 0.8, 6.03)
        for a in np.linspace(0.0, 2.0 * math.pi, 25)[:-1]
    )
    cut = divided(part, curve_cut(1, (*ring, ring[0])))
    assert areas(cut, 1, 2) == pytest.approx([80.0 * math.pi, 320.0 * math.pi], abs=0.01)


def test_the_faces_as_read_are_cut_with_the_part():
    part = bowl(30.0, 30.0, 12.0, 10.0)
    hollow = next(t for t in part.tags if part.graph().surface[t - 1] == "sphere")
    cut = divided(part, plane_cut(hollow, (15.0, 15.0, 8.0), (0.0, 0.0, 1.0)))
    read = faces_of(cut.as_read)
    assert [area_of(read[t - 1]) for t in (hollow, cut.n_faces)] == pytest.approx(
        [120.0 * math.pi, 80.0 * math.pi], rel=1e-5
    )
    assert cut.boundary().length_of(hollow) == pytest.approx(
        2.0 * math.pi * math.sqrt(84.0), rel=1e-5
    )


def test_names_and_colours_of_a_face_are_those_of_its_pieces():
    from dataclasses import replace

    plain = plate(30.0, 20.0, 5.0)
    top = face_towards(plain, 0, 0, 1)
    part = Part(
        replace(plain.facts, names={top: "gas side"}, colours={top: (1.0, 0.0, 0.0)}),
        plain.shape,
        plain.as_read,
    )
    cut = divided(part, plane_cut(top, (10.0, 0.0, 0.0), (1.0, 0.0, 0.0)))
    assert (cut.names[7], cut.colours[7]) == ("gas side", (1.0, 0.0, 0.0))


@pytest.mark.parametrize(
    ("cut", "words"),
    [
        (plane_cut(9, (0.0, 0.0, 0.0), (1.0, 0.0, 0.0)), "no such face; its faces are 1 to 3"),
        (plane_cut(1, (0.0, 0.0, 99.0), (0.0, 0.0, 1.0)), "doesn't divide it"),
        (curve_cut(1, ((0.0, 0.0, 5.0), (0.0, 0.1, 5.0))), "away from the face"),
        (
            curve_cut(1, ((8.0, 0.0, 5.0), (0.0, 5.0, 5.0))),
            "3 mm away from the face; .* nearest place is 5.000 0.000 5.000",
        ),
        (curve_cut(1, ((5.0, 0.0, 5.0), (5.0, 0.0, 5.0))), "fall together"),
    ],
)
def test_a_cut_that_can_not_be_made_is_refused_in_one_line(cut, words):
    with pytest.raises(BadInput, match=words) as refused:
        divided(cylinder(5.0, 20.0), cut)
    assert "\n" not in str(refused.value)


def test_a_plane_without_a_normal_and_a_way_of_one_place_are_refused():
    with pytest.raises(BadInput, match="normal"):
        plane_cut(1, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    with pytest.raises(BadInput, match="needs numbers; got nan 0 0 1 0 0"):
        plane_cut(1, (float("nan"), 0.0, 0.0), (1.0, 0.0, 0.0))
    with pytest.raises(BadInput, match="two places"):
        curve_cut(1, ((0.0, 0.0, 0.0),))


@settings(deadline=None, max_examples=12)
@given(st.floats(0.5, 19.5), st.floats(-1.0, 1.0), st.floats(-1.0, 1.0))
@example(4.0, -1.0, 5.960464477539063e-08)
@example(4.0, -1.0, -1e-7)
@example(12.0, 0.5, 1e-7)
def test_wherever_a_plane_cuts_the_pieces_are_the_whole(height, nx, ny):
    part = cylinder(5.0, 20.0)
    cut = divided(part, plane_cut(1, (0.0, 0.0, height), (nx, ny, 1.5)))
    assert sum(areas(cut, *cut.tags)) == pytest.approx(part.area, rel=1e-5)
    assert cut.graph().open_edges == 0
