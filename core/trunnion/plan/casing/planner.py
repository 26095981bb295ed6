"""The planner of casings."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from trunnion import tolerance
from trunnion.findings import Finding, Severity
from trunnion.model.operation import Operation
from trunnion.model.process import ProcessTree
from trunnion.model.session import SizeEntry
from trunnion.plan.casing.drives import bores_driven, gaps_driven, plane_driven, sides_driven
from trunnion.plan.casing.grounds import fine_mesh
from trunnion.plan.casing.milling_settings import CasingRouteSettings
from trunnion.plan.casing.plan_state import CasingPlanState
from trunnion.plan.casing.regions.settings import RegionSettings
from trunnion.plan.casing.route import CUTTER_RULES, make_casing_route
from trunnion.plan.casing.turning_route import after_turning, plan_turned, revolved_driven
from trunnion.plan.contract import DriveNeeds, OperationDrive, RouteJob, Scene, driven_by
from trunnion.plan.cutting.milling import CuttingSettings
from trunnion.plan.feasibility import both_sides, refuse_open, too_large, without_axes
from trunnion.plan.freeform.drive import SurfaceDrive
from trunnion.plan.holes.drive import HoleDrive
from trunnion.plan.holes.settings import HOLE_SETTINGS
from trunnion.plan.prismatic.drive import PlaneDrive
from trunnion.plan.process import process_of
from trunnion.plan.settings import RouteSettings
from trunnion.plan.setups import SetupSettings, make_setups
from trunnion.plan.size import PART
from trunnion.plan.turning.drive import RevolvedDrive
from trunnion.plan.turning.gap_drive import GapDrive
from trunnion.plan.turning.settings import TurningSettings
from trunnion.plan.typical import typical_plan
from trunnion.progress import Progress

if TYPE_CHECKING:
    from trunnion.part.part import Part

NEEDS_AXES = "bosses are milled along their own normals"
LEAN = 90.0
"""Degrees: how far tools lean from the axis of the ring, along the normals of its bosses."""
LEANING = f" that leans the tool by {LEAN:.0f} degrees"
"""Why a machine without rotary axes is refused, and what they must do."""

DIAMETERS, WALL = ("smallest_diameter", "largest_diameter"), "wall_thickness"
"""Names of the sizes that casings are compared by."""


class CasingPlanner:
    """Plans the milled side of a casing: bottoms laid flat, bosses along their normals, holes along their axes."""

    name, noun = "casing", "casings"
    settings: tuple[type, ...] = (
        RouteSettings,
        CasingRouteSettings,
        TurningSettings,
        RegionSettings,
        *HOLE_SETTINGS,
    )
    cutter_rules: tuple[str, ...] = CUTTER_RULES
    skins: tuple[float, ...] = (tolerance.CHORD, tolerance.SKIN_CHORD)
    lean = math.radians(LEAN)

    def principal_sizes(self, sizes: Sequence[SizeEntry]) -> Mapping[str, float]:
        """Return the largest and the smallest diameter, the length along the axis and the thinnest wall (mm) of a casing."""
        diameters = [e.value for e in sizes if e.name in DIAMETERS]
        walls = [e.value for e in sizes if e.name == WALL]
        lengths = [e.value for e in sizes if e.feature == PART and e.name == "height"]
        found = {
            "largest_diameter": max(diameters, default=0.0),
            "smallest_diameter": min(diameters, default=0.0),
            "length": max(lengths, default=0.0),
            WALL: min(walls, default=0.0),
        }
        return {name: value for name, value in found.items() if value > 0.0}

    def can_plan(self, part: Part) -> None:
        """Raise `BadInput` for faces that enclose no material."""
        refuse_open(part.is_closed)

    def route(self, job: RouteJob) -> ProcessTree:
        """Return the process by `make_casing_route`, or why the blank fits no machine."""
        route = job.settings_of(RouteSettings)
        plan = typical_plan(job.shop, job.recognition.family, route.plan, CUTTER_RULES)
        material = job.shop.material(job.blank.material)
        turned = plan_turned(replace(job, progress=job.progress.part(0.0, 0.2)), plan)
        blank, setups = job.blank, job.setups
        if turned is not None and turned.setups:
            blank = turned.blank
            setups = make_setups(job.recognition, blank, job.settings_of(SetupSettings))
        not_turned = turned.findings if turned is not None else ()
        findings: Sequence[Finding] = [f for f in not_turned if f.severity is Severity.ERROR]
        findings = (
            findings
            or too_large(blank, setups, job.shop)
            or without_axes(job.recognition, setups, job.shop, NEEDS_AXES, LEANING)
        )
        if findings:
            return process_of(
                (), findings, plan=plan, material=material, setups=job.setups, shop=job.shop
            )
        part = job.context.part
        setup, *others = after_turning(
            both_sides(setups, blank, job.shop, job.settings_of(SetupSettings)),
            turned,
            job.settings_of(SetupSettings),
        )
        state = CasingPlanState(
            part=part,
            mesh=job.progress.aside(lambda _: fine_mesh(part)),
            context=job.context,
            recognition=job.recognition,
            blank=blank,
            setup=setup,
            material=material,
            machine=job.shop.machine(setup.machine),
            shop=job.shop,
            route=route,
            settings=job.settings_of(CasingRouteSettings),
            cutting=job.settings_of(CuttingSettings),
            regions=job.settings_of(RegionSettings),
            choices=job.choices,
            progress=job.progress.part(0.2, 1.0),
            turned=turned,
            next=others[0] if others else None,
        )
        return make_casing_route(state, plan)

    def drive(
        self, operation: Operation, needs: DriveNeeds, scene: Scene, progress: Progress
    ) -> OperationDrive:
        """Return the drive that an operation's strategy needs."""
        return driven_by(
            {
                PlaneDrive: plane_driven,
                SurfaceDrive: sides_driven,
                HoleDrive: bores_driven,
                RevolvedDrive: revolved_driven,
                GapDrive: gaps_driven,
            },
            self,
            operation,
            needs,
            scene,
            progress,
        )
