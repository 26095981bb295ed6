"""Constant scallop and flow lines: passes as far apart as the scallop allows, nowhere farther; climbing, clipped, explained."""

from __future__ import annotations

import math

import numpy as np
import pytest
from pytest import approx

from milling import box_blank, cutting
from own_shop import own_shop
from surface_forms import (
    cylinder,
    drive_of,
    grid,
    joined,
    length,
    plane,
    saddle,
    stepovers_away,
    zone,
)
from trunnion.findings import BadInput, Refused
from trunnion.geometry.frame import WORLD
from trunnion.geometry.sheet.fields import blend
from trunnion.geometry.sheet.sheet import sheet_of
from trunnion.model.motion.toolpath import Mark
from trunnion.model.setup import Setup
from trunnion.settings import choose
from trunnion.toolpath.contact_passes.flow_lines import DenseFlowLines, FlowParameters, flow_lines
from trunnion.toolpath.contact_passes.stepover import fronts
from trunnion.toolpath.contact_passes.stepover.fronts import AIM, FIRST, scallop_passes
from trunnion.toolpath.contact_passes.stepover.metric import spread, stepover_measure
from trunnion.toolpath.stock.heightfield import PlanningStock
from trunnion.toolpath.surface.constant import ConstantSettings, constant
from trunnion.toolpath.surface.streamline import StreamlineSettings, streamline

SHOP = own_shop()
BALL = next(t for t in SHOP.tools if t.form == "ball" and t.diameter == 6.0)
BULL = next(t for t in SHOP.tools if t.form == "bull")
FLAT = next(t for t in SHOP.tools if t.form == "flat")
FORMS = {
    "plane": plane(),
    "boss": cylinder(),
    "hollow": cylinder(hollow=True),
    "zone": zone(),
    "saddle": saddle(),
}
STEP = math.sqrt(8.0 * 3.0 * 0.01)


def cut(strategy, settings, skin, **words):
    drive = drive_of(skin)
    blank = box_blank(tuple(drive.low), tuple(drive.high))
    setup = Setup(
        name="S1", frame=WORLD, work_offset="G54", clearance=drive.clearance, machine="3-axis"
    )
    return strategy(
        drive,
        BALL,
        cutting(1.0, 1.0),
        PlanningStock.of(blank, setup),
        setup,
        choose(settings, words),
    )


def one_way(a_normal, b_normal, tool=BALL, height=0.01, way=(0.1, 0.0, 0.0)):
    rows = [np.array([v], dtype=float) for v in ((0.0, 0.0, 0.0), a_normal, way, b_normal)]
    return float(stepover_measure(tool, height)(*rows)[0])


def test_a_stepover_on_a_plane_by_hand() -> None:
    exact = 2.0 * math.sqrt(2.0 * 3.0 * 0.01 - 0.01**2)
    assert 0.1 / one_way((0.0, 0.0, 1.0), (0.0, 0.0, 1.0)) == approx(exact, rel=1e-6)


@pytest.mark.parametrize(("turn", "share"), [(0.01, 1.3), (-0.01, 0.7)])
def test_stepovers_are_narrower_on_bosses_and_wider_in_hollows(turn: float, share: float) -> None:
    # A turn of 0.01 on 0.1 mm is a radius of 10; the cutter's is 3.
    flat = one_way((0.0, 0.0, 1.0), (0.0, 0.0, 1.0))
    bent = one_way((-turn / 2.0, 0.0, 1.0), (turn / 2.0, 0.0, 1.0))
    assert (bent / flat) ** 2 == approx(share)


def test_a_hollow_as_round_as_the_cutter_has_a_widest_stepover() -> None:
    assert 0.1 / one_way((1.0 / 60.0, 0.0, 1.0), (-1.0 / 60.0, 0.0, 1.0)) == approx(3.0)


def test_a_bull_end_is_its_corner_along_a_slope_and_its_circle_across() -> None:
    normal = (math.sin(0.4), 0.0, math.cos(0.4))
    down, level = (
        one_way(normal, normal, BULL, way=w)
        for w in ((0.1 * math.cos(0.4), 0.0, -0.1 * math.sin(0.4)), (0.0, 0.1, 0.0))
    )
    inner, corner = BULL.radius - BULL.corner_radius, BULL.corner_radius
    assert (level / down) ** 2 == approx(
        math.sin(0.4) / (inner + corner * math.sin(0.4)) * corner, rel=1e-6
    )


def test_a_flat_end_is_refused() -> None:
    with pytest.raises(Refused, match="flat"):
        stepover_measure(FLAT, 0.01)


def test_spread_keeps_corners() -> None:
    square = np.array(
        [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 0.0]]
    )
    point, _ = spread(square, np.tile([0.0, 0.0, 1.0], (5, 1)), True, 3.0, 0.001, 0.7)
    assert all(np.linalg.norm(point - corner, axis=1).min() < 1e-12 for corner in square)
    assert (
        np.linalg.norm(np.diff(point, axis=0), axis=1).max() <= 0.7
        and (point[0] == point[-1]).all()
    )


@pytest.mark.parametrize("name", FORMS)
def test_no_place_is_much_farther_than_half_a_stepover_from_a_pass(name: str) -> None:
    drive = drive_of(FORMS[name])
    ways = scallop_passes(drive, BALL, 0.0005)
    away = stepovers_away(drive, BALL, ways)
    assert np.percentile(away, 99.5) < 0.515 and away.max() < 0.53


@pytest.mark.parametrize("name", FORMS)
def test_an_area_too_large_for_one_field_is_cut_in_pieces_that_leave_nothing_between_them(
    name: str, monkeypatch
) -> None:
    drive = drive_of(FORMS[name])
    whole = length(scallop_passes(drive, BALL, 0.0005))
    monkeypatch.setattr(fronts, "LARGEST", 40.0)
    ways = scallop_passes(drive, BALL, 0.0005)
    assert 1.01 * whole < length(ways) < 1.6 * whole
    away = stepovers_away(drive, BALL, ways)
    # No ridge is higher than wanted by more than a tenth.
    assert np.percentile(away, 99.5) < 0.515 and away.max() < 0.5 * math.sqrt(1.1 / AIM)


@pytest.mark.parametrize("extra", [-0.03, 0.0, 0.02, 0.04, 0.1])
def test_a_ridge_that_rises_and_falls_about_a_pass_has_one_pass_without_gaps(extra: float) -> None:
    # A strip whose middle is as far from both rims as a pass, here a little more and there a little less.
    wide = 2.0 * STEP * math.sqrt(AIM) * (2.0 + FIRST + extra)
    strip = grid(
        lambda u, v: np.column_stack([u, v * (wide + 0.05 * STEP * np.sin(2.3 * u)), 0 * u]),
        lambda u, v: np.column_stack([0 * u, 0 * u, 0 * u + 1.0]),
        np.linspace(0.0, 8.0, 41),
        np.linspace(0.0, 1.0, 5),
    )
    drive = drive_of(strip)
    ways = scallop_passes(drive, BALL, 0.0005)
    assert stepovers_away(drive, BALL, ways).max() < 0.53
    # What goes there and back on nearly one line is no pass.
    for way in ways:
        if way.closed:
            x, y = way.point[:-1, 0], way.point[:-1, 1]
            assert abs(x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2.0 > 0.02 * STEP * length([way])


@pytest.mark.parametrize("name", FORMS)
def test_passes_are_not_closer_than_the_scallop_wants(name: str) -> None:
    skin = FORMS[name]
    drive = drive_of(skin)
    sheet = sheet_of(skin, (1,))
    bend = {"plane": 0.0, "boss": 0.1, "hollow": -0.1, "zone": 0.1, "saddle": 0.0}[name]
    rim = sum(
        np.linalg.norm(np.diff(sheet.points[np.append(r, r[0])], axis=0), axis=1).sum()
        for r in sheet.rims()
    )
    # They are laid a little closer than wanted, so that the highest ridge of them all is no higher.
    least = sheet.area().sum() * math.sqrt(1.0 + 3.0 * max(bend, 0.0)) / (STEP * math.sqrt(AIM))
    # Beside it: the passes begin nearer to the rim than half a step, and ridges get one of their own.
    assert length(scallop_passes(drive, BALL, 0.0005)) < 1.03 * least + 0.75 * rim


@pytest.mark.parametrize("name", FORMS)
def test_flow_lines_cover_all_within_half_a_stepover(name: str) -> None:
    drive = drive_of(FORMS[name])
    away = stepovers_away(drive, BALL, flow_lines(drive, BALL))
    assert np.percentile(away, 99.0) < 0.52 and away.max() < 0.6


def test_flow_lines_over_slivers_are_laid_over_even_triangles(monkeypatch) -> None:
    # Strips 0.02 mm wide, as a mesh within half a micron has them beside a small fillet.
    drive = drive_of(cylinder(radius=10.0, length=8.0, angle=0.3, n=301))
    sizes = []

    def recorded(metric, *guides):
        sizes.append((len(metric.sheet.triangles), float(metric.area().sum())))
        return blend(metric, *guides)

    monkeypatch.setattr("trunnion.toolpath.contact_passes.flow_lines.blend", recorded)
    away = stepovers_away(drive, BALL, flow_lines(drive, BALL))
    assert np.percentile(away, 99.0) < 0.52 and away.max() < 0.6
    ((triangles, squares),) = sizes
    # Equilateral ones with sides of a stepover would be 2.3 in a square; rims keep their 600 points, and halving leaves shorter edges.
    assert triangles < 6.0 * 2.3 * squares + 2 * 600


def test_flow_lines_over_a_plane_are_rows_that_climb() -> None:
    ways = flow_lines(drive_of(plane()), BALL)
    assert len(ways) == math.ceil(4.0 / STEP) and not any(w.closed for w in ways)
    step = ways[1].point[0] - ways[0].point[0]
    # What is not cut yet lies on the right of the feed.
    assert (np.cross(ways[0].feed[0], step) * ways[0].normal[0]).sum() < 0.0


def test_a_ring_is_one_spiral_and_without_one_closed_passes() -> None:
    drive = drive_of(zone())
    spiral = flow_lines(drive, BALL)
    rings = flow_lines(drive, BALL, FlowParameters(spiral=False))
    assert len(spiral) == 1 and len(rings) > 3 and all(r.closed for r in rings)
    assert np.linalg.norm(spiral[0].point, axis=1) == approx(
        np.full(len(spiral[0]), 10.0), abs=1e-4
    )
    assert np.linalg.norm(np.diff(spiral[0].point, axis=0), axis=1).max() < 0.6


def test_flow_lines_run_between_the_faces_that_are_named() -> None:
    skin = joined(plane(), plane(tag=2, start=6.0), plane(tag=3, start=-6.0))
    ways = flow_lines(
        drive_of(skin), BALL, FlowParameters(first_guide="face 2", second_guide="face 3")
    )
    assert (
        ways[0].point[:, 0] == approx(np.full(len(ways[0]), ways[0].point[0, 0]))
        and ways[0].point[0, 0] > ways[-1].point[0, 0]
    )


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ({"first_guide": "face 2"}, "both guides"),
        ({"first_guide": "top", "second_guide": "2"}, "tags"),
        ({"first_guide": "face 8", "second_guide": "face 9"}, "face 8"),
    ],
)
def test_guides_that_cannot_be_are_refused_in_words(words, message: str) -> None:
    with pytest.raises(BadInput, match=message):
        flow_lines(drive_of(plane()), BALL, FlowParameters(**words))


def test_flow_lines_that_would_crowd_are_refused() -> None:
    # Guides at one end of a long strip: the blend stands still in all the rest of it.
    strip = grid(
        lambda u, v: np.column_stack([u, v, 0 * u]),
        lambda u, v: np.column_stack([0 * u, 0 * u, 0 * u + 1.0]),
        np.linspace(0.0, 2.0, 9),
        np.linspace(0.0, 24.0, 97),
    )
    drive = drive_of(
        joined(
            strip,
            *(plane(1.0, 1.0, n=5, tag=tag, start=start) for tag, start in ((2, -1.0), (3, 2.0))),
        )
    )
    with pytest.raises(DenseFlowLines, match="constant scallop"):
        flow_lines(drive, BALL, FlowParameters(first_guide="2", second_guide="3"))


@pytest.mark.parametrize(
    ("strategy", "settings"), [(constant, ConstantSettings), (streamline, StreamlineSettings)]
)
def test_an_upright_tool_stands_on_the_faces(strategy, settings) -> None:
    planned = cut(strategy, settings, FORMS["saddle"])
    tips = planned.path.position[planned.path.mark == Mark.CUT]
    slope = np.column_stack([-0.04 * tips[:, 0], 0.04 * tips[:, 1], np.ones(len(tips))])
    # A centre above the saddle: nowhere nearer to it than the radius, and hardly farther.
    centre = tips + [0.0, 0.0, 3.0]
    foot = centre - 3.0 * slope / np.linalg.norm(slope, axis=1, keepdims=True)
    for _ in range(6):
        slope = np.column_stack([-0.04 * foot[:, 0], 0.04 * foot[:, 1], np.ones(len(foot))])
        foot = centre - 3.0 * slope / np.linalg.norm(slope, axis=1, keepdims=True)
    off = foot[:, 2] - 0.02 * (foot[:, 0] ** 2 - foot[:, 1] ** 2)
    assert np.abs(off).max() < 0.001 and not planned.findings
    assert planned.path.position[-1, 2] == planned.path.position[0, 2] == 20.0 + 0.02 * 9.0


def test_climbing_inwards_leaves_the_uncut_side_on_the_right() -> None:
    for direction, side in (("climb", -1.0), ("conventional", 1.0)):
        path = cut(constant, ConstantSettings, plane(), direction=direction).path
        rows = np.flatnonzero((path.mark[1:] == Mark.CUT) & (path.mark[:-1] == Mark.CUT))
        start, end = path.position[rows], path.position[rows + 1]
        first = slice(0, 4)
        inwards = np.array([3.0, 2.0, 0.0]) - start[first]
        assert (side * np.cross(end[first] - start[first], inwards)[:, 2] > 0.0).all()


def test_walls_too_steep_are_left_and_named() -> None:
    planned = cut(constant, ConstantSettings, cylinder(radius=4.0, angle=1.4), steepest=60.0)
    assert [f.code for f in planned.findings] == ["surface.too-steep"]
    assert planned.path.position[planned.path.mark == Mark.CUT][:, 1].max() < 7.0 * math.sin(
        math.radians(61.0)
    )


def test_the_same_input_gives_the_same_path() -> None:
    first, second = (cut(constant, ConstantSettings, FORMS["zone"]).path for _ in range(2))
    assert (first.position == second.position).all()


@pytest.mark.parametrize(("radius", "goes"), [(3.02, False), (6.0, True)])
def test_a_hollow_as_round_as_the_ball_is_said_to_be_left(radius, goes):
    def place(u, v):
        return np.column_stack([u, v, -np.sqrt(radius**2 - u * u - v * v)])

    side = np.linspace(-1.5, 1.5, 25)
    made = cut(
        constant, ConstantSettings, grid(place, lambda u, v: -place(u, v) / radius, side, side)
    )
    codes = [f.code for f in made.findings]
    assert bool(len(made.path)) is goes and ("surface.no-way" in codes) is not goes
