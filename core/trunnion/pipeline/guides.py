"""The guide lines and guide faces of a plan's operations, made anew from their faces whenever somebody looks at them."""

from __future__ import annotations

from typing import Any

from trunnion import registry
from trunnion.findings import BadCall, Refused
from trunnion.model.guides import OperationGuides
from trunnion.model.operation import Operation
from trunnion.model.session import Session
from trunnion.pipeline.context import Context
from trunnion.pipeline.planning.scene import SessionContext, SetupScene
from trunnion.plan.contract import DriveNeeds, GuideDrive, planner_for
from trunnion.plan.plane_guides import guide_space
from trunnion.progress import Progress
from trunnion.registry import STRATEGIES
from trunnion.settings import digest


class PlanGuides:
    """The guides of one plan; what several operations share is worked out once for all that are asked for."""

    def __init__(self, session: Session, context: Context) -> None:
        self.digest = digest_of(session)
        self._session, self._parts = session, SessionContext(context, session)
        self._scenes: dict[str, SetupScene] = {}

    def of(self, id: str, progress: Progress) -> OperationGuides:
        """Return the guide lines and guide faces of an operation by its id; raise `BadCall` where there is none of it.

        Strategies that are driven by faces alone have no lines. What earlier operations have cut is not asked for.
        """
        session = self._session
        if session.process is None or session.recognition is None or session.blank is None:
            raise BadCall("no operations yet: generate the route first")
        operation = next((o for o in session.process.operations if o.id == id), None)
        if operation is None:
            raise BadCall(f"the plan has no operation {id}")
        return self.of_operation(operation, progress)

    def of_operation(self, operation: Operation, progress: Progress) -> OperationGuides:
        """Return the guide lines and guide faces of an operation as it is given; the plan may have another one of its id."""
        session, id = self._session, operation.id
        assert session.recognition is not None
        drive = registry.get(STRATEGIES, operation.strategy).drive
        if not issubclass(drive, GuideDrive):
            return OperationGuides(operation=id, faces=operation.faces)
        planner = planner_for(session.recognition.family)
        try:
            driven = planner.drive(
                operation, DriveNeeds(drive=drive), self._scene(operation), progress
            )
            made: Any = driven.drive
            lines = made.guides(guide_space(self._parts.part, driven.to_world))
        except Refused as reason:
            return OperationGuides(operation=id, faces=operation.faces, refused=str(reason))
        return OperationGuides(operation=id, lines=lines, faces=operation.faces)

    def _scene(self, operation: Operation) -> SetupScene:
        session = self._session
        assert session.process is not None
        assert session.recognition is not None
        assert session.blank is not None
        setup = session.process.setup(operation.setup)
        if setup.name not in self._scenes:
            self._scenes[setup.name] = SetupScene(
                context=self._parts,
                recognition=session.recognition,
                blank=session.blank,
                setup=setup,
                process=session.process,
                fixtures=session.fixtures_of(setup.name),
            )
        return self._scenes[setup.name]


def digest_of(session: Session) -> str:
    """Return a digest of all that guides depend on."""
    return digest(
        session.part.digest if session.part is not None else "",
        session.cuts,
        session.process,
        session.recognition,
        session.blank,
        session.fixtures,
        session.choices,
    )
