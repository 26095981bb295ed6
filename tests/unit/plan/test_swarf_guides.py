"""Guide lines of swarf milling in closed form: funnels of leaning planes, cones and cylinders; a flank on their rulings enters nothing."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from funnels import HEIGHT, SIDES, edges, funnel, planes
from trunnion.geometry.sheet.skin import Skin
from trunnion.plan.freeform.swarf.feet import border_of, depths
from trunnion.plan.freeform.swarf.flank import first_fitting, flank_poses
from trunnion.plan.freeform.swarf.guide_lines import GuideLine, guide_lines
from trunnion.plan.freeform.swarf.level_sections import level_sections
from verify_tools import bull, flat


def round_pocket(foot: float, lean: float, count: int = 240) -> Skin:
    """Return the skin of a round pocket of a radius at its foot whose wall is a cone (lean 0: a cylinder) round z."""
    angle = np.linspace(0.0, 2.0 * math.pi, count, endpoint=False)
    a = math.radians(lean)
    out = np.column_stack([np.cos(angle), np.sin(angle)])
    low, high = (r * out for r in (foot, foot + HEIGHT * math.tan(a)))
    points = np.vstack(
        [np.column_stack([low, np.zeros(count)]), np.column_stack([high, np.full(count, HEIGHT)])]
    )
    normal = np.column_stack([-math.cos(a) * out, np.full(count, math.sin(a))])
    k = np.arange(count)
    n = (k + 1) % count
    triangles = np.vstack(
        [np.column_stack([k, n, n + count]), np.column_stack([k, n + count, k + count])]
    )
    return Skin(
        points=points,
        normals=np.vstack([normal, normal]),
        triangles=triangles[:, ::-1],
        face=np.full(2 * count, 1),
        bound=0.0,
    )


def one_line(skin: Skin, faces: tuple[int, ...], z: float, radius: float) -> GuideLine:
    (section,) = level_sections(skin, faces, z)
    (line,) = guide_lines(section, radius)
    return line


def test_a_section_goes_round_a_pocket_with_the_material_on_its_right() -> None:
    (section,) = level_sections(funnel((5.0, 5.0, 5.0, 5.0)), (1, 2, 3, 4), 10.0)
    assert section.closed and section.point[:, 2] == pytest.approx(10.0)
    assert sorted(int(section.face[rows][0]) for rows in section.runs()) == [1, 2, 3, 4]
    x, y = section.point[:, 0], section.point[:, 1]
    # What is free on the left: anticlockwise, a positive area by the trapezoids.
    assert 0.5 * float((x[:-1] * y[1:] - x[1:] * y[:-1]).sum()) > 0.0
    assert np.linalg.norm(section.normal, axis=1) == pytest.approx(1.0)


def test_a_section_of_some_walls_is_open() -> None:
    (section,) = level_sections(funnel((5.0, 5.0, 5.0, 5.0)), (1, 2), 10.0)
    assert not section.closed and set(section.face.tolist()) == {1, 2}
    assert level_sections(funnel((5.0, 5.0, 5.0, 5.0)), (1, 2), HEIGHT + 1.0) == []


# Floats in a tuple count as slow on a busy machine.
@settings(suppress_health_check=[HealthCheck.too_slow])
@given(
    st.tuples(*(st.floats(-12.0, 14.0) for _ in SIDES)),
    st.floats(1.0, 6.0),
    st.floats(2.0, 28.0),
    st.floats(0.0, 1.0),
)
def test_a_flank_on_the_rulings_of_planes_touches_its_own_and_enters_none(
    leans: tuple[float, ...], radius: float, z: float, corner: float
) -> None:
    skin, (foot, normals) = funnel(leans), planes(leans)
    line = one_line(skin, (1, 2, 3, 4), z, radius)
    tool = bull(2.0 * radius, corner * 0.9 * radius)(flute=HEIGHT)
    tip, axis = flank_poses(line.point, line.normal, line.ruling, tool)
    assert line.closed
    # The cylinder's middle line, from where the corner ends up to the rim, keeps the radius from every wall.
    for up in (tool.corner_radius, HEIGHT - z):
        middle = tip + up * axis
        off = ((middle[:, None] - foot[None]) * normals[None]).sum(axis=2)
        assert (off >= radius - 1e-7).all()
        assert off[np.arange(len(line)), line.face - 1] == pytest.approx(radius, abs=1e-7)


def test_a_flank_comes_to_an_inner_edge_along_it() -> None:
    leans = (6.0, -5.0, 6.0, -5.0)
    line = one_line(funnel(leans), (1, 2, 3, 4), 10.0, 4.0)
    up = edges(planes(leans)[1])
    for k in range(4):
        rows = np.flatnonzero(line.face == k + 1)
        first = rows[
            np.argmin(
                np.linalg.norm(line.point[rows] - (planes(leans)[0][k] + 10.0 * up[k]), axis=1)
            )
        ]
        assert np.cross(line.ruling[first], up[k]) == pytest.approx(0.0, abs=1e-9)


def test_a_flank_stays_on_the_steepest_line_far_from_edges() -> None:
    leans = (6.0, -5.0, 6.0, -5.0)
    line = one_line(funnel(leans, 3.0), (1, 2, 3, 4), 10.0, 4.0)
    middle = np.flatnonzero(line.face == 1)
    row = middle[len(middle) // 2]
    steepest = np.array([0.0, 0.0, 1.0]) - line.normal[row, 2] * line.normal[row]
    assert line.ruling[row] == pytest.approx(steepest / np.linalg.norm(steepest), abs=1e-9)


@pytest.mark.parametrize("lean", [-8.0, 0.0, 9.0])
def test_the_rulings_of_a_round_wall_lie_on_it(lean: float) -> None:
    skin = round_pocket(40.0, lean)
    line = one_line(skin, (1,), 12.0, 5.0)
    assert line.closed
    # On a cone with the apex A all rulings go through A; a cylinder's stand upright.
    a = math.radians(lean)
    out = line.point[:, :2] / np.linalg.norm(line.point[:, :2], axis=1, keepdims=True)
    wanted = np.column_stack([math.sin(a) * out, np.full(len(line), math.cos(a))])
    assert line.ruling == pytest.approx(wanted, abs=2e-3)
    assert (line.ruling * line.normal).sum(axis=1) == pytest.approx(0.0, abs=1e-4)


def test_walls_go_down_along_their_rulings_to_their_foot() -> None:
    leans = (6.0, -5.0, 3.0, 0.0)
    skin = funnel(leans)
    line = one_line(skin, (1, 2, 3, 4), 10.0, 4.0)
    deep = depths(line, border_of(skin, (1, 2, 3, 4)))
    assert deep == pytest.approx(10.0 / line.ruling[:, 2], abs=1e-6)


def test_edges_between_walls_that_are_milled_together_are_no_border() -> None:
    skin = funnel((6.0, -5.0, 3.0, 0.0))
    assert len(border_of(skin, (1, 2, 3, 4))) == 8
    assert len(border_of(skin, (1,))) == 4


def test_the_first_cutter_that_has_room_is_taken() -> None:
    skin = funnel((6.0, -5.0, 3.0, 0.0))

    def query_for(tool):
        return lambda tip, axis: np.full(len(tip), tool.diameter <= 12.0)

    tools = [flat(d)() for d in (16.0, 12.0, 8.0)]
    chosen = first_fitting(skin, (1, 2, 3, 4), tools, query_for, 0.97)
    assert chosen is not None and chosen.diameter == 12.0
    assert first_fitting(skin, (1, 2, 3, 4), tools[:1], query_for, 0.97) is None
