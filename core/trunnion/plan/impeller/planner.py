"""The planner of impellers."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from trunnion import tolerance
from trunnion.findings import Finding, Refused, error
from trunnion.geometry.frame import WORLD
from trunnion.model.operation import Operation
from trunnion.model.process import ProcessTree
from trunnion.plan.channel.drive import ChannelDrive
from trunnion.plan.contract import DriveNeeds, OperationDrive, RouteJob, Scene, driven_by
from trunnion.plan.cutting.milling import CuttingSettings
from trunnion.plan.feasibility import both_sides, refuse_open, too_large, without_axes
from trunnion.plan.freeform.drive import SurfaceDrive
from trunnion.plan.freeform.surface_drives import surface_driven
from trunnion.plan.holes.drive import HoleDrive, holes_driven
from trunnion.plan.holes.settings import HOLE_SETTINGS
from trunnion.plan.impeller.cutters import sizes_of
from trunnion.plan.impeller.drives import channel_driven
from trunnion.plan.impeller.route import CUTTER_RULES, ImpellerPlanState, make_impeller_route
from trunnion.plan.impeller.settings import ImpellerRouteSettings
from trunnion.plan.impeller.wheel import wheel_of
from trunnion.plan.process import process_of
from trunnion.plan.settings import RouteSettings
from trunnion.plan.setups import SetupSettings
from trunnion.plan.typical import typical_plan
from trunnion.progress import Progress

if TYPE_CHECKING:
    from trunnion.part.part import Part

NEEDS_AXES = "channels between blades are milled by a tool that leans"
"""Why a machine without rotary axes is refused."""
LEAN = 60.0
"""Degrees: how far tools lean from the axis of usual wheels, where channels turn outwards."""


class ImpellerPlanner:
    """Plans the channels of one period of a wheel and the holes beside its bore; what is turned before is told."""

    name, noun = "impeller", "impellers"
    settings: tuple[type, ...] = (
        RouteSettings,
        ImpellerRouteSettings,
        *HOLE_SETTINGS,
    )
    cutter_rules: tuple[str, ...] = CUTTER_RULES
    skins: tuple[float, ...] = (tolerance.CHORD,)
    lean = math.radians(LEAN)

    def can_plan(self, part: Part) -> None:
        """Raise `BadInput` for faces that enclose no material."""
        refuse_open(part.is_closed)

    def route(self, job: RouteJob) -> ProcessTree:
        """Return the process by `make_impeller_route`, or why the blank fits no machine."""
        route, cutting = job.settings_of(RouteSettings), job.settings_of(CuttingSettings)
        plan = typical_plan(job.shop, job.recognition.family, route.plan, CUTTER_RULES)
        material = job.shop.material(job.blank.material)
        job.progress.at(0.0, "looking at the wheel")
        findings = too_large(job.blank, job.setups, job.shop) or without_axes(
            job.recognition, job.setups, job.shop, NEEDS_AXES
        )
        if not findings:
            skin = job.context.skin(tolerance.CHORD, job.progress)
            skin = skin.moved(WORLD, job.recognition.frame)
            try:
                wheel = wheel_of(job.recognition, skin)
            except Refused as reason:
                findings = [_not_planned(job, str(reason), "correct the features")]
        if findings:
            return process_of(
                (), findings, plan=plan, material=material, setups=job.setups, shop=job.shop
            )
        setup, *others = both_sides(job.setups, job.blank, job.shop, job.settings_of(SetupSettings))
        state = ImpellerPlanState(
            part=job.context.part,
            context=job.context,
            recognition=job.recognition,
            blank=job.blank,
            setup=setup,
            material=material,
            machine=job.shop.machine(setup.machine),
            shop=job.shop,
            route=route,
            cutting=cutting,
            choices=job.choices,
            progress=job.progress,
            next=others[0] if others else None,
            wheel=wheel,
            sizes=sizes_of(wheel, skin),
            settings=job.settings_of(ImpellerRouteSettings),
        )
        return make_impeller_route(state, plan)

    def drive(
        self, operation: Operation, needs: DriveNeeds, scene: Scene, progress: Progress
    ) -> OperationDrive:
        """Return the drive that an operation's strategy needs."""
        return driven_by(
            {
                ChannelDrive: channel_driven,
                SurfaceDrive: surface_driven,
                HoleDrive: holes_driven,
            },
            self,
            operation,
            needs,
            scene,
            progress,
        )


def _not_planned(job: RouteJob, text: str, remedy: str) -> Finding:
    return error("route.not-planned", text, *(f.id for f in job.recognition), remedy=remedy)
