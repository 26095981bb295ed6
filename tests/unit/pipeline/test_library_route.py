"""A route that follows a plan of the library: a sibling gets nearly all of it, other parts get none, an empty library changes nothing."""

from __future__ import annotations

import sqlite3
from contextlib import closing
from dataclasses import replace
from functools import cache

import pytest

import samples
from seeded.casings import short_ring
from trunnion.findings import BadCall, BadInput
from trunnion.pipeline import Engine
from trunnion.pipeline.planning.library import add_to_library, library_choice, matches
from trunnion.plan.freeform.keys import SCALLOP
from trunnion.plan.manual.operation_change import OperationChange
from trunnion.settings import choose
from trunnion.shop.library import PlanLibrary

CHOICES = {"setup.machine": "Trunnion 650"}
TOPS = ("boss-tops-boss-01", "boss-tops-boss-02")
SMALLER = "AL3-stub D10 R0"
"""The end mill that a person takes for the tops of both bosses."""


@cache
def finished():
    """Return an engine and the session of the short ring, routed and then changed by hand: other cutters for tops, one of them faster."""
    engine = Engine()
    part = samples.written(short_ring(), name="short-ring")
    session = engine.with_choices(engine.open(part), {**CHOICES, "casing.scallop": 0.008})
    session = engine.run(session, "route")
    for id in TOPS:
        session = engine.with_operation_change(session, id, change(tool=SMALLER, spindle=9000.0))
    return engine, session


@cache
def sibling():
    """Return an engine and the session of a ring whose drilled boss is elsewhere, with a smaller gap to the lower flange."""
    engine = Engine()
    session = engine.open(samples.written(short_ring(75.0, 11.5), name="sibling"))
    return engine, engine.run(engine.with_choices(session, CHOICES), "blank")


@cache
def panel():
    engine = Engine()
    session = engine.open(samples.written(samples.two_pockets_and_a_rib_shape()))
    return engine, engine.run(session, "blank")


def change(**values) -> OperationChange:
    return choose(OperationChange, {f"operation.{name}": v for name, v in values.items()})


@pytest.fixture
def library(tmp_path):
    """A library with what the finished ring teaches."""
    made = PlanLibrary(tmp_path / "plan-library.sqlite")
    _, session = finished()
    add_to_library(session, with_library(finished, made), name="RING", date="2026-01-01")
    return made


def with_library(of, library):
    """Return the context of a part with a library."""
    engine, session = of()
    return replace(engine.context_of(session), library=library)


def routed(of, library, until="route", **choices):
    """Return the session of a part routed with a library."""
    engine, session = of()
    session = engine.with_choices(session, choices)
    known = engine._contexts
    assert known is not None
    known._made[()] = with_library(of, library)
    try:
        return engine.run(session, until)
    finally:
        known._made[()] = with_library(of, None)


def of_library(session):
    """Return the findings of a route on the library."""
    return [f for f in session.process.findings if f.code == "route.library"]


def test_a_sibling_gets_nearly_all_its_operations_from_the_plan(library):
    session = routed(sibling, library)
    operations = session.process.operations
    taken = [o for o in operations if "From the taught plan RING" in o.rules[-1]]
    assert len(taken) >= 0.9 * len(operations) and len(operations) >= 8
    assert session.process.plan == "RING"
    # What the person changed is there too, without being called a person's work on this part.
    for id in TOPS:
        top = session.process.operation(id)
        assert top.tool.name == SMALLER and not top.by_hand
        assert top.data.spindle == 9000.0 and top.taught_data
    (finding,) = of_library(session)
    words = ("follows the plan RING", "similarity 100 %", "5 of 5 kinds of features", "operations")
    assert all(w in finding.text for w in words)


def test_a_smaller_gap_gets_another_cutter_with_the_reason_kept(library):
    session = routed(sibling, library)
    _, taught = finished()
    bottom = session.process.operation("bottoms-pocket-01")
    before = taught.process.operation("bottoms-pocket-01")
    assert bottom.tool.diameter < before.tool.diameter
    assert f"{before.tool.name} does not fit here (the gap is too narrow" in bottom.rules[-1]
    assert "with another cutter" in of_library(session)[0].text


def test_data_of_the_plan_stay_when_data_are_computed_again(library):
    session = routed(sibling, library, "optimize")
    assert session.process.operation(TOPS[0]).data.spindle == 9000.0


def test_settings_of_the_plan_are_taken_but_for_those_that_the_session_sets(library):
    scallops = {
        o.choices[SCALLOP]
        for o in routed(sibling, library).process.operations
        if SCALLOP in o.choices
    }
    own = routed(sibling, library, **{"casing.scallop": 0.02}).process.operations
    assert scallops == {0.008}
    assert {o.choices[SCALLOP] for o in own if SCALLOP in o.choices} == {0.02}


def test_with_an_empty_library_route_and_digest_are_what_they_were(tmp_path):
    library = PlanLibrary(tmp_path / "plan-library.sqlite")
    plain, with_empty = routed(sibling, None), routed(sibling, library)
    assert with_empty.records["route"].key == plain.records["route"].key
    assert with_empty.process.findings == plain.process.findings
    assert [repr(o) for o in with_empty.process.operations] == [
        repr(o) for o in plain.process.operations
    ]


def test_a_route_is_stale_once_another_plan_would_be_taken(library):
    session = routed(sibling, library)
    context = with_library(sibling, library)
    step = next(s for s in steps() if s.name == "route")
    assert step.key(session, context) == session.records["route"].key
    library.remove("RING")
    assert step.key(session, context) != session.records["route"].key


def steps():
    from trunnion.pipeline.steps import STEP_TABLE

    return STEP_TABLE


def test_a_panel_is_no_sibling_of_a_casing(library):
    session = routed(panel, library)
    (finding,) = of_library(session)
    assert "it has none for parts of this family" in finding.text
    assert session.process.plan != "RING"
    assert not any("taught plan" in r for o in session.process.operations for r in o.rules)


def test_a_part_that_is_not_similar_enough_says_what_is_nearest(library):
    engine, session = sibling()
    session = engine.with_choices(session, {"setup.machine": "Mill 1200"})
    asked = engine.with_choices(session, {"route.library.similarity": 0.95})
    context = with_library(sibling, library)
    (match,) = matches(asked, context)
    # Another kind of machine is a tenth.
    assert match.similarity.value == pytest.approx(0.9)
    choice = library_choice(asked, context)
    assert choice.plan is None
    assert "95 % is asked for" in choice.findings[0].text and "RING with 90 %" in (
        choice.findings[0].text
    )
    assert library_choice(session, context).plan is not None


def test_a_part_does_not_follow_its_own_plan_unless_that_is_named(library):
    """A finished and proven process must not go stale because it was added to the library."""
    engine, session = finished()
    context = with_library(finished, library)
    step = next(s for s in steps() if s.name == "route")
    assert step.key(session, context) == session.records["route"].key
    choice = library_choice(engine.with_choices(session, {"route.library.use": "RING"}), context)
    assert choice.plan.name == "RING"


def test_off_and_a_named_typical_plan_leave_the_library_alone(library):
    context = with_library(sibling, library)
    engine, session = sibling()
    for choices in ({"route.library.use": "off"}, {"route.plan": "Casing"}):
        choice = library_choice(engine.with_choices(session, choices), context)
        assert choice.plan is None and choice.findings == ()


def test_a_plan_that_is_named_is_followed_however_similar_or_refused_in_words(library):
    context = with_library(sibling, library)
    engine, session = sibling()
    named = {"route.library.use": "RING", "route.library.similarity": 1.0}
    other = engine.with_choices(session, {**named, "setup.machine": "Mill 1200"})
    assert library_choice(other, context).plan.name == "RING"
    unknown = engine.with_choices(session, {"route.library.use": "RANG"})
    with pytest.raises(BadInput, match="no plan RANG in the library; known: RING"):
        library_choice(unknown, context)
    flat, part = panel()
    with pytest.raises(BadInput, match="it is for parts of the family casing"):
        library_choice(flat.with_choices(part, named), with_library(panel, library))


def test_a_library_that_cannot_be_read_is_a_warning_and_the_route_goes_on(library):
    library.path.write_bytes(b"nothing of the kind " * 50)
    session = routed(sibling, library)
    (finding,) = of_library(session)
    assert finding.severity == "warning" and str(library.path) in finding.text
    assert len(session.process.operations) >= 8


def test_a_plan_whose_words_are_not_known_any_more_is_not_followed(library):
    with closing(sqlite3.connect(library.path)) as database, database:
        database.execute(
            """UPDATE plan SET content = replace(content, '"cutter": "side"', '"cutter": "flank"')"""
        )
    choice = library_choice(sibling()[1], with_library(sibling, library))
    assert choice.plan is None
    assert "cutter rule flank" in choice.findings[0].text


def test_names_with_a_meaning_are_refused_and_so_is_what_is_not_planned(library):
    _, session = finished()
    context = with_library(finished, library)
    for name in ("auto", "off", "Casing"):
        with pytest.raises(BadInput, match="choose another name"):
            add_to_library(session, context, name=name, date="")
    with pytest.raises(BadCall, match="generate the route first"):
        add_to_library(sibling()[1], context, name="X", date="")
