"""Waterlines: level passes round walls and slopes, on the free side, as far apart as the scallop allows."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from surface_drives import DATA, driven, grid, joined, roughed
from trunnion.findings import Refused
from trunnion.geometry.sheet.skin import Skin
from trunnion.model.motion.toolpath import Mark, Motion
from trunnion.plan.freeform.cutters.cutter import lower_side
from trunnion.progress import NO_PROGRESS
from trunnion.toolpath.surface.waterline import WaterlineSettings, waterline
from trunnion.units import trimmed
from verify_tools import bull, flat

FLAT, BALL = flat(10.0)(flute=20.0), bull(6.0, 3.0)()


def round_wall(radius, foot, top, n=90, lean=0.0, tag=1):
    """Return the skin of a round boss about (15, 15), its wall leaning in by an angle (radians), with a top of tag + 1."""
    turn = np.linspace(0.0, 2 * math.pi, n, endpoint=False)
    rows, width = [], [radius, radius - (top - foot) * math.tan(lean)]
    for z, r in zip((foot, top), width, strict=True):
        rows.append(
            np.column_stack([15.0 + r * np.cos(turn), 15.0 + r * np.sin(turn), np.full(n, z)])
        )
    points = np.vstack([*rows, rows[1], [[15.0, 15.0, top]]])
    out = np.column_stack(
        [math.cos(lean) * np.cos(turn), math.cos(lean) * np.sin(turn), np.full(n, math.sin(lean))]
    )
    normals = np.vstack([out, out, np.tile([0.0, 0.0, 1.0], (n + 1, 1))])
    a, b = np.arange(n), (np.arange(n) + 1) % n
    triangles = np.vstack(
        [
            np.column_stack([a, b, b + n]),
            np.column_stack([a, b + n, a + n]),
            np.column_stack([2 * n + a, 2 * n + b, np.full(n, 3 * n)]),
        ]
    )
    return Skin(
        points=points,
        normals=normals,
        triangles=triangles,
        face=np.repeat([tag, tag + 1], [2 * n, n]),
        bound=0.0,
    )


def planned(skin, tool, faces=(1,), allowance=0.0, height=0.01, **chosen):
    drive, setup, stock = driven(skin, faces=faces, allowance=allowance, height=height)
    return waterline(
        drive, tool, DATA, roughed(stock, skin), setup, WaterlineSettings(**chosen), NO_PROGRESS
    ), drive


def cut_tips(path):
    return path.position[path.mark == Mark.CUT]


def test_an_upright_wall_is_cut_once_at_its_foot_with_the_flank() -> None:
    made, _ = planned(round_wall(8.0, 0.0, 10.0), FLAT, chord=0.005)
    tips = cut_tips(made.path)
    assert np.unique(tips[:, 2]).tolist() == [0.0]
    away = np.hypot(tips[:, 0] - 15.0, tips[:, 1] - 15.0)
    # A polygon of 90 sides lies inside its circle by 8 (1 - cos 2 deg), 5 um.
    assert away.min() > 12.99 and away.max() < 13.0 + 1e-4


def test_a_ball_goes_down_an_upright_wall_to_the_floor_it_stands_on() -> None:
    skin = joined(round_wall(8.0, 0.0, 10.0), grid(lambda x, y: 0.0 * x, tag=3))
    levels = np.unique(
        cut_tips(planned(skin, bull(6.0, 3.0)(flute=8.0), chord=0.005)[0].path)[:, 2].round(4)
    )
    assert levels[0] == pytest.approx(0.0, abs=1e-3)


@pytest.mark.parametrize("high", [0.0, 1.5, 5.0])
def test_how_far_a_tool_comes_below_the_blank_is_said(high) -> None:
    """A ball of 3 mm goes down to 3 mm below a wall's foot, the blank to `high` below it."""
    skin = round_wall(8.0, 0.0, 10.0)
    _, drive = planned(skin, BALL, chord=0.005)
    drive = replace(drive, low=np.array([*drive.low[:2], -high]))
    _, setup, stock = driven(skin)
    made = waterline(
        drive, BALL, DATA, roughed(stock, skin), setup, WaterlineSettings(chord=0.005), NO_PROGRESS
    )
    deep = -high - float(made.path.position[:, 2].min())
    found = [f for f in made.findings if f.code == "surface.low"]
    assert bool(found) is (deep > 0.01) is (high < 3.0)
    if found:
        assert (
            f"comes {trimmed(deep, 1)} mm lower" in found[0].text
            and "above the table" in found[0].remedy
        )


def test_the_flank_above_a_ball_leaves_no_band_of_an_upright_wall() -> None:
    ball = bull(6.0, 3.0)(flute=8.0)
    skin = joined(round_wall(8.0, 0.0, 17.0), grid(lambda x, y: 0.0 * x, tag=3))
    levels = np.unique(cut_tips(planned(skin, ball, chord=0.005)[0].path)[:, 2].round(4))
    # Up to the end of the ball the flank does not touch yet, and above the flutes it no longer cuts.
    assert np.diff(levels).max() <= ball.flute_length - ball.corner_radius
    assert levels[-1] + ball.flute_length >= 17.0


def test_the_wall_is_on_the_right_of_the_feed() -> None:
    tips = cut_tips(planned(round_wall(8.0, 0.0, 10.0), FLAT, chord=0.005)[0].path)[:, :2] - 15.0
    turn = tips[:-1, 0] * tips[1:, 1] - tips[:-1, 1] * tips[1:, 0]
    assert (turn < 0.0).mean() > 0.99


def test_levels_on_a_slope_are_one_stepover_apart() -> None:
    lean = math.radians(30.0)
    made, _ = planned(round_wall(9.0, 0.0, 5.0, lean=lean), BALL, chord=0.01)
    levels = np.unique(cut_tips(made.path)[:, 2].round(6))
    # Where a wall bends, levels are laid for a twentieth less.
    across = 2.0 * math.sqrt(2.0 * 3.0 * 0.0095 - 0.0095**2) * math.cos(lean)
    assert np.diff(levels).max() == pytest.approx(across, rel=1e-2)


def test_a_flat_end_leaves_steps_as_high_as_wanted() -> None:
    lean = math.radians(20.0)
    made, _ = planned(round_wall(9.0, 0.0, 4.0, lean=lean), FLAT, height=0.05, chord=0.01)
    levels = np.unique(cut_tips(made.path)[:, 2].round(6))
    assert np.diff(levels).max() == pytest.approx(0.05 / math.sin(lean), rel=1e-3)


def test_nothing_is_gouged_and_the_tips_touch() -> None:
    made, drive = planned(round_wall(9.0, 0.0, 5.0, lean=math.radians(30.0)), BALL, height=0.05)
    tips = cut_tips(made.path)
    over = tips[:, 2] - drive.skin.drop.drop(tips[:, :2], lower_side(BALL), -9.0)
    # Tips are on the free side; the end of an overlap lies on a chord.
    assert np.sort(over)[len(over) // 50] > -2e-6 and over.min() > -0.0005 and over.max() < 2e-3
    moves = made.path.position[made.path.motion != Motion.RAPID]
    assert (moves[:, 2] - drive.skin.drop.drop(moves[:, :2], lower_side(BALL), -9.0)).min() > -1e-3


@pytest.mark.parametrize(
    ("skin", "tool"),
    [
        (round_wall(9.0, 0.0, 5.0, lean=math.radians(30.0)), BALL),
        (round_wall(8.0, 0.0, 10.0), FLAT),
        (round_wall(8.0, 0.0, 5.0, n=7), BALL),
        (grid(lambda x, y: 4.0 * np.sin(0.4 * x) * np.cos(0.3 * y)), BALL),
    ],
)
def test_no_chord_leaves_the_rim_of_what_is_blocked_by_more_than_the_chord_error(
    skin, tool
) -> None:
    chord = 0.002
    made, drive = planned(skin, tool, step=1.0, chord=chord)
    tips, cut = made.path.position, made.path.mark == Mark.CUT
    rows = np.flatnonzero(cut[1:] & cut[:-1] & (np.hypot(*np.diff(tips[:, :2], axis=0).T) > 0.01))
    start, way = tips[rows], np.diff(tips, axis=0)[rows]
    left = np.column_stack([-way[:, 1], way[:, 0]]) / np.hypot(way[:, 0], way[:, 1])[:, None]
    for share in (0.2, 0.5, 0.8):
        place = start + share * way
        over = [
            drive.skin.drop.drop(place[:, :2] + side * chord * left, lower_side(tool), -9.0)
            - place[:, 2]
            for side in (-1.0, 1.0)
        ]
        assert (over[1] <= 1e-9).all() and (over[0] > -1e-9).all()


def test_an_allowance_keeps_the_cutter_off_the_wall() -> None:
    tips = cut_tips(planned(round_wall(8.0, 0.0, 10.0), FLAT, allowance=0.5, chord=0.005)[0].path)
    assert np.hypot(tips[:, 0] - 15.0, tips[:, 1] - 15.0).max() == pytest.approx(13.5, abs=1e-3)


def test_a_set_step_is_kept() -> None:
    levels = np.unique(
        cut_tips(planned(round_wall(8.0, 0.0, 10.0), FLAT, step=2.5, chord=0.01)[0].path)[
            :, 2
        ].round(6)
    )
    assert levels.tolist() == [0.0, 2.5, 5.0, 7.5]


def test_levels_are_cut_downwards() -> None:
    heights = cut_tips(planned(round_wall(8.0, 0.0, 10.0), FLAT, step=2.5, chord=0.01)[0].path)[
        :, 2
    ]
    assert (np.diff(heights) <= 1e-9).all()


def test_what_is_shallow_is_left_and_said() -> None:
    made, _ = planned(round_wall(8.0, 0.0, 10.0), FLAT, faces=(1, 2), chord=0.01)
    (finding,) = made.findings
    assert finding.code == "surface.too-shallow" and finding.text.startswith("20")


def test_a_level_face_alone_has_no_path_but_a_finding() -> None:
    made, _ = planned(grid(lambda x, y: 0.0 * x, n=4), BALL)
    assert not len(made.path) and made.findings[0].code == "surface.too-shallow"


def test_without_a_scallop_height_or_a_step_it_refuses() -> None:
    with pytest.raises(Refused, match="scallop height"):
        planned(round_wall(8.0, 0.0, 10.0), FLAT, height=0.0)


def block(low, high):
    """Return the skin of the four sides (tag 1) and the top (tag 2) of a block."""
    (x0, y0, z0), (x1, y1, z1) = low, high
    ring = np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]])
    points, normals, triangles = [], [], []
    for k, out in enumerate(((0, -1), (1, 0), (0, 1), (-1, 0))):
        a, b = ring[k], ring[(k + 1) % 4]
        points += [[*a, z0], [*b, z0], [*b, z1], [*a, z1]]
        normals += [[*out, 0.0]] * 4
        triangles += [[4 * k, 4 * k + 1, 4 * k + 2], [4 * k, 4 * k + 2, 4 * k + 3]]
    points += [[*p, z1] for p in ring]
    normals += [[0.0, 0.0, 1.0]] * 4
    triangles += [[16, 17, 18], [16, 18, 19]]
    return Skin(
        points=np.array(points, dtype=float),
        normals=np.array(normals, dtype=float),
        triangles=np.array(triangles),
        face=np.repeat([1, 2], [8, 2]),
        bound=0.0,
    )


def test_the_cutter_rolls_round_the_corners_of_a_block_in_one_closed_pass() -> None:
    made, _ = planned(block((5, 5, 0), (25, 20, 8)), FLAT, chord=0.005)
    assert (made.path.motion == Motion.RAPID).sum() == 3
    around = made.path.lengths()[made.path.mark == Mark.CUT].sum()
    # And over its start by half a millimetre.
    assert around == pytest.approx(2 * 20 + 2 * 15 + 2 * math.pi * 5.0 + 0.5, abs=0.01)


def test_upright_walls_beside_leaning_ones_are_cut_on_levels_of_their_own() -> None:
    upright, leaning = round_wall(32.0, 0.0, 4.0), round_wall(32.0, 0.0, 4.0, lean=0.3, tag=3)
    skin = joined(upright, replace(leaning, points=leaning.points + [90.0, 0.0, 0.0]))
    tips = cut_tips(planned(skin, FLAT, faces=(1, 3), chord=0.005)[0].path)
    near = tips[:, 0] < 60.0
    assert np.flatnonzero(near).max() < np.flatnonzero(~near).min(), "upright ones come first"
    assert np.unique(tips[near, 2]).tolist() == [0.0]
    levels = np.unique(tips[~near, 2].round(6))
    assert len(levels) == pytest.approx(4.0 * math.sin(0.3) / 0.01, abs=2)
    alone = cut_tips(planned(skin, FLAT, faces=(3,), chord=0.005)[0].path)
    assert levels == pytest.approx(np.unique(alone[:, 2].round(6)))


def test_a_pass_past_a_short_area_does_not_go_on_round_the_boss() -> None:
    wall = round_wall(12.0, 0.0, 10.0)
    some = wall.points[wall.triangles].mean(axis=1)[:, 0] > 26.0
    skin = replace(wall, face=np.where(some & (wall.face == 1), 9, wall.face))
    tips = cut_tips(planned(skin, FLAT, faces=(9,), chord=0.005, overlap=0.5)[0].path)
    area = np.unique(skin.triangles[skin.face == 9])
    half = math.atan2(np.ptp(skin.points[area, 1]) / 2.0, 11.0)
    angle = np.abs(np.arctan2(tips[:, 1] - 15.0, tips[:, 0] - 15.0))
    # Half a millimetre past the area and no more than a tip's width of the search.
    assert half <= angle.max() <= half + 0.5 / 17.0 + 0.1


def arched(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """A floor that rises by 1 mm to y = 15 along x."""
    return 1.0 - (y - 15.0) ** 2 / 225.0


def arched_wall(n: int = 60, rise: float = 1.0) -> Skin:
    """Return an upright wall at x = 20, facing low x, from an arched floor up to z = 10: two triangles for each step of its foot."""
    y = np.linspace(0.0, 30.0, n + 1)
    points = np.vstack(
        [
            np.column_stack([np.full(n + 1, 20.0), y, z])
            for z in (rise * arched(20.0, y), np.full(n + 1, 10.0))
        ]
    )
    a = np.arange(n)
    return Skin(
        points=points,
        normals=np.tile([-1.0, 0.0, 0.0], (len(points), 1)),
        triangles=np.vstack(
            [np.column_stack([a, a + n + 1, a + 1]), np.column_stack([a + 1, a + n + 1, a + n + 2])]
        ),
        face=np.ones(2 * n, dtype=np.int64),
        bound=0.0,
    )


def test_the_foot_of_an_upright_wall_is_followed_where_the_floor_rises_along_it() -> None:
    tool = bull(6.0, 0.5)(flute=8.0)
    floor = grid(arched, n=120, low=(0.0, -5.0), high=(20.0, 35.0), tag=3)
    made, drive = planned(joined(arched_wall(), floor), tool, chord=0.002)
    tips = cut_tips(made.path)
    # Off the wall by as much as chords may be off, in one pass.
    mine = tips[(tips[:, 0] < 16.999) & (tips[:, 0] > 16.99)]
    y = np.linspace(2.0, 28.0, 45)
    rests = drive.skin.drop.drop(np.column_stack([np.full(45, 16.99), y]), lower_side(tool), -9.0)
    line = mine[np.argsort(mine[:, 1])]
    assert np.abs(np.interp(y, line[:, 1], line[:, 2]) - rests).max() < 0.005
    assert len(np.unique(tips[:, 2])) < 60 and len(tips) < 100
    assert (tips[:, 2] - drive.skin.drop.drop(tips[:, :2], lower_side(tool), -9.0)).min() > -1e-3


@pytest.mark.parametrize("rise", [1.0, -1.0])
def test_the_foot_is_followed_where_the_flank_is_longer_than_the_wall_is_high(rise: float) -> None:
    tool = bull(6.0, 0.5)(flute=30.0)

    def bent(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return rise * arched(x, y)

    floor = grid(bent, n=120, low=(0.0, -5.0), high=(20.0, 35.0), tag=3)
    made, drive = planned(joined(arched_wall(rise=rise), floor), tool, chord=0.002)
    tips = cut_tips(made.path)
    rows = np.flatnonzero(made.path.mark == Mark.CUT)
    begins, share = made.path.starts()[rows], np.linspace(0.0, 1.0, 200)[:, None, None]
    along = (begins + share * (made.path.position[rows] - begins)).reshape(-1, 3)
    mine = along[np.abs(along[:, 0] - 17.0) < 0.01]
    y = np.linspace(2.0, 28.0, 45)
    rests = drive.skin.drop.drop(np.column_stack([np.full(45, 16.99), y]), lower_side(tool), -9.0)
    # Everywhere along the wall there is a pass at its foot, which rises by up to 0.06 mm over what is looked at to either side.
    lowest = [float(mine[np.abs(mine[:, 1] - at) < 0.5, 2].min()) for at in y]
    assert np.abs(lowest - rests).max() < 0.13
    assert (tips[:, 2] - drive.skin.drop.drop(tips[:, :2], lower_side(tool), -9.0)).min() > -1e-3
