"""Casings through the whole line on a five-axis machine: released, no gouge, no collision, no rapid in stock."""

from __future__ import annotations

import pytest

import samples
from releases import assert_released
from seeded.casings import bolted_ring, ribbed_ring, short_ring, small_casing
from seeded.recesses import recessed_ring
from trunnion.pipeline import Engine

pytestmark = [pytest.mark.long, pytest.mark.timeout(1800)]
CHOICES = {"setup.machine": "Trunnion 650", "recognize.family": "casing"}


@pytest.mark.parametrize(
    ("part", "coverage"),
    # The rib's sides that a boss runs into are planned for no operation yet: what the turned ring leaves on them stays.
    [(short_ring, 0.99), (small_casing, 0.99), (bolted_ring, 0.99), (ribbed_ring, 0.985)],
)
def test_a_casing_is_released(part, coverage):
    engine = Engine()
    session = engine.open(samples.written(part(), name="casing"))
    session = engine.run(engine.with_choices(session, CHOICES))
    assert_released(session, coverage=coverage)


@pytest.mark.parametrize(
    "form", [{}, {"slope": 0.2}, {"radial": True}, {"fillet": 1.0}, {"on_it": False}]
)
def test_a_casing_with_a_recess_is_released(form):
    engine = Engine()
    session = engine.open(samples.written(recessed_ring(**form), name="casing"))
    session = engine.run(engine.with_choices(session, CHOICES))
    # Over a ground of 38 mm parallel walls lean in by up to 20 degrees: no cutter goes into the corners at their feet.
    assert_released(session, coverage=0.98)


@pytest.mark.parametrize("part", [short_ring, bolted_ring])
def test_a_casing_is_turned_and_milled_from_a_bored_blank(part):
    engine = Engine()
    session = engine.open(samples.written(part(), name="casing"))
    words = {**CHOICES, "blank.kind": "turned", "blank.bored": True}
    session = engine.run(engine.with_choices(session, words))
    assert_released(session, coverage=0.99)
    turned = [o for o in session.process.operations if not o.tool.rotates]
    assert {o.setup for o in turned} == {"S1", "S2"}


@pytest.mark.parametrize("part", [short_ring, bolted_ring])
def test_gaps_between_bosses_are_turned_on_a_machine_that_turns_and_mills(part):
    engine = Engine()
    session = engine.open(samples.written(part(), name="casing"))
    words = {**CHOICES, "setup.machine": "Mill-turn 1250", "casing.regions.surface_speed": 8.0}
    session = engine.run(engine.with_choices(session, words))
    assert_released(session, coverage=0.99)
    assert [o for o in session.process.operations if o.tool.locked]
