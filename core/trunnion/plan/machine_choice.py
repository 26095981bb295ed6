"""The machine that a part is programmed for where nobody named one: the simplest and smallest of the catalogue that can make it."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from trunnion.geometry.arrays import Floats
from trunnion.model.blank import Blank
from trunnion.model.material import Machine
from trunnion.plan.setups import SetupSettings
from trunnion.shop import Shop
from trunnion.shop.kinematics import SLACK, UP, WorkPosition, rotary_solutions, words_of
from trunnion.shop.rotary_angles import TURN

_GAUGE = 150.0
"""mm from the spindle's face to the tip of a usual tool in its holder."""
_PAST = 25.0
"""mm that a tool goes past the sides of the blank: the radius of a wide one."""
_AZIMUTHS = 24
"""Directions round the part from which the travel of a leaning tool is looked at."""


def machine_for(blank: Blank, lean: float, settings: SetupSettings, shop: Shop) -> str:
    """Return the name of the machine: the chosen one, else the first that takes a blank, whose tool leans by `lean` (rad) from its z axis.

    Machines are tried by the number of their rotary axes, then by the volume that their travel makes. Where none takes the blank it is the
    largest that has the axes, or the largest of all: the planner says what it lacks.
    """
    if settings.machine:
        return settings.machine
    mills = sorted(
        (m for m in shop.machines.values() if m.work_spindle is None),
        key=lambda m: (len(m.rotary), _volume(m), m.name),
    )
    fits = (m for m in mills if takes(m, blank, lean, settings.clearance))
    leaning = [m for m in mills if bool(m.rotary) >= bool(lean)]
    largest = max(leaning or mills, key=_volume, default=None)
    machine = next(fits, largest)
    return machine.name if machine is not None else ""


def takes(machine: Machine, blank: Blank, lean: float, clearance: float) -> bool:
    """Return whether a machine's travel is enough for a blank, with the tool upright and, all round, leaning by `lean` (rad)."""
    travel = _travel(machine)
    return any(bool(np.all(need <= travel)) for need in _needs(machine, blank, lean, clearance))


def _needs(machine: Machine, blank: Blank, lean: float, clearance: float) -> Iterator[Floats]:
    """Yield the travel (3,) in mm in X, Y and Z of a tool that goes over the blank and round it, for each way to hold a leaning tool."""
    low, high = blank.box_in(blank.frame)
    upright = np.array([*(high - low)[:2], high[2] - low[2] + clearance])
    if not lean:
        yield upright
        return
    if not machine.rotary:
        return
    centre = 0.5 * (low + high)
    radius = blank.reach(centre, blank.frame) + clearance
    foot = np.array([centre[0], centre[1], low[2]])
    work = WorkPosition(machine=machine, foot=foot, centre=centre, radius=radius)
    tips, axes = _around(low, high, radius, lean)
    either, _, held = rotary_solutions(machine, axes)
    least, most = work.limits
    # Solutions may be whole turns off: the smallest angle that is not below the limit decides.
    angle = least - SLACK + np.mod(either - least + SLACK, TURN)
    allowed = np.all(angle <= most + SLACK, axis=2)
    if not (held.all() and allowed.any(axis=1).all()):
        return
    for way in (0, 1):
        taken = np.where(allowed[:, way], way, 1 - way)
        words = words_of(work, tips, angle[np.arange(len(tips)), taken], _GAUGE)
        need = np.maximum(np.ptp(words, axis=0), upright)
        yield need + np.array([2.0, 2.0, 0.0]) * _PAST


def _around(low: Floats, high: Floats, radius: float, lean: float) -> tuple[Floats, Floats]:
    """Return tips (k, 3) and unit tool axes (k, 3): tools upright and leaning outwards, all round, at the foot of what is cut and on the
    sphere of a `radius` about a box, on which they go from one direction to the next."""
    middle, wide = 0.5 * (low + high), 0.5 * float(np.max((high - low)[:2]))
    turn = np.linspace(0.0, 2.0 * math.pi, _AZIMUTHS, endpoint=False)
    out = np.stack([np.cos(turn), np.sin(turn), np.zeros(_AZIMUTHS)], axis=1)
    foot = np.array([middle[0], middle[1], low[2]]) + wide * out
    tips, axes = [], []
    for angle in (0.0, lean):
        axis = math.sin(angle) * out + math.cos(angle) * UP
        tips += [foot, middle + radius * axis]
        axes += [axis, axis]
    return np.concatenate(tips), np.concatenate(axes)


def _travel(machine: Machine) -> Floats:
    """Return the travel (3,) in mm of a machine's X, Y and Z."""
    return np.array([(axis := machine.axis(name)).high - axis.low for name in "XYZ"])


def _volume(machine: Machine) -> float:
    """Return the volume in mm3 that a machine's linear axes go through."""
    return float(np.prod(_travel(machine)))
