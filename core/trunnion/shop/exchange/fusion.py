"""Fusion's tool libraries: JSON (`.json`), or a zip archive with that as `tools.json` (`.tools`).

Sources: the tool in Autodesk's manual of the Fusion API (`Tool.createFromJson`: keys, units, holder segments from the nose up), Fusion's
dialog of tools (LB, the body length, is what stands out of the holder), and numbers of libraries where the meaning shows: a tapered mill
of a 1/16 inch ball and 11 degrees over both sides has DC 0.0568 inch, which is where its flank would meet the plane of its tip.
Which keys a type has is after libraries that Fusion wrote.
"""

from __future__ import annotations

import io
import json
import math
import uuid
import zipfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from trunnion import tolerance
from trunnion.findings import BadInput
from trunnion.model.tool import BORING_BAR, REAMER, T_SLOT, TAP, THREAD_MILL, Holder, Tool
from trunnion.model.tool.thread_mill import is_comb, teeth_along
from trunnion.shop.cutters import END_MILL, Cutter
from trunnion.shop.exchange.assumptions import all_completed, read_tools
from trunnion.shop.exchange.cone import cone_of, give_cone
from trunnion.shop.exchange.contract import (
    UNITS,
    ExchangeContext,
    Loss,
    LossKind,
    ReadTools,
    WrittenTools,
)
from trunnion.shop.exchange.description import ToolDescription, count, number, text
from trunnion.shop.exchange.files import json_in, listed, member_of, read_bytes, table
from trunnion.shop.exchange.readback import lost, not_written
from trunnion.shop.exchange.scaling import scaled, unscaled, without_noise

ARCHIVE, MEMBER = ".tools", "tools.json"
_VERSION = 36
"""Version of libraries that are written: that of Fusion in 2025."""
_UNITS = {"millimeters": UNITS["mm"], "inches": UNITS["inch"]}
_NAMES = {"mm": "millimeters", "inch": "inches"}
_NO_TIME = (1980, 1, 1, 0, 0, 0)
_OVERALL = "the catalogue keeps what stands out of the holder, not the overall length"
_NO_TYPE = "Fusion has no type for such a tool"
_PROFILE_ANGLE = 60.0
"""Degrees between a thread's flanks (ISO 68-1)."""


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
        held = [c for c in cutters if _type_of(c) is not None]
        omitted = [not_written(c, _NO_TYPE) for c in cutters if _type_of(c) is None]
        library = {"data": [_entry(c, context) for c in held], "version": _VERSION}
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
    read = _READERS.get(kind)
    if read is None:
        words = "a holder without a tool" if kind == "holder" else f"of Fusion's type {kind[:40]}"
        tool.refusal = f"it is {words}, which the catalogue has no kind for"
        return tool
    scale = _scale(tool, entry, "unit", context.scale)
    geometry = _Geometry(dict(table(entry, "geometry", source)), source, scale)
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
    _give_holder(tool, table(entry, "holder", source), scale)
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


class _Geometry:
    """The geometry of an entry, whose keys are taken out as they are read; lengths come in mm."""

    def __init__(self, values: dict[str, Any], source: str, scale: float) -> None:
        self.values, self.source, self.scale = values, source, scale

    def length(self, word: str) -> float:
        """Return a length in mm, 0 where there is none."""
        return scaled(self.number(word), self.scale)

    def number(self, word: str) -> float:
        """Return a number, 0 where there is none."""
        value = self.values.pop(word, None)
        return 0.0 if value is None else number(value, self.source, word)


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
    if unit not in _UNITS:
        raise BadInput(f"{tool.source}: unit must be {' or '.join(_UNITS)}; got {str(unit)[:40]!r}")
    return _UNITS[unit]


def _give_holder(tool: ToolDescription, entry: dict[str, Any], scale: float) -> None:
    """Give a tool its holder, as far as the spindle's face; one without segments has no shape."""
    if not entry:
        return
    source = f"{tool.source}: holder"
    name = text(entry.get("description") or "holder", source, "description")
    own = _UNITS[entry["unit"]] if entry.get("unit") in _UNITS else scale
    gauge = scaled(number(entry.get("gaugeLength") or 0, source, "gaugeLength"), own)
    rows = _rows(listed(entry, "segments", source) if "segments" in entry else [], source, own)
    if not rows:
        tool.ignore("holder", name, "it has no segments: its shape is not known")
        return
    top = rows[-1][2]
    if 0.0 < gauge < top - tolerance.COINCIDENT:
        tool.ignore(
            "holder segments",
            f"{top:g} mm",
            f"what is above its gauge line, {gauge:g} mm, is inside the spindle",
        )
        rows = _cut(rows, gauge)
    elif gauge > top + tolerance.COINCIDENT:
        radius = rows[-1][3]
        rows.append((top, radius, gauge, radius))
        why = "its segments end below its gauge line: the last one is taken to reach up to it"
        tool.assumed["holder_rows"] = (f"({top:g}, {radius:g}, {gauge:g}, {radius:g})", why)
    tool.values["holder"] = Holder(name=name, rows=tuple(rows))


Row = tuple[float, float, float, float]


def _rows(segments: list[dict[str, Any]], source: str, scale: float) -> list[Row]:
    """Return segments, from the nose up, as rows of a holder."""
    rows: list[Row] = []
    z = 0.0
    for n, segment in enumerate(segments, 1):
        height, low, high = (
            scaled(number(segment.get(word), f"{source}: segment {n}", word), scale)
            for word in ("height", "lower-diameter", "upper-diameter")
        )
        if height > 0.0:
            top = without_noise(z + height)
            rows.append((z, low / 2, top, high / 2))
            z = top
    return rows


def _cut(rows: list[Row], height: float) -> list[Row]:
    """Return rows up to a height."""
    found = []
    for z0, r0, z1, r1 in rows:
        if z0 >= height:
            break
        if z1 > height:
            r1 = r0 + (r1 - r0) * (height - z0) / (z1 - z0)
        found.append((z0, r0, min(z1, height), r1))
    return found


def _ignore(tool: ToolDescription, entry: dict[str, Any], geometry: dict[str, Any]) -> None:
    """Note what is not taken over."""
    if geometry.get("thread-profile-angle") in (_PROFILE_ANGLE, 0):
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


def _flat(tool: ToolDescription, geometry: _Geometry) -> None:
    tool.values |= {"form": END_MILL, "corner_radius": geometry.length("RE")}
    geometry.values.pop("tip-diameter", None)
    _taper_or_none(tool, geometry)


def _ball(tool: ToolDescription, geometry: _Geometry) -> None:
    geometry.length("RE")
    tool.values |= {"form": END_MILL, "corner_radius": tool.values.get("diameter", 0.0) / 2}
    geometry.values.pop("tip-diameter", None)
    _taper_or_none(tool, geometry)


def _taper_or_none(tool: ToolDescription, geometry: _Geometry) -> None:
    if geometry.number("TA") != 0.0:
        tool.refusal = "its flank is tapered, which the catalogue has no such kind for"


def _face(tool: ToolDescription, geometry: _Geometry) -> None:
    """Read a face mill: a flat or bull end, or a taper where its edges are at an angle."""
    angle, corner = geometry.number("TA"), geometry.length("RE")
    for word in ("tip-diameter", "DCX"):
        geometry.values.pop(word, None)
    tool.values |= {"form": END_MILL, "corner_radius": corner, "use": ("face",)}
    if angle:
        tool.values |= {"form": "taper", "taper_angle": angle}


def _taper(tool: ToolDescription, geometry: _Geometry) -> None:
    """Read a tapered mill, whose DC is where the flank would meet the plane of its tip."""
    angle, corner = geometry.number("TA"), geometry.length("RE")
    geometry.values.pop("tip-diameter", None)
    if not 0.0 < angle < 90.0:
        tool.refusal = f"its taper angle must be between 0 and 90 degrees; got {angle:g}"
        return
    end = tool.values.get("diameter", 0.0) + corner_excess(corner, angle)
    tool.values |= {"form": "taper", "taper_angle": angle, "corner_radius": corner}
    tool.values["diameter"] = without_noise(end)


def corner_excess(corner: float, angle: float) -> float:
    """Return by how much the end of a taper, out to its corner, is wider in mm than its flank where that would meet the plane of the
    tip: the corner, tangent to both, touches the plane r tan((90 - a) / 2) inside of there and is r wide: 2 r (1 - tan((90 - a) / 2))."""
    return 2.0 * corner * (1.0 - math.tan(math.radians((90.0 - angle) / 2.0)))


def _slot(tool: ToolDescription, geometry: _Geometry) -> None:
    tool.values |= {"form": T_SLOT, "corner_radius": geometry.length("RE")}
    geometry.values.pop("tip-diameter", None)


def _drill(tool: ToolDescription, geometry: _Geometry) -> None:
    tool.values["form"] = "drill"
    angle = geometry.number("SIG")
    if angle:
        tool.values["point_angle"] = angle


def _spot_drill(tool: ToolDescription, geometry: _Geometry) -> None:
    _drill(tool, geometry)
    tool.values["use"] = ("spot",)


def _reamer(tool: ToolDescription, geometry: _Geometry) -> None:
    tool.values["form"] = REAMER


def _boring_bar(tool: ToolDescription, geometry: _Geometry) -> None:
    tool.values["form"] = BORING_BAR


def _tap(tool: ToolDescription, geometry: _Geometry) -> None:
    tool.values |= {"form": TAP, "pitch": geometry.length("TP")}


def _thread_mill(tool: ToolDescription, geometry: _Geometry) -> None:
    """Read a comb by its pitch, or a single tooth by the pitches that it cuts."""
    tool.values["form"] = THREAD_MILL
    pitch, low, high = (geometry.length(word) for word in ("TP", "TPN", "TPX"))
    single = count(geometry.values.pop("NT", 1), tool.source, "NT") <= 1
    for word in ("tip-diameter", "thread-tip-type"):
        geometry.values.pop(word, None)
    if single and low > 0.0 and high > 0.0:
        tool.values |= {"pitch_low": low, "pitch_high": high}
    elif pitch > 0.0:
        tool.values["pitch"] = pitch


def _countersink(tool: ToolDescription, geometry: _Geometry) -> None:
    give_cone(tool, geometry.length("tip-diameter"), geometry.number("SIG"))


def _chamfer_mill(tool: ToolDescription, geometry: _Geometry) -> None:
    """Read a chamfer mill, whose angle is to one side."""
    give_cone(tool, geometry.length("tip-diameter"), 2.0 * geometry.number("TA"))


def _oval(tool: ToolDescription, geometry: _Geometry) -> None:
    """Read an oval circle segment mill: a ball at the tip, and a flank of a large radius that is tangent to it."""
    tool.values |= {
        "form": "barrel",
        "corner_radius": geometry.length("lower-radius"),
        "barrel_radius": geometry.length("profile-radius"),
    }
    geometry.values.pop("tip-diameter", None)


_READERS: Mapping[str, Callable[[ToolDescription, _Geometry], None]] = {
    "flat end mill": _flat,
    "bull nose end mill": _flat,
    "ball end mill": _ball,
    "face mill": _face,
    "tapered mill": _taper,
    "circle segment oval": _oval,
    "slot mill": _slot,
    "drill": _drill,
    "spot drill": _spot_drill,
    "reamer": _reamer,
    "boring bar": _boring_bar,
    "tap right hand": _tap,
    "tap left hand": _tap,
    "thread mill": _thread_mill,
    "counter sink": _countersink,
    "chamfer mill": _chamfer_mill,
}
"""What each type of tool is here; other types are left out."""
_TYPES: Mapping[str, str] = {
    "flat": "flat end mill",
    "bull": "bull nose end mill",
    "ball": "ball end mill",
    "taper": "tapered mill",
    "barrel": "circle segment oval",
    T_SLOT: "slot mill",
    "drill": "drill",
    REAMER: "reamer",
    BORING_BAR: "boring bar",
    TAP: "tap right hand",
    THREAD_MILL: "thread mill",
    "form": "counter sink",
}
"""The type that Fusion has for a form."""
_AXIAL = ("drill", "spot drill", "reamer", "boring bar", "tap right hand", "counter sink")
"""Types of tools for holes: they have a point angle, and no neck of a diameter of its own."""


def _type_of(cutter: Cutter) -> str | None:
    """Return the type of a tool, None where Fusion has none: outlines must be cones."""
    form = cutter.tool.form
    if form == "form" and cone_of(cutter.tool) is None:
        return None
    if form in ("flat", "bull") and cutter.use == ("face",):
        return "face mill"
    if form == "drill" and cutter.use == ("spot",):
        return "spot drill"
    return _TYPES.get(form)


def _entry(cutter: Cutter, context: ExchangeContext) -> dict[str, Any]:
    """Return the entry of a tool."""
    tool = cutter.tool
    kind = _type_of(cutter)
    assert kind is not None
    return {
        "BMC": "unspecified",
        "description": tool.description,
        "geometry": dict(sorted(_geometry(tool, kind, context.scale).items())),
        "guid": str(uuid.uuid5(uuid.NAMESPACE_URL, f"trunnion:tool:{tool.name}")),
        "holder": _holder(tool.holder, context),
        "post-process": {
            "break-control": False,
            "comment": "",
            "diameter-offset": tool.number,
            "length-offset": tool.number,
            "live": True,
            "manual-tool-change": False,
            "number": tool.number,
            "turret": 0,
        },
        "product-id": tool.name,
        "product-link": "",
        "start-values": {"presets": []},
        "type": kind,
        "unit": _NAMES[context.unit],
        "vendor": "",
    }


def _holder(holder: Holder, context: ExchangeContext) -> dict[str, Any]:
    scale = context.scale
    return {
        "description": holder.name,
        "gaugeLength": unscaled(holder.length, scale),
        "guid": str(uuid.uuid5(uuid.NAMESPACE_URL, f"trunnion:holder:{holder.name}")),
        "product-id": "",
        "product-link": "",
        "segments": [
            {
                "height": unscaled(without_noise(z1 - z0), scale),
                "lower-diameter": unscaled(2 * r0, scale),
                "upper-diameter": unscaled(2 * r1, scale),
            }
            for z0, r0, z1, r1 in holder.rows
        ],
        "type": "holder",
        "unit": _NAMES[context.unit],
        "vendor": "",
    }


def _geometry(tool: Tool, kind: str, scale: float) -> dict[str, Any]:
    """Return the keys that a type has: dimensions with a point, as Fusion wants them, and counts without."""
    lengths = {
        "DC": tool.diameter,
        "LB": tool.stickout,
        "LCF": tool.flute_length,
        "OAL": tool.stickout,
        "RE": tool.corner_radius,
        "SFDM": tool.shank_diameter,
        "TP": tool.pitch,
        "assemblyGaugeLength": tool.gauge_length,
        "shoulder-length": tool.neck_length,
        "tip-diameter": 0.0,
        "tip-length": 0.0,
        "tip-offset": 0.0,
    }
    other: dict[str, Any] = {"CSP": False, "HAND": True, "NOF": tool.teeth, "NT": 1}
    other["thread-profile-angle"] = _PROFILE_ANGLE
    if kind in _AXIAL:
        other["SIG"] = 0.0
    else:
        other["TA"] = 0.0
        lengths["shoulder-diameter"] = tool.neck_diameter
        lengths["tip-diameter"] = tool.diameter - 2 * tool.corner_radius
    if kind == "face mill":
        lengths |= {"DCX": tool.diameter, "upper-radius": 0.0}
    elif kind == "tapered mill":
        lengths["DC"] = tool.diameter - corner_excess(tool.corner_radius, tool.taper_angle)
        other["TA"] = tool.taper_angle
    elif kind == "circle segment oval":
        lengths |= {"RE": 0.0, "axial-distance": 0.0, "upper-radius": 0.0}
        lengths |= {"lower-radius": tool.corner_radius, "profile-radius": tool.barrel_radius}
    elif kind in ("drill", "spot drill"):
        other["SIG"] = tool.point_angle
    elif kind == "counter sink":
        lengths["tip-diameter"], other["SIG"] = cone_of(tool) or (0.0, 0.0)
    elif kind == "thread mill":
        lengths |= {"TPN": tool.pitch_low, "TPX": tool.pitch_high}
        other |= {"NT": teeth_along(tool), "thread-tip-type": "point"}
        if not is_comb(tool):
            lengths["TP"] = tool.pitch_high
    return {word: float(unscaled(v, scale)) for word, v in lengths.items()} | other
