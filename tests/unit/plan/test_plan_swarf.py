"""Leaning walls of pockets on a machine with rotary axes: what is swarf milled, by which cutter, and that it is proven."""

from __future__ import annotations

from functools import cache, partial
from typing import Any

import pytest

import leaning_pockets
import samples
from long_mark import mostly_long
from trunnion.model.session import Session
from trunnion.pipeline import Engine

SHAPES = {
    "away": leaning_pockets.leaning_block,
    "over": leaning_pockets.mixed_block,
    "over a fillet": partial(leaning_pockets.mixed_block, fillet=3.0),
    "bowl": leaning_pockets.bowl_block,
}


@cache
def routed(name: str, machine: str = "Trunnion 650", **choices: Any) -> Session:
    engine = Engine()
    session = engine.open(samples.written(SHAPES[name]()))
    words = {"setup.machine": machine, "repair.rounds": 0, **choices}
    return engine.run(engine.with_choices(session, words), "route")


def kinds(session: Session) -> dict[str, str]:
    assert session.process is not None
    return {o.kind: o.strategy for o in session.process.operations}


def test_walls_that_lean_away_are_left_to_the_flank() -> None:
    session = routed("away")
    assert session.process is not None and session.recognition is not None
    pocket = session.recognition.feature("pocket-01")
    by_kind = {o.kind: o for o in session.process.operations}
    swarf, fillets = by_kind["swarf"], by_kind["leaning_fillet"]
    assert swarf.strategy == "surface.swarf" and "swarf_foot" not in by_kind
    assert set(swarf.faces) == {*pocket.with_role("outer_convergence"), *pocket.with_role("corner")}
    assert set(fillets.faces) == set(pocket.with_role("floor_fillet"))
    assert "leaning_side" not in by_kind


def test_the_flank_has_the_fillets_corner() -> None:
    process = routed("away").process
    assert process is not None
    (swarf,) = [o for o in process.operations if o.kind == "swarf"]
    assert swarf.cutter.corner_radius == 4.0


def test_walls_that_lean_over_are_roughed_and_finished_at_their_feet() -> None:
    session = routed("over")
    process = session.process
    assert process is not None and session.recognition is not None
    (hanging,) = session.recognition.feature("pocket-01").with_role("inner_convergence")
    by_kind = {o.kind: o for o in process.operations}
    rough, finish, foot = (by_kind[k] for k in ("semi", "swarf", "swarf_foot"))
    assert hanging in rough.faces and rough.choices["surface.allowance"] > 0.0
    assert hanging in finish.faces and hanging in foot.faces
    flat, less = (o.cutter.radius - o.cutter.corner_radius for o in (finish, foot))
    assert less < flat and foot.choices["surface.swarf.feet"] is True
    assert not [f for f in session.findings() if f.code == "route.not-planned"]


def test_on_three_axes_walls_are_finished_level_by_level() -> None:
    found = kinds(routed("away", "Mill 1200"))
    assert "swarf" not in found and found["leaning_side"] == "surface.waterline"


def test_a_person_may_have_walls_level_by_level_on_five_axes() -> None:
    found = kinds(routed("away", **{"leaning.swarf": False}))
    assert "swarf" not in found and found["leaning_side"] == "surface.waterline"


def test_a_pocket_of_upright_walls_over_a_curved_floor_is_planned_as_before() -> None:
    assert "swarf" not in kinds(routed("bowl"))


@pytest.mark.parametrize("name", mostly_long(["away", "over", "over a fillet"], "over"))
def test_swarf_milled_walls_are_proven(name: str) -> None:
    engine = Engine()
    words = {"setup.machine": "Trunnion 650", "repair.rounds": 0}
    session = engine.open(samples.written(SHAPES[name]()))
    session = engine.run(engine.with_choices(session, words))
    verdict = session.verdict
    assert verdict is not None and verdict.releases, [str(f) for f in verdict.findings]
    assert verdict.reachable >= 0.99 and verdict.collisions == 0
    assert session.recognition is not None
    walls = session.recognition.feature("pocket-01").with_role(
        "inner_convergence", "outer_convergence"
    )
    for face in verdict.faces:
        if face.face in walls:
            assert face.finished >= 0.995 * face.area
