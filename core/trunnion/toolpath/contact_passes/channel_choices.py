"""The settings that strategies for channels between blades share."""

from __future__ import annotations

from typing import Any

from trunnion.settings import setting


def axis_turn() -> Any:
    """Return the field of how fast the axis may turn along the way."""
    return setting(
        10.0,
        unit="deg/mm",
        low=0.5,
        high=60.0,
        label="Axis turn",
        help="How far the axis may turn on a mm of the cutter's way.",
    )


def finishing_chord(surface: str) -> Any:
    """Return the field of the chord error of a finished surface, which is named."""
    return setting(
        0.002,
        unit="mm",
        low=0.0001,
        high=0.1,
        label="Chord error",
        help=f"How far a block may leave the {surface}, on either side.",
    )


def over_shroud() -> Any:
    """Return the field of how far over the shroud rapids begin."""
    return setting(
        1.0,
        unit="mm",
        low=0.2,
        high=50.0,
        label="Safety distance",
        help="How far over the shroud the tool is fed out of a channel before it goes at rapid.",
    )
