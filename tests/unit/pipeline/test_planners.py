"""Planners: found by the family's name and asked for drives; common checks are in `tests/conformance/test_planners.py`."""

from __future__ import annotations

from dataclasses import replace

import pytest

from trunnion import registry
from trunnion.findings import BadInput, Severity
from trunnion.pipeline import Engine
from trunnion.pipeline.toolpaths import make_paths
from trunnion.plan.contract import DriveNeeds, driven_by, planner_for
from trunnion.progress import NO_PROGRESS
from trunnion.shop import load_shop


class WedgePlanner:
    """A planner of a test: it makes no drives."""

    name, noun, settings, cutter_rules = "wedge", "wedges", (), ()

    def drive(self, operation, needs, scene, progress):
        """Make no drive."""
        return driven_by({}, self, operation, needs, scene, progress)


@pytest.fixture
def wedges(monkeypatch):
    """Registers the planner of wedges for one test."""
    known, names = registry.get, registry.names
    monkeypatch.setattr(
        registry,
        "get",
        lambda kind, name: (
            WedgePlanner if (kind, name) == ("planners", "wedge") else known(kind, name)
        ),
    )
    monkeypatch.setattr(
        registry,
        "names",
        lambda kind: (*names(kind), "wedge") if kind == "planners" else names(kind),
    )


@pytest.fixture(scope="module")
def measured(sample_panel):
    """An engine and its session of the small panel, with a blank."""
    engine = Engine()
    return engine, engine.run(engine.open(sample_panel), until="blank")


@pytest.fixture(scope="module")
def routed(measured):
    """The same with operations."""
    engine, session = measured
    return engine, engine.run(session, until="optimize")


def as_family(session, family):
    return replace(session, recognition=replace(session.recognition, family=family))


def test_a_family_without_a_planner_is_refused_with_what_to_do() -> None:
    with pytest.raises(
        BadInput,
        match="parts of the family spindle are segmented and measured, but not planned yet; for flat pockets and "
        "outlines choose recognize.family = casing or impeller or panel or surface",
    ):
        planner_for("spindle")


def test_a_drive_that_a_planner_does_not_make_is_an_error_that_names_strategy_and_family(
    routed, wedges
) -> None:
    engine, session = routed
    first = replace(session.process, operations=session.process.operations[:1])
    found = make_paths(
        as_family(replace(session, process=first, paths=()), "wedge"), engine.context, NO_PROGRESS
    )[0].findings
    assert [(f.severity, f.code) for f in found] == [(Severity.ERROR, "toolpath.refused")]
    assert "plane.face is driven by a PlaneDrive, which is not made for wedges" in found[0].text


@pytest.mark.parametrize("family", registry.names("planners"))
def test_our_planners_drive_every_strategy_of_their_plans(routed, family) -> None:
    operation = routed[1].process.operations[0]
    plans = [p for p in load_shop().plans.values() if p.family == family]
    made = {registry.get("strategies", s.strategy).drive for p in plans for s in p.stages}
    assert made
    for drive in made:
        with pytest.raises(AttributeError):  # it goes for the scene: a drive of this class is made
            planner_for(family).drive(operation, DriveNeeds(drive=drive), None, NO_PROGRESS)


def test_unsewn_faces_are_refused_as_parts_of_curved_surfaces_only() -> None:
    class Faces:
        is_closed = False

    planner_for("panel").can_plan(Faces())
    with pytest.raises(BadInput, match="faces that enclose no material"):
        planner_for("surface").can_plan(Faces())
