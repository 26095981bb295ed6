"""Designations of threads in words: those of the standards are found, what only looks like one is not."""

from __future__ import annotations

import pytest

from trunnion.part.read.thread_text import thread_in


@pytest.mark.parametrize(
    ("words", "thread"),
    [
        # ISO 965-1, 5855 and 2904, as their own examples write them.
        ("M6x1", "M6x1"),
        ("TAPPED M8 × 1-6H, 12 deep", "M8 × 1-6H"),
        ("2X M6x0,75-6H-LH", "M6x0,75-6H-LH"),
        ("MJ6x1-4H5H", "MJ6x1-4H5H"),
        ("Tr 40x7", "Tr 40x7"),
        # ASME B1.1, B1.15 and B1.20.1.
        ("1/4-20 UNC-2B THRU", "1/4-20 UNC-2B"),
        ("#10-32 UNF", "#10-32 UNF"),
        (".250-28 UNJF-3B", ".250-28 UNJF-3B"),
        ("1 1/2-6 UNC", "1 1/2-6 UNC"),
        ("1/4-18 NPT", "1/4-18 NPT"),
        # ISO 228-1 and 7-1.
        ("port G1/4", "G1/4"),
        ("Rp 1 1/2", "Rp 1 1/2"),
    ],
)
def test_a_whole_designation_is_found_as_it_is_written(words: str, thread: str) -> None:
    assert thread_in(words) == thread


@pytest.mark.parametrize(
    "words",
    [
        "clearance hole for M6",
        "M6",
        "Simple Hole(12)",
        "Radial Dimension (17)",
        "12 H7",
        "DRAWING AM6x1",
        "2 x 45",
        "1/4",
        "M6x1 or M6x0.75",
        "",
    ],
)
def test_what_names_no_thread_for_certain_is_none(words: str) -> None:
    assert thread_in(words) == ""


def test_a_size_alone_is_a_thread_only_where_it_stands_for_the_size() -> None:
    assert thread_in(" M6 - 6H ", alone=True) == "M6 - 6H"
    assert thread_in("M6 screw", alone=True) == ""
