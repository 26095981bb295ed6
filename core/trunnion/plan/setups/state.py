"""What is known while a part is planned in a setup, and the operations so far: what planners of whole parts share."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Self

from trunnion.findings import Finding
from trunnion.geometry.arrays import Floats
from trunnion.model.blank import Blank
from trunnion.model.feature import Recognition
from trunnion.model.material import Machine, Material
from trunnion.model.operation import CuttingData, Operation
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.part.part import Part
from trunnion.plan.contract import PartContext
from trunnion.plan.cutting.milling import CuttingSettings, cutting_data
from trunnion.plan.prismatic.regions import SetupSpace
from trunnion.plan.settings import RouteSettings
from trunnion.plan.setups.flip import turned
from trunnion.plan.setups.frames import UPRIGHT, Direction
from trunnion.progress import Progress
from trunnion.settings import Value
from trunnion.shop import Shop, Stage

NEARLY = 1e-9
"""What the z of an upright direction may be off 1."""


@dataclass(slots=True, kw_only=True)
class SetupPlanState:
    """What is known while a part is planned in a setup.

    `choices` are a session's settings by full key. `next` is the setup of the part turned over, where the machine takes it so: for what
    the first one does not reach.
    """

    part: Part
    context: PartContext
    recognition: Recognition
    blank: Blank
    setup: Setup
    material: Material
    machine: Machine
    shop: Shop
    route: RouteSettings
    cutting: CuttingSettings
    choices: Mapping[str, Value]
    progress: Progress
    next: Setup | None = None
    operations: list[Operation] = field(default_factory=list)
    findings: list[Finding] = field(default_factory=list)

    def turned_over(self) -> Self | None:
        """Return what is known in the next setup, its operations and findings the same lists; None where there is none."""
        if self.next is None:
            return None
        machine = self.shop.machine(self.next.machine)
        return replace(self, setup=self.next, machine=machine, next=None)

    def cutters(self, use: str) -> list[Tool]:
        """Return the catalogue's cutters for a use and the blank's material."""
        return list(self.shop.tools_for(self.material.iso_group, use))

    def direction(self, out: Floats) -> Direction:
        """Return a direction of the part's coordinates in the setup's frame, upright where it is by less than what parallel means."""
        local = self.setup.frame.local_direction(out)
        x, y, z = (float(v) for v in local)
        return UPRIGHT if z > 1.0 - NEARLY else (x, y, z)

    def add(
        self,
        stage: Stage,
        name: str,
        feature: str,
        tool: Tool,
        *,
        depth: float = 0.0,
        width: float = 0.0,
        faces: tuple[int, ...] = (),
        choices: dict[str, Value] | None = None,
        why: str,
        direction: Direction = UPRIGHT,
        others: tuple[str, ...] = (),
        kind: str = "",
        data: CuttingData | None = None,
    ) -> None:
        """Add an operation of a stage, with milling data for a depth and a width (mm) of cut where no others are given."""
        kind = kind or stage.kind
        if data is None:
            data = cutting_data(tool, self.material, self.machine, kind, self.cutting, depth, width)
        self.operations.append(
            Operation(
                id=f"{stage.name}-{name}".replace(" ", "-"),
                kind=kind,
                strategy=stage.strategy,
                feature=feature,
                setup=self.setup.name,
                tool=tool,
                data=data,
                faces=faces,
                choices=choices or {},
                rules=(stage.rule, why),
                group=stage.name,
                direction=direction,
                others=others,
            )
        )

    def used_setups(self, before: Sequence[Setup] = ()) -> tuple[Setup, ...]:
        """Return setups that came before and those of this plan that cut anything, or the first, and tell how the part is turned from one
        to the next."""
        used = {o.setup for o in self.operations}
        own = [s for s in (self.setup, self.next) if s is not None and s.name in used]
        setups = (*before, *(own or ([] if before else [self.setup])))
        for first, second in pairwise(setups):
            spaces = (
                SetupSpace.of(self.part, self.recognition, s.begins_with(self.blank), s)
                for s in (first, second)
            )
            self.findings.append(turned(*spaces))
        return setups
