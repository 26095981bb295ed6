"""The process tree: the plan of this part, one branch a setup."""

from __future__ import annotations

from dataclasses import dataclass, replace

from trunnion.findings import Finding
from trunnion.model.operation import Operation
from trunnion.model.setup import Setup
from trunnion.model.tool import AnyTool


@dataclass(frozen=True, kw_only=True)
class ProcessTree:
    """Setups and their operations in the order they are cut; `plan` names the typical plan they come from.

    `removed` has the ids of operations that a person deleted: a re-run does not make them again.
    """

    plan: str
    material: str
    setups: tuple[Setup, ...] = ()
    operations: tuple[Operation, ...] = ()
    findings: tuple[Finding, ...] = ()
    removed: tuple[str, ...] = ()

    def of_setup(self, name: str) -> tuple[Operation, ...]:
        """Return the operations of a setup that are not suppressed, in order."""
        return tuple(o for o in self.operations if o.setup == name and not o.suppressed)

    def setup(self, name: str) -> Setup:
        """Return the setup with a name; raise `KeyError` when there is none."""
        for s in self.setups:
            if s.name == name:
                return s
        raise KeyError(name)

    def operation(self, id: str) -> Operation:
        """Return the operation with an id; raise `KeyError` when there is none."""
        for o in self.operations:
            if o.id == id:
                return o
        raise KeyError(id)

    def tools(self, machine: str = "") -> tuple[AnyTool, ...]:
        """Return the tools in use, each once, by number: all, or those on one machine, where no two have the same number."""
        setups = {s.name for s in self.setups if s.machine == machine}
        used = (
            o for o in self.operations if not o.suppressed and (not machine or o.setup in setups)
        )
        by_number = {(o.tool.number, o.tool.name): o.tool for o in used}
        return tuple(by_number[key] for key in sorted(by_number))

    def with_operation(self, changed: Operation) -> ProcessTree:
        """Return the tree with the operation of the same id replaced."""
        return replace(
            self, operations=tuple(changed if o.id == changed.id else o for o in self.operations)
        )

    def without(self, *ids: str) -> ProcessTree:
        """Return the tree after a person deleted operations; what had to come after them need not any more.

        Copies are made by persons alone: of these nothing is remembered.
        """
        kept = tuple(
            replace(o, after=tuple(a for a in o.after if a not in ids))
            for o in self.operations
            if o.id not in ids
        )
        copies = {o.id for o in self.operations if o.copy_of}
        planned = (id for id in ids if id not in copies)
        return replace(
            self, operations=kept, removed=tuple(dict.fromkeys((*self.removed, *planned)))
        )
