"""Fusion's tool libraries: JSON (`.json`), or a zip archive with that as `tools.json` (`.tools`).

Sources: the tool in Autodesk's manual of the Fusion API (`Tool.createFromJson`: keys, units, holder segments from the nose up), Fusion's
dialog of tools (LB, the body length, is what stands out of the holder), and numbers of libraries where the meaning shows: a tapered mill
of a 1/16 inch ball and 11 degrees over both sides has DC 0.0568 inch, which is where its flank would meet the plane of its tip.
Which keys a type has is after libraries that Fusion wrote.
"""

from __future__ import annotations

import io
import json
import zipfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from trunnion.findings import BadInput
from trunnion.shop.cutters import Cutter
from trunnion.shop.exchange.assumptions import all_completed, read_tools
from trunnion.shop.exchange.contract import (
    UNITS,
    ExchangeContext,
    Loss,
    LossKind,
    ReadTools,
    WrittenTools,
)
from trunnion.shop.exchange.description import ToolDescription, count, text
from trunnion.shop.exchange.files import json_in, listed, member_of, read_bytes, table
from trunnion.shop.exchange.formats.fusion.entries import PROFILE_ANGLE, library_entry, type_of
from trunnion.shop.exchange.formats.fusion.geometry import READERS, EntryGeometry
from trunnion.shop.exchange.formats.fusion.holders import UNIT_SCALES, give_holder
from trunnion.shop.exchange.readback import lost, not_written

ARCHIVE, MEMBER = ".tools", "tools.json"
_VERSION = 36
"""Version of libraries that are written: that of Fusion in 2025."""
_NO_TIME = (1980, 1, 1, 0, 0, 0)
_OVERALL = "the catalogue keeps what stands out of the holder, not the overall length"
_NO_TYPE = "Fusion has no type for such a tool"


class FusionFormat:
    """Tool libraries of Autodesk Fusion."""

    name = "fusion"
    title = "Fusion"
    suffixes = (".json", ARCHIVE)

    def read(self, path: Path, context: ExchangeContext) -> ReadTools:
        """Return the tools of a library; entries that are holders alone are left out."""
        packed = path.suffix.lower() == ARCHIVE
        data = member_of(path, MEMBER) if packed else read_bytes(path)
        return read_tools(_described(data, str(path), context), context)

    def write(
        self, cutters: Sequence[Cutter], path: Path, context: ExchangeContext
    ) -> WrittenTools:
        """Return the library; tools keep their numbers, 0 where they have none."""
        held = [c for c in cutters if type_of(c) is not None]
        omitted = [not_written(c, _NO_TYPE) for c in cutters if type_of(c) is None]
        library = {"data": [library_entry(c, context) for c in held], "version": _VERSION}
        data = (json.dumps(library, indent=2, ensure_ascii=False) + "\n").encode("utf-8", "replace")
        again = all_completed(_described(data, str(path), context), context) if held else []
        losses = (*omitted, *map(_overall, held), *lost(held, again, self.title))
        packed = path.suffix.lower() == ARCHIVE
        return WrittenTools(files={path: _packed(data) if packed else data}, losses=losses)


def _overall(cutter: Cutter) -> Loss:
    return Loss(
        kind=LossKind.ASSUMED,
        tool=cutter.tool.name,
        field="OAL",
        value=cutter.tool.stickout,
        why="Fusion wants the overall length: what stands out of the holder stands there",
    )


def _packed(data: bytes) -> bytes:
    """Return a zip archive with a library, without a time of its own."""
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w") as archive:
        entry = zipfile.ZipInfo(MEMBER, date_time=_NO_TIME)
        entry.create_system, entry.external_attr = 3, 0o644 << 16
        archive.writestr(entry, data, compress_type=zipfile.ZIP_DEFLATED)
    return file.getvalue()


def _described(data: bytes, source: str, context: ExchangeContext) -> Iterator[ToolDescription]:
    for n, entry in enumerate(listed(json_in(data, source), "data", source), 1):
        yield _tool(entry, f"{source}: data {n}", context)


def _tool(entry: dict[str, Any], source: str, context: ExchangeContext) -> ToolDescription:
    """Return the tool of one entry."""
    tool = ToolDescription(source=source)
    kind = text(entry.get("type", ""), source, "type").lower()
    _give_names(tool, entry)
    read = READERS.get(kind)
    if read is None:
        words = "a holder without a tool" if kind == "holder" else f"of Fusion's type {kind[:40]}"
        tool.refusal = f"it is {words}, which the catalogue has no kind for"
        return tool
    scale = _scale(tool, entry, "unit", context.scale)
    geometry = EntryGeometry(dict(table(entry, "geometry", source)), source, scale)
    if geometry.values.pop("HAND", True) is False or kind.endswith("left hand"):
        tool.refusal = "it cuts left-handed: all tools of the catalogue turn right"
        return tool
    for word, name in _LENGTHS.items():
        length = geometry.length(word)
        if length > 0.0:
            tool.values[name] = length
    teeth = count(geometry.values.pop("NOF", 0), source, "NOF")
    if teeth:
        tool.values["teeth"] = teeth
    read(tool, geometry)
    give_holder(tool, table(entry, "holder", source), scale)
    if "holder" in tool.values and (whole := geometry.length("assemblyGaugeLength")) > 0.0:
        tool.values["gauge_length"] = whole
    geometry.values.pop("assemblyGaugeLength", None)
    tool.ignore("OAL", geometry.values.pop("OAL", None), _OVERALL)
    _ignore(tool, entry, geometry.values)
    return tool


_LENGTHS = {
    "DC": "diameter",
    "LCF": "flute_length",
    "LB": "stickout",
    "SFDM": "shank_diameter",
    "shoulder-length": "neck_length",
    "shoulder-diameter": "neck_diameter",
}
"""Keys of the geometry that are a length of ours."""


def _give_names(tool: ToolDescription, entry: dict[str, Any]) -> None:
    source = tool.source
    title = text(entry.get("description") or "", source, "description")
    name = text(entry.get("product-id") or "", source, "product-id") or title
    if name:
        tool.values["name"] = name
    if title:
        tool.values["title"] = title
    after = table(entry, "post-process", source)
    nr = count(after.get("number") or 0, source, "post-process number")
    if nr > 0:
        tool.values["number"] = nr
    for word in ("diameter-offset", "length-offset"):
        if after.get(word) != nr:
            tool.ignore(word, after.get(word), "offsets have the number of their tool here")
    for word in ("comment", "turret", "manual-tool-change", "break-control"):
        tool.ignore(word, after.get(word))


def _scale(tool: ToolDescription, entry: dict[str, Any], word: str, default: float) -> float:
    """Return the unit of an entry in mm, and where it names none the one that is expected."""
    unit = entry.get(word)
    if unit is None:
        tool.assumed["unit"] = (
            next(name for name, scale in UNITS.items() if scale == default),
            "the file names none",
        )
        return default
    if unit not in UNIT_SCALES:
        raise BadInput(
            f"{tool.source}: unit must be {' or '.join(UNIT_SCALES)}; got {str(unit)[:40]!r}"
        )
    return UNIT_SCALES[unit]


def _ignore(tool: ToolDescription, entry: dict[str, Any], geometry: dict[str, Any]) -> None:
    """Note what is not taken over."""
    if geometry.get("thread-profile-angle") in (PROFILE_ANGLE, 0):
        geometry.pop("thread-profile-angle")
    if geometry.get("NT") == 1:
        geometry.pop("NT")
    for word, value in geometry.items():
        tool.ignore(
            word[:80],
            value if isinstance(value, (str, int, float, bool)) else str(type(value).__name__),
        )
    for word in ("BMC", "GRADE", "vendor", "product-link"):
        tool.ignore(word, entry.get(word))
    presets = table(entry, "start-values", tool.source).get("presets")
    if presets:
        found = len(presets) if isinstance(presets, list) else 1
        tool.ignore("presets", found, "cutting data stand in the tables of materials")
    for word in ("shaft", "expressions"):
        if entry.get(word):
            tool.ignore(word, word, "lengths and diameters are taken as the geometry gives them")
