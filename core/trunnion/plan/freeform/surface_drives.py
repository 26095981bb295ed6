"""Surface drives of any part: its skin from the direction that an operation's tool comes from, made once a setup."""

from __future__ import annotations

from trunnion import tolerance
from trunnion.findings import Finding
from trunnion.geometry.plane.region import Region
from trunnion.model.operation import Operation
from trunnion.model.tool import Tool, rotating
from trunnion.plan.clearance import LeaningCutQuery
from trunnion.plan.contract import Drive, DriveNeeds, LazyDrive, OperationDrive, Scene
from trunnion.plan.freeform.keys import ALLOWANCE, EARLIER, UPRIGHT_EARLIER, number
from trunnion.plan.freeform.space import SurfaceSpace
from trunnion.plan.setups.frames import Direction
from trunnion.progress import Progress


def space_from(
    direction: Direction, chord: float, scene: Scene, progress: Progress
) -> SurfaceSpace:
    """Return the part's skin, within a chord error (mm), as a tool from a direction in the setup's frame sees it."""

    def seen() -> SurfaceSpace:
        return SurfaceSpace.of(
            scene.context.part,
            scene.context.skin(chord, progress),
            scene.blank,
            scene.setup,
            direction,
        )

    return scene.once(("space", direction, chord), seen)


def surface_driven(
    operation: Operation,
    needs: DriveNeeds,
    scene: Scene,
    progress: Progress,
    within: Region | None = None,
) -> OperationDrive:
    """Return the surface drive of an operation, with the cutter that finished its faces before where the operation names one; of faces that
    run out of a plan area, only what is `within` it."""
    space = space_from(operation.direction, tolerance.SKIN_CHORD, scene, progress)
    around = scene.context.around(scene.setup, space.frame, space.skin, progress)
    earlier, upright = (_named(operation, key, scene) for key in (EARLIER, UPRIGHT_EARLIER))
    allowance = number(operation, ALLOWANCE) if needs.leans else 0.0
    remaining_stock, cut = None, ""
    if needs.leans:
        # What leaves an allowance waits for nothing: paths of leaning tools are made beside each other.
        remaining_stock = scene.remaining_stock(space.frame, progress, leaning=allowance <= 0.0)
        cut = remaining_stock.cut
    cuts: tuple[LeaningCutQuery, ...] = ()
    if needs.earlier_cuts and allowance <= 0.0:
        cuts = scene.leaning_cuts(operation.feature)

    def made() -> tuple[Drive, tuple[Finding, ...]]:
        drive = progress.aside(
            lambda own: space.drive_of(
                operation, needs, earlier, around, remaining_stock, upright, own, within, cuts
            )
        )
        return drive, drive.findings

    identity = space.drive_digest(operation, needs, earlier, upright, within)
    return OperationDrive(
        setup=space.setup,
        lazy=LazyDrive(made),
        identity=(
            identity,
            scene.fixtures,
            *((cut,) if cut else ()),
            *((tuple(c.digest for c in cuts),) if cuts else ()),
        ),
        allowance=allowance,
    )


def _named(operation: Operation, key: str, scene: Scene) -> Tool | None:
    """Return the cutter of the process that an operation names under a key of its choices; None where it names none."""
    name = operation.choices.get(key, "")
    named = next((t for t in scene.process.tools() if t.name == name), None)
    return rotating(named, operation.id) if named is not None else None
