"""The planner of parts of curved surfaces."""

from __future__ import annotations

from typing import TYPE_CHECKING

from trunnion import tolerance
from trunnion.findings import BadInput
from trunnion.model.operation import Operation
from trunnion.model.process import ProcessTree
from trunnion.plan.contract import DriveNeeds, OperationDrive, RouteJob, Scene, driven_by
from trunnion.plan.freeform.drive import SurfaceDrive
from trunnion.plan.freeform.roughing.layers import plane_drive_of
from trunnion.plan.freeform.space import SurfaceSpace
from trunnion.plan.freeform.surface_drives import space_from, surface_driven
from trunnion.plan.holes.drive import HoleDrive, holes_driven
from trunnion.plan.prismatic.drive import PlaneDrive
from trunnion.plan.settings import RouteSettings
from trunnion.plan.surface.route import CUTTER_RULES, make_surface_route, refused_process
from trunnion.plan.surface.settings import SurfaceRouteSettings
from trunnion.progress import Progress

if TYPE_CHECKING:
    from trunnion.part.part import Part


class SurfacePlanner:
    """Plans layers, outlines, lands and areas; its plane operations are driven by how high the part is."""

    name, noun = "surface", "parts of curved surfaces"
    settings: tuple[type, ...] = (RouteSettings, SurfaceRouteSettings)
    cutter_rules: tuple[str, ...] = CUTTER_RULES
    skins: tuple[float, ...] = (tolerance.CHORD, tolerance.SKIN_CHORD)

    def can_plan(self, part: Part) -> None:
        """Raise `BadInput` for faces that enclose no material."""
        if not part.is_closed:
            raise BadInput(
                "nothing can be planned for faces that enclose no material and have no backing"
            )

    def route(self, job: RouteJob) -> ProcessTree:
        """Return the process by `make_surface_route`, or why the blank fits no machine."""
        first, progress = job.setups[0], job.progress
        curved = job.settings_of(SurfaceRouteSettings).consistent()
        # Faces of a part that no machine takes are not opened: metres of them would fill the memory.
        refused = refused_process(
            job.recognition, job.blank, job.setups, job.shop, job.settings_of(RouteSettings)
        )
        if refused is not None:
            return refused
        skin = job.context.skin(tolerance.CHORD, progress.part(0.0, 0.5))
        space = SurfaceSpace.of(job.context.part, skin, job.blank, first)
        around = job.context.around(first, space.frame, space.skin, progress)
        return make_surface_route(
            job.recognition,
            job.blank,
            job.setups,
            job.shop,
            space,
            around,
            job.settings_of(RouteSettings),
            curved,
            progress.part(0.5, 1.0),
        )

    def drive(
        self, operation: Operation, needs: DriveNeeds, scene: Scene, progress: Progress
    ) -> OperationDrive:
        """Return the drive that an operation's strategy needs."""
        return driven_by(
            {
                PlaneDrive: _plane_driven,
                SurfaceDrive: surface_driven,
                HoleDrive: holes_driven,
            },
            self,
            operation,
            needs,
            scene,
            progress,
        )


def _plane_driven(
    operation: Operation, needs: DriveNeeds, scene: Scene, progress: Progress
) -> OperationDrive:
    space = space_from(operation.direction, tolerance.CHORD, scene, progress)
    drive = plane_drive_of(operation, space, scene.stock(space.setup), progress, scene.process)
    return OperationDrive.of(setup=space.setup, drive=drive, identity=drive)
