"""Cutting data of reamers and boring bars: speed, feed a revolution and depth of cut from the catalogue's tables, bounded by the
machine."""

from __future__ import annotations

import math

from trunnion.model.material import DrillingTable, Machine, Material
from trunnion.model.operation import CuttingData
from trunnion.model.tool import Tool
from trunnion.plan.cutting.milling import CuttingSettings, within_spindle
from trunnion.plan.cutting.power import NEWTON_METRES, reaming_power
from trunnion.shop.materials import feed_at
from trunnion.units import MM_PER_METRE, trimmed


def reaming_data(
    tool: Tool,
    material: Material,
    table: DrillingTable,
    machine: Machine,
    settings: CuttingSettings,
    word: str = "reaming",
) -> CuttingData:
    """Return the data of an operation that reams or bores to size, with a sentence for each number; `word` says which.

    The depth of cut is half of the most that the table leaves on the diameter: a bore that is wider is a lighter cut.
    """
    speed = table.speed * settings.speed_share
    rules = [f"vc {trimmed(speed, 0)} m/min: {word} {table.title.lower()} ({table.name})"]
    speed, spindle, bound = within_spindle(speed, tool, machine, settings)
    rules += bound
    rows = [(d, low + table.feed_share * (high - low)) for d, low, high in table.feeds]
    turn = feed_at(rows, tool.diameter) * settings.feed_share
    rules.append(
        f"f {trimmed(turn, 3)} mm a revolution: the {word} table at D {trimmed(tool.diameter, 2)}"
    )
    least, most = table.allowance(tool.diameter)
    depth = 0.5 * most
    rules.append(
        f"ap {trimmed(depth, 3)} mm: the bore is to be {trimmed(least, 2)} to {trimmed(most, 2)} mm smaller"
    )
    feed, fastest = turn * spindle, min(machine.feed_max, settings.feed_limit)
    if feed > fastest:
        feed = fastest
        rules.append(f"vf {trimmed(feed, 0)} mm/min: the machine's limit")
    limit = machine.power_at(spindle) * settings.power_share
    power = reaming_power(material, tool, feed / (tool.teeth * spindle), depth, feed)
    if power > limit:
        feed *= (limit / power) ** (1.0 / (1.0 - material.force_exponent))
        power = reaming_power(material, tool, feed / (tool.teeth * spindle), depth, feed)
        rules.append(
            f"vf {trimmed(feed, 0)} mm/min: the spindle gives {trimmed(limit, 1)} kW at this speed"
        )
    return CuttingData(
        speed=speed,
        spindle=spindle,
        feed_per_tooth=feed / (tool.teeth * spindle),
        feed=feed,
        plunge_feed=feed,
        depth=depth,
        width=tool.diameter,
        removal_rate=math.pi * (tool.diameter - depth) * depth * feed / MM_PER_METRE,
        power=power,
        power_limit=limit,
        torque=NEWTON_METRES * power / spindle,
        rules=tuple(rules),
    )
