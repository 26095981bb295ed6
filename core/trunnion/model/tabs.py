"""Tabs: bridges of material that hold a part in the frame of its blank while its outline is cut, and are cut off by hand afterwards."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from trunnion.findings import BadInput
from trunnion.geometry.arrays import Floats
from trunnion.settings import Value

POSITIONS, WIDTH, HEIGHT, RAMP = (
    f"profile.tabs.{name}" for name in ("placed", "width", "height", "ramp_angle")
)
"""Keys of an operation's choices that hold its tabs: where they are (`written`), their width and height in mm, the slope of their ends in
degrees."""
DECIMALS = 4
"""Decimals of positions (mm) and directions (degrees) in an operation's choices: those of posted programs."""
NUMBERS = 5
"""Numbers of one tab in an operation's choices: x, y, z, direction, reach."""

TabRow: TypeAlias = tuple[float, float, float, float, float]
"""One tab as `written` has it: x, y, z of its middle (mm), its direction (degrees), its reach (mm)."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Tab:
    """A bridge between a part's outline and the frame of its blank, in the setup's frame.

    `middle` (x, y) mm lies on the outline, on a straight piece of it; `direction` is the angle from x of the way outwards, radians. The
    bridge is a box `width` mm along the outline, `reach` mm outwards (as wide as the channel that is cut around the part), from `bottom`
    up to `top`, mm. `ramp` is the slope in radians at which cutters rise to its top and come down from it.
    """

    middle: tuple[float, float]
    direction: float
    width: float
    reach: float
    bottom: float
    top: float
    ramp: float

    @property
    def height(self) -> float:
        """How thick the bridge is, mm."""
        return self.top - self.bottom

    @property
    def volume(self) -> float:
        """Volume of the bridge in mm3, without what round cutters leave beside it."""
        return self.width * self.reach * self.height

    @property
    def run(self) -> float:
        """How long a ramp from its bottom to its top is in plan, mm."""
        return self.height / math.tan(self.ramp)

    def half_length(self, radius: float, z: float) -> float:
        """Return how far from its middle along the outline a cutter of a radius leaves material at a height z: where it touches the wall.

        The axis is kept `radius` off the bridge at its top, and one ramp farther off at its bottom.
        """
        return 0.5 * self.width + radius + (self.top - z) / math.tan(self.ramp)

    def local(self, points: Floats) -> Floats:
        """Return for points (k, 2 or more) in the setup's frame how far they are along the outline and outwards (k, 2)."""
        c, s = math.cos(self.direction), math.sin(self.direction)
        away = points[:, :2] - np.array(self.middle)
        return np.stack([away @ np.array([-s, c]), away @ np.array([c, s])], axis=1)

    def world(self, local: Floats) -> Floats:
        """Return the points (k, 2) in the setup's frame that are so far along the outline and outwards (k, 2)."""
        c, s = math.cos(self.direction), math.sin(self.direction)
        moved: Floats = np.array(self.middle) + local @ np.array([[-s, c], [c, s]])
        return moved

    def distance(self, points: Floats) -> Floats:
        """Return how far points (k, 2) are from the bridge in plan, mm; 0 inside."""
        local = self.local(points)
        sideways = np.maximum(np.abs(local[:, 0]) - 0.5 * self.width, 0.0)
        outwards = np.maximum(np.maximum(-local[:, 1], local[:, 1] - self.reach), 0.0)
        return np.hypot(sideways, outwards)


@dataclass(frozen=True, slots=True, kw_only=True)
class PlannedTab:
    """A tab that a plan leaves: its setup's name, and the radius in mm of the cutter that finishes the outline beside it."""

    setup: str
    tab: Tab
    radius: float


def written(rows: Iterable[TabRow]) -> str:
    """Return where tabs are as an operation's choices keep it.

    >>> written([(10.0, 0.0, -20.0, -90.0, 28.5)])
    '10.0 0.0 -20.0 -90.0 28.5'
    """
    return "; ".join(" ".join(str(round(v, DECIMALS) + 0.0) for v in row) for row in rows)


def tabs_of(choices: Mapping[str, Value], name: str) -> tuple[Tab, ...]:
    """Return the tabs that an operation leaves, from its choices; `name` is the operation's, for the message.

    Raises `BadInput` where the choices do not say them.
    """
    text = choices.get(POSITIONS, "")
    if not text:
        return ()
    try:
        width, height, ramp = (float(choices[key]) for key in (WIDTH, HEIGHT, RAMP))
        rows = [[float(v) for v in row.split()] for row in str(text).split(";")]
    except (KeyError, ValueError):
        rows = [[]]
    if not all(len(row) == NUMBERS and np.isfinite(row).all() for row in rows):
        raise BadInput(
            f"{name}: its tabs ({POSITIONS} = {text}) are not x, y, z, direction and reach of each, with width, height and ramp angle; "
            "plan the route again"
        )
    return tuple(
        Tab(
            middle=(x, y),
            direction=math.radians(angle),
            width=width,
            reach=reach,
            bottom=z,
            top=z + height,
            ramp=math.radians(ramp),
        )
        for x, y, z, angle, reach in rows
    )
