"""FreeCAD's tools: a JSON file a tool (`.fctb`), and libraries (`.fctl`) that give files their numbers.

Source: FreeCAD 1.1, `src/Mod/CAM/Path/Tool`: parameters of each shape (`shape/models`), files (`toolbit/serializers/fctb.py`,
`library/serializers/fctl.py`), older words (`toolbit/migration.py`) and names of shapes (`Tools/Shape/shape_aliases.json`).
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path, PurePosixPath
from typing import Any

from trunnion.findings import BadInput
from trunnion.model.tool import REAMER, T_SLOT, TAP, THREAD_MILL, Tool
from trunnion.model.tool.thread_mill import TIP_FLAT, is_comb
from trunnion.shop.cutters import END_MILL, Cutter
from trunnion.shop.exchange.assumptions import all_completed, read_tools
from trunnion.shop.exchange.cone import cone_of, give_cone
from trunnion.shop.exchange.contract import ExchangeContext, Loss, LossKind, ReadTools, WrittenTools
from trunnion.shop.exchange.description import ToolDescription, count, text
from trunnion.shop.exchange.files import json_in, listed, read_bytes, table
from trunnion.shop.exchange.numbering import numbered
from trunnion.shop.exchange.quantity import degrees_in, degrees_text, length_in, length_text
from trunnion.shop.exchange.readback import lost, not_written

TOOL, LIBRARY = ".fctb", ".fctl"
_FILE_VERSION, _LIBRARY_VERSION = 2, 1
_BITS = "Bit"
"""The folder beside that of libraries, which FreeCAD keeps the files of tools in."""
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
        held = [c for c in cutters if _shape_of(c.tool) is not None]
        losses = [not_written(c, _NO_SHAPE) for c in cutters if _shape_of(c.tool) is None]
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
    used = set()
    for cutter in cutters:
        stem = re.sub(r"[^A-Za-z0-9.-]+", "_", cutter.tool.name).strip("._") or "tool"
        stem, tried = stem[:80], 1
        name = f"{stem}{TOOL}"
        while name.lower() in used:
            tried += 1
            name = f"{stem}-{tried}{TOOL}"
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
    read = _READERS.get(shape)
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


Parameters = dict[str, Any]


def _end_mill(tool: ToolDescription, parameters: Parameters) -> None:
    tool.values |= {"form": END_MILL, "corner_radius": 0.0}


def _ball(tool: ToolDescription, parameters: Parameters) -> None:
    tool.values["form"] = END_MILL
    if "diameter" in tool.values:
        tool.values["corner_radius"] = tool.values["diameter"] / 2


def _bull(tool: ToolDescription, parameters: Parameters) -> None:
    """Read a corner radius, in older files as the radius of the flat between the corners."""
    values = tool.values
    values["form"] = END_MILL
    flat = parameters.pop("FlatRadius", None)
    if "corner_radius" not in values and flat is not None and "diameter" in values:
        radius = length_in(flat, tool.source, "FlatRadius")
        values["corner_radius"] = values["diameter"] / 2 - radius


def _drill(tool: ToolDescription, parameters: Parameters) -> None:
    tool.values["form"] = "drill"
    if "TipAngle" in parameters:
        angle = degrees_in(parameters.pop("TipAngle"), tool.source, "TipAngle")
        tool.values["point_angle"] = angle


def _reamer(tool: ToolDescription, parameters: Parameters) -> None:
    tool.values["form"] = REAMER


def _tap(tool: ToolDescription, parameters: Parameters) -> None:
    tool.values["form"] = TAP


def _taper(tool: ToolDescription, parameters: Parameters) -> None:
    """Read a taper with a ball end; its angle is over both sides."""
    values = tool.values
    values["form"] = "taper"
    if "diameter" in values:
        values["corner_radius"] = values["diameter"] / 2
    if "TaperAngle" in parameters:
        angle = degrees_in(parameters.pop("TaperAngle"), tool.source, "TaperAngle")
        values["taper_angle"] = angle / 2


def _saw(tool: ToolDescription, parameters: Parameters) -> None:
    """Read a saw as a T-slot cutter, unless it has a cap that is lower than its blade."""
    tool.values["form"] = T_SLOT
    tool.values.setdefault("corner_radius", 0.0)
    words = ("CapDiameter", "CapHeight")
    if all(length_in(parameters.pop(w, "0 mm"), tool.source, w) > 0.0 for w in words):
        tool.refusal = "it has a cap below its blade, which no kind of the catalogue has"


def _thread_mill(tool: ToolDescription, parameters: Parameters) -> None:
    """Read a single tooth: its flat is an eighth of the finest pitch, its height that of the coarsest groove (ISO 68-1)."""
    values = tool.values
    values["form"] = THREAD_MILL
    if "Crest" in parameters and "diameter" in values and "neck_diameter" in values:
        flat = length_in(parameters["Crest"], tool.source, "Crest")
        height = (values["diameter"] - values["neck_diameter"]) / 2
        if flat > 0.0 and height > 0.0:
            parameters.pop("Crest")
            low, high = pitches_of(flat, height)
            why = "worked out of the flat and the height of its tooth"
            tool.assume("pitch_low", low, why)
            tool.assume("pitch_high", high, why)


def _cone(tool: ToolDescription, parameters: Parameters) -> None:
    """Read a countersink, chamfer mill or engraving point."""
    angle = degrees_in(parameters.pop("CuttingEdgeAngle", 0.0), tool.source, "CuttingEdgeAngle")
    give_cone(
        tool, length_in(parameters.pop("TipDiameter", "0 mm"), tool.source, "TipDiameter"), angle
    )


def pitches_of(flat: float, height: float) -> tuple[float, float]:
    """Return the finest and the coarsest pitch in mm of a tooth with a flat and a height (mm): P_low = 8 flat, and the coarsest by
    which a groove, 5/8 H deep and deeper by (P - P_low) / 16 / tan 30 for the narrow flat, is as deep as the tooth is high."""
    low = flat / TIP_FLAT
    high = (height + _EXTRA * low) / (_DEPTH + _EXTRA)
    return low, max(low, high)


_DEPTH = 5.0 / 8.0 * 0.75**0.5
"""Depth of an internal thread over its pitch: 5/8 of H = sqrt(3) / 2 P (ISO 68-1)."""
_EXTRA = TIP_FLAT / 2 * 3.0**0.5
"""How much deeper a tooth goes, over what its pitch is coarser than the one that its flat is for."""

_READERS: Mapping[str, Callable[[ToolDescription, Parameters], None]] = {
    "endmill": _end_mill,
    "ballend": _ball,
    "bullnose": _bull,
    "torus": _bull,
    "drill": _drill,
    "reamer": _reamer,
    "tap": _tap,
    "taperedballnose": _taper,
    "taperballnose": _taper,
    "conicalballnose": _taper,
    "slittingsaw": _saw,
    "threadmill": _thread_mill,
    "vbit": _cone,
    "chamfer": _cone,
}
"""What each shape is here, by its name without hyphens; other shapes are left out."""

_SHAPES: Mapping[str, tuple[str, str]] = {
    "flat": ("Endmill", "endmill"),
    "ball": ("Ballend", "ballend"),
    "bull": ("Bullnose", "bullnose"),
    "drill": ("Drill", "drill"),
    REAMER: ("Reamer", "reamer"),
    TAP: ("Tap", "tap"),
    "taper": ("TaperedBallNose", "taperedballnose"),
    T_SLOT: ("SlittingSaw", "slittingsaw"),
    THREAD_MILL: ("ThreadMill", "thread-mill"),
    "form": ("VBit", "v-bit"),
}
"""Type and file of the shape that FreeCAD has for a form."""


def _shape_of(tool: Tool) -> tuple[str, str] | None:
    """Return type and file of a tool's shape, None where there is none: tapers have ball ends there, and outlines are cones."""
    if tool.form == "taper" and tool.corner_radius != tool.radius:
        return None
    if tool.form == "form" and cone_of(tool) is None:
        return None
    return _SHAPES.get(tool.form)


def _bit(tool: Tool, unit: str) -> dict[str, Any]:
    """Return the object of a tool's file."""
    shape = _shape_of(tool)
    assert shape is not None
    return {
        "version": _FILE_VERSION,
        "name": tool.name,
        "shape": f"{shape[1]}.fcstd",
        "shape-type": shape[0],
        "parameter": dict(sorted(_parameters(tool, unit).items())),
        "attribute": {},
    }


def _parameters(tool: Tool, unit: str) -> dict[str, str]:
    """Return the parameters that the shape of a tool has."""
    lengths = {"Diameter": tool.diameter, "Length": tool.stickout}
    other = {}
    form = tool.form
    if form != "drill":
        lengths["ShankDiameter"] = tool.shank_diameter
    if form not in ("drill", TAP, T_SLOT, THREAD_MILL):
        lengths["CuttingEdgeHeight"] = tool.flute_length
    if form != REAMER:
        other["Flutes"] = str(tool.teeth)
    if form == "bull":
        lengths["CornerRadius"] = tool.corner_radius
    elif form == "drill":
        other["TipAngle"] = degrees_text(tool.point_angle)
    elif form == TAP:
        lengths |= {"CuttingEdgeLength": tool.flute_length, "Pitch": tool.pitch}
    elif form == "taper":
        other["TaperAngle"] = degrees_text(2 * tool.taper_angle)
    elif form == T_SLOT:
        lengths |= {"BladeThickness": tool.flute_length, "CapDiameter": 0.0, "CapHeight": 0.0}
    elif form == THREAD_MILL:
        lengths |= {"NeckDiameter": tool.neck_diameter, "NeckLength": tool.neck_length}
        if not is_comb(tool):
            lengths["Crest"] = TIP_FLAT * tool.pitch_low
    elif form == "form":
        tip, angle = cone_of(tool) or (0.0, 0.0)
        lengths["TipDiameter"] = tip
        other["CuttingEdgeAngle"] = degrees_text(angle)
    return {word: length_text(value, unit) for word, value in lengths.items()} | other
