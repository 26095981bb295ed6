"""Fields of settings that strategies of every kind have in common, each declared once."""

from __future__ import annotations

from typing import Any

from trunnion.settings import setting


def safety() -> Any:
    """Return the field of how far above the stock rapids end."""
    return setting(
        2.0,
        unit="mm",
        low=0.2,
        high=50.0,
        label="Safety distance",
        help="Where a rapid ends above what may still be there.",
    )
