"""What a fix is applied with, and what every kind of fix promises."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

from trunnion import registry
from trunnion.findings import Fix
from trunnion.model.process import ProcessTree
from trunnion.model.tool import Tool
from trunnion.plan.process import with_tool_numbers
from trunnion.plan.settings import RouteSettings
from trunnion.registry import FIXES
from trunnion.settings import Value, checked, choose
from trunnion.shop import Shop
from trunnion.shop.crib import Cribs


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RepairJob:
    """What a process is changed with: the catalogues, and a session's settings by full key."""

    shop: Shop
    choices: Mapping[str, Value]

    @property
    def route(self) -> RouteSettings:
        """The settings of the route: its clearances and largest cutter hold for what a fix chooses too."""
        return checked(choose(RouteSettings, self.choices))

    def milling_tools(self, process: ProcessTree, forms: tuple[str, ...]) -> tuple[Tool, ...]:
        """Return the catalogue's milling cutters of some forms for the material of a process, in the order of their names."""
        suits = self.shop.material(process.material).iso_group
        return tuple(
            sorted(
                (c.tool for c in self.shop.cutters if suits in c.suits and c.tool.form in forms),
                key=lambda t: t.name,
            )
        )


FixRule = Callable[[ProcessTree, Fix, RepairJob], ProcessTree | None]
"""A kind of fix: returns the process with what the fix asks for, None where nothing of the kind can be done."""


def applied(process: ProcessTree, fix: Fix, job: RepairJob) -> ProcessTree | None:
    """Return the process with a fix, its tools numbered anew; None where the fix changes nothing. What a person set by hand stays."""
    if fix.kind not in registry.names(FIXES) or _is_manual(process, fix.operation):
        return None
    rule: FixRule = registry.get(FIXES, fix.kind)
    changed = rule(process, fix, job)
    return None if changed is None else numbered(changed, job.shop.cribs)


def _is_manual(process: ProcessTree, id: str) -> bool:
    return any(o.by_hand for o in process.operations if o.id == id)


def numbered(process: ProcessTree, cribs: Cribs) -> ProcessTree:
    """Return a process whose tools have the numbers of the cribs of its machines, others those of their order of use."""
    operations = with_tool_numbers(process.operations, process.setups, cribs)
    return replace(process, operations=operations)
