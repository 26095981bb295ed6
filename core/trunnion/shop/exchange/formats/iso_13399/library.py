"""Cutting tools after ISO 13399 in a Part 21 file (`.p21`): items with properties, each by the code of the standard's dictionary.

Sources: codes and their meaning are those that makers publish after ISO/TS 13399-2 to -4 (Sandvik Coromant and Dormer Pramet, "Cutting tool
parameters according to ISO 13399"). The dictionary itself is not free: its class and property identifiers (PLIB) are neither read nor
written. A value carries its code in plain text, `NUMERICAL_VALUE('DC', $, #unit, '6.35')`, as tool makers' files have it; entities and
the order of their parameters are those of the schema CUTTING_TOOL_SCHEMA_ARM as such files show it.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from trunnion.findings import BadInput
from trunnion.model.tool import REAMER, TAP, THREAD_MILL
from trunnion.part.read.step_text import EntityNumber, StepText
from trunnion.shop.cutters import END_MILL, ISO_GROUPS, Cutter
from trunnion.shop.exchange.assumptions import all_completed, read_tools
from trunnion.shop.exchange.cone import cone_of, give_cone
from trunnion.shop.exchange.contract import ExchangeContext, ReadTools, WrittenTools
from trunnion.shop.exchange.description import ToolDescription, text
from trunnion.shop.exchange.fields import kind_of
from trunnion.shop.exchange.files import MOST_BRACKETS, read_bytes, text_in
from trunnion.shop.exchange.formats.iso_13399.items import (
    ASSOCIATION,
    OWN,
    TYPES,
    ToolItem,
    items_of,
)
from trunnion.shop.exchange.formats.iso_13399.properties import (
    ANGLES,
    CENTRE,
    EDGE_ANGLE,
    FIT,
    GROUPS,
    HAND,
    LENGTHS,
    TEETH,
    UNIT_WORDS,
    ItemProperties,
    properties_of,
)
from trunnion.shop.exchange.formats.part_21 import EntityFile
from trunnion.shop.exchange.readback import lost, not_written

_END = "END-ISO-10303-21"


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


def _described(data: bytes, source: str, context: ExchangeContext) -> Iterator[ToolDescription]:
    words = text_in(data, source)
    if not words.lstrip().startswith("ISO-10303-21"):
        raise BadInput(f"{source}: not a Part 21 file: it doesn't begin with ISO-10303-21")
    if _END not in words[-4096:]:
        raise BadInput(f"{source}: the file is cut off: its end mark {_END} is missing")
    if words.count("(") > MOST_BRACKETS:
        raise BadInput(f"{source}: more than the {MOST_BRACKETS} lists that are read")
    for item in items_of(StepText(data, TYPES), source):
        yield _tool(item, f"{source}: #{item.number}", context)


def _tool(item: ToolItem, source: str, context: ExchangeContext) -> ToolDescription:
    """Return the tool of an item."""
    tool = ToolDescription(source=source)
    values, own = tool.values, ItemProperties(item, source, context.scale)
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


def _give_properties(tool: ToolDescription, own: ItemProperties) -> None:
    """Give a tool what is no length: teeth, fit, materials, and which way it turns."""
    values = tool.values
    for code in TEETH:
        teeth = own.number(code) if code in own.values and "teeth" not in values else None
        if teeth is not None and teeth == int(teeth) and teeth > 0:
            values["teeth"] = int(teeth)
    centre = own.word(CENTRE)
    if centre:
        values["centre_cutting"] = centre.lower() in ("1", "yes", "true")
    groups = dict.fromkeys(re.findall(r"[A-Z]", own.word(GROUPS).upper()))
    if groups and groups.keys() <= set(ISO_GROUPS):
        values["suits"] = tuple(groups)
    elif groups:
        tool.ignore(GROUPS, " ".join(groups), f"groups of materials are {' '.join(ISO_GROUPS)}")
    if own.word(HAND).upper().startswith("L"):
        tool.refusal = "it cuts left-handed: all tools of the catalogue turn right"


def _give_form(tool: ToolDescription, own: ItemProperties, item: ToolItem) -> None:
    """Give a tool its form and what only that has; what the file says of it otherwise is ignored."""
    values = tool.values
    edge = own.number(EDGE_ANGLE)
    if item.kind:
        values["form"] = item.kind
    else:
        why = "worked out of its properties and its name"
        tool.assume("form", _form_of(f"{item.name} {item.title}".lower(), own, values, edge), why)
    form = values["form"]
    fit = own.word(FIT)
    if form == REAMER and fit:
        values["fit"] = fit
    elif fit:
        tool.ignore(FIT, fit)
    if form == "taper" and edge is not None:
        values["taper_angle"] = 90.0 - edge
    elif edge not in (None, 0.0, 90.0):
        tool.ignore(EDGE_ANGLE, edge)
    if form == "form":
        give_cone(tool, values.pop("smallest", 0.0), values.pop("point_angle", 0.0))
    if form == END_MILL and "corner_radius" not in values and "ball" in item.title.lower():
        values["corner_radius"] = values.get("diameter", 0.0) / 2


def _form_of(words: str, own: ItemProperties, values: dict[str, Any], edge: float | None) -> str:
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
    file = EntityFile(name, "CUTTING_TOOL_SCHEMA_ARM", OWN)
    language = file.add("LANGUAGE", None, "eng")
    units = {word: file.add("UNIT", word) for word in (UNIT_WORDS[context.unit], "deg")}
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
            kinds[kind] = file.add("GENERAL_CLASSIFICATION", None, OWN, kind, None, "1")
        file.add("CLASSIFICATION_ASSOCIATION", kinds[kind], item, None, "classification")
        for code, value, unit in properties_of(cutter, context):
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
            file.add(ASSOCIATION, None, definition, given_value, None, None)
    return file.bytes()
