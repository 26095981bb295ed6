"""The blank: a box or a round bar around the part with an allowance on each side, or what a file holds."""

from __future__ import annotations

import numpy as np

from trunnion.geometry.arrays import Floats, Ints
from trunnion.geometry.frame import Frame
from trunnion.model.blank import AXES, Blank, Box, Faceted, Revolved
from trunnion.model.material import Material
from trunnion.settings import setting, settings

KINDS = ("box", "cylinder", "file")
DECIMALS = 7
"""Decimals of a radius in mm: ten times finer than two points are told apart."""


@settings("blank")
class BlankSettings:
    """What the blank is, how much larger than the part, and what it is made of."""

    kind: str = setting(
        "box",
        choices=KINDS,
        label="Kind of blank",
        help="A box or a round bar around the part, or the solid of a file.",
    )
    side: float = setting(
        5.0,
        unit="mm",
        low=0.0,
        high=500.0,
        label="Side allowance",
        help="Material on each of the four sides; on a round bar beyond the part, and at the ends of a lying one.",
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
    axis: str = setting(
        "z",
        choices=AXES,
        label="Axis of the bar",
        help="The axis of the part's frame that a round bar lies along; z: it stands.",
    )
    diameter: float = setting(
        0.0,
        unit="mm",
        low=0.0,
        high=10000.0,
        label="Diameter of the bar",
        help="Diameter of a round bar; 0: what the part needs and the side allowance.",
    )
    file: str = setting(
        "",
        label="File of the blank",
        files=(".step", ".stp", ".iges", ".igs", ".stl"),
        help="STEP, IGES or STL file of a blank of kind file, in the part's coordinates.",
    )
    material: str = setting(
        "EN AW-7075",
        label="Material",
        catalogue="materials",
        help="Name of a material of the catalogue.",
    )


def make_blank(
    frame: Frame, low: Floats, high: Floats, material: Material, settings: BlankSettings
) -> Box:
    """Return the box blank of a part whose box in `frame` reaches from `low` to `high` (3,) mm."""
    low, high = _allowed(low, high, settings)
    return Box(frame=frame, low=low, high=high, material=material.name, density=material.density)


def make_bar(
    frame: Frame,
    low: Floats,
    high: Floats,
    points: Floats,
    material: Material,
    settings: BlankSettings,
) -> Revolved:
    """Return the round bar of a part whose box in `frame` reaches from `low` to `high` (3,) mm; points (v, 3) are its own there.

    Its axis goes through the middle of the box.
    """
    k = AXES.index(settings.axis)
    across = [(k + 1) % 3, (k + 2) % 3]
    middle = 0.5 * (np.asarray(low) + np.asarray(high))
    middle[k] = 0.0
    needed = float(np.linalg.norm((points - middle)[:, across], axis=1).max()) + settings.side
    radius = 0.5 * settings.diameter or round(needed, DECIMALS)
    first, last = _allowed(low, high, settings)
    return Revolved.cylinder(
        frame.moved(middle),
        radius,
        (float(first[k]), float(last[k])),
        material.name,
        material.density,
        settings.axis,
    )


def make_faceted(
    frame: Frame, points: Floats, triangles: Ints, material: Material, source: str
) -> Blank:
    """Return the blank inside triangles (t, 3) of points (v, 3) of the part's coordinates, in `frame`.

    Raises `ValueError` when they enclose no solid.
    """
    return Faceted(
        frame=frame,
        points=frame.to_local(points),
        triangles=triangles,
        material=material.name,
        density=material.density,
        source=source,
    )


def _allowed(low: Floats, high: Floats, settings: BlankSettings) -> tuple[Floats, Floats]:
    """Return the corners of a part's box with the allowances."""
    below = np.array([settings.side, settings.side, settings.bottom])
    above = np.array([settings.side, settings.side, settings.top])
    return np.asarray(low) - below, np.asarray(high) + above
