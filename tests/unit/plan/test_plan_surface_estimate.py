"""The estimate of finishing times by area rates, with the numbers of the paper's turbine blade."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from milling import cutting, mill
from trunnion.model.operation import Operation
from trunnion.model.process import ProcessTree
from trunnion.plan.freeform.estimate.finishing_time import PathFigures, estimate_of

AREAS = np.array([735.836, 737.478])


def finishing(id, tag, tool, kind="finish", strategy="surface.parallel", feature="group-01"):
    return Operation(
        id=id,
        kind=kind,
        strategy=strategy,
        feature=feature,
        setup="S1",
        tool=tool,
        faces=(tag,),
        data=cutting(0.1, 0.3, feed=3000.0),
    )


def plan(*operations):
    return ProcessTree(plan="p", material="m", operations=operations)


def test_an_area_takes_its_size_over_feed_times_stepover():
    found = estimate_of(plan(finishing("finish-a", 1, mill(8.0))), AREAS)
    assert found.areas[0].rate == pytest.approx(3000.0 * 0.3 / 60.0)
    assert found.seconds == pytest.approx(735.836 / 15.0)
    assert found.gain == pytest.approx(0.0)


def taking(**seconds):
    """Return the figures of toolpaths that take some seconds and go a mm a second."""
    return {id.replace("_", "-"): PathFigures(seconds=s, length=s) for id, s in seconds.items()}


def test_rates_of_toolpaths_give_the_papers_gain_on_the_blade():
    found = estimate_of(
        plan(finishing("finish-a", 1, mill(8.0)), finishing("finish-b", 2, mill(6.0))),
        AREAS,
        taking(finish_a=735.836 / (1440.73 / 8162.0), finish_b=737.478 / (1440.73 / 10462.0)),
    )
    assert found.alone == "D6 R0"
    assert round(100.0 * found.gain, 2) == 12.33
    assert round(100.0 * found.saving, 2) == 10.98


def test_slow_passes_on_steep_places_are_no_measure_for_shallow_ones():
    found = estimate_of(
        plan(
            finishing("finish-a", 1, mill(8.0), feature="remaining"),
            finishing("finish-b", 2, mill(6.0), feature="local-01"),
            finishing(
                "finish-b-steep", 3, mill(6.0), strategy="surface.waterline", feature="local-01"
            ),
        ),
        np.array([1000.0, 100.0, 100.0]),
        taking(finish_a=100.0, finish_b=12.5, finish_b_steep=100.0),
    )
    # 1000 mm2 at the small cutter's 8 mm2/s for shallow places, not at its 1 mm2/s for steep ones.
    assert found.seconds_alone == pytest.approx(1000.0 / 8.0 + 12.5 + 100.0)
    assert found.gain == pytest.approx(237.5 / 212.5 - 1.0)
    assert [(t.feature, t.seconds, t.seconds_alone) for t in found.totals] == [
        ("remaining", pytest.approx(100.0), pytest.approx(125.0)),
        ("local-01", pytest.approx(112.5), pytest.approx(112.5)),
    ]


def test_a_kind_of_passes_that_the_small_cutter_has_nowhere_is_taken_by_its_planned_rate():
    large = finishing("finish-a", 1, mill(8.0), strategy="surface.waterline")
    small = finishing("finish-b", 2, mill(6.0))
    slower = replace(small, data=cutting(0.1, 0.15, feed=3000.0))
    found = estimate_of(plan(large, slower), AREAS, taking(finish_a=50.0, finish_b=80.0))
    assert found.areas[0].seconds_alone == pytest.approx(100.0)


@pytest.mark.parametrize(("diameter", "alone"), [(6.0, 130.0), (4.0, 140.0)])
def test_what_only_the_large_cutter_leaves_the_small_one_alone_would_not_leave(diameter, alone):
    found = estimate_of(
        plan(
            finishing("finish-a", 1, mill(8.0)),
            finishing("finish-b", 2, mill(6.0)),
            finishing("rest-a", 1, mill(diameter), kind="rest_finish"),
        ),
        np.array([1000.0, 300.0]),
        taking(finish_a=80.0, finish_b=30.0, rest_a=10.0),
    )
    assert (found.seconds, found.seconds_alone) == (pytest.approx(120.0), pytest.approx(alone))


def test_steep_and_shallow_places_of_a_face_share_its_area_by_their_passes():
    parts = finishing("finish-a-steep", 1, mill(8.0)), finishing("finish-a", 1, mill(8.0))
    found = estimate_of(plan(*parts), AREAS[:1], taking(finish_a_steep=30.0, finish_a=10.0))
    assert found.areas[0].area == pytest.approx(3.0 * found.areas[1].area)


def test_a_face_whose_steep_and_shallow_places_are_finished_apart_counts_once():
    parts = finishing("finish-a-steep", 1, mill(8.0)), finishing("finish-a", 1, mill(8.0))
    found = estimate_of(plan(*parts, finishing("finish-b", 2, mill(6.0))), AREAS)
    assert sum(a.area for a in found.areas) == pytest.approx(AREAS.sum())
    assert found.areas[0].area == found.areas[1].area


def test_without_finished_areas_there_is_no_estimate():
    assert estimate_of(plan(finishing("semi-a", 1, mill(8.0), kind="semi")), AREAS) is None


def test_totals_are_those_of_local_features_of_the_remaining_area_and_of_each_group():
    found = estimate_of(
        plan(
            replace(finishing("finish-a", 1, mill(8.0)), faces=(1, 2)),
            finishing("finish-b", 3, mill(6.0), feature="group-03"),
        ),
        np.array([300.0, 100.0, 50.0]),
        taking(finish_a=40.0, finish_b=10.0),
        {"group-01": (1,), "group-02": (2,), "group-03": (3,)},
        local=("group-03",),
    )
    # 400 mm2 in 40 s go by area: three quarters to face 1; alone they take 80 s at 5 mm2/s.
    assert [(t.feature, t.area, t.seconds, t.seconds_alone) for t in found.totals] == [
        ("remaining area", 400.0, pytest.approx(40.0), pytest.approx(80.0)),
        ("local features", 50.0, pytest.approx(10.0), pytest.approx(10.0)),
        ("group-01", 300.0, pytest.approx(30.0), pytest.approx(60.0)),
        ("group-02", 100.0, pytest.approx(10.0), pytest.approx(20.0)),
        ("group-03", 50.0, pytest.approx(10.0), pytest.approx(10.0)),
    ]
