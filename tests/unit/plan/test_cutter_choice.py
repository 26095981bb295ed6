"""The cutters of an area: in the order they cut, and a larger one first where both together take less time."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from trunnion.plan.freeform.cutters.choice import (
    AreaCutters,
    steps_of,
    with_larger_first,
    with_rounder_between,
)
from trunnion.plan.freeform.estimate.scallop import level_step, stepover_on_plane
from trunnion.shop import load_shop

SHOP = load_shop(Path("/nowhere"))
BALLS = {t.diameter: t for t in SHOP.tools_for("N", "surface") if t.form == "ball"}
SMALL, MIDDLE, LARGE = (BALLS[d] for d in (3.0, 4.0, 10.0))


def cutters(by_large: int) -> AreaCutters:
    """A hundred samples: the middle ball reaches 97, the small one all, the large one as many as said."""
    rows = np.arange(100)
    reach = {MIDDLE.name: rows < 97, SMALL.name: rows < 100, LARGE.name: rows < by_large}
    return AreaCutters(
        tool=MIDDLE,
        reached=reach[MIDDLE.name],
        reachable=rows < 100,
        missed=rows >= 97,
        rest=SMALL,
        by_name=reach,
    )


def in_order(by_large: int, change: float = 0.1):
    """A sample is 10 mm2; a ball finishes 25 mm2/min for each mm of its diameter."""
    tools = [SMALL, MIDDLE, LARGE]
    return with_larger_first(cutters(by_large), tools, 10.0, lambda t: 25.0 * t.diameter, change)


def test_a_larger_cutter_goes_first_where_that_takes_less_time() -> None:
    steps = in_order(60)
    assert [s.tool for s in steps] == [LARGE, MIDDLE, SMALL]
    assert [int(s.rows.sum()) for s in steps] == [60, 37, 3]
    assert [s.earlier for s in steps] == [None, LARGE, MIDDLE]
    assert not (steps[0].rows & steps[1].rows).any()


@pytest.mark.parametrize(("by_large", "change"), [(0, 0.0), (60, 5.0)])
def test_it_stays_away_where_it_reaches_nothing_or_changing_it_takes_longer(
    by_large: int, change: float
) -> None:
    # 60 samples: 600 / 100 - 600 / 250 = 3.6 min are saved.
    steps = in_order(by_large, change)
    assert [s.tool for s in steps] == [MIDDLE, SMALL] == [s.tool for s in steps_of(cutters(60))]


def test_an_area_that_no_cutter_reaches_has_no_steps() -> None:
    none = np.zeros(4, dtype=bool)
    nothing = AreaCutters(tool=None, reached=none, reachable=none, missed=none, rest=None)
    assert steps_of(nothing) == with_larger_first(nothing, [LARGE], 1.0, lambda t: 1.0, 0.0) == ()


ENDS = {
    t.corner_radius: t
    for t in SHOP.tools_for("N", "finish")
    if t.form in ("flat", "bull") and t.diameter == 8.0
}
SHARP, ROUND, ROUNDER = ENDS[0.0], ENDS[0.5], ENDS[1.5]


def in_corners(by_round: int, change: float):
    """Of a hundred samples the rounder end reaches 90, the round one some of the rest, the sharp one all.

    A sample takes a sharp end 1 min, a round one 0.2 min."""
    rows = np.arange(100)
    known = AreaCutters(
        tool=ROUNDER,
        reached=rows < 90,
        reachable=rows < 100,
        missed=rows >= 90,
        rest=SHARP,
        by_name={ROUNDER.name: rows < 90, ROUND.name: rows < 90 + by_round, SHARP.name: rows < 100},
    )
    return with_rounder_between(
        known,
        [SHARP, ROUND, ROUNDER],
        lambda tool, mine: float(mine.sum()) * (1.0 if tool is SHARP else 0.2),
        change,
    )


def test_a_rounder_end_goes_before_a_sharp_one_where_that_takes_less_time() -> None:
    steps = in_corners(6, 1.0)
    assert [s.tool for s in steps] == [ROUNDER, ROUND, SHARP]
    assert [int(s.rows.sum()) for s in steps] == [90, 6, 4]
    assert [s.earlier for s in steps] == [None, ROUNDER, ROUND]


@pytest.mark.parametrize(("by_round", "change"), [(0, 0.0), (6, 5.0)])
def test_it_does_not_where_it_reaches_nothing_or_changing_it_takes_longer(by_round, change) -> None:
    assert [s.tool for s in in_corners(by_round, change)] == [ROUNDER, SHARP]


def test_a_rounder_end_that_leaves_nothing_is_the_last() -> None:
    assert [s.tool for s in in_corners(10, 1.0)] == [ROUNDER, ROUND]


def test_levels_lie_apart_by_scallops_or_by_the_steps_of_flanks() -> None:
    up = np.sin(np.radians([0.0, 5.0, 45.0, 90.0]))
    flat = level_step(0.0, 0.01, up, 20.0)
    assert flat.tolist() == pytest.approx([20.0, *(0.01 / up[1:])])
    round_ = level_step(3.0, 0.01, up, 20.0)
    assert round_[2] == pytest.approx(stepover_on_plane(3.0, 0.01) * np.cos(np.radians(45.0)))
    assert (round_ >= flat).all()
