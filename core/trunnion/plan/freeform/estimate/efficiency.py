"""What variable parameters gain, by the paper's arithmetic: areas over area rates (quick segmentation, experiment and estimation)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class AreaRate:
    """How much area a cutter finishes in a time: mm2 and s, measured together on one face."""

    area: float
    time: float

    def seconds(self, area: float) -> float:
        """Return the time for another area."""
        return area * self.time / self.area


def mixed_time(
    large: Sequence[float], small: Sequence[float], large_rate: AreaRate, small_rate: AreaRate
) -> float:
    """Return the time (s) of areas (mm2) cut by the large cutter and areas cut by the small one; tool changes are left out."""
    return large_rate.seconds(sum(large)) + small_rate.seconds(sum(small))


def gain(old: float, new: float) -> float:
    """Return the increase of efficiency: old time over new time, less one."""
    return old / new - 1.0


def saving(old: float, new: float) -> float:
    """Return the share of the time that is saved."""
    return 1.0 - new / old
