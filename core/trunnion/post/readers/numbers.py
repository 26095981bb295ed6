"""What numbers a text may hold. What lies beyond is a slip of the hand that no machine could run: it is refused with its line."""

from __future__ import annotations

from dataclasses import dataclass

from trunnion.findings import BadInput
from trunnion.units import FARTHEST, FASTEST, LONGEST_BLOCK, SECONDS_PER_MINUTE, trimmed

LONGEST_WORD = 32
"""Characters of a text that a message repeats: a number of a thousand digits would hide what is wrong with it."""
DECIMALS = 4
"""Decimals of a range's ends in a message."""


@dataclass(frozen=True, slots=True)
class NumberRange:
    """The numbers from `low` to `high`, both allowed, and their unit in words; `slack` is how far rounding may bring one beyond."""

    low: float
    high: float
    unit: str = ""
    slack: float = 0.0

    @property
    def limits(self) -> tuple[float, float]:
        """The least and the greatest number that `check` lets pass."""
        return self.low - self.slack, self.high + self.slack

    def check(self, line: int, word: str, value: float) -> None:
        """Raise `BadInput` unless the value that follows a word is in the range; a NaN never is."""
        low, high = self.limits
        if not low <= value <= high:
            ends = f"{trimmed(self.low, DECIMALS)} to {trimmed(self.high, DECIMALS)} {self.unit}".rstrip()
            raise BadInput(f"line {line}: {word}{value:.15g} is out of range; allowed is {ends}")


LENGTH = NumberRange(-FARTHEST, FARTHEST, "mm or inch")
FEED = NumberRange(1e-3, FASTEST, "mm or inch a minute")
"""The least is a hundredth of the smallest feed that posts write in mm."""
FEED_PER_REVOLUTION = NumberRange(1e-7, 1000.0, "mm or inch a revolution")
"""From below the last decimal that posts write to beyond the pitch of any thread."""
INVERSE_TIME = NumberRange(SECONDS_PER_MINUTE / LONGEST_BLOCK, 1e12, "1/min")
"""Blocks from the last written decimal of an angle at `FASTEST` to `LONGEST_BLOCK`."""
SPINDLE = NumberRange(0.0, FASTEST, "1/min")
DWELL = NumberRange(0.0, LONGEST_BLOCK, "s")
LINE_NUMBER = NumberRange(0.0, 99_999_999.0)
"""Eight digits, as the controls with the longest line numbers take them."""
COUNT = NumberRange(0.0, 99_999.0)
"""Numbers of tools and of their lengths: LinuxCNC's tool table takes five digits."""
MOST_TURN = 3600.0
"""Degrees that a rotary axis may turn in one block while the tool is at the work: every degree of it is looked at by the proof."""


def shown(text: str) -> str:
    """Return a text as a message repeats it: printable, and cut short.

    >>> shown("X1"), shown("9" * 40)
    ('X1', '99999999999999999999999999999...')
    """
    plain = "".join(c if c.isprintable() else "?" for c in text)
    return plain if len(plain) <= LONGEST_WORD else plain[: LONGEST_WORD - 3] + "..."
