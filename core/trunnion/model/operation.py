"""Operations: what is cut, by which strategy, with which tool and cutting data, and the rule behind each choice."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from trunnion.findings import Finding
from trunnion.model.tool import Tool
from trunnion.model.toolpath import EMPTY, Toolpath
from trunnion.settings import Value, added


@dataclass(frozen=True, slots=True, kw_only=True)
class CuttingData:
    """Speeds, feeds and engagement of an operation, and what the spindle has to give for them.

    `speed` vc m/min, `spindle` 1/min, `feed_per_tooth` mm, `feed` and `plunge_feed` mm/min, `depth` ap and `width` ae mm,
    `power` and `power_limit` kW, `torque` Nm, `removal_rate` cm3/min; `rules` say where each number comes from.
    `widest` mm: what may stand in front of the cutter at once where the area says so (0: only the strategy knows); `slot_share`: share of
    its feed in full width that the spindle leaves a strategy; `peak_power` kW and `peak_torque` Nm at the largest engagement that the
    strategy can meet, and `peak_at`, in words, where that is; `routed_depth` mm: the depth that the route chose where
    the spindle allows less (0: the same).
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

    @property
    def highest_power(self) -> float:
        """The power in kW at steady cutting or at the largest engagement, whichever is more."""
        return max(self.power, self.peak_power)


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
    a person's change; `suppressed` keeps it in the tree without cutting.
    """

    id: str
    kind: str
    strategy: str
    feature: str
    setup: str
    tool: Tool
    data: CuttingData
    faces: tuple[int, ...] = ()
    choices: Mapping[str, Value] = field(default_factory=dict)
    rules: tuple[str, ...] = ()
    after: tuple[str, ...] = ()
    by_hand: bool = False
    suppressed: bool = False
    group: str = ""
    direction: tuple[float, float, float] = (0.0, 0.0, 1.0)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class OperationPath:
    """The toolpath of one operation, the areas it leaves (in words) and the digest of what it was made from."""

    operation: str
    path: Toolpath = EMPTY
    findings: tuple[Finding, ...] = ()
    key: str = ""
