"""Drills: a cone of a point angle below a cylinder."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from trunnion.model.tool.rotating import Tool


def point_height(diameter: float, point_angle: float) -> float:
    """Return the height in mm of a point whose angle, over both sides, is given in degrees."""
    return diameter / 2 / math.tan(math.radians(point_angle / 2))


def wrong_drill(tool: Tool) -> str:
    """Return what the numbers of a drill lack, or nothing."""
    if not 0.0 < tool.point_angle <= 180.0 or tool.corner_radius != 0.0:
        return "a drill needs a point angle up to 180 degrees and no corner radius"
    if tool.flute_length <= tool.point_length:
        return f"a drill's flutes must be longer than its point, {tool.point_length:.3f} mm"
    return ""
