"""Thread mills: combs of thread teeth of one pitch, and single teeth that cut a range of pitches.

A tooth has the profile of the groove that it cuts: 60 degrees, and a flat of an eighth of the pitch at its tip (ISO 68-1). A single tooth
that cuts a range has the flat of the finest of them; a coarser groove it cuts deeper, until its flanks stand where they belong.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from trunnion import tolerance
from trunnion.model.tool.lead import THREAD_HEIGHT, fundamental_triangle

if TYPE_CHECKING:
    from trunnion.model.tool.rotating import Tool

THREAD_MILL = "thread-mill"
"""The form of tools that mill a thread along helices."""
TIP_FLAT = 1.0 / 8.0
"""Flat at a groove's bottom over the pitch (ISO 68-1)."""
FLANK_ANGLE = math.radians(30.0)
"""Angle between a thread's flanks and the plane across its axis, radians (ISO 68-1)."""


def is_comb(tool: Tool) -> bool:
    """Return whether a thread mill has teeth of one pitch, and not a single tooth for a range."""
    return tool.pitch > 0.0


def pitches(tool: Tool) -> tuple[float, float]:
    """Return the finest and the coarsest pitch in mm that a thread mill cuts."""
    return (tool.pitch, tool.pitch) if is_comb(tool) else (tool.pitch_low, tool.pitch_high)


def cuts_pitch(tool: Tool, pitch: float) -> bool:
    """Return whether a thread mill cuts grooves of a pitch (mm)."""
    low, high = pitches(tool)
    return low - tolerance.COINCIDENT <= pitch <= high + tolerance.COINCIDENT


def extra_depth(tool: Tool, pitch: float) -> float:
    """Return by how much deeper than the basic profile, mm, a tooth goes for a pitch: its flat is narrower than the groove's by
    (P - P_low) / 8, and its flanks come to their place that much farther out, times sqrt(3) / 2."""
    return 0.5 * TIP_FLAT * (pitch - pitches(tool)[0]) / math.tan(FLANK_ANGLE)


def groove_depth(tool: Tool, pitch: float) -> float:
    """Return how deep in mm a thread mill goes into a bore of the basic minor diameter: 5/8 H, and its extra depth."""
    return THREAD_HEIGHT * fundamental_triangle(pitch) + extra_depth(tool, pitch)


def mill_core(tool: Tool) -> float:
    """Return the diameter in mm inside of a thread mill's teeth, which are as high as the coarsest groove is deep."""
    return tool.diameter - 2.0 * groove_depth(tool, pitches(tool)[1])


def teeth_along(tool: Tool) -> int:
    """Return how many teeth a thread mill has one above the other."""
    if not is_comb(tool):
        return 1
    return math.floor(tool.flute_length / tool.pitch + tolerance.PARAMETRIC)


def lowest_tooth(tool: Tool) -> float:
    """Return the height in mm of the middle of a thread mill's lowest tooth above its tip."""
    return 0.5 * (tool.pitch if is_comb(tool) else tool.flute_length)


def root_width(tool: Tool) -> float:
    """Return how wide in mm the tooth is where it meets the core: its flat, and both flanks over its height."""
    low, high = pitches(tool)
    return TIP_FLAT * low + 2.0 * groove_depth(tool, high) * math.tan(FLANK_ANGLE)


def wrong_thread_mill(tool: Tool) -> str:
    """Return what the numbers of a thread mill lack, or nothing."""
    if tool.corner_radius != 0.0 or tool.fit or tool.lead != 0.0:
        return "a thread mill has no corner radius, no lead and no fit"
    ranged = tool.pitch_low != 0.0 or tool.pitch_high != 0.0
    if is_comb(tool) == ranged or (ranged and not 0.0 < tool.pitch_low <= tool.pitch_high):
        return (
            "a thread mill needs a pitch above 0, or for a single tooth pitch_low and pitch_high, "
            "the finest and the coarsest that it cuts"
        )
    if mill_core(tool) <= 0.0:
        return "a thread mill's diameter is too small for the height of its teeth"
    least = tool.pitch if is_comb(tool) else root_width(tool)
    if tool.flute_length < least - tolerance.PARAMETRIC:
        return f"a thread mill's flute length must be at least that of a tooth, {least:.3f} mm"
    if tool.neck_length > tool.flute_length and tool.neck_diameter > mill_core(tool):
        return (
            f"behind its teeth a thread mill is no thicker than its core, {mill_core(tool):.3f} mm"
        )
    return ""
