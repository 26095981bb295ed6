"""The blank: a box around the part with an allowance on each side."""

from __future__ import annotations

import numpy as np

from trunnion.geometry.arrays import Floats
from trunnion.geometry.frame import Frame
from trunnion.model.blank import Blank
from trunnion.model.material import Material
from trunnion.settings import setting, settings


@settings("blank")
class BlankSettings:
    """How much larger than the part the blank is, and what it is made of."""

    side: float = setting(
        5.0,
        unit="mm",
        low=0.0,
        high=500.0,
        label="Side allowance",
        help="Material on each of the four sides.",
    )
    top: float = setting(
        2.0,
        unit="mm",
        low=0.0,
        high=500.0,
        label="Top allowance",
        help="Material over the part's top.",
    )
    bottom: float = setting(
        0.0,
        unit="mm",
        low=0.0,
        high=500.0,
        label="Bottom allowance",
        help="Material under the part's bottom.",
    )
    material: str = setting(
        "EN AW-7075",
        label="Material",
        catalogue="materials",
        help="Name of a material of the catalogue.",
    )


def make_blank(
    frame: Frame, low: Floats, high: Floats, material: Material, settings: BlankSettings
) -> Blank:
    """Return the box blank of a part whose box in `frame` reaches from `low` to `high` (3,) mm."""
    below = np.array([settings.side, settings.side, settings.bottom])
    above = np.array([settings.side, settings.side, settings.top])
    return Blank(
        frame=frame,
        low=np.asarray(low) - below,
        high=np.asarray(high) + above,
        material=material.name,
        density=material.density,
    )
