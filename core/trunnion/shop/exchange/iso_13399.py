"""Cutting tools after ISO 13399 in a Part 21 file (`.p21`): items with properties, each by the code of the standard's dictionary.

Sources: codes and their meaning are those that makers publish after ISO/TS 13399-2 to -4 (Sandvik Coromant and Dormer Pramet, "Cutting tool
parameters according to ISO 13399"). The dictionary itself is not free: its class and property identifiers (PLIB) are neither read nor
written. A value carries its code in plain text, `NUMERICAL_VALUE('DC', $, #unit, '6.35')`, as tool makers' files have it; entities and
the order of their parameters are those of the schema CUTTING_TOOL_SCHEMA_ARM as such files show it.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from trunnion.findings import BadInput
from trunnion.model.tool import BORING_BAR, REAMER, TAP, THREAD_MILL
from trunnion.part.read.step_text import BadEntity, EntityNumber, StepEntity, StepText, numbers_in
from trunnion.shop.cutters import END_MILL, ISO_GROUPS, KINDS, Cutter
from trunnion.shop.exchange.assumptions import all_completed, read_tools
from trunnion.shop.exchange.cone import cone_of, give_cone
from trunnion.shop.exchange.contract import ExchangeContext, ReadTools, WrittenTools
from trunnion.shop.exchange.description import ToolDescription, text
from trunnion.shop.exchange.fields import fields_of, kind_of
from trunnion.shop.exchange.files import MOST_TOOLS, read_bytes, text_in
from trunnion.shop.exchange.part_21 import EntityFile
from trunnion.shop.exchange.readback import lost, not_written
from trunnion.shop.exchange.scaling import scaled, unscaled
from trunnion.units import MM_PER_INCH, MM_PER_METRE

_END = "END-ISO-10303-21"
_ASSOCIATION = "PROPERTY_VALUE_ASSOCIATION"
_VALUES = ("NUMERICAL_VALUE", "STRING_VALUE")
_TYPES = (
    *("ITEM", "ITEM_VERSION", "ITEM_DEFINITION", "UNIT", "STRING_WITH_LANGUAGE"),
    *("MULTI_LANGUAGE_STRING", _ASSOCIATION, "PROPERTY_VALUE_REPRESENTATION", *_VALUES),
    *("GENERAL_CLASSIFICATION", "CLASSIFICATION_ASSOCIATION"),
)
_OWN = "Trunnion"
"""Source of the classification that says a tool's kind in files that are written here."""
_UNITS: Mapping[str, float] = {
    "mm": 1.0,
    "millimetre": 1.0,
    "m": MM_PER_METRE,
    "in": MM_PER_INCH,
    "inch": MM_PER_INCH,
}
_UNIT_WORDS = {"mm": "mm", "inch": "in"}
_NUMBER = re.compile(
    r"\s*[-+]?(?:[0-9]{1,30}[.,]?[0-9]{0,30}|[.,][0-9]{1,30})(?:[eE][-+]?[0-9]{1,3})?\s*"
)

LENGTHS: Mapping[str, tuple[str, ...]] = {
    "diameter": ("DC", "DCX"),
    "smallest": ("DCN",),
    "corner_radius": ("RE",),
    "flute_length": ("APMX", "LCF", "THLGTH", "LU"),
    "neck_diameter": ("DN",),
    "neck_length": ("LN",),
    "shank_diameter": ("DCONMS", "DMM", "DCON"),
    "stickout": ("OHX",),
    "pitch": ("TP",),
    "pitch_low": ("TPN",),
    "pitch_high": ("TPX",),
    "barrel_radius": ("PRFRAD",),
}
"""Codes that a length of ours is read from, the first that is given; the first one is written."""
ANGLES: Mapping[str, str] = {"point_angle": "SIG", "helix_angle": "FHA"}
_EDGE_ANGLE = "KAPR"
"""Angle between edge and feed plane: 90 less that of a taper's flank."""
_TEETH = ("ZEFF", "PCEDC", "ZEFP", "NOF")
_FIT, _CENTRE, _GROUPS, _HAND = "TCHA", "CCC", "TMC1ISO", "HAND"


class IsoToolFormat:
    """Items of ISO 13399. What a tool is comes from its properties, as the classes of the dictionary are not known."""

    name = "iso13399"
    title = "ISO 13399"
    suffixes = (".p21",)

    def read(self, path: Path, context: ExchangeContext) -> ReadTools:
        """Return the items of a file that have a cutting diameter."""
        return read_tools(_described(read_bytes(path), str(path), context), context)

    def write(
        self, cutters: Sequence[Cutter], path: Path, context: ExchangeContext
    ) -> WrittenTools:
        """Return a file with an item for each tool, without its holder."""
        held = [c for c in cutters if _is_held(c)]
        why = "an outline that is no cone has no properties"
        omitted = [not_written(c, why) for c in cutters if not _is_held(c)]
        data = _written(held, path.name, context)
        again = all_completed(_described(data, str(path), context), context) if held else []
        losses = (*omitted, *lost(held, again, self.title))
        return WrittenTools(files={path: data}, losses=losses)


def _is_held(cutter: Cutter) -> bool:
    return cutter.tool.form != "form" or cone_of(cutter.tool) is not None


@dataclass(slots=True)
class _Item:
    """An item with its values by code: number with unit, or text."""

    number: int
    name: str
    title: str
    kind: str = ""
    values: dict[str, tuple[float | str, str]] = field(default_factory=dict)


def _described(data: bytes, source: str, context: ExchangeContext) -> Iterator[ToolDescription]:
    words = text_in(data, source)
    if not words.lstrip().startswith("ISO-10303-21"):
        raise BadInput(f"{source}: not a Part 21 file: it doesn't begin with ISO-10303-21")
    if _END not in words[-4096:]:
        raise BadInput(f"{source}: the file is cut off: its end mark {_END} is missing")
    for item in _items(StepText(data, _TYPES), source):
        yield _tool(item, f"{source}: #{item.number}", context)


def _items(step: StepText, source: str) -> list[_Item]:
    """Return the items of a file with their values; raise `BadInput` for damage, and where values belong to nothing."""
    items = {e.number: _item(step, e.number, _parameters(e, "ITEM")) for e in step.of_types("ITEM")}
    if not items:
        raise BadInput(f"{source}: it holds no tool (no entity ITEM)")
    if len(items) > MOST_TOOLS:
        raise BadInput(f"{source}: {len(items)} items are more than the {MOST_TOOLS} that are read")
    linked = False
    for entity in step.of_types(_ASSOCIATION):
        parameters = _parameters(entity, _ASSOCIATION)
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


def _item(step: StepText, number: int, parameters: list[object]) -> _Item:
    """Return an item: description, identifier and name stand in this order, the first and the last in languages."""
    title, identifier, name = (*parameters, None, None, None)[:3]
    words = _phrase(step, name) or (identifier if isinstance(identifier, str) else "")
    return _Item(number, words, _phrase(step, title))


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
    front, seen = numbers_in(parameter), set[int]()
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
        front = following
    return found


def _add_value(step: StepText, item: _Item, number: int, source: str) -> None:
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


def _classify(step: StepText, items: dict[int, _Item]) -> None:
    """Give items the kind that our own files say."""
    for entity in step.of_types("CLASSIFICATION_ASSOCIATION"):
        parameters = _parameters(entity, "CLASSIFICATION_ASSOCIATION")
        if len(parameters) < 2:
            continue
        for number in _reached(step, parameters[0], "GENERAL_CLASSIFICATION"):
            own = _parameters(_entity(step, number), "GENERAL_CLASSIFICATION")
            if len(own) > 2 and own[1] == _OWN and own[2] in KINDS:
                for item in numbers_in(parameters[1]):
                    if item in items:
                        items[item].kind = str(own[2])


class _Properties:
    """The values of an item, which are taken out as they are read."""

    def __init__(self, item: _Item, source: str, scale: float) -> None:
        self.values, self.source, self.scale = dict(item.values), source, scale

    def number(self, code: str) -> float | None:
        """Return a number, None where there is none; raise `BadInput` for a text."""
        found = self.values.pop(code, None)
        if found is None:
            return None
        value = found[0]
        if isinstance(value, str):
            if not _NUMBER.fullmatch(value):
                raise BadInput(f"{self.source}: {code} must be a number; got {value[:40]!r}")
            value = float(value.replace(",", "."))
        if abs(value) > _LARGEST:
            raise BadInput(f"{self.source}: {code} is too large")
        return value

    def length(self, code: str) -> float | None:
        """Return a length in mm, None where there is none."""
        unit = self.values.get(code, ("", ""))[1].strip().lower()
        if unit and unit not in _UNITS:
            raise BadInput(
                f"{self.source}: {code} has the unit {unit[:12]!r}; known: {' '.join(_UNITS)}"
            )
        value = self.number(code)
        return None if value is None else scaled(value, _UNITS[unit] if unit else self.scale)

    def word(self, code: str) -> str:
        """Return a text, empty where there is none."""
        value = self.values.pop(code, ("", ""))[0]
        return text(value, self.source, code) if isinstance(value, str) else f"{value:g}"


_LARGEST = 1e9


def _tool(item: _Item, source: str, context: ExchangeContext) -> ToolDescription:
    """Return the tool of an item."""
    tool = ToolDescription(source=source)
    values, own = tool.values, _Properties(item, source, context.scale)
    for name, words in (("name", item.name), ("title", item.title)):
        if words:
            values[name] = text(words, source, name)
    for name, codes in LENGTHS.items():
        for code in codes:
            if name not in values and code in own.values:
                length = own.length(code)
                if length is not None and (length != 0.0 or name == "corner_radius"):
                    values[name] = length
    for name, code in ANGLES.items():
        angle = own.number(code)
        if angle is not None:
            values[name] = angle
    _give_properties(tool, own)
    _give_form(tool, own, item)
    for code, (value, unit) in own.values.items():
        tool.ignore(code[:80], f"{value} {unit}".strip())
    return tool


def _give_properties(tool: ToolDescription, own: _Properties) -> None:
    """Give a tool what is no length: teeth, fit, materials, and which way it turns."""
    values = tool.values
    for code in _TEETH:
        teeth = own.number(code) if code in own.values and "teeth" not in values else None
        if teeth is not None and teeth == int(teeth) and teeth > 0:
            values["teeth"] = int(teeth)
    centre = own.word(_CENTRE)
    if centre:
        values["centre_cutting"] = centre.lower() in ("1", "yes", "true")
    groups = dict.fromkeys(re.findall(r"[A-Z]", own.word(_GROUPS).upper()))
    if groups and groups.keys() <= set(ISO_GROUPS):
        values["suits"] = tuple(groups)
    elif groups:
        tool.ignore(_GROUPS, " ".join(groups), f"groups of materials are {' '.join(ISO_GROUPS)}")
    if own.word(_HAND).upper().startswith("L"):
        tool.refusal = "it cuts left-handed: all tools of the catalogue turn right"


def _give_form(tool: ToolDescription, own: _Properties, item: _Item) -> None:
    """Give a tool its form and what only that has; what the file says of it otherwise is ignored."""
    values = tool.values
    edge = own.number(_EDGE_ANGLE)
    if item.kind:
        values["form"] = item.kind
    else:
        why = "worked out of its properties and its name"
        tool.assume("form", _form_of(f"{item.name} {item.title}".lower(), own, values, edge), why)
    form = values["form"]
    fit = own.word(_FIT)
    if form == REAMER and fit:
        values["fit"] = fit
    elif fit:
        tool.ignore(_FIT, fit)
    if form == "taper" and edge is not None:
        values["taper_angle"] = 90.0 - edge
    elif edge not in (None, 0.0, 90.0):
        tool.ignore(_EDGE_ANGLE, edge)
    if form == "form":
        give_cone(tool, values.pop("smallest", 0.0), values.pop("point_angle", 0.0))
    if form == END_MILL and "corner_radius" not in values and "ball" in item.title.lower():
        values["corner_radius"] = values.get("diameter", 0.0) / 2
    for name, kinds in _ONLY.items():
        if form not in kinds and name in values:
            tool.ignore(_CODES[name], values.pop(name))


_ONLY: Mapping[str, tuple[str, ...]] = {
    "smallest": (BORING_BAR,),
    "pitch": (TAP, THREAD_MILL),
    "pitch_low": (THREAD_MILL,),
    "pitch_high": (THREAD_MILL,),
    "point_angle": ("drill",),
    "barrel_radius": ("barrel",),
    "corner_radius": (END_MILL, "taper", "barrel", "t-slot", "button"),
}
"""Fields that only some kinds have."""
_CODES = {name: codes[0] for name, codes in LENGTHS.items()} | dict(ANGLES)


def _form_of(words: str, own: _Properties, values: dict[str, Any], edge: float | None) -> str:
    """Return the kind that an item's properties and name (English, small letters) stand for."""
    if "pitch" in values or "pitch_low" in values:
        return THREAD_MILL if "mill" in words else TAP
    if re.search(r"\bream", words):
        return REAMER
    if "point_angle" in values or re.search(r"\bdrill", words):
        return "drill"
    if edge is not None and 0.0 < edge < 90.0:
        return "taper"
    return END_MILL


def _written(cutters: Sequence[Cutter], name: str, context: ExchangeContext) -> bytes:
    """Return a file with an item for each cutter."""
    file = EntityFile(name, "CUTTING_TOOL_SCHEMA_ARM", _OWN)
    language = file.add("LANGUAGE", None, "eng")
    units = {word: file.add("UNIT", word) for word in (_UNIT_WORDS[context.unit], "deg")}
    kinds: dict[str, EntityNumber] = {}
    properties: dict[str, EntityNumber] = {}
    for cutter in cutters:
        tool = cutter.tool
        title, named = (
            file.add("MULTI_LANGUAGE_STRING", (), file.add("STRING_WITH_LANGUAGE", t, language))
            for t in (tool.description, tool.name)
        )
        item = file.add("ITEM", title, tool.name, named)
        version = file.add("ITEM_VERSION", item, None, "1")
        definition = file.add("ITEM_DEFINITION", version, None, "1", None)
        file.add("SPECIFIC_ITEM_CLASSIFICATION", (item,), "tool item", None)
        kind = kind_of(tool.form)
        if kind not in kinds:
            kinds[kind] = file.add("GENERAL_CLASSIFICATION", None, _OWN, kind, None, "1")
        file.add("CLASSIFICATION_ASSOCIATION", kinds[kind], item, None, "classification")
        for code, value, unit in _properties(cutter, context):
            if code not in properties:
                library = file.add("EXTERNAL_LIBRARY_REFERENCE", None, code, "ISO 13399")
                given = (units[unit],) if unit else ()
                properties[code] = file.add("PROPERTY", given, None, code, library, None, None)
            if isinstance(value, str):
                phrase = file.add("STRING_WITH_LANGUAGE", value, language)
                many = file.add("MULTI_LANGUAGE_STRING", (), phrase)
                entity = file.add("STRING_VALUE", code, many)
            else:
                of = units[unit] if unit else None
                entity = file.add("NUMERICAL_VALUE", code, None, of, f"{value!r}")
            given_value = file.add(
                "PROPERTY_VALUE_REPRESENTATION", properties[code], None, None, entity, None
            )
            file.add(_ASSOCIATION, None, definition, given_value, None, None)
    return file.bytes()


def _properties(
    cutter: Cutter, context: ExchangeContext
) -> Iterator[tuple[str, float | int | str, str]]:
    """Yield code, value and unit of what a tool has."""
    fields = fields_of(cutter)
    tool = cutter.tool
    if tool.form == "form":
        tip, angle = cone_of(tool) or (0.0, 0.0)
        fields |= {"smallest": tip, "point_angle": angle}
    for name, codes in LENGTHS.items():
        if name in fields:
            yield codes[0], unscaled(float(fields[name]), context.scale), _UNIT_WORDS[context.unit]
    for name, code in ANGLES.items():
        if name in fields:
            yield code, float(fields[name]), "deg"
    if tool.form == "taper":
        yield _EDGE_ANGLE, 90.0 - tool.taper_angle, "deg"
    yield _TEETH[0], tool.teeth, ""
    yield _CENTRE, int(tool.centre_cutting), ""
    if tool.form == REAMER:
        yield _FIT, tool.fit, ""
    if cutter.suits:
        yield _GROUPS, " ".join(cutter.suits), ""
