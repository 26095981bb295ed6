"""The plan library on whole parts: a sibling of A2 gets nearly all of A2's plan, A4 and panels are no siblings of A2."""

from __future__ import annotations

from functools import cache

import pytest

import samples
from moved_bosses import sibling_of_a2
from parts import PARTS, needs_parts
from taught_plans import plan
from trunnion.pipeline import Engine
from trunnion.pipeline.planning.library import (
    add_to_library,
    library_choice,
    matches,
    signature_of,
)

pytestmark = [pytest.mark.long, pytest.mark.timeout(3600), needs_parts]
CHOICES = {"setup.machine": "Universal 1250"}


@cache
def signature():
    """Return the signature of A2."""
    engine = Engine()
    session = engine.with_choices(engine.open(PARTS / "casing" / "A2.step"), CHOICES)
    session = engine.run(session, "blank")
    return signature_of(session, engine.context_of(session))


def prepared(folder, part, until="blank"):
    """Return an engine with a library in a folder, and the session of a part until a step."""
    engine = Engine(folder)
    return engine, engine.run(engine.with_choices(engine.open(part), CHOICES), until)


@pytest.mark.parametrize("name", ["casing/A4", "panel/B1", "panel/B2"])
def test_another_casing_and_panels_are_no_siblings(tmp_path, name):
    engine, session = prepared(tmp_path, PARTS / f"{name}.step")
    engine.library.add(plan("A2", signature()))
    choice = library_choice(session, engine.context_of(session))
    assert choice.plan is None
    assert "no plan of the library is similar enough" in choice.findings[0].text


def test_a_sibling_is_found_with_its_reason(tmp_path):
    engine, session = prepared(tmp_path, samples.written(sibling_of_a2(), name="A2-sibling"))
    engine.library.add(plan("A2", signature()))
    (match,) = matches(session, engine.context_of(session))
    assert match.similarity.value >= 0.95
    assert "7 of 7 kinds of features and 127 of 127 features" in match.similarity.words


def test_a_sibling_with_smaller_gaps_gets_nearly_all_its_operations_from_the_plan(tmp_path):
    engine, session = prepared(tmp_path, PARTS / "casing" / "A2.step", "route")
    add_to_library(session, engine.context_of(session), name="A2", date="2026-03-01")
    part = samples.written(sibling_of_a2(), name="A2-sibling")
    _, sibling = prepared(tmp_path, part, "route")
    operations = sibling.process.operations
    taken = [o for o in operations if "From the taught plan A2" in o.rules[-1]]
    assert len(taken) >= 0.9 * len(operations)
    changed = [o for o in taken if "with another cutter" in o.rules[-1]]
    assert any("too narrow" in o.rules[-1] for o in changed)
