"""A taught plan: the order of work of a finished part, with its cutters, choices and cutting data, for parts like it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from trunnion.settings import Value, digest
from trunnion.shop.library.signature import PartSignature
from trunnion.shop.plans import Stage, TypicalPlan


@dataclass(frozen=True, slots=True, kw_only=True)
class TaughtOperation:
    """What a taught plan does in a stage on features of a kind (empty: on no feature) where a planner takes the cutter `planned`.

    `tool` is the cutter in its place, most often the same; `choices` are the strategy's settings that a person gave, by full key; `spindle`
    1/min and `feed` mm/min are those set by hand, 0 where they follow from tables. `count` is how many operations of the part were so.
    """

    stage: str
    kind: str
    planned: str
    tool: str
    choices: Mapping[str, Value] = field(default_factory=dict)
    spindle: float = 0.0
    feed: float = 0.0
    count: int = 1


@dataclass(frozen=True, slots=True, kw_only=True)
class TaughtPlan:
    """A plan as a finished part has taught it.

    `date` is given by who adds it; `part` names the part, `part_digest` is that of its file (`PartInfo`), `base` names the typical plan
    that it was made from. `stages` are in the order of work, without those that were suppressed. `settings` are the part's settings of
    route and strategies that are not the defaults, by full key.
    """

    name: str
    date: str
    part: str
    part_digest: str
    base: str
    signature: PartSignature
    stages: tuple[Stage, ...]
    operations: tuple[TaughtOperation, ...]
    settings: Mapping[str, Value] = field(default_factory=dict)

    @property
    def family(self) -> str:
        """The family of its part."""
        return self.signature.family

    @property
    def digest(self) -> str:
        """A short stable digest of all that a route takes from it."""
        return digest(self.name, self.stages, self.operations, dict(self.settings))

    def typical(self) -> TypicalPlan:
        """Return its stages as a typical plan that a planner follows."""
        return TypicalPlan(
            name=self.name, title=f"taught by {self.part}", family=self.family, stages=self.stages
        )

    def of_stage(self, stage: str, kind: str) -> tuple[TaughtOperation, ...]:
        """Return what it does in a stage on features of a kind."""
        return tuple(o for o in self.operations if o.stage == stage and o.kind == kind)
