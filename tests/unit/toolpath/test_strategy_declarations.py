"""What a strategy declares decides how it is served; its name says nothing."""

from __future__ import annotations

from dataclasses import replace

import pytest

from trunnion import registry
from trunnion.findings import warning
from trunnion.model.operation import OperationPath
from trunnion.pipeline import Engine
from trunnion.pipeline.toolpaths import findings_of, make_paths
from trunnion.plan.freeform.keys import EARLIER
from trunnion.plan.prismatic.drive import PlaneDrive
from trunnion.progress import NO_PROGRESS
from trunnion.settings import settings
from trunnion.toolpath.contact_passes.choices import HINDERED
from trunnion.toolpath.contract import (
    Planned,
    ToolAxis,
    fixed_axis,
    lead_and_tilt,
    leaning_axis,
    strategy,
)


@settings("shop.test")
class NoSettings:
    """A strategy of a test takes none."""


@strategy(settings=NoSettings, leaves=("shop.left",))
def leaving(drive, tool, data, stock, setup, settings, progress):
    """Return no motions."""
    return Planned()


@strategy(settings=NoSettings, settles=("shop.left",))
def settling(drive, tool, data, stock, setup, settings, progress):
    """Return no motions."""
    return Planned()


@pytest.fixture
def registered(monkeypatch):
    """Registers strategies for one test by name."""
    known = registry.get

    def register(**own):
        monkeypatch.setattr(registry, "get", lambda kind, name: own.get(name) or known(kind, name))

    return register


@pytest.fixture(scope="module")
def routed(sample_panel):
    """An engine and its session of the small panel, with operations."""
    engine = Engine()
    return engine, engine.run(engine.open(sample_panel), until="optimize")


def on_one_face(session, *strategies):
    """Return the process with its last operations by other strategies, all on face 1."""
    own = [
        replace(o, id=f"own-{n}", strategy=name, faces=(1,))
        for n, (o, name) in enumerate(zip(session.process.operations, strategies, strict=False))
    ]
    return replace(session.process, operations=tuple(own))


def told(process):
    path = OperationPath(operation="own-0", findings=(warning("shop.left", "a corner stays"),))
    return [f.code for f in findings_of([path], process)]


def test_a_strategy_of_any_name_gets_the_drive_it_declares(routed, registered) -> None:
    engine, session = routed
    got = []

    @strategy(settings=NoSettings, drive=PlaneDrive)
    def skim(drive, tool, data, stock, setup, settings, progress):
        got.append(type(drive))
        return Planned()

    registered(skim=skim)
    first = replace(session.process.operations[0], strategy="skim")
    make_paths(
        replace(session, process=replace(session.process, operations=(first,)), paths=()),
        engine.context,
        NO_PROGRESS,
    )
    assert got == [PlaneDrive]


def test_what_another_strategy_settles_on_the_same_face_is_not_told(routed, registered) -> None:
    registered(leaving=leaving, settling=settling)
    assert told(on_one_face(routed[1], "leaving", "settling")) == []


def test_what_nobody_settles_is_told(routed, registered) -> None:
    registered(leaving=leaving, settling=settling)
    assert told(on_one_face(routed[1], "leaving", "leaving")) == ["shop.left"]


def test_what_a_strategy_does_not_leave_to_others_is_told(routed, registered) -> None:
    registered(leaving=leaving, settling=settling)
    assert told(on_one_face(routed[1], "settling", "settling")) == ["shop.left"]


@pytest.mark.parametrize(("of", "says"), [("own", False), ("other", True), ("", True)])
def test_what_a_cutter_is_lifted_off_is_told_unless_an_operation_takes_its_rest(
    routed, of, says
) -> None:
    process = on_one_face(routed[1], "surface.constant", "surface.constant")
    own, other = process.operations
    names = {"own": own.cutter.name, "other": "another one", "": ""}
    rest = replace(other, choices={**other.choices, EARLIER: names[of]})
    path = OperationPath(operation="own-0", findings=(warning(HINDERED, "a corner stays"),))
    found = findings_of([path], replace(process, operations=(own, rest)))
    assert bool(found) is says
    idle = replace(process, operations=(own, replace(rest, suppressed=True)))
    assert findings_of([path], idle)


def test_the_tool_axis_follows_from_the_settings() -> None:
    parallel = registry.get("strategies", "surface.parallel")
    upright, leaning = parallel.settings(), parallel.settings(tilt=5.0)
    assert (fixed_axis(leaning), leaning_axis(upright)) == (ToolAxis.FIXED, ToolAxis.LEANING)
    assert (lead_and_tilt(upright), lead_and_tilt(leaning)) == (ToolAxis.FIXED, ToolAxis.LEANING)


def test_every_finding_that_a_strategy_leaves_is_settled_by_one_of_ours() -> None:
    ours = [registry.get("strategies", name) for name in registry.names("strategies")]
    assert {code for s in ours for code in s.leaves} <= {code for s in ours for code in s.settles}
