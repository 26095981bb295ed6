"""Cutting data: speeds and feeds from material and cutter, bounded by what machine and cutter can bear; every bound in words."""

from __future__ import annotations

import math

from trunnion.model.material import Machine, Material
from trunnion.model.operation import CuttingData
from trunnion.model.spindle import surface_speed, turns_of
from trunnion.model.tool import Tool
from trunnion.plan.cutting.power import NEWTON_METRES, cutting_power
from trunnion.settings import setting, settings
from trunnion.shop.materials import feed_at
from trunnion.units import MM_PER_METRE, trimmed

ROUGH = "rough"
"""The kind of operations that go into full material."""
ROUGHING = ("face", ROUGH, "corner", "profile_rough")
"""Kinds of operation that take the material's roughing speed."""


@settings("cutting")
class CuttingSettings:
    """Limits that every operation's cutting data keep."""

    speed_share: float = setting(
        1.0,
        unit="of the material's",
        low=0.1,
        high=3.0,
        label="Cutting speed",
        help="Factor on the material's cutting speeds.",
    )
    feed_share: float = setting(
        1.0,
        unit="of the material's",
        low=0.1,
        high=3.0,
        label="Feed per tooth",
        help="Factor on the material's feeds per tooth.",
    )
    depth_share: float = setting(
        1.0,
        unit="of the material's",
        low=0.1,
        high=3.0,
        label="Roughing depth",
        help="Factor on the material's depth of cut.",
    )
    width_share: float = setting(
        1.0,
        unit="of the material's",
        low=0.1,
        high=3.0,
        label="Roughing width",
        help="Factor on the material's width of cut.",
    )
    spindle_limit: float = setting(
        100_000.0,
        unit="1/min",
        low=10.0,
        high=200_000.0,
        label="Spindle limit",
        help="Highest spindle speed, when lower than the machine's.",
    )
    feed_limit: float = setting(
        100_000.0,
        unit="mm/min",
        low=1.0,
        high=200_000.0,
        label="Feed limit",
        help="Highest feed, when lower than the machine's.",
    )
    power_share: float = setting(
        0.8,
        unit="of the spindle's",
        low=0.05,
        high=1.0,
        label="Power",
        help="Share of the spindle's power at its speed that cutting may take.",
    )
    thinning_limit: float = setting(
        1.5,
        unit="times",
        low=1.0,
        high=10.0,
        label="Chip thinning",
        help="How far the feed may be raised for a small width of cut.",
    )
    plunge_share: float = setting(
        0.4,
        unit="of the feed",
        low=0.02,
        high=1.0,
        label="Plunge feed",
        help="Feed downwards over the feed across.",
    )
    ramp_share: float = setting(
        0.75,
        unit="of the feed",
        low=0.02,
        high=1.0,
        label="Ramp feed",
        help="Feed of roughing along helices and ramps over the feed across; downwards it is no faster than the plunge feed.",
    )
    slender: float = setting(
        4.0,
        unit="diameters",
        low=1.0,
        high=20.0,
        label="Slender from",
        help="Stickout over diameter from which feed and depth are reduced.",
    )
    slender_share: float = setting(
        0.5,
        unit="of both",
        low=0.1,
        high=1.0,
        label="Slenderest",
        help="What is left of feed and depth at two and a half times that length, and beyond.",
    )


FILM = 0.012
"""Radii: thickness of what passes at constant engagement leave to each other, and a link may scrape off."""


def chip_thinning(diameter: float, width: float) -> float:
    """Return by how much a chip is thinner than the feed per tooth: D / (2 sqrt(ae (D - ae))) for ae < D / 2, else 1.

    >>> chip_thinning(20.0, 10.0), round(chip_thinning(20.0, 2.0), 4)
    (1.0, 1.6667)
    """
    if width >= diameter / 2:
        return 1.0
    return diameter / (2.0 * math.sqrt(width * (diameter - width)))


def slenderness(tool: Tool, settings: CuttingSettings) -> float:
    """Return the share of feed and depth that a stickout leaves: 1 up to `slender` diameters, falling straight to `slender_share`."""
    excess = (tool.stickout / tool.diameter - settings.slender) / (1.5 * settings.slender)
    return 1.0 - min(max(excess, 0.0), 1.0) * (1.0 - settings.slender_share)


def table_feed(material: Material, diameter: float) -> float:
    """Return the material's feed per tooth in mm for a diameter."""
    rows = [(d, low + material.feed_share * (high - low)) for d, low, high in material.feeds]
    return feed_at(rows, diameter)


def roughing_depth(tool: Tool, material: Material, settings: CuttingSettings) -> float:
    """Return the depth of cut in mm that a material and a cutter bear when roughing, not more than the flutes."""
    return _depth(material.depth_factor, tool, settings)


def layer_depth(tool: Tool, material: Material, settings: CuttingSettings) -> float:
    """Return the depth in mm of layers that a cutter bears: as deep as a slot may be, where a strategy opens them by slots at a feed that
    the spindle bears, or comes to them from outside."""
    return _depth(material.deepest_factor, tool, settings)


def _depth(factor: float, tool: Tool, settings: CuttingSettings) -> float:
    bears = factor * settings.depth_share * slenderness(tool, settings) * tool.diameter
    return min(bears, tool.flute_length)


def roughing_width(tool: Tool, material: Material, settings: CuttingSettings) -> float:
    """Return the width of cut in mm that a material bears when roughing."""
    return min(material.width_factor * settings.width_share, 1.0) * tool.diameter


def layer_width(tool: Tool, material: Material, settings: CuttingSettings) -> float:
    """Return the width of cut in mm in layers that are opened by slots or come to from outside: what a slot bears, it bears as well."""
    return min(material.widest_factor * settings.width_share, 1.0) * tool.diameter


def within_spindle(
    speed: float, tool: Tool, machine: Machine, settings: CuttingSettings
) -> tuple[float, float, list[str]]:
    """Return cutting speed (m/min) and spindle speed (1/min) within the machine's and a person's limits, and the bound in words if any."""
    spindle = turns_of(speed, tool.diameter)
    highest = min(machine.spindle_high, settings.spindle_limit)
    if machine.spindle_low <= spindle <= highest:
        return speed, spindle, []
    spindle = min(max(spindle, machine.spindle_low), highest)
    speed = surface_speed(spindle, tool.diameter)
    words = (
        f"n {trimmed(spindle, 0)} 1/min: the spindle's limit, so vc is {trimmed(speed, 0)} m/min"
    )
    return speed, spindle, [words]


def cutting_data(
    tool: Tool,
    material: Material,
    machine: Machine,
    kind: str,
    settings: CuttingSettings,
    depth: float,
    width: float,
    widest: float = 0.0,
) -> CuttingData:
    """Return the data of an operation of `kind` that cuts `depth` ap and `width` ae (mm), with a sentence for each number.

    Feeds follow from the material's table, chip thinning and slenderness; then spindle, feed and power of the machine bound them.
    `widest` (mm) is what may be in front of the cutter at once, where the area says so.
    """
    rough = kind in ROUGHING
    speed = (material.speed_rough if rough else material.speed_finish) * settings.speed_share
    rules = [
        f"vc {trimmed(speed, 0)} m/min: {material.name}, {'roughing' if rough else 'finishing'}"
    ]
    speed, spindle, bound = within_spindle(speed, tool, machine, settings)
    rules += bound
    width, depth = min(width, tool.diameter), min(depth, tool.flute_length)
    table = table_feed(material, tool.diameter) * settings.feed_share
    rules.append(
        f"fz {trimmed(table, 3)} mm: the material's table at D {trimmed(tool.diameter, 2)}"
    )
    thinning = min(chip_thinning(tool.diameter, width), settings.thinning_limit)
    if thinning > 1.0:
        rules.append(
            f"fz times {trimmed(thinning, 2)}: chips are thinner at ae {trimmed(width, 2)} below half the diameter"
        )
    share = slenderness(tool, settings)
    if share < 1.0:
        rules.append(
            f"fz times {trimmed(share, 2)}: the cutter sticks out {trimmed(tool.stickout / tool.diameter, 1)} diameters"
        )
    feed = table * thinning * share * tool.teeth * spindle
    fastest = min(machine.feed_max, settings.feed_limit)
    if feed > fastest:
        feed = fastest
        rules.append(f"vf {trimmed(feed, 0)} mm/min: the machine's limit")
    limit = machine.power_at(spindle) * settings.power_share
    power = cutting_power(
        material, tool.diameter, feed / (tool.teeth * spindle), depth, width, feed
    )
    if power > limit:
        feed *= (limit / power) ** (1.0 / (1.0 - material.force_exponent))
        power = cutting_power(
            material, tool.diameter, feed / (tool.teeth * spindle), depth, width, feed
        )
        rules.append(
            f"vf {trimmed(feed, 0)} mm/min: the spindle gives {trimmed(limit, 1)} kW at this speed "
            f"({trimmed(NEWTON_METRES * limit / spindle, 1)} Nm)"
        )
    return CuttingData(
        speed=speed,
        spindle=spindle,
        feed_per_tooth=feed / (tool.teeth * spindle),
        feed=feed,
        plunge_feed=feed * settings.plunge_share,
        depth=depth,
        width=width,
        removal_rate=depth * width * feed / MM_PER_METRE,
        power=power,
        power_limit=limit,
        torque=NEWTON_METRES * power / spindle,
        rules=tuple(rules),
        widest=widest,
        entry_angle=material.entry_angle * share if kind == ROUGH else 0.0,
        # Finishing enters thin skins: there a ramp takes no time, and would be the largest removal of the operation.
        ramp_share=settings.ramp_share if kind in ROUGHING else 0.0,
        fastest_link=fastest,
        thin_share=max(settings.thinning_limit / thinning, 1.0),
        # Chips off a film are then as thick as those of the cut.
        link_share=chip_thinning(tool.diameter, FILM * tool.radius)
        / chip_thinning(tool.diameter, width),
    )
