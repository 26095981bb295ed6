"""What every registered planner must do, whoever wrote it: ours, and those of packages in `tests/families`."""

from __future__ import annotations

from dataclasses import replace

import pytest

from subjects import (
    PLANNERS,
    check_cancel,
    check_settings,
    dear_ones_long,
    is_one_line,
    own,
    until,
)
from trunnion import registry
from trunnion.findings import Refused
from trunnion.model.blank import Box
from trunnion.model.process import ProcessTree
from trunnion.pipeline.planning.library import add_to_library
from trunnion.pipeline.planning.scene import SessionContext, SetupScene
from trunnion.pipeline.steps import step_named
from trunnion.plan.contract import DriveNeeds, planner_for
from trunnion.plan.settings import RouteSettings
from trunnion.plan.setups import SetupSettings
from trunnion.plan.typical import typical_plan
from trunnion.progress import NO_PROGRESS
from trunnion.recognize.contract import feature_kinds
from trunnion.settings import GROUPS, declared, digest
from trunnion.shop.library import PlanLibrary
from trunnion.store.mapping import Members, from_xml, to_xml
from trunnion.store.process import process_xml

by_name = pytest.mark.parametrize("name", PLANNERS)
BLANK = "blank"
"""What a typical plan does once a setup."""
SHARED = {SetupSettings, RouteSettings}
"""Settings of routes that several planners take."""


def routed(name):
    """Return engine and session of a small part of the planner's family, with operations that have their data."""
    return own(name)[0], until(name, "optimize")


def route_again(name, progress=NO_PROGRESS, **choices):
    """Return the process that the planner makes of the same blank and features once more."""
    engine, session = own(name)[0], until(name, "blank")
    session = replace(session, choices={**session.choices, **choices})
    return step_named("route").work(session, engine.context, progress).session.process


def scene_of(name):
    engine, session = routed(name)
    return SetupScene(
        context=SessionContext(engine.context, session),
        recognition=session.recognition,
        blank=session.blank,
        setup=session.setups[0],
        process=session.process,
        fixtures=(),
    )


def needs_of(operation) -> DriveNeeds:
    strategy = registry.get("strategies", operation.strategy)
    return DriveNeeds(drive=strategy.drive, finds_rest=strategy.finds_rest)


def test_a_planner_of_a_package_is_among_them():
    assert set(PLANNERS) > {"panel", "surface"}


@by_name
def test_it_plans_the_family_that_it_is_registered_under(name):
    planner = planner_for(name)
    assert planner.name == name in registry.names("families")
    assert is_one_line(planner.noun) and len(set(planner.cutter_rules)) == len(planner.cutter_rules)
    assert planner.can_plan(own(name)[0].context.part) is None


@by_name
def test_its_settings_are_complete(name):
    assert planner_for(name).settings
    for group in planner_for(name).settings:
        check_settings(group)


@by_name
def test_its_typical_plans_name_what_there_is(name):
    shop, planner = own(name)[0].context.shop, planner_for(name)
    kinds = {BLANK, *feature_kinds()}
    plans = [plan for plan in shop.plans.values() if plan.family == name]
    assert plans
    for plan in plans:
        stages = typical_plan(shop, name, plan.name, planner.cutter_rules).stages
        assert {s.strategy for s in stages} <= set(registry.names("strategies"))
        assert {kind for s in stages for kind in s.on} <= kinds
        assert all(is_one_line(s.rule) for s in stages)


@pytest.mark.parametrize("name", dear_ones_long(PLANNERS))
def test_the_same_part_gives_the_same_bytes(name):
    session = routed(name)[1]
    first, second = (process_xml(route_again(name), session.part) for _ in (0, 1))
    assert first == second


@by_name
def test_operations_have_names_of_their_own_and_say_why(name):
    process = routed(name)[1].process
    ids = [o.id for o in process.operations]
    assert len(set(ids)) == len(ids) > 0
    assert all(" " not in id and id.isascii() for id in ids)
    assert all(o.rules and all(map(is_one_line, o.rules)) for o in process.operations)


@by_name
def test_operations_name_setups_strategies_faces_and_numbered_tools(name):
    engine, session = routed(name)
    setups = {s.name for s in session.setups}
    numbers = {}
    for o in session.process.operations:
        assert o.setup in setups and o.strategy in registry.names("strategies")
        assert set(o.faces) <= set(engine.context.part.tags)
        assert numbers.setdefault(o.tool.number, o.tool) == o.tool and o.tool.number > 0


@by_name
def test_what_must_come_before_does(name):
    done: set[str] = set()
    for o in routed(name)[1].process.operations:
        assert set(o.after) <= done, o.id
        done.add(o.id)


@by_name
def test_every_feature_is_planned_or_in_a_finding(name):
    session = routed(name)[1]
    served = {word for f in session.process.findings for word in f.where}
    cut = {tag for o in session.process.operations for tag in o.faces}
    for feature in session.recognition:
        planned = any(o.feature == feature.id for o in session.process.operations)
        told = served & {feature.id, *(f"face {tag}" for tag in feature.tags)}
        assert planned or told or set(feature.tags) & cut, feature.id


@by_name
def test_cutting_data_are_what_a_machine_can_do(name):
    engine, session = routed(name)
    for o in session.process.operations:
        machine = engine.context.shop.machine(session.process.setup(o.setup).machine)
        assert 0.0 < o.data.plunge_feed <= o.data.feed <= machine.feed_max * (1 + 1e-9), o.id
        assert machine.spindle_low <= o.data.spindle <= machine.spindle_high * (1 + 1e-9), o.id
        assert 0.0 < o.data.depth <= o.tool.flute_length and o.data.width > 0.0, o.id


@by_name
def test_what_it_chooses_for_operations_are_values_that_are_allowed(name):
    known = {d.key: d for group in GROUPS.values() for d in declared(group)}
    for o in routed(name)[1].process.operations:
        for key, value in o.choices.items():
            if key in known:
                assert known[key].parse(value) == value, (o.id, key)


@by_name
def test_its_route_reads_its_own_settings_and_no_others(name):
    engine, session = routed(name)
    step, own_groups = step_named("route"), {SetupSettings, *planner_for(name).settings}
    assert set(step.uses(session)) == own_groups
    for group in step.settings():
        number = next((d for d in declared(group) if d.kind is float and d.low < d.high), None)
        if number is None:
            continue
        value = number.low if number.default != number.low else number.high
        changed = replace(session, choices={**session.choices, number.key: value})
        moved = step.key(changed, engine.context) != step.key(session, engine.context)
        assert moved == (group in own_groups), number.key


@by_name
def test_its_drives_can_be_told_apart_and_lie_in_a_setups_frame(name):
    session, scene = routed(name)[1], scene_of(name)
    for o in session.process.of_setup(session.setups[0].name):
        first, again = (planner_for(name).drive(o, needs_of(o), scene, NO_PROGRESS) for _ in (0, 1))
        assert isinstance(first.drive, needs_of(o).drive)
        assert first.drive.is_empty in (True, False)
        assert digest(first.identity) == digest(again.identity)
        assert first.setup.name == o.setup and first.setup.frame is not None


@by_name
def test_a_drive_that_it_does_not_make_is_refused_in_words(name):
    operation = routed(name)[1].process.operations[0]
    with pytest.raises(
        Refused, match=f"driven by a int, which is not made for {planner_for(name).noun}"
    ):
        planner_for(name).drive(operation, DriveNeeds(drive=int), None, NO_PROGRESS)


@by_name
def test_a_blank_that_no_machine_takes_is_said(name):
    engine, session = own(name)[0], until(name, "blank")
    blank = session.blank
    large = Box(
        frame=blank.frame,
        low=blank.low,
        high=blank.low + 9e4,
        material=blank.material,
        density=blank.density,
    )
    after = (
        step_named("route").work(replace(session, blank=large), engine.context, NO_PROGRESS).session
    )
    assert "route.travel" in {f.code for f in after.process.findings}


@by_name
def test_its_process_is_read_back_from_a_project_and_fits_the_schema(name):
    session, members = routed(name)[1], Members()
    kept = to_xml(session.process, ProcessTree, "process", members)
    again = from_xml(kept, ProcessTree, Members(members.files))
    assert process_xml(again, session.part) == process_xml(session.process, session.part)
    assert [o.id for o in again.operations] == [o.id for o in session.process.operations]
    assert digest(*again.operations) == digest(*session.process.operations)


@by_name
def test_it_stops_soon_after_it_was_asked_to(name):
    route_again(name)
    check_cancel(lambda progress: route_again(name, progress))


@pytest.mark.parametrize("name", dear_ones_long(PLANNERS))
def test_a_plan_that_its_part_has_taught_gives_the_same_operations_again(name, tmp_path):
    engine, session = own(name)[0], until(name, "route")
    library = PlanLibrary(tmp_path / "plan-library.sqlite")
    context = replace(engine.context_of(session), library=library)
    result = add_to_library(session, context, name="taught", date="2026-03-01")
    assert all(size > 0.0 for size in result.plan.signature.sizes.values())
    assert result.plan.signature.sizes and result.plan.signature.features
    again = replace(
        until(name, "blank"),
        choices={**session.choices, "route.library.use": "taught"},
        process=None,
    )
    process = step_named("route").work(again, context, NO_PROGRESS).session.process
    assert process.plan == "taught"
    plain = [replace(o, rules=()) for o in session.process.operations]
    assert digest([replace(o, rules=()) for o in process.operations]) == digest(plain)
    assert all(o.rules[-1].startswith("From the taught plan") for o in process.operations)
