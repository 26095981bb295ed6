"""Numbers with a unit in a text, as FreeCAD writes them: `6.0000 mm`, `0.375 "`, `118.00 °`."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from trunnion.findings import BadInput
from trunnion.shop.exchange.contract import UNITS
from trunnion.shop.exchange.description import number
from trunnion.shop.exchange.scaling import scaled, unscaled
from trunnion.units import MM_PER_INCH, MM_PER_METRE

_QUANTITY = re.compile(
    r"\s*([-+]?[0-9]{0,30}(?:[.,][0-9]{0,30})?(?:[eE][-+]?[0-9]{1,3})?)\s*([^\s0-9]*)\s*"
)
_LENGTHS: Mapping[str, float] = {
    "": 1.0,
    "mm": 1.0,
    "cm": MM_PER_METRE / 100.0,
    "m": MM_PER_METRE,
    "um": 1.0 / MM_PER_METRE,
    "in": MM_PER_INCH,
    '"': MM_PER_INCH,
    "'": 12.0 * MM_PER_INCH,
    "ft": 12.0 * MM_PER_INCH,
    "thou": MM_PER_INCH / 1000.0,
}
_ANGLES = ("", "°", "deg")


def length_in(value: Any, source: str, word: str) -> float:
    """Return a length in mm of a text with a unit, or of a number in mm; raise `BadInput` with the place and the parameter's word."""
    found, unit = _parts(value, source, word)
    if unit not in _LENGTHS:
        raise BadInput(f"{source}: {word} has the unit {unit[:12]!r}; known: {' '.join(_LENGTHS)}")
    return scaled(found, _LENGTHS[unit])


def degrees_in(value: Any, source: str, word: str) -> float:
    """Return an angle in degrees; raise `BadInput` with the place and the parameter's word."""
    found, unit = _parts(value, source, word)
    if unit not in _ANGLES:
        raise BadInput(f"{source}: {word} has the unit {unit[:12]!r}; it must be in degrees")
    return found


def length_text(value: float, unit: str) -> str:
    """Return a length of mm with a unit (`mm` or `inch`), exact enough to come back.

    >>> length_text(9.525, "inch"), length_text(6.0, "mm")
    ('0.375 in', '6.0 mm')
    """
    return f"{unscaled(value, UNITS[unit])!r} {'in' if unit == 'inch' else unit}"


def degrees_text(value: float) -> str:
    """Return an angle of degrees with its unit."""
    return f"{value!r} °"


def _parts(value: Any, source: str, word: str) -> tuple[float, str]:
    if not isinstance(value, str):
        return number(value, source, word), ""
    match = _QUANTITY.fullmatch(value) if len(value) <= _LONGEST else None
    try:
        if match is None:
            raise ValueError
        return number(float(match[1].replace(",", ".")), source, word), match[2]
    except ValueError:
        raise BadInput(
            f"{source}: {word} must be a number with a unit; got {value[:40]!r}"
        ) from None


_LONGEST = 100
"""Characters of a number with its unit."""
