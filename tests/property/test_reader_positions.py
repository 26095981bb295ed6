"""Lines of positions alone are read by short ways: the motions and the refusals are those of any other line."""

from __future__ import annotations

import re
from dataclasses import fields

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from leaning_paths import TABLE, standing
from programs import BULL_10, FLAT_16, S1
from trunnion import registry
from trunnion.findings import BadInput
from trunnion.post.readers.sinumerik import blocks as sinumerik_blocks
from trunnion.post.readers.sinumerik.blocks import split_sinumerik_line
from trunnion.post.readers.word_address.moves import ToolMover

WORD_ADDRESS = ["linuxcnc", "fanuc", "sinumerik"]
STARTS = {
    "linuxcnc": "G21 G54\nT1 M6\nS9000 M3\nG0 X0 Y0\nG43 H1 Z50\n",
    "fanuc": "G21 G54\nT1 M6\nS9000 M3\nG0 X0. Y0.\nG43 H1 Z50.\n",
    "sinumerik": "G710 G54\nT1 M6\nS9000 M3\nG0 X0 Y0\nD1 Z50\n",
}
TIP_STARTS = {
    "fanuc": "G21 G54\nT1 M6\nS9000 M3\nG43.5 H1 P1\nG0 X0. Y0. Z50. I0. J0. K1.\n",
    "sinumerik": "G710 G54\nT1 M6\nS9000 M3\nD1\nTRAORI\nG0 X0 Y0 Z50 A3=0 B3=0 C3=1\n",
}
VECTORS = {"fanuc": ("I", "J", "K"), "sinumerik": ("A3=", "B3=", "C3=")}
plain_numbers = st.sampled_from(["0.", "1.", "-1.", "7.5", "-0.", "0.5", "20.25", ".001"])
numbers = st.one_of(*[plain_numbers] * 15, st.just("99999999."))
spare = st.sampled_from(
    [
        "G0",
        "G1",
        "G1 F100.",
        "F100.",
        "F0.",
        "M5",
        "M9",
        "S500.",
        "G93",
        "G94",
        "G53",
        "G40",
        "K1.",
        "D0",
        "G49",
        "TRAFOOF",
        "TRAORI",
        "N1",
        "P1.",
        "B3.",
        "H1",
        "R2.",
    ]
)
"""Words that end a run of straight moves, or that are refused."""


def split(text):
    """Return the block of a Sinumerik line, or why it is refused."""
    try:
        return split_sinumerik_line(7, text, lambda line, name: 3.0)
    except BadInput as refused:
        return str(refused)


words = st.one_of(
    st.tuples(
        st.sampled_from(
            ["X", "y", "A3=", "b3=", "R3=", "TURN=", "G", "M", "F", "N", "X=", "T", "G4 F"]
        ),
        st.sampled_from(["0", "-1.5", "+.5", "3.", ".", "", "1e5", "1_0", "4", "٣", '"a"', "123"]),
    ).map("".join),
    st.sampled_from(
        [
            "MCALL",
            "CYCLE800()",
            "TRAORI",
            "=3",
            "(",
            ";",
            "/",
            "\t",
            "  ",
            "\x1c",
            "ß",
            "ſ1",
            "X1Y2",
        ]
    ),
    st.text(alphabet='GXYA3=.-+ ()"0', max_size=6),
)


@settings(deadline=None, max_examples=250)
@given(text=st.lists(words, max_size=8), between=st.sampled_from([" ", "", "\t", "\xa0 "]))
def test_a_line_of_simple_words_is_read_as_any_other(text, between):
    line = between.join(text)
    read = split(line)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(sinumerik_blocks, "_SIMPLE_WORD", re.compile("(?!)"))
        assert split(line) == read


def read(name, text, places):
    """Return all that a text says as texts and numbers, or why it is refused."""
    try:
        (found,) = registry.get("dialects", name)().read(text, (FLAT_16, BULL_10), [S1], places)
    except BadInput as refused:
        return str(refused)
    return [
        getattr(s.path, f.name).tolist()
        if isinstance(getattr(s.path, f.name), np.ndarray)
        else None
        for s in found.sections
        for f in fields(s.path)
    ] + [[repr(getattr(s, f.name)) for f in fields(s) if f.name != "path"] for s in found.sections]


def same_motions(name, text, places):
    """Assert that a text is read the same, or refused for the same reason, with and without the short way."""
    short = read(name, text, places)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(ToolMover, "straight", lambda self: None)
        long = read(name, text, places)
    assert repr(short) == repr(long)


@st.composite
def bodies(draw, letters):
    """Return lines that mostly say positions alone, most of them in order."""
    lines, number = [], 100
    for _ in range(draw(st.integers(1, 12))):
        chosen = draw(st.lists(st.sampled_from(letters), min_size=1, max_size=6))
        line = [letter + draw(numbers) for letter in dict.fromkeys(chosen)]
        number += draw(st.sampled_from([1, 1, 1, 1, 1, 0]))
        line[:0] = draw(st.sampled_from([[f"N{number}"], []]))
        line += draw(st.one_of(*[st.just([])] * 6, spare.map(lambda word: [word])))
        lines += [" ".join(line), *draw(st.one_of(*[st.just([])] * 3, st.lists(spare, max_size=1)))]
    return "\n".join(lines)


@pytest.mark.examples(40)
@pytest.mark.parametrize("name", WORD_ADDRESS)
@settings(deadline=None, max_examples=100)
@given(body=bodies(["X", "Y", "Z"]), begins=st.sampled_from(["G1 X1. F100.\n", "G0 X1.\n", ""]))
def test_positions_of_three_axes_are_read_as_line_by_line(name, body, begins):
    same_motions(name, f"{STARTS[name]}{begins}{body}\nM30\n", {})


@pytest.mark.examples(50)
@pytest.mark.parametrize("name", ["fanuc", "sinumerik"])
@settings(deadline=None, max_examples=150)
@given(data=st.data(), begins=st.sampled_from(["G1 X1. F100.\n", "G0 X1.\n"]))
def test_positions_and_directions_are_read_as_line_by_line(name, data, begins):
    body = data.draw(bodies(["X", "Y", "Z", *VECTORS[name]]))
    same_motions(name, f"{TIP_STARTS[name]}{begins}{body}\nM30\n", {"S1": standing(TABLE)})


@pytest.mark.parametrize(
    "body",
    [
        "D0\nX2",
        "M5\nX2",
        "M9\nX2",
        "G93\nX2",
        "G53\nX2",
        "TRAFOOF\nX2",
        "TRAFOOF\nX2 A3=1",
        "SUPA G0 Z0\nX2",
        "N5 X2\nN5 X3",
        "N5\nN4 X3",
        "X2 A3=0 B3=0",
        "X2 C3=0.0001",
        "X2 C3=-1",
        "X2\nA3=2 C3=2\nZ40",
        "X2 J3",
        "X2 D1",
        "M30\nX2",
        "G93 X2 F100\nX3",
        "G95 X2 F0.1\nX3",
    ],
)
@pytest.mark.parametrize("begins", ["G1 X1 F100\n", "G0 X1\n"])
def test_what_ends_a_run_of_positions_is_read_as_line_by_line(body, begins):
    same_motions(
        "sinumerik", f"{TIP_STARTS['sinumerik']}{begins}X3\n{body}\nM30\n", {"S1": standing(TABLE)}
    )


def test_the_short_way_is_taken_in_long_texts():
    taken, straight = [], ToolMover.straight
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(ToolMover, "straight", lambda self: taken.append(1) or straight(self))
        text = STARTS["sinumerik"] + "G1 X1 F100\n" + "X2\nX3 Y4\n" * 50 + "M30\n"
        assert isinstance(read("sinumerik", text, {}), list)
    assert len(taken) == 1
