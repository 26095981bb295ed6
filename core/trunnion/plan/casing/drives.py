"""What drives the operations on a casing: over bottoms laid flat, and along the directions of bosses and holes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from trunnion import tolerance
from trunnion.geometry.plane.region import Region, union_all
from trunnion.model.blank import Blank
from trunnion.model.operation import Operation
from trunnion.model.setup import Setup
from trunnion.plan.casing.grounds import bottom_of, fine_mesh, ground_under
from trunnion.plan.casing.interrupted_route import gap_drive, turned_of
from trunnion.plan.contract import DriveNeeds, OperationDrive, RollingGround, Scene
from trunnion.plan.cutting.interrupted import INTERRUPTED
from trunnion.plan.development.drives import (
    FLOOR,
    ROUGH,
    GroundCutter,
    floor_over,
    layers_over,
)
from trunnion.plan.development.ground import DevelopedGround
from trunnion.plan.freeform.keys import number
from trunnion.plan.freeform.lands import STOCK, land_drive
from trunnion.plan.freeform.surface_drives import space_from, surface_driven
from trunnion.plan.holes.drive import holes_driven
from trunnion.plan.prismatic.drive import FLOOR_ALLOWANCE, WALL_ALLOWANCE
from trunnion.plan.turning.gap_drive import GapDrive
from trunnion.progress import Progress

ROUGH_CHORD, FINISH_CHORD = 0.05, 0.002
"""mm: chord errors of circles about the axis while roughing, at most, and while finishing."""
CHORD_SHARE = 1.0 / 6.0
"""Of the least allowance that roughing leaves: its chord error at most."""


CELLS, FINEST, COARSEST = 300.0, 0.5, 2.0
"""Cells over the blank's length, and mm at least and at most: side of the cells of stock along the directions of bosses and holes."""


def ground_in(scene: Scene, pocket: str, progress: Progress) -> DevelopedGround:
    """Return the ground of a pocket, made once for all operations of a setup."""

    def made() -> DevelopedGround:
        part = scene.context.part
        bottom = bottom_of(scene.recognition, part, pocket)
        return ground_under(bottom, scene.recognition, part, fine_mesh(part), scene.blank, progress)

    return scene.once(("ground", pocket), made).watched(progress)


def plane_driven(
    operation: Operation, needs: DriveNeeds, scene: Scene, progress: Progress
) -> OperationDrive:
    """Return the plane drive of an operation: over a bottom laid flat, or on the top of a boss seen along its normal."""
    if operation.kind not in (ROUGH, FLOOR):
        space = space_from(operation.direction, tolerance.CHORD, scene, progress)
        drive = land_drive(operation, space, (), float(space.high[2]), progress)
        return OperationDrive.of(
            setup=space.setup, drive=drive, identity=drive, cell=stock_cell(scene.blank)
        )
    ground = ground_in(scene, operation.feature, progress)
    before = [GroundCutter.of(o) for o in earlier_over(operation, scene)]
    if operation.kind == ROUGH:
        drive = layers_over(operation, ground, boss_tops(ground), before)
    else:
        turned = [o for o in earlier(operation, scene) if o.kind == INTERRUPTED]
        areas = [turned_in(scene, o, progress) for o in turned]
        drive = floor_over(operation, ground, before, number(operation, STOCK), union_all(areas))
    rolling = rolling_over(operation.feature, _chord(operation), scene, progress)
    setup = flat_setup(scene.setup, ground)
    return OperationDrive.of(
        setup=setup, drive=drive, identity=(drive, ground.development), rolling=rolling
    )


def rolling_over(pocket: str, chord: float, scene: Scene, progress: Progress) -> RollingGround:
    """Return what a path over the ground of a pocket is rolled onto, with that of the pocket it is sunk into."""
    host = scene.once(
        ("host", pocket),
        lambda: bottom_of(scene.recognition, scene.context.part, pocket).recess_of,
    )
    rolling = rolling_on(ground_in(scene, pocket, progress), chord)
    if not host:
        return rolling
    return replace(rolling, upper=rolling_over(host, chord, scene, progress))


def _chord(operation: Operation) -> float:
    """Return the chord error (mm) of an operation's circles about the axis."""
    if operation.kind != ROUGH:
        return FINISH_CHORD
    least = min(number(operation, key) for key in (FLOOR_ALLOWANCE, WALL_ALLOWANCE))
    return min(max(CHORD_SHARE * least, FINISH_CHORD), ROUGH_CHORD)


def gaps_driven(
    operation: Operation, needs: DriveNeeds, scene: Scene, progress: Progress
) -> OperationDrive:
    """Return the passes of interrupted turning over a bottom."""
    drive = gaps_in(scene, operation, progress)
    return OperationDrive.of(
        setup=scene.setup, drive=drive, identity=drive, cell=stock_cell(scene.blank)
    )


def gaps_in(scene: Scene, operation: Operation, progress: Progress) -> GapDrive:
    """Return the passes of an operation of interrupted turning, made once for all operations of a setup."""

    def made() -> GapDrive:
        ground = ground_in(scene, operation.feature, progress)
        clearance = flat_setup(scene.setup, ground).clearance
        return gap_drive(operation, ground, roughed_before(operation, scene), clearance)

    return scene.once(("gaps", operation.id), made)


def turned_in(scene: Scene, operation: Operation, progress: Progress) -> Region:
    """Return the area of ground that an operation of interrupted turning finishes, made once for all operations of a setup."""

    def made() -> Region:
        ground = ground_in(scene, operation.feature, progress)
        return turned_of(operation, ground, gaps_in(scene, operation, progress))

    return scene.once(("turned", operation.id), made)


def earlier_over(operation: Operation, scene: Scene) -> list[Operation]:
    """Return the operations of an operation's kind that went over the same bottom before."""
    return [o for o in earlier(operation, scene) if o.kind == operation.kind]


def roughed_before(operation: Operation, scene: Scene) -> list[Operation]:
    """Return the operations that roughed an operation's bottom before."""
    return [o for o in earlier(operation, scene) if o.kind == ROUGH]


def earlier(operation: Operation, scene: Scene) -> list[Operation]:
    """Return the operations on the same bottom before an operation."""
    found = []
    for o in scene.process.of_setup(operation.setup):
        if o.id == operation.id:
            break
        if o.feature == operation.feature and not o.suppressed:
            found.append(o)
    return found


def boss_tops(ground: DevelopedGround) -> tuple[float, ...]:
    """Return the heights over ground from which on each boss on it is clear."""
    low, high = ground.ends
    found = []
    for each in ground.obstacles:
        if each.closed and len(each.corners):
            along = ground.development.along_and_turn(each.corners.reshape(-1, 3))[0]
            if low <= float(np.median(along)) <= high:
                found.append(float(each.corners[:, :, 2].max()))
    return tuple(sorted(set(found)))


def rolling_on(ground: DevelopedGround, chord: float) -> RollingGround:
    """Return what a path over ground is rolled onto."""
    low, high = ground.around().box()
    return RollingGround(
        development=ground.development,
        chord=chord,
        low=np.asarray(low),
        high=np.asarray(high),
        profile=ground.profile,
        widths=ground.widths,
        known=ground.known,
    )


def flat_setup(setup: Setup, ground: DevelopedGround) -> Setup:
    """Return a setup over the plane of ground laid flat: its tool travels as far over all of blank and part there as over the blank in
    the setup itself."""
    above = float(ground.profile[:, 1].max())
    for each in ground.obstacles:
        if len(each.corners):
            above = max(above, float(each.corners[:, :, 2].max()))
    return replace(setup, clearance=above + CLEARANCE, fixtures=())


CLEARANCE = 10.0
"""mm that rapids over bottoms stay above everything there."""


def bores_driven(
    operation: Operation, needs: DriveNeeds, scene: Scene, progress: Progress
) -> OperationDrive:
    """Return the drive of an operation on holes."""
    driven = holes_driven(operation, needs, scene, progress)
    return replace(driven, cell=stock_cell(scene.blank))


def sides_driven(
    operation: Operation, needs: DriveNeeds, scene: Scene, progress: Progress
) -> OperationDrive:
    """Return the surface drive of an operation along a boss's normal."""
    driven = surface_driven(operation, needs, scene, progress)
    return replace(driven, cell=stock_cell(scene.blank))


def stock_cell(blank: Blank) -> float:
    """Return the side (mm) of the cells that stock beside bosses and holes is known in: there are many directions, and each has only a
    few links to make over it."""
    return min(max(float(blank.size.max()) / CELLS, FINEST), COARSEST)
