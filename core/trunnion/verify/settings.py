"""What a shop may choose about the proof."""

from __future__ import annotations

from trunnion import tolerance
from trunnion.settings import setting, settings


@settings("verify")
class ProofSettings:
    """Limits of the verdict and fineness of what is looked at."""

    tolerance: float = setting(
        tolerance.GOUGE,
        unit="mm",
        low=0.001,
        high=1.0,
        label="Tolerance",
        help="How deep anything may enter the finished part, and how much may be left on a finished face.",
    )
    allowance: float = setting(
        0.0,
        unit="mm",
        low=0.0,
        high=10.0,
        label="Allowance",
        help="Material left on purpose; a face is finished within tolerance and allowance.",
    )
    coverage: float = setting(
        0.99,
        unit="of the reachable area",
        low=0.0,
        high=1.0,
        label="Coverage",
        help="Share of the reachable area that must be finished.",
    )
    cell: float = setting(
        0.0,
        unit="mm",
        low=0.0,
        high=10.0,
        label="Stock cell",
        help="Distance of the columns that the stock is made of. Halving it takes four times the memory. 0: as small as the "
        "part is, between 0.15 and 0.5 mm; 0.5 mm where a tool leans.",
    )
    spacing: float = setting(
        2.0,
        unit="mm",
        low=0.2,
        high=20.0,
        label="Sample spacing",
        help="Distance of the samples that measure which area is finished.",
    )
    bundles: str = setting(
        "auto",
        label="Stock bundles",
        choices=("auto", "z", "xyz"),
        help="Directions of the columns that the stock is made of. auto: z alone while every tool stands upright on the "
        "blank and cuts nothing from below, all three otherwise.",
    )
    threads: int = setting(
        0,
        unit="",
        low=0,
        high=256,
        label="Threads",
        help="Cores that the proof works on; 0 takes all there are. The result is the same.",
    )
    power: float = setting(
        1.0,
        unit="of the spindle's",
        low=0.05,
        high=2.0,
        label="Power",
        help="Share of the spindle's power at its speed that cutting may take; more is an error.",
    )
    removal: float = setting(
        3.0,
        unit="times the chosen",
        low=1.0,
        high=20.0,
        label="Removal rate",
        help="How far the removal rate may pass what an operation's feed is chosen for, or what the material's tables "
        "allow its cutter when that is more. Full width at the feed for a quarter of it comes to 4.",
    )
    chip: float = setting(
        1.5,
        unit="times the chosen",
        low=1.0,
        high=5.0,
        label="Chip thickness",
        help="How far the thickest chip may pass that of the chosen engagement, or the material's largest feed per tooth "
        "when that is more.",
    )
    air: float = setting(
        0.8,
        unit="of the way",
        low=0.0,
        high=1.0,
        label="Air cutting",
        help="Share of an operation's feed moves that may cut nothing before it is remarked.",
    )
