"""Numbers at and beyond every limit: each is refused in one line that says what is allowed, or judged by the proof."""

from __future__ import annotations

import json
import math
from dataclasses import replace

import pytest
from pytest import approx

from leaning_paths import TABLE, again, standing
from nc_numbers import a_material, after, lines_of, not_finite, outcome_of, read, replaced
from programs import FLAT_16, S1
from trunnion.cli.programs.proof import operation_dict
from trunnion.findings import BadInput, Severity
from trunnion.model.verdict import Outcome
from trunnion.post.readers.apt.interpreter import read_apt
from trunnion.post.readers.linuxcnc import read_linuxcnc
from verify_tools import clean_plan, proof

START = "G21 G90 G17 G40 G94 G54\nT1 M6\nS9000 M3\nG0 G43 H1 X0 Y0 Z50\n"
MANY = "9" * 400
NEARLY_CLOSED = "line 5: the arc ends 1e-12 mm from its start; write the start's own numbers for a full circle, or a line"
TURNED = "G21 G90 G17 G94\nG54\nT1 M6\nS9000 M3\nG0 A0 C0\nG0 X0 Y0\nG43 H1 Z50\n"
CL = "UNITS/MM\nLOADTL/1\nSPINDL/RPM,9000,CLW\nRAPID\nGOTO/10,0,50\nFEDRAT/100,MMPM\n"


def refusal(body):
    with pytest.raises(BadInput) as refused:
        read_linuxcnc(START + body + "\nM30\n", (FLAT_16,), S1)
    return str(refused.value)


def codes(verdict):
    return {f.code for f in verdict.findings if f.severity is Severity.ERROR}


@pytest.mark.parametrize(
    ("body", "words"),
    [
        (
            f"G1 X{MANY} F100",
            "line 5: Xinf is out of range; allowed is -100000 to 100000 mm or inch",
        ),
        (
            "G1 X1000000000 F100",
            "line 5: X1000000000 is out of range; allowed is -100000 to 100000 mm or inch",
        ),
        (
            "G1 Z-100001 F100",
            "line 5: Z-100001 is out of range; allowed is -100000 to 100000 mm or inch",
        ),
        (
            "G3 I1000000000 F100",
            "line 5: I1000000000 is out of range; allowed is -100000 to 100000 mm or inch",
        ),
        (
            "G3 X5 R1000000000 F100",
            "line 5: R1000000000 is out of range; allowed is -100000 to 100000 mm or inch",
        ),
        (
            f"G1 X1 F{MANY}",
            "line 5: Finf is out of range; allowed is 0.001 to 500000 mm or inch a minute",
        ),
        (
            "G1 X1 F0.0000001",
            "line 5: F1e-07 is out of range; allowed is 0.001 to 500000 mm or inch a minute",
        ),
        ("G1 X1 F-0", "line 5: the feed F must be above zero"),
        ("S99999999999", "line 5: S99999999999 is out of range; allowed is 0 to 500000 1/min"),
        ("S-1", "line 5: the spindle speed S must not be negative"),
        (f"T{MANY} M6", "line 5: Tinf is out of range; allowed is 0 to 99999"),
        ("T-1 M6", "line 5: T-1 is out of range; allowed is 0 to 99999"),
        ("T-0 M6", "line 5: T0 is not in the tool list; it has 1"),
        (f"G43 H{MANY}", "line 5: Hinf is out of range; allowed is 0 to 99999"),
        (f"N{MANY} G1 X1 F100", "line 5: Ninf is out of range; allowed is 0 to 99999999"),
        ("N-0.5 G1 X1 F100", "line 5: N-0.5 is out of range; allowed is 0 to 99999999"),
        (f"G{MANY}", "line 5: G99999999999999999999999999999... is no code of this control"),
        (f"M{MANY}", "line 5: M99999999999999999999999999999... is no code of this control"),
        ("G1E300", "line 5: the word E is not understood by a three-axis program; remove it"),
        (
            "G59.4",
            "line 5: G59.4 is not understood; remove it or write what it does in known words",
        ),
        ("G4", "line 5: G4 without P; say how many seconds"),
        ("G4 P-1", "line 5: P-1 is out of range; allowed is 0 to 3600 s"),
        ("G4 P99999999999", "line 5: P99999999999 is out of range; allowed is 0 to 3600 s"),
        (
            "G4 G64 P0.005",
            "line 5: G4 and G64 in one line: whose P it is is not clear; write two lines",
        ),
        (
            "G64 P0.005 Q5",
            "line 5: G64 Q5 joins lines that are more than 0.02 mm apart; give a smaller Q",
        ),
        (
            "G64 P0.005 Q-1",
            "line 5: G64 Q-1 joins lines that are more than 0.02 mm apart; give a smaller Q",
        ),
        ("G3 I0 F100", "line 5: an arc without a radius; check its centre or R"),
        ("G3 I0.000000000001 F100", "line 5: an arc without a radius; check its centre or R"),
        ("G3 X0.001 R0 F100", "line 5: an arc without a radius; check its centre or R"),
        ("G3 X0.001 R0.0001 F100", "line 5: an arc without a radius; check its centre or R"),
        ("G3 X0.001 I0.001 F100", "line 5: an arc without a radius; check its centre or R"),
        ("G3 X0.000000000001 I5 F100", NEARLY_CLOSED),
        ("G3 X0.000000000001 R5 F100", NEARLY_CLOSED),
        (
            f"X{'-' * 5000}",
            "line 5: X----------------------------... is not understood; a word is a letter and a number",
        ),
    ],
)
def test_a_number_beyond_its_limit_is_refused_with_what_is_allowed(body, words):
    assert refusal(body) == words


def test_a_header_that_names_a_tool_of_a_thousand_digits_is_refused_in_a_short_line():
    message = refusal(f"(TOOL {'9' * 5000} flat 16 D16 R0 LENGTH 90 STICKOUT 33 HOLDER x)")
    assert (
        message.startswith("line 5: the text was made for another tool 9999") and len(message) < 150
    )


@pytest.mark.parametrize(
    ("body", "words"),
    [
        ("G1 A31 F1000", "line 8: A31 is out of range; allowed is -120 to 30 degrees"),
        (
            "G1 C1000000000 F1000",
            "line 8: C1000000000 is out of range; allowed is -9999999 to 9999999 degrees",
        ),
        (f"G0 C{MANY}", "line 8: Cinf is out of range; allowed is -9999999 to 9999999 degrees"),
        (
            "G1 C99999 F100",
            "line 8: C turns by 99999 degrees in one block, at most 3600 are understood; write several",
        ),
        (
            "G1 C360 F0.01",
            "line 8: at this feed the block takes 36000 min, no block takes more than 60; check F",
        ),
        (
            "G93 G1 C90 F0.000001",
            "line 8: F1e-06 is out of range; allowed is 0.0167 to 1000000000000 1/min",
        ),
        (
            f"G93 G1 C90 F{MANY}",
            "line 8: Finf is out of range; allowed is 0.0167 to 1000000000000 1/min",
        ),
    ],
)
def test_an_angle_or_a_time_beyond_the_machines_limits_is_refused(body, words):
    with pytest.raises(BadInput) as refused:
        again(TURNED + body + "\nM30\n", standing(TABLE))
    assert str(refused.value) == words


def test_a_rotary_axis_may_unwind_any_number_of_turns_at_the_top_of_the_machine():
    assert len(
        again(TURNED + "G53 G0 Z0\nG0 C36000\nG0 X1 Y1\nG0 Z50\nG1 X2 F100\nM30\n", standing(TABLE))
        .sections[0]
        .path
    )


@pytest.mark.parametrize(
    ("body", "words"),
    [
        (
            "GOTO/1E300,0,0",
            "line 7: GOTO 1e+300 is out of range; allowed is -100000 to 100000 mm or inch",
        ),
        ("GOTO/1E400,0,0", "line 7: 1E400,0,0 must be 3 or 6 numbers"),
        ("GOTO/1_0,0,0", "line 7: 1_0,0,0 is not a list of numbers"),
        ("GOTO/NAN,0,0", "line 7: NAN,0,0 is not a list of numbers"),
        (
            f"GOTO/{'1,' * 500}X",
            "line 7: 1,1,1,1,1,1,1,1,1,1,1,1,1,1,1... is not a list of numbers",
        ),
        (
            f"LOADTL/{'9' * 5000}",
            "line 7: tool 99999999999999999999999999999... is not in the tool list; it has 1",
        ),
        (
            "FEDRAT/1E-300,MMPM",
            "line 7: FEDRAT 1e-300 is out of range; allowed is 0.001 to 500000 mm or inch a minute",
        ),
        (
            "FEDRAT/1E300,MMPM",
            "line 7: FEDRAT 1e+300 is out of range; allowed is 0.001 to 500000 mm or inch a minute",
        ),
        ("SPINDL/RPM,-1,CLW", "line 7: SPINDL -1 is out of range; allowed is 0 to 500000 1/min"),
        (
            "CIRCLE/1E9,0,0,0,0,1,5",
            "line 7: CIRCLE 1000000000 is out of range; allowed is -100000 to 100000 mm or inch",
        ),
        (
            "CIRCLE/10,0,50,0,0,1,0\nGOTO/10,0,50",
            "line 8: an arc without a radius; check its centre or R",
        ),
        (
            "SPINDL/OFF\nGOTO/1,0,0",
            "line 8: a feed move while the spindle stands; put SPINDL first",
        ),
        (
            "A\x0bB/1",
            "line 7: A?B is not understood; known are PARTNO, PPRINT, REMARK, UNITS, MULTAX, LOADTL, CUTTER, SPINDL, COOLNT, RAPID, "
            "FEDRAT, GOTO, CIRCLE, DELAY, END, FINI",
        ),
    ],
)
def test_cl_text_is_refused_in_the_same_way(body, words):
    with pytest.raises(BadInput) as refused:
        read_apt(CL + body + "\nFINI\n", (FLAT_16,), [S1])
    assert str(refused.value) == words


@pytest.mark.parametrize(
    "body",
    [
        "X-0",
        "Y-0.0",
        "X+00000.5",
        "X" + "0" * 300 + "1",
        "X0.5" + "0" * 300,
        "G01X1",
        "G1.0 X2",
        "M-0",
    ],
)
def test_a_number_written_in_an_unusual_way_is_read(body):
    program = read_linuxcnc(START + "G1 F100\n" + body + "\nG0 Z60\nM30\n", (FLAT_16,), S1)
    assert not any(
        math.copysign(1.0, v) < 0.0 and v == 0.0 for v in program.sections[0].path.position.ravel()
    )


@pytest.mark.parametrize(
    ("dialect", "place", "new"),
    [
        ("linuxcnc", "G1", "S0"),
        ("linuxcnc", "G1", "S0.4"),
        ("linuxcnc", "G1", "M5\nS0 M3"),
        ("apt", "FEDRAT", "SPINDL/RPM,0,CLW"),
    ],
)
def test_a_cut_with_the_spindle_standing_fails_the_proof(dialect, place, new):
    verdict = outcome_of(dialect, after(dialect, place, new))
    assert verdict.outcome is Outcome.FAILED and codes(verdict) >= {"verify.spindle-stands"}
    (said,) = [f for f in verdict.findings if f.code == "verify.spindle-stands"]
    assert "with the spindle standing still" in said.text and any(
        w.startswith("line ") for w in said.where
    )
    assert not list(not_finite(verdict))


def test_a_spindle_that_stands_while_only_rapids_run_is_no_fault():
    # The pocket's operation goes to its place while the spindle stands, as one of its own.
    text = replaced("linuxcnc", "S10000 M3", "S0 M3").replace(
        "G0 G43 H2 Z30", "G0 G43 H2 Z30\n(OPERATION next)\nS10000"
    )
    assert [s.spindle for s in read("linuxcnc", text).sections] == [10000.0, 0.0, 10000.0]
    assert outcome_of("linuxcnc", text).outcome is Outcome.PASSED


def test_the_proof_itself_bears_a_section_whose_spindle_stands():
    face, pocket = clean_plan()
    for spindle in (0.0, 1e-12, 1e-300):
        verdict = proof(face, replace(pocket, spindle=spindle), material=a_material())
        assert codes(verdict) == {"verify.spindle-stands"} and not list(not_finite(verdict))


def test_a_feed_at_which_a_block_takes_hours_fails_the_proof():
    verdict = outcome_of("linuxcnc", after("linuxcnc", "G1", "G1 X1 F0.001"))
    assert "verify.endless" in codes(verdict)
    assert next(f for f in verdict.findings if f.code == "verify.endless").text.startswith(
        "pocket takes "
    )


def test_a_program_within_the_longest_block_is_not_endless():
    assert "verify.endless" not in codes(
        outcome_of("linuxcnc", after("linuxcnc", "G1", "G1 X18 F1"))
    )


@pytest.mark.parametrize("place", ["G53 G0 Z0", "M8", "G1", "M6"])
def test_a_dwell_counts_in_the_time_wherever_it_stands(place):
    plain, waiting = (
        outcome_of("linuxcnc", text)
        for text in ("\n".join(lines_of("linuxcnc")), after("linuxcnc", place, "G4 P90.5"))
    )
    assert waiting.machining_time_s == approx(plain.machining_time_s + 90.5)
    assert waiting.outcome is Outcome.PASSED


def test_a_dwell_belongs_to_the_operation_that_waits():
    first, second = read("linuxcnc", after("linuxcnc", "G1", "G4 P2")).sections
    assert (first.dwell, second.dwell) == (0.0, 2.0)


@pytest.mark.parametrize(
    "new",
    [
        "G1 X99999 Y99999 Z-99999",
        "G0 X99999",
        "G1 Z99999",
        "G3 I99999",
        "G3 I99999 Z-99999",
        "G3 I5 Z-99999",
        "G2 X0 Y0 R-99999",
        "G1 X1 F500000",
        "S500000",
        "S1",
    ],
)
def test_what_a_machine_cannot_do_is_judged_by_the_proof(new):
    verdict = outcome_of("linuxcnc", after("linuxcnc", "G1", new + "\nG1"))
    assert verdict.outcome is Outcome.FAILED and codes(verdict)
    assert not list(not_finite(verdict))
    json.dumps([operation_dict(o) for o in verdict.operations], allow_nan=False)


def test_the_program_itself_passes_with_the_material_that_judges_loads():
    for dialect in ("linuxcnc", "apt"):
        verdict = outcome_of(dialect, "\n".join(lines_of(dialect)))
        assert verdict.outcome is Outcome.PASSED and not list(not_finite(verdict))
