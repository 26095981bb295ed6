"""What is known of a casing while its milling is planned, and the operations so far."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from trunnion.findings import Finding
from trunnion.geometry.arrays import Floats
from trunnion.geometry.mesh import Mesh
from trunnion.geometry.plane.region import Region
from trunnion.model.blank import Blank
from trunnion.model.feature import Recognition
from trunnion.model.material import Machine, Material
from trunnion.model.operation import CuttingData, Operation
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.part.part import Part
from trunnion.plan.casing.milling_settings import CasingRouteSettings
from trunnion.plan.casing.regions.settings import RegionSettings
from trunnion.plan.casing.turning_route import TurnedRoute
from trunnion.plan.contract import PartContext
from trunnion.plan.cutting.milling import CuttingSettings, cutting_data
from trunnion.plan.development.ground import DevelopedGround
from trunnion.plan.freeform.frames import UPRIGHT, Direction
from trunnion.plan.settings import RouteSettings
from trunnion.progress import Progress
from trunnion.settings import Value
from trunnion.shop import Shop, Stage


@dataclass(slots=True, kw_only=True)
class CasingPlanState:
    """What is known while a casing is planned in a setup.

    `grounds` are the bottoms laid flat, by their pockets, `hosts` of those that are recesses the pocket that each is sunk into, empty where
    that is a profile, `gaps` what of them is turned with interruptions. `next` is the setup of the part turned over, where the machine
    takes it so: for what the first one does not reach. `turned` is the turning before them, where the blank did not come turned.
    """

    part: Part
    mesh: Mesh
    context: PartContext
    recognition: Recognition
    blank: Blank
    setup: Setup
    material: Material
    machine: Machine
    shop: Shop
    route: RouteSettings
    settings: CasingRouteSettings
    cutting: CuttingSettings
    regions: RegionSettings
    progress: Progress
    next: Setup | None = None
    turned: TurnedRoute | None = None
    grounds: dict[str, DevelopedGround] = field(default_factory=dict)
    gaps: dict[str, Region] = field(default_factory=dict)
    hosts: dict[str, str] = field(default_factory=dict)
    operations: list[Operation] = field(default_factory=list)
    findings: list[Finding] = field(default_factory=list)

    def turned_over(self) -> CasingPlanState | None:
        """Return what is known in the next setup, its operations and findings the same lists; None where there is none."""
        return replace(self, setup=self.next, next=None) if self.next is not None else None

    def hosts_of(self, pocket: str) -> list[str]:
        """Return the pockets that a recess is sunk into, the nearest first; none for a bottom that runs round."""
        found = list[str]()
        while self.hosts.get(pocket):
            pocket = self.hosts[pocket]
            found.append(pocket)
        return found

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
        depth: float,
        width: float,
        faces: tuple[int, ...] = (),
        choices: dict[str, Value] | None = None,
        why: str,
        direction: Direction = UPRIGHT,
        others: tuple[str, ...] = (),
        kind: str = "",
        setup: str = "",
        data: CuttingData | None = None,
    ) -> None:
        """Add an operation of a stage, with milling data for a depth and a width (mm) of cut where no others are given; in this setup where
        none is named."""
        kind = kind or stage.kind
        if data is None:
            data = cutting_data(tool, self.material, self.machine, kind, self.cutting, depth, width)
        self.operations.append(
            Operation(
                id=f"{stage.name}-{name}".replace(" ", "-"),
                kind=kind,
                strategy=stage.strategy,
                feature=feature,
                setup=setup or self.setup.name,
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


NEARLY = 1e-9
"""What the z of an upright direction may be off 1."""
