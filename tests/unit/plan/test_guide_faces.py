"""A plane drive on the faces that a person gave its operation: the runs of its guide lines, and what only keeps the cutter off."""

from __future__ import annotations

import numpy as np
import pytest

from trunnion.findings import Refused
from trunnion.geometry.plane.curve import Curve
from trunnion.geometry.plane.region import Region
from trunnion.model.guides import GuideChain, GuideKind, LinkRelation
from trunnion.plan.plane_guides import GuideSpace
from trunnion.plan.prismatic.drive import DriveLevel, Floor, PlaneDrive, WallGuide
from trunnion.plan.prismatic.guide_faces import on_guide_faces

BELOW, RIGHT, ABOVE, LEFT = 1, 2, 3, 4
"""Tags of the walls of a pocket of 10 by 6 mm, in the order that its loop runs."""
CORNERS = np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 6.0], [0.0, 6.0]])


def faces_at(points, faces):
    """Return the wall that points lie on; none at x = 0, for the left wall is open."""
    x, y = points[:, 0], points[:, 1]
    on = np.select([y < 0.1, x > 9.9, y > 5.9], [BELOW, RIGHT, ABOVE], 0)
    return np.where(np.isin(on, faces), on, 0)


SPACE = GuideSpace(lambda points: points, faces_at)


def pocket(curve: Curve | None = None, **given) -> PlaneDrive:
    area = Region.of([Curve.polygon(CORNERS)])
    level = DriveLevel(top=0.0, bottom=-5.0, wanted=area, boundary=area)
    wall = WallGuide(
        curve=curve or Curve.polygon(CORNERS),
        top=0.0,
        bottom=-5.0,
        fillet=1.0,
        faces=(BELOW, RIGHT, ABOVE, LEFT, 8),
    )
    return PlaneDrive(feature="pocket-01", kind="wall", levels=(level,), walls=(wall,), **given)


def led(drive: PlaneDrive, *faces: int) -> PlaneDrive:
    return on_guide_faces(drive, "wall-pocket-01", faces, SPACE)


def test_a_guide_line_on_all_its_faces_stays_as_it_is() -> None:
    drive = pocket()
    assert led(drive, BELOW, RIGHT, ABOVE).walls == drive.walls


def test_a_wall_that_is_left_out_opens_the_loop() -> None:
    (run,) = led(pocket(), BELOW, ABOVE).walls
    assert not run.curve.closed and run.curve.length == pytest.approx(26.0)
    assert run.curve.start.tolist() == [10.0, 6.0] and run.curve.end.tolist() == [10.0, 0.0]
    assert run.loop.closed and not run.is_around


def test_what_lies_on_no_face_goes_with_the_faces_next_to_it() -> None:
    (run,) = led(pocket(), BELOW).walls
    assert run.curve.length == pytest.approx(10.0)
    (run,) = led(pocket(), RIGHT, ABOVE).walls
    assert run.curve.length == pytest.approx(16.0)


def test_an_open_line_is_not_joined_over_its_ends() -> None:
    drive = pocket(Curve(CORNERS[[3, 2, 1, 0]], np.zeros(4), False))
    first, last = led(drive, ABOVE, BELOW).walls
    assert (first.curve.length, last.curve.length) == pytest.approx((10.0, 10.0))
    assert led(drive, ABOVE, RIGHT, BELOW).walls == drive.walls


def test_a_wall_without_faces_of_its_own_keeps_the_cutter_off_its_foot() -> None:
    hole = Curve.polygon(np.array([[4.0, 2.0], [4.0, 4.0], [6.0, 4.0], [6.0, 2.0]]))
    island = WallGuide(curve=hole, top=-2.0, bottom=-5.0, fillet=2.0, faces=(11,))
    drive = pocket()
    both = PlaneDrive(
        feature="pocket-01", kind="wall", levels=drive.levels, walls=(*drive.walls, island)
    )
    made = led(both, BELOW, RIGHT, ABOVE)
    assert made.walls == drive.walls and made.beside == (island,)


def test_floors_are_those_among_the_faces_or_all_for_an_operation_on_walls() -> None:
    area = Region.of([Curve.polygon(CORNERS)])
    floors = tuple(Floor(z=z, region=area, fillet=0.0, face=f) for z, f in ((-2.0, 20), (-5.0, 21)))
    drive = pocket(floors=floors)
    assert led(drive, BELOW).floors == floors
    made = led(drive, 21)
    assert made.floors == floors[1:] and made.walls == ()


def test_without_any_of_its_faces_it_is_refused() -> None:
    with pytest.raises(Refused, match="no guide line is on its faces"):
        led(pocket(), 99)


def test_elements_say_how_the_tool_goes_on_and_what_it_comes_to() -> None:
    line = led(pocket(), BELOW, RIGHT).walls[0].line(GuideKind.WALL, SPACE)
    assert list(line.chain.elements()) == [
        ("GOFWD", BELOW, LinkRelation.TO, RIGHT),
        ("GOLFT", RIGHT, None, 0),
    ]
    (closed,) = (w.line(GuideKind.WALL, SPACE) for w in pocket().walls)
    assert list(closed.chain.elements())[-1] == ("GOLFT", 0, LinkRelation.TO, BELOW)


def test_a_round_wall_is_one_element_that_goes_on_to_itself() -> None:
    everywhere = GuideSpace(lambda points: points, lambda points, _: np.full(len(points), 5))
    wall = WallGuide(
        curve=Curve.circle((0.0, 0.0), 4.0), top=0.0, bottom=-3.0, fillet=0.0, faces=(5,)
    )
    chain = wall.line(GuideKind.WALL, everywhere).chain
    assert list(chain.elements()) == [("GOFWD", 5, LinkRelation.TANGENT, 5)]


def test_a_chain_has_a_link_between_each_two_elements() -> None:
    with pytest.raises(ValueError, match="2 elements have 1 links"):
        GuideChain(kind=GuideKind.WALL, on=(1, 2))
    with pytest.raises(ValueError, match="2 elements have 2 links"):
        GuideChain(kind=GuideKind.WALL, closed=True, on=(1, 2), relations=(LinkRelation.TO,))
