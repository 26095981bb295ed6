"""Milling cutters: what the numbers of each form must satisfy."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from itertools import pairwise
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from trunnion.model.tool.rotating import Tool

T_SLOT = "t-slot"
"""The form of a disc on a thinner neck, which cuts under material."""
_ROUNDING = 1e-9
"""Share of a radius by which an outline may stand out of it: its numbers were computed."""


def _end(tool: Tool) -> str:
    if tool.form == "flat" and tool.corner_radius != 0.0:
        return "a flat end has no corner radius; the form is bull"
    if tool.flute_length < tool.corner_radius:
        return f"its flutes must reach up to where the corner ends, {tool.corner_radius:.3f} mm"
    return ""


def _button(tool: Tool) -> str:
    if 2.0 * tool.corner_radius != tool.diameter:
        return "a button is round: its corner radius is half its diameter"
    return "a button is one insert: it has one tooth" if tool.teeth != 1 else _end(tool)


def _taper(tool: Tool) -> str:
    if not 0.0 < tool.taper_angle < 90.0:
        return "a taper needs a taper angle between 0 and 90 degrees"
    corner = tool.corner_radius * (1.0 - math.sin(math.radians(tool.taper_angle)))
    return "a taper's flutes must reach up to its flank" if tool.flute_length < corner else ""


def _barrel(tool: Tool) -> str:
    r, flank = tool.radius, tool.barrel_radius
    if not 0.0 < tool.corner_radius < r < flank:
        return "a barrel's tip radius, radius and barrel radius must grow in this order"
    if tool.flute_length <= tool.widest_height:
        return f"a barrel's flutes must reach above its widest circle, {tool.widest_height:.3f} mm"
    if tool.flute_length >= tool.widest_height + math.sqrt(flank**2 - (flank - r) ** 2):
        return "a barrel's flutes must end before its flank comes to the axis"
    return ""


def _t_slot(tool: Tool) -> str:
    if 2 * tool.corner_radius > tool.flute_length:
        return "a T-slot cutter must be thicker than both its corner radii"
    return ""


def _form(tool: Tool) -> str:
    rows = tool.outline
    if (
        len(rows) < 2
        or rows[0][1] != 0.0
        or rows[-1][1] != tool.flute_length
        or any(b[1] < a[1] for a, b in pairwise(rows))
    ):
        return "the outline must rise from 0 to the flute length"
    most = tool.radius * (1.0 + _ROUNDING)
    if not all(0.0 <= row[0] <= most and abs(row[2]) <= 1.0 for row in rows):
        return (
            "the outline must stay between the axis and the radius, with arcs up to half a circle"
        )
    return ""


MILLS: Mapping[str, Callable[[Tool], str]] = {
    "flat": _end,
    "bull": _end,
    "ball": _end,
    "button": _button,
    "taper": _taper,
    "barrel": _barrel,
    T_SLOT: _t_slot,
    "form": _form,
}
"""What the numbers of each form of milling cutter lack, in words, or nothing; a button, which turns, has the end of a ball."""
