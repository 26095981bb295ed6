"""Cutters with shank and holder, as the catalogue, the plan and the proof see them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

FORMS = ("flat", "bull", "ball")


@dataclass(frozen=True, slots=True, kw_only=True)
class Holder:
    """A holder as truncated cones stacked along the axis: rows (z0, r0, z1, r1), z from the holder's nose upwards, mm."""

    name: str
    rows: tuple[tuple[float, float, float, float], ...]

    @property
    def length(self) -> float:
        """Height of the holder above its nose."""
        return max((row[2] for row in self.rows), default=0.0)

    @property
    def radius(self) -> float:
        """Largest radius of the holder."""
        return max((max(row[1], row[3]) for row in self.rows), default=0.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class Tool:
    """An end mill in its holder. Heights are from the tip (the lowest point, on the axis), mm.

    `flute_length` cuts; above it a neck of `neck_diameter` up to `neck_length` (equal to the flute's when there is none), then the shank of
    `shank_diameter` up to `stickout`, where the holder's nose is. `gauge_length` is from tip to spindle face.
    """

    number: int
    name: str
    form: str
    diameter: float
    corner_radius: float
    flute_length: float
    neck_diameter: float
    neck_length: float
    shank_diameter: float
    stickout: float
    gauge_length: float
    teeth: int
    centre_cutting: bool
    helix_angle: float
    holder: Holder
    description: str = ""

    def __post_init__(self) -> None:
        if self.form not in FORMS:
            raise ValueError(f"tool {self.name}: form {self.form} is none of {', '.join(FORMS)}")
        if not 0.0 <= self.corner_radius <= self.diameter / 2:
            raise ValueError(f"tool {self.name}: corner radius {self.corner_radius} does not fit diameter {self.diameter}")
        if not 0.0 < self.flute_length <= self.neck_length <= self.stickout <= self.gauge_length:
            raise ValueError(f"tool {self.name}: flute, neck, stickout and gauge length must grow in this order")

    @property
    def radius(self) -> float:
        """Half the diameter."""
        return self.diameter / 2

    @property
    def reach(self) -> float:
        """How deep below the surroundings the cutter may go before something thicker than it follows."""
        if self.shank_diameter <= self.diameter and self.neck_diameter <= self.diameter:
            return self.stickout
        return self.neck_length

    def profile(self) -> tuple[tuple[float, float, float, float], ...]:
        """Return what is above the flutes (neck, shank, holder) as truncated cones (z0, r0, z1, r1) from the tip."""
        rows = []
        if self.neck_length > self.flute_length:
            rows.append((self.flute_length, self.neck_diameter / 2, self.neck_length, self.neck_diameter / 2))
        if self.stickout > self.neck_length:
            rows.append((self.neck_length, self.shank_diameter / 2, self.stickout, self.shank_diameter / 2))
        rows += [(self.stickout + z0, r0, self.stickout + z1, r1) for z0, r0, z1, r1 in self.holder.rows]
        return tuple(rows)

    def radius_at(self, height: float) -> float:
        """Return the radius of the cutting part at a height above the tip."""
        if height >= self.corner_radius:
            return self.radius
        depth = self.corner_radius - max(height, 0.0)
        return self.radius - self.corner_radius + math.sqrt(max(self.corner_radius**2 - depth**2, 0.0))

    def as_dict(self) -> dict[str, Any]:
        """Return the tool as `NAME.tools.json` has it."""
        return {"number": self.number, "name": self.name, "form": self.form, "diameter": self.diameter, "corner_radius": self.corner_radius,
                "taper_deg": 0.0, "flute_length": self.flute_length, "neck_diameter": self.neck_diameter, "neck_length": self.neck_length,
                "shank_diameter": self.shank_diameter, "stickout": self.stickout, "gauge_length": self.gauge_length, "teeth": self.teeth,
                "holder": [list(row) for row in self.holder.rows], "holder_name": self.holder.name, "description": self.description}
