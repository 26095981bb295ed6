"""Lengths in a STEP file in mm: measures with their unit, their name and what qualifies them (ISO 10303-41, measure_schema; -45)."""

from __future__ import annotations

import math
from dataclasses import dataclass

from trunnion.part.read.step_text import (
    BadEntity,
    EntityRecord,
    StepEntity,
    StepText,
    StepWord,
    numbers_in,
)

MEASURE_TYPES = (
    "MEASURE_WITH_UNIT",
    "LENGTH_MEASURE_WITH_UNIT",
    "MEASURE_REPRESENTATION_ITEM",
    "LENGTH_UNIT",
    "SI_UNIT",
    "CONVERSION_BASED_UNIT",
    "TYPE_QUALIFIER",
)
"""The types of entities that are read here."""
_WITH_VALUE = MEASURE_TYPES[:3]
_LENGTHS = ("LENGTH_MEASURE", "POSITIVE_LENGTH_MEASURE", "NON_NEGATIVE_LENGTH_MEASURE")
_SI_PREFIXES = {
    "EXA": 1e21,
    "PETA": 1e18,
    "TERA": 1e15,
    "GIGA": 1e12,
    "MEGA": 1e9,
    "KILO": 1e6,
    "HECTO": 1e5,
    "DECA": 1e4,
    "": 1e3,
    "DECI": 1e2,
    "CENTI": 10.0,
    "MILLI": 1.0,
    "MICRO": 1e-3,
    "NANO": 1e-6,
    "PICO": 1e-9,
    "FEMTO": 1e-12,
    "ATTO": 1e-15,
}
"""mm in a metre with a prefix (ISO 10303-41, si_prefix)."""
_CONVERSIONS = 4
"""Units that a unit may be defined by, one by another: more are a circle."""
_DECIMALS = 9
"""Decimals of a length in mm: what lies beyond is rounding of the conversion."""


@dataclass(frozen=True, slots=True)
class StepMeasure:
    """A length in mm, the name that its item has, and the words that qualify it ("maximum", "minimum")."""

    value: float
    name: str
    qualifiers: tuple[str, ...]


def rounded(length: float) -> float:
    """Return a length in mm without what converting and subtracting add to its last decimals, and zero without a sign."""
    return round(length, _DECIMALS) + 0.0


def length_of(text: StepText, number: int) -> StepMeasure | None:
    """Return the length that an entity gives, None of one that is no length; raise `BadEntity` where its value or unit is missing."""
    entity = text.entity(number)
    own = next((r for r in entity.records if r.type in _WITH_VALUE and len(r.parameters) > 1), None)
    if own is None:
        return None
    value, unit = own.parameters[-2:]
    if isinstance(value, EntityRecord):
        if value.type not in _LENGTHS:
            return None
        value = value.parameters[0] if value.parameters else None
    if not isinstance(value, float) or not math.isfinite(value):
        raise BadEntity(f"#{number} has no value")
    named = entity.parameters("REPRESENTATION_ITEM") or own.parameters[:-2]
    name = next((p for p in named if isinstance(p, str)), "")
    return StepMeasure(
        rounded(value * _named_unit(text, number, unit)),
        name.strip().lower(),
        _qualifiers(text, entity),
    )


def _named_unit(text: StepText, number: int, unit: object, depth: int = 0) -> float:
    """Return how many mm the unit is that an entity names."""
    numbers = numbers_in(unit)
    if len(numbers) != 1 or depth > _CONVERSIONS:
        raise BadEntity(f"#{number} has no unit")
    return unit_of(text, numbers[0], depth)


def unit_of(text: StepText, number: int, depth: int = 0) -> float:
    """Return how many mm a unit of length is, `depth` conversions deep; raise `BadEntity` where it is none."""
    entity = text.entity(number)
    si = entity.parameters("SI_UNIT")
    if si is not None:
        # As an entity of one type it begins with its dimensions, `*`.
        prefix, name = si[-2:] if len(si) > 1 else (None, None)
        word = prefix.word if isinstance(prefix, StepWord) else ""
        if name == StepWord("METRE") and word in _SI_PREFIXES:
            return _SI_PREFIXES[word]
    defined = entity.parameters("CONVERSION_BASED_UNIT")
    if defined:
        factor = text.entity((numbers_in(defined[-1]) or [0])[0])
        measure = factor.parameters(*_WITH_VALUE) or ()
        if len(measure) > 1:
            value = measure[-2]
            if isinstance(value, EntityRecord) and value.parameters:
                value = value.parameters[0]
            if isinstance(value, float) and 0.0 < value < math.inf:
                return value * _named_unit(text, number, measure[-1], depth + 1)
    raise BadEntity(f"#{number} is no unit of length")


def _qualifiers(text: StepText, entity: StepEntity) -> tuple[str, ...]:
    """Return the words of a qualified item's type qualifiers; others say how many digits are shown."""
    found = []
    for number in numbers_in(entity.parameters("QUALIFIED_REPRESENTATION_ITEM") or ()):
        try:
            words = text.entity(number).parameters("TYPE_QUALIFIER") or ()
        except BadEntity:
            continue
        found += [w.strip().lower() for w in words if isinstance(w, str)]
    return tuple(found)
