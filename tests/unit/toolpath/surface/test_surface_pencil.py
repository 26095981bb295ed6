"""Pencil passes: along valleys, where the cutter touches two faces, and beside them where a larger cutter stood off."""

from __future__ import annotations

import math

import numpy as np
import pytest

from surface_drives import DATA, driven, grid, joined
from trunnion.findings import Refused
from trunnion.geometry.sheet.skin import Skin
from trunnion.model.motion.toolpath import Mark, Motion
from trunnion.plan.freeform.cutters.cutter import lower_side
from trunnion.progress import NO_PROGRESS
from trunnion.toolpath.surface.pencil import PencilSettings, pencil
from verify_tools import bull, flat

BALL = bull(6.0, 3.0)()


def valley(slope=1.0):
    """Return two faces that fall to a valley along y at x = 15."""
    left = grid(lambda x, y: slope * (15.0 - x), n=20, high=(15.0, 20.0))
    right = grid(lambda x, y: slope * (x - 15.0), n=20, low=(15.0, 0.0), high=(30.0, 20.0), tag=2)
    return joined(left, right)


def planned(skin: Skin, tool=BALL, faces=(1, 2), earlier=None, **chosen):
    drive, setup, stock = driven(skin, faces=faces, height=0.01, earlier=earlier)
    return pencil(drive, tool, DATA, stock, setup, PencilSettings(**chosen), NO_PROGRESS), drive


def cut_tips(path):
    return path.position[path.mark == Mark.CUT]


def test_the_pass_lies_where_the_ball_touches_both_slopes() -> None:
    tips = cut_tips(planned(valley())[0].path)
    assert tips[:, 0] == pytest.approx(np.full(len(tips), 15.0), abs=1e-4)
    order = np.argsort(tips[:, 1])
    # Before and behind the faces the ball rolls over their rims.
    heights = np.interp(np.linspace(0.5, 19.5, 20), tips[order, 1], tips[order, 2])
    assert heights == pytest.approx(np.full(20, 3.0 * (math.sqrt(2.0) - 1.0)), abs=1e-3)
    assert np.ptp(tips[:, 1]) > 18.0


def test_a_valley_flatter_than_the_angle_is_none() -> None:
    made, _ = planned(valley(math.tan(math.radians(8.0))), angle=20.0)
    assert not len(made.path) and made.findings[0].code == "surface.no-valley"


def test_a_smooth_hollow_is_no_valley() -> None:
    made, _ = planned(grid(lambda x, y: 0.02 * (x - 15.0) ** 2, n=60), faces=(1,))
    assert not len(made.path)


def test_where_a_larger_ball_was_before_passes_lie_beside_the_valley() -> None:
    made, drive = planned(valley(), earlier=bull(12.0, 6.0)())
    across = np.abs(cut_tips(made.path)[:, 0] - 15.0).max()
    # The larger ball touched the slopes at 6 sin 45 from the middle, ours does at 3 sin 45: by as much it must go aside.
    assert 3.0 * math.sqrt(0.5) <= across <= 3.0 * math.sqrt(0.5) + 1.5
    tips = made.path.position[made.path.motion != Motion.RAPID]
    assert (tips[:, 2] - drive.skin.drop.drop(tips[:, :2], lower_side(BALL), -9.0)).min() > -1e-3


def test_passes_beside_as_many_as_asked_for() -> None:
    tips = cut_tips(planned(valley(), sides=2, stepover=0.5)[0].path)
    assert np.unique(tips[:, 0].round(2)).tolist() == [14.0, 14.5, 15.0, 15.5, 16.0]


def test_a_flat_end_is_refused() -> None:
    with pytest.raises(Refused, match="flat end"):
        planned(valley(), flat(6.0)())
