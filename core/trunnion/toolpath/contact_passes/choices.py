"""Settings and codes of findings that surface strategies have in common: declared once, each setting in its own position on their pages."""

from __future__ import annotations

from typing import Any

from trunnion.settings import setting

TOO_STEEP, TOO_SHALLOW = "surface.too-steep", "surface.too-shallow"
"""Codes of findings on slopes that one strategy leaves to another."""
HINDERED = "surface.in-the-way"
"""Code of the finding on what an upright tool is lifted off by other faces: a smaller one is there for it, or should be."""
IN_STOCK = "surface.in-stock"
"""Code of the finding on what lies beside stock that is in the way of an upright tool."""
LOW = "surface.low"
"""Code of the finding on how far an upright tool comes below the blank."""


def steepest() -> Any:
    """Return the field of the slope beyond which an upright tool is not put on contacts."""
    return setting(
        80.0,
        unit="deg",
        low=5.0,
        high=89.0,
        label="Steepest slope",
        help="Steeper places are left to waterlines.",
    )


def chord() -> Any:
    """Return the field of the chord error of cuts."""
    return setting(
        0.0003,
        unit="mm",
        low=0.00005,
        high=0.1,
        label="Chord error",
        help="How far straight moves may leave the way of the cutter.",
    )


def lead_radius() -> Any:
    """Return the field of the radius of leads."""
    return setting(
        1.0,
        unit="mm",
        low=0.0,
        high=20.0,
        label="Lead radius",
        help="Radius of the arcs onto and off the face.",
    )
