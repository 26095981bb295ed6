"""Limits of machine, cutter and surface as constraints: power, force, bending, feed marks, feed.

Mechanistic force by Kienzle: the mean cutting force is F = P / v, with the power of the cutting data and of the proof. While a tooth is in
contact it bears more: the force divided by the share of a turn in which any tooth is, which the helix lengthens (Y. Altintas, Manufacturing
Automation, helical end mills). The handbook's power law (Ai and Xiao 1994) stands beside it for the paper's example.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from trunnion.geometry.arrays import Floats
from trunnion.model.material import Machine, Material
from trunnion.model.operation import Engagement
from trunnion.model.spindle import surface_speed
from trunnion.model.tool import Tool
from trunnion.plan.cutting.optimization.problem import Constraint
from trunnion.plan.cutting.power import cutting_power
from trunnion.units import MM_PER_METRE, SECONDS_PER_MINUTE, WATTS_PER_KILOWATT

YOUNG = 600_000.0
"""N/mm2: Young's modulus of cemented carbide with about 10 % cobalt (usual handbook value, 580 to 620 GPa)."""
CORE = 0.8
"""Diameter of a cylinder as stiff as the fluted part, over the cutter's (L. Kops and D. T. Vo, CIRP Annals 39, 1990)."""
RADIAL = 0.4
"""Radial over tangential force (usual order of mechanistic models, 0.3 to 0.5): the resultant is sqrt(1 + 0.4^2) times the tangential."""
UM_PER_MM = 1000.0
RT_OVER_RA = 4.0
"""Peak-to-valley height over mean roughness of feed marks, nearly a parabola's 3.9 (E. Brammertz 1961; usual handbook order)."""

POWER, PEAK_POWER, TORQUE, PEAK_TORQUE = (
    "power",
    "power at most engagement",
    "torque",
    "torque at most engagement",
)
CHIP_PEAK = "chip at most engagement"
FORCE, BENDING, FEED, RA, RT = "force", "deflection", "machine feed", "Ra", "Rt"


def power_limit(
    name: str,
    machine: Machine,
    material: Material,
    tool: Tool,
    met: Engagement,
    share: float,
) -> Constraint:
    """Return the constraint that the power by Kienzle in an engagement keeps a share of what the spindle gives at its speed.

    Below the speed of the spindle's most power the same limit is one of torque: M = P / (2 pi n).
    """
    unit = _power_over_speed(material, tool, met)

    def shares(spindle: Floats) -> Floats:
        return np.asarray(spindle * unit / (share * _spindle_power(machine, spindle)))

    return Constraint(name=name, exponent=1.0 - material.force_exponent, unit_share=shares)


def _spindle_power(machine: Machine, spindle: Floats) -> Floats:
    """Return the power (n,) in kW of the spindle's curve: as `Machine.power_at`, for arrays."""
    rows = np.array(machine.power)
    found = np.interp(spindle, rows[:, 0], rows[:, 1])
    return np.asarray(np.where(spindle < rows[0, 0], rows[0, 1] * spindle / rows[0, 0], found))


def _power_over_speed(material: Material, tool: Tool, met: Engagement) -> float:
    """Return the power in kW at 1 1/min and a feed per tooth of 1 mm, times the engagement's share of the feed."""
    tooth = met.share
    return cutting_power(material, tool.diameter, tooth, met.depth, met.width, tooth * tool.teeth)


def mean_force(material: Material, tool: Tool, met: Engagement) -> float:
    """Return the tangential force F = P / v in N at a feed per tooth of 1 mm, the mean over a turn; it does not depend on the speed."""
    speed = surface_speed(1.0, tool.diameter)
    power = _power_over_speed(material, tool, met)
    return power * WATTS_PER_KILOWATT * SECONDS_PER_MINUTE / speed


def contact_share(tool: Tool, met: Engagement) -> float:
    """Return the share of a turn in which a tooth is in contact, at most 1: Z (arc + lag of the helix over the depth of cut) / 2 pi."""
    width = min(met.width, tool.diameter)
    arc = math.acos(max(1.0 - 2.0 * width / tool.diameter, -1.0))
    lag = met.depth * math.tan(math.radians(tool.helix_angle)) / tool.radius
    return min(tool.teeth * (arc + lag) / (2.0 * math.pi), 1.0)


def force_limit(material: Material, tool: Tool, met: Engagement, most: float) -> Constraint:
    """Return the constraint that the force in contact stays below `most` N."""
    unit = mean_force(material, tool, met) / contact_share(tool, met) / most
    return _even(FORCE, 1.0 - material.force_exponent, unit)


def bending_limit(material: Material, tool: Tool, met: Engagement, most: float) -> Constraint:
    """Return the constraint that the resultant force bends the cutter by `most` mm at most."""
    force = mean_force(material, tool, met) / contact_share(tool, met)
    unit = force * math.hypot(1.0, RADIAL) * compliance(tool, 0.5 * met.depth) / most
    return _even(BENDING, 1.0 - material.force_exponent, unit)


def compliance(tool: Tool, height: float) -> float:
    """Return the bending in mm/N of a cutter at a height (mm) over its tip for a force there: a stepped beam held at the holder's nose.

    Each step from a to b of moment of inertia I = pi d^4 / 64 adds ((b - h)^3 - (a - h)^3) / (3 E I): flutes, neck, shank.
    """
    steps = (
        (0.0, tool.flute_length, CORE * tool.diameter),
        (tool.flute_length, tool.neck_length, tool.neck_diameter),
        (tool.neck_length, tool.stickout, tool.shank_diameter),
    )
    total = 0.0
    for low, high, diameter in steps:
        a, b = max(low - height, 0.0), max(high - height, 0.0)
        inertia = math.pi * diameter**4 / 64.0
        total += (b**3 - a**3) / (3.0 * YOUNG * inertia)
    return total


def chip_limit(unit: float, most: float) -> Constraint:
    """Return the constraint that the thickest chip, `unit` times the feed per tooth, is at most `most` mm."""
    return _even(CHIP_PEAK, 1.0, unit / most)


def feed_limit(teeth: int, most: float) -> Constraint:
    """Return the constraint fz Z n <= `most` mm/min."""

    def shares(spindle: Floats) -> Floats:
        return np.asarray(teeth * spindle / most)

    return Constraint(name=FEED, exponent=1.0, unit_share=shares)


def rt_limit(radius: float, most: float) -> Constraint:
    """Return the constraint Rt = fz^2 / (8 r) <= `most` um at a nose or cutter radius in mm."""
    return _even(RT, 2.0, UM_PER_MM / (8.0 * radius) / most)


def ra_limit(radius: float, most: float) -> Constraint:
    """Return the constraint Ra = Rt / 4 <= `most` um."""
    return _even(RA, 2.0, UM_PER_MM / (8.0 * radius) / RT_OVER_RA / most)


def _even(name: str, exponent: float, unit: float) -> Constraint:
    """Return a constraint that does not depend on the spindle's speed."""

    def shares(spindle: Floats) -> Floats:
        return np.full(np.shape(spindle), unit)

    return Constraint(name=name, exponent=exponent, unit_share=shares)


@dataclass(frozen=True, slots=True, kw_only=True)
class PowerLaw:
    """The handbook's force of milling: K 9.81 C_F ap^x fz^y ae^u Z (pi d)^w / (d^q (60 v)^w) in N, v in `speed_unit`, mm/s or m/s.

    Names as in the handbook (Ai and Xiao 1994), lengths in mm.
    """

    correction: float
    coefficient: float
    depth_exponent: float
    feed_exponent: float
    width_exponent: float
    diameter_exponent: float
    speed_exponent: float
    depth: float
    width: float
    diameter: float
    teeth: int
    speed_unit: str = "mm/s"

    def force(self, spindle: Floats) -> Floats:
        """Return the force (n,) in N at a feed per tooth of 1 mm."""
        w = self.speed_exponent
        speed = math.pi * self.diameter * spindle / SECONDS_PER_MINUTE
        if self.speed_unit == "m/s":
            speed = speed / MM_PER_METRE
        return np.asarray(
            self._common()
            * (math.pi * self.diameter) ** w
            / (self.diameter**self.diameter_exponent * (SECONDS_PER_MINUTE * speed) ** w)
        )

    def power(self, spindle: Floats) -> Floats:
        """Return the power (n,) in kW at a feed per tooth of 1 mm as the paper prints it; F v in mm/s is 60^w times as much."""
        w, q = self.speed_exponent, self.diameter_exponent
        scale = SECONDS_PER_MINUTE * WATTS_PER_KILOWATT * MM_PER_METRE * SECONDS_PER_MINUTE**w
        return np.asarray(
            self._common() * math.pi * spindle ** (1.0 - w) * self.diameter ** (1.0 - q) / scale
        )

    def limit(self, name: str, value: Callable[[Floats], Floats], most: float) -> Constraint:
        """Return the constraint that a value at a feed per tooth of 1 mm, by spindle speed, stays below `most` in its unit."""

        def shares(spindle: Floats) -> Floats:
            return np.asarray(value(spindle) / most)

        return Constraint(name=name, exponent=self.feed_exponent, unit_share=shares)

    def _common(self) -> float:
        return (
            self.correction
            * STANDARD_GRAVITY
            * self.coefficient
            * self.depth**self.depth_exponent
            * self.width**self.width_exponent
            * self.teeth
        )


STANDARD_GRAVITY = 9.81
"""N of a kilogram-force, as the handbook rounds it."""
