"""Operations: what is cut, by which strategy, with which tool and cutting data, and the rule behind each choice."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

from trunnion.findings import Finding
from trunnion.model.guides import GuideChain
from trunnion.model.keep_out import KeepOutBox
from trunnion.model.motion.toolpath import EMPTY, Toolpath
from trunnion.model.spindle import FeedMode, SpindleMode, limited_turns, per_revolution
from trunnion.model.tool import AnyTool, Tool, rotating
from trunnion.settings import Value, added, unwritten


@dataclass(frozen=True, slots=True, kw_only=True)
class CuttingData:
    """Speeds, feeds and engagement of an operation, and what the spindle has to give for them.

    `speed` vc m/min, `spindle` 1/min, `feed_per_tooth` mm, `feed` and `plunge_feed` mm/min, `depth` ap and `width` ae mm,
    `power` and `power_limit` kW, `torque` Nm, `removal_rate` cm3/min; `rules` say where each number comes from.
    `widest` mm: what may stand in front of the cutter at once where the area says so (0: only the strategy knows); `slot_share`: share of
    its feed in full width that the spindle leaves a strategy; `peak_power` kW and `peak_torque` Nm at the largest engagement that the
    strategy can meet, and `peak_at`, in words, where that is; `routed_depth` mm: the depth that the route chose where
    the spindle allows less (0: the same); `entry_angle` degrees: the slope that the material bears helices and ramps at (0: nothing is
    known of it); `ramp_share`: what of the feed helices and ramps are gone down with (0: they plunge); of data for
    constant engagement `layer_depth` and `layer_width` mm of layers that slots open, and `layer_share` of the feed in them (0: `depth` and
    `width`); `link_share`: how many times the feed links
    through what was cleared may go at, and `fastest_link` mm/min at most (0: the feed); `thin_share`: how many times the feed a roughing
    path may go at where it cuts narrower than `width`. Where spindle speed and feed were
    chosen by the optimiser: `handbook_spindle` 1/min and `handbook_feed` mm/min of the material's tables (0 elsewhere), and `bound_by`,
    what stops a quicker choice, in words.
    Of a tool in a locked spindle `spindle` is the table's speed, `feed` the ground's under it and `feed_per_tooth` the feed in mm a turn of
    the table.
    `spindle_mode` and `feed_mode` say what a program gives of them: at a constant surface speed `spindle` is that of a rotating tool's own
    diameter, and `highest_spindle` 1/min is never passed.
    """

    speed: float
    spindle: float
    feed_per_tooth: float
    feed: float
    plunge_feed: float
    depth: float
    width: float
    removal_rate: float
    power: float
    power_limit: float
    torque: float
    rules: tuple[str, ...] = ()
    widest: float = added(0.0)
    slot_share: float = added(1.0)
    peak_power: float = added(0.0)
    peak_torque: float = added(0.0)
    peak_at: str = added("")
    routed_depth: float = added(0.0)
    spindle_mode: SpindleMode = added(SpindleMode.RPM, written=False)
    highest_spindle: float = added(0.0, written=False)
    feed_mode: FeedMode = added(FeedMode.MINUTE, written=False)
    entry_angle: float = added(0.0, written=False)
    handbook_spindle: float = added(0.0, written=False)
    handbook_feed: float = added(0.0, written=False)
    bound_by: str = added("", written=False)
    ramp_share: float = added(0.0, written=False)
    layer_depth: float = added(0.0, written=False)
    layer_width: float = added(0.0, written=False)
    layer_share: float = added(1.0, written=False)
    fastest_link: float = added(0.0, written=False)
    link_share: float = added(1.0, written=False)
    thin_share: float = added(1.0, written=False)

    def __post_init__(self) -> None:
        if self.spindle_mode is SpindleMode.SURFACE and self.highest_spindle <= 0.0:
            raise ValueError("cutting data: a constant surface speed needs a highest spindle speed")

    @property
    def feed_per_revolution(self) -> float:
        """The feed in mm a revolution."""
        return per_revolution(self.feed, self.spindle)

    def ramp_feed(self, slope: float) -> float:
        """Return the feed in mm/min along a helix or ramp of a slope (rad): its share of the feed across, while it goes down no faster than
        a plunge; a plunge's feed at least."""
        down = self.plunge_feed / math.sin(slope) if slope > 0.0 else math.inf
        return max(self.plunge_feed, min(self.ramp_share * self.feed, down))

    @property
    def link_feed(self) -> float:
        """The feed in mm/min of links through what was cleared."""
        return max(min(self.link_share * self.feed, self.fastest_link), self.feed)

    @property
    def is_engaged(self) -> bool:
        """Whether the data are for constant engagement."""
        return self.layer_depth > 0.0

    @property
    def deepest_slot(self) -> float:
        """How deep in mm the cutter may go in full width."""
        return min(self.layer_depth, self.depth) if self.is_engaged else self.depth

    @property
    def feed_gain(self) -> float:
        """How much less time the same way takes than with the tables' feed, as a share; 0 where the data are the tables'."""
        return 1.0 - self.handbook_feed / self.feed if self.handbook_feed > 0.0 else 0.0

    @property
    def highest_power(self) -> float:
        """The power in kW at steady cutting or at the largest engagement, whichever is more."""
        return max(self.power, self.peak_power)

    def spindle_at(self, diameter: float) -> float:
        """Return the spindle speed in 1/min of a rotating tool of a diameter in mm: it is the same all along a path in either mode."""
        if self.spindle_mode is SpindleMode.RPM:
            return self.spindle
        return float(limited_turns(self.speed, diameter, self.highest_spindle))

    def as_dict(self) -> dict[str, Any]:
        """Return the data as JSON has them."""
        omitted = unwritten(self)
        return {name: value for name, value in asdict(self).items() if name not in omitted}


@dataclass(frozen=True, slots=True, kw_only=True)
class Engagement:
    """The largest engagement that a strategy can meet: `width` and `depth` mm at a `share` of the feed; `at` says in words where.

    `slows`: the strategy goes slower there by `CuttingData.slot_share`, and not elsewhere.
    """

    width: float
    depth: float
    share: float
    at: str
    slows: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class Operation:
    """One operation of a setup.

    `strategy` is a registered name; `feature` the id of the feature it machines; `faces` the tags it finishes (empty for roughing);
    `choices` the values of the strategy's settings by full key; `rules` why this operation, tool and order; `after` the ids of operations
    that must come before it; `direction`, in the setup's frame, where the tool comes from (3 + 2 axes where that is not z); `by_hand` marks
    a person's change; `suppressed` keeps it in the tree without cutting; `avoid` are boxes in its cutting frame that its tip keeps out of
    (a tool that leans knows none); `others` the ids of further features that it machines with the same tool and data, as of equal holes.
    What a plan can be taught by: `planned_tool` names the cutter that the planner took where a person or a plan of the library has another
    one in its place, `own_choices` are the keys of the choices that these gave; `taught_data` marks cutting data of such a plan.
    `copy_of`: the planned operation that a person copied it from; `moved` marks that a person gave it its place, `own_faces` its faces.
    """

    id: str
    kind: str
    strategy: str
    feature: str
    setup: str
    tool: AnyTool
    data: CuttingData
    faces: tuple[int, ...] = ()
    choices: Mapping[str, Value] = field(default_factory=dict)
    rules: tuple[str, ...] = ()
    after: tuple[str, ...] = ()
    by_hand: bool = False
    suppressed: bool = False
    group: str = ""
    direction: tuple[float, float, float] = (0.0, 0.0, 1.0)
    avoid: tuple[KeepOutBox, ...] = added((), written=False)
    others: tuple[str, ...] = added((), written=False)
    planned_tool: str = added("", written=False)
    own_choices: tuple[str, ...] = added((), written=False)
    taught_data: bool = added(False, written=False)
    copy_of: str = added("", written=False)
    moved: bool = added(False, written=False)
    own_faces: bool = added(False, written=False)

    @property
    def keeps_data(self) -> bool:
        """Whether its cutting data are given, by a person or by a plan of the library, and not computed again."""
        return self.by_hand or self.taught_data

    @property
    def is_manual(self) -> bool:
        """Whether a person made, changed or moved it."""
        return self.by_hand or self.moved

    @property
    def all_features(self) -> tuple[str, ...]:
        """The ids of all features that it machines."""
        return (self.feature, *self.others)

    @property
    def cutter(self) -> Tool:
        """The tool where it rotates; raises `BadInput` for a turning tool."""
        return rotating(self.tool, self.id)

    @property
    def spindle(self) -> float:
        """The spindle speed in 1/min; where turning work keeps its surface speed, the highest; 0 of a spindle that is locked."""
        data = self.data
        if self.tool.locked:
            return 0.0
        if self.tool.rotates:
            return data.spindle_at(self.cutter.diameter)
        return data.highest_spindle if self.surface_speed > 0.0 else data.spindle

    @property
    def surface_speed(self) -> float:
        """The speed in m/min that the surface of turning work keeps; 0 where the spindle's is kept."""
        kept = not self.tool.rotates and self.data.spindle_mode is SpindleMode.SURFACE
        return self.data.speed if kept else 0.0


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class OperationPath:
    """The toolpath of one operation, the areas it leaves (in words) and the digest of what it was made from.

    `stock_box` is where the stock was looked at for it, mm: least x and y, greatest x and y, or nothing for all of it; `stock_key` the
    digest of the stock there. `guides` are the guide lines that led it, by the faces that they are on.

    `power` kW, `rate` cm3/min and `chip` mm are the highest that its own motions come to, by what they take off the stock as it is planned:
    0 where that isn't known, of a tool that leans.
    """

    operation: str
    path: Toolpath = EMPTY
    findings: tuple[Finding, ...] = ()
    key: str = ""
    power: float = added(0.0)
    rate: float = added(0.0)
    chip: float = added(0.0)
    stock_box: tuple[float, ...] = added((), written=False)
    stock_key: str = added("", written=False)
    guides: tuple[GuideChain, ...] = added((), written=False)
