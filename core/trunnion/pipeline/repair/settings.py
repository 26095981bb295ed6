"""What a person may choose about repair."""

from __future__ import annotations

from trunnion.settings import setting, settings


@settings("repair")
class RepairSettings:
    """How long a plan that failed its proof is repaired."""

    rounds: int = setting(
        8,
        low=0,
        high=100,
        label="Repair rounds",
        help="Most rounds in which fixes are tried and proven when a plan fails its proof; 0: none.",
    )
    remarks: bool = setting(
        False,
        label="Repair remarks",
        help="Also repair what the proof only remarks on a released plan: excess load, operations that cut mostly air.",
    )
