"""Setups: from which side the part is machined, and where the program's zero lies."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Floats
from trunnion.geometry.frame import Frame
from trunnion.model.blank import Blank, Revolved
from trunnion.model.feature import Feature, Recognition
from trunnion.model.fixture import Fixture
from trunnion.model.setup import Setup
from trunnion.settings import setting, settings

AUTOMATIC = "automatic"
"""The middle of a round blank's top, which is found by its circumference, the corner of any other."""
ORIGINS = (AUTOMATIC, "corner top", "centre top", "corner bottom", "centre bottom")


@settings("setup")
class SetupSettings:
    """Where the work offset lies, how high the tool travels, and on which machine."""

    origin: str = setting(
        AUTOMATIC,
        choices=ORIGINS,
        label="Origin",
        help="Place of the program's zero on the blank, seen from the spindle; corner: smallest x and y; automatic: the centre of the top "
        "of a blank of revolution, the top's corner of others.",
    )
    clearance: float = setting(
        20.0,
        unit="mm",
        low=1.0,
        high=500.0,
        label="Clearance",
        help="Height above the blank at which the tool travels between operations.",
    )
    machine: str = setting(
        "",
        label="Machine",
        catalogue="machines",
        help="Name of a machine of the catalogue; empty: the one with the fewest axes and the least travel that the part's family and "
        "its blank need.",
    )
    next_machine: str = setting(
        "",
        label="Machine of the next setups",
        catalogue="machines",
        help="The machine of the setups after the first; empty: the same.",
    )
    work_offset: int = setting(
        54,
        unit="",
        low=54,
        high=59,
        label="Work offset",
        help="G code of the first setup's work offset; the next takes the next.",
    )


def work_offset(settings: SetupSettings, number: int) -> str:
    """Return the word of the work offset of a setup, counted from 0."""
    return f"G{min(settings.work_offset + number, 59)}"


def make_setups(
    recognition: Recognition, blank: Blank, settings: SetupSettings
) -> tuple[Setup, ...]:
    """Return one setup from above, and a second from below when a feature is reached only from there.

    The second one is the first turned about its x axis. Frames are the work offsets' (`Setup.frame`). Each is on the machine that the
    settings name for it.
    """
    first = _setup(0, blank.frame, blank, settings)
    if any(from_below(f) for f in recognition):
        return first, turned_over(blank, settings)
    return (first,)


def turned_over(blank: Blank, settings: SetupSettings, number: int = 1) -> Setup:
    """Return a setup, by its number from 0: the first one turned about its x axis."""
    over = Frame(blank.frame.origin, blank.frame.x, -blank.frame.z)
    return _setup(number, over, blank, settings)


def on_edge(
    blank: Blank, frame: Frame, direction: Floats, settings: SetupSettings, number: int
) -> Setup:
    """Return a setup, by its number from 0, that looks along a level direction (3,) out of a part in a frame: this one turned by a right
    angle about the level axis across that."""
    axis = np.cross([0.0, 0.0, 1.0], direction)
    x = axis * axis[0] + np.cross(axis, [1.0, 0.0, 0.0])
    seen = Frame(blank.frame.origin, frame.world_direction(x), frame.world_direction(direction))
    return _setup(number, seen, blank, settings)


def held(setup: Setup, fixtures: Sequence[Fixture], blank: Blank) -> Setup:
    """Return a setup with the fixtures that hold the part in it, its clearance as far above the highest of them as above the blank."""
    own = replace(setup, fixtures=tuple(fixtures))
    higher = own.top(blank) - setup.top(blank)
    return replace(own, clearance=setup.clearance + higher) if higher > 0.0 else own


def from_below(feature: Feature) -> bool:
    """Return whether a feature is reached along the recognition frame's +z, from under the part; holes that lean are not."""
    direction = feature.attributes.get("direction")
    return (
        isinstance(direction, tuple)
        and len(direction) == 3
        and bool(direction[2] <= -np.cos(tolerance.ANGLE) * np.linalg.norm(direction))
    )


def level_direction(feature: Feature) -> Floats | None:
    """Return the unit direction (3,) out of the part, in the recognition's frame, that a feature is reached from at an edge of it; None
    where it is reached from above or below, or leans."""
    direction = feature.attributes.get("direction")
    if not (isinstance(direction, tuple) and len(direction) == 3):
        return None
    out = np.array(direction, dtype=np.float64)
    out /= np.linalg.norm(out)
    return out if abs(float(out[2])) < math.sin(tolerance.ANGLE) else None


def _setup(n: int, frame: Frame, blank: Blank, settings: SetupSettings) -> Setup:
    low, high = blank.box_in(frame)
    origin = settings.origin
    if origin == AUTOMATIC:
        origin = "centre top" if isinstance(blank, Revolved) else "corner top"
    position, height = origin.split()
    zero = low if position == "corner" else 0.5 * (low + high)
    z = high[2] if height == "top" else low[2]
    offset = frame.moved(np.array([zero[0], zero[1], z]))
    return Setup(
        name=f"S{n + 1}",
        frame=offset,
        work_offset=work_offset(settings, n),
        clearance=float(high[2] - z + settings.clearance),
        machine=(settings.next_machine if n else "") or settings.machine,
    )
