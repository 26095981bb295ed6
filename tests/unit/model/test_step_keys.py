"""What makes a step stale: the settings of the session's own family, planner and strategies, and no others."""

from __future__ import annotations

import pytest

from trunnion.pipeline import Engine


@pytest.fixture(scope="module")
def programmed(sample_panel):
    """An engine and its session of the small panel, with toolpaths."""
    engine = Engine()
    return engine, engine.run(engine.open(sample_panel), until="toolpath")


def stale(programmed, **words):
    engine, session = programmed
    changed = engine.states(
        engine.with_choices(
            session, {key.replace("__", "."): value for key, value in words.items()}
        )
    )
    return [name for name, state in changed.items() if state == "stale"]


def test_nothing_is_stale_after_a_run(programmed) -> None:
    assert stale(programmed) == []


def test_another_family_s_recognition_makes_nothing_stale(programmed) -> None:
    assert stale(programmed, recognize__surface__smallest=0.8) == []


def test_another_planner_s_settings_make_nothing_stale(programmed) -> None:
    assert stale(programmed, surface__scallop=0.02) == []


def test_a_strategy_that_no_operation_uses_makes_nothing_stale(programmed) -> None:
    assert stale(programmed, surface__parallel__stepover=0.4) == []


def test_the_own_family_s_settings_make_everything_stale(programmed) -> None:
    assert stale(programmed, recognize__family="surface")[0] == "recognize"
    assert stale(programmed, recognize__panel__beta=12.0)[0] == "recognize"


def test_the_own_planner_s_settings_make_the_route_stale(programmed) -> None:
    assert stale(programmed, route__wall_allowance=0.7) == ["route", "optimize", "toolpath"]


def test_the_settings_of_a_strategy_in_use_make_its_toolpaths_stale(programmed) -> None:
    assert "toolpath" in stale(programmed, plane__rough__slot_feed=0.3)
