"""The cutters of an area: in the order they cut, and a larger one first where both together take less time."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from trunnion.plan.freeform.cutters.choice import AreaCutters, steps_of, with_larger_first
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
