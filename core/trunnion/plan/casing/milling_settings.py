"""What a person may choose about the milling of a casing."""

from __future__ import annotations

from trunnion.settings import setting, settings


@settings("casing")
class CasingRouteSettings:
    """Which cutters mill a casing between its bosses, how fine, and what roughing leaves."""

    scallop: float = setting(
        0.006,
        unit="mm",
        low=0.0005,
        high=1.0,
        label="Scallop height",
        help="Height of the ridges between finishing passes, on sides and bottoms alike.",
    )
    layer: float = setting(
        0.0,
        unit="mm",
        low=0.0,
        high=50.0,
        label="Roughing layer",
        help="Largest depth of the layers that roughing goes down by; 0: what material and cutter bear.",
    )
    rough_cutter: str = setting(
        "",
        label="Roughing cutter",
        catalogue="tools",
        help="Name of the cutter that roughs between bosses; empty: the largest that leaves little.",
    )
    finish_cutter: str = setting(
        "",
        label="Bottom cutter",
        catalogue="tools",
        help="Name of the end mill that finishes bottoms; empty: the largest that leaves little.",
    )
    share: float = setting(
        0.9,
        unit="of the area",
        low=0.3,
        high=1.0,
        label="Reach",
        help="Share of a bottom that its cutter must reach; the largest that does is taken, smaller ones cut the rest.",
    )
    interrupted: bool = setting(
        True,
        label="Interrupted turning",
        help="Gaps between bosses that are long enough are turned on a machine that turns and mills; else bottoms are milled throughout.",
    )
    lathe: str = setting(
        "",
        label="Turning machine",
        catalogue="machines",
        help="Name of the machine that turns a blank which does not come turned; empty: the smallest of the catalogue that does.",
    )
