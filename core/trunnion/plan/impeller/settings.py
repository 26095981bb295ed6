"""What a person may choose about the plan of an impeller."""

from __future__ import annotations

from trunnion.plan.freeform.estimate.scallop import height_of
from trunnion.settings import setting, settings


@settings("impeller")
class ImpellerRouteSettings:
    """Which cutters are used, how fine the channels get, and what roughing leaves."""

    scallop: float = setting(
        0.01,
        unit="mm",
        low=0.0005,
        high=1.0,
        label="Scallop height",
        help="Height of the ridges between passes that finishing leaves.",
    )
    ra: float = setting(
        0.0,
        unit="um",
        low=0.0,
        high=100.0,
        label="Wanted Ra",
        help="Roughness that the scallop height is chosen for, 2.5 um of height for each um; 0: as said by the height.",
    )
    rough_allowance: float = setting(
        0.3,
        unit="mm",
        low=0.0,
        high=5.0,
        label="Roughing allowance",
        help="What roughing leaves on walls and hub.",
    )
    layer: float = setting(
        0.0,
        unit="mm",
        low=0.0,
        high=20.0,
        label="Roughing layer",
        help="Largest depth of the layers that roughing goes down by; 0: what material and cutter bear.",
    )
    rough_cutter: str = setting(
        "",
        label="Roughing cutter",
        catalogue="tools",
        help="Name of the cutter that roughs the channels; empty: the largest tapered ball that goes through the narrowest place.",
    )
    wide_first: bool = setting(
        True,
        label="Wide parts first",
        help="Rough with a larger cutter wherever it fits, before the one that goes through the narrowest place, if that saves a "
        "quarter of the time.",
    )
    wide_cutter: str = setting(
        "",
        label="Cutter of wide parts",
        catalogue="tools",
        help="Name of the cutter that roughs the wide parts of the channels first; empty: the one that saves most.",
    )
    finish_cutter: str = setting(
        "",
        label="Finishing cutter",
        catalogue="tools",
        help="Name of the cutter that finishes blades and splitters; empty: the largest tapered ball that goes through the narrowest "
        "place, no larger than the root fillets.",
    )
    fillet_cutter: str = setting(
        "",
        label="Cutter of hub and fillets",
        catalogue="tools",
        help="Name of the cutter that finishes hub and root fillets; empty: the largest tapered ball no larger than the fillets.",
    )

    def height(self) -> float:
        """Return the scallop height in mm that is wanted."""
        return height_of(self.ra) if self.ra > 0.0 else self.scallop
