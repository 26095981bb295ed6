"""Limits of a hole's diameter, as deviations from the nominal one."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Limits:
    """The deviations in mm that a hole's diameter may have from the nominal one: EI `lower` and ES `upper` of ISO 286-1."""

    lower: float
    upper: float

    def __post_init__(self) -> None:
        if not self.lower <= self.upper:
            raise ValueError(
                f"the lower deviation {self.lower:g} is above the upper {self.upper:g}"
            )

    @property
    def width(self) -> float:
        """The tolerance in mm: how far the limits are apart."""
        return self.upper - self.lower

    @property
    def middle(self) -> float:
        """The deviation in mm half between the limits, which a tool is made or set for."""
        return 0.5 * (self.lower + self.upper)
