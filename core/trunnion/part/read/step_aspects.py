"""Aspects of a shape in a STEP file: what they are called, and the faces and edges that they are of.

An aspect is tied to its faces by a usage (`geometric_item_specific_usage`, ISO 10303-43), in files of before AP242 by a property with a
shape representation of its own; an aspect that is made of others has the faces of all of them.
"""

from __future__ import annotations

from trunnion.part.read.step_text import BadEntity, StepText

USAGES = ("GEOMETRIC_ITEM_SPECIFIC_USAGE", "ITEM_IDENTIFIED_REPRESENTATION_USAGE")
"""Entities that tie an aspect, or a size, to an item of a representation."""
_COMPOSITES = (
    "COMPOSITE_SHAPE_ASPECT",
    "COMPOSITE_GROUP_SHAPE_ASPECT",
    "COMPOSITE_UNIT_SHAPE_ASPECT",
    "CONTINUOUS_SHAPE_ASPECT",
    "ALL_AROUND_SHAPE_ASPECT",
)
"""Aspects that are made of others; those of other types are only related to each other."""
_NAMED = ("SHAPE_ASPECT", *_COMPOSITES, "DATUM_FEATURE", "INSTANCED_FEATURE")
ASPECT_TYPES = (
    *USAGES,
    *_NAMED,
    "SHAPE_ASPECT_RELATIONSHIP",
    "PROPERTY_DEFINITION",
    "SHAPE_DEFINITION_REPRESENTATION",
    "SHAPE_REPRESENTATION",
)
"""The types of entities that are read here."""


class ShapeAspects:
    """The aspects of a file."""

    def __init__(self, text: StepText) -> None:
        self._text = text
        self._usages = text.links(2, 4, *USAGES)
        self._related = text.links(2, 3, "SHAPE_ASPECT_RELATIONSHIP")
        self._properties = text.links(2, None, "PROPERTY_DEFINITION")
        self._shapes = text.links(0, 1, "SHAPE_DEFINITION_REPRESENTATION")

    def name(self, aspect: int) -> str:
        """Return what an aspect is called, else its description, else ""."""
        return next(iter(self.words(aspect)), "")

    def words(self, aspect: int) -> list[str]:
        """Return the name and the description of an aspect, where it has them."""
        try:
            parameters = self._text.entity(aspect).parameters(*_NAMED) or ()
        except BadEntity:
            return []
        found = [" ".join(p.split()) for p in parameters[:2] if isinstance(p, str)]
        return [words for words in found if words]

    def items(self, aspect: int) -> tuple[int, ...]:
        """Return the numbers of the faces, edges and other items of an aspect and of those that it is made of, each once."""
        found: dict[int, None] = {}
        met: set[int] = set()
        waiting = [aspect]
        while waiting:
            number = waiting.pop(0)
            if number in met:
                continue
            met.add(number)
            found |= dict.fromkeys(self._usages.get(number) or self._by_property(number))
            if self._is_composite(number):
                waiting += self._related.get(number, [])
        return tuple(found)

    def _by_property(self, aspect: int) -> list[int]:
        shapes = [s for p in self._properties.get(aspect, []) for s in self._shapes.get(p, [])]
        return [
            item for shape in shapes for item in self._text.items(shape, "SHAPE_REPRESENTATION")
        ]

    def _is_composite(self, aspect: int) -> bool:
        try:
            return bool(set(self._text.entity(aspect).types) & set(_COMPOSITES))
        except BadEntity:
            return False
