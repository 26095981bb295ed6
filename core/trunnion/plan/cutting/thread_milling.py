"""Cutting data of thread mills: speed and feed a tooth from the catalogue's table, and how deep one radial pass goes."""

from __future__ import annotations

import math

from trunnion.model.material import Machine, Material, ThreadMillingTable
from trunnion.model.operation import CuttingData
from trunnion.model.tool import Tool
from trunnion.model.tool.thread_mill import (
    FLANK_ANGLE,
    TIP_FLAT,
    groove_depth,
    pitches,
    teeth_along,
)
from trunnion.plan.cutting.milling import CuttingSettings, slenderness, within_spindle
from trunnion.plan.cutting.power import NEWTON_METRES, cutting_power
from trunnion.shop.materials import feed_at
from trunnion.units import MM_PER_METRE, trimmed


def thread_milling_data(
    tool: Tool,
    material: Material,
    table: ThreadMillingTable,
    machine: Machine,
    settings: CuttingSettings,
) -> CuttingData:
    """Return the data of an operation that mills a thread, with a sentence for each number.

    The feed is that of the teeth's tips. `width` is how deep the first of the passes goes that the coarsest groove of the tool is cut in,
    the depth over the square root of their number: of a groove with leaning flanks each takes about as much. `depth` is the mean width of
    that cut along the axis, of all teeth together. Spindle, feed and power of the machine bound them.
    """
    wanted = table.speed * settings.speed_share
    rules = [f"vc {trimmed(wanted, 0)} m/min: thread milling {table.title.lower()} ({table.name})"]
    speed, spindle, bound = within_spindle(wanted, tool, machine, settings)
    per_tooth = feed_at(table.feeds, tool.diameter) * settings.feed_share
    rules += [
        *bound,
        f"fz {trimmed(per_tooth, 3)} mm: the table's at D {trimmed(tool.diameter, 2)}, at the tips of the teeth",
    ]
    share = slenderness(tool, settings)
    if share < 1.0:
        rules.append(
            f"fz times {trimmed(share, 2)}: the cutter sticks out {trimmed(tool.stickout / tool.diameter, 1)} diameters"
        )
    feed = per_tooth * share * tool.teeth * spindle
    fastest = min(machine.feed_max, settings.feed_limit)
    if feed > fastest:
        feed = fastest
        rules.append(f"vf {trimmed(feed, 0)} mm/min: the machine's limit")
    depth, width, passes = _engagement(tool, table)
    rules.append(
        f"ae {trimmed(width, 3)} mm: the first of {passes} passes, pitch {trimmed(pitches(tool)[1], 3)} mm"
        if passes > 1
        else f"ae {trimmed(width, 3)} mm: the thread's depth in one pass"
    )

    def power_at(feed: float) -> float:
        return cutting_power(
            material, tool.diameter, feed / (tool.teeth * spindle), depth, width, feed
        )

    limit, power = machine.power_at(spindle) * settings.power_share, power_at(feed)
    if power > limit:
        feed *= (limit / power) ** (1.0 / (1.0 - material.force_exponent))
        power = power_at(feed)
        rules.append(
            f"vf {trimmed(feed, 0)} mm/min: the spindle gives {trimmed(limit, 1)} kW at this speed"
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
    )


def _engagement(tool: Tool, table: ThreadMillingTable) -> tuple[float, float, int]:
    """Return depth (along the axis) and width of cut in mm of the first pass of a tool's coarsest groove, and how many passes it takes."""
    finest, coarsest = pitches(tool)
    passes = table.passes(coarsest)
    width = groove_depth(tool, coarsest) / math.sqrt(passes)
    mean = TIP_FLAT * finest + width * math.tan(FLANK_ANGLE)
    return teeth_along(tool) * mean, width, passes
