"""Who may be released, and that nothing rejected can look so."""

from __future__ import annotations

from dataclasses import replace

import pytest

import programs
from programs import program_1, program_2, verdict
from trunnion.findings import BadCall, Refused, error
from trunnion.model.session import PostedFile, Session
from trunnion.model.verdict import Outcome, Verdict
from trunnion.post.dialects.apt import AptDialect
from trunnion.post.dialects.linuxcnc import LinuxCncDialect
from trunnion.post.header import STAMP_LINES, Header
from trunnion.post.release import is_program_of, is_released, release
from trunnion.post.settings import PostSettings
from trunnion.store.programs import write_programs


def proven(given: Verdict | None) -> Session:
    """Return a session whose two setups and CL are posted, with a verdict."""
    session = programs.session()
    header, settings = Header.of(session), PostSettings()
    texts = [
        PostedFile(
            suffix=f"{p.setup.name}.nc",
            dialect="linuxcnc",
            setup=p.setup.name,
            text=LinuxCncDialect().write([p], header, settings),
        )
        for p in (program_1(), program_2())
    ]
    texts.append(
        PostedFile(
            suffix="cl",
            dialect="apt",
            setup="",
            text=AptDialect().write([program_1(), program_2()], header, settings),
        )
    )
    return replace(session, posted=tuple(texts), verdict=given)


FAILED = replace(
    verdict(Outcome.FAILED),
    gouge=0.0513,
    collisions=2,
    findings=(error("verify.gouge", "cuts into the part", "face 4"),),
)


def test_a_passed_plan_leaves_under_plain_names():
    files = release(proven(verdict()), date="2026-01-02")
    assert [f.suffix for f in files] == ["S1.nc", "S2.nc", "cl"]
    assert all(is_released(f.text) for f in files)
    assert files[0].text.split("\n")[:STAMP_LINES] == [
        "(TRUNNION PROGRAM B1.S1)",
        "(RELEASED)",
        "(VERDICT: PASSED, coverage 99.51 %, gouge 0.0012 mm)",
        "(REMARKS: a quarter is air wall-01)",
        "(DATE: 2026-01-02)",
    ]


def test_remarks_release_too():
    assert is_released(release(proven(verdict(Outcome.REMARKS)))[0].text)


def test_a_failed_plan_leaves_as_rejected_with_the_reasons():
    files = release(proven(FAILED))
    assert [f.suffix for f in files] == ["S1.REJECTED.nc", "S2.REJECTED.nc", "cl"]
    assert files[1].text.split("\n")[1:4] == [
        "(REJECTED: DO NOT RUN)",
        "(VERDICT: FAILED, coverage 99.51 %, gouge 0.0513 mm)",
        "(REASON: gouge 0.0513 mm, 2 collisions, cuts into the part face 4)",
    ]
    assert files[2].text.split("\n")[1] == "PPRINT/REJECTED: DO NOT RUN"


def test_a_passed_verdict_with_an_error_among_its_findings_is_rejected():
    files = release(proven(replace(verdict(), findings=(error("verify.block", "not understood"),))))
    assert files[0].suffix == "S1.REJECTED.nc"


def test_the_motions_that_leave_are_byte_for_byte_those_that_were_proven():
    session = proven(verdict())
    for posted, left in zip(
        session.posted, release(session, name="OTHER", date="2026-01-02"), strict=True
    ):
        assert posted.text.split("\n")[STAMP_LINES:] == left.text.split("\n")[STAMP_LINES:]
        assert "PROGRAM OTHER" in left.text.split("\n")[0]


def test_the_stamp_keeps_every_line_number():
    passed, failed = release(proven(verdict())), release(proven(FAILED))
    assert [f.text.count("\n") for f in passed] == [f.text.count("\n") for f in failed]


def test_same_session_same_bytes():
    assert release(proven(verdict()), date="d") == release(proven(verdict()), date="d")


def test_nothing_leaves_unproven():
    with pytest.raises(BadCall, match="verify first"):
        release(proven(None))


def test_a_plan_changed_after_its_proof_does_not_leave():
    session = proven(verdict())
    assert session.process is not None
    changed = replace(
        session, process=replace(session.process, operations=session.process.operations[:-1])
    )
    with pytest.raises(Refused, match="not the text of this session's plan"):
        release(changed)


def test_earlier_programs_of_the_name_go_and_others_stay(tmp_path):
    for name in (
        "B1.S1.nc",
        "B1.S9.nc",
        "B1.S1.REJECTED.nc",
        "B1.cl",
        "B12.S1.nc",
        "B1.report.html",
        "B1.trunnion",
    ):
        (tmp_path / name).write_text("old")
    names = write_programs(tmp_path, "B1", release(proven(FAILED)))
    assert names == ("B1.S1.REJECTED.nc", "B1.S2.REJECTED.nc", "B1.cl")
    assert sorted(p.name for p in tmp_path.iterdir()) == [
        "B1.S1.REJECTED.nc",
        "B1.S2.REJECTED.nc",
        "B1.cl",
        "B1.report.html",
        "B1.trunnion",
        "B12.S1.nc",
    ]
    assert "DO NOT RUN" in (tmp_path / "B1.cl").read_text()


def test_a_rejected_text_is_not_written_under_a_released_name(tmp_path):
    (tmp_path / "B1.S1.nc").write_text("good")
    rejected = [
        replace(f, suffix=f.suffix.replace(".REJECTED", "")) for f in release(proven(FAILED))
    ]
    with pytest.raises(Refused, match="its name and its stamp differ"):
        write_programs(tmp_path, "B1", rejected)
    assert (tmp_path / "B1.S1.nc").read_text() == "good"


def test_a_rejected_setup_is_not_written_beside_a_released_one(tmp_path):
    with pytest.raises(Refused, match="whole or not at all"):
        write_programs(tmp_path, "B1", (release(proven(verdict()))[0], release(proven(FAILED))[1]))


def test_an_unproven_text_is_not_written_as_released(tmp_path):
    with pytest.raises(Refused, match="its name and its stamp differ"):
        write_programs(tmp_path, "B1", proven(verdict()).posted)


def test_a_name_does_not_reach_for_a_longer_one():
    assert not is_program_of("B1", "B1.x.S1.nc")
    assert is_program_of("B1.x", "B1.x.S1.nc")


def test_reasons_without_end_are_counted():
    many = replace(FAILED, findings=tuple(error("verify.gouge", f"gouge {n}") for n in range(20)))
    header = replace(Header.of(programs.session()), verdict=many)
    assert header.reasons()[-1] == "and 16 more"
    assert all(len(line) <= 240 for line in LinuxCncDialect().stamp("B1.S1", header))


def test_an_acceptance_by_a_person_stands_in_the_verdict_line():
    header = replace(
        Header.of(programs.session()),
        verdict=replace(verdict(), accepted_by="A. Smith, 2026-01-02: left for the fitter"),
    )
    assert (
        "shortfall accepted by A. Smith, 2026-01-02: left for the fitter"
        in header.stamp("B1.S1")[2]
    )
