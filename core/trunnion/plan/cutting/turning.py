"""Cutting data of turning: constant surface speed, feed a revolution and depth from the material's table, bounded by the work spindle."""

from __future__ import annotations

import math

from trunnion.model.material import Material, TurningTable, WorkSpindle
from trunnion.model.operation import CuttingData
from trunnion.model.spindle import FeedMode, SpindleMode, limited_turns
from trunnion.model.tool import TurningTool
from trunnion.plan.cutting.milling import CuttingSettings
from trunnion.plan.cutting.power import NEWTON_METRES
from trunnion.units import SECONDS_PER_MINUTE, WATTS_PER_KILOWATT, trimmed

TURNING_ROUGH, TURNING_FINISH = "turning_rough", "turning_finish"
"""Kinds of turning operation."""
FULL_DEPTH_ANGLE = 80.0
"""degrees: the corner that the tables' depths are for; slenderer ones bear less, in proportion."""
NOSE_FEED = 0.5
"""A feed a revolution is at most this share of the nose radius: beyond, the nose leaves a thread."""


def turning_data(
    tool: TurningTool,
    material: Material,
    table: TurningTable,
    spindle: WorkSpindle,
    settings: CuttingSettings,
    *,
    finish: bool,
    radius: float,
) -> CuttingData:
    """Return the data of a turning operation whose largest radius (mm) of cut is given.

    The depth of cut is lowered where the table's power at the slowest turning does not bear it.
    """
    speed = (table.speed_finish if finish else table.speed_rough) * settings.speed_share
    feed = (table.feed_finish if finish else table.feed_rough) * settings.feed_share
    feed = min(feed, NOSE_FEED * tool.insert.nose_radius)
    strength = min(1.0, (tool.insert.point_angle or FULL_DEPTH_ANGLE) / FULL_DEPTH_ANGLE)
    depth = table.depth_finish if finish else table.depth_rough * settings.depth_share * strength
    highest = min(spindle.high, settings.spindle_limit)
    turns = float(limited_turns(speed, 2.0 * radius, highest))
    chip = feed * math.sin(math.radians(tool.edge_angle))
    force = material.force * chip**-material.force_exponent
    limit = spindle.power_at(turns)
    rules = [f"surface speed and feed a revolution: {table.source}"]
    most = (
        settings.power_share
        * limit
        * SECONDS_PER_MINUTE
        * WATTS_PER_KILOWATT
        / (speed * feed * force)
    )
    if depth > most:
        rules.append(
            f"depth {trimmed(most, 2)} mm instead of {trimmed(depth, 2)}: the table gives {trimmed(limit, 1)} kW at {turns:.0f} 1/min"
        )
        depth = most
    rate = speed * feed * depth
    power = rate * force / (SECONDS_PER_MINUTE * WATTS_PER_KILOWATT)
    return CuttingData(
        speed=speed,
        spindle=turns,
        feed_per_tooth=feed,
        feed=feed * turns,
        plunge_feed=0.5 * feed * turns,
        depth=depth,
        width=feed,
        removal_rate=rate,
        power=power,
        power_limit=limit,
        torque=NEWTON_METRES * power / turns,
        rules=tuple(rules),
        spindle_mode=SpindleMode.SURFACE,
        highest_spindle=highest,
        feed_mode=FeedMode.REVOLUTION,
    )
