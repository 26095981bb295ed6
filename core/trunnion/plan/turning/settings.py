"""What a person may choose about turning: from where a tool comes, how low it goes, what it leaves."""

from __future__ import annotations

from trunnion.plan.turning.reach import TurningLimits
from trunnion.plan.turning.view import TurningSide
from trunnion.settings import setting, settings
from trunnion.units import FARTHEST

MOST_LAYERS = 2.5
"""Times its depth of cut that a finishing pass bears: what is thicker, because no roughing tool gets there, it leaves."""


@settings("turn")
class TurningSettings:
    """From where the tool comes to the work, how low it goes, what it leaves, and how far its moves keep away."""

    side: str = setting(
        TurningSide.OUTSIDE.value,
        choices=tuple(a.value for a in TurningSide),
        label="TurningSide",
        help="outside or inside: fed along the axis; face: fed across the upper end.",
    )
    lowest: float = setting(
        -FARTHEST,
        unit="mm",
        low=-FARTHEST,
        high=FARTHEST,
        label="Lowest point",
        help="Z of the setup below which the tool's point does not go.",
    )
    floor: float = setting(
        -FARTHEST,
        unit="mm",
        low=-FARTHEST,
        high=FARTHEST,
        label="Floor",
        help="Z of the setup below which nothing of the tool goes: what holds the work is there.",
    )
    allowance: float = setting(
        0.3,
        unit="mm",
        low=0.0,
        high=5.0,
        label="Allowance",
        help="Material that roughing leaves all round for the finishing pass.",
    )
    finish_allowance: float = setting(
        0.0,
        unit="mm",
        low=0.0,
        high=5.0,
        label="Finishing allowance",
        help="Material that the finishing pass leaves all round.",
    )
    clearance: float = setting(
        2.0,
        unit="mm",
        low=0.2,
        high=50.0,
        label="Clearance",
        help="How far rapids keep from the stock, and how far passes begin before it.",
    )
    bridge: float = setting(
        10.0,
        unit="mm",
        low=0.0,
        high=500.0,
        label="Bridge",
        help="A pass along the contour goes on over stretches without material up to this long.",
    )

    @property
    def limits(self) -> TurningLimits:
        """How low the tool goes."""
        return TurningLimits(floor=self.floor, lowest=self.lowest)
