"""The process tree of operations in their order: tools numbered, and what the machines' magazines don't take."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

from trunnion.findings import Finding
from trunnion.model.material import Material
from trunnion.model.operation import Operation
from trunnion.model.process import ProcessTree
from trunnion.model.setup import Setup
from trunnion.plan.feasibility import too_many_tools
from trunnion.shop import Shop, TypicalPlan


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
    numbered = with_tool_numbers(operations)
    return ProcessTree(
        plan=plan.name,
        material=material.name,
        setups=tuple(setups),
        operations=numbered,
        findings=(*findings, *too_many_tools(numbered, setups, shop)),
    )


def with_tool_numbers(operations: Iterable[Operation]) -> tuple[Operation, ...]:
    """Return the operations with tools numbered from 1 in the order of use; a tool's name has one number."""
    numbers: dict[str, int] = {}
    return tuple(
        replace(o, tool=replace(o.tool, number=numbers.setdefault(o.tool.name, len(numbers) + 1)))
        for o in operations
    )
