"""The fix `approach`: faces that an upright tool can't finish without harm are finished by one that leans out of the way; one that leans
already keeps off what may stand on the part."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, replace

from trunnion import registry
from trunnion.findings import Fix
from trunnion.model.operation import Operation
from trunnion.model.process import ProcessTree
from trunnion.plan.contract import ToolAxis
from trunnion.plan.freeform.drive import SurfaceDrive
from trunnion.plan.repair.contract import RepairJob
from trunnion.registry import STRATEGIES
from trunnion.settings import Value, choose

UPRIGHT, LEANING = ToolAxis.FIXED, ToolAxis.LEANING
FORMS = ("ball", "bull")
"""Forms that touch a face with their round part, however they lean."""
WARY = "wary"
"""The setting of a leaning strategy that keeps its tool off what may stand on the part."""
WHY_WARY = "Its tool keeps off what earlier tools left on the part: the proof saw it in there."
WHY = "Its tool leans, because an upright one met the part: the proof asked for it."


def with_leaning_axis(process: ProcessTree, fix: Fix, job: RepairJob) -> ProcessTree | None:
    """Return the process with an operation's faces given to a strategy whose tool leans by itself, or with the tool wary of stock where
    it leans already; None where the machine has no rotary axes, the cutter has no round part, or the tool is wary already."""
    operation = process.operation(fix.operation)
    machine = job.shop.machine(process.setup(operation.setup).machine)
    if not machine.rotary or operation.cutter.form not in FORMS or not operation.faces:
        return None
    axis = _axis_on_faces(operation.strategy, {**job.choices, **operation.choices})
    if axis is LEANING:
        return _wary(process, operation)
    if axis is not UPRIGHT:
        return None
    leaning = (n for n in registry.names(STRATEGIES) if _axis_on_faces(n, job.choices) is LEANING)
    strategy = next(leaning, "")
    if not strategy:
        return None
    own = f"{operation.strategy}."
    choices = {k: v for k, v in operation.choices.items() if not k.startswith(own)}
    return process.with_operation(
        replace(operation, strategy=strategy, choices=choices, rules=(*operation.rules, WHY))
    )


def _wary(process: ProcessTree, operation: Operation) -> ProcessTree | None:
    """Return the process with a leaning operation that keeps off what earlier tools may have left on the part; None where it does, or its
    strategy knows nothing of it."""
    key = f"{operation.strategy}.{WARY}"
    known = {f.name for f in fields(registry.get(STRATEGIES, operation.strategy).settings)}
    if WARY not in known or operation.choices.get(key):
        return None
    return process.with_operation(
        replace(
            operation,
            choices={**operation.choices, key: True},
            rules=(*operation.rules, WHY_WARY),
        )
    )


def _axis_on_faces(name: str, choices: Mapping[str, Value]) -> ToolAxis | None:
    """Return what a strategy's tool axis does by a session's choices; None for one that is driven by no faces."""
    strategy = registry.get(STRATEGIES, name)
    if not issubclass(strategy.drive, SurfaceDrive):
        return None
    axis: ToolAxis = strategy.tool_axis(choose(strategy.settings, choices))
    return axis
