"""The process tree: the plan of this part, one branch a setup."""

from __future__ import annotations

from dataclasses import dataclass, replace

from trunnion.findings import Finding
from trunnion.model.operation import Operation
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool


@dataclass(frozen=True, kw_only=True)
class ProcessTree:
    """Setups and their operations in the order they are cut; `plan` names the typical plan they come from."""

    plan: str
    material: str
    setups: tuple[Setup, ...] = ()
    operations: tuple[Operation, ...] = ()
    findings: tuple[Finding, ...] = ()

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

    def tools(self) -> tuple[Tool, ...]:
        """Return the tools in use, each once, by number."""
        return tuple(sorted({o.tool.number: o.tool for o in self.operations if not o.suppressed}.values(), key=lambda t: t.number))

    def with_operation(self, changed: Operation) -> ProcessTree:
        """Return the tree with the operation of the same id replaced."""
        return replace(self, operations=tuple(changed if o.id == changed.id else o for o in self.operations))
