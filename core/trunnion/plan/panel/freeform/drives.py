"""Drives of operations on pockets with leaning walls or curved floors: layers, level floors, rims of what hangs over these, and the share
that a pocket has of faces that run on into its neighbours."""

from __future__ import annotations

from trunnion import tolerance
from trunnion.findings import Refused
from trunnion.model.operation import Operation
from trunnion.plan.contract import Scene
from trunnion.plan.freeform.keys import CELL, number, total_allowance
from trunnion.plan.freeform.roughing.layers import pocket_layers
from trunnion.plan.freeform.surface_drives import space_from
from trunnion.plan.panel.feasibility import adjacent
from trunnion.plan.panel.freeform.pocket import FreeformPocket
from trunnion.plan.prismatic.drive import PlaneDrive
from trunnion.plan.prismatic.regions import SetupSpace
from trunnion.progress import Progress

OVERHUNG_FLOOR = "overhung_floor"
"""The kind of operation that finishes what of floors something hangs over."""
OVERHANG_RIM = "overhang_rim"
"""The kind of operation that goes along the upper edges of walls that lean over."""


def pocket_of(
    operation: Operation, space: SetupSpace, scene: Scene, progress: Progress
) -> FreeformPocket | None:
    """Return the freeform pocket that an operation is on, None where it is on none."""
    feature = next((f for f in scene.recognition if f.id == operation.feature), None)
    if feature is None or not space.is_freeform(feature):
        return None

    def made() -> FreeformPocket:
        beside = scene.once("beside", lambda: adjacent(scene.recognition, scene.context.part))
        curved = space_from(operation.direction, tolerance.CHORD, scene, progress)
        return FreeformPocket.of(feature, space, curved, beside.get(feature.id, frozenset()))

    return scene.once(("freeform pocket", feature.id), made)


def freeform_drive(
    operation: Operation, pocket: FreeformPocket, scene: Scene, progress: Progress
) -> PlaneDrive:
    """Return the drive of a plane operation on a freeform pocket: layers, its level floors, the rims of what hangs over these; raise
    `Refused` for other kinds."""
    if operation.kind == "rough":
        return _layers(operation, pocket, scene, progress)
    if operation.kind == "leaning_floor":
        floors, levels = pocket.floors()
        return PlaneDrive(
            feature=operation.feature,
            kind=operation.kind,
            levels=levels,
            floors=floors,
            fillet=pocket.fillet,
            stock_top=pocket.space.top,
            faces=operation.faces,
        )
    if operation.kind == OVERHANG_RIM:
        return PlaneDrive(
            feature=operation.feature,
            kind=operation.kind,
            levels=pocket.floors()[1],
            walls=pocket.overhang_rims(),
            fillet=pocket.fillet,
            stock_top=pocket.space.top,
            faces=operation.faces,
        )
    raise Refused(
        f"{operation.id}: pockets with leaning walls or curved floors have no drive for plane operations of kind {operation.kind}"
    )


def _layers(
    operation: Operation, pocket: FreeformPocket, scene: Scene, progress: Progress
) -> PlaneDrive:
    curved = space_from(operation.direction, tolerance.CHORD, scene, progress)
    allowance, cell = total_allowance(operation), number(operation, CELL)
    area = pocket.layer_area()
    tall = scene.once(
        ("height map", operation.feature, allowance, cell),
        lambda: area.height_map(curved, cell, allowance, progress),
    )
    return pocket_layers(operation, curved, scene.stock(curved.setup), area, tall, progress)
