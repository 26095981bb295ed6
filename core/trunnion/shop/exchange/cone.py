"""Cutters whose edges are one cone below a cylinder: countersinks, chamfer mills and engraving points, kept as outlines."""

from __future__ import annotations

import math

from trunnion import tolerance
from trunnion.model.tool import Tool
from trunnion.shop.exchange.description import ToolDescription
from trunnion.shop.exchange.scaling import without_noise

Outline = tuple[tuple[float, float, float], ...]


def cone_height(tip_diameter: float, diameter: float, angle: float) -> float:
    """Return how high in mm a cone of an angle over both sides (degrees) rises from its tip to its diameter (mm)."""
    return (diameter - tip_diameter) / 2 / math.tan(math.radians(angle / 2))


def cone_outline(
    tip_diameter: float, diameter: float, angle: float, flute_length: float
) -> Outline:
    """Return the outline (r, z, bulge) of a cone with a cylinder above it up to the flute length; raise `ValueError` for no such cone."""
    if not (0.0 <= tip_diameter < diameter and 0.0 < angle < 180.0):
        raise ValueError("the tip must be thinner than the diameter, the angle between 0 and 180")
    height = cone_height(tip_diameter, diameter, angle)
    if flute_length < height - tolerance.COINCIDENT:
        raise ValueError(f"its edges end at {flute_length:g} mm, below its cone's {height:g} mm")
    cone = ((tip_diameter / 2, 0.0, 0.0), (diameter / 2, height, 0.0))
    if flute_length - height <= tolerance.COINCIDENT:
        return (cone[0], (diameter / 2, flute_length, 0.0))
    return (*cone, (diameter / 2, flute_length, 0.0))


def give_cone(description: ToolDescription, tip_diameter: float, angle: float) -> None:
    """Give a described tool the outline of a cone of an angle over both sides (degrees) and what it is for, or say why it is none."""
    values = description.values
    values["form"], values["use"] = "form", ("countersink",)
    diameter = float(values.get("diameter", 0.0))
    if not (0.0 <= tip_diameter < diameter and 0.0 < angle < 180.0):
        description.refusal = "it gives no cone: a tip below its diameter, and an angle of 0 to 180"
        return
    height = without_noise(cone_height(tip_diameter, diameter, angle))
    if float(values.get("flute_length", 0.0)) < height - tolerance.COINCIDENT:
        description.assume("flute_length", height, "its edges reach up to where its cone ends")
    values["outline"] = cone_outline(tip_diameter, diameter, angle, float(values["flute_length"]))


def cone_of(tool: Tool) -> tuple[float, float] | None:
    """Return the diameter of a form cutter's tip (mm) and the angle over both sides (degrees) where its outline is a cone, else None."""
    rows = tool.outline
    if tool.form != "form" or len(rows) not in (2, 3) or any(row[2] for row in rows):
        return None
    (low, _, _), (high, height, _) = rows[:2]
    rim = abs(high - tool.radius) <= tolerance.COINCIDENT
    land = len(rows) == 2 or abs(rows[2][0] - high) <= tolerance.COINCIDENT
    if not (rim and land and low < high and height > 0.0):
        return None
    return 2 * low, 2 * math.degrees(math.atan2(high - low, height))
