"""Material that features keep on purpose, from a person's word to the proof of the posted programs."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from pytest import approx

import trunnion
from kept_parts import (
    FLOOR_KEPT,
    WALL_KEPT,
    kept,
    plain,
    pocket_with_island,
    recognised,
    ribbed_file,
)
from releases import assert_released
from trunnion.cli.main import main
from trunnion.findings import BadInput, Severity
from trunnion.model.feature import Recognition
from trunnion.pipeline import Engine
from trunnion.pipeline.planning.allowances import with_feature_allowance
from trunnion.pipeline.proof.posted_programs import programs_of, prove_programs
from trunnion.plan.allowances import allowance_of, face_allowances, with_allowances_kept
from trunnion.plan.freeform.keys import KEPT
from trunnion.plan.manual.operation_copy import with_copy_on
from trunnion.plan.prismatic.drive import FLOOR_ALLOWANCE, KEPT_ON_FLOORS, KEPT_ON_WALLS
from trunnion.progress import NO_PROGRESS


def left_on(session, tags) -> np.ndarray:
    found = session.verdict.deviation
    return found.deviation[np.isin(found.face, tags)]


def test_the_programs_leave_what_features_keep_and_are_released_with_remarks():
    _, session = kept()
    assert_released(session)
    # What is left in the sharp corners at the ends of the rib is left without the demand too.
    assert session.verdict.coverage == approx(plain()[1].verdict.coverage, abs=1e-4)
    found = session.recognition
    pocket = found.feature(pocket_with_island(session))
    told = [f for f in session.verdict.findings if f.code == "verify.kept"]
    # The island's walls are cut with the pocket's: it is told of as well.
    assert {f.where[0] for f in told} == {pocket.id, "profile-01", "island-01"}
    assert all(f.severity is Severity.REMARK for f in told)
    floor = left_on(session, pocket.with_role("floor"))
    # Strips of the floor lie under the layers of the walls, which are thicker.
    assert floor.min() == approx(FLOOR_KEPT, abs=0.005)
    assert np.median(floor) == approx(FLOOR_KEPT, abs=0.005)
    own = [t for t in pocket.with_role("corner") if sum(t in f.tags for f in found) == 1]
    assert left_on(session, own) == approx(WALL_KEPT, abs=0.005)
    outline = left_on(session, found.feature("profile-01").tags)
    assert outline.max() == approx(WALL_KEPT, abs=0.005)


def test_a_wall_behind_a_rib_keeps_material_in_one_pocket_and_none_in_the_other():
    _, session = kept()
    found = session.recognition
    pocket = found.feature(pocket_with_island(session))
    other = next(f for f in found.of_kind("pocket") if f.id != pocket.id)
    (shared, *_) = sorted(set(pocket.with_role("wall")) & set(other.with_role("wall")))
    samples = session.verdict.deviation
    mine = samples.face == shared
    x, left = samples.point[mine, 0], samples.deviation[mine]
    assert left[x > -4.0] == approx(WALL_KEPT, abs=0.005)
    assert left[x < -20.0] == approx(0.0, abs=0.005)


def test_without_the_demand_the_same_programs_leave_the_part_unfinished():
    engine, session = kept()
    bare = replace(session, recognition=plain()[1].recognition)
    context = engine.context_of(bare)
    verdict = prove_programs(bare, context, programs_of(session), NO_PROGRESS)
    assert not verdict.releases
    assert "verify.coverage" in {f.code for f in verdict.findings}


def test_programs_that_leave_nothing_are_refused_where_something_is_to_stay():
    engine, session = plain()
    wanted = replace(session, recognition=kept()[1].recognition)
    programs = programs_of(session)
    verdict = prove_programs(wanted, engine.context_of(wanted), programs, NO_PROGRESS)
    (first, *_) = [f for f in verdict.findings if f.code == "verify.allowance"]
    assert first.severity is Severity.ERROR and not verdict.releases
    pocket = pocket_with_island(session)
    assert any(f.where[0] == pocket and f"wall-{pocket}" in f.where for f in verdict.findings)


def test_operations_leave_it_beside_their_own_allowance():
    _, session = kept()
    pocket = pocket_with_island(session)
    for o in session.process.operations:
        wall, floor = (o.choices.get(key, 0.0) for key in (KEPT_ON_WALLS, KEPT_ON_FLOORS))
        if o.feature == pocket:
            assert (wall, floor) == (WALL_KEPT, FLOOR_KEPT) and KEPT not in o.choices
        elif o.feature == "profile-01":
            assert (wall, floor) == (WALL_KEPT, 0.0)
        elif o.feature != "island-01":
            assert (wall, floor) == (0.0, 0.0)
    rough = session.process.operation(f"rough-{pocket}")
    assert rough.choices[FLOOR_ALLOWANCE] == 0.3


def test_it_is_kept_when_recognition_runs_again_and_in_a_project(tmp_path):
    engine, session = kept()
    again = with_allowances_kept(plain()[1].recognition, session.recognition)
    pocket = pocket_with_island(session)
    assert allowance_of(again.feature(pocket)) == allowance_of(session.recognition.feature(pocket))
    file = tmp_path / "kept.trunnion"
    engine.save(session, file)
    opened = Engine().open(file)
    assert allowance_of(opened.recognition.feature(pocket)).wall_allowance == WALL_KEPT
    assert engine.states(session)["verify"] == "done"
    less = with_feature_allowance(session, [pocket], wall_allowance=0.1)
    assert engine.states(less)["route"] == engine.states(less)["verify"] == "stale"
    none = with_feature_allowance(session, [pocket], wall_allowance=0.0, floor_allowance=0.0)
    assert (
        not {"wall_allowance", "floor_allowance"}
        & none.recognition.feature(pocket).attributes.keys()
    )


def test_a_copy_on_another_feature_leaves_what_that_one_keeps():
    engine, session = kept()
    found, pocket = session.recognition, pocket_with_island(session)
    other = next(f.id for f in found.of_kind("pocket") if f.id != pocket)
    process, there = with_copy_on(session.process, f"wall-{pocket}", other, found)
    process, here = with_copy_on(process, f"wall-{other}", pocket, found)
    planned = engine.run(replace(session, process=process), until="optimize")
    assert KEPT_ON_WALLS not in planned.process.operation(there).choices
    assert planned.process.operation(here).choices[KEPT_ON_WALLS] == WALL_KEPT
    assert engine.states(planned)["optimize"] == "done"


@pytest.mark.parametrize(
    ("id", "amounts", "words"),
    [
        ("pocket-77", {"wall_allowance": 0.1}, "there is no feature pocket-77"),
        ("rib-01", {"wall_allowance": 0.1}, "rib-01 has no walls of its own"),
        ("profile-01", {"floor_allowance": 0.1}, "profile-01 has no floor and no top"),
        (
            "island-01",
            {"wall_allowance": 0.1},
            "the walls of island-01 are cut with those of pocket-",
        ),
        ("datum-01", {"floor_allowance": 0.1}, "datum-01 is a datum"),
        ("pocket-01", {"wall_allowance": -0.1}, "must be from 0 to 20 mm"),
        ("pocket-01", {"wall_allowance": math.nan}, "must be from 0 to 20 mm"),
    ],
)
def test_what_can_not_keep_it_is_refused_in_one_line(id, amounts, words):
    _, session = recognised()
    with pytest.raises(BadInput, match=words) as refusal:
        with_feature_allowance(session, [id], **amounts)
    assert "\n" not in str(refusal.value)


def test_a_family_that_leaves_nothing_says_so():
    _, session = recognised()
    wheel = replace(session, recognition=Recognition(family="impeller"))
    with pytest.raises(BadInput, match="not left on purpose on features of impellers"):
        with_feature_allowance(wheel, ["blade-01"], wall_allowance=0.1)


def test_fillets_between_walls_and_floors_keep_what_lies_between():
    engine, session = kept()
    pocket = session.recognition.feature(pocket_with_island(session))
    filleted = replace(
        pocket,
        faces=tuple(
            replace(f, role="floor_fillet") if f.role == "corner" else f for f in pocket.faces
        ),
    )
    found = replace(
        session.recognition,
        features=tuple(filleted if f.id == pocket.id else f for f in session.recognition),
    )
    (tag, *_) = pocket.with_role("corner")
    (own,) = [a for a in face_allowances(found, engine.context.part) if a.face == tag]
    assert (own.least, own.most) == (FLOOR_KEPT, approx(math.hypot(WALL_KEPT, FLOOR_KEPT)))


def test_it_is_typed_on_the_command_line(tmp_path, capsys):
    part, project = ribbed_file(tmp_path / "ribbed.step"), tmp_path / "ribbed.trunnion"
    command = ["edit", str(part), "--set", "recognize.family=panel", "--out", str(project)]
    amounts = ["--keep-on-walls", "pocket-01,profile-01=0.3", "--keep-on-floors", "pocket-01=0.2"]
    assert main([*command, *amounts]) == 0
    assert "walls 0.3 mm, floors 0.2 mm" in capsys.readouterr().out
    assert main([*command, "--keep-on-walls", "pocket-01=thick"]) == 2
    assert "thick is no amount in mm" in capsys.readouterr().err
    assert main(command) == 2
    assert "--keep-on-walls" in capsys.readouterr().err


def test_a_script_lets_features_keep_material(tmp_path):
    program = trunnion.open(
        ribbed_file(tmp_path / "ribbed.step"), settings={"recognize.family": "panel"}
    )
    program.keep(["pocket-01"], walls=0.3)
    program.keep(["pocket-01"], floors=0.2)
    kept = allowance_of(program.session.recognition.feature("pocket-01"))
    assert (kept.wall_allowance, kept.floor_allowance) == (0.3, 0.2)
    assert "program.keep(['pocket-01'], floors=0.2)" in program.script()
