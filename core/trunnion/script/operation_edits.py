"""Edits of operations by a person: set, copied, moved, taken out. Planning leaves alone what was done."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace

from trunnion import registry
from trunnion.findings import BadCall
from trunnion.model.process import ProcessTree
from trunnion.pipeline.planning.guide_faces import with_guide_faces
from trunnion.plan.manual.operation_change import OperationChange, check_known
from trunnion.plan.manual.operation_copy import with_copy, with_copy_on
from trunnion.plan.manual.operation_order import with_operation_before
from trunnion.plan.manual.operation_state import with_own_choices, with_suppressed
from trunnion.registry import STRATEGIES
from trunnion.script.recording import recorded
from trunnion.script.state import ProgramState
from trunnion.settings import Value, choose

PLANNED = "optimize"
"""The step that operations have their cutting data after."""


class OperationEdits(ProgramState):
    """Edits of planned operations, by their ids as `route` gives them; each plans first where the plan is stale.

    All raise `BadInput` for an operation that is not there and for what can't be done to it.
    """

    @recorded
    def change(
        self,
        operation: str,
        *,
        tool: str = "",
        spindle: float = 0.0,
        feed: float = 0.0,
        own: Mapping[str, Value] | None = None,
        add_faces: Iterable[int] = (),
        leave_out: Iterable[int] = (),
        before: str = "",
        last: bool = False,
        suppressed: bool | None = None,
    ) -> None:
        """Change an operation: its `tool` (a cutter of the catalogue), `spindle` speed 1/min and `feed` mm/min; its `own` values of its
        strategy's settings; the faces that lead it, more of them (`add_faces`) or fewer (`leave_out`); its position, `before` another one
        of its setup or `last` in it; whether it is `suppressed`, kept in the plan without being cut."""
        add_faces, leave_out = tuple(add_faces), tuple(leave_out)
        given: dict[str, Value] = {"tool": tool, "spindle": spindle, "feed": feed}
        is_moved = bool(before) or last
        others = (own, add_faces, leave_out, is_moved, suppressed is not None)
        if not any((*given.values(), *others)):
            raise BadCall(f"nothing to change of {operation}: give a tool, a speed, a feed, ...")
        process = self._planned(operation)
        if own:
            group = registry.get(STRATEGIES, process.operation(operation).strategy).settings
            process = with_own_choices(process, operation, own, group)
        if suppressed is not None:
            process = with_suppressed(process, operation, suppressed)
        if before:
            check_known(process, before)
        if is_moved:
            process = with_operation_before(process, operation, before or None)
        session = replace(self.session, process=process)
        if any(given.values()):
            change = choose(OperationChange, {f"operation.{n}": v for n, v in given.items()})
            session = self.engine.with_operation_change(session, operation, change)
        if add_faces or leave_out:
            session = with_guide_faces(
                self.engine,
                session,
                operation,
                add=add_faces,
                leave_out=leave_out,
                progress=self.progress,
            )
        self.session = session

    @recorded
    def copy(self, operation: str, on: str = "") -> str:
        """Copy an operation, right behind it, or `on` another feature of the same kind; return the copy's id."""
        process = self._planned(operation)
        if on:
            assert self.session.recognition is not None
            process, made = with_copy_on(process, operation, on, self.session.recognition)
        else:
            process, made = with_copy(process, operation)
        self.session = replace(self.session, process=process)
        return made

    @recorded
    def delete(self, operation: str) -> None:
        """Take an operation out of the plan."""
        process = self._planned(operation)
        self.session = replace(self.session, process=process.without(operation))

    def _planned(self, operation: str) -> ProcessTree:
        process = self.run(PLANNED).process
        assert process is not None
        check_known(process, operation)
        return process
