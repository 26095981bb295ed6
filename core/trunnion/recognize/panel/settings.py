"""What a person may choose about the recognition of panels."""

from __future__ import annotations

from trunnion.settings import setting, settings


@settings("recognize.panel")
class PanelSettings:
    """Limits that decide what a face is; the names are those of the slicing papers."""

    beta: float = setting(
        15.0,
        unit="degrees",
        low=1.0,
        high=44.0,
        label="Largest lean of a wall",
        help="A wall that leans further from the vertical than this is a slope, not a wall (the papers' beta).",
    )
    angle: float = setting(
        0.2,
        unit="degrees",
        low=0.001,
        high=2.0,
        label="Angular tolerance",
        help="A face within this angle of horizontal or vertical is taken as horizontal or vertical.",
    )
    rib_width: float = setting(
        12.0,
        unit="mm",
        low=0.1,
        high=200.0,
        label="Widest rib",
        help="A wider top between two machined spaces is a floor, not a rib.",
    )
    slicing_depth: float = setting(
        20.0,
        unit="mm",
        low=0.5,
        high=500.0,
        label="Slicing depth",
        help="Slices stand between all horizontal faces and at most this far apart.",
    )
    hole_diameter: float = setting(
        30.0,
        unit="mm",
        low=0.0,
        high=500.0,
        label="Largest hole",
        help="A round recess or opening up to this diameter is a hole, a wider one a pocket.",
    )
    chamfer_width: float = setting(
        5.0,
        unit="mm",
        low=0.0,
        high=50.0,
        label="Widest chamfer",
        help="A slope between a level face and a wall that is wider, seen from above, is no chamfer.",
    )
