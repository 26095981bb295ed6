"""Cutting data of taps: speed from the catalogue's table, a whole number of revolutions, and the feed of the pitch."""

from __future__ import annotations

import math

from trunnion.model.material import Machine, Material, TappingTable
from trunnion.model.operation import CuttingData
from trunnion.model.spindle import surface_speed, turns_of
from trunnion.model.tool import Tool
from trunnion.model.tool.lead import THREAD_HEIGHT, fundamental_triangle
from trunnion.plan.cutting.milling import CuttingSettings
from trunnion.plan.cutting.power import NEWTON_METRES, tapping_torque
from trunnion.units import MM_PER_METRE, trimmed


def tapping_data(
    tool: Tool,
    material: Material,
    table: TappingTable,
    machine: Machine,
    settings: CuttingSettings,
) -> CuttingData:
    """Return the data of an operation that taps a bore, with a sentence for each number.

    The spindle turns at a whole number of revolutions a minute, and the feed is exactly the pitch times that. Limits of spindle, feed and
    torque lower the speed, never the feed alone; where no speed gives the torque, the power stands above its limit (`peak.is_overload`).
    """
    wanted = table.speed * settings.speed_share
    rules = [f"vc {trimmed(wanted, 1)} m/min: tapping {table.title.lower()} ({table.name})"]
    spindle, bounds = _turns(tool, wanted, machine, settings)
    torque = tapping_torque(material, tool)
    strong = _strong_enough(torque, spindle, machine, settings)
    if strong is None:
        bounds.append(f"{trimmed(torque, 1)} Nm are more than the spindle gives at any speed")
    elif strong < spindle:
        spindle = strong
        bounds.append(
            f"n {spindle} 1/min: the spindle gives the torque of {trimmed(torque, 1)} Nm up to this speed"
        )
    feed = tool.pitch * spindle
    rules += [
        *bounds,
        f"n {spindle} 1/min: a whole number, so that the feed is the pitch's",
        f"f {trimmed(tool.pitch, 4)} mm a revolution: the pitch",
        f"Md {trimmed(torque, 1)} Nm: P^2 D kc / 8000, kc by Kienzle",
    ]
    power = torque * spindle / NEWTON_METRES
    return CuttingData(
        speed=float(surface_speed(spindle, tool.diameter)),
        spindle=float(spindle),
        feed_per_tooth=tool.pitch / tool.teeth,
        feed=feed,
        plunge_feed=feed,
        depth=0.5 * (tool.diameter - tool.core_diameter),
        width=tool.diameter,
        removal_rate=_section(tool) * _pitch_circle(tool) * spindle / MM_PER_METRE,
        power=power,
        power_limit=machine.power_at(spindle) * settings.power_share,
        torque=torque,
        rules=tuple(rules),
    )


def _turns(
    tool: Tool, speed: float, machine: Machine, settings: CuttingSettings
) -> tuple[int, list[str]]:
    """Return the largest whole spindle speed in 1/min that speed (m/min), spindle and feed allow, and what bounds it in words."""
    most = math.floor(
        min(
            machine.spindle_high,
            settings.spindle_limit,
            min(machine.feed_max, settings.feed_limit) / tool.pitch,
        )
    )
    turns = math.floor(turns_of(speed, tool.diameter))
    if turns > most:
        return most, [f"n {most} 1/min: the limit of spindle or feed"]
    least = math.ceil(machine.spindle_low)
    if turns < least:
        return least, [f"n {least} 1/min: the spindle's lowest speed"]
    return turns, []


def _strong_enough(
    torque: float, spindle: int, machine: Machine, settings: CuttingSettings
) -> int | None:
    """Return the largest whole spindle speed up to one at which the spindle gives a torque (Nm), or None where there is none."""
    least = max(math.ceil(machine.spindle_low), 1)
    for turns in range(spindle, least - 1, -1):
        if torque * turns / NEWTON_METRES <= machine.power_at(turns) * settings.power_share:
            return turns
    return None


def _section(tool: Tool) -> float:
    """Return the section in mm2 of the groove that a tap cuts into its core: as high as the thread, P / 8 wide at the major diameter and
    3 P / 4 at the minor one (ISO 68-1)."""
    return 0.5 * (0.125 + 0.75) * tool.pitch * THREAD_HEIGHT * fundamental_triangle(tool.pitch)


def _pitch_circle(tool: Tool) -> float:
    """Return the length in mm of one turn at the pitch diameter, D2 = D - 3/4 H (ISO 68-1)."""
    return math.pi * (tool.diameter - 0.75 * fundamental_triangle(tool.pitch))
