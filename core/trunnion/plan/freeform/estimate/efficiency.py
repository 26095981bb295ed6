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


@dataclass(frozen=True, slots=True, kw_only=True)
class CutterAreas:
    """Areas (mm2) that a cutter finishes, and the area rate that was measured for it."""

    cutter: str
    areas: tuple[float, ...]
    rate: AreaRate

    @property
    def seconds(self) -> float:
        """Time for its areas."""
        return self.rate.seconds(sum(self.areas))


@dataclass(frozen=True, slots=True, kw_only=True)
class EfficiencyEstimate:
    """The gain of a large cutter for some areas and a small one for the others, over the small one for all of them.

    `title` and `source` say what was measured, and by whom.
    """

    name: str
    large: CutterAreas
    small: CutterAreas
    title: str = ""
    source: str = ""

    @property
    def seconds(self) -> float:
        """Time (s) with both cutters."""
        return mixed_time(self.large.areas, self.small.areas, self.large.rate, self.small.rate)

    @property
    def seconds_alone(self) -> float:
        """Time (s) with the small cutter alone."""
        areas = (*self.large.areas, *self.small.areas)
        return mixed_time((), areas, self.large.rate, self.small.rate)

    @property
    def gain(self) -> float:
        """Increase of efficiency as a share."""
        return gain(self.seconds_alone, self.seconds)

    @property
    def saving(self) -> float:
        """Share of the time that is saved."""
        return saving(self.seconds_alone, self.seconds)

    def as_dict(self) -> dict[str, object]:
        """Return the estimate as the JSON that other programs rely on: mm2, mm2/s, s, shares."""
        return {
            "name": self.name,
            "title": self.title,
            "source": self.source,
            "cutters": [
                {
                    "cutter": c.cutter,
                    "areas": list(c.areas),
                    "rate": c.rate.area / c.rate.time,
                    "seconds": c.seconds,
                }
                for c in (self.large, self.small)
            ],
            "seconds": self.seconds,
            "seconds_alone": self.seconds_alone,
            "gain": self.gain,
            "saving": self.saving,
        }
