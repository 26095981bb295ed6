"""The estimate of finishing times by area rates, with the numbers of the paper's turbine blade."""

from __future__ import annotations

import numpy as np
import pytest

from milling import cutting, mill
from trunnion.model.operation import Operation
from trunnion.model.process import ProcessTree
from trunnion.plan.freeform.estimate.finishing_time import estimate_of, measured

AREAS = np.array([735.836, 737.478])


def finishing(id, tag, tool, kind="finish"):
    return Operation(
        id=id,
        kind=kind,
        strategy="surface.parallel",
        feature="group-01",
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


def test_rates_of_toolpaths_give_the_papers_gain_on_the_blade():
    found = estimate_of(
        plan(finishing("finish-a", 1, mill(8.0)), finishing("finish-b", 2, mill(6.0))), AREAS
    )
    seconds = {"finish-a": 735.836 / (1440.73 / 8162.0), "finish-b": 737.478 / (1440.73 / 10462.0)}
    known = measured(found, seconds)
    assert known.alone == "D6 R0"
    assert round(100.0 * known.gain, 2) == 12.33
    assert round(100.0 * known.saving, 2) == 10.98


def test_a_face_whose_steep_and_shallow_places_are_finished_apart_counts_once():
    parts = finishing("finish-a-steep", 1, mill(8.0)), finishing("finish-a", 1, mill(8.0))
    found = estimate_of(plan(*parts, finishing("finish-b", 2, mill(6.0))), AREAS)
    assert sum(a.area for a in found.areas) == pytest.approx(AREAS.sum())
    assert found.areas[0].area == found.areas[1].area


def test_without_finished_areas_there_is_no_estimate():
    assert estimate_of(plan(finishing("semi-a", 1, mill(8.0), kind="semi")), AREAS) is None
