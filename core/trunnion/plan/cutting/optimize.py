"""The cutting data of a whole process computed again: by tables or by the optimiser, each operation with the peak of its load."""

from __future__ import annotations

import math
from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass, replace

from trunnion import tolerance
from trunnion.model.material import Machine, Material
from trunnion.model.operation import Operation
from trunnion.model.process import ProcessTree
from trunnion.model.tool import TurningTool
from trunnion.plan.cutting.axial import TABLE_FORMS, TABLE_KINDS, table_data
from trunnion.plan.cutting.engaged import (
    engaged_data,
    engaged_depth,
    engaged_width,
)
from trunnion.plan.cutting.milling import (
    ROUGHING,
    CuttingSettings,
    cutting_data,
    layer_depth,
    layer_width,
    roughing_depth,
    roughing_width,
)
from trunnion.plan.cutting.optimization.operation import (
    OptimizationSettings,
    at_optimum,
    problem_of,
    solve,
)
from trunnion.plan.cutting.optimization.problem import CuttingProblem, Optimum
from trunnion.plan.cutting.optimization.settings import OPTIMISED
from trunnion.plan.cutting.peak import is_overload, with_peak
from trunnion.plan.cutting.turning import TURNING_FINISH, turning_data
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.settings import Value, choose, declared
from trunnion.shop import Shop
from trunnion.units import MM_PER_METRE


@dataclass(frozen=True, slots=True, kw_only=True)
class Choice:
    """An operation with the data of the tables, and with those of the optimiser: the same where it found none better or has no models for
    it, and then there is neither problem nor optimum."""

    handbook: Operation
    optimised: Operation
    problem: CuttingProblem | None = None
    optimum: Optimum | None = None


Solutions = dict[Hashable, Optimum | None]
"""Optima by the identity of their problems: many operations of a part are alike."""


def balance(
    process: ProcessTree,
    shop: Shop,
    settings: CuttingSettings,
    choices: Mapping[str, Value],
    progress: Progress = NO_PROGRESS,
) -> ProcessTree:
    """Return the process with every operation's data computed again under these limits; what a person set by hand stays.

    Every operation is told the peak of its load under a session's `choices` for the strategies. `optimize.data` says whether spindle speed
    and feed are those of the tables or the optimiser's.
    """
    material, done, solutions = shop.material(process.material), list[Operation](), Solutions()
    for operation in progress.each(process.operations):
        earlier = [o for o in done if o.setup == operation.setup]
        own = _own_choices(operation, choices)
        limits = own.cutting if _of_its_own(operation) else settings
        handbook = with_peak(
            recomputed(operation, process, material, shop, limits), earlier, material, choices
        )
        if own.optimize.data == OPTIMISED:
            machine = shop.machine(process.setup(operation.setup).machine)
            own = replace(own, cutting=limits)
            handbook = _choice(
                handbook, earlier, material, machine, own, choices, solutions, progress
            ).optimised
        done.append(handbook)
    return replace(process, operations=tuple(done))


def choices_of(
    process: ProcessTree,
    shop: Shop,
    choices: Mapping[str, Value],
    progress: Progress = NO_PROGRESS,
    only: str = "",
) -> tuple[Choice, ...]:
    """Return every operation with the data of the tables and with those of the optimiser, whichever are in use; none is changed.

    Where the id of one is given, that `only`.
    """
    material, done, found = shop.material(process.material), list[Operation](), list[Choice]()
    solutions = Solutions()
    for operation in progress.each(process.operations):
        earlier = [o for o in done if o.setup == operation.setup]
        own = _own_choices(operation, choices)
        machine = shop.machine(process.setup(operation.setup).machine)
        handbook = with_peak(
            recomputed(operation, process, material, shop, own.cutting), earlier, material, choices
        )
        if only in ("", operation.id):
            found.append(
                _choice(handbook, earlier, material, machine, own, choices, solutions, progress)
            )
        done.append(handbook)
    return tuple(found)


def _own_choices(operation: Operation, choices: Mapping[str, Value]) -> OptimizationSettings:
    return OptimizationSettings.of({**choices, **operation.choices})


def _solved(
    problem: CuttingProblem,
    settings: OptimizationSettings,
    solutions: Solutions,
    progress: Progress,
) -> Optimum | None:
    if problem.identity not in solutions:
        solutions[problem.identity] = solve(problem, settings, progress)
    return solutions[problem.identity]


def _choice(
    handbook: Operation,
    earlier: Sequence[Operation],
    material: Material,
    machine: Machine,
    settings: OptimizationSettings,
    choices: Mapping[str, Value],
    solutions: Solutions,
    progress: Progress,
) -> Choice:
    """Return an operation's choice; the tables' data stay where nothing keeps the limits, or the load would pass them all the same."""
    problem = problem_of(handbook, earlier, material, machine, settings, choices)
    optimum = None if problem is None else _solved(problem, settings, solutions, progress)
    if problem is None or optimum is None:
        return Choice(handbook=handbook, optimised=handbook, problem=problem)
    optimised = with_peak(
        at_optimum(handbook, problem, optimum, material, machine, settings.cutting),
        earlier,
        material,
        choices,
    )
    if is_overload(optimised.data):
        optimised = handbook
    return Choice(handbook=handbook, optimised=optimised, problem=problem, optimum=optimum)


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
    """Return an operation with the data of the tables under these limits; one that keeps its data as it is, and so does interrupted
    turning, whose gaps were chosen for its speed."""
    if operation.keeps_data or operation.tool.locked:
        return operation
    machine = shop.machine(process.setup(operation.setup).machine)
    if isinstance(operation.tool, TurningTool):
        return turned_again(operation, operation.tool, material, shop, machine, settings)
    depth, width = operation.data.routed_depth or operation.data.depth, operation.data.width
    if operation.kind in ROUGHING and operation.kind != "face":
        depth, width = _borne(operation, depth, width, material, settings)
    if operation.kind in TABLE_KINDS or operation.cutter.form in TABLE_FORMS:
        data = table_data(operation.kind, operation.cutter, material, machine, shop, settings)
        return replace(operation, data=data)
    if operation.data.is_engaged:
        data = engaged_data(operation.cutter, material, machine, settings, depth, width)
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


def _borne(
    operation: Operation, depth: float, width: float, material: Material, settings: CuttingSettings
) -> tuple[float, float]:
    """Return the depth and width (mm) of an operation as far as its cutter bears them under some limits: as the first of what cutters bear
    along walls, in layers that slots open, and at constant engagement that its route's depth and width are within."""
    tool, tables = operation.cutter, choose(CuttingSettings, {})

    def pairs(limits: CuttingSettings) -> tuple[tuple[float, float], ...]:
        flank = engaged_depth(tool, material, limits)
        return (
            (roughing_depth(tool, material, limits), roughing_width(tool, material, limits)),
            (layer_depth(tool, material, limits), layer_width(tool, material, limits)),
            (flank, engaged_width(tool, material, limits, min(depth, flank))),
        )

    slack = 1.0 + tolerance.PARAMETRIC
    within = [depth <= d * slack and width <= w * slack for d, w in pairs(tables)]
    row = 2 if operation.data.is_engaged else within.index(True) if any(within) else 1
    deepest, widest = pairs(settings)[row]
    return min(depth, deepest), min(width, widest)


def turned_again(
    operation: Operation,
    tool: TurningTool,
    material: Material,
    shop: Shop,
    machine: Machine,
    settings: CuttingSettings,
) -> Operation:
    """Return a turning operation with the data of the tables under these limits; as it is where its machine doesn't turn."""
    if machine.work_spindle is None:
        return operation
    now = operation.data
    data = turning_data(
        tool,
        material,
        shop.turning_for(material),
        machine.work_spindle,
        settings,
        finish=operation.kind == TURNING_FINISH,
        radius=0.5 * now.speed * MM_PER_METRE / (math.pi * now.spindle),
    )
    return replace(operation, data=data)
