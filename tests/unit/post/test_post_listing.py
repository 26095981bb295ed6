"""The neutral listing of motions."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from programs import CCW, FLAT_16, LINE, RAPID, S1, path_of, program_1, program_from, section
from trunnion.model.motion.listing import listing
from trunnion.model.motion.program import Program

PATH = path_of((RAPID, 1, 2, 50), (LINE, 1, 2, -0.00001, 99.96), (CCW, 3, 2, -1, 2, 2, 1200))


def one(path) -> Program:
    return Program(name="any", setup=S1, sections=(section("op-1", FLAT_16, path),))


def test_every_block_says_all_its_words():
    assert listing(one(PATH)) == (
        "setup S1 G54\n"
        "operation op-1 tool 1 spindle 12000 coolant flood\n"
        "rapid   x 1.0000 y 2.0000 z 50.0000 retract\n"
        "line    x 1.0000 y 2.0000 z 0.0000 feed 100.0 cut\n"
        "arc-ccw x 3.0000 y 2.0000 z -1.0000 centre x 2.0000 y 2.0000 feed 1200.0 cut\n"
    )


def test_marks_may_be_left_out():
    assert listing(one(PATH), marks=False).splitlines()[2] == "rapid   x 1.0000 y 2.0000 z 50.0000"


def test_a_tilted_axis_is_said():
    tilted = replace(PATH, axis=np.array([[0.0, 0.0, 1.0], [0.6, 0.0, 0.8], [0.6, 0.0, 0.8]]))
    assert (
        listing(one(tilted)).splitlines()[3]
        == "line    x 1.0000 y 2.0000 z 0.0000 i 0.6000 j 0.0000 k 0.8000 feed 100.0 cut"
    )


def test_the_listing_of_what_a_listing_says_is_the_same():
    assert listing(program_from(listing(program_1()))) == listing(program_1())
