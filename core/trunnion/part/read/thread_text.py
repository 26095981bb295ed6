"""The designation of a screw thread in words that a file holds, as the file writes it.

Only whole designations count: with their pitch (ISO 965-1 and 5855 "M6x1", ISO 2904 "Tr20x4") or number of threads an inch and series
(ASME B1.1 and B1.15 "1/4-20 UNC", ASME B1.20.1 "1/4-18 NPT"), or a pipe thread by its size (ISO 228-1 "G1/4", ISO 7-1 "Rp 1/4"). A letter
and a size alone ("M6") name a screw as often as a thread ("clearance hole for M6"): they count only where they are all that an annotation
of the size shows.
"""

from __future__ import annotations

import re

_CLASS = r"(?:\s*-\s*\d[A-Za-z](?:\d[A-Za-z])?(?![A-Za-z0-9]))?(?:\s*-?\s*LH\b)?"
"""Tolerance class and hand: "-6H", "-4H5H", "-LH"."""
_METRIC = r"(?:MJ?|Tr)\s?\d+(?:[.,]\d+)?"
_PITCH = r"\s?[xX×]\s?\d+(?:[.,]\d+)?"
_INCH = r"(?:\d+[ -]\d+/\d+|\d+/\d+|#\d+|\d*\.\d+|\d+)"
_SERIES = r"(?:UNJ?(?:C|F|EF|S)?|UNR(?:C|F|EF|S)?|NPTF?|NPSM?|NPSC|NPSF)"
_UNIFIED = (
    rf"{_INCH}\s?(?:[\"″]\s?)?-\s?\d+(?:\.\d+)?\s?{_SERIES}(?:\s?-\s?[123][AB])?(?:\s*-\s*LH\b)?"
)
_PIPE = r"(?:G|Rp|Rc|R)\s?(?:\d+\s)?\d+/\d+(?:\s?[AB]\b)?"
_WITHIN = re.compile(
    rf"(?<![A-Za-z0-9./#-])(?:{_METRIC}{_PITCH}{_CLASS}|{_UNIFIED}|{_PIPE})(?![A-Za-z0-9/])"
)
_ALONE = re.compile(rf"{_METRIC}(?:{_PITCH})?{_CLASS}")


def thread_in(text: str, *, alone: bool = False) -> str:
    """Return the designation of the thread that a text names, with single spaces, or "" where it names none or more than one.

    `alone` says that the text stands for the size itself, so that a letter and a size name a thread.

    >>> thread_in("TAPPED M6 x 1-6H, 12 DEEP"), thread_in("M6", alone=True), thread_in("M6")
    ('M6 x 1-6H', 'M6', '')
    """
    words = " ".join(text.split())
    if alone and _ALONE.fullmatch(words):
        return words
    found = {match[0] for match in _WITHIN.finditer(words)}
    return found.pop() if len(found) == 1 else ""
