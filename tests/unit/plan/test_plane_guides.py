"""Guide lines: how the elements of a wall's line follow each other, and what leads each class of drive."""

from __future__ import annotations

import math

import numpy as np
import pytest

from trunnion.geometry.development import Development
from trunnion.geometry.frame import WORLD, Frame
from trunnion.geometry.plane.curve import Curve
from trunnion.geometry.plane.region import Region
from trunnion.model.guides import MOVES, GuideKind, LinkRelation
from trunnion.plan.holes.drive import HoleDrive
from trunnion.plan.holes.hole import PlannedHole
from trunnion.plan.plane_guides import GuideSpace, relations_along, wall_line
from trunnion.plan.prismatic.drive import DriveLevel, Floor, PlaneDrive, WallGuide
from trunnion.plan.turning.drive import RevolvedDrive
from trunnion.plan.turning.gap_drive import GapDrive, GapPass

SQUARE = np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 6.0], [0.0, 6.0]])


def nowhere(points, faces):
    return np.zeros(len(points), dtype=int)


same = GuideSpace(lambda points: points, nowhere)
"""The part's coordinates, and no face known."""


@pytest.mark.parametrize(
    ("points", "link"), [(SQUARE, LinkRelation.TO), (SQUARE[::-1], LinkRelation.PAST)]
)
def test_in_a_pocket_a_pass_comes_to_the_next_wall_and_round_an_island_past_the_end(
    points, link
) -> None:
    corners, relations = relations_along(Curve.polygon(points))
    assert relations == (link,) * 4
    assert {tuple(c) for c in corners.tolist()} == {tuple(c) for c in SQUARE.tolist()}
    assert MOVES[link] == ("GOLFT" if link is LinkRelation.TO else "GORGT")


def test_rounded_corners_are_gone_round_tangentially() -> None:
    (rounded,) = Region.of([Curve.polygon(SQUARE)]).offset(-2.0).offset(2.0).curves()
    corners, relations = relations_along(rounded)
    assert relations == (LinkRelation.TANGENT,) * len(corners) and len(corners) == 8
    assert MOVES[LinkRelation.TANGENT] == "GOFWD"


def test_an_open_line_has_no_corner_at_its_ends() -> None:
    bent = Curve(np.array([[0.0, 0.0], [5.0, 0.0], [5.0, 5.0], [9.0, 5.0]]), np.zeros(4), False)
    corners, relations = relations_along(bent)
    assert corners.tolist() == [[5.0, 0.0], [5.0, 5.0]] and relations == (
        LinkRelation.TO,
        LinkRelation.PAST,
    )


def test_lines_lie_where_the_setup_stands() -> None:
    frame = Frame(origin=[1.0, 2.0, 3.0], x=[0.0, 1.0, 0.0], z=[1.0, 0.0, 0.0])
    space = GuideSpace(frame.to_world, nowhere)
    on = np.array([7, 7, 8, 0])
    line = wall_line(GuideKind.WALL, Curve.polygon(SQUARE), -4.0, on, (7, 8), space)
    assert frame.to_local(line.points)[:, 2] == pytest.approx(-4.0)
    assert line.length == pytest.approx(32.0) and line.chain.faces == (7, 8)
    assert np.array_equal(line.points[0], line.points[-1])


def plane_drive(**given) -> PlaneDrive:
    area = Region.of([Curve.polygon(SQUARE)])
    level = DriveLevel(top=0.0, bottom=-5.0, wanted=area, boundary=area)
    return PlaneDrive(feature="pocket-01", kind="rough", levels=(level,), **given)


def test_a_plane_drive_shows_walls_feet_and_floors_or_what_is_cleared() -> None:
    wall = WallGuide(
        curve=Curve.polygon(SQUARE), top=0.0, bottom=-5.0, fillet=0.0, faces=(1, 2, 3, 4)
    )
    floor = Floor(z=-5.0, region=Region.of([Curve.polygon(SQUARE)]), fillet=0.0, face=9)
    lines = plane_drive(walls=(wall,), beside=(wall,), floors=(floor,)).guides(same)
    assert [line.kind for line in lines] == [GuideKind.WALL, GuideKind.FOOT, GuideKind.AREA]
    assert lines[0].chain.faces == (1, 2, 3, 4) and lines[2].chain.faces == (9,)
    (cleared,) = plane_drive().guides(same)
    assert cleared.kind is GuideKind.AREA and cleared.points[:, 2] == pytest.approx(-5.0)


def test_holes_show_their_axes() -> None:
    hole = PlannedHole(
        feature="hole-01", x=3.0, y=4.0, top=0.0, bottom=-12.0, diameter=6.0, through=True
    )
    (line,) = HoleDrive(kind="drill", holes=(hole,)).guides(same)
    assert line.kind is GuideKind.AXIS and line.points.tolist() == [[3, 4, 0], [3, 4, -12]]


def test_turning_shows_its_contour_and_the_arcs_in_its_gaps() -> None:
    outline = np.array([[10.0, 0.0], [20.0, 0.0], [20.0, -5.0], [10.0, -5.0]])
    (line,) = RevolvedDrive(part=outline, to_cut=1.0).guides(same)
    assert line.kind is GuideKind.CONTOUR and line.length == pytest.approx(30.0)
    ground = Development(frame=WORLD, radius=50.0, height=0.0, slope=0.0, middle=0.0)
    one = GapPass(along=7.0, lift=2.0, gaps=((0.1, 0.6), (1.0, 1.5)))
    arcs = GapDrive(development=ground, passes=(one,), clearance=5.0).guides(same)
    assert len(arcs) == 2
    for arc in arcs:
        assert np.hypot(*arc.points[:, :2].T) == pytest.approx(50.0)
        assert arc.length == pytest.approx(25.0, rel=1e-3)
        assert arc.points[:, 2] == pytest.approx(7.0) and math.isfinite(arc.length)
