"""Plans with the tools in the machine: their numbers, what planners then choose from, and what lists have of them."""

from __future__ import annotations

from dataclasses import replace

import pytest

from flat_parts import operation
from own_shop import own_shop
from programs import BULL_10, FLAT_16, S1, S2
from samples import block_with_pocket
from trunnion.findings import BadInput, Severity, error
from trunnion.model.process import ProcessTree
from trunnion.pipeline import Engine
from trunnion.plan.loaded_tools import CODE, loaded_findings, planning_shop
from trunnion.plan.process import with_tool_numbers
from trunnion.shop.crib import Crib, CribTool, tools_listed
from trunnion.store.tool_crib import put_tool, set_wear

SHOP = own_shop()
MILL, LATHE = "Mill 1200", "Vertical lathe 600"
ONLY = {"route.only_in_machine": True}
DRILL = next(t for t in SHOP.tools if t.name == "DR-S D8")


def crib(machine, **numbers):
    tools = (CribTool(name=n, number=t) for n, t in numbers.items())
    return {machine: Crib(machine=machine, tools=tuple(sorted(tools, key=lambda t: t.number)))}


def numbers_of(operations):
    return [o.tool.number for o in operations]


ROUGH, WALL, HOLE, BACK = (
    operation("rough", "pocket-01", FLAT_16),
    operation("wall", "pocket-01", BULL_10),
    operation("drill", "hole-01", DRILL),
    replace(operation("face", "back", FLAT_16), setup="S2"),
)


def test_without_a_crib_tools_are_numbered_in_the_order_of_use():
    assert numbers_of(with_tool_numbers((ROUGH, WALL, HOLE, BACK))) == [1, 2, 3, 1]


def test_a_tool_in_the_machine_has_its_number_and_others_get_none_of_the_machine():
    cribs = crib(S1.machine, **{BULL_10.name: 1, "Not in use": 2})
    made = with_tool_numbers((ROUGH, WALL, HOLE, BACK), (S1, S2), cribs)
    assert numbers_of(made) == [3, 1, 4, 3]


def test_each_machine_has_numbers_of_its_own():
    other = replace(S2, machine="Other")
    cribs = crib(S1.machine, **{FLAT_16.name: 7}) | crib("Other", **{FLAT_16.name: 9, "X": 1})
    made = with_tool_numbers((ROUGH, WALL, BACK), (S1, other), cribs)
    assert numbers_of(made) == [7, 2, 9]
    tree = ProcessTree(plan="p", material="m", setups=(S1, other), operations=made, findings=())
    assert [t.number for t in tree.tools()] == [2, 7, 9]
    assert [t.number for t in tree.tools("Other")] == [9]
    assert [
        (t.tool.number, t.machine, t.crib and t.crib.number) for t in tools_listed(tree, cribs)
    ] == [
        (2, "", None),
        (7, S1.machine, 7),
        (9, "Other", 9),
    ]


def test_two_machines_may_call_other_tools_by_one_number():
    other = replace(S2, machine="Other")
    cribs = crib(S1.machine, **{FLAT_16.name: 7}) | crib("Other", **{BULL_10.name: 7})
    made = with_tool_numbers((ROUGH, replace(WALL, setup="S2")), (S1, other), cribs)
    tree = ProcessTree(plan="p", material="m", setups=(S1, other), operations=made, findings=())
    assert sorted(t.name for t in tree.tools()) == sorted((FLAT_16.name, BULL_10.name))
    assert [t.name for t in tree.tools(S1.machine)] == [FLAT_16.name]


def test_planners_choose_from_the_tools_in_the_machine_alone():
    shop = replace(
        SHOP, cribs=crib(MILL, **{DRILL.name: 3}) | crib(LATHE, **{SHOP.turning[0].name: 1})
    )
    assert planning_shop(shop, [MILL], {}) is shop
    found = planning_shop(shop, [MILL], ONLY)
    assert [t.name for t in found.tools] == [DRILL.name]
    assert found.turning == SHOP.turning[:1]
    assert found.cribs is shop.cribs and found.materials is shop.materials


def test_an_empty_machine_is_refused_in_one_line_with_what_to_do():
    with pytest.raises(BadInput, match="no tool of the catalogue is in Mill 1200.*--put NAME=T"):
        planning_shop(SHOP, [MILL], ONLY)
    shop = replace(SHOP, cribs=crib(MILL, Gone=1))
    with pytest.raises(BadInput, match="no tool of the catalogue is in Mill 1200"):
        planning_shop(shop, [MILL], ONLY)


def test_what_the_machine_lacks_is_told():
    setup = replace(S1, machine=MILL)
    shop = replace(SHOP, cribs=crib(MILL, **{DRILL.name: 3, "Gone": 1}))
    tree = ProcessTree(plan="p", material="m", setups=(setup,), operations=(HOLE,), findings=())
    assert loaded_findings(tree, shop, {}) == []
    summary, unknown = loaded_findings(tree, shop, ONLY)
    assert (summary.severity, summary.code) == (Severity.INFO, CODE)
    assert "2 tools in Mill 1200" in summary.text
    assert (unknown.code, unknown.where) == ("route.unknown-tool", ("Gone",))
    short = replace(tree, operations=(HOLE, ROUGH), findings=(error("route.no-tool", "none"),))
    summary, missing, _ = loaded_findings(short, shop, ONLY)
    assert summary.severity is Severity.WARNING and "only_in_machine = false" in summary.remedy
    assert missing.code == "route.not-in-machine" and missing.where == (ROUGH.id,)


@pytest.fixture(scope="module")
def unrestricted():
    engine = Engine()
    session = engine.run(engine.open(block_with_pocket()), until="route")
    return session.process


def route(folder, **choices):
    engine = Engine(folder)
    session = engine.with_choices(engine.open(block_with_pocket()), choices)
    return engine, engine.run(session, until="route")


def test_a_route_calls_tools_by_their_numbers_in_the_machine(tmp_path, unrestricted):
    machine = unrestricted.setups[0].machine
    first = unrestricted.tools()[0].name
    put_tool(tmp_path, SHOP, machine, first, number=41)
    _, session = route(tmp_path)
    numbers = {t.name: t.number for t in session.process.tools()}
    assert numbers[first] == 41
    assert sorted(numbers) == sorted(t.name for t in unrestricted.tools())
    others = sorted(n for name, n in numbers.items() if name != first)
    assert others == list(range(1, len(others) + 1))


def test_a_route_from_the_machine_alone_takes_its_tools_and_tells_what_it_lacks(
    tmp_path, unrestricted
):
    machine = unrestricted.setups[0].machine
    used = [t.name for t in unrestricted.tools()]
    other = next(
        t.name
        for t in SHOP.tools_for("N", "rough")
        if t.name not in used and t.form == "flat" and t.diameter == 12.0
    )
    put_tool(tmp_path, SHOP, machine, other, number=8)
    engine, session = route(tmp_path, only_in_machine=True)
    assert {t.name for t in session.process.tools()} == {other}
    assert {t.number for t in session.process.tools()} == {8}
    assert CODE in {f.code for f in session.process.findings}
    # Wear leaves the plan as it is; a tool more makes it stale.
    set_wear(tmp_path, machine, other, -0.01, -0.02)
    engine.reload_shop()
    assert engine.states(session)["route"] in ("done", "problem")
    (listed,) = tools_listed(session.process, engine.shop.cribs)
    assert listed.as_dict()["wear"] == {"length": -0.01, "radius": -0.02}
    assert listed.as_dict()["diameter"] == 12.0
    put_tool(tmp_path, SHOP, machine, used[0], number=9)
    engine.reload_shop()
    assert engine.states(session)["route"] == "stale"


def test_a_route_with_nothing_in_the_machine_is_refused(tmp_path):
    with pytest.raises(BadInput, match="no tool of the catalogue is in"):
        route(tmp_path, only_in_machine=True)
