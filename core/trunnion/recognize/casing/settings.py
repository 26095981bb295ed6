"""What a person may choose about the recognition of casings."""

from __future__ import annotations

from trunnion.settings import setting, settings

FILE, BOSS = "file", "boss"


@settings("recognize.casing")
class CasingSettings:
    """Where angles count from, and which round openings are holes."""

    x: str = setting(
        FILE,
        choices=(FILE, BOSS),
        label="Zero of angles",
        help="file: the x axis of the part's file, across the main axis. boss: through the boss that stands out most, the widest "
        "of equal ones.",
    )
    hole_diameter: float = setting(
        0.0,
        unit="mm",
        low=0.0,
        high=10000.0,
        label="Largest hole",
        help="Round openings up to this diameter are holes; 0: all that are narrower than the casing's own bore.",
    )
