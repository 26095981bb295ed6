"""A wheel without CAD: hub and shroud are quarter circles, blades thin, straight in the meridian and swept back round the axis."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import RegularGridInterpolator

from trunnion.plan.channel.blade_channel import NO_TOE, U_BEYOND, BladeChannel, Camber
from trunnion.plan.channel.meridian import MeridianSpline, WheelMeridian
from trunnion.toolpath.contact_passes.linking.sphere_links import SphereLinkParameters
from trunnion.toolpath.motion.reorient import ClearanceSphere

SPHERE = ClearanceSphere(centre=np.zeros(3), radius=50.0)
HUB_RADIUS, SHROUD_RADIUS = 30.0, 20.0
"""mm: radii of the quarter circles in the meridian, both about (40, 32)."""
SWEEP, HALF_THICK = 0.6, 0.03
"""rad that blades go round the axis from inlet to outlet, and their half thickness."""


def quarter(radius: float) -> MeridianSpline:
    turn = np.linspace(np.pi, 1.5 * np.pi, 40)
    return MeridianSpline(
        rows=np.column_stack([40.0 + radius * np.cos(turn), 32.0 + radius * np.sin(turn)])
    )


def meridian() -> WheelMeridian:
    return WheelMeridian(hub=quarter(HUB_RADIUS), shroud=quarter(SHROUD_RADIUS))


def camber(angle: float = 0.0) -> Camber:
    """Return a camber that is swept back by the same angle at hub and shroud."""
    u, w = np.linspace(-U_BEYOND, 1.0 + U_BEYOND, 31), np.linspace(0.0, 1.0, 5)
    values = angle - SWEEP * np.repeat(u[:, None], len(w), axis=1)
    nets = [RegularGridInterpolator((u, w), values + off) for off in (0.0, -HALF_THICK, HALF_THICK)]
    return Camber(angle=nets[0], sides=(nets[1], nets[2]), toes=(NO_TOE, NO_TOE))


def channel(count: int = 9) -> BladeChannel:
    """Return the channel between two of so many blades."""
    return BladeChannel(meridian=meridian(), lower=camber(), upper=camber(2.0 * np.pi / count))


def links_round(near: float) -> SphereLinkParameters:
    """Return links round a sphere of 50 mm about the origin, where every pose is clear."""
    return SphereLinkParameters(
        near=near,
        turn=0.5,
        feed=1000.0,
        link_feed=500.0,
        sphere=SPHERE,
        retreat=lambda tip, axis: 4.0,
        query=lambda tip, axis, **_: np.ones(len(tip), dtype=bool),
    )
