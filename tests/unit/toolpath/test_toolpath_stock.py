"""The planning stock errs on the side of material, and its compiled loops do what their plain forms do."""

from __future__ import annotations

import math

import numpy as np
import pytest

from milling import SETUP, box_blank, cutting, mill
from trunnion.findings import OutOfMemory
from trunnion.geometry.frame import Frame
from trunnion.geometry.kernels import heightfield
from trunnion.geometry.plane.region import Region
from trunnion.model.setup import Setup
from trunnion.toolpath.motion.builder import PathBuilder
from trunnion.toolpath.stock.heightfield import PlanningStock

BLANK = box_blank((0, 0, -20), (60, 40, 2))


def test_an_uncut_blank_is_as_high_as_its_top() -> None:
    stock = PlanningStock.of(BLANK, SETUP)
    assert stock.height((10, 10), (50, 30), 5.0) == 2.0


def test_there_is_nothing_outside_the_blank() -> None:
    assert PlanningStock.of(BLANK, SETUP).height((-20, 10), (-20, 30), 5.0) == -np.inf


def test_a_blank_turned_over_is_measured_in_the_setup() -> None:
    under = Setup(
        name="S2",
        frame=Frame(np.zeros(3), np.array([1.0, 0, 0]), np.array([0, 0, -1.0])),
        work_offset="G55",
        clearance=60.0,
        machine="Mill",
    )
    assert PlanningStock.of(BLANK, under).heights.max() == 20.0


def test_a_blank_too_large_to_plan_over_is_refused_with_a_remedy() -> None:
    with pytest.raises(OutOfMemory, match="split the part"):
        PlanningStock.of(box_blank((0, 0, 0), (20000, 20000, 10)), SETUP)


def test_a_slot_lowers_only_what_the_cutter_covers_wholly() -> None:
    stock = PlanningStock.of(BLANK, SETUP)
    builder = PathBuilder(mill(10), cutting(4, 4), stock, SETUP, 2.0)
    builder.rapid((-10, 20, 50))
    builder.line((-10, 20, -3), 500.0)
    builder.line((70, 20, -3), 500.0)
    after = stock.after(builder.finished(), mill(10))
    assert after.height((30, 20), (30, 20), 4.0) == -3.0
    assert after.height((30, 20), (30, 20), 5.0) == 2.0
    assert stock.height((30, 20), (30, 20), 4.0) == 2.0


def test_rapids_remove_nothing() -> None:
    stock = PlanningStock.of(BLANK, SETUP)
    builder = PathBuilder(mill(10), cutting(4, 4), stock, SETUP, 2.0)
    builder.rapid((30, 20, 50))
    builder.rapid((30, 20, -5))
    assert stock.after(builder.finished(), mill(10)).digest == stock.digest


def test_places_that_are_higher_are_found_in_an_area_only() -> None:
    stock = PlanningStock.of(BLANK, SETUP)
    assert len(stock.positions_above(1.0, Region.rectangle(10, 10, 12, 12))) == 16
    assert len(stock.positions_above(2.0, Region.rectangle(10, 10, 12, 12))) == 0
    assert len(stock.positions_above(1.0, Region.rectangle(100, 10, 120, 12))) == 0


@pytest.mark.parametrize("flutes", [4.0, math.inf])
@pytest.mark.parametrize("corner", [0.0, 2.0, 6.0])
def test_the_compiled_field_is_lowered_as_its_plain_form(corner: float, flutes: float) -> None:
    random = np.random.default_rng(7)
    starts = random.uniform((-5, -5, -9), (45, 35, 0), (20, 3))
    ends = np.where(
        random.random((20, 1)) < 0.3, starts, random.uniform((-5, -5, -9), (45, 35, 0), (20, 3))
    )
    fast, plain = np.zeros((80, 60)), np.zeros((80, 60))
    gone, plainly_gone = np.zeros((20, 2)), np.zeros((20, 2))
    heightfield.zmap_cut(fast, 0.0, 0.0, 0.5, starts, ends, 6.0, corner, flutes, gone)
    heightfield.zmap_cut_reference(
        plain, 0.0, 0.0, 0.5, starts, ends, 6.0, corner, flutes, plainly_gone
    )
    assert max(np.abs(fast - plain).max(), np.abs(gone - plainly_gone).max()) < 1e-9
    # Some are cut, and of some the tops are beyond the flutes of cuts that would take them.
    deeper = np.zeros((80, 60))
    heightfield.zmap_cut(deeper, 0.0, 0.0, 0.5, starts, ends, 6.0, corner, math.inf, gone)
    assert fast.any() and (deeper < fast).any() is np.bool_(flutes < math.inf)


@pytest.mark.parametrize("corner", [0.0, 2.0, 6.0])
def test_compiled_columns_are_cut_as_in_their_plain_form(corner: float) -> None:
    random = np.random.default_rng(9)
    starts = random.uniform((-5, -5, -9), (45, 35, 0), (40, 3))
    ends = np.where(
        random.random((40, 1)) < 0.3, starts, random.uniform((-5, -5, -9), (45, 35, 0), (40, 3))
    )
    points = random.uniform((0, 0), (40, 30), (500, 2))
    fast, plain = np.zeros(500), np.zeros(500)
    heightfield.columns_cut(fast, points, starts, ends, 6.0, corner, 4.0)
    heightfield.columns_cut_reference(plain, points, starts, ends, 6.0, corner, 4.0)
    assert np.abs(fast - plain).max() < 1e-9
    # Some are cut, and of some the tops are beyond the flutes of cuts that would take them.
    deeper = np.zeros(500)
    heightfield.columns_cut(deeper, points, starts, ends, 6.0, corner, 100.0)
    assert (fast < 0.0).any() and (deeper < fast).any()


def test_the_compiled_greatest_height_is_that_of_its_plain_form() -> None:
    random = np.random.default_rng(8)
    heights = random.random((50, 40))
    for a, b, radius in zip(
        random.uniform(-5, 30, (50, 2)),
        random.uniform(-5, 30, (50, 2)),
        random.uniform(0.1, 8, 50),
        strict=True,
    ):
        asked = (heights, 0.0, 0.0, 0.5, a, b, radius)
        assert heightfield.zmap_highest(*asked) == heightfield.zmap_highest_reference(*asked)


def test_a_cutter_smaller_than_a_cell_removes_nothing_for_certain() -> None:
    heights = np.zeros((10, 10))
    heightfield.zmap_cut(
        heights,
        0.0,
        0.0,
        1.0,
        np.array([[5.0, 5.0, -1.0]]),
        np.array([[6.0, 5.0, -1.0]]),
        0.4,
        0.0,
        math.inf,
        np.zeros((1, 2)),
    )
    assert not heights.any()


@pytest.mark.parametrize("seed", range(20))
def test_a_strip_of_any_width_is_clear_only_where_nothing_stands_over_it(seed: int) -> None:
    """Also one so narrow that no cell has its middle in it: a rib's top between two rows of cells counted as clear."""
    draw = np.random.default_rng(seed)
    stock = PlanningStock.of(BLANK, SETUP)
    x, y = draw.uniform(5.0, 40.0), draw.uniform(5.0, 35.0)
    strip = Region.rectangle(x, y, x + draw.uniform(0.5, 15.0), y + draw.uniform(0.02, 0.9))
    assert not stock.is_clear(1.9, strip)
    assert stock.is_clear(2.1, strip)
    builder = PathBuilder(mill(10), cutting(4, 4), stock, SETUP, 2.0)
    builder.rapid((-10, y, 50))
    builder.line((-10, y, -3), 500.0)
    builder.line((70, y, -3), 500.0)
    after = stock.after(builder.finished(), mill(10))
    assert after.is_clear(-2.9, strip) and not after.is_clear(-3.1, strip)


def test_beside_the_blank_everything_is_clear() -> None:
    stock = PlanningStock.of(BLANK, SETUP)
    assert stock.is_clear(-30.0, Region.rectangle(70.0, 10.0, 80.0, 10.1))
