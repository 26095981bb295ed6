"""Parallel passes: planes as far apart as the scallop allows, cut only where the area is touched, and what is too steep is said."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from surface_drives import DATA, driven, grid, joined, roughed
from trunnion.findings import Refused
from trunnion.geometry.kernels.cutter_contact.drop_cutter import drop_cutter
from trunnion.model.motion.toolpath import Mark, Motion
from trunnion.plan.freeform.cutters.cutter import lower_side
from trunnion.plan.freeform.estimate.scallop import stepover_on_plane
from trunnion.progress import NO_PROGRESS
from trunnion.toolpath.surface.parallel import ParallelSettings, _joined, _Planes, _runs, parallel
from verify_tools import bull

BALL = bull(6.0, 3.0)()


def planned(skin, tool=BALL, faces=(1,), allowance=0.0, height=0.004, **chosen):
    drive, setup, stock = driven(skin, faces=faces, allowance=allowance, height=height)
    chosen = ParallelSettings(**chosen)
    return parallel(drive, tool, DATA, roughed(stock, skin), setup, chosen, NO_PROGRESS), drive


def cuts(path):
    """Return the cut moves (k, 2, 3) of a path."""
    return np.stack([path.starts(), path.position], axis=1)[path.mark == Mark.CUT]


def along_x(path):
    moves = cuts(path)
    return moves[np.abs(moves[:, 1, 0] - moves[:, 0, 0]) > 1.0]


def rows_of(path, column):
    """Return at which places across the feed passes lie, ascending."""
    places = np.sort(cuts(path)[:, 1, column])
    return places[np.append(True, np.diff(places) > 1e-6)]


def total_allowance(path, tool, points):
    """Return how far points (n, 3) stand from a ball that went along all the cuts."""
    a, b = cuts(path).transpose(1, 0, 2) + np.array([0.0, 0.0, tool.radius])
    way = b - a
    share = np.clip(((points[:, None] - a) * way).sum(axis=2) / (way * way).sum(axis=1), 0.0, 1.0)
    return (
        np.linalg.norm(points[:, None] - a - share[:, :, None] * way, axis=2).min(axis=1)
        - tool.radius
    )


def test_on_a_plane_passes_are_one_stepover_apart() -> None:
    made, _ = planned(grid(lambda x, y: 0.0 * x, n=8, high=(30.0, 10.0)))
    places = rows_of(made.path, 1)
    apart = np.diff(places)
    assert apart[:-1] == pytest.approx(
        np.full(len(apart) - 1, stepover_on_plane(3.0, 0.004)), rel=1e-6
    )
    assert (places[0], places[-1]) == pytest.approx((0.0, 10.0), abs=1e-6)
    # The longer side of the area is the feed direction.
    assert len(along_x(made.path)) == len(places)


def test_where_the_face_leans_across_the_feed_planes_are_nearer() -> None:
    made, _ = planned(
        grid(lambda x, y: math.tan(math.radians(40.0)) * y, n=8, high=(30.0, 10.0)),
        direction="angle",
        angle=0.0,
    )
    wanted = stepover_on_plane(3.0, 0.004) * math.cos(math.radians(40.0))
    assert np.diff(rows_of(made.path, 1))[:-1].max() == pytest.approx(wanted, rel=1e-6)


def test_where_the_face_leans_along_the_feed_they_are_not() -> None:
    made, _ = planned(
        grid(lambda x, y: math.tan(math.radians(40.0)) * x, n=8, high=(10.0, 10.0)),
        direction="angle",
        angle=0.0,
    )
    assert np.diff(rows_of(made.path, 1))[:-1].max() == pytest.approx(
        stepover_on_plane(3.0, 0.004), rel=1e-6
    )


def test_scallops_on_waves_stay_below_what_is_wanted_and_nothing_is_gouged() -> None:
    def height(x, y):
        return 1.5 * np.sin(x / 5.0) * np.cos(y / 6.0)

    made, drive = planned(grid(height, n=160, high=(16.0, 16.0)), height=0.02)
    rng = np.random.default_rng(1)
    x, y = rng.uniform(2.0, 14.0, (2, 1500))
    left = total_allowance(made.path, BALL, np.column_stack([x, y, height(x, y)]))
    assert left.max() < 1.1 * 0.02 and left.min() > -0.003
    tips = made.path.position[made.path.motion != Motion.RAPID]
    assert (tips[:, 2] - drive.skin.drop.drop(tips[:, :2], lower_side(BALL), -9.0)).min() > -1e-3


def test_an_allowance_is_kept_all_round() -> None:
    made, _ = planned(grid(lambda x, y: 0.5 * x, n=8, high=(10.0, 10.0)), allowance=0.3)
    at = np.array([[5.0, 5.0, 2.5]])
    assert total_allowance(made.path, BALL, at) == pytest.approx([0.3], abs=0.006)


def test_only_where_the_area_is_touched_is_cut_and_a_little_over_its_rim() -> None:
    both = joined(
        grid(lambda x, y: 0.0 * x, n=8, high=(10.0, 10.0)),
        grid(lambda x, y: 0.0 * x, n=8, low=(10.0, 0.0), high=(20.0, 10.0), tag=2),
    )
    made, _ = planned(both, faces=(2,), overlap=0.3, direction="angle", angle=0.0)
    assert cuts(made.path)[:, :, 0].min() == pytest.approx(9.7, abs=0.01)


def test_a_boss_of_another_area_interrupts_the_passes() -> None:
    # A block of another face, 6 mm wide, stands on the plane.
    block = replace(
        grid(lambda x, y: 0.0 * x + 5.0, n=2, low=(12.0, 12.0), high=(18.0, 18.0)),
        face=np.full(8, 2),
    )
    made, _ = planned(
        joined(grid(lambda x, y: 0.0 * x, n=30), block), direction="angle", angle=0.0, height=0.02
    )
    inside = cuts(made.path)[:, 1]
    over = (np.abs(inside[:, :2] - 15.0) < 2.5).all(axis=1)
    assert not over.any() and (made.path.motion == Motion.RAPID).sum() > 4


def test_what_is_too_steep_is_left_and_said() -> None:
    steep = grid(lambda x, y: 30.0 * x, n=8, low=(10.0, 0.0), high=(11.0, 10.0), tag=1)
    made, _ = planned(
        joined(grid(lambda x, y: 0.0 * x, n=8, high=(10.0, 10.0)), steep), faces=(1,), steepest=60.0
    )
    # The holder meets the wall itself, which roughing leaves.
    finding, *others = made.findings
    assert [f.code for f in others] == ["surface.in-stock"]
    assert finding.code == "surface.too-steep" and finding.text.startswith(
        f"{10.0 * math.hypot(1.0, 30.0):.1f} mm2"
    )


def test_one_way_passes_all_go_the_same_way() -> None:
    made, _ = planned(
        grid(lambda x, y: 0.0 * x, n=8, high=(30.0, 4.0)), way="one", direction="angle", angle=0.0
    )
    ways = along_x(made.path)
    assert (np.sign(ways[:, 1, 0] - ways[:, 0, 0]) == 1.0).all()


def test_the_same_input_gives_the_same_bytes() -> None:
    first, again = (
        planned(grid(lambda x, y: np.sin(x / 3.0), n=40, high=(10.0, 10.0)))[
            0
        ].path.position.tobytes()
        for _ in range(2)
    )
    assert first == again


def test_without_a_scallop_height_or_a_stepover_it_refuses() -> None:
    with pytest.raises(Refused, match="scallop height"):
        planned(grid(lambda x, y: 0.0 * x, n=4), height=0.0)


def test_tips_stand_where_the_plain_drop_puts_them() -> None:
    made, drive = planned(
        grid(lambda x, y: 0.1 * x * np.cos(y), n=12, high=(6.0, 6.0)), height=0.05
    )
    tips = cuts(made.path)[::7, 1]
    assert tips[:, 2] == pytest.approx(
        drop_cutter(tips[:, :2], drive.skin.points[drive.skin.triangles], lower_side(BALL), -9.0),
        abs=1e-9,
    )


def test_a_run_that_only_touches_a_corner_of_the_area_is_left_out():
    plane, runs = np.array([0, 0, 1]), np.array([[1.0, 1.0], [8.0, 12.0], [3.0, 3.0]])
    kept, longer = _joined(plane, runs, np.zeros((3, 2)), 2.0)
    assert kept.tolist() == [0] and longer.tolist() == [[8.0, 12.0]]


def test_runs_that_go_on_past_what_is_looked_at_end_there():
    planes = _Planes(
        along=np.array([1.0, 0.0]),
        across=np.array([0.0, 1.0]),
        at=np.zeros(2),
        reach=np.array([[0.0, 10.0], [2.0, 5.0]]),
        widest=1.0,
        beyond=1.0,
        triangles=np.zeros(0, np.int64),
    )
    plane, runs = _runs(
        planes, 0.5, 1.0, lambda plane, run, progress: (plane == 0) | (run > 3.0), NO_PROGRESS
    )
    assert plane.tolist() == [0, 1]
    assert (
        runs[0, 0] < -0.9
        and runs[0, 1] > 10.9
        and runs[1, 0] == pytest.approx(3.0, abs=0.5 / 2**7)
        and runs[1, 1] > 5.9
    )


def test_over_a_rim_that_hangs_free_passes_go_on_level() -> None:
    # A blade's round edge, 78 degrees to either side, with nothing beside it.
    radius, rim = 1.6, 1.6 * math.sin(math.radians(78.0))
    edge = grid(lambda x, y: np.sqrt(radius**2 - x**2), n=40, low=(-rim, 0.0), high=(rim, 10.0))
    made, _ = planned(edge, direction="angle", angle=0.0, steepest=85.0)
    tips = made.path.position[made.path.motion != Motion.RAPID]
    # Rolled right over the rim the ball's middle is as high as that.
    assert tips[:, 2].min() > radius * math.cos(math.radians(78.0)) - BALL.radius
    assert np.ptp(tips[:, 0]) > 2.0 * (radius + BALL.radius) * math.sin(math.radians(78.0))
