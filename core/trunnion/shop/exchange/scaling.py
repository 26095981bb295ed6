"""Lengths in a library's own unit: mm or inches."""

from __future__ import annotations

_DECIMALS = 9
"""mm: what a change of units may leave beyond is rounding."""


def without_noise(value: float) -> float:
    """Return a length in mm without what sums and changes of units leave beyond all measuring.

    >>> without_noise(0.1 + 0.2)
    0.3
    """
    return round(value, _DECIMALS)


def scaled(value: float, scale: float) -> float:
    """Return a length in mm of one in units of `scale` mm.

    >>> scaled(0.1875, 25.4), scaled(3.0, 1.0)
    (4.7625, 3.0)
    """
    return value if scale == 1.0 else without_noise(value * scale)


def unscaled(value: float, scale: float) -> float:
    """Return a length in units of `scale` mm of one in mm, exact enough to come back.

    >>> unscaled(4.7625, 25.4), unscaled(3.0, 1.0)
    (0.1875, 3.0)
    """
    return value if scale == 1.0 else round(value / scale, _DECIMALS + 2)
