"""Tools that cut with a chamfered lead and follow a bore: reamers, boring bars and taps."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from trunnion.model.tool.rotating import Tool

REAMER = "reamer"
"""The form of tools that bring a bore to its size and fit."""
BORING_BAR = "boring-bar"
"""The form of bars in fine boring heads, whose one edge is set to a diameter within a range."""
FINISHING = (REAMER, BORING_BAR)
"""Forms that bring a bore to its size along its axis, by a thin ring."""
TAP = "tap"
"""The form of tools that cut an internal thread into a bore."""
REAMER_EDGE = 45.0
"""Degrees between a reamer's lead and its axis (DIN 212, DIN 8093); a boring bar's nose is taken for such a lead."""
THREAD_HEIGHT = 5.0 / 8.0
"""Height of an internal thread over that of its fundamental triangle (ISO 68-1: H1 = 5/8 H)."""


def fundamental_triangle(pitch: float) -> float:
    """Return the height H in mm of the fundamental triangle of a 60 degree thread: H = sqrt(3) / 2 P (ISO 68-1, ASME B1.1)."""
    return 0.5 * math.sqrt(3.0) * pitch


def basic_minor_diameter(diameter: float, pitch: float) -> float:
    """Return D1 in mm of an internal thread: D1 = D - 2 (5/8) H = D - 1.0825 P (ISO 68-1, ASME B1.1)."""
    return diameter - 2.0 * THREAD_HEIGHT * fundamental_triangle(pitch)


def wrong_reamer(tool: Tool) -> str:
    """Return what the numbers of a reamer lack, or nothing."""
    if tool.corner_radius != 0.0 or tool.pitch != 0.0:
        return "a reamer has no corner radius and no pitch"
    if not 0.0 < tool.lead < tool.radius:
        return "a reamer needs a lead between 0 and its radius: its chamfer has 45 degrees"
    if not tool.fit:
        return "a reamer needs the fit that it makes, such as H7"
    if tool.flute_length <= tool.lead:
        return f"a reamer's flutes must be longer than its lead, {tool.lead:.3f} mm"
    return ""


def wrong_boring_bar(tool: Tool) -> str:
    """Return what the numbers of a boring bar lack, or nothing."""
    if tool.corner_radius != 0.0 or tool.pitch != 0.0:
        return "a boring bar has no corner radius and no pitch: its nose is its lead"
    if not 0.0 < tool.lead < tool.flute_length:
        return "a boring bar needs a lead above 0, the height of its nose, and an insert higher than that"
    if not 2.0 * tool.lead < tool.smallest <= tool.diameter:
        return "a boring bar needs the smallest diameter that it is set to, up to its largest"
    if tool.neck_diameter >= tool.smallest:
        return "a boring bar is thinner than the smallest diameter that it is set to"
    return ""


def wrong_tap(tool: Tool) -> str:
    """Return what the numbers of a tap lack, or nothing."""
    if tool.corner_radius != 0.0 or tool.fit:
        return "a tap has no corner radius and no fit"
    if tool.pitch <= 0.0 or tool.core_diameter <= 0.0:
        return "a tap needs a pitch above 0, and a core above 0 within its threads"
    if not 0.0 < tool.lead < tool.flute_length:
        return "a tap needs a lead above 0 and shorter than its thread"
    if tool.neck_length > tool.flute_length and tool.neck_diameter > tool.core_diameter:
        return f"behind its thread a tap is no thicker than the core, {tool.core_diameter:.3f} mm"
    return ""
