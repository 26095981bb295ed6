"""FreeCAD's tools: a JSON file a tool (`.fctb`), and libraries (`.fctl`) that give files their numbers.

Source: FreeCAD 1.1, `src/Mod/CAM/Path/Tool`: parameters of each shape (`shape/models`), files (`toolbit/serializers/fctb.py`,
`library/serializers/fctl.py`), older words (`toolbit/migration.py`) and names of shapes (`Tools/Shape/shape_aliases.json`).
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path, PurePosixPath
from typing import Any

from trunnion.findings import BadInput
from trunnion.model.tool import Tool
from trunnion.shop.cutters import Cutter
from trunnion.shop.exchange.assumptions import all_completed, read_tools
from trunnion.shop.exchange.contract import ExchangeContext, Loss, LossKind, ReadTools, WrittenTools
from trunnion.shop.exchange.description import ToolDescription, count, text
from trunnion.shop.exchange.files import json_in, listed, read_bytes, table
from trunnion.shop.exchange.formats.freecad.shapes import READERS, parameters_of, shape_of
from trunnion.shop.exchange.formats.quantity import length_in
from trunnion.shop.exchange.numbering import numbered
from trunnion.shop.exchange.readback import lost, not_written

TOOL, LIBRARY = ".fctb", ".fctl"
_FILE_VERSION, _LIBRARY_VERSION = 2, 1
_BITS = "Bit"
"""The folder beside that of libraries, which FreeCAD keeps the files of tools in."""
_LONGEST_STEM = 80
"""Characters of a file's name that come from its tool."""
_STICKOUT = "btl-stickout"
"""An attribute that the add-on Better Tool Library gives a tool: how far it stands out of its holder."""
_OVERALL = "the catalogue keeps what stands out of the holder, not the overall length"
_NO_SHAPE = "FreeCAD has no shape for such a tool"
_LENGTHS: Mapping[str, str] = {
    "Diameter": "diameter",
    "CuttingEdgeHeight": "flute_length",
    "CuttingEdgeLength": "flute_length",
    "BladeThickness": "flute_length",
    "CornerRadius": "corner_radius",
    "TorusRadius": "corner_radius",
    "ShankDiameter": "shank_diameter",
    "NeckDiameter": "neck_diameter",
    "NeckLength": "neck_length",
    "Pitch": "pitch",
}
"""Parameters that are a length of ours; where two are given for one field, the first is taken."""


class FreeCadFormat:
    """Tools and libraries of FreeCAD's CAM workbench."""

    name = "freecad"
    title = "FreeCAD"
    suffixes = (LIBRARY, TOOL)

    def read(self, path: Path, context: ExchangeContext) -> ReadTools:
        """Return the tool of a `.fctb` file, or the tools of a library, whose files lie beside it or in the folder `Bit` beside its own."""
        if path.suffix.lower() != LIBRARY:
            found = [_described(json_in(read_bytes(path), path), str(path))]
        else:
            found = list(_library(path))
        return read_tools(found, context)

    def write(
        self, cutters: Sequence[Cutter], path: Path, context: ExchangeContext
    ) -> WrittenTools:
        """Return a `.fctl` library with a file beside it for each tool, or the `.fctb` file of a single one."""
        held = [c for c in cutters if shape_of(c.tool) is not None]
        losses = [not_written(c, _NO_SHAPE) for c in cutters if shape_of(c.tool) is None]
        single = path.suffix.lower() != LIBRARY
        if single and len(held) != 1:
            raise BadInput(
                f"{path}: a file {TOOL} holds one tool, not {len(held)}; write a library, {LIBRARY}"
            )
        numbers, invented = ([held[0].tool.number], ()) if single else numbered(held)
        names = [path.name] if single else _file_names(held)
        files: dict[Path, bytes] = {}
        described = []
        for cutter, name, nr in zip(held, names, numbers, strict=True):
            data = _written(_bit(cutter.tool, context.unit))
            files[path.with_name(name)] = data
            description = _described(json_in(data, name), name)
            if not single:
                description.values["number"] = nr
            described.append(description)
        requested = [
            replace(c, tool=replace(c.tool, number=n)) for c, n in zip(held, numbers, strict=True)
        ]
        losses += [
            *invented,
            *map(_overall, held),
            *lost(requested, all_completed(described, context), self.title),
        ]
        if not single:
            entries = [{"nr": nr, "path": name} for nr, name in zip(numbers, names, strict=True)]
            files[path] = _written({"tools": entries, "version": _LIBRARY_VERSION})
        return WrittenTools(files=files, losses=tuple(losses))


def _overall(cutter: Cutter) -> Loss:
    return Loss(
        kind=LossKind.ASSUMED,
        tool=cutter.tool.name,
        field="Length",
        value=cutter.tool.stickout,
        why="FreeCAD wants the overall length: what stands out of the holder stands there",
    )


def _written(data: dict[str, Any]) -> bytes:
    return (json.dumps(data, indent=2, ensure_ascii=False) + "\n").encode("utf-8", "replace")


def _file_names(cutters: Sequence[Cutter]) -> list[str]:
    """Return a name of a file for each tool: that of the tool in letters that every system takes, numbered where two are alike."""
    names: list[str] = []
    used: set[str] = set()
    tried: dict[str, int] = {}
    for cutter in cutters:
        stem = (
            re.sub(r"[^A-Za-z0-9.-]+", "_", cutter.tool.name).strip("._")[:_LONGEST_STEM] or "tool"
        )
        key = stem.lower()
        name = f"{stem}{TOOL}"
        while name.lower() in used:
            tried[key] = tried.get(key, 1) + 1
            name = f"{stem}-{tried[key]}{TOOL}"
        used.add(name.lower())
        names.append(name)
    return names


def _library(path: Path) -> Iterator[ToolDescription]:
    """Yield the tools of a library; a file that is missing leaves its tool out."""
    for n, entry in enumerate(listed(json_in(read_bytes(path), path), "tools", path), 1):
        source = f"{path}: tools {n}"
        nr = count(entry.get("nr", 0), source, "nr")
        named = PurePosixPath(text(entry.get("path"), source, "path").replace("\\", "/")).name
        if not named:
            raise BadInput(f"{source}: path names no file")
        file = named if named.lower().endswith(TOOL) else f"{named}{TOOL}"
        beside = (path.parent / file, path.parent.parent / _BITS / file)
        there = next((p for p in beside if p.is_file()), None)
        if there is None:
            description = ToolDescription(source=source, values={"name": file})
            description.refusal = f"its file {file} is neither beside the library nor in {_BITS}"
        else:
            description = _described(json_in(read_bytes(there), there), str(there))
        description.values["number"] = nr
        description.ignore("pocket", entry.get("pocket"), "the catalogue has no pockets")
        yield description


def _described(found: dict[str, Any], source: str) -> ToolDescription:
    """Return the tool of a file's object."""
    description = ToolDescription(source=source)
    values = description.values
    shape = _shape_named(found, source)
    name = text(found.get("name", ""), source, "name")
    if name:
        values["name"] = name
    attributes = dict(table(found, "attribute", source))
    parameters = dict(table(found, "parameter", source))
    read = READERS.get(shape)
    if read is None:
        description.refusal = (
            f"the catalogue has no kind for FreeCAD's shape {shape or 'without a name'}"
        )
        return description
    if _STICKOUT in attributes:
        values["stickout"] = length_in(attributes.pop(_STICKOUT), source, _STICKOUT)
    for word, field in _LENGTHS.items():
        if word in parameters and field not in values:
            length = length_in(parameters.pop(word), source, word)
            if length != 0.0 or field == "corner_radius":
                values[field] = length
    if "Flutes" in parameters:
        teeth = parameters.pop("Flutes")
        teeth = _counted(teeth, source)
        if teeth:
            values["teeth"] = teeth
    description.ignore("Length", _foreign_value(parameters.pop("Length", None)), _OVERALL)
    read(description, parameters)
    for word, value in (*parameters.items(), *attributes.items()):
        description.ignore(word[:80], _foreign_value(value))
    return description


def _foreign_value(value: Any) -> Any:
    """Return a foreign value, or nothing where it is an empty quantity such as `0.0 mm`."""
    if isinstance(value, str) and re.fullmatch(r"\s*[-+]?0*[.,]?0*\s*(mm|in|\"|°|deg)?\s*", value):
        return None
    return value


def _counted(value: Any, source: str) -> int:
    if isinstance(value, str) and re.fullmatch(r"\s*[0-9]{1,6}\s*", value):
        return int(value)
    return count(value, source, "Flutes")


def _shape_named(found: dict[str, Any], source: str) -> str:
    """Return a shape's name in small letters without hyphens: its type, or in older files what its file is called."""
    words = found.get("shape-type") or found.get("shape") or ""
    stem = PurePosixPath(text(words, source, "shape").replace("\\", "/")).name
    stem = re.sub(r"\.fcstd$", "", stem, flags=re.IGNORECASE)
    return re.sub(r"[-_ ]", "", stem).lower()


def _bit(tool: Tool, unit: str) -> dict[str, Any]:
    """Return the object of a tool's file."""
    shape = shape_of(tool)
    assert shape is not None
    return {
        "version": _FILE_VERSION,
        "name": tool.name,
        "shape": f"{shape[1]}.fcstd",
        "shape-type": shape[0],
        "parameter": dict(sorted(parameters_of(tool, unit).items())),
        "attribute": {},
    }
