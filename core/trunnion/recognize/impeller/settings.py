"""What a person may choose about the recognition of impellers."""

from __future__ import annotations

from trunnion.settings import setting, settings

AUTOMATIC, ANTICLOCKWISE, CLOCKWISE = "auto", "anticlockwise", "clockwise"


@settings("recognize.impeller")
class ImpellerSettings:
    """Which way the wheel turns, and how large holes beside its bore may be."""

    rotation: str = setting(
        AUTOMATIC,
        label="Rotation",
        choices=(AUTOMATIC, ANTICLOCKWISE, CLOCKWISE),
        help="Way the wheel turns, seen from its inlet; auto: the one in which the blades are swept back. The pressure side of a blade "
        "faces that way.",
    )
    hole_diameter: float = setting(
        0.25,
        unit="of the outlet diameter",
        low=0.0,
        high=1.0,
        label="Largest hole",
        help="A round recess or opening beside the bore up to this share of the outlet diameter is a hole, a wider one is left open.",
    )
