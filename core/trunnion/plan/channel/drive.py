"""What drives strategies in the channels of a bladed wheel: one period of it, and the angles that its path is turned by to all others.

Everything lies in the ROTOR'S FRAME, which is the cutting frame: its z is the wheel's axis, towards the inlet, its origin on the axis.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from trunnion.findings import Refused
from trunnion.geometry.arrays import Bools, Floats
from trunnion.model.blank import Blank
from trunnion.model.tool import Tool
from trunnion.plan.channel.blade_channel import BladeChannel
from trunnion.plan.channel.cut_space import CutSpace
from trunnion.plan.channel.meridian import cylindrical
from trunnion.plan.clearance import ClearanceQuery
from trunnion.plan.freeform.drive import SurfaceDrive


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ChannelDrive:
    """Channels between the blades of one period, and the surfaces of it.

    `surface` has what any surface strategy needs; its `faces` are those of the period that the operation finishes (none where it roughs).
    `channels`: those of the period; `in_channels` whether the operation goes through them. `copies` (rad): the turns about the axis that
    bring the period to all of its places, the first one 0. `tips` and `roots` are tags of faces beyond the rims of `faces`, towards the
    shroud and towards the hub, where passes begin and end. `inward` says how deep below the blank's surface points (k, 3) lie, negative
    outside. `blank` is the blank itself; `holds` says which tool axes (k, 3) the machine can hold, `fixed` whether fixtures stand there,
    `sharp` whether blades meet the hub without root fillets. `cut` is what the operations before have cut, where this one roughs.
    """

    surface: SurfaceDrive
    channels: tuple[BladeChannel, ...]
    copies: tuple[float, ...]
    blank: Blank
    inward: Callable[[Floats], Floats]
    in_channels: bool
    holds: Callable[[Floats], Bools]
    fixed: bool = False
    sharp: bool = False
    tips: tuple[int, ...] = ()
    roots: tuple[int, ...] = ()
    cut: tuple[CutSpace, ...] = ()

    @property
    def is_empty(self) -> bool:
        """Whether there is nothing to cut."""
        return not self.in_channels and not self.surface.faces

    def leaning_query(self, work: str) -> Callable[[Tool], ClearanceQuery]:
        """Return what tells for a tool which of its poses are clear; raise `Refused`, naming the work, on a machine that can't lean it."""
        if self.surface.query_for is None:
            raise Refused(
                f"{self.surface.feature}: {work} leans the tool; choose a machine with rotary axes"
            )
        return self.surface.query_for

    def rulings(self, points: Floats) -> Floats:
        """Return unit directions (k, 3) from hub to shroud at points (k, 3), along the rulings of the walls beside them."""
        rz, angle = cylindrical(points)
        uw = self.channels[0].meridian.coordinates(rz)
        u, w = uw[:, 0], np.clip(uw[:, 1], 0.0, 1.0)
        best, found = np.full(len(points), np.inf), np.zeros((len(points), 3))
        for channel in self.channels:
            low, high = channel.lower.at(u, w), channel.upper.at(u, w)
            middle = 0.5 * (low + high)
            near = middle + np.mod(angle - middle + np.pi, 2.0 * np.pi) - np.pi
            v = (near - low) / (high - low)
            off = np.maximum(np.maximum(-v, v - 1.0), 0.0)
            rows = np.flatnonzero(off < best)
            best[rows] = off[rows]
            inside = np.clip(v[rows], 0.0, 1.0)
            # What lies beyond a camber has the ruling that is there, turned to its own place.
            turn = near[rows] - channel.angle(u[rows], inside, w[rows])
            found[rows] = _turned(channel.rulings(u[rows], inside), turn)
        return found


def _turned(direction: Floats, angle: Floats) -> Floats:
    """Return directions (k, 3) turned about z by angles (k,) rad."""
    c, s = np.cos(angle), np.sin(angle)
    x, y = direction[:, 0], direction[:, 1]
    return np.column_stack([c * x - s * y, s * x + c * y, direction[:, 2]])
