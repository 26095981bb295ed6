"""Entries of Fusion's libraries written: the type of a tool, and the keys that this type has."""

from __future__ import annotations

import uuid
from collections.abc import Mapping
from typing import Any

from trunnion.model.tool import BORING_BAR, REAMER, T_SLOT, TAP, THREAD_MILL, Tool
from trunnion.model.tool.thread_mill import is_comb, teeth_along
from trunnion.shop.cutters import Cutter
from trunnion.shop.exchange.cone import cone_of
from trunnion.shop.exchange.contract import (
    ExchangeContext,
)
from trunnion.shop.exchange.formats.fusion.geometry import corner_excess
from trunnion.shop.exchange.formats.fusion.holders import UNIT_NAMES, holder_entry
from trunnion.shop.exchange.scaling import unscaled

PROFILE_ANGLE = 60.0
"""Degrees between a thread's flanks (ISO 68-1)."""
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


def type_of(cutter: Cutter) -> str | None:
    """Return the type of a tool, None where Fusion has none: outlines must be cones."""
    form = cutter.tool.form
    if form == "form" and cone_of(cutter.tool) is None:
        return None
    if form in ("flat", "bull") and cutter.use == ("face",):
        return "face mill"
    if form == "drill" and cutter.use == ("spot",):
        return "spot drill"
    return _TYPES.get(form)


def library_entry(cutter: Cutter, context: ExchangeContext) -> dict[str, Any]:
    """Return the entry of a tool."""
    tool = cutter.tool
    kind = type_of(cutter)
    assert kind is not None
    return {
        "BMC": "unspecified",
        "description": tool.description,
        "geometry": dict(sorted(_geometry(tool, kind, context.scale).items())),
        "guid": str(uuid.uuid5(uuid.NAMESPACE_URL, f"trunnion:tool:{tool.name}")),
        "holder": holder_entry(tool.holder, context),
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
        "unit": UNIT_NAMES[context.unit],
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
    other["thread-profile-angle"] = PROFILE_ANGLE
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
