"""Tolerance classes of holes after ISO 286-1: standard tolerances, and where they lie by the letter of the class."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path

from trunnion.findings import BadInput
from trunnion.model.hole_limits import Limits
from trunnion.shop.reading import CatalogueEntry, by_name, entries
from trunnion.units import trimmed

MM_PER_MICROMETRE = 1e-3
"""mm of one um: tables are in um as in the standard."""
_DECIMALS = 6
"""Deviations are rounded to 1e-6 mm: what is beyond comes from reckoning in binary."""
SMALLEST_SIZE = 1.0
"""mm: classes of smaller holes are not tabled in ISO 286-2 without exceptions."""
_LARGEST_SIZE, _LARGEST_DEVIATION = 3150.0, 20_000.0
"""mm and um: no size and no deviation of ISO 286-1 is larger."""
_TIGHTEST, _WIDEST = 1, 18
"""Grades of standard tolerances, IT1 to IT18."""
_LARGEST_TYPED = 5.0
"""mm: no deviation that is typed as a number is larger."""
SIDES = ("lower", "upper", "middle")
TOLERANCES, INCREMENTS = "IT", "Delta"
"""Names of the tables that are no letters of holes."""

Rows = tuple[tuple[float, float], ...]
"""Values in um of ranges of sizes: (mm that the range goes up to, um); each range begins where the one before ends."""

_CLASS = re.compile(r"([A-Za-z]{1,2})(\d{1,2})")
_NUMBER = r"[+-]?\d+(?:\.\d+)?|[+-]?\.\d+"
_TYPED = re.compile(rf"\s*({_NUMBER})\s*/\s*({_NUMBER})\s*")
_EVEN = re.compile(r"\s*(?:\+\s*/?\s*-|\u00b1)\s*(\d+(?:\.\d+)?|\.\d+)\s*")


@dataclass(frozen=True, slots=True, kw_only=True)
class FundamentalDeviation:
    """Where the tolerance of a letter lies: on which `side` (`SIDES`) its fundamental deviation is, and its values.

    `fine` holds for grades up to `delta_to`, with the increment Delta added, `coarse` for those above; where a range is missing the
    class is not in the standard. `exceptions` are (grade, mm over, mm up to, um): single values that a note of the standard gives.
    """

    side: str
    fine: Rows = ()
    coarse: Rows = ()
    delta_to: int = 0
    exceptions: tuple[tuple[float, float, float, float], ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class FitTables:
    """The tables of ISO 286-1: `tolerances` and `increments` by grade, in um, and the `deviations` of holes by letter."""

    tolerances: Mapping[int, Rows] = field(default_factory=dict)
    increments: Mapping[int, Rows] = field(default_factory=dict)
    deviations: Mapping[str, FundamentalDeviation] = field(default_factory=dict)

    def limits(self, text: str, diameter: float) -> Limits:
        """Return the limits of a hole of a nominal diameter (mm) by a class ("H7") or by deviations ("+0.021/0", "+-0.02") in mm.

        Raises `BadInput` for what is neither, for classes of shafts, and for those that the tables don't have at this diameter.
        """
        typed = _typed(text)
        if typed is not None:
            return typed
        found = _CLASS.fullmatch(text.strip())
        if found is None:
            raise BadInput(
                f"fit {text!r}: give a class of holes such as H7, or deviations in mm such as +0.021/0 or +-0.02"
            )
        letters, grade = found[1], int(found[2])
        if letters != letters.upper():
            raise BadInput(
                f"fit {text!r}: small letters are classes of shafts; a hole's class has capital ones, such as {letters.upper()}{grade}"
            )
        return self._of_class(letters, grade, diameter)

    def _of_class(self, letters: str, grade: int, diameter: float) -> Limits:
        where = f"fit {letters}{grade} at D {trimmed(diameter, 3)}"
        if letters not in self.deviations:
            raise BadInput(f"{where}: known letters of holes are {', '.join(self.deviations)}")
        if grade not in self.tolerances:
            known = ", ".join(str(g) for g in sorted(self.tolerances))
            raise BadInput(f"{where}: known grades are {known}")
        tolerance = _value(self.tolerances[grade], diameter)
        if tolerance is None or diameter < SMALLEST_SIZE:
            largest = self.tolerances[grade][-1][0]
            raise BadInput(
                f"{where}: classes are known from {SMALLEST_SIZE:g} to {largest:g} mm; give the deviations as numbers, such as +0.02/0"
            )
        deviation = self.deviations[letters]
        if deviation.side == "middle":
            return _limits(-0.5 * tolerance, 0.5 * tolerance)
        value = self._fundamental(deviation, grade, diameter)
        if value is None:
            raise BadInput(
                f"{where}: the standard has no such class at this size; give the deviations as numbers, such as +0.02/0"
            )
        if deviation.side == "lower":
            return _limits(value, value + tolerance)
        return _limits(value - tolerance, value)

    def _fundamental(
        self, deviation: FundamentalDeviation, grade: int, diameter: float
    ) -> float | None:
        """Return the fundamental deviation in um, or None where there is none."""
        for at, over, most, value in deviation.exceptions:
            if grade == at and over < diameter <= most:
                return value
        if deviation.delta_to and grade > deviation.delta_to:
            return _value(deviation.coarse, diameter)
        fine = _value(deviation.fine, diameter)
        if fine is None or not deviation.delta_to:
            return fine
        increment = _value(self.increments.get(grade, ()), diameter)
        return None if increment is None else fine + increment


def load_fits(user_folder: Path | None) -> FitTables:
    """Return the tables of fits; a user's table replaces the program's of the same name as a whole."""
    grades: dict[str, dict[int, Rows]] = {TOLERANCES: {}, INCREMENTS: {}}
    deviations: dict[str, FundamentalDeviation] = {}
    for name, entry in by_name(entries("fits", user_folder)).items():
        kind = entry.text("kind")
        entry.text("title")
        entry.text("source")
        if kind == "tolerance":
            if name not in grades:
                raise entry.wrong(f"a table of tolerances is named {' or '.join(grades)}")
            grades[name] = _grades(entry)
        elif kind == "deviation":
            deviations[name] = _deviation(entry)
        else:
            raise entry.wrong(f"kind knows tolerance, deviation; got {kind!r}")
        entry.done()
    return FitTables(
        tolerances=grades[TOLERANCES], increments=grades[INCREMENTS], deviations=deviations
    )


def _grades(entry: CatalogueEntry) -> dict[int, Rows]:
    grades = [int(g) for g in entry.numbers("grades", _TIGHTEST, _WIDEST)]
    rows = entry.rows("rows", 1 + len(grades), 0.0, _LARGEST_DEVIATION)
    return {
        grade: _in_order(entry, "rows", [(row[0], row[k]) for row in rows])
        for k, grade in enumerate(grades, 1)
    }


def _deviation(entry: CatalogueEntry) -> FundamentalDeviation:
    name = entry.name
    if not (name.isascii() and name.isalpha() and name == name.upper() and len(name) <= 2):
        raise entry.wrong("a deviation is named by the letters of its class, such as F or JS")
    side = entry.text("side")
    if side not in SIDES:
        raise entry.wrong(f"side knows {', '.join(SIDES)}; got {side!r}")
    if side == "middle":
        return FundamentalDeviation(side=side)
    fine, coarse = (_rows(entry, field) for field in ("deviations", "coarser"))
    if not fine:
        raise entry.wrong("deviations is missing")
    exceptions = (
        entry.rows("exceptions", 4, -_LARGEST_DEVIATION, _LARGEST_DEVIATION)
        if entry.has("exceptions")
        else ()
    )
    return FundamentalDeviation(
        side=side,
        fine=fine,
        coarse=coarse,
        delta_to=entry.count("delta_to", _TIGHTEST, _WIDEST) if entry.has("delta_to") else 0,
        exceptions=tuple((row[0], row[1], row[2], row[3]) for row in exceptions),
    )


def _rows(entry: CatalogueEntry, name: str) -> Rows:
    if not entry.has(name):
        return ()
    rows = entry.rows(name, 2, -_LARGEST_DEVIATION, _LARGEST_DEVIATION)
    return _in_order(entry, name, [(row[0], row[1]) for row in rows])


def _in_order(entry: CatalogueEntry, name: str, rows: list[tuple[float, float]]) -> Rows:
    if not rows[0][0] > 0.0 or any(a[0] >= b[0] for a, b in pairwise(rows)):
        raise entry.wrong(f"{name} must begin with the sizes that ranges go up to, growing")
    if rows[-1][0] > _LARGEST_SIZE:
        raise entry.wrong(f"{name}: sizes go up to {_LARGEST_SIZE:g} mm")
    return tuple(rows)


def _value(rows: Rows, diameter: float) -> float | None:
    """Return the value of the range that a diameter is in: over the end of the range before, up to and including its own."""
    return next((value for most, value in rows if diameter <= most), None)


def _limits(lower: float, upper: float) -> Limits:
    """Return limits in mm from deviations in um."""
    return Limits(
        lower=round(lower * MM_PER_MICROMETRE, _DECIMALS) + 0.0,
        upper=round(upper * MM_PER_MICROMETRE, _DECIMALS) + 0.0,
    )


def _typed(text: str) -> Limits | None:
    """Return limits that are typed as deviations in mm, upper/lower or +-half, or None where the text is no such."""
    even, pair = _EVEN.fullmatch(text), _TYPED.fullmatch(text)
    if even is not None:
        lower, upper = -float(even[1]), float(even[1])
    elif pair is not None:
        lower, upper = float(pair[2]), float(pair[1])
    else:
        return None
    if max(abs(lower), abs(upper)) > _LARGEST_TYPED:
        raise BadInput(f"fit {text!r}: deviations are mm, at most {_LARGEST_TYPED:g}")
    if lower >= upper:
        raise BadInput(
            f"fit {text!r}: the upper deviation comes first and is above the lower one, such as +0.021/0"
        )
    return Limits(lower=lower + 0.0, upper=upper + 0.0)
