"""Power and torque of cutting, by Kienzle."""

from __future__ import annotations

import math

import numpy as np

from trunnion.geometry.arrays import Floats
from trunnion.model.material import Material
from trunnion.model.tool import FINISHING, TAP, Tool
from trunnion.units import MM_PER_METRE, SECONDS_PER_MINUTE, WATTS_PER_KILOWATT

NEWTON_METRES = SECONDS_PER_MINUTE * WATTS_PER_KILOWATT / (2.0 * math.pi)
"""Torque in Nm of one kW at one turn a minute."""

DRILL = "drill"
"""The form of cutters that cut along their axis, with their whole diameter."""

AXIAL_FORMS = (DRILL, *FINISHING, TAP)
"""Forms of cutters that cut along their axis."""

THREAD_TORQUE = 8000.0
"""Of a tap's torque in Nm: it cuts a section of P^2 / 4 at half its diameter, and 1000 Nmm are one Nm."""

LEAST_CHIP = 1e-3
"""mm: the thinnest mean chip that Kienzle's formula is taken for."""


def cutting_power(
    material: Material,
    diameter: float,
    feed_per_tooth: float,
    depth: float,
    width: float,
    feed: float,
) -> float:
    """Return the power at the cutter in kW by Kienzle: k_c = k_c1.1 h^-m_c with the mean chip thickness over the arc of contact."""
    arc = math.acos(max(1.0 - 2.0 * min(width, diameter) / diameter, -1.0))
    chip = feed_per_tooth * 2.0 * (min(width, diameter) / diameter) / arc
    specific = material.force * chip**-material.force_exponent
    return (
        depth * width * feed * specific / (SECONDS_PER_MINUTE * MM_PER_METRE * WATTS_PER_KILOWATT)
    )


def tool_power(
    material: Material, tool: Tool, feed_per_tooth: float, depth: float, width: float, feed: float
) -> float:
    """Return the power at a tool in kW: of a drill by its whole diameter, of a reamer or boring bar by the ring of its depth of cut (mm),
    of a tap by its torque, of others by depth and width of cut."""
    if tool.form == DRILL:
        return drilling_power(material, tool, feed_per_tooth, feed)
    if tool.form in FINISHING:
        return reaming_power(material, tool, feed_per_tooth, depth, feed)
    if tool.form == TAP:
        return tapping_torque(material, tool) * (feed / tool.pitch) / NEWTON_METRES
    return cutting_power(material, tool.diameter, feed_per_tooth, depth, width, feed)


def drilling_power(material: Material, tool: Tool, feed_per_tooth: float, feed: float) -> float:
    """Return the power of drilling into solid material in kW, by Kienzle: P = A vf k_c with A = pi D^2 / 4.

    It is Pc = f vc D k_c / 240000 of the makers' tables (Sandvik Coromant, Drilling formulas and definitions).
    """
    specific = float(specific_force(material, np.array(drill_chip(tool, feed_per_tooth))))
    area = 0.25 * math.pi * tool.diameter**2
    return area * feed * specific / (SECONDS_PER_MINUTE * MM_PER_METRE * WATTS_PER_KILOWATT)


def reaming_power(
    material: Material, tool: Tool, feed_per_tooth: float, depth: float, feed: float
) -> float:
    """Return the power in kW of reaming a bore by `depth` mm on its radius, by Kienzle: P = A vf k_c with the ring A = pi (D - ap) ap."""
    specific = float(specific_force(material, np.array(drill_chip(tool, feed_per_tooth))))
    area = math.pi * (tool.diameter - depth) * depth
    return area * feed * specific / (SECONDS_PER_MINUTE * MM_PER_METRE * WATTS_PER_KILOWATT)


def tapping_torque(material: Material, tool: Tool) -> float:
    """Return the torque of tapping in Nm: Md = P^2 D k_c / 8000 (Lubero, calculations: torque and power ranges).

    k_c is Kienzle's at the tap's chip, h = P^2 / (2 z l) with the length l of its lead (same source): 1.1 to 2.4 times what the
    constant k_c of that source's table gives, the most for thin chips.
    """
    chip = tool.pitch**2 / (2.0 * tool.teeth * tool.lead)
    specific = float(specific_force(material, np.array(chip)))
    return tool.pitch**2 * tool.diameter * specific / THREAD_TORQUE


def drilling_thrust(material: Material, tool: Tool, feed_per_tooth: float) -> float:
    """Return the feed force of drilling in N: F = k_c / 2 (D / 2) f sin(kappa) (same source); the chisel edge comes on top."""
    chip = drill_chip(tool, feed_per_tooth)
    specific = float(specific_force(material, np.array(chip)))
    return 0.5 * specific * tool.radius * tool.teeth * chip


def drill_chip(tool: Tool, feed_per_tooth: float) -> float:
    """Return the chip thickness of a tool that cuts along its axis in mm: h = fz sin(kappa), kappa the angle of its edges to the axis, of a
    drill half its point angle."""
    return feed_per_tooth * math.sin(math.radians(tool.edge_angle))


def specific_force(material: Material, chip: Floats) -> Floats:
    """Return k_c (n,) in N/mm2 at mean chip thicknesses (n,) mm; below `LEAST_CHIP` a cutter rubs, and the formula isn't held there."""
    return np.asarray(material.force * np.maximum(chip, LEAST_CHIP) ** -material.force_exponent)
