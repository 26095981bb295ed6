"""What the plan foresees of the spindle's load is never less than what the proof measures, and not absurdly more."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import Any

import cadquery as cq
import numpy as np
import pytest

from long_mark import mostly_long
from samples import ball_shape, dome_on_a_plate_shape, written
from seeded.pockets import random_panel
from trunnion.model.session import Session
from trunnion.pipeline import Engine

SEEDS = range(12)
NOT_LESS = 0.95
"""Of the measured: the stock's cells let the proof see a little more than there is."""
NOT_MUCH_MORE = 1.5
FULL_TURN = 0.95 * np.pi
"""rad: an engagement that counts as full width."""


@cache
def programmed(seed: int) -> Session:
    engine = Engine()
    return engine.run(engine.open(written(random_panel(seed))))


def ratios(session: Session) -> dict[str, float]:
    """Return foreseen over measured power of every operation that cuts."""
    proofs = {p.operation: p for p in session.verdict.operations}
    return {
        o.id: o.data.highest_power / proofs[o.id].power
        for o in session.process.operations
        if o.id in proofs and proofs[o.id].power
    }


@pytest.mark.parametrize("seed", SEEDS)
def test_a_panel_is_foreseen_to_load_the_spindle_as_the_proof_sees_it(seed):
    found = ratios(programmed(seed))
    assert found and {id: ratio for id, ratio in found.items() if ratio < NOT_LESS} == {}


@pytest.mark.parametrize("seed", SEEDS)
def test_no_panel_passes_the_spindles_power_without_a_word(seed):
    session = programmed(seed)
    told = {f.where[0] for f in session.findings() if f.code == "optimize.load"}
    assert {f.where[0] for f in session.verdict.findings if f.code == "verify.power"} <= told


def test_what_is_foreseen_at_full_width_is_near_what_is_measured():
    found = [
        ratio
        for seed in SEEDS
        for id, ratio in ratios(programmed(seed)).items()
        if id.startswith("rough-")
    ]
    assert len(found) >= len(SEEDS)
    assert float(np.mean(found)) <= NOT_MUCH_MORE


CLOSE = (1.0 / 1.15, 1.15)
"""What a strategy's laid paths come to, over what is measured of them, on the median."""
FEW = 6
"""Operations of a strategy below which a median says little."""
IN_CORNERS = {"plane.corner", "plane.wall"}
"""Their thickest chip is that of a moment in a corner, which the proof takes from its widest probe and the plan from half a radius' way;
and a long block's rate is to the proof that of its widest end."""


@cache
def laid() -> dict[str, np.ndarray]:
    """Return by strategy of each operation (n, 3) power, chip and removal rate that its path comes to, over the measured."""
    found = defaultdict(list)
    for session in map(programmed, SEEDS):
        proofs = {p.operation: p for p in session.verdict.operations}
        for o in session.process.operations:
            path, proof = session.path_of(o.id), proofs.get(o.id)
            if path is not None and proof is not None and proof.power:
                found[o.strategy].append(
                    (path.power / proof.power, path.chip / proof.chip, path.rate / proof.rate)
                )
    return {name: np.array(rows) for name, rows in found.items() if len(rows) >= FEW}


def medians(column: int) -> dict[str, float]:
    return {name: float(np.median(rows[:, column])) for name, rows in laid().items()}


def test_the_power_that_laid_paths_come_to_is_what_is_measured_of_them():
    power = medians(0)
    assert len(power) >= 6
    assert {n: r for n, r in power.items() if not CLOSE[0] <= r <= CLOSE[1]} == {}


@pytest.mark.parametrize("column", [1, 2], ids=["chip", "removal"])
def test_chips_and_removal_of_laid_paths_are_what_is_measured_of_them(column):
    found = {name: r for name, r in medians(column).items() if name not in IN_CORNERS}
    assert {n: r for n, r in found.items() if not CLOSE[0] <= r <= CLOSE[1]} == {}


@cache
def roughed(shape: Callable[[], Any]) -> Session:
    """Return the session of a curved part whose finishing is left out."""
    engine = Engine()
    session = engine.run(engine.open(written(shape())), until="optimize")
    operations = tuple(replace(o, suppressed=o.kind != "rough") for o in session.process.operations)
    return engine.run(replace(session, process=replace(session.process, operations=operations)))


CURVED = (dome_on_a_plate_shape, ball_shape)


@pytest.mark.timeout(600)
@pytest.mark.parametrize("shape", mostly_long(CURVED, ball_shape))
def test_roughing_of_a_curved_part_is_foreseen_too(shape):
    found = ratios(roughed(shape))
    assert found and min(found.values()) >= NOT_LESS


def trough_shape() -> Any:
    """Return a block with a trough as deep as one layer, with leaning sides: roughing can't come into it from outside."""
    block = cq.Workplane("XY").box(150.0, 80.0, 24.0, centered=(True, True, False))
    trough = cq.Workplane("XY", origin=(0.0, 0.0, 11.7)).slot2D(90.0, 34.0)
    return block.cut(trough.extrude(12.3, taper=-30.0)).val().wrapped


QUICK_CURVED, EVERY_CURVED = (ball_shape, trough_shape), (*CURVED, trough_shape)


@pytest.mark.timeout(600)
@pytest.mark.parametrize("shapes", mostly_long((QUICK_CURVED, EVERY_CURVED), QUICK_CURVED), ids=len)
def test_what_is_foreseen_of_curved_parts_at_full_width_is_near_what_is_measured(shapes):
    found = [
        ratios(session)[p.operation]
        for session in map(roughed, shapes)
        for p in session.verdict.operations
        if p.engaged > FULL_TURN
    ]
    assert found
    assert float(np.mean(found)) <= NOT_MUCH_MORE
