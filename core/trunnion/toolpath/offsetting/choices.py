"""Fields of settings that plane strategies have in common, each declared once; defaults and help where they differ are the strategy's."""

from __future__ import annotations

from typing import Any

from trunnion.settings import setting

WHERE_NO_LEAD_FITS = "Slope of a ramp where no lead fits."
"""Help of the entry angle of strategies that enter by leads."""


def ramp_angle(default: float, help: str = WHERE_NO_LEAD_FITS) -> Any:
    """Return the field of the slope of helices and ramps into material."""
    return setting(default, unit="deg", low=0.5, high=30.0, label="Entry angle", help=help)


def lead_radius(default: float, help: str) -> Any:
    """Return the field of the radius of leads onto walls."""
    return setting(default, unit="mm", low=0.2, high=100.0, label="Lead radius", help=help)


def overlap(default: float) -> Any:
    """Return the field of how far closed passes run on."""
    return setting(
        default,
        unit="mm",
        low=0.0,
        high=50.0,
        label="Overlap",
        help="How far a closed pass runs on past its start.",
    )


def fillet_scallop() -> Any:
    """Return the field of the height of cusps on floor fillets."""
    return setting(
        0.01,
        unit="mm",
        low=0.001,
        high=1.0,
        label="Scallop",
        help="Height of the cusps on a fillet that is larger than the cutter's corner.",
    )


def slot_feed(default: float, help: str) -> Any:
    """Return the field of the share of the feed in full width."""
    return setting(
        default, unit="of feed", low=0.1, high=1.0, label="Feed in full width", help=help
    )
