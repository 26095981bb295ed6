"""How long a gap between two bosses must be so that a tool can be in it while the part turns: paper's threshold made of speed and machine.

    g* = kappa (V (t_r + t_a + t_cut) + margin),  V = 2 pi n r
    t = L / v + v / a  where L >= v^2 / a,  else 2 sqrt(L / a),  L = H / cos(phi)

V is the speed of the ground, t_r and t_a the times to retract over the height H of the next boss and to approach again with the machine's
speed v and acceleration a, phi the angle of the way to the radius, t_cut the shortest cut worth while, kappa the shop's factor.
"""

from __future__ import annotations

import math

from trunnion.plan.casing.regions.settings import RegionSettings
from trunnion.plan.turning.gap_motion import PER_MINUTE
from trunnion.plan.turning.retract import travel_time
from trunnion.units import radians


def busy_time(height: float, settings: RegionSettings) -> float:
    """Return the time (s) that a gap is needed for: out over a height (mm), in again, and the shortest cut."""
    way = (height + settings.clearance) / math.cos(radians(settings.retract_angle))
    one = travel_time(way, settings.retract_speed * PER_MINUTE, settings.acceleration)
    return 2.0 * one + settings.shortest_cut


def shortest_gap(height: float, settings: RegionSettings) -> float:
    """Return the arc length (mm) that a gap must have beside a boss of a height (mm): the fixed one, or by the formula."""
    if settings.threshold > 0.0:
        return settings.threshold
    speed = settings.surface_speed * PER_MINUTE
    return settings.shop_factor * (speed * busy_time(height, settings) + settings.margin)


def speed_for(arc: float, height: float, settings: RegionSettings) -> float | None:
    """Return the highest speed (m/min) at which a gap of an arc length (mm) is long enough, None where that is below the lowest one or a
    length is fixed."""
    if settings.threshold > 0.0:
        return None
    speed = (arc / settings.shop_factor - settings.margin) / busy_time(height, settings)
    speed /= PER_MINUTE
    return speed if settings.lowest_speed <= speed < settings.surface_speed else None
