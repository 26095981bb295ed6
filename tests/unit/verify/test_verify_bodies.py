"""Convex bodies of every cutter form, against their outlines sampled closely and against forms written anew."""

from __future__ import annotations

import math

import numpy as np
import pytest
from pytest import approx

from trunnion import tolerance
from trunnion.model.tool import Tool
from trunnion.verify.cutter import OVERLAP, bodies_of, lowest_height, outline_of
from trunnion.verify.kernels import body as kernel
from verify_tools import FORMS, flat, joined_supports_of, plain_depth, supports_of, tool_of

EVERY_FORM = pytest.mark.parametrize("tool", FORMS.values(), ids=FORMS)


def cutting(tool: Tool):
    """Return arcs and pieces of what cuts."""
    bodies = bodies_of([tool])
    return bodies.arc, bodies.piece[bodies.piece[:, kernel.KIND] == 0.0]


def sampled_outline(tool, count=400):
    """Return points (k, 2) of the cutting outline, closely along every span."""
    points, share = [], np.linspace(0.0, 1.0, count)
    for r0, z0, r1, z1, cr, cz, radius in outline_of(tool):
        if radius == 0.0:
            points.append(np.column_stack([r0 + share * (r1 - r0), z0 + share * (z1 - z0)]))
            continue
        start = math.atan2(z0 - cz, r0 - cr)
        angle = start + share * math.remainder(math.atan2(z1 - cz, r1 - cr) - start, math.tau)
        points.append(
            np.column_stack([cr + abs(radius) * np.cos(angle), cz + abs(radius) * np.sin(angle)])
        )
    return np.vstack(points)


def depths(arcs, first, last, points):
    return np.array([kernel.depth_in_body(arcs, int(first), int(last), r, h)[0] for r, h in points])


@EVERY_FORM
def test_an_outline_lies_on_its_bodies(tool):
    arcs, pieces = cutting(tool)
    outline = sampled_outline(tool)
    deepest = np.full(len(outline), -np.inf)
    for p in pieces:
        beside = (outline[:, 1] >= p[kernel.Z_LOW] - 1e-9) & (
            outline[:, 1] <= p[kernel.Z_HIGH] + 1e-9
        )
        deepest[beside] = np.maximum(
            deepest[beside], depths(arcs, p[kernel.FIRST], p[kernel.LAST], outline[beside])
        )
    assert deepest == approx(np.zeros(len(outline)), abs=1e-9)


@EVERY_FORM
@pytest.mark.parametrize("rise", [0.0, 3.0])
def test_depths_agree_with_the_distance_to_every_line_that_touches_the_form(tool, rise):
    bodies, random = bodies_of([tool]), np.random.default_rng(7)
    parts = supports_of(tool)
    assert [row[[kernel.Z_LOW, kernel.Z_HIGH, kernel.KIND]].tolist() for row in bodies.piece] == [
        approx(list(part[1:])) for part in parts
    ]
    for part, piece in zip(parts, bodies.piece, strict=True):
        rho, h = (
            random.uniform(0.0, 1.3 * piece[kernel.R_MAX], 200),
            random.uniform(part[1], part[2] + rise, 200),
        )
        found = [
            kernel.swept_depth(bodies.arc, piece, r, z, rise)[0]
            for r, z in zip(rho, h, strict=True)
        ]
        assert found == approx(plain_depth(part, rho, h, rise), abs=1e-9)


@EVERY_FORM
def test_a_closed_body_is_as_deep_as_the_nearest_side_of_the_tool_is_away(tool):
    """Near a joint where the outline bends outwards, as where a holder's cone goes over into its cylinder, that may be its neighbour's."""
    bodies, random = bodies_of([tool]), np.random.default_rng(5)
    for part, piece in zip(joined_supports_of(tool), bodies.piece, strict=True):
        rho, h = (
            random.uniform(0.0, piece[kernel.R_MAX], 400),
            random.uniform(part[1], part[2], 400),
        )
        true = plain_depth(part, rho, h)
        found = depths(
            bodies.arc,
            piece[kernel.CLOSED_FIRST],
            piece[kernel.CLOSED_LAST],
            np.column_stack([rho, h]),
        )
        inside = true > 0.0
        assert np.minimum(found, OVERLAP)[inside] == approx(
            np.minimum(true, OVERLAP)[inside], abs=1e-9
        )


@EVERY_FORM
def test_a_depth_without_a_sweep_is_the_depth_in_the_open_body_and_its_slope_is_the_nearest_normal(
    tool,
):
    bodies, random = bodies_of([tool]), np.random.default_rng(3)
    for piece in bodies.piece:
        for rho, h in zip(
            random.uniform(0.1, 20.0, 40),
            random.uniform(piece[kernel.Z_LOW], piece[kernel.Z_HIGH], 40),
            strict=True,
        ):
            depth, normal_r, normal_h = kernel.depth_in_body(
                bodies.arc, int(piece[kernel.FIRST]), int(piece[kernel.LAST]), rho, h
            )
            assert kernel.swept_depth(bodies.arc, piece, rho, h, 0.0) == approx(
                (depth, -normal_r, -normal_h), abs=1e-12
            )
            assert math.hypot(normal_r, normal_h) == approx(1.0)


@EVERY_FORM
def test_compiled_depths_agree_with_themselves_uncompiled(tool):
    bodies = bodies_of([tool])
    for piece in bodies.piece:
        for rho, h, rise in (
            (0.0, piece[kernel.Z_LOW], 0.0),
            (3.3, piece[kernel.Z_HIGH], 2.0),
            (40.0, 11.0, 5.0),
        ):
            both = [
                f(bodies.arc, piece, rho, h, rise)
                for f in (kernel.swept_depth, kernel.swept_depth.py_func)
            ]
            assert both[0] == approx(both[1], abs=1e-12)


@EVERY_FORM
def test_a_radius_is_where_the_depth_is_nothing(tool):
    arcs, pieces = cutting(tool)
    for p in pieces:
        first, last = int(p[kernel.FIRST]), int(p[kernel.LAST])
        for h in np.linspace(p[kernel.Z_LOW] + 1e-6, p[kernel.Z_HIGH] - 1e-6, 57):
            assert kernel.depth_in_body(
                arcs, first, last, kernel.radius_at(arcs, first, last, h), h
            )[0] == approx(0.0, abs=1e-9)


@EVERY_FORM
def test_radii_are_those_of_the_sampled_outline(tool):
    arcs, pieces = cutting(tool)
    outline = sampled_outline(tool, 4000)
    for h in np.linspace(0.3, tool.flute_length - 0.3, 23):
        widest = max(
            kernel.radius_at(arcs, int(p[kernel.FIRST]), int(p[kernel.LAST]), h)
            for p in pieces
            if p[kernel.Z_LOW] <= h <= p[kernel.Z_HIGH]
        )
        near = np.abs(outline[:, 1] - h) < 0.01
        assert outline[near, 0].min() - 0.05 <= widest <= outline[near, 0].max() + 0.05


@EVERY_FORM
def test_a_body_holds_a_point_between_the_heights_it_names_and_nowhere_else(tool):
    arcs, pieces = cutting(tool)
    random = np.random.default_rng(11)
    for p in pieces:
        first, last, low, high = (
            int(p[kernel.FIRST]),
            int(p[kernel.LAST]),
            p[kernel.Z_LOW],
            p[kernel.Z_HIGH],
        )
        for rho, h in zip(
            random.uniform(0.0, 1.2 * tool.radius, 300), random.uniform(low, high, 300), strict=True
        ):
            below, above = kernel.heights_at(arcs, first, last, low, high, rho)
            depth = kernel.depth_in_body(arcs, first, last, rho, h)[0]
            assert abs(depth) < 1e-9 or (below <= h <= above) == (depth > 0.0)


@EVERY_FORM
def test_cutters_begin_at_the_height_of_the_plain_reference(tool):
    arcs, pieces = cutting(tool)
    p = pieces[0]
    rho = np.linspace(
        0.0,
        kernel.radius_at(arcs, int(p[kernel.FIRST]), int(p[kernel.LAST]), p[kernel.Z_HIGH] / 2)
        - 1e-6,
        17,
    )
    found = [
        kernel.heights_at(
            arcs, int(p[kernel.FIRST]), int(p[kernel.LAST]), p[kernel.Z_LOW], p[kernel.Z_HIGH], r
        )[0]
        for r in rho
    ]
    assert found == approx(lowest_height(tool, rho), abs=1e-9)


@EVERY_FORM
def test_a_closed_body_reaches_as_far_as_its_furthest_point(tool):
    bodies, random = bodies_of([tool]), np.random.default_rng(5)
    for p in bodies.piece:
        first, last = int(p[kernel.CLOSED_FIRST]), int(p[kernel.CLOSED_LAST])
        for angle in random.uniform(-math.pi / 2, math.pi / 2, 20):
            nr, nz = math.cos(angle), math.sin(angle)
            reach = kernel.support(bodies.arc, first, last, nr, nz)
            # Its own plane holds the body: the depth is nothing on it, and the body lies below.
            points = np.column_stack(
                [
                    random.uniform(0.0, 1.1 * p[kernel.R_MAX], 200),
                    random.uniform(p[kernel.Z_LOW] - OVERLAP, p[kernel.Z_HIGH] + OVERLAP, 200),
                ]
            )
            inside = points[depths(bodies.arc, first, last, points) > 0.0]
            assert (inside @ [nr, nz] <= reach + 1e-9).all()
            assert max(depths(bodies.arc, first, last, _along(nr, nz, reach, p))) == approx(
                0.0, abs=0.02
            )


def _along(nr, nz, reach, piece):
    """Return points (k, 2) of the line that a body reaches up to in a direction, beside the body."""
    share = np.linspace(-1.0, 1.0, 4001)[:, None] * (
        piece[kernel.Z_HIGH] + 2.0 * piece[kernel.R_MAX]
    )
    points = reach * np.array([nr, nz]) + share * np.array([-nz, nr])
    return points[points[:, 0] >= 0.0]


def radius_of(bodies, h):
    """Return the largest radius of a whole tool at a height."""
    beside = [p for p in bodies.piece if p[kernel.Z_LOW] - 1e-9 <= h <= p[kernel.Z_HIGH] + 1e-9]
    return max(
        (
            kernel.radius_at(bodies.arc, int(p[kernel.FIRST]), int(p[kernel.LAST]), h)
            for p in beside
        ),
        default=-1.0,
    )


@EVERY_FORM
def test_a_closed_body_stays_inside_the_tool(tool):
    bodies, random = bodies_of([tool]), np.random.default_rng(13)
    for p in bodies.piece:
        first, last = int(p[kernel.CLOSED_FIRST]), int(p[kernel.CLOSED_LAST])
        heights = np.concatenate(
            [
                end + OVERLAP * random.uniform(-1.2, 1.2, 300)
                for end in (p[kernel.Z_LOW], p[kernel.Z_HIGH])
            ]
        )
        points = np.column_stack([random.uniform(0.0, 1.2 * p[kernel.R_MAX], 600), heights])
        inside = points[depths(bodies.arc, first, last, points) > 1e-9]
        assert all(r <= radius_of(bodies, h) for r, h in inside)


@EVERY_FORM
def test_a_closed_body_holds_all_of_its_open_one(tool):
    bodies, random = bodies_of([tool]), np.random.default_rng(17)
    for p in bodies.piece:
        points = np.column_stack(
            [
                random.uniform(0.0, 1.1 * p[kernel.R_MAX], 300),
                random.uniform(p[kernel.Z_LOW], p[kernel.Z_HIGH], 300),
            ]
        )
        opened = depths(bodies.arc, p[kernel.FIRST], p[kernel.LAST], points)
        closed = depths(bodies.arc, p[kernel.CLOSED_FIRST], p[kernel.CLOSED_LAST], points)
        assert ((opened > 1e-9) == (closed > 1e-9)).all()


def test_pieces_above_the_flutes_are_free_where_their_neighbour_is_thinner():
    # Neck 4.5, shank 5, holder from 12 to 20, then 20: free ends are the flutes' top, the shank's and the holder's nose, the holder's top.
    bodies = bodies_of([flat(10.0)(flute=5.0)])
    low = [
        bool((bodies.arc[int(p[kernel.FIRST]) : int(p[kernel.LAST]), kernel.A0Z] == -1.0).any())
        for p in bodies.piece
    ]
    high = [
        bool((bodies.arc[int(p[kernel.FIRST]) : int(p[kernel.LAST]), kernel.A1Z] == 1.0).any())
        for p in bodies.piece
    ]
    assert bodies.piece[:, kernel.KIND].tolist() == [0.0, 1.0, 1.0, 1.0, 1.0]
    assert low == [True, False, True, True, False]
    assert high == [True, False, False, False, True]


@EVERY_FORM
def test_every_arc_looks_down_or_up(tool):
    arcs = bodies_of([tool]).arc
    assert not ((arcs[:, kernel.A0Z] < -1e-9) & (arcs[:, kernel.A1Z] > 1e-9)).any()


def test_a_hollow_outline_is_cut_into_bodies_that_are_at_most_a_quarter_of_the_bound_too_large():
    # A quarter circle of radius 4, bent inwards, from (3, 1) up to (7, 5): a corner-rounding cutter.
    tool = tool_of(
        "form",
        diameter=14.0,
        flute_length=10.0,
        outline=(
            (3.0, 0.0, 0.0),
            (3.0, 1.0, -math.tan(math.pi / 8)),
            (7.0, 5.0, 0.0),
            (7.0, 10.0, 0.0),
        ),
    )
    arcs, pieces = cutting(tool)
    assert len(pieces) > 2
    for angle in np.linspace(math.pi / 2, math.pi, 33)[1:-1]:
        r, h = 7.0 + 4.0 * math.cos(angle), 1.0 + 4.0 * math.sin(angle)
        deepest = max(
            kernel.depth_in_body(arcs, int(p[kernel.FIRST]), int(p[kernel.LAST]), r, h)[0]
            for p in pieces
            if p[kernel.Z_LOW] <= h <= p[kernel.Z_HIGH]
        )
        assert -1e-9 <= deepest <= tolerance.CONTACT_BOUND / 4


@pytest.mark.parametrize("form", ["ball", "bull", "t-slot"])
def test_flutes_as_long_as_the_corner_is_high_have_no_flank(form):
    corner = {"ball": 5.0, "bull": 2.0, "t-slot": 2.0}[form]
    tool = tool_of(form, corner_radius=corner, flute_length=4.0 if form == "t-slot" else corner)
    bodies = bodies_of([tool])
    assert np.isfinite(bodies.arc).all()
    for rho in (0.0, 2.9, 4.0, 4.99):
        under = corner - math.sqrt(max(corner**2 - max(rho - 5.0 + corner, 0.0) ** 2, 0.0))
        depth, _, _ = kernel.depth_in_body(
            bodies.arc,
            int(bodies.piece[0, kernel.FIRST]),
            int(bodies.piece[0, kernel.LAST]),
            rho,
            under,
        )
        assert depth == approx(0.0, abs=1e-9)


@pytest.mark.parametrize(
    ("form", "fields"),
    [
        ("ball", {"corner_radius": 5.0, "flute_length": 3.0}),
        ("bull", {"corner_radius": 2.0, "flute_length": 1.9}),
        ("taper", {"corner_radius": 4.0, "taper_angle": 10.0, "flute_length": 3.0}),
        ("barrel", {"corner_radius": 1.0, "barrel_radius": 10.0, "flute_length": 30.0}),
    ],
)
def test_flutes_that_end_inside_the_corner_or_beyond_a_barrel_are_refused(form, fields):
    with pytest.raises(ValueError, match="flutes"):
        tool_of(form, **fields)
