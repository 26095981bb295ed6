"""Plans the turning of one setup: tools, data and what each operation leaves, one after the other, as the stages of a typical plan say."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from shapely.geometry.base import BaseGeometry

from trunnion.findings import Finding, warning
from trunnion.model.material import Material, TurningTable, WorkSpindle
from trunnion.model.operation import Operation
from trunnion.model.setup import Setup
from trunnion.model.tool import TurningTool
from trunnion.plan.cutting.milling import CuttingSettings
from trunnion.plan.cutting.turning import TURNING_FINISH, TURNING_ROUGH, turning_data
from trunnion.plan.turning.contour_spans import contour_spans, stock_after
from trunnion.plan.turning.drive import LEAST_AREA
from trunnion.plan.turning.reach import TurningLimits, TurningReach, reach_of
from trunnion.plan.turning.settings import MOST_LAYERS, TurningSettings
from trunnion.plan.turning.tools import bars_that_fit, candidates
from trunnion.plan.turning.view import TurningSide
from trunnion.shop import Stage
from trunnion.units import trimmed

FACE, OUTSIDE, BACK, INSIDE = "turn_face", "turn_outside", "turn_back", "turn_inside"
RULES: Mapping[str, tuple[TurningSide, str]] = {
    FACE: (TurningSide.FACE, "right"),
    OUTSIDE: (TurningSide.OUTSIDE, "right"),
    BACK: (TurningSide.OUTSIDE, "left"),
    INSIDE: (TurningSide.INSIDE, "right"),
}
"""The words of a typical plan for the tool of a turning stage: its side and hand."""
CLEARANCE = 2.0
"""mm that a boring bar keeps from the far side of its bore."""


@dataclass(slots=True, kw_only=True)
class SetupTurning:
    """A setup while its turning is planned: `part` and `stock` are meridians (r, z) in its frame, the stock's as the operations so far
    leave it; `limits` say how low tools go."""

    setup: Setup
    part: BaseGeometry
    stock: BaseGeometry
    limits: TurningLimits
    tools: Sequence[TurningTool]
    material: Material
    table: TurningTable
    spindle: WorkSpindle
    cutting: CuttingSettings
    settings: TurningSettings
    operations: list[Operation] = field(default_factory=list)
    findings: list[Finding] = field(default_factory=list)
    cut: list[BaseGeometry] = field(default_factory=list)

    def limits_for(self, side: TurningSide) -> TurningLimits:
        """Return how low tools go from a side: a face is turned to the part's own end."""
        top = float(self.part.bounds[3])
        return (
            TurningLimits(floor=self.limits.floor, lowest=top)
            if side is TurningSide.FACE
            else self.limits
        )

    def plan(self, stage: Stage, feature: str) -> None:
        """Add the operations of a stage: its first tool takes what it can, each of the others what is left that only it reaches."""
        side, hand = RULES[stage.cutter]
        tools = self._bars() if side is TurningSide.INSIDE else self.tools
        fitting = candidates(tools, side, hand, finish=stage.finish)
        limits = self.limits_for(side)
        allowance = self.settings.finish_allowance if stage.finish else self.settings.allowance
        for tool in fitting:
            reach = reach_of(tool, side, self.part, limits, self.stock, allowance=allowance)
            self._add(stage, feature, tool, reach, side, limits)

    def _bars(self) -> list[TurningTool]:
        """Return the boring bars that go in; where there is none a finding is added."""
        bore, depth = float(self.stock.bounds[0]), float(self.stock.bounds[3]) - self.limits.lowest
        inside = [t for t in self.tools if t.inside]
        bars = bars_that_fit(inside, bore, depth, CLEARANCE)
        if not bars and not any(f.code == "route.no-boring-bar" for f in self.findings):
            what = (
                f"no boring bar of the catalogue goes into a bore of {trimmed(2.0 * bore, 1)} mm and reaches {trimmed(depth, 1)} mm deep"
                if bore > 0.0
                else "the blank has no bore to turn from"
            )
            self.findings.append(
                warning(
                    "route.no-boring-bar",
                    f"{self.setup.name}: {what}; its inside is not turned",
                    self.setup.name,
                    remedy="add a boring bar to the turning folder"
                    if bore > 0.0
                    else "choose a blank that is bored (blank.bored = yes)",
                )
            )
        return bars

    def _add(
        self,
        stage: Stage,
        feature: str,
        tool: TurningTool,
        reach: TurningReach,
        side: TurningSide,
        limits: TurningLimits,
    ) -> None:
        """Add an operation with a tool, unless it takes nothing."""
        left = self._left(reach, finish=stage.finish)
        taken = self.stock.area - left.area
        chips = self.stock.difference(left)
        # What finishing takes in one pass is not worth a roughing tool.
        if taken <= LEAST_AREA or (
            not stage.finish and chips.buffer(-self.table.depth_finish).is_empty
        ):
            return
        data = turning_data(
            tool,
            self.material,
            self.table,
            self.spindle,
            self.cutting,
            finish=stage.finish,
            radius=float(chips.bounds[2]),
        )
        count = sum(1 for o in self.operations if o.group == stage.name)
        name = f"{stage.name} {self.setup.name}" + (f" {count + 1}" if count else "")
        self.operations.append(
            Operation(
                id=name.replace(" ", "-"),
                kind=TURNING_FINISH if stage.finish else TURNING_ROUGH,
                strategy=stage.strategy,
                feature=feature,
                setup=self.setup.name,
                tool=tool,
                data=data,
                rules=(
                    stage.rule,
                    f"{tool.name} takes {trimmed(taken, 1)} mm2 of the meridian.",
                ),
                group=stage.name,
                choices={
                    "turn.side": side.value,
                    "turn.lowest": limits.lowest,
                    "turn.floor": limits.floor,
                },
            )
        )
        self.stock = left
        self.cut.append(chips)

    def _left(self, reach: TurningReach, *, finish: bool) -> BaseGeometry:
        """Return what an operation leaves: roughing layers all but what its tool doesn't reach, finishing what is too thick for it too."""
        if not finish:
            return reach.cut_from(self.stock)
        seen = reach.view.shape_seen(self.stock)
        passes = contour_spans(
            reach,
            seen,
            bridge=self.settings.bridge,
            beyond=self.settings.clearance,
            most=MOST_LAYERS * self.table.depth_finish,
        )
        return reach.view.shape_back(stock_after(reach, seen, passes))
