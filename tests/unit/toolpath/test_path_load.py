"""The load of laid paths, in cuts whose figures are known."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from pytest import approx

from milling import SETUP, box_blank, cutting, mill
from own_shop import own_shop
from trunnion.geometry.frame import WORLD
from trunnion.model.motion.toolpath import Toolpath
from trunnion.plan.cutting.power import cutting_power
from trunnion.shop import load_shop
from trunnion.toolpath.motion.builder import PathBuilder
from trunnion.toolpath.motion.load.path_load import LoadStock, PathLoad
from trunnion.toolpath.stock.heightfield import PlanningStock

ALUMINIUM = own_shop().material("EN AW-7075")
BLANK = box_blank((0, 0, -20), (60, 40, 0))
TOOL, FEED = mill(10), 1200.0
DATA = cutting(4, 4, FEED)


def path(*points) -> Toolpath:
    """Return a path that goes down beside the blank and along points (x, y) at a depth of 4 mm."""
    builder = PathBuilder(TOOL, DATA, PlanningStock.of(BLANK, SETUP), SETUP, 2.0)
    builder.rapid((*points[0], 50))
    for point in points:
        builder.line((*point, -4.0), FEED)
    return builder.finished()


def load(*paths: Toolpath) -> PathLoad:
    """Return the load of the last of some paths, one after another."""
    stock = LoadStock(BLANK, WORLD)
    return [stock.cut(_in(stock, p), TOOL, DATA, ALUMINIUM) for p in paths][-1]


def _in(stock: LoadStock, made: Toolpath) -> Toolpath:
    from trunnion.pipeline.operation_path import turned

    return turned(made, WORLD, stock.frame)


def power(width: float) -> float:
    tooth = FEED / (TOOL.teeth * DATA.spindle)
    return cutting_power(ALUMINIUM, TOOL.diameter, tooth, 4.0, width, FEED)


def test_a_reamer_takes_the_ring_that_its_bore_has_left_and_a_tap_nothing_of_its_core():
    tools = {t.name: t for t in load_shop().tools}
    reamer, tap = tools["RE-H7 D10"], tools["TAP-B M10x1.5"]

    def down(tool):
        builder = PathBuilder(tool, DATA, PlanningStock.of(BLANK, SETUP), SETUP, 2.0)
        builder.rapid((30.0, 20.0, 50.0))
        for x in (30.0, 30.001):
            builder.line((x, 20.0, -10.0 - tool.lead), FEED)
        return builder.finished()

    bored = PlanningStock.of(BLANK, SETUP, 0.05).after(down(mill(9.8)), mill(9.8))
    gone = float(np.sum(bored.field - bored.after(down(reamer), reamer).field)) * 0.05**2
    assert gone == approx(math.pi / 4 * (10.0**2 - 9.8**2) * 10.0, rel=0.1)
    narrow = PlanningStock.of(BLANK, SETUP, 0.05).after(down(mill(8.4)), mill(8.4))
    deep = replace(tap, lead=0.1)
    assert np.abs(narrow.after(down(deep), deep).field - narrow.field).max() < 1e-9


def test_a_slot_is_a_full_width():
    found = load(path((-10, 20), (70, 20)))
    assert np.median(found.power[found.power > 0.0]) == approx(power(10.0), rel=0.02)
    assert found.chip.max() == approx(FEED / (TOOL.teeth * DATA.spindle), rel=0.01)


@pytest.mark.parametrize("width", [0.1, 0.3, 1.0, 4.0])
@pytest.mark.parametrize("along", ["x", "y"])
def test_a_layer_thinner_than_a_cell_is_as_thick_as_it_is(width, along):
    line = ((-10, width - 5.0), (70, width - 5.0))
    made = path(*line) if along == "x" else path(*((y, x) for x, y in line))
    found = load(made)
    cuts = found.rate[found.rate > 0.0]
    middle = cuts[len(cuts) // 4 : -len(cuts) // 4]
    assert middle.mean() == approx(width * 4.0 * FEED / 1000.0, rel=0.05)
    assert np.median(found.power[found.power > 0.0]) == approx(power(width), rel=0.12)


def test_what_was_cut_before_is_air():
    assert load(path((-10, 20), (70, 20)), path((-10, 20), (70, 20))).power.max() == approx(0.0)


def test_a_film_bears_next_to_nothing():
    wide = path((-10, 20), (70, 20))
    film = path((-10, 26), (70, 26))
    higher = Toolpath(
        **{
            **{n: getattr(film, n) for n in ("axis", "motion", "centre", "feed", "mark")},
            "position": film.position + (0.0, 0.0, 3.99),
        }
    )
    found = load(wide, higher)
    assert 0.0 < found.power.max() < 0.02 * power(10.0)


def test_a_way_between_rapids_is_loaded_by_itself():
    short = load(path((-10, 20), (-4.0, 20)))
    assert short.rate.max() * 1000.0 / FEED <= 4.0 * 10.0
    assert math.isfinite(short.power.max())
