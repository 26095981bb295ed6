"""The cutting data of a whole process computed again under other limits, each operation with the peak of its load."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from trunnion.model.material import Material
from trunnion.model.operation import Operation
from trunnion.model.process import ProcessTree
from trunnion.plan.cutting.drilling import AXIAL, drilling_data
from trunnion.plan.cutting.milling import (
    ROUGHING,
    CuttingSettings,
    cutting_data,
    roughing_depth,
    roughing_width,
)
from trunnion.plan.cutting.peak import with_peak
from trunnion.plan.cutting.power import DRILL
from trunnion.settings import Value, choose, declared
from trunnion.shop import Shop


def balance(
    process: ProcessTree, shop: Shop, settings: CuttingSettings, choices: Mapping[str, Value]
) -> ProcessTree:
    """Return the process with every operation's data computed again under these limits; what a person set by hand stays.

    Every operation is told the peak of its load under a session's `choices` for the strategies.
    """
    material, done = shop.material(process.material), list[Operation]()
    for operation in process.operations:
        own = choose(CuttingSettings, {**choices, **operation.choices})
        balanced = recomputed(
            operation, process, material, shop, own if _of_its_own(operation) else settings
        )
        done.append(
            with_peak(balanced, [o for o in done if o.setup == operation.setup], material, choices)
        )
    return replace(process, operations=tuple(done))


def _of_its_own(operation: Operation) -> bool:
    """Return whether an operation has limits of its own."""
    return any(d.key in operation.choices for d in declared(CuttingSettings))


def recomputed(
    operation: Operation,
    process: ProcessTree,
    material: Material,
    shop: Shop,
    settings: CuttingSettings,
) -> Operation:
    """Return an operation with the data of the tables under these limits; one that a person set by hand as it is."""
    if operation.by_hand:
        return operation
    machine = shop.machine(process.setup(operation.setup).machine)
    depth, width = operation.data.routed_depth or operation.data.depth, operation.data.width
    if operation.kind in ROUGHING and operation.kind != "face":
        depth = min(depth, roughing_depth(operation.cutter, material, settings))
        width = min(width, roughing_width(operation.cutter, material, settings))
    if operation.kind in AXIAL or operation.cutter.form == DRILL:
        data = drilling_data(
            operation.cutter,
            material,
            shop.drilling_for(material),
            machine,
            settings,
            operation.kind,
        )
        return replace(operation, data=data)
    data = cutting_data(
        operation.cutter,
        material,
        machine,
        operation.kind,
        settings,
        depth,
        width,
        operation.data.widest,
    )
    return replace(operation, data=data)
