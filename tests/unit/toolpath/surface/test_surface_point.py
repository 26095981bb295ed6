"""Point milling: blocks of a leaning cutter stay within the chord error of faces in closed form, and the strategy says what it leaves."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from pytest import approx

from leaning_tools import EVERY_FORM, PlainCutter, contact_of, cutter, leaning_section
from surface_drives import DATA, driven, grid
from trunnion.findings import BadInput, Refused
from trunnion.geometry.frame import WORLD, Frame
from trunnion.model.motion.toolpath import Motion
from trunnion.pipeline.planning.clearance import ToolClearanceQuery
from trunnion.settings import choose
from trunnion.toolpath.contact_passes.axis_fields import fixed, leaning
from trunnion.toolpath.contact_passes.axis_search import LeanLimits, thickened
from trunnion.toolpath.contact_passes.contacts import Contacts, slerp
from trunnion.toolpath.contact_passes.passes import UPRIGHT
from trunnion.toolpath.contact_passes.run_poses import ASTRAY
from trunnion.toolpath.stock.remaining import RemainingStock
from trunnion.toolpath.surface.point import PointSettings, field_of, grooving, milled, point

CHORD = 0.0005
LEAD = leaning(math.radians(20.0), math.radians(5.0))
BALL = cutter("ball", diameter=6.0, corner=3.0, flute=12.0)
LONG = replace(BALL, stickout=90.0, gauge_length=150.0)


def unit(v):
    return v / np.linalg.norm(v, axis=1, keepdims=True)


def helix(radius, turns=2.0, n=181):
    angle = np.linspace(0.0, 2.0 * np.pi * turns, n)
    out = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(n)])
    return Contacts(point=radius * out + np.outer(angle, [0.0, 0.0, 0.1]), normal=out)


def over_sphere(radius, n=121):
    angle = np.linspace(-1.0, 1.0, n)
    out = unit(np.column_stack([np.sin(angle), 0.3 * np.cos(2.0 * angle), np.cos(angle)]))
    return Contacts(point=radius * out, normal=out)


def over_saddle(n=181):
    """Across the ruled saddle z = x y / 20."""
    x = np.linspace(-12.0, 12.0, n)
    y = 6.0 * np.sin(0.3 * x) + 0.4 * x
    return Contacts(
        point=np.column_stack([x, y, x * y / 20.0]),
        normal=unit(np.column_stack([-y / 20.0, -x / 20.0, np.ones(n)])),
    )


def to_saddle(points):
    """Return how far points (k, 3) are from the saddle: the feet by Newton's method."""
    foot = points[:, :2].copy()
    for _ in range(30):
        x, y = foot.T
        z = x * y / 20.0 - points[:, 2]
        g = np.column_stack([x - points[:, 0] + z * y / 20.0, y - points[:, 1] + z * x / 20.0])
        a, b, d = 1.0 + (y / 20.0) ** 2, z / 20.0 + x * y / 400.0, 1.0 + (x / 20.0) ** 2
        foot -= (
            np.column_stack([d * g[:, 0] - b * g[:, 1], a * g[:, 1] - b * g[:, 0]])
            / (a * d - b * b)[:, None]
        )
    return np.linalg.norm(points - np.column_stack([foot, foot[:, 0] * foot[:, 1] / 20.0]), axis=1)


def centres(one, radius, shares=9):
    """Return the ball's centres (k, 3) all along a pass."""
    found = []
    for share in np.linspace(0.0, 1.0, shares):
        axis = slerp(one.axis[:-1], one.axis[1:], np.full(len(one) - 1, share))
        found.append(one.tip[:-1] + share * np.diff(one.tip, axis=0) + radius * axis)
    return np.vstack(found)


FACES = {
    "cylinder": (helix(8.0), lambda p: np.hypot(p[:, 0], p[:, 1]) - 8.0),
    "blade's edge": (helix(0.5), lambda p: np.hypot(p[:, 0], p[:, 1]) - 0.5),
    "sphere": (over_sphere(20.0), lambda p: np.linalg.norm(p, axis=1) - 20.0),
    "ruled saddle": (over_saddle(), to_saddle),
}


@pytest.mark.parametrize("face", FACES)
def test_a_ball_stays_within_the_chord_error_of_a_face_all_along_its_blocks(face: str) -> None:
    way, distance = FACES[face]
    done = milled([way], BALL, LEAD, None, LeanLimits(turn=math.radians(40.0)), CHORD)
    off = np.concatenate([distance(centres(one, BALL.radius)) for one in done.passes]) - BALL.radius
    assert done.remaining == approx(0.0, abs=1e-9)
    # Between contacts the way is a cubic: it leaves the face by a little.
    assert np.abs(off).max() < 1.2 * CHORD + 2e-5


def test_blocks_are_as_long_as_the_chord_error_and_the_axis_allow() -> None:
    way = helix(8.0)
    done = {
        chord: milled([way], BALL, LEAD, None, LeanLimits(turn=math.radians(40.0)), chord).passes
        for chord in (CHORD, 16.0 * CHORD)
    }
    fine, coarse = (sum(len(one) - 1 for one in some) for some in done.values())
    # The arc over a block rises with the square of its length: 16 times the error, blocks 4 times as long, but for halving's steps.
    assert 2.0 <= fine / coarse <= 8.0
    plane = Contacts(
        point=np.column_stack([np.linspace(0.0, 60.0, 61), np.zeros(61), np.zeros(61)]),
        normal=np.tile([0.0, 0.0, 1.0], (61, 1)),
    )
    (straight,) = milled([plane], BALL, LEAD, None, LeanLimits(), CHORD).passes
    assert len(straight) - 1 <= 5
    # Over a plane only the axis bends: it goes from one side to the other and back.
    swing = math.radians(20.0)

    def swung(point, normal, feed):
        angle = swing * np.sin(point[:, 0] / 10.0)
        return np.column_stack([np.zeros(len(point)), np.sin(angle), np.cos(angle)])

    (leaning_over,) = milled([plane], BALL, swung, None, LeanLimits(), CHORD).passes
    (finely,) = milled([plane], BALL, swung, None, LeanLimits(), 0.01 * CHORD).passes
    assert len(straight) < len(leaning_over) < 61
    turned = slerp(
        leaning_over.axis[:-1], leaning_over.axis[1:], np.full(len(leaning_over) - 1, 0.5)
    )
    middle = 0.5 * (leaning_over.tip[:-1] + leaning_over.tip[1:]) + BALL.radius * turned
    there = np.column_stack(
        [
            np.interp(middle[:, 0], (finely.tip + BALL.radius * finely.axis)[:, 0], a)
            for a in finely.axis.T
        ]
    )
    assert np.arccos(np.clip((turned * unit(there)).sum(axis=1), -1.0, 1.0)).max() < 1.1 * ASTRAY


def test_a_long_block_that_touches_something_is_tried_in_short_ones_before_it_is_left() -> None:
    plane = Contacts(
        point=np.column_stack([np.linspace(0.0, 60.0, 61), np.zeros(61), np.zeros(61)]),
        normal=np.tile([0.0, 0.0, 1.0], (61, 1)),
    )

    def short_moves_only(tip, axis, *, start_tip=None, start_axis=None):
        return np.linalg.norm(tip - (tip if start_tip is None else start_tip), axis=1) < 2.0

    done = milled([plane], BALL, LEAD, short_moves_only, LeanLimits(), CHORD)
    assert done.remaining == 0.0 and not done.rest


@pytest.mark.parametrize("form", ["bull", "taper", "barrel"])
def test_any_form_of_cutter_touches_a_cylinder_within_the_chord_error(form: str) -> None:
    tool, chord, radius = EVERY_FORM[form], 0.002, 25.0
    way = helix(radius, turns=0.2, n=41)
    (one,) = milled([way], tool, LEAD, None, LeanLimits(), chord).passes
    section, plain = leaning_section(tool, one.tip, one.axis), PlainCutter(tool)
    for block in range(2, len(one), max(1, len(one) // 6)):
        # The cylinder's points about the middle of the block: none deeper than the chord error, and the nearest touched.
        middle = 0.5 * (one.tip[block] + one.tip[block - 1])
        angle = math.atan2(middle[1], middle[0])
        near = [
            plain.nearest(
                section,
                block,
                np.array([radius * math.cos(a), radius * math.sin(a), z]),
                rounds=3,
                steps=40,
            )
            for a in angle + np.linspace(-0.12, 0.12, 9)
            for z in way.point[:, 2].mean() + np.linspace(-1.0, 1.0, 5)
        ]
        assert min(near) > -1.5 * chord
    assert np.abs(np.linalg.norm(one.axis, axis=1) - 1.0).max() < 1e-12


def test_an_allowance_is_kept() -> None:
    way, distance = FACES["cylinder"]
    done = milled([way], BALL, LEAD, None, LeanLimits(), CHORD, allowance=0.2)
    off = np.concatenate([distance(centres(one, BALL.radius)) for one in done.passes]) - BALL.radius
    assert off.min() > 0.2 - 1.2 * CHORD and off.max() < 0.2 + 1.2 * CHORD


def test_blocks_are_no_shorter_than_they_need_be() -> None:
    way = helix(8.0)
    (one,) = milled(
        [way], BALL, fixed([0.0, 0.0, 1.0]), None, LeanLimits(steepest=math.radians(95.0)), CHORD
    ).passes
    # Chords of a circle of 8 + 3 mm that leave it by the chord error.
    fewest = 2.0 * math.pi * 2.0 / (2.0 * math.acos(1.0 - CHORD / 11.0))
    assert fewest <= len(one) < 2.5 * fewest


def test_a_ball_grooves_as_itself_and_a_bull_that_leads_as_a_wider_one() -> None:
    assert grooving(BALL, 0.2, 0.1).radius == approx(3.0)
    bull, lead = EVERY_FORM["bull"], math.radians(10.0)
    # Across the feed the corner's circle is as round as (R - r) / sin(lead) + r.
    assert grooving(bull, lead, 0.0).radius == approx(3.0 / math.sin(lead) + 2.0)
    assert grooving(bull, 0.0, lead).radius == approx(2.0)
    assert grooving(EVERY_FORM["barrel"], 0.0, math.radians(80.0)).radius == approx(60.0)


class Boxes:
    """Boxes to touch on a machine that holds every axis."""

    def __init__(self, *boxes):
        self._contact = contact_of(*boxes)

    def holds(self, axis):
        return np.ones(len(axis), bool)

    def clear(self, moves):
        return self._contact.clear(moves, 0.006)

    def __call__(self, tool):
        return ToolClearanceQuery(self, thickened(tool, 0.2))


FLOOR = ((-60.0, -60.0, -9.0), (90.0, 90.0, 0.0))
WALL = ((-60.0, 10.0, 0.0), (90.0, 40.0, 50.0))


def strip(high=8.0):
    drive, setup, stock = driven(grid(lambda x, y: 0.0 * x, n=12, high=(20.0, high)), height=0.05)
    return drive, setup, stock


def planned(ask, tool=BALL, high=8.0, **chosen):
    drive, setup, stock = strip(high)
    return point(
        replace(drive, query_for=ask), tool, DATA, stock, setup, choose(PointSettings, chosen)
    ), setup


def test_a_path_begins_with_a_rapid_and_begins_and_ends_above_everything() -> None:
    plan, setup = planned(Boxes(FLOOR))
    path = plan.path
    assert path.motion[0] == Motion.RAPID and (path.position[[0, -1], 2] >= setup.clearance).all()
    assert (np.abs(np.linalg.norm(path.axis, axis=1) - 1.0) < 1e-9).all()
    assert not plan.findings


def test_beside_a_wall_everything_is_cut_and_nothing_touched() -> None:
    ask = Boxes(FLOOR, WALL)
    plan, _ = planned(ask, tool=LONG, high=6.0)
    path = plan.path
    assert ask(LONG)(
        path.position[1:], path.axis[1:], start_tip=path.position[:-1], start_axis=path.axis[:-1]
    ).all()
    assert not [f for f in plan.findings if f.code != "point.low"]
    # Close to the wall the tool leans away from it.
    beside = path.position[:, 1] > 5.0
    assert (path.axis[beside & (path.mark == 0), 1] < 0.1).all()


def test_what_no_lean_reaches_is_a_finding_with_its_area() -> None:
    roof = ((-60.0, -60.0, 5.0), (12.0, 60.0, 90.0))
    plan, _ = planned(Boxes(FLOOR, roof), steepest=50.0)
    (left,) = [f for f in plan.findings if f.code == "point.left"]
    # Under the roof's 12 mm, and where the holder would stand in it; 160 are all of it.
    assert 80.0 < float(left.text.split()[0]) < 160.0 and "holder" in left.remedy


def test_where_no_tool_may_lean_point_milling_is_refused() -> None:
    with pytest.raises(Refused, match="rotary axes"):
        planned(None)


def test_axes_are_asked_for_in_the_part_s_coordinates() -> None:
    tilted = Frame(np.array([0.0, 0.0, 5.0]), np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0]))
    at, up = np.zeros((1, 3)), UPRIGHT[None]

    def axis(frame=WORLD, **chosen):
        return field_of(choose(PointSettings, chosen), frame)(at, up, np.array([[1.0, 0.0, 0.0]]))[
            0
        ]

    assert axis(axis="fixed", axis_from="0 0 2", frame=tilted) == approx(
        tilted.local_direction(np.array([0.0, 0.0, 1.0]))
    )
    assert axis(axis="away", axis_from="0, 0, -3") == approx([0.0, 0.0, 1.0])
    assert axis(axis="towards", axis_from="0 4 3") == approx([0.0, 0.8, 0.6])
    assert axis(axis="vectors", axis_from="1 0 0 > 1 0 0; -1 0 0 > 0 0 1") == approx(
        [math.sqrt(0.5), 0.0, math.sqrt(0.5)]
    )
    with pytest.raises(BadInput, match="three numbers"):
        axis(axis="fixed", axis_from="up")
    with pytest.raises(BadInput, match="vectors as"):
        axis(axis="vectors", axis_from="1 2 3")


def test_passes_of_constant_scallop_are_milled_by_points_too() -> None:
    ask = Boxes(FLOOR, WALL)
    plan, _ = planned(ask, tool=LONG, high=6.0, pattern="constant")
    path = plan.path
    assert ask(LONG)(
        path.position[1:], path.axis[1:], start_tip=path.position[:-1], start_axis=path.axis[:-1]
    ).all()
    cut = path.position[path.mark == 0]
    assert np.ptp(cut[:, 0]) > 19.0 and np.ptp(cut[:, 1]) > 4.5


@pytest.mark.parametrize("roughed", [False, True])
def test_what_lies_under_stock_stays_and_is_told_apart_from_what_no_lean_reaches(roughed) -> None:
    drive, setup, stock = strip()
    block = np.argwhere(np.ones((30, 60, 40))) + [-15.0, -25.0, 16.0]
    standing = RemainingStock(points=np.zeros((0, 3)) if roughed else block, side=1.0)
    drive = replace(drive, query_for=Boxes(FLOOR), remaining_stock=standing)
    plan = point(
        drive, BALL, DATA, stock, setup, choose(PointSettings, {"surface.point.steepest": 40.0})
    )
    told = [f for f in plan.findings if f.code in ("point.left", "point.in-stock")]
    assert [f.code for f in told] == ([] if roughed else ["point.in-stock"])
    if told:
        # Below it the neck comes up to it 13 mm over the tip, however far it leans; 160 are all.
        assert 60.0 < float(told[0].text.split()[1]) < 160.0
        tips = plan.path.position[plan.path.mark == 0] + 16.0 * plan.path.axis[plan.path.mark == 0]
        assert tips[:, 0].min() > 10.0


def test_after_an_earlier_cutter_only_what_it_left_is_milled() -> None:
    # Beside the wall a ball of 12 mm comes no nearer than 6 mm, one of 6 mm comes to 3 mm.
    drive, setup, stock = strip(high=7.0)
    ask, large = (
        Boxes(FLOOR, WALL),
        replace(
            cutter("ball", diameter=12.0, corner=6.0, flute=12.0), stickout=90.0, gauge_length=150.0
        ),
    )
    plan = point(
        replace(drive, query_for=ask, earlier=large),
        LONG,
        DATA,
        stock,
        setup,
        choose(PointSettings, {}),
    )
    # Blocks are long on a plane: where one begins counts as much as where it ends.
    rows = np.flatnonzero(plan.path.mark == 0)
    rows = np.union1d(rows, rows - 1)
    cut = plan.path.position[rows] + 3.0 * plan.path.axis[rows]
    cut = cut[cut[:, 2] < 3.0 + DATA.depth]
    # The earlier cutter had come to y = 4: passes are 1 mm apart, and one more overlaps what it did.
    assert (
        cut[:, 1].max() == approx(6.5) and 1.0 < cut[:, 1].min() < 4.0 and np.ptp(cut[:, 0]) > 18.9
    )
    assert not [f for f in plan.findings if f.code == "point.left"]


def test_where_an_earlier_cutter_left_nothing_there_is_nothing_to_do() -> None:
    drive, setup, stock = strip(high=4.0)
    plan = point(
        replace(drive, query_for=Boxes(FLOOR), earlier=BALL),
        BALL,
        DATA,
        stock,
        setup,
        choose(PointSettings, {}),
    )
    assert not len(plan.path) and [f.code for f in plan.findings] == ["point.nothing-left"]


def test_to_and_fro_every_other_pass_runs_back() -> None:
    ask = Boxes(FLOOR)
    there, both = (planned(ask, way=way)[0].path for way in ("one", "both"))

    def runs(path):
        cut = path.position[path.mark == 0][:, :2]
        step = np.diff(cut, axis=0)
        return set(np.sign(step[np.abs(step[:, 1]) < 1e-6, 0]).tolist())

    assert len(runs(there)) == 1 and len(runs(both)) == 2
