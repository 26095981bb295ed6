"""Power and torque of cutting, by Kienzle."""

from __future__ import annotations

import math

import numpy as np

from trunnion.geometry.arrays import Floats
from trunnion.model.material import Material
from trunnion.units import MM_PER_METRE, SECONDS_PER_MINUTE, WATTS_PER_KILOWATT

NEWTON_METRES = SECONDS_PER_MINUTE * WATTS_PER_KILOWATT / (2.0 * math.pi)
"""Torque in Nm of one kW at one turn a minute."""

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


def specific_force(material: Material, chip: Floats) -> Floats:
    """Return k_c (n,) in N/mm2 at mean chip thicknesses (n,) mm; below `LEAST_CHIP` a cutter rubs, and the formula isn't held there."""
    return np.asarray(material.force * np.maximum(chip, LEAST_CHIP) ** -material.force_exponent)
