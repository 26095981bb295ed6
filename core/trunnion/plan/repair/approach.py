"""The fix `approach`: faces that an upright tool can't finish without harm are finished by one that leans out of the way."""

from __future__ import annotations

from dataclasses import replace

from trunnion import registry
from trunnion.findings import Fix
from trunnion.model.operation import Operation
from trunnion.model.process import ProcessTree
from trunnion.plan.contract import ToolAxis
from trunnion.plan.freeform.drive import SurfaceDrive
from trunnion.plan.repair.contract import RepairJob
from trunnion.registry import STRATEGIES
from trunnion.settings import choose

FORMS = ("ball", "bull")
"""Forms that touch a face with their round part, however they lean."""
WHY = "Its tool leans, because an upright one met the part: the proof asked for it."


def with_leaning_axis(process: ProcessTree, fix: Fix, job: RepairJob) -> ProcessTree | None:
    """Return the process with an operation's faces given to a strategy whose tool leans; None where the machine has no rotary axes, the
    cutter has no round part, or the tool leans already."""
    operation = process.operation(fix.operation)
    machine = job.shop.machine(process.setup(operation.setup).machine)
    if not machine.rotary or operation.cutter.form not in FORMS or not operation.faces:
        return None
    if not _is_upright_on_faces(operation, job):
        return None
    leaning = next((n for n in registry.names(STRATEGIES) if _leans(n, job)), "")
    if not leaning:
        return None
    own = f"{operation.strategy}."
    choices = {k: v for k, v in operation.choices.items() if not k.startswith(own)}
    return process.with_operation(
        replace(operation, strategy=leaning, choices=choices, rules=(*operation.rules, WHY))
    )


def _is_upright_on_faces(operation: Operation, job: RepairJob) -> bool:
    strategy = registry.get(STRATEGIES, operation.strategy)
    settings = choose(strategy.settings, {**job.choices, **operation.choices})
    return issubclass(strategy.drive, SurfaceDrive) and (
        strategy.tool_axis(settings) is not ToolAxis.LEANING
    )


def _leans(name: str, job: RepairJob) -> bool:
    """Return whether a strategy finishes faces with a tool that leans by itself, without a setting that asks for it."""
    strategy = registry.get(STRATEGIES, name)
    return issubclass(strategy.drive, SurfaceDrive) and (
        strategy.tool_axis(choose(strategy.settings, job.choices)) is ToolAxis.LEANING
    )
