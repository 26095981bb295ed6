"""Materials and machines as the shop's catalogues give them."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

from trunnion.settings import added

CONTROL = "linuxcnc"
"""The control of a machine whose catalogue entry names none: the one that the program has always written for."""


@dataclass(frozen=True, slots=True, kw_only=True)
class TaylorLife:
    """Tool life by Taylor: `minutes` at `speed` vc m/min, with the exponent n of vc T^n = C.

    Where it is known how life goes with the width of cut: `width` ae over D that the minutes are for, `width_exponent`, and the smallest
    and the largest of such `widths` that were tried; beyond them life is that of the nearest one.
    """

    minutes: float
    speed: float
    exponent: float
    width: float = 1.0
    width_exponent: float = 0.0
    widths: tuple[float, float] = (0.0, 1.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class Material:
    """A work material with its starting values; every number's source stands in the catalogue.

    `speed_rough`, `speed_finish` vc m/min; `feeds` rows (diameter, fz smallest, fz largest) mm; `force` k_c1.1 N/mm2 with exponent
    `force_exponent`;
    `depth_factor` ap over D and `width_factor` ae over D for roughing, `slot_factor` ap over D up to which a cutter may be fed through a
    slot, at the feed that the spindle bears there (0: as `depth_factor`); `layer_width_factor` ae over D in layers that such slots open
    (0: as `width_factor`); `engaged_depth_factor` ap over D and `engaged_width_factor` ae over D at constant engagement (0: as
    `depth_factor` and `width_factor`), `shallow_width_factor` ae over D up to which it may be wider there in pockets that are not so deep,
    at the same section ap ae (0: no wider); `entry_angle` degrees that helices and ramps into full material go down at (0: nothing is known
    of it); `density` kg/dm3. `speed_range` vc m/min, the smallest and the largest speed that cutters bear, and `life`: None where the
    catalogue has none. `feed_share` says where between smallest and largest the tables' fz lies, `feed_range` between which such shares
    another may be chosen.
    """

    name: str
    title: str
    iso_group: str
    density: float
    speed_rough: float
    speed_finish: float
    feeds: tuple[tuple[float, float, float], ...]
    feed_share: float
    force: float
    force_exponent: float
    depth_factor: float
    width_factor: float
    source: str
    feed_range: tuple[float, float] = (0.0, 0.0)
    speed_range: tuple[float, float] | None = None
    life: TaylorLife | None = None
    slot_factor: float = 0.0
    layer_width_factor: float = 0.0
    entry_angle: float = 0.0
    engaged_depth_factor: float = 0.0
    engaged_width_factor: float = 0.0
    shallow_width_factor: float = 0.0

    @property
    def deepest_factor(self) -> float:
        """The larger of both depths of cut over D."""
        return max(self.depth_factor, self.slot_factor)

    @property
    def widest_factor(self) -> float:
        """The larger of both widths of cut over D."""
        return max(self.width_factor, self.layer_width_factor)

    @property
    def bears_deep_slots(self) -> bool:
        """Whether a slot may be deeper than a cut along a wall: where it is, a cutter on its flank may meet a corner or a notch."""
        return self.slot_factor > self.depth_factor

    @property
    def deepest_engaged_factor(self) -> float:
        """The depth of cut over D at constant engagement."""
        return self.engaged_depth_factor or self.depth_factor

    @property
    def widest_engaged_factor(self) -> float:
        """The width of cut over D at constant engagement."""
        return self.engaged_width_factor or self.width_factor


@dataclass(frozen=True, slots=True, kw_only=True)
class DrillingTable:
    """What drills or reamers bear in a group of materials, or in one: `name` is the group's or the material's.

    `speed` vc m/min; `feeds` rows (diameter, smallest, largest feed a revolution) mm, `feed_share` where between the two. Of reamers
    `allowances` are rows (diameter that a range goes up to, least, most that is left on the bore's diameter) mm.
    """

    name: str
    title: str
    speed: float
    feeds: tuple[tuple[float, float, float], ...]
    feed_share: float
    source: str
    allowances: tuple[tuple[float, float, float], ...] = added((), written=False)

    def allowance(self, diameter: float) -> tuple[float, float]:
        """Return the least and the most in mm by which a bore's diameter is smaller than the reamer of a diameter that follows."""
        for most, low, high in self.allowances:
            if diameter <= most:
                return low, high
        return self.allowances[-1][1:] if self.allowances else (0.0, 0.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class TappingTable:
    """What taps bear in a group of materials, or in one: `name` is the group's or the material's, `speed` vc in m/min.

    Their pitch feeds them.
    """

    name: str
    title: str
    speed: float
    source: str


@dataclass(frozen=True, slots=True, kw_only=True)
class ThreadMillingTable:
    """What thread mills bear in a group of materials, or in one: `name` is the group's or the material's.

    `speed` vc m/min; `feeds` rows (diameter, feed a tooth at the tip of the teeth) mm; `pass_rows` (coarsest pitch in mm, radial passes).
    """

    name: str
    title: str
    speed: float
    feeds: tuple[tuple[float, float], ...]
    pass_rows: tuple[tuple[float, int], ...]
    source: str

    def passes(self, pitch: float) -> int:
        """Return in how many radial passes a groove of a pitch (mm) is cut."""
        return next((n for most, n in self.pass_rows if pitch <= most), self.pass_rows[-1][1])


@dataclass(frozen=True, slots=True, kw_only=True)
class TurningTable:
    """What inserts bear in a group of materials, or in one: `name` is the group's or the material's.

    Speeds vc m/min, feeds mm a revolution and depths of cut ap mm of roughing and finishing.
    """

    name: str
    title: str
    speed_rough: float
    speed_finish: float
    feed_rough: float
    feed_finish: float
    depth_rough: float
    depth_finish: float
    source: str


@dataclass(frozen=True, slots=True, kw_only=True)
class WorkSpindle:
    """The table or chuck of a machine where it turns the work as a spindle: speeds 1/min, power curve (rows: 1/min, kW) and the largest
    diameter in mm that turns in it."""

    low: float
    high: float
    power: tuple[tuple[float, float], ...]
    largest_diameter: float

    def power_at(self, spindle: float) -> float:
        """Return the power in kW at a spindle speed, straight between the rows of the curve."""
        return _power_at(self.power, spindle)


@dataclass(frozen=True, slots=True, kw_only=True)
class Axis:
    """One machine axis: limits and speeds in mm, mm/min, mm/s2 (degrees for rotary ones).

    A rotary axis turns what it carries (`tool` or `work`) right-handed about `direction` (unit) as its value grows, about the line
    through `point` (mm, all axes at 0): from the middle of the table's top when it carries the work, from the middle of the spindle's face
    when it carries the tool.
    """

    name: str
    kind: str
    low: float
    high: float
    rapid: float
    acceleration: float
    direction: tuple[float, float, float] = (0.0, 0.0, 0.0)
    carries: str = ""
    point: tuple[float, float, float] = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class Machine:
    """A machine: axes, spindle with its power curve (rows: 1/min, kW), largest feed mm/min, tool-change seconds and places, control.

    `control` is the registered name of the dialect that its programs are written in. Rotary axes that carry the same side stand in the
    order from the machine's bed outwards: the second one rides on the first. A machine with a `work_spindle` turns.
    """

    name: str
    title: str
    axes: tuple[Axis, ...]
    spindle_low: float
    spindle_high: float
    power: tuple[tuple[float, float], ...]
    feed_max: float
    tool_change_s: float
    tool_places: int
    control: str = CONTROL
    work_spindle: WorkSpindle | None = added(None)

    def power_at(self, spindle: float) -> float:
        """Return the power in kW at a spindle speed, straight between the rows of the curve."""
        return _power_at(self.power, spindle)

    @property
    def rotary(self) -> tuple[Axis, ...]:
        """The rotary axes, in their order."""
        return tuple(a for a in self.axes if a.kind == "rotary")

    def axis(self, name: str) -> Axis:
        """Return the axis with a name; raise `KeyError` when there is none."""
        for a in self.axes:
            if a.name == name:
                return a
        raise KeyError(name)


def leaning_axis(machine: Machine) -> int:
    """Return which of a machine's rotary axes leans the tool: the head's where the table turns too, else the first.

    Of the two ways to hold a direction the sign of its angle says which is meant (CYCLE800's DIR, PLANE SPATIAL's SEQ).
    """
    carried = [a.carries for a in machine.rotary]
    return carried.index("tool") if len(set(carried)) > 1 else 0


def _power_at(rows: Sequence[tuple[float, float]], spindle: float) -> float:
    """Return the power in kW at a spindle speed in 1/min, straight between the rows of a curve and from nothing to its first one."""
    if spindle <= rows[0][0]:
        return rows[0][1] * spindle / rows[0][0]
    for (n0, p0), (n1, p1) in itertools.pairwise(rows):
        if spindle <= n1:
            return p0 + (p1 - p0) * (spindle - n0) / (n1 - n0)
    return rows[-1][1]
