"""A plate with holes from its features to the proof: planned, written for two controls, read back, proven.

The features are made by hand, so that a fault of recognition is none of planning.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from pytest import approx

from holed import hole, plate, with_holes
from long_mark import mostly_long
from trunnion.model.motion.cycle import CycleKind
from trunnion.model.session import Session
from trunnion.model.verdict import Outcome
from trunnion.pipeline import Engine

DRILLED = (
    hole(20, 15, 8),
    hole(80, 15, 8),
    hole(80, 45, 8),
    hole(20, 45, 8),
    hole(50, 30, 6, 12.0, point_angle=140.0),
    hole(35, 30, 3.3, 18.0, point_angle=140.0),
    hole(65, 30, 3),
    hole(90, 30, 12, 8.0, point_angle=140.0),
)


@cache
def proven(holes, *choices) -> tuple[Engine, Session]:
    """Return an engine and the session of a plate with holes after its proof."""
    engine = Engine()
    with TemporaryDirectory() as folder:
        session = engine.open(plate(Path(folder) / "plate.step", *map(dict, holes)))
    session = replace(session, choices={"recognize.family": "panel", **dict(choices)})
    session = engine.run(session, until="recognize")
    made = with_holes(session.recognition, engine.context.part.graph(), *map(dict, holes))
    return engine, engine.run(replace(session, recognition=made), until="verify")


def fixed(holes):
    return tuple(tuple(h.items()) for h in holes)


def drilled(*choices) -> Session:
    return proven(fixed(DRILLED), *choices)[1]


def tool_path(session, operation):
    return next(p for p in session.paths if p.operation == operation).path


def test_through_and_blind_holes_are_drilled_and_proven():
    verdict = drilled().verdict
    assert verdict.outcome is Outcome.PASSED
    assert verdict.coverage == approx(1.0, abs=1e-4)
    assert all(o.gouge <= 1e-6 and not o.rapids_in_stock for o in verdict.operations)


def test_every_hole_is_one_cycle_of_its_operation():
    session = drilled()
    cycles = {
        o.id: [b.cycle.kind for b in tool_path(session, o.id).cycles]
        for o in session.process.operations
        if o.kind == "drill"
    }
    assert sorted(map(len, cycles.values())) == [1, 1, 1, 1, 4]
    kinds = {kind for found in cycles.values() for kind in found}
    assert kinds == {CycleKind.DRILL, CycleKind.CHIP_BREAK, CycleKind.PECK}


@pytest.mark.parametrize("dialect", ["linuxcnc", "apt", "heidenhain"])
def test_programs_for_several_controls_are_read_back_and_prove_the_same(dialect):
    session = drilled(("post.dialect", dialect))
    assert session.verdict.outcome is Outcome.PASSED
    text = next(f.text for f in session.posted if f.setup)
    if dialect == "linuxcnc":
        assert text.count("G81") == 3 and text.count("G83") == 1 and text.count("G73") == 1
    if dialect == "heidenhain":
        assert [text.count(f"CYCL DEF {n} ") for n in (200, 205, 203)] == [3, 1, 1]
        assert text.count("M99") == 8


def test_the_load_of_drills_is_foreseen():
    session = drilled()
    foreseen = {o.id: o.data.highest_power for o in session.process.operations}
    for proof in session.verdict.operations:
        if proof.operation.startswith("drill"):
            assert proof.power <= 1.06 * foreseen[proof.operation]


def test_a_drill_too_deep_is_found_by_the_proof():
    """The proof sees the drill as it is: its point a millimetre into what is under a blind hole."""
    from trunnion.pipeline.proof.posted_programs import program_of, prove_programs
    from trunnion.progress import NO_PROGRESS

    engine, session = proven(fixed(DRILLED))
    program = program_of(session, session.setups[0])
    sections = tuple(
        replace(s, path=replace(s.path, position=s.path.position - [0.0, 0.0, 1.0], cycles=()))
        if s.operation == "drill-hole-05"
        else s
        for s in program.sections
    )
    lower = replace(program, sections=sections)
    verdict = prove_programs(session, engine.context, (lower,), NO_PROGRESS)
    bad = next(o for o in verdict.operations if o.operation == "drill-hole-05")
    assert verdict.outcome is Outcome.FAILED
    # The cone goes in by a millimetre along the axis, sin(70 degrees) of it across its flank.
    assert bad.gouge == approx(0.94, abs=0.07)


STEPPED = (
    hole(20, 15, 9, counterbore_diameter=15, counterbore_depth=6),
    hole(80, 15, 9, counterbore_diameter=15, counterbore_depth=6),
    hole(20, 45, 7.7),
    hole(50, 15, 8, 9.0),
    hole(50, 35, 25.0),
    hole(80, 45, 9, 14.0, counterbore_diameter=16, counterbore_depth=8),
)


@pytest.mark.parametrize("dialect", mostly_long(["linuxcnc", "apt"], "linuxcnc"))
def test_counterbores_flat_floors_and_milled_holes_are_proven(dialect):
    session = proven(fixed(STEPPED), ("post.dialect", dialect))[1]
    kinds = {o.kind for o in session.process.operations}
    assert {"drill", "hole_mill", "hole_floor", "counterbore"} <= kinds
    assert session.verdict.outcome is Outcome.PASSED
    assert session.verdict.coverage == approx(1.0, abs=1e-4)
    assert all(o.gouge <= 1e-6 and not o.rapids_in_stock for o in session.verdict.operations)


def test_what_the_drill_leaves_on_a_flat_floor_is_not_told_where_it_is_milled():
    session = proven(fixed(STEPPED))[1]
    told = [f.code for f in session.records["toolpath"].findings]
    assert "hole.floor" in {f.code for p in session.paths for f in p.findings}
    assert "hole.floor" not in told


SUNK = (
    hole(20, 15, 6, countersink_diameter=12, countersink_angle=90),
    hole(80, 15, 6, countersink_diameter=10, countersink_angle=90),
    hole(20, 45, 5, countersink_diameter=9.5, countersink_angle=100),
    hole(50, 15, 8, 9.0, point_angle=118, countersink_diameter=12, countersink_angle=90),
)


def test_countersinks_are_proven_and_stay_cycles_with_a_dwell():
    session = proven(fixed(SUNK))[1]
    assert session.verdict.outcome is Outcome.PASSED
    assert session.verdict.coverage == approx(1.0, abs=1e-4)
    text = next(f.text for f in session.posted if f.setup)
    assert text.count("G82") == 2 and "P0.2" in text
