"""A plate with a fit and threads from its features to the proof, on several controls; and what the proof finds of wrong programs."""

from __future__ import annotations

import json
from dataclasses import replace
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from pytest import approx

from holed import hole, plate, with_holes
from trunnion.cli.main import main
from trunnion.findings import BadInput
from trunnion.model.dimension import DIAMETER, Dimension
from trunnion.model.motion.cycle import CycleKind
from trunnion.model.session import Session
from trunnion.model.verdict import Outcome
from trunnion.pipeline import Engine
from trunnion.pipeline.planning.hole_demands import with_demands, with_hole_demand
from trunnion.pipeline.proof.posted_programs import program_of, prove_programs
from trunnion.plan.holes.demand import fit_demand, thread_demand
from trunnion.progress import NO_PROGRESS

HOLES = (
    hole(20, 15, 10),
    hole(80, 15, 5),
    hole(20, 45, 6.8, 16.0, point_angle=140.0),
    hole(80, 45, 12, 12.0),
    hole(50, 30, 8),
    hole(50, 48, 9),
)
DEMANDS = {
    "hole-01": fit_demand("H7"),
    "hole-02": thread_demand("M6"),
    "hole-03": thread_demand("M8", 10.0),
    "hole-04": fit_demand("H8"),
    "hole-06": fit_demand("M7"),
}


@cache
def demanded() -> tuple[Engine, Session]:
    """Return an engine and the session of the plate with its demands, before its blank."""
    engine = Engine()
    with TemporaryDirectory() as folder:
        session = engine.open(plate(Path(folder) / "plate.step", *HOLES))
    session = replace(session, choices={"recognize.family": "panel"})
    session = engine.run(session, until="recognize")
    made = with_holes(session.recognition, engine.context.part.graph(), *HOLES)
    session = replace(session, recognition=made)
    for id, demand in DEMANDS.items():
        session = with_hole_demand(engine, session, [id], demand)
    return engine, session


@cache
def proven(*choices) -> tuple[Engine, Session]:
    engine, session = demanded()
    session = replace(session, choices={**session.choices, **dict(choices)})
    return engine, engine.run(session, until="verify")


def findings(session, *codes):
    return [f for f in session.verdict.findings if f.code in codes or not codes]


def test_fits_and_threads_are_made_and_proven():
    session = proven()[1]
    verdict = session.verdict
    assert {o.kind for o in session.process.operations} >= {"drill", "ream", "fine_bore", "tap"}
    assert verdict.outcome in (Outcome.PASSED, Outcome.REMARKS)
    assert verdict.gouge <= 0.02 and not verdict.collisions
    assert not [f for f in verdict.findings if "thread" in f.code or "fit" in f.code]
    # What is left is the ring that the reamer's lead leaves at the blind bore's end, a tenth of a millimetre thick.
    short = [f for p in session.paths for f in p.findings if f.code == "hole.finished-depth"]
    assert len(short) == 1 and verdict.coverage > 0.99


def test_a_reamer_takes_what_the_drill_has_left_and_a_tap_is_taken_for_its_core():
    session = proven()[1]
    removed = {o.operation: o.removed for o in session.verdict.operations}
    ring = np.pi / 4 * (10.0**2 - 9.8**2) * 20.0
    ream = next(o.id for o in session.process.operations if o.kind == "ream" and "01" in o.id)
    assert removed[ream] == approx(ring, rel=0.25)
    taps = [o.id for o in session.process.operations if o.kind == "tap"]
    assert len(taps) == 2 and all(removed[id] < 1.0 for id in taps)


@pytest.mark.parametrize(
    ("dialect", "words"),
    [
        ("linuxcnc", ("G85", "G89", "G84")),
        ("fanuc", ("G85", "G89", "G84")),
        ("heidenhain", ("CYCL DEF 201", "CYCL DEF 207")),
        ("sinumerik", ("CYCLE85", "CYCLE89", "CYCLE84")),
        ("apt", ("RE-H7 D10", "TAP-B M6x1")),
    ],
)
def test_every_control_gets_its_cycles_and_the_text_proves_the_same(dialect, words):
    session = proven(("post.dialect", dialect))[1]
    text = next(f.text for f in session.posted if f.setup)
    assert all(word in text for word in words)
    assert session.verdict.outcome in (Outcome.PASSED, Outcome.REMARKS)


def proof_of(change) -> Session:
    """Return the session after the proof of its program with every section changed, None: left out."""
    engine, session = proven()
    program = program_of(session, session.setups[0])
    sections = tuple(s for s in map(change, program.sections) if s is not None)
    changed = replace(program, sections=sections)
    verdict = prove_programs(session, engine.context, (changed,), NO_PROGRESS)
    return replace(session, verdict=verdict)


def tapping(section):
    return any(b.cycle.kind is CycleKind.TAP for b in section.path.cycles)


def reaming(section):
    return any(b.cycle.kind in (CycleKind.REAM, CycleKind.BORE) for b in section.path.cycles)


def moved(section, by):
    path = section.path
    return replace(section, path=replace(path, position=path.position + by, cycles=()))


def test_a_thread_that_nothing_cuts_is_told():
    session = proof_of(lambda s: None if tapping(s) else s)
    told = findings(session, "verify.thread")
    assert sorted(f.text.split(":")[0] for f in told) == ["hole-02", "hole-03"]
    assert all(f.severity == "warning" for f in told)


def test_a_fit_that_nothing_makes_is_told():
    session = proof_of(lambda s: None if reaming(s) else s)
    told = findings(session, "verify.fit")
    assert sorted(f.text.split(":")[0] for f in told) == ["hole-01", "hole-04", "hole-06"]


def test_a_tap_where_no_thread_is_demanded_fails():
    session = proof_of(lambda s: moved(s, [-30.0, 15.0, 0.0]) if tapping(s) else s)
    assert session.verdict.outcome is Outcome.FAILED
    assert findings(session, "verify.thread-elsewhere")


def test_a_tap_at_another_feed_than_its_pitch_fails():
    def faster(s):
        return replace(s, spindle=0.9 * s.spindle) if tapping(s) else s

    session = proof_of(faster)
    assert session.verdict.outcome is Outcome.FAILED
    assert len(findings(session, "verify.thread-feed")) == 2


def test_a_tap_in_a_bore_that_is_not_drilled_fails():
    def undrilled(s):
        return None if s.operation.startswith("drill") else s

    session = proof_of(undrilled)
    assert session.verdict.outcome is Outcome.FAILED
    assert findings(session, "verify.thread-core")


def test_a_thread_that_ends_too_high_is_told_with_its_depth():
    session = proof_of(lambda s: moved(s, [0.0, 0.0, 2.0]) if tapping(s) else s)
    told = {f.text.split(":")[0]: f.text for f in findings(session, "verify.thread-depth")}
    assert "8 of 10 mm" in told["hole-03"]


def test_a_demand_survives_recognition_and_the_project(tmp_path):
    """As recognition has the holes itself."""
    engine = Engine()
    session = engine.open(plate(tmp_path / "plate.step", *HOLES))
    session = replace(session, choices={"recognize.family": "panel"})
    session = engine.run(session, until="recognize")
    bore = next(f for f in session.recognition.of_kind("hole") if f.sizes["diameter"] == 10.0)
    session = with_hole_demand(engine, session, [bore.id], fit_demand("H7"))
    wider = {**session.choices, "recognize.panel.hole_diameter": 25.0}
    again = engine.run(replace(session, choices=wider), until="recognize")
    assert again.recognition.feature(bore.id).attributes["fit"] == "H7"
    file = tmp_path / "plate.trunnion"
    engine.save(again, file)
    assert Engine().open(file).recognition.features == again.recognition.features


def test_a_changed_demand_makes_the_route_stale_and_the_proof_too():
    engine, session = proven()
    after = with_hole_demand(engine, session, ["hole-05"], fit_demand("H12"))
    assert engine.states(after)["route"] == "stale"
    assert with_hole_demand(engine, after, ["hole-05"], fit_demand("H12")) is after


def dimension(session, id, **fields):
    feature = session.recognition.feature(id)
    given = {
        "kind": DIAMETER,
        "value": feature.sizes["diameter"],
        "upper": None,
        "lower": None,
        "fit": "",
        "thread": "",
        "text": "",
        "faces": feature.with_role("side"),
    }
    return Dimension(**{**given, **fields})


def test_what_the_file_demands_is_taken_up_and_a_person_goes_before_it():
    engine, session = demanded()
    shop, bare = engine.context.shop, session.recognition
    given = (
        dimension(session, "hole-05", upper=0.05, lower=0.0),
        dimension(session, "hole-01", fit="G7"),
    )
    found = with_demands(bare, bare, given, shop)
    assert found.feature("hole-05").attributes["fit"] == "+0.05/0"
    assert found.feature("hole-05").attributes["demanded"] == "by the file"
    assert found.feature("hole-01").attributes["fit"] == "H7"
    # What a person took away does not come back from the file.
    without = with_hole_demand(engine, session, ["hole-05"], fit_demand(""))
    again = with_demands(without.recognition, without.recognition, given, shop)
    assert "fit" not in again.feature("hole-05").attributes


def test_limits_in_the_file_are_taken_about_the_diameter_that_is_drawn():
    engine, session = demanded()
    given = (dimension(session, "hole-05", value=7.99, upper=0.03, lower=0.0),)
    found = with_demands(session.recognition, None, given, engine.context.shop)
    sizes = found.feature("hole-05").sizes
    assert (sizes["fit_lower"], sizes["fit_upper"]) == approx((-0.01, 0.02))


def test_what_the_file_says_of_another_size_is_told_and_not_taken_up():
    engine, session = demanded()
    given = (dimension(session, "hole-05", value=8.5, fit="H7", text="size 8.5"),)
    found = with_demands(session.recognition, None, given, engine.context.shop)
    (told,) = [f for f in found.findings if f.code == "recognize.demand-unused"]
    assert "size 8.5" in told.text and "8 mm, not with 8.5" in told.text
    assert "fit" not in found.feature("hole-05").attributes


def test_a_demand_that_a_revised_hole_does_not_bear_is_told():
    engine, session = demanded()
    before = session.recognition
    wider = tuple(
        replace(f, sizes={**f.sizes, "diameter": 6.0}) if f.id == "hole-02" else f
        for f in before.features
    )
    found = with_demands(replace(before, features=wider), before, (), engine.context.shop)
    (told,) = [f for f in found.findings if f.code == "recognize.demand-lost"]
    assert "hole-02" in told.text and "M6 needs a bore" in told.text


def test_the_command_line_demands_fits_and_threads(tmp_path, capsys):
    part = plate(tmp_path / "plate.step", *HOLES)
    engine = Engine()
    session = engine.run(
        replace(engine.open(part), choices={"recognize.family": "panel"}), until="recognize"
    )
    ids = {f.sizes["diameter"]: f.id for f in session.recognition.of_kind("hole")}
    out = tmp_path / "plate.trunnion"
    demands = ["--fit", f"{ids[10.0]}=H7", "--thread", f"{ids[6.8]}=M8:10"]
    given = ["edit", str(part), "--set", "recognize.family=panel", *demands, "--out", str(out)]
    assert main([*given, "--json"]) == 0
    made = {f["id"]: f for f in json.loads(capsys.readouterr().out)["features"]}
    assert made[ids[10.0]]["fit"] == "H7" and made[ids[6.8]]["sizes"]["thread_depth"] == 10.0
    assert main(["edit", str(out), "--fit", f"{ids[10.0]}=", "--out", str(out)]) == 0
    again = Engine().open(out).recognition
    assert "fit" not in again.feature(ids[10.0]).attributes
    assert again.feature(ids[6.8]).attributes["thread"] == "M8"


@pytest.mark.parametrize("given", ["hole-01", "=H7", "hole-01=M6:deep"])
def test_a_demand_that_can_not_be_read_is_refused(given, tmp_path, capsys):
    part = plate(tmp_path / "plate.step", *HOLES)
    out = str(tmp_path / "plate.trunnion")
    options = ["--set", "recognize.family=panel", "--thread", given, "--out", out]
    assert main(["edit", str(part), *options]) == 2
    assert "Traceback" not in capsys.readouterr().err


def test_unknown_words_are_refused_before_anything_changes():
    engine, session = demanded()
    with pytest.raises(BadInput, match="hole-05"):
        with_hole_demand(engine, session, ["hole-05"], thread_demand("Tr8"))
