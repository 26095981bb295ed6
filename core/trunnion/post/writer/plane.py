"""The letters of the plane that a section's blocks lie in: XY of milling, ZX of turning."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

Text = Callable[[int], str]


@dataclass(frozen=True, slots=True, kw_only=True)
class PlaneWords:
    """Letters of a written point's three numbers, the third "" where it is none, and of an arc's centre in the first two.

    `diameter` is 2 where the second number is written as a diameter, else 1; `radial` is which number the surface speed counts by.
    """

    letters: tuple[str, str, str]
    centres: tuple[str, str]
    diameter: int
    radial: int

    def words(self, point: list[int], text: Text) -> list[str]:
        """Return the words of a point in ticks, all that there are."""
        numbers = (point[0], self.diameter * point[1], point[2])
        return [
            letter + text(number)
            for letter, number in zip(self.letters, numbers, strict=True)
            if letter
        ]


MILLING = PlaneWords(letters=("X", "Y", "Z"), centres=("I", "J"), diameter=1, radial=0)
TURNING = PlaneWords(letters=("Z", "X", ""), centres=("K", "I"), diameter=2, radial=1)
