"""What a shop may choose about the text of its programs."""

from __future__ import annotations

from trunnion import registry, tolerance
from trunnion.settings import setting, settings

OF_MACHINE = "machine"
"""The choice of a control that leaves it to each setup's machine."""


@settings("post")
class PostSettings:
    """The control and the form of its text."""

    dialect: str = setting(
        OF_MACHINE,
        label="Control",
        help="The dialect that programs are written in; machine: that of each setup's machine.",
        choices=(OF_MACHINE, *registry.names("dialects")),
    )
    units: str = setting(
        "mm",
        label="Units",
        help="The unit of lengths and feeds in the text.",
        choices=("mm", "inch"),
    )
    decimals: int = setting(
        4,
        low=3,
        high=6,
        label="Decimals",
        help="Decimals of a length in mm; a text in inches has one more.",
    )
    path_tolerance: float = setting(
        0.005,
        unit="mm",
        low=0.001,
        high=tolerance.GOUGE,
        label="Path tolerance",
        help="How far the control may round corners off to keep its speed.",
    )
    straying: float = setting(
        0.002,
        unit="mm",
        low=0.0005,
        high=tolerance.GOUGE,
        label="Five-axis tolerance",
        help="How far the tool may leave its way between two blocks while rotary axes turn.",
    )
    rapid_straying: float = setting(
        0.5,
        unit="mm",
        low=0.001,
        high=5.0,
        label="Five-axis tolerance of rapids",
        help="The same for rapids, which go through free space.",
    )
    number_step: int = setting(
        10, low=1, high=100, label="Line number step", help="From one N word to the next."
    )
