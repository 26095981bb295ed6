"""Numbers and units: what stands at the edges of the program (mm, degrees) and inside it (mm, radians)."""

from __future__ import annotations

import math
import re

MM_PER_INCH = 25.4
SECONDS_PER_MINUTE = 60.0
MINUTES_PER_HOUR = 60.0
WATTS_PER_KILOWATT = 1000.0
MM_PER_METRE = 1000.0
METRES_PER_FOOT = 0.3048
FARTHEST = 100_000.0
"""mm: no machine's axis goes farther from its zero; beyond, a number is a slip of the hand."""
FASTEST = 500_000.0
"""1/min, mm/min or degrees/min: no spindle and no axis is faster."""
LONGEST_BLOCK = 3600.0
"""s: no block of a milling program takes longer, nor does a dwell: a path of 4 m at 70 mm/min is done by then."""


SIZE_DECIMALS = 4
"""Sizes of features are given to a tenth of a micrometre: what is beyond is rounding of a file's numbers."""


def several(word: str) -> str:
    """Return an English word for more than one thing.

    >>> several("pocket"), several("boss")
    ('pockets', 'bosses')
    """
    return f"{word}es" if word.endswith(("s", "x", "ch", "sh")) else f"{word}s"


def rounded(value: float) -> float:
    """Return a size of a feature without the noise of a file's numbers, and without a negative zero.

    >>> rounded(19.99999999), rounded(-1e-12)
    (20.0, 0.0)
    """
    return round(float(value), SIZE_DECIMALS) + 0.0


def radians(degrees: float) -> float:
    """Return an angle in radians from one in degrees."""
    return math.radians(degrees)


def degrees(radians: float) -> float:
    """Return an angle in degrees from one in radians."""
    return math.degrees(radians)


def trimmed(value: float, decimals: int) -> str:
    """Return a number without trailing zeros and without a negative zero.

    >>> trimmed(12.5000, 4), trimmed(-0.00001, 3), trimmed(40, 3)
    ('12.5', '0', '40')
    """
    text = f"{value:.{decimals}f}"
    if "." in text:
        text = text.rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


def percent(share: float) -> str:
    """Return a share in whole per cent as a sentence has it.

    >>> percent(0.9749)
    '97 %'
    """
    return f"{100.0 * share:.0f} %"


def seconds_of(words: str) -> float:
    """Return a time in s from hours, minutes and seconds as a person writes them; raise `ValueError` for other words.

    >>> seconds_of("2 h 16 min 02 s"), seconds_of("1 h"), seconds_of("90.5")
    (8162.0, 3600.0, 90.5)
    """
    number = r"(\d+(?:\.\d+)?)"
    found = re.fullmatch(
        rf"(?:{number}\s*h)?\s*(?:{number}\s*min)?\s*(?:{number}\s*s?)?", words.strip()
    )
    if found is None or not any(found.groups()):
        raise ValueError(f"must be a time such as 2 h 16 min 02 s, or in seconds; got {words!r}")
    hours, minutes, seconds = (float(part or 0.0) for part in found.groups())
    return (hours * MINUTES_PER_HOUR + minutes) * SECONDS_PER_MINUTE + seconds


def timed(seconds: float) -> str:
    """Return a time in the words that `seconds_of` reads, to the last digit.

    >>> timed(8162.0), timed(90.5), timed(3600.0)
    ('2 h 16 min 02 s', '1 min 30.5 s', '1 h 00 min 00 s')
    """
    if not seconds.is_integer():
        minutes = int(seconds // SECONDS_PER_MINUTE)
        return f"{minutes} min {seconds - minutes * SECONDS_PER_MINUTE:.9g} s"
    minutes, rest = divmod(int(seconds), int(SECONDS_PER_MINUTE))
    hours, minutes = divmod(minutes, int(MINUTES_PER_HOUR))
    return f"{hours} h {minutes:02d} min {rest:02d} s" if hours else f"{minutes} min {rest:02d} s"
