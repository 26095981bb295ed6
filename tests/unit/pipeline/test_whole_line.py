"""The whole line on the sample panel B1: from the shipped file to proven text, and what a person may do to it on the way."""

from __future__ import annotations

import contextlib
import io
import json
import shutil
from dataclasses import replace
from hashlib import sha256
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import rs274
from trunnion.cli.main import main
from trunnion.cli.programs.proof import proof_text
from trunnion.findings import BadCall, BadInput, Cancelled
from trunnion.model.verdict import Outcome
from trunnion.pipeline import STEPS, Engine
from trunnion.pipeline.proof.external_nc import verify_texts
from trunnion.progress import NO_PROGRESS, Progress
from trunnion_resources import sample


@pytest.fixture(scope="module")
def line(tmp_path_factory):
    """The engine, the proven session of B1 and the folder with everything written."""
    folder = tmp_path_factory.mktemp("B1")
    engine = Engine()
    session = engine.run(engine.open(Path(str(sample("B1")))))
    engine.write(session, folder, name="B1")
    return engine, session, folder


@pytest.fixture(scope="module")
def small(tmp_path_factory, sample_panel):
    """The same of the small panel, which has a feature of every kind but takes a third of the time."""
    folder = tmp_path_factory.mktemp("small")
    engine = Engine()
    session = engine.run(engine.open(sample_panel))
    engine.write(session, folder, name="small")
    return engine, session, folder


@pytest.fixture(scope="module")
def commanded(tmp_path_factory, sample_panel):
    """The exit code, the JSON and the folder of `trunnion program` on the small panel."""
    folder, said = tmp_path_factory.mktemp("commanded"), io.StringIO()
    with contextlib.redirect_stdout(said):
        code = main(["program", str(sample_panel), "-o", str(folder), "--name", "small", "--json"])
    return code, json.loads(said.getvalue()), folder


def test_b1_passes_its_proof(line):
    verdict = line[1].verdict
    assert verdict.outcome is Outcome.PASSED
    assert verdict.gouge <= 0.02
    assert verdict.coverage >= 0.99
    assert (verdict.collisions, verdict.rapids_in_stock) == (0, 0)


def test_every_operation_of_b1_passes(line):
    assert {p.outcome for p in line[1].verdict.operations} == {Outcome.PASSED}


def test_the_bound_stands_beside_every_time(line):
    verdict = line[1].verdict
    for o in verdict.operations:
        assert 0.0 < o.bound_s <= o.time_s, o.operation
        assert sum(seconds for _, seconds in o.time_parts()) == pytest.approx(o.time_s)
    assert sum(o.bound_s for o in verdict.operations) < verdict.bound_s < verdict.machining_time_s
    assert sum(share for _, share in verdict.time_shares()) == pytest.approx(1.0)


def test_a_program_that_cuts_nothing_says_nothing_of_where_its_minutes_go(line):
    verdict = replace(line[1].verdict, operations=(), machining_time_s=0.0, bound_s=0.0)
    assert verdict.time_shares() == () and verdict.over_bound == 0.0
    told = proof_text(replace(line[1], verdict=verdict))
    assert "of that" not in told and "bound" not in told


def test_everything_is_written(line):
    names = {path.name for path in line[2].iterdir()}
    assert names == {
        f"B1.{end}"
        for end in (
            "S1.nc",
            "cl",
            "tools.json",
            "features.xml",
            "process.xml",
            "features.png",
            "toolpaths.png",
            "deviation.png",
            "report.html",
            "trunnion",
        )
    }


def test_arcs_stay_arcs(line):
    words = (line[2] / "B1.S1.nc").read_text().split()
    assert words.count("G2") + words.count("G3") > 500


@rs274.needs_rs274
def test_linuxcnc_moves_as_we_mean(line, tmp_path):
    session = line[1]
    text = (line[2] / "B1.S1.nc").read_text()
    assert rs274.compare(text, session.process.tools(), session.setups[0], tmp_path) > 3000


def test_the_tool_list_has_the_documented_keys(line):
    tools = json.loads((line[2] / "B1.tools.json").read_text())
    assert {
        "number",
        "form",
        "diameter",
        "corner_radius",
        "taper_deg",
        "flute_length",
        "stickout",
        "gauge_length",
        "holder",
    } <= tools[0].keys()


def test_the_report_names_the_verdict_and_shows_pictures(line):
    report = (line[2] / "B1.report.html").read_text()
    assert '<span class="verdict passed">passed</span>' in report
    assert report.count("data:image/png;base64,") == 3


def test_the_features_picture_shows_each_kind_in_its_colour(line):
    from trunnion.report.palette import load_palette

    pixels = (
        np.asarray(Image.open(line[2] / "B1.features.png").convert("RGB"))
        .reshape(-1, 3)
        .astype(float)
    )
    hues = pixels / np.maximum(np.linalg.norm(pixels, axis=1, keepdims=True), 1.0)
    for kind in line[1].recognition.counts():
        colour = np.array(load_palette().kind(kind), dtype=float)
        alike = hues @ (colour / np.linalg.norm(colour)) > 0.999
        assert alike.mean() > 0.0005, kind


def test_every_face_is_in_a_feature(line):
    recognition = line[1].recognition
    explained = {tag for feature in recognition for tag in feature.tags}
    assert explained | set(recognition.unexplained) == set(range(1, 261))


def is_the_same(name, folder, other):
    """Hold what was written of a part against what was written another time."""
    for end in (
        "S1.nc",
        "cl",
        "tools.json",
        "features.xml",
        "process.xml",
        "deviation.png",
        "report.html",
    ):
        file = f"{name}.{end}"
        # Not by the bytes themselves: where they differ, pytest compares megabytes of them line by line.
        first, second = (sha256((f / file).read_bytes()).hexdigest() for f in (folder, other))
        assert first == second, file


def test_the_same_part_gives_the_same_bytes(small, commanded):
    is_the_same("small", small[2], commanded[2])


@pytest.mark.long
def test_b1_gives_the_same_bytes(line, tmp_path):
    engine = Engine()
    session = engine.run(engine.open(Path(str(sample("B1")))))
    engine.write(session, tmp_path, name="B1")
    is_the_same("B1", tmp_path, line[2])


def test_the_saved_project_opens_with_everything_done(line):
    engine = Engine()
    session = engine.open(line[2] / "B1.trunnion")
    assert set(engine.states(session).values()) == {"done"}
    assert session.verdict.outcome is Outcome.PASSED


def test_a_changed_setting_makes_stale_what_depends_on_it_and_nothing_else(line):
    engine, session, _ = line
    states = engine.states(engine.with_choices(session, {"verify.coverage": "0.98"}))
    assert states == {**dict.fromkeys(STEPS, "done"), "verify": "stale", "repair": "stale"}
    states = engine.states(engine.with_choices(session, {"blank.top": "3"}))
    assert [s for s in STEPS if states[s] == "done"] == ["recognize", "size"]


def test_what_is_stale_can_not_be_written(line, tmp_path):
    engine, session, _ = line
    with pytest.raises(BadCall, match="verify again"):
        engine.write(engine.with_choices(session, {"verify.coverage": "0.98"}), tmp_path)


def test_an_operation_whose_inputs_are_the_same_keeps_its_toolpath(line):
    engine, session, _ = line
    last = session.process.operations[-1]
    slower = replace(last, data=replace(last.data, feed=last.data.feed / 2), by_hand=True)
    changed = engine.run(
        replace(session, process=session.process.with_operation(slower)), until="toolpath"
    )
    same = [a.operation for a, b in zip(session.paths, changed.paths, strict=True) if a is b]
    assert same == [o.id for o in session.process.operations[:-1]]
    assert changed.process.operation(last.id).data.feed == slower.data.feed


def test_a_cancelled_job_leaves_the_session_as_it_was(line):
    engine, session, _ = line
    stale, asked = replace(session, records={}), []

    def soon() -> bool:
        asked.append(1)
        return len(asked) > 40

    with pytest.raises(Cancelled):
        engine.run(stale, progress=Progress(cancelled=soon))
    assert stale.records == {} and engine.states(session)["verify"] == "done"


def test_a_program_edited_by_hand_is_judged_by_what_it_says(line, tmp_path):
    engine, session, folder = line
    text = (folder / "B1.S1.nc").read_text()
    assert "Z-38 " in text
    (tmp_path / "edited.nc").write_text(text.replace("Z-38 ", "Z-38.05 "))
    judged = verify_texts(engine, session, [tmp_path / "edited.nc"], NO_PROGRESS)
    assert judged.verdict.outcome is Outcome.FAILED
    assert judged.verdict.gouge == pytest.approx(0.05, abs=0.002)


def test_a_clamp_in_the_way_makes_the_toolpaths_stale_and_is_avoided(line, tmp_path):
    engine, session, _ = line
    low = session.part.low
    corners = [low + [x, y, z] for z in (0.0, 60.0) for y in (60.0, 100.0) for x in (-30.0, 5.0)]
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    rows = [
        f"vertex {x} {y} {z}"
        for a, b, c, d in quads
        for n in (a, b, c, a, c, d)
        for x, y, z in [corners[n]]
    ]
    (tmp_path / "clamp.stl").write_text("solid clamp\n" + "\n".join(rows))
    clamped = engine.with_fixtures(session, [str(tmp_path / "clamp.stl")])
    stale = [name for name, state in engine.states(clamped).items() if state != "done"]
    assert stale == ["toolpath", "verify", "repair"]
    held = engine.run(clamped, until="verify")
    # What it covers is named, nothing touches it, and enough is reached beside it.
    assert held.verdict.releases and held.verdict.collisions == 0
    assert 0.99 <= held.verdict.coverage < session.verdict.coverage
    assert "fixture.kept-off" in {f.code for f in held.findings()}
    with pytest.raises(BadInput, match="clamp is for setup S7; the part has S1"):
        engine.run(engine.with_fixtures(session, [f"S7={tmp_path / 'clamp.stl'}"]))


def test_a_program_that_fails_is_written_as_rejected_and_the_released_one_goes(small, tmp_path):
    engine, session, folder = small
    shutil.copytree(folder, tmp_path / "out")
    without = tuple(replace(o, suppressed=o.kind == "wall") for o in session.process.operations)
    failed = engine.run(replace(session, process=replace(session.process, operations=without)))
    names = engine.write(failed, tmp_path / "out", name="small")
    assert failed.verdict.outcome is Outcome.FAILED and failed.verdict.coverage < 0.99
    assert "small.S1.REJECTED.nc" in names and not (tmp_path / "out" / "small.S1.nc").exists()
    assert (
        "REJECTED: DO NOT RUN"
        in (tmp_path / "out" / "small.S1.REJECTED.nc").read_text().splitlines()[1]
    )
    assert "REJECTED" in (tmp_path / "out" / "small.cl").read_text()
    assert "REJECTED" in (tmp_path / "out" / "small.report.html").read_text()


def test_the_command_line_prints_the_documented_keys(commanded):
    code, said, folder = commanded
    assert code == (0 if said["verdict"].startswith("passed") else 1)
    assert {
        "verdict",
        "coverage",
        "reachable",
        "gouge_mm",
        "collisions",
        "rapids_in_stock",
        "machining_time_s",
        "bound_s",
        "over_bound",
        "seconds",
        "setups",
        "operations",
        "offers",
        "files",
        "findings",
    } <= said.keys()
    assert {"name", "nc", "frame", "blank"} <= said["setups"][0].keys()
    assert {
        "id",
        "kind",
        "feature",
        "tool",
        "verdict",
        "gouges",
        "left_mm",
        "engaged_deg",
        "depth_of_cut_mm",
        "removal_cm3_min",
        "chip_mm",
        "power_kw",
        "power_limit_kw",
        "torque_nm",
        "air_share",
        "bound_s",
        "cutting_s",
        "air_s",
        "rapid_s",
        "idle_s",
    } <= said["operations"][0].keys()
    assert sorted(said["files"]) == sorted(path.name for path in folder.iterdir())


def test_a_plan_with_errors_is_not_released_however_well_the_rest_is_cut(line):
    from trunnion.findings import error
    from trunnion.pipeline.proof.posted_programs import held_back

    verdict = held_back(
        line[1].verdict,
        [error("route.no-cutter", "no tool is small enough", "pocket-01", remedy="choose another")],
    )
    assert verdict.outcome is Outcome.FAILED
    assert (
        verdict.findings[0].code == "verify.errors-before"
        and "no tool is small enough" in verdict.findings[0].text
    )


def test_a_text_from_outside_is_held_back_by_errors_of_the_part_but_not_of_the_plan(line):
    from trunnion.findings import error
    from trunnion.model.session import StepRecord
    from trunnion.pipeline.proof.posted_programs import errors_before, errors_of_part

    told = error("part.open", "the part is not closed", remedy="sew it")
    planned = StepRecord(
        key="x",
        seconds=0.0,
        findings=(error("route.no-cutter", "no tool is small enough", remedy="choose another"),),
    )
    session = replace(
        line[1], part=replace(line[1].part, findings=(told,)), records={"route": planned}
    )
    assert errors_of_part(session) == (told,)
    assert [f.code for f in errors_before(session)] == ["part.open", "route.no-cutter"]


def test_the_window_without_a_screen_is_one_line_and_exit_2():
    import os
    import subprocess
    import sys

    bare = {
        k: v
        for k, v in os.environ.items()
        if k not in ("DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM")
    }
    said = subprocess.run(
        [sys.executable, "-m", "trunnion_gui.app"],
        capture_output=True,
        text=True,
        env=bare,
        check=False,
    )
    assert said.returncode == 2
    assert (
        said.stderr.startswith("trunnion-gui: no screen")
        and len(said.stderr.strip().splitlines()) == 1
    )
