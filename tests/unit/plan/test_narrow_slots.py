"""Slots narrower than every end mill for pockets: a small one cuts them, and nothing else on the part."""

from __future__ import annotations

from pathlib import Path

import cadquery as cq
import numpy as np
import pytest

from trunnion.pipeline import Engine

SMALLEST = 4.0
"""Diameter of the smallest end mill that pockets are planned with, mm."""


def _plate(seed: int, folder: Path) -> Path:
    """Return a plate with a pocket and three slots, all of them narrower than `SMALLEST` mm, one of them right through."""
    rng = np.random.default_rng(seed)
    plate = cq.Workplane("XY").box(90.0, 60.0, 10.0, centered=(True, True, False))
    pocket = cq.Workplane("XY").box(40.0, 25.0, 6.0, centered=(True, True, False))
    plate = plate.cut(pocket.edges("|Z").fillet(6.0).translate((-15.0, 0.0, 4.0)))
    for y, depth in zip((-15.0, 0.0, 15.0), (10.0, *rng.uniform(2.0, 7.0, 2)), strict=True):
        width, length = rng.uniform(3.3, 3.95), rng.uniform(12.0, 22.0)
        slot = cq.Workplane("XY").slot2D(float(length), float(width)).extrude(float(depth))
        plate = plate.cut(slot.translate((25.0, y, 10.0 - float(depth))))
    path = folder / "slots.step"
    cq.exporters.export(plate, str(path))
    return path


@pytest.mark.parametrize("seed", range(3))
def test_narrow_slots_get_small_end_mills_and_no_other_pocket_does(seed, tmp_path):
    engine = Engine()
    session = engine.run(engine.open(_plate(seed, tmp_path)), "route")
    slots = {p.id for p in session.recognition.of_kind("pocket") if p.sizes["corner_radius"] < 2.0}
    assert len(slots) == 3
    for operation in session.process.operations:
        assert (operation.cutter.diameter < SMALLEST) == (operation.feature in slots), operation.id
    assert not [f for f in session.findings() if f.code == "route.no-cutter"]
    told = {f.where[0] for f in session.findings() if f.code == "route.second-choice"}
    assert told == slots


def test_a_plate_with_narrow_slots_is_released(tmp_path):
    engine = Engine()
    verdict = engine.run(engine.open(_plate(0, tmp_path))).verdict
    assert verdict.releases and verdict.coverage > 0.99 and verdict.gouge == 0.0


def test_a_slot_that_nothing_gets_into_is_told_with_the_smallest_that_was_tried(tmp_path):
    plate = cq.Workplane("XY").box(60.0, 40.0, 20.0, centered=(True, True, False))
    slot = cq.Workplane("XY").slot2D(20.0, 2.0).extrude(20.0)
    cq.exporters.export(plate.cut(slot), str(tmp_path / "deep.step"))
    engine = Engine()
    session = engine.run(engine.open(tmp_path / "deep.step"), "route")
    (told, *_) = [f for f in session.findings() if f.code == "route.no-cutter"]
    assert "20" in told.text and "reaches" in told.text


@pytest.mark.parametrize("width", (3.1, 3.33, 3.6, 3.9))
@pytest.mark.parametrize("aside", (0.0, 0.17, 0.31))
def test_a_slot_between_two_rows_of_cells_is_roughed_before_its_walls(width, aside, tmp_path):
    """No cell of the stock's field had its middle in what is left of such a slot without its rim: it counted as cleared, and the cutter
    of the walls went in full."""
    plate = cq.Workplane("XY").box(60.0, 40.0, 10.0, centered=(True, True, False))
    slot = cq.Workplane("XY").slot2D(20.0, width).extrude(10.0).translate((0.0, aside, 0.0))
    cq.exporters.export(plate.cut(slot), str(tmp_path / "slot.step"))
    engine = Engine()
    session = engine.run(engine.open(tmp_path / "slot.step"), "toolpath")
    (pocket,) = session.recognition.of_kind("pocket")
    rough = [o.id for o in session.process.operations if o.kind == "rough"]
    laid = {p.operation for p in session.paths if len(p.path)}
    assert any(o.startswith(f"rough-{pocket.id}") and o in laid for o in rough)
