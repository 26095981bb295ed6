"""The process tree of operations in their order: tools numbered, and what the machines' magazines don't take."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from itertools import count

from trunnion.findings import Finding
from trunnion.model.material import Material
from trunnion.model.operation import Operation
from trunnion.model.process import ProcessTree
from trunnion.model.setup import Setup
from trunnion.plan.feasibility import too_many_tools
from trunnion.shop import Shop, TypicalPlan
from trunnion.shop.crib import NO_CRIBS, Cribs


def process_of(
    operations: Iterable[Operation],
    findings: Iterable[Finding],
    *,
    plan: TypicalPlan,
    material: Material,
    setups: Sequence[Setup],
    shop: Shop,
) -> ProcessTree:
    """Return the process of operations in cutting order, with findings of the route and on more tools than a magazine takes."""
    numbered = with_tool_numbers(operations, setups, shop.cribs)
    return ProcessTree(
        plan=plan.name,
        material=material.name,
        setups=tuple(setups),
        operations=numbered,
        findings=(*findings, *too_many_tools(numbered, setups, shop)),
    )


def with_tool_numbers(
    operations: Iterable[Operation], setups: Sequence[Setup] = (), cribs: Cribs = NO_CRIBS
) -> tuple[Operation, ...]:
    """Return the operations with tools numbered: those in the machine of their setup as its crib has them, others in the order of use.

    The others get the lowest numbers that no tool in any of the machines has, a tool's name one number.
    """
    in_use = {s.name: cribs[s.machine] for s in setups if s.machine in cribs}
    taken = {t.number for crib in in_use.values() for t in crib.tools}
    free = (n for n in count(1) if n not in taken)
    numbers: dict[str, int] = {}
    numbered = []
    for operation in operations:
        name = operation.tool.name
        crib = in_use.get(operation.setup)
        loaded = crib.tool(name) if crib is not None else None
        if loaded is None and name not in numbers:
            numbers[name] = next(free)
        number = numbers[name] if loaded is None else loaded.number
        numbered.append(replace(operation, tool=replace(operation.tool, number=number)))
    return tuple(numbered)
