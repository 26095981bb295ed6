"""Holders of rotating tools."""

from __future__ import annotations

from dataclasses import dataclass


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
