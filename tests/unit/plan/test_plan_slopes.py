"""What is planned for slopes outside of pockets: chamfers, sides of the outline that lean, free-form sides."""

from __future__ import annotations

from functools import cache
from typing import Any

import pytest

import samples
import sloped_blocks
from trunnion.model.session import Session
from trunnion.pipeline import Engine

SHAPES = {
    "chamfers": sloped_blocks.chamfered_block,
    "away": sloped_blocks.drafted_block,
    "over": lambda: sloped_blocks.drafted_block(-6.0),
    "fringe": sloped_blocks.fringed_block,
}


@cache
def routed(name: str) -> Session:
    engine = Engine()
    return engine.run(engine.open(samples.written(SHAPES[name]())), "route")


def by_setup(name: str, *kinds: str) -> dict[str, list[Any]]:
    found: dict[str, list[Any]] = {}
    for operation in routed(name).process.operations:
        if operation.kind in kinds:
            found.setdefault(operation.setup, []).append(operation)
    return found


@pytest.mark.parametrize("name", SHAPES)
def test_nothing_is_left_for_a_person_to_plan(name) -> None:
    lost = [f.text for f in routed(name).findings() if f.code == "route.not-planned"]
    # What winds to either side is upright somewhere: there no end that is round comes down to the foot.
    assert not lost or (name == "fringe" and all("fringe-01" in text for text in lost))


def test_chamfers_are_cut_from_the_side_that_sees_them_by_balls() -> None:
    found = by_setup("chamfers", "chamfer")
    named = {s: {o.feature for o in made} for s, made in found.items()}
    assert named == {"S1": {"chamfer-01", "chamfer-02"}, "S2": {"chamfer-03"}}
    assert {o.cutter.form for made in found.values() for o in made} == {"ball"}


def test_chamfers_come_after_the_walls_and_floors_and_before_the_outline_is_free() -> None:
    rows = [o.id for o in routed("chamfers").process.operations]
    first = min(rows.index(o.id) for o in by_setup("chamfers", "chamfer")["S1"])
    assert max(rows.index(i) for i in rows if i.startswith(("wall-", "floor-"))) < first
    assert rows.index("profile_finish-profile-01") > first


@pytest.mark.parametrize(("name", "setup"), [("away", "S1"), ("over", "S2")])
def test_sides_that_lean_are_roughed_and_finished_from_the_side_that_sees_them(name, setup) -> None:
    found = by_setup(name, "semi", "leaning_side")
    assert set(found) == {setup}
    rough, *finishing = found[setup]
    feature = routed(name).recognition.feature("profile-01")
    assert rough.kind == "semi" and rough.choices["surface.allowance"] > 0.0
    faces = {f for o in finishing for f in o.faces}
    assert faces == set(feature.with_role("outer_convergence", "inner_convergence"))
    assert finishing[0].choices["surface.allowance"] == 0.0


@pytest.mark.parametrize("name", ["away", "over"])
def test_the_outline_is_cut_where_it_is_widest(name) -> None:
    ids = [o.id for o in routed(name).process.operations]
    assert ids.count("profile_rough-profile-01") == 1
    (_, semi, *_) = [i for i in ids if i.startswith(("profile_rough", "semi"))]
    assert ids.index("profile_rough-profile-01") < ids.index(semi)


def test_a_side_that_winds_is_cut_from_both_sides() -> None:
    found = by_setup("fringe", "leaning_side")
    assert {s: {o.feature for o in made} for s, made in found.items()} == {
        "S1": {"fringe-01"},
        "S2": {"fringe-01"},
    }
    assert all(o.id.endswith("-S2") for o in found["S2"] if "rest" not in o.id)


def test_a_wide_slope_is_roughed_in_passes_that_its_cutter_bears() -> None:
    engine = Engine()
    session = engine.run(engine.open(samples.written(sloped_blocks.drafted_block(14.0))), "route")
    wide = [o for o in session.process.operations if o.kind == "semi"]
    own = {o.cutter.diameter for o in wide}
    assert all(o.data.depth <= 0.5 * max(own) + 1e-9 for o in wide)
    allowances = [o.choices["surface.allowance"] for o in wide]
    assert allowances == sorted(allowances, reverse=True)
