"""Cutting data of interrupted turning: a round insert in a locked spindle, the work turned past it by the table."""

from __future__ import annotations

import math

from trunnion.model.material import Machine, Material, TurningTable, WorkSpindle
from trunnion.model.operation import CuttingData
from trunnion.model.tool import Tool
from trunnion.plan.cutting.milling import CuttingSettings
from trunnion.plan.cutting.power import NEWTON_METRES
from trunnion.units import MM_PER_METRE, SECONDS_PER_MINUTE, WATTS_PER_KILOWATT, trimmed

INTERRUPTED = "interrupted"
"""The kind of operations that turn the gaps between bosses."""
DEGREES_A_TURN = 360.0


def contact_angle(radius: float, depth: float) -> float:
    """Return the angle (rad) over which a round insert of a radius is in contact at a depth of cut, mm."""
    return math.acos(max(1.0 - depth / radius, -1.0))


def interrupted_data(
    tool: Tool,
    material: Material,
    table: TurningTable,
    machine: Machine,
    spindle: WorkSpindle,
    settings: CuttingSettings,
    *,
    speed: float,
    retract_speed: float,
    radius: float,
    lift: float,
    depth: float,
    ridge: float,
) -> CuttingData:
    """Return the data of an operation on ground of a least `radius` (mm), `depth` mm deep, that leaves ridges of a height (mm).

    `speed` m/min is the wanted one of the ground under the tool. Of the machine its table bounds it, and its largest feed: the tool also
    goes `lift` mm over the ground, where the work passes more quickly, while it retracts at `retract_speed` m/min.
    The feed a revolution leaves ridges of f^2 / (8 r); at the depth's end the chip is f sin(kappa) thick, which the table's feeds are for.
    """
    rules = [
        f"vc {trimmed(speed, 0)} m/min: the speed for interrupted cuts (casing.regions.surface_speed)"
    ]
    borne = table.speed_finish * settings.speed_share
    around = 2.0 * math.pi * radius / MM_PER_METRE
    turning = next(a for a in machine.rotary if a.carries == "work")
    fastest = min(machine.feed_max, settings.feed_limit) / MM_PER_METRE
    bounds = {
        f"what inserts bear in {material.name}": borne,
        f"axis {turning.name} turns at {trimmed(turning.rapid / DEGREES_A_TURN, 0)} 1/min at most": turning.rapid
        / DEGREES_A_TURN
        * around,
        f"the table turns at {trimmed(spindle.high, 0)} 1/min at most": spindle.high * around,
        f"{machine.title} feeds at most {trimmed(fastest, 0)} m/min": math.sqrt(
            max(fastest**2 - retract_speed**2, 0.0)
        )
        * radius
        / (radius + lift),
    }
    why, most = min(bounds.items(), key=lambda b: b[1])
    if most < speed:
        speed = most
        rules.append(f"vc {trimmed(speed, 1)} m/min: {why}")
    contact = contact_angle(tool.radius, depth)
    thickest = table.feed_rough * settings.feed_share
    feed = min(math.sqrt(8.0 * tool.radius * ridge), thickest / math.sin(min(contact, math.pi / 2)))
    rules.append(
        f"f {trimmed(feed, 3)} mm a revolution: ridges of {trimmed(feed**2 / (8.0 * tool.radius), 4)} mm by a radius of "
        f"{trimmed(tool.radius, 1)} mm, chips of {trimmed(thickest, 2)} mm at most"
    )
    turns = speed / around
    rate = speed * feed * depth
    chip = feed * depth / (tool.radius * contact)
    force = material.force * chip**-material.force_exponent
    power = rate * force / (SECONDS_PER_MINUTE * WATTS_PER_KILOWATT)
    return CuttingData(
        speed=speed,
        spindle=turns,
        feed_per_tooth=feed,
        feed=speed * MM_PER_METRE,
        plunge_feed=speed * MM_PER_METRE,
        depth=depth,
        width=feed,
        removal_rate=rate,
        power=power,
        power_limit=spindle.power_at(turns) * settings.power_share,
        torque=NEWTON_METRES * power / turns,
        rules=tuple(rules),
    )
