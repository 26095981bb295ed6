"""FreeCAD's shapes of tools: what the parameters of each say in our fields, and which ones are written."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from trunnion.model.tool import REAMER, T_SLOT, TAP, THREAD_MILL, Tool
from trunnion.model.tool.thread_mill import TIP_FLAT, is_comb
from trunnion.shop.cutters import END_MILL
from trunnion.shop.exchange.cone import cone_of, give_cone
from trunnion.shop.exchange.description import ToolDescription
from trunnion.shop.exchange.formats.quantity import degrees_in, degrees_text, length_in, length_text

Parameters = dict[str, Any]


def _end_mill(tool: ToolDescription, parameters: Parameters) -> None:
    tool.values["form"] = END_MILL
    tool.values.setdefault("corner_radius", 0.0)


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
READERS: Mapping[str, Callable[[ToolDescription, Parameters], None]] = {
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


def shape_of(tool: Tool) -> tuple[str, str] | None:
    """Return type and file of a tool's shape, None where there is none: tapers have ball ends there, and outlines are cones."""
    if tool.form == "taper" and tool.corner_radius != tool.radius:
        return None
    if tool.form == "form" and cone_of(tool) is None:
        return None
    return _SHAPES.get(tool.form)


def parameters_of(tool: Tool, unit: str) -> dict[str, str]:
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
