"""Screw threads of holes, as they are tapped: size, pitch and the limits of the bore that they are cut into."""

from __future__ import annotations

from dataclasses import dataclass

from trunnion.model.tool.lead import basic_minor_diameter


@dataclass(frozen=True, slots=True)
class ScrewThread:
    """An internal screw thread, right-hand: `name` as a drawing has it ("M6", "M6x0.75", "1/4-20 UNC"), nominal `diameter` and `pitch` in
    mm, and the limits `core_low` and `core_high` in mm of its minor diameter (class 6H of ISO 965-1, or 2B of ASME B1.1): the bore to
    drill."""

    name: str
    diameter: float
    pitch: float
    core_low: float
    core_high: float

    @property
    def depth(self) -> float:
        """Radial depth in mm of the thread in its bore, (D - D1) / 2 of the basic profile (ISO 68-1): 5/8 H."""
        return 0.5 * (self.diameter - basic_minor_diameter(self.diameter, self.pitch))
