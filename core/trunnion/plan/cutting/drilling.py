"""Cutting data of drills: speed and feed a revolution from the catalogue's tables, bounded by the machine; every bound in words."""

from __future__ import annotations

import math

from trunnion.model.material import DrillingTable, Machine, Material
from trunnion.model.operation import CuttingData
from trunnion.model.tool import Tool
from trunnion.plan.cutting.milling import CuttingSettings, within_spindle
from trunnion.plan.cutting.power import NEWTON_METRES, drilling_power, drilling_thrust
from trunnion.shop.materials import feed_at
from trunnion.units import MM_PER_METRE, trimmed

AXIAL = ("spot", "drill", "countersink", "ream", "fine_bore", "tap")
"""Kinds of operation whose tool cuts along its axis: their data are those of drilling, reaming, boring or tapping."""
SLOWER = {"countersink": 0.5}
"""Share of the speed of drilling that other kinds take: a countersink has its edge over a long cone, and chatters (usual shop practice)."""


def drilling_data(
    tool: Tool,
    material: Material,
    table: DrillingTable,
    machine: Machine,
    settings: CuttingSettings,
    kind: str = "drill",
) -> CuttingData:
    """Return the data of an operation of a kind (`AXIAL` but reaming and tapping) that drills into solid material, with a sentence for
    each number.

    The depth of cut of a drill is half its diameter (ISO 3002-3), its width the diameter; it is fed down at the feed itself.
    """
    speed = table.speed * SLOWER.get(kind, 1.0) * settings.speed_share
    rules = [f"vc {trimmed(speed, 0)} m/min: drilling {table.title.lower()} ({table.name})"]
    speed, spindle, bound = within_spindle(speed, tool, machine, settings)
    rules += bound
    rows = [(d, low + table.feed_share * (high - low)) for d, low, high in table.feeds]
    turn = feed_at(rows, tool.diameter) * settings.feed_share
    rules.append(
        f"f {trimmed(turn, 3)} mm a revolution: the drilling table at D {trimmed(tool.diameter, 2)}"
    )
    feed, fastest = turn * spindle, min(machine.feed_max, settings.feed_limit)
    if feed > fastest:
        feed = fastest
        rules.append(f"vf {trimmed(feed, 0)} mm/min: the machine's limit")
    limit = machine.power_at(spindle) * settings.power_share
    power = drilling_power(material, tool, feed / (tool.teeth * spindle), feed)
    if power > limit:
        feed *= (limit / power) ** (1.0 / (1.0 - material.force_exponent))
        power = drilling_power(material, tool, feed / (tool.teeth * spindle), feed)
        rules.append(
            f"vf {trimmed(feed, 0)} mm/min: the spindle gives {trimmed(limit, 1)} kW at this speed "
            f"({trimmed(NEWTON_METRES * limit / spindle, 1)} Nm)"
        )
    tooth = feed / (tool.teeth * spindle)
    rules.append(
        f"thrust {trimmed(drilling_thrust(material, tool, tooth), 0)} N by Kienzle, the chisel edge's share not counted"
    )
    return CuttingData(
        speed=speed,
        spindle=spindle,
        feed_per_tooth=tooth,
        feed=feed,
        plunge_feed=feed,
        depth=tool.radius,
        width=tool.diameter,
        removal_rate=0.25 * math.pi * tool.diameter**2 * feed / MM_PER_METRE,
        power=power,
        power_limit=limit,
        torque=NEWTON_METRES * power / spindle,
        rules=tuple(rules),
    )
