"""The diameters that a STEP file gives as data: size, deviations, fit and thread, and the faces or edges that have them.

Entities and their meaning: ISO 10303-47 (dimensional_size, plus_minus_tolerance, tolerance_value, limits_and_fits,
shape_dimension_representation), ISO 10303-41, -43 and -45 (aspects, properties, measures), and the CAx-IF recommended practices for the
representation of PMI in AP242, in use in files of AP203 and AP214 too.

They are read from the file's text and not by the CAD kernel (`STEPCAFControl_Reader` with GD&T): its Python binding can't return a class of
tolerance (`GetClassOfTolerance` has nothing but output arguments), it passes over limits without a nominal size and over the texts that
name threads, and damaged PMI would be met inside the kernel. Nothing is guessed: what a file doesn't say stays empty.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import pairwise

from trunnion.geometry.dimension import DIAMETER, Dimension
from trunnion.part.read.step_aspects import ASPECT_TYPES, ShapeAspects
from trunnion.part.read.step_measures import MEASURE_TYPES, StepMeasure, length_of, rounded
from trunnion.part.read.step_text import (
    BadEntity,
    EntityNumber,
    StepEntity,
    StepText,
    numbers_in,
)
from trunnion.part.read.thread_text import thread_in

MARK = b"DIMENSIONAL_SIZE"
"""What stands in the text of every file that gives sizes as data."""
_SIZES = ("DIMENSIONAL_SIZE", "DIMENSIONAL_SIZE_WITH_DATUM_FEATURE", "DIMENSIONAL_SIZE_WITH_PATH")
_COMPOUNDS = ("COMPOUND_REPRESENTATION_ITEM", "VALUE_RANGE")
_ANNOTATED = (
    "DRAUGHTING_MODEL_ITEM_ASSOCIATION",
    "DRAUGHTING_MODEL_ITEM_ASSOCIATION_WITH_PLACEHOLDER",
)
_TYPES = (
    *_SIZES,
    *_COMPOUNDS,
    *_ANNOTATED,
    *MEASURE_TYPES,
    *ASPECT_TYPES,
    "DIMENSIONAL_CHARACTERISTIC_REPRESENTATION",
    "SHAPE_DIMENSION_REPRESENTATION",
    "DESCRIPTIVE_REPRESENTATION_ITEM",
    "PLUS_MINUS_TOLERANCE",
    "TOLERANCE_VALUE",
    "LIMITS_AND_FITS",
    "CHARACTERIZED_ITEM_WITHIN_REPRESENTATION",
    "PROPERTY_DEFINITION_REPRESENTATION",
    "REPRESENTATION",
)
_ITEMS = ("ADVANCED_FACE", "FACE_SURFACE", "EDGE_CURVE")
"""Entities that can have a diameter."""
_LIMITS = {
    "upper limit": "upper",
    "upper bound": "upper",
    "maximum": "upper",
    "lower limit": "lower",
    "lower bound": "lower",
    "minimum": "lower",
}
"""Names and qualifiers of sizes that are limits: of AP242, of AP214's value ranges and value limits."""
_FIT = re.compile(
    r"(CD|EF|FG|JS|Z[ABC]|[A-HJKMNPR-VXYZ])\s*(?:IT)?\s*(01|0|1[0-8]|[1-9])", re.IGNORECASE
)
"""The letters of the fundamental deviations and the standard tolerance grades of ISO 286-1:2010."""
_DATA = b"ENDSEC"
"""What ends the header."""
_WRONG_GRADES = b"Open CASCADE STEP processor"
"""The writer that gives a grade by its place in a list, two too high: H7 as 'H', '9' (`STEPCAFControl_GDTProperty::GetLimitsAndFits`, up to
version 7.9 at least)."""
_ANNOTATION_WORDS = "equivalent unicode string"
"""The name of the words that an annotation shows (CAx-IF, PMI Unicode String Specification)."""
_PART = r"\x"
"""What parts the words of annotations that are shown together."""
_KIND = re.compile(r"^(DIM|TXT)\\[a-z]")
"""What words begin with: those of a dimension, of a note; other kinds are of tolerances and datums."""
_OTHER_KIND = re.compile(r"^[A-Z]{3}\\[a-z]")
_CONTROL = re.compile(r"\\[a-z]|/n")
"""Ends of lines, raised figures and the like within words."""


class BadDimension(Exception):
    """A dimension of which the file doesn't say enough; the message says what is missing."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FileDimension:
    """A dimension that has no faces yet, the number of its entity, and those of the faces and edges that have the size."""

    number: int
    dimension: Dimension
    items: tuple[int, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class FileDimensions:
    """The dimensions in a file, in its order, and in words what can't be used.

    `positions` says of faces and edges, by the numbers of their entities, where they stand among the `count` entities of the file, from 1.
    """

    dimensions: tuple[FileDimension, ...]
    problems: tuple[str, ...]
    positions: Mapping[int, int]
    count: int


def dimensions_in(data: bytes) -> FileDimensions:
    """Return the diameters that a STEP text gives as data; what can't be used is said in words and raises nothing."""
    text = StepText(data, _TYPES, _ITEMS)
    header = data[: data.find(_DATA)]
    found, problems = _DimensionReader(text, _WRONG_GRADES in header).read()
    return FileDimensions(
        dimensions=tuple(found),
        problems=tuple(problems),
        positions=text.positions,
        count=text.count,
    )


class _DimensionReader:
    """Reads dimensions by what refers to them: representations, tolerances, annotations."""

    def __init__(self, text: StepText, wrong_grades: bool) -> None:
        self._text, self._wrong_grades = text, wrong_grades
        self._aspects = ShapeAspects(text)
        self._values = text.links(0, 1, "DIMENSIONAL_CHARACTERISTIC_REPRESENTATION")
        self._tolerances = text.links(1, None, "PLUS_MINUS_TOLERANCE")
        self._annotations = text.links(2, 4, *_ANNOTATED)
        self._characterized = text.links(2, None, "CHARACTERIZED_ITEM_WITHIN_REPRESENTATION")
        self._properties = text.links(2, None, "PROPERTY_DEFINITION")
        self._represented = text.links(0, 1, "PROPERTY_DEFINITION_REPRESENTATION")
        self._problems: list[str] = []

    def read(self) -> tuple[list[FileDimension], list[str]]:
        """Return all diameters, and the problems met."""
        found = []
        for entity in self._text.of_types(*_SIZES):
            aspect, name = _applied(entity)
            if name.strip().lower() != DIAMETER:
                continue
            try:
                found.append(self._dimension(entity.number, aspect))
            except (BadDimension, BadEntity) as reason:
                self._problems.append(f"#{entity.number} is left out, {reason}")
        known = " ".join(self._problems)
        damage = [words for words in self._text.damage.values() if words not in known]
        return found, [*self._problems, *damage]

    def _dimension(self, number: int, aspect: int) -> FileDimension:
        items = self._aspects.items(aspect)
        if not items:
            raise BadDimension("it names no face")
        measures, words = self._represented_values(number)
        sized = _sized(measures)
        words += self._aspects.words(aspect)
        own, notes = self._annotation_words(number)
        dimension = replace(
            self._toleranced(number, sized),
            text=next(w for w in (*own, self._aspects.name(aspect), *notes, DIAMETER) if w),
            thread=self._thread(number, words, own + notes),
        )
        return FileDimension(number=number, dimension=dimension, items=items)

    def _represented_values(self, number: int) -> tuple[list[StepMeasure], list[str]]:
        """Return the lengths and the texts that represent a dimension."""
        measures: list[StepMeasure] = []
        words: list[str] = []
        waiting = [
            item
            for representation in self._values.get(number, [])
            for item in self._text.items(representation, "SHAPE_DIMENSION_REPRESENTATION")
        ]
        met = set()
        while waiting:
            item = waiting.pop(0)
            # Other items place the dimension in a picture.
            if item in met or item not in self._text:
                continue
            met.add(item)
            entity = self._text.entity(item)
            described = entity.parameters("DESCRIPTIVE_REPRESENTATION_ITEM")
            compound = entity.parameters(*_COMPOUNDS)
            if described is not None:
                words += [w for w in described if isinstance(w, str)]
            elif compound is not None:
                waiting += numbers_in(compound)
            elif (measure := length_of(self._text, item)) is not None:
                measures.append(measure)
        return measures, words

    def _toleranced(self, number: int, dimension: Dimension) -> Dimension:
        """Return a dimension with the deviations and the fit that its tolerances give; a damaged tolerance is a problem of its own."""
        for tolerance in self._tolerances.get(number, []):
            parameters = self._text.entity(tolerance).parameters("PLUS_MINUS_TOLERANCE") or ()
            try:
                named = numbers_in(parameters[:1])
                if not named:
                    raise BadDimension(f"#{tolerance} names no deviations and no fit")
                limits = self._text.entity(named[0])
                fit = limits.parameters("LIMITS_AND_FITS")
                if fit is not None:
                    dimension = replace(dimension, fit=self._fit(limits.number, fit))
                else:
                    dimension = self._between(limits, dimension)
            except (BadDimension, BadEntity) as reason:
                self._problems.append(f"#{number} has no tolerance, {reason}")
        return dimension

    def _fit(self, number: int, parameters: tuple[object, ...]) -> str:
        if self._wrong_grades:
            raise BadDimension(f"#{number} is of a writer that writes grades of fits wrong")
        return fit_of(number, parameters)

    def _between(self, limits: StepEntity, dimension: Dimension) -> Dimension:
        """Return a dimension with the two deviations of a tolerance value, the lower first."""
        parameters = limits.parameters("TOLERANCE_VALUE")
        if parameters is None:
            raise BadDimension(f"#{limits.number} is neither deviations nor a fit")
        bounds = []
        for parameter in (*parameters, None, None)[:2]:
            number = next(iter(numbers_in(parameter)), None)
            length = None if number is None else length_of(self._text, number)
            if length is None:
                raise BadDimension(f"#{limits.number} has a deviation without a value")
            bounds.append(length.value)
        lower, upper = bounds
        if lower >= upper:
            raise BadDimension(
                f"the lower deviation of #{limits.number}, {lower:g} mm, is not below the upper, {upper:g} mm"
            )
        return replace(dimension, lower=lower, upper=upper)

    def _annotation_words(self, number: int) -> tuple[list[str], list[str]]:
        """Return the words that a dimension and its annotations show, where the file gives them; those of dimensions before notes."""
        annotations = self._annotations.get(number, [])
        definitions = [*(c for a in annotations for c in self._characterized.get(a, [])), number]
        found: dict[bool, list[str]] = {True: [], False: []}
        for definition in definitions:
            for item in self._property_items(definition):
                if item not in self._text:
                    continue
                words = self._text.entity(item).parameters("DESCRIPTIVE_REPRESENTATION_ITEM")
                if words and words[0] == _ANNOTATION_WORDS and isinstance(words[-1], str):
                    for part in words[-1].split(_PART):
                        if not _OTHER_KIND.match(part) or _KIND.match(part):
                            plain = " ".join(_CONTROL.sub(" ", _KIND.sub("", part)).split())
                            found[part.startswith("DIM")] += [plain] if plain else []
        return found[True], found[False]

    def _property_items(self, definition: int) -> list[int]:
        return [
            item
            for of_definition in self._properties.get(definition, [])
            for representation in self._represented.get(of_definition, [])
            for item in self._text.items(representation, "REPRESENTATION")
        ]

    def _thread(self, number: int, words: list[str], shown: list[str]) -> str:
        """Return the one thread that the texts of a dimension name, in the first form met."""
        found = [t for w in words if (t := thread_in(w))]
        found += [t for w in shown if (t := thread_in(w, alone=True))]
        if len({re.sub(r"\s", "", t).lower() for t in found}) > 1:
            self._problems.append(f"#{number} names more than one thread: {', '.join(found)}")
            return ""
        return found[0] if found else ""


def _applied(entity: StepEntity) -> tuple[int, str]:
    """Return the aspect that a size applies to and the size's name: the one reference that a text follows, whatever a subtype inherits."""
    parameters = entity.parameters(*_SIZES) or ()
    for first, second in pairwise(parameters):
        if isinstance(first, EntityNumber) and isinstance(second, str):
            return first.number, second
    return 0, ""


def _sized(measures: list[StepMeasure]) -> Dimension:
    """Return the dimension of the lengths that represent it: one nominal size, limits, or both."""
    given: dict[str, float] = {}
    for measure in measures:
        kinds = [_LIMITS[w] for w in (measure.name, *measure.qualifiers) if w in _LIMITS]
        kind = kinds[0] if kinds else "nominal"
        if measure.value <= 0.0:
            raise BadDimension(f"its size is {measure.value:g} mm")
        if given.setdefault(kind, measure.value) != measure.value:
            raise BadDimension(f"it has two sizes: {given[kind]:g} mm and {measure.value:g} mm")
    if not given:
        raise BadDimension("it has no size")
    lower, upper = given.get("lower"), given.get("upper")
    if lower is not None and upper is not None and lower >= upper:
        raise BadDimension(f"its lower limit, {lower:g} mm, is not below the upper, {upper:g} mm")
    value = next(given[k] for k in ("nominal", "lower", "upper") if k in given)
    return Dimension(
        DIAMETER,
        value,
        upper=None if upper is None else rounded(upper - value),
        lower=None if lower is None else rounded(lower - value),
    )


def fit_of(number: int, parameters: tuple[object, ...]) -> str:
    """Return a tolerance class of form variance and grade (ISO 10303-47, limits_and_fits).

    Letters are capitals for a hole and small for a shaft where the zone variance says which (ISO 286-1); files that write the whole class
    as form variance (`'G6','hole','',''`) mean the same.
    """
    form, zone, grade = ([p if isinstance(p, str) else "" for p in parameters] + [""] * 3)[:3]
    found = _FIT.fullmatch(f"{form.strip()} {grade.strip()}".strip())
    if found is None:
        raise BadDimension(f"#{number} is no tolerance class of ISO 286: '{form}', '{grade}'")
    letters = {"hole": found[1].upper(), "shaft": found[1].lower()}
    return letters.get(zone.strip().lower(), found[1]) + found[2]
