"""Cutters of floors by time, on the sample panel: two of its floors are too narrow between islands for the cutter of the others."""

from __future__ import annotations

from pathlib import Path

import pytest

from trunnion.pipeline import Engine
from trunnion.plan.panel import route
from trunnion.plan.panel.floor_cutters import floor_time, quicker_floors
from trunnion_resources import sample


@pytest.fixture(scope="module")
def asked():
    """Return what was asked for cutters of floors when the sample was routed: state, tasks, fits, cutters before and after."""
    found = []

    def recorded(state, tasks, fits):
        before, made = dict(state.tools), quicker_floors(state, tasks, fits)
        if made:
            found.append((state, tasks, fits, before, made))
        return made

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(route, "quicker_floors", recorded)
        engine = Engine()
        engine.run(engine.open(Path(str(sample("B1")))), until="route")
    (only,) = found
    return only


def minutes(state, tasks, cutters) -> float:
    """Return how long floors take with their cutters, and tool changes for those that nothing else uses."""
    by_id = {t.id: t for t in tasks}
    others = {tool.name for id, tool in state.tools.items() if id not in cutters}
    fresh = {tool.name for tool in cutters.values()} - others
    return (
        sum(floor_time(state, by_id[id], tool) for id, tool in cutters.items())
        + len(fresh) * state.machine.tool_change_s / 60.0
    )


def test_floors_take_less_time_than_with_few_cutters(asked):
    state, tasks, _, before, made = asked
    few = {id: before[id] for id in made}
    assert minutes(state, tasks, made) < minutes(state, tasks, few) - 0.1


def test_no_other_cutter_saves_more_than_its_tool_change(asked):
    state, tasks, fits, _, made = asked
    now = minutes(state, tasks, made)
    by_id = {t.id: t for t in tasks}
    for tool in {t.name: t for id in made for t in fits[id]}.values():
        changed = {
            id: tool
            if tool in fits[id]
            and floor_time(state, by_id[id], tool) < floor_time(state, by_id[id], own)
            else own
            for id, own in made.items()
        }
        assert minutes(state, tasks, changed) >= now - 1e-9


def test_a_wider_flat_is_quicker(asked):
    state, tasks, _, _, _ = asked
    floor = next(t for t in tasks if t.id == "floor-pocket-11")
    by_name = {t.name: t for t in state.shop.tools}
    flat, rounded = by_name["AL3-regular D12 R0"], by_name["AL3-regular D12 R3"]
    assert floor_time(state, floor, flat) < floor_time(state, floor, rounded)
