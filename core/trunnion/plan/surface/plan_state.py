"""What is known of a part of curved surfaces while one setup of it is planned, and the operations so far."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from trunnion.findings import BadInput, Finding
from trunnion.model.feature import Recognition
from trunnion.model.material import Machine, Material
from trunnion.model.operation import Operation
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.plan.clearance import ClearanceScene
from trunnion.plan.cutting.milling import CuttingSettings, cutting_data
from trunnion.plan.freeform.space import SurfaceSpace
from trunnion.plan.settings import RouteSettings
from trunnion.plan.setups.frames import UPRIGHT, Direction
from trunnion.plan.surface.settings import SurfaceRouteSettings
from trunnion.settings import Value, choose
from trunnion.shop import Shop, Stage


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RoughingSide:
    """What has been roughed from a direction: down to which height (mm) in its cutting frame, with which smallest cutter."""

    space: SurfaceSpace
    bottom: float
    tool: Tool


@dataclass(slots=True)
class SurfacePlanState:
    """What is known while one setup is planned; `unsampled` are the faces so small that no position of their area lies on them, `hanging`
    the hidden ones that are no hollows; `has_overhangs`: some face hangs over."""

    space: SurfaceSpace
    around: ClearanceScene
    setup: Setup
    recognition: Recognition
    material: Material
    machine: Machine
    shop: Shop
    route: RouteSettings
    settings: SurfaceRouteSettings
    stages: dict[str, Stage]
    operations: list[Operation] = field(default_factory=list)
    findings: list[Finding] = field(default_factory=list)
    unsampled: set[int] = field(default_factory=set)
    hanging: set[int] = field(default_factory=set)
    has_overhangs: bool = False
    roughing_sides: list[RoughingSide] = field(default_factory=list)

    def cutters(self, use: str) -> tuple[Tool, ...]:
        """Return the catalogue's cutters for a use and the blank's material."""
        return self.shop.tools_for(self.material.iso_group, use)

    def first_feature(self) -> str:
        """Return the id of the first feature; raise `BadInput` when nothing was recognised."""
        if not self.recognition.features:
            raise BadInput("nothing was recognised on this part: there is nothing to plan")
        return self.recognition.features[0].id

    def feature_of(self, tags: Sequence[int]) -> str:
        """Return the feature that has most of some faces."""
        return max(self.recognition, key=lambda f: len(set(f.tags) & set(tags))).id

    def add(
        self,
        kind: str,
        name: str,
        feature: str,
        tool: Tool,
        tags: tuple[int, ...],
        depth: float,
        width: float,
        choices: dict[str, Value],
        rules: tuple[str, ...],
        *,
        strategy: str = "",
        operation_kind: str = "",
        direction: Direction = UPRIGHT,
    ) -> None:
        """Add an operation of the stage of a kind, with data for a depth and a width (mm) of cut."""
        stage = self.stages[kind]
        data = cutting_data(
            tool,
            self.material,
            self.machine,
            operation_kind or kind,
            choose(CuttingSettings, {}),
            depth,
            width,
        )
        self.operations.append(
            Operation(
                id=f"{kind.replace('_', '-')}-{name}",
                kind=operation_kind or kind,
                strategy=strategy or stage.strategy,
                feature=feature,
                setup=self.setup.name,
                tool=tool,
                data=data,
                faces=tags,
                choices=choices,
                rules=rules,
                group=stage.name,
                direction=direction,
            )
        )


def face_name(tags: Sequence[int]) -> str:
    """Return the name of an operation on faces, by the first of them."""
    return f"face-{tags[0]}"
