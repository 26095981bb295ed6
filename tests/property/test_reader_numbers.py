"""Whatever number stands behind whatever word: a text is refused in one line, or read and judged, in finite numbers."""

from __future__ import annotations

import math
import string

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from leaning_paths import TABLE, again, standing
from nc_numbers import AWKWARD, DIALECTS, judged, lines_of, not_finite, read
from trunnion.findings import BadInput
from trunnion.model.motion.program import Program
from trunnion.model.motion.toolpath import Motion
from trunnion.model.verdict import Outcome
from trunnion.units import FARTHEST, FASTEST, LONGEST_BLOCK, MM_PER_INCH

LONGEST_LINE = 200
"""Characters of a refusal that a person still reads."""
BLOCKS = (
    "G0",
    "G1",
    "G1 F500",
    "G2",
    "G2 I5",
    "G3",
    "G3 R5",
    "G4",
    "G43",
    "G64 P0.005",
    "M3",
    "M6",
    "G53 G0",
    "G20",
    "G93",
    "",
)
CL_BLOCKS = (
    "GOTO/{0},0,30",
    "GOTO/0,{0},30",
    "GOTO/0,0,{0}",
    "GOTO/0,0,30,{0},0,1",
    "CIRCLE/{0},0,30,0,0,1,5",
    "CIRCLE/0,0,30,0,0,1,{0}",
    "CIRCLE/0,0,30,0,0,{0},5\nGOTO/0,5,30",
    "SPINDL/RPM,{0},CLW",
    "FEDRAT/{0},MMPM",
    "LOADTL/{0}",
    "LOADTL/2,LENGTH,{0}",
    "CUTTER/{0},2",
    "CUTTER/6,{0}",
    "UNITS/{0}",
    "MULTAX/{0}",
    "COOLNT/{0}",
    "RAPID/{0}",
    "END/{0}",
    "PPRINT/SETUP {0} WORK OFFSET G54",
)
JUDGED = (
    "G1 X{0} Y{1}",
    "G1 X{0} Z{1} F{2}",
    "G0 X{0} Y{1}",
    "G0 Z{0}",
    "G2 I{0} J{1} Z{2}",
    "G3 X{0} Y{1} R{2}",
    "G3 X{0} Y{1} I{2} J0",
    "G1 F{0}\nX{1}",
    "S{0}",
    "S{0} M3",
    "M5\nS{0} M3",
    "G4 P{0}",
    "G64 P{0} Q{1}",
    "T1 M6\nS{0} M3\nG0 X{1} Y0\nG43 H1 Z{2}",
)
"""Lines that leave much to the proof: what stands in them is mostly read."""
TURNED = "G21 G90 G17 G94\nG54\nT1 M6\nS9000 M3\nG0 A0 C0\nG0 X0 Y0\nG43 H1 Z50\nG1 Z30 F500\n"

plain = st.floats(-1e12, 1e12).map(lambda v: f"{v:.12f}".rstrip("0"))
numbers = st.one_of(
    st.sampled_from(AWKWARD), plain, st.floats(-100.0, 100.0).map(lambda v: f"{v:.4f}")
)
words = st.tuples(st.sampled_from(string.ascii_uppercase), numbers).map("".join)
fair = st.one_of(
    st.sampled_from(
        (
            "0",
            "-0",
            "0.0004",
            "0.000000000001",
            "1",
            "-1",
            "100000",
            "-100000",
            "99999",
            "500000",
            "0.001",
            "10.0001",
            "-10.000000000000000000001",
            "3600",
            "0.02",
        )
    ),
    st.floats(-200.0, 200.0).map(lambda v: f"{v:.4f}"),
)
shares = st.floats(0.0, 1.0, exclude_max=True)
kept = settings(deadline=None, derandomize=True, database=None)


@st.composite
def inserted(draw):
    """Return the LinuxCNC text with one line more, of a block and one to three words."""
    lines = list(lines_of("linuxcnc"))
    row = int(draw(shares) * len(lines))
    line = " ".join([draw(st.sampled_from(BLOCKS)), *draw(st.lists(words, min_size=1, max_size=3))])
    return "\n".join([*lines[:row], line, *lines[row:]])


@st.composite
def replaced(draw):
    """Return the LinuxCNC text with the numbers of one to three words replaced."""
    lines = [line.split(" ") for line in lines_of("linuxcnc")]
    places = [
        (r, c)
        for r, line in enumerate(lines)
        for c, w in enumerate(line)
        if w[:1].isalpha() and not line[0].startswith("(")
    ]
    for _ in range(draw(st.integers(1, 3))):
        row, column = places[int(draw(shares) * len(places))]
        lines[row][column] = lines[row][column][0] + draw(numbers)
    return "\n".join(" ".join(line) for line in lines)


@st.composite
def cuts(draw):
    """Return the LinuxCNC text with one line more inside its last operation, of the kind that the proof has to judge."""
    lines = list(lines_of("linuxcnc"))
    first = next(n for n, line in enumerate(lines) if "OPERATION pocket" in line)
    begins = [n for n, line in enumerate(lines) if n > first and " G1 " in line]
    row = begins[int(draw(shares) * len(begins))]
    line = draw(st.sampled_from(JUDGED)).format(*(draw(fair) for _ in range(3)))
    return "\n".join([*lines[:row], line, *lines[row:]])


@st.composite
def cl_texts(draw):
    """Return the CL text with one statement more."""
    lines = list(lines_of("apt"))
    row = int(draw(shares) * len(lines))
    return "\n".join(
        [*lines[:row], draw(st.sampled_from(CL_BLOCKS)).replace("{0}", draw(numbers)), *lines[row:]]
    )


def understood(dialect: str, text: str) -> Program | None:
    """Return what a text says, checked to be finite and within what machines do; None when it is refused in one readable line."""
    try:
        program = read(dialect, text)
    except BadInput as refused:
        one_line(refused)
        return None
    check_finite(program)
    return program


def one_line(refused: BadInput) -> None:
    said = str(refused)
    assert said.isprintable() and len(said) <= LONGEST_LINE
    assert said.startswith("line ") or said.split(" ")[0:2] in (["the", "program"], ["the", "text"])


def check_finite(program: Program) -> None:
    for section in program.sections:
        path = section.path
        assert np.abs(path.position).max() <= FARTHEST * MM_PER_INCH
        assert all(
            np.isfinite(values).all()
            for values in (path.position, path.axis, path.feed, path.sweeps(), path.lengths())
        )
        assert 0.0 <= section.spindle <= FASTEST and path.feed.max() <= FASTEST * MM_PER_INCH
        assert 0.0 <= section.dwell < math.inf and section.block_lines[-1] > 0


def check_judged(program: Program) -> None:
    verdict = judged(program)
    assert not list(not_finite(verdict))
    stands = any(
        s.spindle_stopped and (s.path.motion != Motion.RAPID).any() for s in program.sections
    )
    slow = any(b.time.max(initial=0.0) > LONGEST_BLOCK for b in verdict.blocks)
    far = any(np.ptp(s.path.position, axis=0).max() > 600.0 for s in program.sections)
    assert verdict.outcome is Outcome.FAILED or not (stands or slow or far)


@pytest.mark.examples(100)
@settings(kept, max_examples=300)
@given(st.one_of(inserted(), replaced()))
def test_a_text_is_read_in_finite_numbers_or_refused_in_one_line(text):
    understood("linuxcnc", text)


@settings(kept, max_examples=300)
@given(cl_texts())
def test_a_cl_text_is_read_in_finite_numbers_or_refused_in_one_line(text):
    understood("apt", text)


@pytest.mark.examples(25)
@settings(kept, max_examples=80)
@given(cuts())
def test_what_is_read_is_judged_in_finite_numbers(text):
    if (program := understood("linuxcnc", text)) is not None:
        check_judged(program)


@settings(kept, max_examples=30)
@given(cl_texts())
def test_what_is_read_of_a_cl_text_is_judged_in_finite_numbers(text):
    if (program := understood("apt", text)) is not None:
        check_judged(program)


@settings(kept, max_examples=200)
@given(
    st.sampled_from(("G0", "G1", "G1 F500", "G93 G1 F9", "G2 I5 F100", "G53 G0 Z0\nG0")),
    st.lists(words, min_size=1, max_size=2),
)
def test_positions_of_rotary_axes_are_read_in_finite_numbers_or_refused(block, said):
    try:
        program = again(TURNED + " ".join([block, *said]) + "\nG0 Z60\nM30\n", standing(TABLE))
    except BadInput as refused:
        one_line(refused)
        return
    check_finite(program)
    assert program.n_blocks() < 100_000


def test_every_word_with_every_awkward_number_is_read_or_refused():
    lines = list(lines_of("linuxcnc"))
    row = next(n for n, line in enumerate(lines) if "G1 X" in line) + 1
    for letter in string.ascii_uppercase:
        for number in AWKWARD:
            understood("linuxcnc", "\n".join([*lines[:row], f"{letter}{number}", *lines[row:]]))
    assert set(DIALECTS) == {"linuxcnc", "apt"}
