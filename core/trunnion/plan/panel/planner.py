"""The planner of panels."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from trunnion import tolerance
from trunnion.findings import Refused
from trunnion.geometry.plane.region import Region, union_all
from trunnion.model.feature import Feature, Recognition
from trunnion.model.operation import Operation
from trunnion.model.process import ProcessTree
from trunnion.model.setup import Setup
from trunnion.plan.allowances import allowance_of
from trunnion.plan.clearance import ClearanceScene
from trunnion.plan.contract import DriveNeeds, OperationDrive, RouteJob, Scene, driven_by
from trunnion.plan.freeform.drive import SurfaceDrive
from trunnion.plan.freeform.keys import PAST_RIM, number
from trunnion.plan.freeform.space import SurfaceSpace
from trunnion.plan.freeform.surface_drives import surface_driven
from trunnion.plan.holes.drive import HoleDrive, holes_driven
from trunnion.plan.holes.settings import HOLE_SETTINGS
from trunnion.plan.panel.freeform.drives import OVERHUNG_FLOOR, freeform_drive, pocket_of
from trunnion.plan.panel.freeform.pocket import FreeformPocket
from trunnion.plan.panel.freeform.settings import LeaningSettings
from trunnion.plan.panel.route import make_route
from trunnion.plan.panel.rules import TASK_MAKERS
from trunnion.plan.panel.side_settings import SidesSettings
from trunnion.plan.prismatic.drive import PlaneDrive, drive_of
from trunnion.plan.prismatic.kept import KeptArea, off_kept
from trunnion.plan.prismatic.lean import POCKETS
from trunnion.plan.prismatic.regions import SetupSpace, parent_of
from trunnion.plan.prismatic.tabs import TabSettings
from trunnion.plan.settings import RouteSettings
from trunnion.progress import Progress

if TYPE_CHECKING:
    from trunnion.part.part import Part


class PanelPlanner:
    """Plans pockets, ribs, islands, holes and the outline; its plane operations are driven by features, through the part's sections."""

    name, noun = "panel", "panels"
    settings: tuple[type, ...] = (
        RouteSettings,
        SidesSettings,
        *HOLE_SETTINGS,
        LeaningSettings,
        TabSettings,
    )
    cutter_rules: tuple[str, ...] = tuple(TASK_MAKERS)
    allowance_kinds = (*POCKETS, "island", "rib", "boss", "profile")

    def walls_with(self, feature: Feature, recognition: Recognition) -> str:
        """Return the pocket that an island stands in: its walls are cut with the pocket's."""
        pocket = parent_of(feature, recognition) if feature.kind == "island" else None
        return feature.id if pocket is None else pocket.id

    def can_plan(self, part: Part) -> None:
        """Refuse no part: features whose sections can't be made are refused one by one."""

    def route(self, job: RouteJob) -> ProcessTree:
        """Return the process by `make_route`."""

        def curved(setup: Setup) -> SurfaceSpace:
            skin = job.context.skin(tolerance.SKIN_CHORD, job.progress)
            return SurfaceSpace.of(job.context.part, skin, job.blank, setup)

        def leaning(space: SurfaceSpace, setup: Setup) -> ClearanceScene:
            return job.context.around(setup, space.frame, space.skin, job.progress)

        return make_route(
            job.recognition,
            job.sizes,
            job.blank,
            job.setups,
            job.shop,
            job.context.part,
            job.settings_of(RouteSettings),
            job.progress,
            choices=job.choices,
            curved=curved,
            leaning=leaning,
        )

    def drive(
        self, operation: Operation, needs: DriveNeeds, scene: Scene, progress: Progress
    ) -> OperationDrive:
        """Return the drive that an operation's strategy needs."""
        return driven_by(
            {PlaneDrive: _plane_driven, SurfaceDrive: _surface_driven, HoleDrive: holes_driven},
            self,
            operation,
            needs,
            scene,
            progress,
        )


def _plane_driven(
    operation: Operation, needs: DriveNeeds, scene: Scene, progress: Progress
) -> OperationDrive:
    space = _space(scene)
    pocket = pocket_of(operation, space, scene, progress)
    if pocket is not None:
        drive = freeform_drive(operation, pocket, scene, progress)
    else:
        drive = drive_of(operation, scene.process, space)
    others = [a for a in _kept_areas(scene) if a.feature not in operation.all_features]
    drive = off_kept(drive, others)
    return OperationDrive.of(setup=scene.setup, drive=drive, identity=drive)


def _kept_areas(scene: Scene) -> tuple[KeptArea, ...]:
    """Return where walls of pockets and of the outline keep material, in plan."""

    def areas() -> Iterator[KeptArea]:
        space = _space(scene)
        for feature in scene.recognition:
            amount = allowance_of(feature).wall_allowance
            if amount <= 0.0:
                continue
            if feature.kind == "profile":
                area = space.around().minus(space.silhouette())
            elif feature.kind in POCKETS and not space.is_freeform(feature):
                try:
                    area = union_all([band.wanted for band in space.bands_of(feature)])
                except Refused:
                    # It opens to another side: no cutter comes by its walls in this setup.
                    continue
            else:
                continue
            yield KeptArea(feature=feature.id, area=area, amount=amount)

    return scene.once("kept areas", lambda: tuple(areas()))


def _surface_driven(
    operation: Operation, needs: DriveNeeds, scene: Scene, progress: Progress
) -> OperationDrive:
    pocket = pocket_of(operation, _space(scene), scene, progress)
    within = None
    if pocket is not None:
        within = _own_area(operation, pocket, needs)
    return surface_driven(operation, needs, scene, progress, within)


def _own_area(operation: Operation, pocket: FreeformPocket, needs: DriveNeeds) -> Region:
    """Return the plan area that is a pocket's of the faces that an operation finishes."""
    if operation.kind == OVERHUNG_FLOOR:
        return pocket.overhung_floors(number(operation, PAST_RIM))[1]
    return pocket.under_overhangs() if needs.leans else pocket.limit(pocket.top)


def _space(scene: Scene) -> SetupSpace:
    return scene.once(
        "sections",
        lambda: SetupSpace.of(scene.context.part, scene.recognition, scene.blank, scene.setup),
    )
