"""Paths over a bottom laid flat, rolled back onto it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from milling import SETUP, mill
from trunnion.findings import Refused
from trunnion.geometry.development import Development
from trunnion.geometry.frame import WORLD, Frame
from trunnion.model.blank import Revolved
from trunnion.model.motion.toolpath import Mark, Motion, Toolpath
from trunnion.plan.contract import RollingGround
from trunnion.toolpath.motion.ground_links import over_ground
from trunnion.toolpath.motion.rolled import laid_flat, rolled
from trunnion.toolpath.stock.views import StockViews

GROUND = Development(frame=WORLD, radius=100.0, height=0.0, slope=0.0, middle=0.0)


def flat_path(rows: list[tuple[float, float, float, Motion]], centre: object = None) -> Toolpath:
    n = len(rows)
    motion = np.array([int(r[3]) for r in rows])
    return Toolpath(
        position=np.array([r[:3] for r in rows]),
        axis=np.tile([0.0, 0.0, 1.0], (n, 1)),
        motion=motion,
        centre=np.full((n, 3), np.nan) if centre is None else np.asarray(centre, dtype=float),
        feed=np.where(motion == Motion.RAPID, 0.0, 500.0),
        mark=np.full(n, Mark.CUT),
    )


ROUND = flat_path(
    [(0.0, 5.0, 20.0, Motion.RAPID), (0.0, 5.0, 0.0, Motion.LINE), (60.0, 5.0, 0.0, Motion.LINE)]
)


def test_a_pass_along_the_circles_keeps_to_the_ground_within_the_chord_error() -> None:
    path = rolled(ROUND, GROUND, WORLD, 0.002)
    on = path.position[path.motion == Motion.LINE]
    middle = 0.5 * (on[1:] + on[:-1])
    assert np.hypot(on[:, 0], on[:, 1]) == pytest.approx(100.0)
    assert 0.0 < (100.0 - np.hypot(middle[:, 0], middle[:, 1])).max() <= 0.002
    assert on[-1] == pytest.approx([100.0 * np.cos(0.6), 100.0 * np.sin(0.6), 5.0])


def test_the_tool_is_the_grounds_normal_everywhere() -> None:
    path = rolled(ROUND, GROUND, WORLD, 0.002)
    out = path.position * [1.0, 1.0, 0.0]
    assert path.axis == pytest.approx(out / np.linalg.norm(out, axis=1, keepdims=True))


def test_rapids_over_half_a_turn_stay_outside() -> None:
    path = rolled(
        flat_path([(0.0, 0.0, 20.0, Motion.RAPID), (300.0, 0.0, 20.0, Motion.RAPID)]),
        GROUND,
        WORLD,
        0.01,
    )
    middle = 0.5 * (path.position[1:] + path.position[:-1])
    assert np.hypot(middle[:, 0], middle[:, 1]).min() > 119.6


def test_an_arc_becomes_chords_of_its_circle() -> None:
    path = flat_path(
        [(10.0, 0.0, 2.0, Motion.RAPID), (-10.0, 0.0, 2.0, Motion.ARC_CCW)],
        [[np.nan] * 3, [0.0, 0.0, 2.0]],
    )
    flat = GROUND.to_local(rolled(path, GROUND, WORLD, 0.001).position)
    assert np.hypot(flat[:, 0], flat[:, 1]) == pytest.approx(10.0)
    assert flat[:, 1].max() == pytest.approx(10.0, abs=1e-3)


def test_a_flat_arc_wider_than_a_cone_is_long_keeps_to_its_chord_error() -> None:
    """An arc with its centre beyond the cone's tip was taken for one at no radius, and went in one block (0.5 mm off)."""
    cone = Development(frame=WORLD, radius=200.0, height=0.0, slope=0.1, middle=0.0)
    arm, sweep = 4000.0, 0.02
    end = (-arm * np.sin(sweep), arm * np.cos(sweep) - arm)
    path = flat_path(
        [(0.0, 0.0, 0.0, Motion.RAPID), (*end, 0.0, Motion.ARC_CCW)],
        [[np.nan] * 3, [0.0, -arm, 0.0]],
    )
    tips = rolled(path, cone, WORLD, 0.05).position
    middle = cone.to_local(0.5 * (tips[1:] + tips[:-1]))
    assert len(tips) > 3 and middle[:, 2].min() >= -0.05 - 1e-9


def on_cone(
    cone: Development, places: list[tuple[float, float, float]], known: tuple[float, float]
) -> tuple[Toolpath, RollingGround]:
    """Return rapids between places (along, turn, height) on a cone, and the ground between places that are known."""
    along, turns, height = np.array(places).T
    flat = np.column_stack([cone.at(along, turns), height])
    ground = RollingGround(
        development=cone,
        chord=0.01,
        low=flat[:, :2].min(axis=0),
        high=flat[:, :2].max(axis=0),
        profile=np.array([[known[0], 10.0], [known[1], 10.0]]),
        widths=1.0,
        known=known,
    )
    return flat_path([(*row, Motion.RAPID) for row in flat.tolist()]), ground


def test_a_rapid_between_places_far_round_a_cone_stays_over_its_ground() -> None:
    """Straight over the plane it came 50 mm out of the ground, through the flange below."""
    cone = Development(frame=WORLD, radius=275.0, height=170.0, slope=0.2126, middle=0.0)
    path, ground = on_cone(cone, [(2.0, -1.0, 12.0), (20.0, 2.0, 12.0)], (-20.0, 160.0))
    straight, round_ = (
        cone.to_local(rolled(p, cone, WORLD, 0.01).position)
        for p in (path, over_ground(path, ground, 25.0))
    )
    assert cone.along_and_turn(straight)[0].min() < -50.0
    along, _ = cone.along_and_turn(round_)
    assert along.min() > 1.5 and along.max() < 20.5
    assert round_[[0, -1]] == pytest.approx(path.position, abs=1e-6)
    assert round_[1:-1, 2] == pytest.approx(25.0, abs=0.5)


def test_a_rapid_that_stays_over_its_ground_goes_straight() -> None:
    cone = Development(frame=WORLD, radius=275.0, height=170.0, slope=0.2126, middle=0.0)
    path, ground = on_cone(cone, [(60.0, -0.4, 12.0), (60.0, 0.4, 12.0)], (-20.0, 160.0))
    assert over_ground(path, ground, 25.0) is path
    flat, on_cylinder = on_cone(GROUND, [(0.0, -3.0, 12.0), (9.0, 3.0, 12.0)], (-1.0, 10.0))
    assert over_ground(flat, on_cylinder, 25.0) is flat


@given(
    slope=st.floats(-0.8, 0.8).filter(lambda s: abs(s) > 0.01),
    turns=st.tuples(st.floats(-3.1, 3.1), st.floats(-3.1, 3.1)),
    places=st.tuples(st.floats(0.0, 100.0), st.floats(0.0, 100.0)),
    heights=st.tuples(st.floats(0.0, 30.0), st.floats(0.0, 30.0)),
)
def test_rapids_over_any_cone_stay_between_the_places_that_are_known(
    slope: float,
    turns: tuple[float, float],
    places: tuple[float, float],
    heights: tuple[float, float],
) -> None:
    cone = Development(frame=WORLD, radius=300.0, height=0.0, slope=slope, middle=0.3)
    path, ground = on_cone(
        cone, list(zip(places, turns, heights, strict=True)), (min(places) - 5.0, max(places) + 5.0)
    )
    kept = over_ground(path, ground, 40.0)
    share = np.linspace(0.0, 1.0, 50)[:, None]
    between = np.concatenate(
        [a + share * (b - a) for a, b in zip(kept.position[:-1], kept.position[1:], strict=True)]
    )
    along, _ = cone.along_and_turn(between)
    assert along.min() >= ground.known[0] - 0.5 and along.max() <= ground.known[1] + 0.5
    assert kept.position[-1] == pytest.approx(path.position[-1], abs=1e-9)
    assert kept.position[0] == pytest.approx(path.position[0], abs=1e-9)


def test_what_was_rolled_is_laid_flat_again() -> None:
    path = rolled(ROUND, GROUND, WORLD, 0.002)
    back = laid_flat(path, GROUND, WORLD)
    assert back.position[[0, -1]] == pytest.approx(ROUND.position[[0, -1]], abs=1e-9)
    assert (back.axis == [0.0, 0.0, 1.0]).all()


def test_a_path_past_half_a_turn_is_no_cut_all_the_way_back() -> None:
    path = rolled(
        flat_path([(310.0, 0.0, 0.0, Motion.RAPID), (330.0, 0.0, 0.0, Motion.LINE)]),
        GROUND,
        WORLD,
        0.01,
    )
    back = laid_flat(path, GROUND, WORLD)
    jumps = np.abs(np.diff(back.position[:, 0])) > 100.0
    assert jumps.sum() == 1 and back.motion[1:][jumps] == [Motion.RAPID]


def test_what_is_cut_over_a_ground_is_known_along_other_directions() -> None:
    outline = np.array([[90.0, 0.0], [105.0, 0.0], [105.0, 40.0], [90.0, 40.0]])
    views = StockViews(Revolved(frame=WORLD, outline=outline, material="EN AW-7075", density=2.8))
    ground = RollingGround(
        development=GROUND,
        chord=0.01,
        low=np.array([-60.0, 0.0]),
        high=np.array([60.0, 40.0]),
        profile=np.array([[0.0, 5.0], [20.0, 5.0], [40.0, 5.0]]),
        widths=100.0 / 105.0,
    )
    assert views.over_ground(ground).heights == pytest.approx(5.0)
    rows = [(-20.0, 20.0, 20.0, Motion.RAPID), (-20.0, 20.0, 1.0, Motion.LINE)]
    views.cut_over(ground, flat_path([*rows, (20.0, 20.0, 1.0, Motion.LINE)]), mill(12.0))
    # Seen along x the groove lies in the middle of the blank, a little over its ground.
    side = Frame(np.zeros(3), np.array([0.0, 1.0, 0.0]), np.array([1.0, 0.0, 0.0]))
    seen = views.seen(replace(SETUP, frame=side), 1.0)
    cell = tuple(((np.array([0.0, 20.0]) - seen.corner) / seen.cell).astype(int))
    assert 101.0 <= seen.heights[cell] < 103.5
    beside = tuple(((np.array([0.0, 35.0]) - seen.corner) / seen.cell).astype(int))
    assert seen.heights[beside] == pytest.approx(105.0, abs=0.1)


def test_what_is_cut_over_the_ground_that_another_is_sunk_into_is_gone_over_both() -> None:
    outline = np.array([[90.0, 0.0], [105.0, 0.0], [105.0, 40.0], [90.0, 40.0]])
    views = StockViews(Revolved(frame=WORLD, outline=outline, material="EN AW-7075", density=2.8))
    upper, lower = (
        RollingGround(
            development=replace(GROUND, radius=radius, middle=middle),
            chord=0.01,
            low=np.array([-wide, 0.0]),
            high=np.array([wide, 40.0]),
            profile=np.array([[0.0, 105.0 - radius], [40.0, 105.0 - radius]]),
            widths=1.0,
        )
        for radius, middle, wide in ((100.0, 0.0, 60.0), (97.0, 0.1, 30.0))
    )
    lower = replace(lower, upper=upper)
    assert views.over_ground(lower).heights == pytest.approx(8.0)
    rows = [(-20.0, 20.0, 20.0, Motion.RAPID), (-20.0, 20.0, 1.0, Motion.LINE)]
    views.cut_over(upper, flat_path([*rows, (30.0, 20.0, 1.0, Motion.LINE)]), mill(12.0))
    stock = views.over_ground(lower)
    # 1 mm stay on the upper ground, which is 3 mm over the lower one; beside the groove all is as it was.
    assert 4.0 <= stock.height((0.0, 20.0), (0.0, 20.0), 1.0) < 4.0 + 2.0 * stock.cell
    assert stock.height((0.0, 35.0), (0.0, 35.0), 1.0) == pytest.approx(8.0)


def test_stock_that_straight_cutters_leave_high_up_is_known() -> None:
    """On a radius of 100 mm a cutter of 12 mm spans 2 asin(6 / 125) at 25 mm: 9.6 mm of the ground, and two passes 11 mm apart leave a fin
    between them that is in no cutter's way at the ground."""
    outline = np.array([[90.0, 0.0], [125.0, 0.0], [125.0, 40.0], [90.0, 40.0]])
    views = StockViews(Revolved(frame=WORLD, outline=outline, material="EN AW-7075", density=2.8))
    profile = np.array([[0.0, 25.0], [20.0, 25.0], [40.0, 25.0]])
    ground = RollingGround(
        development=GROUND,
        chord=0.01,
        low=np.array([-60.0, 0.0]),
        high=np.array([60.0, 40.0]),
        profile=profile,
        widths=GROUND.least_width(*profile.T),
    )
    for u in (-5.5, 5.5):
        rows = [(u, 0.0, 60.0, Motion.RAPID), (u, 0.0, 1.0, Motion.LINE)]
        views.cut_over(ground, flat_path([*rows, (u, 40.0, 1.0, Motion.LINE)]), mill(12.0))
    stock = views.over_ground(ground)
    assert stock.height((0.0, 20.0), (0.0, 20.0), 0.1) == pytest.approx(25.0)
    assert stock.height((5.5, 20.0), (5.5, 20.0), 3.5) == pytest.approx(1.0)


class Drilling:
    """As much of a path with a drilling cycle as is looked at."""

    cycles = (object(),)


def test_holes_are_refused() -> None:
    with pytest.raises(Refused, match="each its own direction"):
        rolled(Drilling(), GROUND, WORLD, 0.01)
