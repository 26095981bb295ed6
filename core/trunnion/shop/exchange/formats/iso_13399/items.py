"""The items of a Part 21 file and their values by code, found along the references between entities."""

from __future__ import annotations

from dataclasses import dataclass, field

from trunnion.findings import BadInput
from trunnion.part.read.step_text import BadEntity, EntityNumber, StepEntity, StepText, numbers_in
from trunnion.shop.cutters import KINDS
from trunnion.shop.exchange.files import MOST_TOOLS

ASSOCIATION = "PROPERTY_VALUE_ASSOCIATION"
_VALUES = ("NUMERICAL_VALUE", "STRING_VALUE")
TYPES = (
    *("ITEM", "ITEM_VERSION", "ITEM_DEFINITION", "UNIT", "STRING_WITH_LANGUAGE"),
    *("MULTI_LANGUAGE_STRING", ASSOCIATION, "PROPERTY_VALUE_REPRESENTATION", *_VALUES),
    *("GENERAL_CLASSIFICATION", "CLASSIFICATION_ASSOCIATION"),
)
OWN = "Trunnion"
"""Source of the classification that says a tool's kind in files that are written here."""


@dataclass(slots=True)
class ToolItem:
    """An item with its values by code: number with unit, or text."""

    number: int
    name: str
    title: str
    kind: str = ""
    values: dict[str, tuple[float | str, str]] = field(default_factory=dict)


def items_of(step: StepText, source: str) -> list[ToolItem]:
    """Return the items of a file with their values; raise `BadInput` for damage, and where values belong to nothing."""
    items = {e.number: _item(step, e.number, _parameters(e, "ITEM")) for e in step.of_types("ITEM")}
    if not items:
        raise BadInput(f"{source}: it holds no tool (no entity ITEM)")
    if len(items) > MOST_TOOLS:
        raise BadInput(f"{source}: {len(items)} items are more than the {MOST_TOOLS} that are read")
    linked = False
    associations = step.of_types(ASSOCIATION)
    if len(associations) > _MOST_ASSOCIATIONS:
        raise BadInput(f"{source}: more than the {_MOST_ASSOCIATIONS} values that are read")
    for entity in associations:
        parameters = _parameters(entity, ASSOCIATION)
        if len(parameters) < 3:
            raise BadInput(f"{source}: #{entity.number} has too few parameters")
        for item in _reached(step, parameters[1], "ITEM"):
            for value in _reached(step, parameters[2], *_VALUES):
                _add_value(step, items[item], value, source)
                linked = True
    if not linked:
        if len(items) > 1:
            raise BadInput(f"{source}: its values belong to none of its {len(items)} items")
        only = next(iter(items.values()))
        for entity in step.of_types(*_VALUES):
            _add_value(step, only, entity.number, source)
    _classify(step, items)
    if step.damage:
        raise BadInput(f"{source}: {next(iter(step.damage.values()))}")
    return list(items.values())


def _item(step: StepText, number: int, parameters: list[object]) -> ToolItem:
    """Return an item: description, identifier and name stand in this order, the first and the last in languages."""
    title, identifier, name = (*parameters, None, None, None)[:3]
    words = _phrase(step, name) or (identifier if isinstance(identifier, str) else "")
    return ToolItem(number, words, _phrase(step, title))


def _phrase(step: StepText, parameter: object) -> str:
    """Return the text that a parameter is or names: of several languages the primary one."""
    for _ in range(_DEEPEST):
        if isinstance(parameter, str):
            return parameter
        if not isinstance(parameter, EntityNumber) or parameter.number not in step:
            return ""
        entity = _entity(step, parameter.number)
        own = entity.parameters("STRING_WITH_LANGUAGE")
        many = entity.parameters("MULTI_LANGUAGE_STRING")
        parameter = own[0] if own else many[-1] if many else None
    return ""


_DEEPEST = 6
"""References between a value and its item, or a text and its language: three in the schema."""


def _parameters(entity: StepEntity, *types: str) -> list[object]:
    """Return the parameters of an entity's record of one of some types, none where it has no such record."""
    return list(entity.parameters(*types) or ())


def _entity(step: StepText, number: int) -> StepEntity:
    try:
        return step.entity(number)
    except BadEntity as reason:
        raise BadInput(str(reason)) from None


def _reached(step: StepText, parameter: object, *types: str) -> list[int]:
    """Return the entities of some types that a parameter leads to by references, nearest first."""
    found: list[int] = []
    front, seen = _few(numbers_in(parameter)), set[int]()
    for _ in range(_DEEPEST):
        following: list[int] = []
        for number in front:
            if number in seen or number not in step:
                continue
            seen.add(number)
            entity = _entity(step, number)
            if entity.parameters(*types) is not None:
                found.append(number)
            else:
                following += [n for record in entity.records for n in numbers_in(record.parameters)]
        front = _few(following)
    return found


def _few(numbers: list[int]) -> list[int]:
    """Return numbers of entities as they are; raise `BadInput` for more than an association has."""
    if len(numbers) > _MOST_REACHED:
        raise BadInput(f"an association of the file leads to more than {_MOST_REACHED} entities")
    return numbers


_MOST_REACHED = 64
"""Entities that a value or an item names at each step: half a dozen in makers' files."""
_MOST_ASSOCIATIONS = 200_000


def _add_value(step: StepText, item: ToolItem, number: int, source: str) -> None:
    """Add a value to an item under its code; the first of several stays."""
    parameters = _parameters(_entity(step, number), *_VALUES)
    if len(parameters) < 2 or not isinstance(parameters[0], str):
        raise BadInput(f"{source}: #{number} gives no code with its value")
    value, unit = parameters[-1], ""
    if isinstance(value, EntityNumber):
        value = _phrase(step, value)
    if len(parameters) > 3 and isinstance(parameters[2], EntityNumber):
        units = _parameters(_entity(step, parameters[2].number), "UNIT")
        unit = next((u for u in units if isinstance(u, str)), "")
    if isinstance(value, (float, str)):
        item.values.setdefault(parameters[0], (value, unit))


def _classify(step: StepText, items: dict[int, ToolItem]) -> None:
    """Give items the kind that our own files say."""
    for entity in step.of_types("CLASSIFICATION_ASSOCIATION"):
        parameters = _parameters(entity, "CLASSIFICATION_ASSOCIATION")
        if len(parameters) < 2:
            continue
        for number in _reached(step, parameters[0], "GENERAL_CLASSIFICATION"):
            own = _parameters(_entity(step, number), "GENERAL_CLASSIFICATION")
            if len(own) > 2 and own[1] == OWN and own[2] in KINDS:
                for item in numbers_in(parameters[1]):
                    if item in items:
                        items[item].kind = str(own[2])
