"""A plate with milled threads from its features to the proof of its text on several controls, and wrong programs that are found."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest

from holed import hole, plate, with_holes
from subjects import own, until
from trunnion.model.motion.toolpath import Motion, Toolpath
from trunnion.model.session import Session
from trunnion.model.verdict import Outcome
from trunnion.pipeline import Engine
from trunnion.pipeline.planning.hole_demands import with_hole_demand
from trunnion.pipeline.proof.posted_programs import program_of, prove_programs
from trunnion.plan.holes.demand import thread_demand
from trunnion.progress import NO_PROGRESS

HOLES = (
    hole(30, 30, 25),
    hole(70, 15, 6.8, 16.0, point_angle=140.0),
    hole(70, 45, 5),
    hole(85, 30, 5, 15.0, point_angle=140.0),
)
DEMANDS = {
    # No tap of the catalogue has the first; none is short enough for the second.
    "hole-01": thread_demand("M27x2"),
    "hole-02": thread_demand("M8", 13.0),
    "hole-03": thread_demand("M6"),
    "hole-04": thread_demand("M6", 10.0),
}


@cache
def demanded() -> tuple[Engine, Session]:
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
    """Return an engine and the session after its proof; all threads are milled unless choices say otherwise."""
    engine, session = demanded()
    chosen = {**session.choices, "holes.thread_milling": "always", **dict(choices)}
    return engine, engine.run(replace(session, choices=chosen), until="verify")


def findings(session, *codes):
    return [f for f in session.verdict.findings if f.code in codes or not codes]


def of_threads(session):
    return [f for f in session.verdict.findings if f.code.startswith("verify.thread")]


def test_only_threads_that_no_tap_serves_are_milled_by_default():
    session = proven(("holes.thread_milling", "no-tap"))[1]
    kinds = {o.all_features: o.kind for o in session.process.operations if "thr" in o.strategy}
    assert kinds == {("hole-01",): "thread_mill", ("hole-02",): "thread_mill"}
    taps = [o.all_features for o in session.process.operations if o.kind == "tap"]
    assert taps == [("hole-03",), ("hole-04",)]
    assert session.verdict.outcome in (Outcome.PASSED, Outcome.REMARKS) and not of_threads(session)


@pytest.mark.parametrize("dialect", ["linuxcnc", "fanuc", "heidenhain", "sinumerik", "apt"])
def test_the_text_of_every_control_proves_its_milled_threads(dialect):
    """Arcs come back as the control has them: whole, in quarters, or as steps of a polar angle."""
    session = proven(("post.dialect", dialect))[1]
    verdict = session.verdict
    assert sum(o.kind == "thread_mill" for o in session.process.operations) == 4
    assert verdict.outcome in (Outcome.PASSED, Outcome.REMARKS)
    assert verdict.gouge <= 0.02 and not verdict.collisions and not of_threads(session)
    assert verdict.coverage > 0.99


def test_a_thread_mill_is_taken_for_its_core_and_its_work_is_not_called_air():
    session = proven()[1]
    removed = {o.operation: o.removed for o in session.verdict.operations}
    mills = [o.id for o in session.process.operations if o.kind == "thread_mill"]
    assert all(removed[id] < 1.0 for id in mills)
    assert not [f for f in findings(session, "verify.air") if f.text.split()[0] in mills]


def test_a_thread_in_a_casings_boss_is_milled_along_its_own_axis():
    """Radially, on five axes: the bore of 4 mm is the core of 10-32 UNF."""
    engine, session = own("casing")[0], until("casing", "recognize")
    bore = next(f for f in session.recognition.of_kind("hole"))
    assert bore.sizes["diameter"] == 4.0
    session = replace(session, choices={**session.choices, "holes.thread_milling": "always"})
    session = with_hole_demand(engine, session, [bore.id], thread_demand("10-32 UNF"))
    session = engine.run(session, until="verify")
    (mill,) = [o for o in session.process.operations if o.kind == "thread_mill"]
    assert abs(mill.direction[2]) < 1e-6 and mill.tool.name == "TM-S D3.6 P0.5-1"
    assert session.verdict.releases and not of_threads(session)


def proof_of(change, feature="") -> Session:
    """Return the session after the proof of its program with every section of thread mills changed, None: left out; or those of one feature
    alone."""
    engine, session = proven()
    program = program_of(session, session.setups[0])
    ids = {
        o.id
        for o in session.process.operations
        if o.kind == "thread_mill" and feature in ("", o.feature)
    }
    sections = (change(s) if s.operation in ids else s for s in program.sections)
    changed = replace(program, sections=tuple(s for s in sections if s is not None))
    verdict = prove_programs(session, engine.context, (changed,), NO_PROGRESS)
    return replace(session, verdict=verdict)


def moved(section, by=(0.0, 0.0, 0.0)):
    path = section.path
    return replace(
        section, path=replace(path, position=path.position + by, centre=path.centre + by)
    )


def reshaped(section, position=None, centre=None, motion=None):
    path = section.path
    given = {"position": position, "centre": centre, "motion": motion}
    return replace(section, path=replace(path, **{k: v for k, v in given.items() if v is not None}))


def feeds_of(section):
    return section.path.motion != Motion.RAPID


def only(session, code, feature):
    (found,) = [f for f in findings(session, code) if feature in f.text]
    return found


def test_the_program_as_it_is_has_no_finding():
    assert not of_threads(proof_of(lambda s: s))


def test_a_thread_that_nothing_mills_is_told():
    told = findings(proof_of(lambda s: None), "verify.thread")
    assert sorted(f.text.split(":")[0] for f in told) == sorted(DEMANDS)
    assert all(f.severity == "warning" for f in told)


def test_a_thread_milled_where_none_is_demanded_fails():
    session = proof_of(lambda s: moved(s, (20.0, 0.0, 0.0)), "hole-01")
    assert session.verdict.outcome is Outcome.FAILED
    assert "no thread is demanded" in findings(session, "verify.thread-elsewhere")[0].text


def test_a_thread_mill_of_another_pitch_fails():
    tool = next(t for t in demanded()[0].context.shop.tools if t.name == "TM-C D16x1.5")
    session = proof_of(lambda s: replace(s, tool=replace(tool, number=s.tool.number)), "hole-01")
    assert session.verdict.outcome is Outcome.FAILED
    assert "M27x2 is demanded" in findings(session, "verify.thread-elsewhere")[0].text


def test_a_helix_that_rises_by_another_pitch_fails():
    def steeper(section):
        """Stretch what is fed by a tenth from its lowest position on."""
        position = section.path.position.copy()
        feed = feeds_of(section)
        low = position[feed, 2].min()
        position[feed, 2] = low + 1.1 * (position[feed, 2] - low)
        return reshaped(section, position)

    session = proof_of(steeper, "hole-03")
    assert session.verdict.outcome is Outcome.FAILED
    assert "1.1 mm a turn" in only(session, "verify.thread-pitch", "hole-03").text


def test_a_left_hand_helix_fails():
    def mirrored(section):
        """Mirror the path in y about the hole, which turns its arcs the other way."""
        path = section.path
        flip = np.array([1.0, -1.0, 1.0])
        y = np.array([0.0, 2.0 * np.nanmean(path.position[:, 1]), 0.0])
        y[1] = 2.0 * path.position[-1, 1]
        motion = path.motion.copy()
        motion[path.motion == Motion.ARC_CCW] = Motion.ARC_CW
        return reshaped(section, path.position * flip + y, path.centre * flip + y, motion)

    session = proof_of(mirrored, "hole-03")
    assert session.verdict.outcome is Outcome.FAILED
    assert "to the left" in only(session, "verify.thread-pitch", "hole-03").text


@pytest.mark.parametrize(
    ("times", "words"),
    [(1.1, "mm deeper than the groove of M27x2"), (0.9, "mm too shallow")],
)
def test_a_helix_of_another_radius_fails(times, words):
    def scaled(section):
        path = section.path
        about = np.append(path.position[-1, :2], 0.0)
        share = np.array([times, times, 1.0])
        return reshaped(
            section, about + (path.position - about) * share, about + (path.centre - about) * share
        )

    session = proof_of(scaled, "hole-01")
    assert session.verdict.outcome is Outcome.FAILED
    assert words in only(session, "verify.thread-radius", "hole-01").text


def test_turns_out_of_step_fail():
    """The comb of M8 goes round twice: the second time half a millimetre too high."""

    def late(section):
        path = section.path
        arcs = np.flatnonzero(path.motion == Motion.ARC_CCW)
        second = arcs[len(arcs) // 2]
        position = path.position.copy()
        position[second - 1 : arcs[-1] + 1, 2] += 0.5
        return reshaped(section, position)

    session = proof_of(late, "hole-02")
    assert session.verdict.outcome is Outcome.FAILED
    assert "0.5 mm beside the groove" in only(session, "verify.thread-pitch", "hole-02").text


def test_a_thread_in_a_bore_that_is_not_drilled_fails():
    engine, session = proven()
    program = program_of(session, session.setups[0])
    kept = tuple(s for s in program.sections if not s.operation.startswith("drill"))
    changed = replace(program, sections=kept)
    verdict = prove_programs(session, engine.context, (changed,), NO_PROGRESS)
    assert verdict.outcome is Outcome.FAILED
    told = [f.text for f in verdict.findings if f.code == "verify.thread-core"]
    assert any("hole-03" in t for t in told) and any("hole-02" in t for t in told)


def test_a_thread_that_ends_too_high_is_told_with_its_depth():
    session = proof_of(lambda s: moved(s, (0.0, 0.0, 1.5)), "hole-02")
    assert "11.5 of 13 mm" in only(session, "verify.thread-depth", "hole-02").text
    assert not findings(session, "verify.thread-pitch", "verify.thread-radius")


def test_a_thread_that_begins_too_low_is_told():
    def shorter(section):
        """Leave the last turn of a comb out."""
        path = section.path
        arcs = np.flatnonzero(path.motion == Motion.ARC_CCW)
        first_of_last = arcs[len(arcs) // 2]
        kept = np.r_[0 : first_of_last - 1, arcs[-1] + 1 : len(path)]
        return replace(section, path=some(path, kept))

    session = proof_of(shorter, "hole-02")
    assert "begins" in only(session, "verify.thread-depth", "hole-02").text


def some(path: Toolpath, rows) -> Toolpath:
    names = ("position", "axis", "motion", "centre", "feed", "mark")
    return replace(path, **{n: getattr(path, n)[rows] for n in names})


def test_a_rapid_with_teeth_in_the_wall_fails():
    def lifted(section):
        """Go up at rapid from the last turn, without the way back to the axis."""
        path = section.path
        arcs = np.flatnonzero(path.motion == Motion.ARC_CCW)
        position = path.position.copy()
        rest = np.arange(arcs[-1] + 1, len(path))
        position[rest, :2] = position[arcs[-1] - 1, :2]
        path = replace(path, position=position)
        return replace(section, path=some(path, np.delete(np.arange(len(path)), arcs[-1])))

    session = proof_of(lifted, "hole-03")
    assert session.verdict.outcome is Outcome.FAILED
    assert "at rapid" in only(session, "verify.thread-radius", "hole-03").text


def test_a_rapid_with_teeth_in_the_part_fails():
    """Beside the axis by less than the core's gap to the bore, by more than that of the teeth."""

    def beside(section):
        position = section.path.position.copy()
        rapid = section.path.motion == Motion.RAPID
        low = position[:, 2] < position[rapid, 2].max() - 1.0
        position[np.flatnonzero(rapid & low), 2] -= 10.0
        position[:, 0] += np.where(rapid, 0.7, 0.0)
        return reshaped(section, position)

    session = proof_of(beside, "hole-03")
    assert session.verdict.outcome is Outcome.FAILED and session.verdict.gouge > 0.3


def test_moves_along_the_axis_in_the_wall_fail():
    def straight_up(section):
        """The second half of a turn becomes a line straight up."""
        path = section.path
        arcs = np.flatnonzero(path.motion == Motion.ARC_CCW)
        row = arcs[1]
        motion, position, centre = path.motion.copy(), path.position.copy(), path.centre.copy()
        position[row, :2] = position[row - 1, :2]
        motion[row], centre[row] = Motion.LINE, np.nan
        return reshaped(section, position, centre, motion)

    session = proof_of(straight_up, "hole-03")
    assert session.verdict.outcome is Outcome.FAILED
    assert findings(session, "verify.thread-pitch", "verify.thread-radius")
